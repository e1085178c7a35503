//! The tangent plane of a surface at the chosen control point: its normal, in three fields.
//!
//! Where a point lies in several surfaces the fields belong to the first. A free plane shows no numbers; the first number typed
//! turns the normal that the surface has there now into a prescribed one.

use super::dom;
use super::page::Page;
use crate::number;
use crate::tool::Selection;
use ductile_spec::{Edit, PointId, Request, SurfaceId};
use glam::{DVec3, Vec3};

/// The fields, in the order of the coordinates.
pub(crate) const FIELDS: [&str; 3] = ["normal-x", "normal-y", "normal-z"];

impl Page {
    /// The chosen point and the surface whose normal the fields show.
    fn normal_subject(&self) -> Option<(SurfaceId, PointId)> {
        let Selection::Point(point) = self.selection else { return None };
        self.document.surfaces_through(point).next().map(|surface| (surface, point))
    }

    /// What a field shows.
    pub(crate) fn normal_text(&self, index: usize) -> String {
        let given = self.normal_subject().and_then(|(surface, point)| self.given_normal(surface, point));
        given.map(|normal| number::show(normal[index])).unwrap_or_default()
    }

    /// Shows the fields where there is a surface, and the way back where its normal is prescribed.
    pub(crate) fn show_normal(&self) {
        let subject = self.normal_subject();
        dom::show(&dom::element("normal-properties"), subject.is_some());
        let given = subject.and_then(|(surface, point)| self.given_normal(surface, point));
        dom::show(&dom::element("free-normal"), given.is_some());
    }

    /// Takes what was typed; says what is wrong with it.
    pub(crate) fn typed_normal(&mut self, index: usize, text: &str) -> Option<String> {
        let (surface, point) = self.normal_subject()?;
        let given = self.given_normal(surface, point);
        if text.trim().is_empty() {
            if given.is_some() {
                self.free_normal();
            }
            return None;
        }
        let mut normal = given.or_else(|| self.present_normal(surface, point))?;
        match number::parse(text) {
            Ok(value) if given.is_some() && number::show(value) == number::show(normal[index]) => None,
            Ok(value) => {
                normal[index] = value;
                if normal == DVec3::ZERO {
                    return Some("A normal needs one number other than 0; Free sets it free.".to_owned());
                }
                self.request(Request::Edit(Edit::Normal { surface, point, normal: Some(normal) }));
                None
            }
            Err(error) => Some(error.to_string()),
        }
    }

    /// Whether the chosen point has a prescribed normal.
    pub(crate) fn has_normal(&self) -> bool {
        self.normal_subject().is_some_and(|(surface, point)| self.given_normal(surface, point).is_some())
    }

    /// Sets the plane free.
    pub(crate) fn free_normal(&mut self) {
        if let Some((surface, point)) = self.normal_subject() {
            self.request(Request::Edit(Edit::Normal { surface, point, normal: None }));
        }
    }

    fn given_normal(&self, surface: SurfaceId, point: PointId) -> Option<DVec3> {
        self.document.surfaces.get(&surface)?.normals.get(&point).copied()
    }

    /// The normal that a surface has now at a point of it, in digits that a person would type.
    fn present_normal(&self, surface: SurfaceId, point: PointId) -> Option<DVec3> {
        let normal = self.surface_normal(surface, self.scene.point(point)?)?;
        Some((normal.as_dvec3() * 1e4).round() / 1e4)
    }

    /// The normal of a surface at its vertex nearest to a place.
    pub(crate) fn surface_normal(&self, surface: SurfaceId, at: Vec3) -> Option<Vec3> {
        let span = self.scene.structure.surfaces.iter().find(|span| span.id == surface)?;
        let vertices = span.first_vertex..span.first_vertex + span.vertex_count;
        let distance = |vertex: &u32| self.scene.vertex(*vertex).distance_squared(at);
        let nearest = vertices.min_by(|a, b| distance(a).total_cmp(&distance(b)))?;
        Some(self.scene.vertex_normal(nearest))
    }

    /// Prescribes the normal that a surface has now at a point, unless one is prescribed; its handle turns it.
    pub(crate) fn take_normal(&mut self, point: PointId) {
        self.selection = Selection::Point(point);
        self.refresh();
        let Some((surface, point)) = self.normal_subject() else {
            self.notices.refusal("No fair surface passes through this point.");
            return;
        };
        if self.given_normal(surface, point).is_none() {
            let normal = self.present_normal(surface, point);
            self.request(Request::Edit(Edit::Normal { surface, point, normal }));
        }
    }

    /// The prescribed directions at what is selected, where no handles stand for them: where, and which way.
    pub(crate) fn marked_directions(&self) -> Vec<(Vec3, Vec3)> {
        if self.tools.turns() {
            return Vec::new();
        }
        self.arms().into_iter().map(|arm| (arm.foot, arm.end - arm.foot)).collect()
    }
}
