//! The direction of a curve at the chosen control point: what the fields show, and what is typed there.
//!
//! Where a point lies on several curves the fields belong to the first. A free tangent shows no numbers; the first
//! number typed turns the direction that the curve has there now into a prescribed one.

use super::dom;
use super::page::Page;
use crate::number;
use crate::tool::Selection;
use ductile_spec::{CurveId, Edit, PointId, Request};
use glam::DVec3;

/// The fields, in the order of the coordinates.
pub(crate) const FIELDS: [&str; 3] = ["tangent-x", "tangent-y", "tangent-z"];

impl Page {
    /// The chosen point and the curve whose direction the fields show.
    fn tangent_subject(&self) -> Option<(CurveId, PointId)> {
        let Selection::Point(point) = self.selection else { return None };
        self.document.curves_through(point).next().map(|curve| (curve, point))
    }

    /// What a field shows.
    pub(crate) fn tangent_text(&self, index: usize) -> String {
        let given = self.tangent_subject().and_then(|(curve, point)| self.given_tangent(curve, point));
        given.map(|direction| number::show(direction[index])).unwrap_or_default()
    }

    /// Shows the fields where there is a curve, and the way back where its direction is prescribed.
    pub(crate) fn show_tangent(&self) {
        let subject = self.tangent_subject();
        dom::show(&dom::element("tangent-properties"), subject.is_some());
        let given = subject.and_then(|(curve, point)| self.given_tangent(curve, point));
        dom::show(&dom::element("free-tangent"), given.is_some());
    }

    /// Takes what was typed; says what is wrong with it.
    pub(crate) fn typed_tangent(&mut self, index: usize, text: &str) -> Option<String> {
        let (curve, point) = self.tangent_subject()?;
        let given = self.given_tangent(curve, point);
        if text.trim().is_empty() {
            if given.is_some() {
                self.free_tangent();
            }
            return None;
        }
        let mut direction = given.or_else(|| self.present_tangent(curve, point))?;
        match number::parse(text) {
            Ok(value) if given.is_some() && number::show(value) == number::show(direction[index]) => None,
            Ok(value) => {
                direction[index] = value;
                if direction == DVec3::ZERO {
                    return Some("A direction needs one number other than 0; Free sets it free.".to_owned());
                }
                self.request(Request::Edit(Edit::Tangent { curve, point, direction: Some(direction) }));
                None
            }
            Err(error) => Some(error.to_string()),
        }
    }

    /// Sets the direction free.
    pub(crate) fn free_tangent(&mut self) {
        if let Some((curve, point)) = self.tangent_subject() {
            self.request(Request::Edit(Edit::Tangent { curve, point, direction: None }));
        }
    }

    fn given_tangent(&self, curve: CurveId, point: PointId) -> Option<DVec3> {
        self.document.curves.get(&curve)?.tangents.get(&point).copied()
    }

    /// The direction that a curve has now at a point of it, in digits that a person would type.
    pub(crate) fn present_tangent(&self, curve: CurveId, point: PointId) -> Option<DVec3> {
        let closed = self.document.curves.get(&curve)?.closed;
        let place = self.scene.point(point)?;
        let samples: Vec<_> = self.scene.samples(curve).collect();
        let distance = |at: &glam::Vec3| (*at - place).length_squared();
        let nearest =
            (0..samples.len()).min_by(|a, b| distance(&samples[*a]).total_cmp(&distance(&samples[*b])))?;
        let last = samples.len() - 1;
        let before = if nearest > 0 {
            nearest - 1
        } else if closed {
            last
        } else {
            0
        };
        let after = if nearest < last {
            nearest + 1
        } else if closed {
            0
        } else {
            last
        };
        let direction = (samples[after] - samples[before]).as_dvec3().try_normalize()?;
        Some((direction * 1e4).round() / 1e4)
    }
}
