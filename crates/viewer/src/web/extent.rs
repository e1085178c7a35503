//! The size of the chosen closed curve: the mean distance of its control points from their centre, typed or taken from
//! another curve.

use super::dom;
use super::page::Page;
use crate::number;
use crate::tool::{Selection, mean_radius};
use ductile_spec::{CurveId, Edit, Extent, Request};

/// The field of index.html.
pub(crate) const FIELD: &str = "loop-radius";

impl Page {
    /// The chosen curve, if it is closed.
    fn chosen_loop(&self) -> Option<CurveId> {
        let Selection::Curve(id) = self.selection else { return None };
        self.document.curves.get(&id).filter(|curve| curve.closed).map(|_| id)
    }

    fn loop_radius(&self) -> Option<f64> {
        let curve = self.document.curves.get(&self.chosen_loop()?)?;
        let places: Vec<_> =
            curve.through.iter().filter_map(|point| self.document.points.get(point).copied()).collect();
        mean_radius(&places)
    }

    /// What the field shows.
    pub(crate) fn loop_radius_text(&self) -> String {
        self.loop_radius().map(number::show).unwrap_or_default()
    }

    /// Shows the field where a closed curve is chosen.
    pub(crate) fn show_extent(&self) {
        dom::show(&dom::element("loop-properties"), self.chosen_loop().is_some());
    }

    /// Takes what was typed; says what is wrong with it.
    pub(crate) fn typed_loop_radius(&mut self, text: &str) -> Option<String> {
        let curve = self.chosen_loop()?;
        match number::parse(text) {
            Ok(radius) if number::show(radius) == self.loop_radius_text() => None,
            Ok(radius) if radius > 0.0 => {
                self.request(Request::Edit(Edit::Expand { curve, to: Extent::Radius(radius) }));
                None
            }
            Ok(_) => Some("A radius is above 0.".to_owned()),
            Err(error) => Some(error.to_string()),
        }
    }

    /// Awaits the curve whose size the chosen one is to get.
    pub(crate) fn begin_match(&mut self) {
        if let Some(curve) = self.chosen_loop() {
            self.tools.choose_match(curve);
            self.hand.hover_is_stale = true;
            self.notices.hide_toast();
            self.refresh();
        }
    }
}
