//! The fields in which the designer types: coordinates, directions, edge length, name.

use super::cage;
use super::density;
use super::dom;
use super::fill;
use super::page::{Page, act};
use super::{extent, legend, normal, options, reach, ribbon, shadow, tangent};
use crate::number;
use crate::tool::Selection;
use ductile_spec::{Edit, PointId, Request};
use glam::DVec3;
use wasm_bindgen::JsCast;
use web_sys::{Element, Event, HtmlInputElement, KeyboardEvent};

const COORDINATES: [&str; 3] = ["x", "y", "z"];

/// Listens to the fields.
pub(crate) fn listen() {
    for (index, id) in COORDINATES.into_iter().enumerate() {
        on_field(id, move |page, text| page.typed_coordinate(index, text));
    }
    for (index, id) in tangent::FIELDS.into_iter().enumerate() {
        on_field(id, move |page, text| page.typed_tangent(index, text));
    }
    for id in density::FIELDS {
        on_field(id, move |page, text| page.typed_spacing(id, text));
    }
    for (index, id) in normal::FIELDS.into_iter().enumerate() {
        on_field(id, move |page, text| page.typed_normal(index, text));
    }
    for id in legend::FIELDS {
        on_field(id, move |page, text| page.typed_legend(id, text));
    }
    for (index, id) in reach::CHOSEN.into_iter().enumerate() {
        on_field(id, move |page, text| page.typed_displacement(index, text));
    }
    for (index, id) in shadow::FIELDS.into_iter().enumerate() {
        on_field(id, move |page, text| page.typed_shadow(index, text));
    }
    for (field, id) in reach::TOOL.into_iter().enumerate() {
        on_field(id, move |page, text| page.typed_reach(field, text));
    }
    on_field(fill::RESOLUTION, Page::typed_fill_resolution);
    on_field(ribbon::FIELD, Page::typed_ribbon);
    on_field(extent::FIELD, Page::typed_loop_radius);
    on_field(options::FIELD, Page::typed_tube_radius);
    on_field(options::ANGLE, Page::typed_join_angle);
    for id in cage::FIELDS {
        on_field(id, move |page, text| page.typed_cage(id, text));
    }
    on_field("name", |page, text| {
        let name = text.trim().to_owned();
        if name != page.document.name {
            page.request(Request::Edit(Edit::Rename { name }));
        }
        None
    });
}

/// Takes what was typed when the field is left or Enter is pressed; Escape puts the old text back.
fn on_field(id: &'static str, typed: impl Fn(&mut Page, &str) -> Option<String> + Copy + 'static) {
    let field: HtmlInputElement = dom::element_as(id);
    let own = field.clone();
    dom::listen(&field, "change", move |_: Event| {
        let text = own.value();
        act(move |page| {
            let error = typed(page, &text);
            page.show_field_error(id, error.as_deref());
        });
    });
    let own = field.clone();
    dom::listen(&field, "keydown", move |event: KeyboardEvent| match event.key().as_str() {
        "Enter" => {
            let _ = own.blur();
        }
        "Escape" => {
            let field = own.clone();
            act(move |page| {
                page.fill_field(&field, true);
                page.show_field_error(id, None);
                let _ = field.blur();
            });
        }
        _ => {}
    });
    dom::listen(&field, "blur", |_: Event| act(|page| page.refresh()));
}

impl Page {
    /// Where a control point is, exactly as the document has it.
    pub(crate) fn exact_place(&self, id: PointId) -> Option<DVec3> {
        self.document.points.get(&id).copied().or_else(|| self.scene.point(id).map(|at| at.as_dvec3()))
    }

    /// Writes the present values into the fields.
    pub(crate) fn show_fields(&self) {
        for id in COORDINATES
            .into_iter()
            .chain(tangent::FIELDS)
            .chain(normal::FIELDS)
            .chain(density::FIELDS)
            .chain(cage::FIELDS)
            .chain(reach::CHOSEN)
            .chain(reach::TOOL)
            .chain(shadow::FIELDS)
            .chain([ribbon::FIELD, extent::FIELD, options::FIELD, options::ANGLE, fill::RESOLUTION])
        {
            self.fill_field(&dom::element_as(id), false);
        }
    }

    /// Writes the present value into a field, unless the designer is typing in it.
    pub(crate) fn fill_field(&self, field: &HtmlInputElement, even_focused: bool) {
        let focused = dom::document().active_element();
        if !even_focused && focused.as_ref() == Some(field.unchecked_ref::<Element>()) {
            return;
        }
        let id = field.id();
        if !even_focused && self.panel.refused.is_some_and(|(refused, _)| refused == id) {
            return;
        }
        let value = match (id.as_str(), self.selection) {
            ("name", _) => self.document.name.clone(),
            (field, _) if density::FIELDS.contains(&field) => self.spacing_text(field),
            (field, _) if cage::FIELDS.contains(&field) => self.cage_text(field),
            (field, Selection::Point(_)) if tangent::FIELDS.contains(&field) => {
                self.tangent_text(tangent::FIELDS.iter().position(|name| *name == field).unwrap_or(0))
            }
            (field, Selection::Point(_)) if normal::FIELDS.contains(&field) => {
                self.normal_text(normal::FIELDS.iter().position(|name| *name == field).unwrap_or(0))
            }
            (field, _) if legend::FIELDS.contains(&field) => self.legend_text(field),
            (options::FIELD, _) => self.tube_radius_text(),
            (options::ANGLE, _) => self.join_angle_text(),
            (fill::RESOLUTION, _) => self.fill_resolution_text(),
            (field, _) if reach::TOOL.contains(&field) => self.reach_text(field),
            (field, _) if reach::CHOSEN.contains(&field) => self.displacement_text(field),
            (field, _) if shadow::FIELDS.contains(&field) => self.shadow_text(field),
            (extent::FIELD, Selection::Curve(_)) => self.loop_radius_text(),
            (ribbon::FIELD, Selection::Curve(_)) => self.ribbon_text(),
            (_, Selection::Point(point)) => {
                let live = self.scene.header.held == Some(point);
                let place = if live {
                    self.scene.point(point).map(|at| at.as_dvec3())
                } else {
                    self.exact_place(point)
                };
                let index = COORDINATES.iter().position(|name| *name == id).unwrap_or(0);
                place.map(|place| number::show(place[index])).unwrap_or_default()
            }
            _ => String::new(),
        };
        if field.value() != value {
            field.set_value(&value);
        }
    }

    fn typed_coordinate(&mut self, index: usize, text: &str) -> Option<String> {
        let Selection::Point(point) = self.selection else { return None };
        let place = self.exact_place(point)?;
        match number::parse(text) {
            Ok(value) if number::show(value) == number::show(place[index]) => None,
            Ok(value) => {
                let mut to = place;
                to[index] = value;
                self.request(Request::Edit(Edit::Move { point, to }));
                None
            }
            Err(error) => Some(error.to_string()),
        }
    }

    /// Says what is wrong with what was typed, or that nothing is.
    pub(crate) fn show_field_error(&mut self, id: &'static str, error: Option<&str>) {
        self.panel.refused = error.map(|_| (id, self.selection));
        let line = dom::element("number-error");
        dom::text(&line, error.unwrap_or_default());
        dom::show(&line, error.is_some());
        dom::attribute(&dom::element(id), "aria-invalid", if error.is_some() { "true" } else { "false" });
        self.refresh();
    }
}
