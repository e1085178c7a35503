//! The shadow of a region: what the tool marks, and its strength and turn in the properties.

use super::dom;
use super::page::Page;
use crate::number;
use crate::tool::{Place, Selection};
use crate::{Highlight, Hit, Tinted};
use ductile_spec::{Edit, On, Request, Shadow, SurfaceId};

/// The fields of index.html: what heights are multiplied by, and the turn in degrees.
pub(crate) const FIELDS: [&str; 2] = ["shadow-strength", "shadow-turn"];

/// Digits of an angle in degrees that a field shows.
const DEGREES: f64 = 1e4;

impl Page {
    /// The region that would shadow, and the stamp under the pointer.
    pub(crate) fn mark_shadow(&self, mark: &mut Highlight) {
        let Some(Place { surface, at, .. }) = self.tools.first_place() else {
            self.mark_region(mark);
            return;
        };
        mark.tinted.clear();
        if let Some(Hit::Surface { triangle, .. }) = self.scene.hit_near(surface, at) {
            let region = self.scene.region_of(triangle);
            mark.tinted.push(region.map_or(Tinted::Surface(surface), |own| Tinted::Region(surface, own)));
        }
        if let Some(Hit::Surface { id, .. }) = mark.hover.take()
            && id != surface
        {
            mark.tinted.push(Tinted::Surface(id));
        }
    }

    /// The shadow of the region that was clicked, or of a surface in one piece, and where it is.
    fn shadow(&self) -> Option<(On, Shadow)> {
        let Selection::Surface(surface) = self.selection else { return None };
        let regions = &self.document.surfaces.get(&surface)?.regions;
        let at = self.picked_place(surface);
        if let Some(entry) = at.and_then(|at| self.scene.region_at(surface, at)) {
            return Some((On { surface, at: at?.as_dvec3() }, entry.shadow?));
        }
        if self.scene.structure.regions.iter().any(|entry| entry.surface == surface) {
            return None;
        }
        let shadow = regions.iter().find_map(|region| region.shadow)?;
        let at = at.or_else(|| Some(self.scene.ball_of(surface)?.0))?.as_dvec3();
        Some((On { surface, at }, shadow))
    }

    /// Shows the properties of the shadow, if there is one.
    pub(crate) fn show_shadow(&self) {
        let shadow = self.shadow();
        dom::show(&dom::element("shadow-properties"), shadow.is_some());
        if let Some((_, shadow)) = shadow {
            dom::text(&dom::element("shadow-title"), &format!("Shadow of {}", shadow.of));
        }
        let trouble = dom::element("shadow-trouble");
        let why = shadow.and_then(|(on, shadow)| self.why_no_shadow(on.surface, &shadow));
        dom::show(&trouble, why.is_some());
        let why = why.unwrap_or_default();
        let text = format!("It does not show: {why}. It comes back by itself when that is mended.");
        dom::text(&trouble, &text);
    }

    /// Why a shadow does not show at the moment.
    fn why_no_shadow(&self, surface: SurfaceId, shadow: &Shadow) -> Option<&str> {
        let mut failed = self.scene.structure.failed_shadows.iter();
        failed.find(|failed| (failed.surface, &failed.shadow) == (surface, shadow)).map(|failed| &*failed.why)
    }

    /// What a field shows.
    pub(crate) fn shadow_text(&self, field: &str) -> String {
        let text = |(_, shadow): (On, Shadow)| {
            let is_strength = field == FIELDS[0];
            let degrees = (shadow.turn.to_degrees() * DEGREES).round() / DEGREES;
            number::show(if is_strength { shadow.strength } else { degrees })
        };
        self.shadow().map(text).unwrap_or_default()
    }

    /// Takes what was typed; says what is wrong with it.
    pub(crate) fn typed_shadow(&mut self, index: usize, text: &str) -> Option<String> {
        let (region, Shadow { of, strength, turn }) = self.shadow()?;
        if text.trim() == self.shadow_text(FIELDS[index]) {
            return None;
        }
        let value = match number::parse(text) {
            Ok(value) => value,
            Err(error) => return Some(error.to_string()),
        };
        let (strength, turn) = if index == 0 { (value, turn) } else { (strength, value.to_radians()) };
        self.request(Request::Edit(Edit::Shadow { region, of: Some(of), strength, turn: Some(turn) }));
        None
    }

    /// Sets the region free.
    pub(crate) fn free_shadow(&mut self) {
        if let Some((region, _)) = self.shadow() {
            self.request(Request::Edit(Edit::Shadow { region, of: None, strength: 1.0, turn: None }));
        }
    }
}
