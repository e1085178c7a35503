//! What shapes minimise, in the properties: one choice for the document, and one for whatever is selected.

use super::dom;
use super::page::{Page, act};
use crate::tool::Selection;
use ductile_spec::{Edit, Objective, ObjectiveOf, Request, SurfaceId};
use web_sys::{Event, HtmlSelectElement};

/// The selects of index.html.
const OWN: &str = "objective";
const REGION: &str = "region-objective";

/// Fills the selects and listens to them.
pub(crate) fn listen() {
    for id in [OWN, REGION] {
        let select: HtmlSelectElement = dom::element_as(id);
        for (value, name) in [(String::new(), "")]
            .into_iter()
            .chain(Objective::ALL.into_iter().enumerate().map(|(place, o)| (place.to_string(), o.label())))
        {
            let option = dom::create_with("option", "", name);
            dom::attribute(&option, "value", &value);
            dom::append(&select, [&option]);
        }
        let own = select.clone();
        dom::listen(&select, "change", move |_: Event| {
            let chosen =
                own.value().parse::<usize>().ok().and_then(|place| Objective::ALL.get(place).copied());
            act(move |page| page.choose_objective(id == REGION, chosen));
        });
    }
}

impl Page {
    fn choose_objective(&mut self, is_region: bool, objective: Option<Objective>) {
        let of = match self.selection {
            Selection::None => Some(ObjectiveOf::Document),
            Selection::Curve(id) => Some(ObjectiveOf::Curve(id)),
            Selection::Surface(surface) if is_region => {
                let at = self.picked_place(surface);
                at.map(|at| ObjectiveOf::Region { surface, at: at.as_dvec3() })
            }
            Selection::Surface(id) => Some(ObjectiveOf::Surface(id)),
            Selection::Point(_) => None,
        };
        if let Some(of) = of {
            self.request(Request::Edit(Edit::Objective { of, objective }));
        }
    }

    /// Where the selected surface was clicked.
    fn picked_place(&self, surface: SurfaceId) -> Option<glam::Vec3> {
        self.picked.filter(|(picked, _)| *picked == surface).map(|(_, at)| at)
    }

    /// Shows what is chosen.
    pub(crate) fn show_objectives(&self) {
        let document = &self.document;
        let (own, is_inherited) = match self.selection {
            Selection::None => (Some(document.objective), false),
            Selection::Curve(id) => (document.curves.get(&id).and_then(|curve| curve.objective), true),
            Selection::Surface(id) => {
                (document.surfaces.get(&id).and_then(|surface| surface.objective), true)
            }
            Selection::Point(_) => (None, false),
        };
        dom::show(&dom::element("objective-properties"), !matches!(self.selection, Selection::Point(_)));
        let inherited = is_inherited.then_some("As the document");
        show_choice(OWN, own, inherited);
        let region = match self.selection {
            Selection::Surface(id) => self.picked_place(id).and_then(|at| self.scene.region_at(id, at)),
            _ => None,
        };
        dom::show(&dom::element("region-properties"), region.is_some());
        if let Some(region) = region {
            show_choice(REGION, region.objective, Some("As the surface"));
        }
    }
}

/// Shows a choice; the entry without one is there only where something is inherited.
fn show_choice(id: &str, objective: Option<Objective>, inherited: Option<&str>) {
    let select: HtmlSelectElement = dom::element_as(id);
    if let Some(first) = select.query_selector("option").ok().flatten() {
        dom::text(&first, inherited.unwrap_or_default());
        if inherited.is_some() {
            let _ = first.remove_attribute("hidden");
        } else {
            dom::attribute(&first, "hidden", "");
        }
    }
    let place = objective.and_then(|own| Objective::ALL.iter().position(|other| *other == own));
    let value = place.map(|place| place.to_string()).unwrap_or_default();
    if select.value() != value {
        select.set_value(&value);
    }
}
