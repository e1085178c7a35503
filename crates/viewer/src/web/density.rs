//! How long edges are, in the properties: of the document, of a surface, and of the region of it that was clicked.

use super::dom;
use super::menu;
use super::page::{Page, act};
use crate::number;
use crate::tool::Selection;
use ductile_spec::{Density, Edit, Request, SpacingOf};

/// The fields of index.html in which an edge length is typed: of what is selected, and of the region.
pub(crate) const FIELDS: [&str; 2] = [OWN, REGION];
const OWN: &str = "spacing";
const REGION: &str = "region-spacing";
const DENSITY: &str = "density";

/// Fills the select and listens to it.
pub(crate) fn listen() {
    menu::fill(DENSITY, Density::ALL.map(Density::label), |place| {
        let density = place.and_then(|place| Density::ALL.get(place).copied());
        act(move |page| page.choose_density(density));
    });
}

impl Page {
    fn choose_density(&mut self, density: Option<Density>) {
        let of = match self.selection {
            Selection::None => None,
            Selection::Surface(id) => Some(id),
            _ => return,
        };
        self.request(Request::Edit(Edit::Density { of, density }));
    }

    /// Whose edge length a field holds.
    fn spacing_of(&self, field: &str) -> Option<SpacingOf> {
        match self.selection {
            Selection::None if field == OWN => Some(SpacingOf::Document),
            Selection::Surface(id) if field == OWN => Some(SpacingOf::Surface(id)),
            Selection::Surface(surface) => {
                let at = self.picked_place(surface)?.as_dvec3();
                Some(SpacingOf::Region { surface, at })
            }
            _ => None,
        }
    }

    /// The edge length that a field holds.
    fn own_spacing(&self, field: &str) -> Option<f64> {
        match self.selection {
            Selection::None if field == OWN => self.document.spacing,
            Selection::Surface(id) if field == OWN => {
                self.document.surfaces.get(&id).and_then(|surface| surface.spacing)
            }
            Selection::Surface(id) => {
                let region = self.picked_place(id).and_then(|at| self.scene.region_at(id, at));
                region.and_then(|region| region.spacing)
            }
            _ => None,
        }
    }

    /// What a field shows.
    pub(crate) fn spacing_text(&self, field: &str) -> String {
        self.own_spacing(field).map(number::show).unwrap_or_default()
    }

    /// Takes what was typed. Returns what is wrong with it.
    pub(crate) fn typed_spacing(&mut self, field: &str, text: &str) -> Option<String> {
        let spacing = if text.trim().is_empty() {
            None
        } else {
            match number::parse(text) {
                Ok(value) if value > 0.0 => Some(value),
                Ok(_) => return Some("An edge length is above 0; nothing means automatic.".to_owned()),
                Err(error) => return Some(error.to_string()),
            }
        };
        let of = self.spacing_of(field)?;
        if spacing.map(number::show) != self.own_spacing(field).map(number::show) {
            self.request(Request::Edit(Edit::Spacing { of, spacing }));
        }
        None
    }

    /// Shows what is chosen.
    pub(crate) fn show_density(&self) {
        let (own, is_inherited) = match self.selection {
            Selection::Surface(id) => {
                (self.document.surfaces.get(&id).and_then(|surface| surface.density), true)
            }
            _ => (Some(self.document.density), false),
        };
        let has_mesh = self.selection == Selection::None || self.fair_surface().is_some();
        dom::show(&dom::element("mesh-properties"), has_mesh);
        let otherwise = if is_inherited { "as the document" } else { "automatic" };
        dom::attribute(&dom::element(OWN), "placeholder", otherwise);
        let place = own.and_then(|own| Density::ALL.iter().position(|other| *other == own));
        menu::show(DENSITY, place, is_inherited.then_some("As the document"));
    }
}
