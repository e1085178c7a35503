//! What shapes minimise, in the properties: one choice for the document, and one for whatever is selected.

use super::dom;
use super::menu;
use super::page::{Page, act};
use crate::tool::Selection;
use ductile_spec::{Edit, Objective, ObjectiveOf, Request, SurfaceId};

/// The selects of index.html.
const OWN: &str = "objective";
const REGION: &str = "region-objective";

/// Fills the selects and listens to them.
pub(crate) fn listen() {
    for id in [OWN, REGION] {
        menu::fill(id, Objective::ALL.map(Objective::label), move |place| {
            let chosen = place.and_then(|place| Objective::ALL.get(place).copied());
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
            Selection::Point(_) | Selection::Edge { .. } | Selection::Face { .. } => None,
        };
        if let Some(of) = of {
            self.request(Request::Edit(Edit::Objective { of, objective }));
        }
    }

    /// Where the selected surface was clicked.
    pub(crate) fn picked_place(&self, surface: SurfaceId) -> Option<glam::Vec3> {
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
            Selection::Point(_) | Selection::Edge { .. } | Selection::Face { .. } => (None, false),
        };
        let minimises =
            matches!(self.selection, Selection::None | Selection::Curve(_)) || self.fair_surface().is_some();
        dom::show(&dom::element("objective-properties"), minimises);
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
    let place = objective.and_then(|own| Objective::ALL.iter().position(|other| *other == own));
    menu::show(id, place, inherited);
}
