//! What tools show of a surface that they would skin, crease, split or trim, before the click.

use super::page::Page;
use crate::tool::{Place, ToolKind, least_skin, span, would_smooth};
use crate::{Highlight, Hit, SharpOrSoft, Skin, Tinted, outline, part_at, region_around, side_of};
use ductile_spec::CurveId;
use glam::Vec3;

/// How far parts drift apart, in CSS pixels.
const DRIFT: f32 = 16.0;

impl Page {
    /// The skin in the curve under the pointer, or in the loop that it closes with others.
    pub(crate) fn mark_sheet(&self, mark: &mut Highlight) {
        if let Some(Hit::Curve { id, .. }) = mark.hover {
            let sides = self.looping.sides(id);
            let is_closed = span(&self.scene.structure, id).is_some_and(|span| span.closed);
            let line: Vec<Vec3> = match sides {
                [] if is_closed => self.scene.samples(id).collect(),
                // Each side ends where the next begins.
                _ => sides.iter().flat_map(|side| &side[..side.len().saturating_sub(1)]).copied().collect(),
            };
            mark.sketch.extend_from_slice(sides);
            let facets = least_skin(&line);
            if !facets.is_empty() {
                mark.skins.push(Skin { facets, is_refused: false });
            }
        }
    }

    /// A region, or a surface in one piece, is tinted whole: no place in it counts more than another. What would be an edge is
    /// drawn sharp, what would be smoothed soft, and what would be split off drifts away.
    pub(crate) fn mark_region(&self, mark: &mut Highlight) {
        mark.tinted.clear();
        let kind = self.tools.kind();
        match mark.hover {
            Some(Hit::Surface { id, triangle, .. }) => {
                let region = self.scene.region_of(triangle);
                mark.tinted.push(region.map_or(Tinted::Surface(id), |region| Tinted::Region(id, region)));
                mark.hover = None;
                let part = region_around(&self.scene, id, triangle).filter(|_| kind != ToolKind::Burnout);
                for places in part.iter().flat_map(|part| outline(&self.scene, id, part)) {
                    mark.edges.push(SharpOrSoft { places, closed: true, is_soft: false });
                }
                mark.skins.extend(part.filter(|_| kind == ToolKind::Split).map(|part| self.adrift(&part)));
            }
            Some(Hit::Curve { id, .. }) => self.mark_edge(mark, id),
            _ => {}
        }
    }

    /// A part as it drifts away from its place.
    fn adrift(&self, part: &[u32]) -> Skin {
        let by = self.drift(part);
        let corner = |v: u32| self.scene.vertex(v) + by;
        let facets = part.chunks_exact(3).map(|t| [t[0], t[1], t[2]].map(corner)).collect();
        Skin { facets, is_refused: false }
    }

    /// Off the surface, toward the eye; a part that turns all ways goes up.
    fn drift(&self, part: &[u32]) -> Vec3 {
        let (mut way, mut area, mut centre) = (Vec3::ZERO, 0.0, Vec3::ZERO);
        for t in part.chunks_exact(3) {
            let [a, b, c] = [t[0], t[1], t[2]].map(|v| self.scene.vertex(v));
            let own = (b - a).cross(c - a);
            way += own;
            area += own.length();
            centre += (a + b + c) * (own.length() / 3.0);
        }
        let centre = centre / area.max(f32::MIN_POSITIVE);
        let way = if way.length() > 0.3 * area { way.normalize_or_zero() } else { self.camera.up() };
        let way = if way.dot(self.camera.forward()) > 0.0 { -way } else { way };
        way * (DRIFT * self.camera.unit_per_pixel(centre))
    }

    /// What would become of the curve under the pointer, and what would be split off on that side of it.
    fn mark_edge(&self, mark: &mut Highlight, curve: CurveId) {
        let is_split = self.tools.kind() == ToolKind::Split;
        let Some(is_soft) = would_smooth(&self.document, curve) else { return };
        let closed = self.scene.curve(curve).is_some_and(|span| span.closed);
        let places = self.scene.samples(curve).collect();
        mark.edges.push(SharpOrSoft { places, closed, is_soft: is_soft && !is_split });
        let below = self.hand.cursor.filter(|_| is_split).and_then(|at| self.below(at));
        if let Some(Hit::Surface { id, triangle, .. }) = below {
            let part = side_of(&self.scene, id, triangle, curve);
            mark.skins.extend(part.map(|part| self.adrift(&part)));
        }
    }

    /// The part of a surface that a trim would keep; all of it while that is not known.
    pub(crate) fn mark_kept(&self, mark: &mut Highlight, place: Place) {
        let hit = match mark.hover {
            Some(Hit::Surface { id, at, triangle, .. }) if id == place.surface => Some((triangle, at)),
            _ => self.scene.hit_near(place.surface, place.at).and_then(|hit| match hit {
                Hit::Surface { triangle, .. } => Some((triangle, place.at)),
                _ => None,
            }),
        };
        match hit.and_then(|hit| part_at(&self.scene, place.surface, hit, &mark.sketch)) {
            Some(facets) => mark.skins.push(Skin { facets, is_refused: false }),
            None => mark.tinted.push(Tinted::Surface(place.surface)),
        }
    }
}
