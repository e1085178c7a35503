//! The sides of a fill in its properties: from where each takes its planes, and how it leaves its curve beside what is fair.

use super::dom;
use super::page::{Page, act};
use crate::number;
use crate::tool::Selection;
use ductile_spec::{
    CurveId, Edit, Fill, FillJoin, FillSide, LEAST_LEAN, MOST_LEAN, MOST_TURN, Request, SurfaceId,
};
use wasm_bindgen::JsCast;
use web_sys::{Element, Event, EventTarget, HtmlInputElement, KeyboardEvent};

/// The list in index.html.
const LIST: &str = "fill-sides";
/// The fields of a side: how they are called, and what is said of them.
const FIELDS: [(&str, &str); 2] = [
    ("turn", "Turned about the curve, in degrees from -90 to 90; 0 is fair. Fades to the corners"),
    ("strength", "How far the direction across the curve reaches in, 0.1 to 5; 1 is fair"),
];
/// Digits of an angle in degrees that a field shows.
const DEGREES: f64 = 1e4;

/// Listens to what is typed and pointed at in the list.
pub(crate) fn listen() {
    let list = dom::element(LIST);
    for event in ["pointerover", "focusin"] {
        dom::listen(&list, event, |event: Event| {
            let side = event.target().and_then(|target| named(&target, "data-side"));
            act(move |page| page.point_at_side(side));
        });
    }
    for event in ["pointerleave", "focusout"] {
        dom::listen(&list, event, |_: Event| act(|page| page.point_at_side(None)));
    }
    dom::listen(&list, "change", |event: Event| {
        if let Some(field) = event.target().and_then(|target| target.dyn_into::<HtmlInputElement>().ok()) {
            act(move |page| page.typed_lean(&field));
        }
    });
    dom::listen(&list, "keydown", |event: KeyboardEvent| {
        let field = event.target().and_then(|target| target.dyn_into::<HtmlInputElement>().ok());
        let Some(field) = field.filter(|_| matches!(event.key().as_str(), "Enter" | "Escape")) else {
            return;
        };
        if event.key() == "Escape" {
            // What was typed is given up.
            let own = field.clone();
            act(move |page| page.show_lean(&own, true));
        }
        let _ = field.blur();
    });
    dom::listen(&list, "focusout", |_: Event| act(|page| page.refresh()));
}

/// A number in an attribute of an element or of what it stands in.
fn named(target: &EventTarget, attribute: &str) -> Option<usize> {
    let row = target.dyn_ref::<Element>()?.closest(&format!("[{attribute}]")).ok().flatten()?;
    row.get_attribute(attribute)?.parse().ok()
}

impl Page {
    fn point_at_side(&mut self, side: Option<usize>) {
        if self.side_over != side {
            self.side_over = side;
            self.redraw();
        }
    }

    /// The side of the selected fill that is pointed at in the list.
    pub(crate) fn mark_side(&self, mark: &mut crate::Highlight) {
        let side = self.side_over.and_then(|at| self.filled()?.1.sides.get(at));
        let line = side.and_then(|side| {
            let stretch = side.stretch(self.document.curves.get(&side.curve)?).0;
            self.stretch_line(&stretch)
        });
        mark.sketch.extend(line.filter(|line| line.len() > 1));
    }

    /// Lists the sides of the selected fill. The rows are made anew only for other sides, so that pointer and focus stay.
    pub(crate) fn show_sides(&self, id: SurfaceId, fill: &Fill) {
        let list = dom::element(LIST);
        let planes: Vec<String> = fill.sides.iter().map(|side| planes(side, fill)).collect();
        let shown =
            format!("{id} {:?}", fill.sides.iter().map(|side| side.curve).zip(&planes).collect::<Vec<_>>());
        if list.get_attribute("data-shown").as_deref() != Some(&shown) {
            dom::attribute(&list, "data-shown", &shown);
            dom::clear(&list);
            for (at, (side, planes)) in fill.sides.iter().zip(&planes).enumerate() {
                dom::append(&list, [&row(at, side.curve, planes, fields_of(side, fill))]);
            }
        }
        let inputs = list.query_selector_all("input").ok();
        let inputs = inputs.iter().flat_map(|found| (0..found.length()).filter_map(|k| found.get(k)));
        for field in inputs.filter_map(|node| node.dyn_into::<HtmlInputElement>().ok()) {
            self.show_lean(&field, false);
        }
    }

    /// Writes the present value into a field, unless the designer is at it.
    fn show_lean(&self, field: &HtmlInputElement, even_focused: bool) {
        let is_at_it = dom::document().active_element().as_ref() == Some(field);
        let is_refused = field.get_attribute("aria-invalid").as_deref() == Some("true");
        let Some((_, side, which)) = self.leaning(field).filter(|_| even_focused || !is_at_it && !is_refused)
        else {
            return;
        };
        dom::attribute(field, "aria-invalid", "false");
        let value = text(&side, which);
        if field.value() != value {
            field.set_value(&value);
        }
    }

    /// What a field is about: the number of the side, from 0, the side, and which of the fields.
    fn leaning(&self, field: &HtmlInputElement) -> Option<(usize, FillSide, usize)> {
        let at = named(field, "data-side")?;
        Some((at, *self.filled()?.1.sides.get(at)?, named(field, "data-lean")?))
    }

    /// Takes what was typed into a field of a side; says what is wrong with it.
    fn typed_lean(&mut self, field: &HtmlInputElement) {
        let (Some((at, side, which)), Selection::Surface(surface)) = (self.leaning(field), self.selection)
        else {
            return;
        };
        let typed = field.value();
        let parsed = match typed.trim().trim_end_matches('°') {
            "" => Ok(if which == 0 { 0.0 } else { 1.0 }),
            text => number::parse(text).map_err(|error| error.to_string()),
        };
        let value = parsed.and_then(|value| {
            let (value, least, most) = if which == 0 {
                (value.to_radians(), -MOST_TURN, MOST_TURN)
            } else {
                (value, LEAST_LEAN, MOST_LEAN)
            };
            if (least..=most).contains(&value) { Ok(value) } else { Err(format!("{}.", FIELDS[which].1)) }
        });
        dom::attribute(field, "aria-invalid", if value.is_err() { "true" } else { "false" });
        let line = dom::element("number-error");
        dom::text(&line, value.as_ref().err().map_or("", |error| error));
        dom::show(&line, value.is_err());
        if let Ok(value) = value.as_ref().copied()
            && typed != text(&side, which)
        {
            let (turn, strength) = if which == 0 { (value, side.strength) } else { (side.turn, value) };
            self.request(Request::Edit(Edit::Lean { surface, side: at + 1, turn, strength }));
        }
        self.refresh();
    }
}

/// What a field shows.
fn text(side: &FillSide, which: usize) -> String {
    number::show(if which == 0 {
        (side.turn.to_degrees() * DEGREES).round() / DEGREES
    } else {
        side.strength
    })
}

/// From where a side takes its planes.
fn planes(side: &FillSide, fill: &Fill) -> String {
    match side.planes {
        _ if fill.style.join == FillJoin::Position => "positions only".to_owned(),
        Some(beside) => format!("planes of surface {}", beside.0),
        None => "fair planes".to_owned(),
    }
}

/// Which fields a side has: what takes its planes from a surface cannot be turned, and what has none neither leans.
fn fields_of(side: &FillSide, fill: &Fill) -> core::ops::Range<usize> {
    match fill.style.join {
        FillJoin::Position => 0..0,
        FillJoin::Tangent => usize::from(side.planes.is_some())..2,
    }
}

fn row(at: usize, curve: CurveId, planes: &str, fields: core::ops::Range<usize>) -> Element {
    let button = dom::command_button("", "", "select");
    dom::attribute(&button, "data-subject", &format!("curve {}", curve.0));
    let name = format!("Side {} · curve {}", at + 1, curve.0);
    dom::append(&button, [&dom::create_with("span", "", &name), &dom::create_with("span", "note", planes)]);
    let item = dom::create("li");
    dom::attribute(&item, "data-side", &at.to_string());
    dom::append(&item, [&button]);
    let leaning = dom::create_with("div", "fields leans", "");
    for which in fields {
        let (name, title) = FIELDS[which];
        let label = dom::create_with("label", "", if which == 0 { "Turn °" } else { "Strength" });
        let id = format!("side-{}-{name}", at + 1);
        dom::attribute(&label, "for", &id);
        dom::attribute(&label, "title", title);
        let field = dom::create("input");
        for (name, value) in [
            ("id", &*id),
            ("type", "text"),
            ("inputmode", "decimal"),
            ("autocomplete", "off"),
            ("aria-describedby", "number-error"),
            ("data-lean", &which.to_string()),
        ] {
            dom::attribute(&field, name, value);
        }
        dom::append(&leaning, [&label, &field]);
    }
    dom::append(&item, [&leaning]);
    item.into()
}
