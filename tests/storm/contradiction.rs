//! Directions, planes and ribbons that contradict each other, the curves and the surface.

use crate::stream::Stream;
use ductile_spec::{CurveId, Document, Edit, Handle, Leave, PointId, Request, SurfaceId};
use glam::DVec3;

impl Stream {
    /// A direction: along an axis, so that neighbours agree or contradict each other exactly, or as a hand means it.
    fn direction(&mut self, others: &[DVec3]) -> DVec3 {
        let axes = [DVec3::X, DVec3::Y, DVec3::Z];
        match self.below(4) {
            0 => self.malice(others),
            1 => axes[self.below(3)] * [1e-200, 1e200][self.below(2)],
            2 => -axes[self.below(3)],
            _ => axes[self.below(3)],
        }
    }

    /// A curve of the document and one of its points.
    fn somewhere(&mut self, document: &Document) -> Option<(CurveId, PointId)> {
        let curves: Vec<_> = document.curves.iter().filter(|(_, curve)| !curve.through.is_empty()).collect();
        let (id, curve) = *curves.get(self.below(curves.len().max(1)))?;
        Some((*id, curve.through[self.below(curve.through.len())]))
    }

    /// Prescribes something at a place where the curves, the surface or what was prescribed before say otherwise.
    pub(crate) fn contradiction(&mut self, document: &Document, others: &[DVec3]) -> Option<Request> {
        let (curve, point) = self.somewhere(document)?;
        let surfaces: Vec<SurfaceId> = document.surfaces.keys().copied().collect();
        let surface = *surfaces.get(self.below(surfaces.len().max(1)))?;
        let direction = self.direction(others);
        Some(Request::Edit(match self.below(5) {
            0 => Edit::Tangent { curve, point, direction: Some(direction) },
            1 => Edit::Normal { surface, point, normal: Some(direction) },
            2 => {
                let points = document.curves[&curve].through.clone();
                let cross = points.into_iter().map(|point| (point, self.direction(others))).collect();
                Edit::Ribbon { surface, curve, leave: Some(Leave::Cross(cross)) }
            }
            3 => {
                let angle = [0.0, 1.5, -3.1, std::f64::consts::PI, f64::NAN, 1e9][self.below(6)];
                Edit::Ribbon { surface, curve, leave: Some(Leave::Angle(angle)) }
            }
            _ => Edit::Ribbon { surface, curve, leave: Some(Leave::Now) },
        }))
    }

    /// A direction at a point to take hold of, in some rounds, if there is one.
    pub(crate) fn handle(&mut self, document: &Document, point: PointId) -> Option<Handle> {
        if self.below(3) > 0 {
            return None;
        }
        let ribbons = document
            .surfaces
            .iter()
            .flat_map(|(surface, all)| all.ribbons.keys().map(move |c| (*surface, *c)));
        let at_ribbons = ribbons
            .filter(|(_, curve)| document.curves.get(curve).is_some_and(|c| c.through.contains(&point)));
        let ribbons = at_ribbons.map(|(surface, curve)| Handle::Ribbon { surface, curve, point });
        let planes = document.surfaces.iter().filter(|(_, all)| all.normals.contains_key(&point));
        let planes = planes.map(|(surface, _)| Handle::Normal { surface: *surface, point });
        let curves = document.curves.iter().filter(|(_, curve)| curve.through.contains(&point));
        let tangents = curves.map(|(curve, _)| Handle::Tangent { curve: *curve, point });
        let all: Vec<Handle> = ribbons.chain(planes).chain(tangents).collect();
        (!all.is_empty()).then(|| all[self.below(all.len())])
    }
}
