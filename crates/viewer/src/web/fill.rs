//! Fills in the page: the tool's loop under the pointer and its choices, and the properties of a fill.

use super::dom;
use super::menu;
use super::page::{Page, act};
use crate::tool::{Selection, ToolKind};
use crate::{Highlight, Hit, Skin, number};
use ductile_spec::{
    CurveId, Edit, Fill, FillInterior, FillJoin, FillNet, FillStyle, Hole, Request, RibbonHole, SurfaceId,
};

/// The field of the resolution in index.html.
pub(crate) const RESOLUTION: &str = "fill-resolution";
/// The selects, of the tool and of a fill.
const DEGREE: [&str; 2] = ["new-fill-degree", "fill-degree"];
const INTERIOR: [&str; 2] = ["new-fill-interior", "fill-interior"];
const JOIN: [&str; 2] = ["new-fill-join", "fill-join"];
const NET: &str = "fill-net";
/// The degrees that can be chosen.
const DEGREES: [(u8, &str); 8] =
    [(3, "3"), (4, "4"), (5, "5"), (6, "6"), (7, "7"), (8, "8"), (9, "9"), (10, "10")];
/// An angle between tangent planes, in degrees, that isophotes show.
const VISIBLE: f64 = 0.5;
/// What is said beside a larger one.
const WHAT_HELPS: &str = " Its sides bend more often than polynomials of this degree do: a higher degree comes nearer, or shorter sides, with curves that leave the rim where it bends.";
/// Most edges along a side.
const MOST_RESOLUTION: f64 = 64.0;

/// Fills the selects and listens to them.
pub(crate) fn listen() {
    for (of_fill, id) in [(false, DEGREE[0]), (true, DEGREE[1])] {
        menu::fill(id, DEGREES.map(|(_, label)| label), move |place| {
            let degree = place.and_then(|place| DEGREES.get(place)).map(|(degree, _)| *degree);
            act(move |page| page.change_fill(of_fill, |style| style.degree = degree));
        });
    }
    for (of_fill, id) in [(false, INTERIOR[0]), (true, INTERIOR[1])] {
        menu::fill(id, ["Biharmonic", "Harmonic"], move |place| {
            let interior = if place == Some(1) { FillInterior::Harmonic } else { FillInterior::Biharmonic };
            act(move |page| page.change_fill(of_fill, |style| style.interior = interior));
        });
    }
    for (of_fill, id) in [(false, JOIN[0]), (true, JOIN[1])] {
        menu::fill(id, ["Tangent planes", "Positions"], move |place| {
            let join = if place == Some(1) { FillJoin::Position } else { FillJoin::Tangent };
            act(move |page| page.change_fill(of_fill, |style| style.join = join));
        });
    }
    menu::fill(NET, ["Ribbons", "Whole"], move |place| {
        let net = if place == Some(1) { FillNet::Whole } else { FillNet::Ribbons };
        act(move |page| page.change_fill(true, |style| style.net = net));
    });
}

impl Page {
    /// Asks for the loop that a click would fill or skin.
    pub(crate) fn ask_loop(&mut self) {
        let sheet = self.tools.kind() == ToolKind::Sheet;
        if sheet || self.tools.kind() == ToolKind::Fill {
            // The hint says why there is no loop only while the pointer is on the curve.
            self.refresh();
        }
        let Some((curve, at)) = self.looped() else { return };
        if self.scene.header.settled
            && let Some(question) = self.looping.want(curve, at.as_dvec3(), sheet)
        {
            self.schedule.push(question);
        }
    }

    /// The place of a curve at which the tool points.
    fn looped(&self) -> Option<(CurveId, glam::Vec3)> {
        match self.hand.hover {
            Some(Hit::Curve { id, at })
                if self.tools.kind() == ToolKind::Sheet
                    || self.tools.kind() == ToolKind::Fill && self.tools.picked().is_empty() =>
            {
                Some((id, at))
            }
            _ => None,
        }
    }

    /// The loop that a click would fill, with a skin and lines from its sides to its middle; or the corners that were picked.
    pub(crate) fn mark_loop(&self, mark: &mut Highlight) {
        mark.selected.extend(self.tools.picked());
        let Some((curve, _)) = self.looped() else { return };
        let sides = self.looping.sides(curve);
        if !sides.is_empty() {
            mark.sketch = sides.to_vec();
            mark.sketch.extend(self.looping.spokes(curve));
            mark.skins.push(Skin { facets: self.looping.fan(curve), is_refused: false });
        }
    }

    /// Why nothing can be filled where the tool points, for the hint.
    pub(crate) fn why_no_loop(&self) -> Option<String> {
        let why = self.looped().and_then(|(curve, _)| self.looping.why(curve))?;
        let first = why.chars().next()?;
        Some(format!("{}{}.", first.to_uppercase(), &why[first.len_utf8()..]))
    }

    /// Fills all loops of the network of the curve that is pointed at or selected, or of all curves.
    pub(crate) fn fill_all(&mut self) {
        let selected = match self.selection {
            Selection::Curve(id) => Some(id),
            _ => None,
        };
        let curve = self.looped().map(|(curve, _)| curve).or(selected);
        let edit = self.tools.fill_all(curve);
        self.request(Request::Edit(edit));
    }

    /// Fills holes between the ribbons of a file, each as an act of its own.
    pub(crate) fn fill_ribbons(&mut self, holes: Vec<RibbonHole>) {
        self.remedies.clear();
        self.notices.dismiss("ribbons");
        for RibbonHole { ribbons, interior, join } in holes {
            let style = FillStyle { interior, join, ..FillStyle::default() };
            self.request(Request::Edit(Edit::Fill { hole: Hole::Ribbons(ribbons), style }));
        }
    }

    /// Ribbons that do not fit together were refused: the banner names side and point, and offers to move them least.
    pub(crate) fn offer_remedy(&mut self, text: &str, remedy: Edit) {
        self.remedies.push(remedy);
        self.notices.banner("ribbons", text, &[("Make compatible", "make-compatible")]);
    }

    /// Does what was offered.
    pub(crate) fn make_compatible(&mut self) {
        self.notices.dismiss("ribbons");
        for remedy in std::mem::take(&mut self.remedies) {
            self.request(Request::Edit(remedy));
        }
    }

    /// The selected fill.
    pub(crate) fn filled(&self) -> Option<(SurfaceId, &Fill)> {
        let Selection::Surface(id) = self.selection else { return None };
        self.document.fills.get(&id).map(|fill| (id, fill))
    }

    /// Whether somebody looks at the figures of a fill.
    pub(crate) fn shows_fill(&self) -> bool {
        self.filled().is_some()
    }

    fn change_fill(&mut self, of_fill: bool, change: impl FnOnce(&mut FillStyle)) {
        if !of_fill {
            change(&mut self.tools.options_mut().fill);
            self.refresh();
            return;
        }
        let Some((surface, fill)) = self.filled() else { return };
        let (before, mut style) = (fill.style, fill.style);
        change(&mut style);
        if style != before {
            self.request(Request::Edit(Edit::Refill { surface, style }));
        }
        self.refresh();
    }

    /// Shows how the tool fills.
    pub(crate) fn show_fill_option(&self) {
        let is_fill = self.tools.kind() == ToolKind::Fill;
        dom::show(&dom::element("fill-option"), is_fill);
        // Enter means the corners while there are some.
        dom::show(&dom::element("fill-all"), self.tools.picked().is_empty());
        show_style(0, self.tools.options().fill);
    }

    /// Shows how the selected fill is filled, from where its sides take their planes, and how well it follows them.
    pub(crate) fn show_fill(&self) {
        let filled = self.filled();
        dom::show(&dom::element("fill-properties"), filled.is_some());
        let Some((id, fill)) = filled else { return };
        show_style(1, fill.style);
        menu::show(NET, Some(usize::from(fill.style.net == FillNet::Whole)), None);
        self.show_sides(id, fill);
        let text = match self.reporting.of_fill(id) {
            None => "…".to_owned(),
            Some(figures) => match &figures.stuck {
                Some(why) => format!("It does not follow its curves at the moment: {why}."),
                None => format!(
                    "{} sides of degree {}, {} control points. Off its curves by at most {}, off its planes by at most {}°.{}{}",
                    figures.sides,
                    figures.degree,
                    figures.control_points,
                    few(figures.curve_deviation),
                    few(figures.plane_deviation),
                    if figures.plane_deviation > VISIBLE { WHAT_HELPS } else { "" },
                    turned_out(figures.turned_out)
                ),
            },
        };
        dom::text(&dom::element("fill-figures"), &text);
    }

    pub(crate) fn fill_resolution_text(&self) -> String {
        let resolution = self.filled().and_then(|(_, fill)| fill.style.resolution);
        resolution.map(|edges| edges.to_string()).unwrap_or_default()
    }

    /// Takes the resolution that was typed; says what is wrong with it.
    pub(crate) fn typed_fill_resolution(&mut self, text: &str) -> Option<String> {
        let resolution = if text.trim().is_empty() {
            None
        } else {
            match number::parse(text) {
                Ok(value) if (1.0..=MOST_RESOLUTION).contains(&value) && value.fract() == 0.0 => {
                    format!("{value}").parse().ok()
                }
                Ok(_) => return Some("A resolution is a whole number from 1 to 64.".to_owned()),
                Err(error) => return Some(error.to_string()),
            }
        };
        self.change_fill(true, |style| style.resolution = resolution);
        None
    }
}

fn show_style(which: usize, style: FillStyle) {
    let degree = style.degree.and_then(|own| DEGREES.iter().position(|(degree, _)| *degree == own));
    menu::show(DEGREE[which], degree, Some("Automatic"));
    menu::show(INTERIOR[which], Some(usize::from(style.interior == FillInterior::Harmonic)), None);
    menu::show(JOIN[which], Some(usize::from(style.join == FillJoin::Position)), None);
}

/// A figure in three digits.
pub(crate) fn few(value: f64) -> String {
    if value == 0.0 || (1e-3..1e4).contains(&value) {
        number::show(format!("{value:.2e}").parse().unwrap_or(value))
    } else {
        format!("{value:.1e}")
    }
}

/// What is wrong where a hole turns outwards at the beginning of a side, and what helps.
fn turned_out(side: Option<u32>) -> String {
    side.map_or_else(String::new, |side| {
        format!(" Where side {side} begins the hole turns outwards, and the patch folds over itself: divide the hole by a curve from there.")
    })
}
