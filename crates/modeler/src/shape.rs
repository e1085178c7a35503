//! The current approximation of what the document specifies: sampled curves and meshed surfaces.
//!
//! Shapes hold no solver state, so they can be shared, kept for undo and compared. A `revision` names a
//! connectivity: solvers and frames that were made for another revision are out of date.

use ductile_mesh::{Mesh, VertexId};
use ductile_spec::{CurveId, PointId};
use glam::DVec3;
use std::sync::Arc;

/// A sampled fair curve.
#[derive(Clone, Debug)]
pub struct CurveShape {
    /// The samples, in order; a closed curve does not repeat its first.
    pub nodes: Vec<DVec3>,
    /// Whether the last sample joins the first.
    pub closed: bool,
    /// Which sample lies on which control point, in the order of the curve; indices ascend.
    pub controls: Vec<(u32, PointId)>,
    /// Names this sampling.
    pub revision: u64,
}

/// A meshed surface.
#[derive(Clone, Debug)]
pub struct SurfaceShape {
    /// Connectivity; control points are tagged with their `PointId`, curve edges with their `CurveId`.
    pub mesh: Mesh,
    /// Positions by vertex slot.
    pub positions: Vec<DVec3>,
    /// The control curves that it follows, vertex by sample.
    pub embeddings: Vec<EmbeddedCurve>,
    /// The control points that it passes through apart from curves.
    pub pins: Vec<Pin>,
    /// Target edge length, where `wanted` says nothing else.
    pub spacing: f64,
    /// Target edge length by vertex slot, where it is not the same everywhere; else empty.
    pub wanted: Vec<f64>,
    /// Steps that it has taken since it was built from a skeleton, counted up to four: then it has lost its corners. What was
    /// grown out of sight until its mesh resolves it has lost them, too.
    pub age: u8,
    /// Names this connectivity.
    pub revision: u64,
}

/// Steps in which a shape that was built from a skeleton loses its corners. Until then it minimises bending where it is to
/// be `fair`: what changes of curvature there are between the triangles of a skeleton says nothing of the shape, and
/// to even them out may end in a crumple.
pub(crate) const GROWN: u8 = 4;

/// A control curve in a surface (shadowing, thesis section 7.3.3): as many vertices as the curve has samples.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct EmbeddedCurve {
    /// The curve that is followed.
    pub curve: CurveId,
    /// The vertex that follows each sample.
    pub vertices: Vec<VertexId>,
}

/// A control point of a surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Pin {
    /// The vertex.
    pub vertex: VertexId,
    /// The control point that it follows.
    pub point: PointId,
}

impl CurveShape {
    /// How many edges the curve has.
    #[must_use]
    pub fn edge_count(&self) -> usize {
        if self.closed { self.nodes.len() } else { self.nodes.len().saturating_sub(1) }
    }

    /// Ends of an edge: sample `edge` and the one after it.
    #[must_use]
    pub fn edge(&self, edge: usize) -> (usize, usize) {
        (edge, (edge + 1) % self.nodes.len())
    }

    /// The sample that lies on a control point.
    #[must_use]
    pub fn sample_of(&self, point: PointId) -> Option<usize> {
        self.controls.iter().find(|(_, id)| *id == point).map(|(sample, _)| *sample as usize)
    }

    /// Whether a sample lies on a control point.
    #[must_use]
    pub fn is_control(&self, sample: usize) -> bool {
        self.controls.iter().any(|(index, _)| *index as usize == sample)
    }

    /// The edges between one control point and the next, for each such stretch: first edge and how many.
    #[must_use]
    pub fn stretches(&self) -> Vec<(usize, usize)> {
        let count = self.nodes.len();
        let controls: Vec<usize> = self.controls.iter().map(|(index, _)| *index as usize).collect();
        let mut stretches: Vec<(usize, usize)> = controls.windows(2).map(|w| (w[0], w[1] - w[0])).collect();
        if let (true, Some(first), Some(last)) = (self.closed, controls.first(), controls.last()) {
            stretches.push((*last, first + count - last));
        }
        stretches
    }

    /// Edge and parameter in [0, 1] of the place nearest to a given one.
    #[must_use]
    pub fn nearest(&self, at: DVec3) -> Option<(usize, f64)> {
        let mut best: Option<(f64, usize, f64)> = None;
        for edge in 0..self.edge_count() {
            let (a, b) = self.edge(edge);
            let (p, q) = (self.nodes[a], self.nodes[b]);
            let squared = (q - p).length_squared();
            let t = if squared > 0.0 { ((at - p).dot(q - p) / squared).clamp(0.0, 1.0) } else { 0.0 };
            let distance = (p.lerp(q, t) - at).length_squared();
            if best.is_none_or(|(least, ..)| distance < least) {
                best = Some((distance, edge, t));
            }
        }
        best.map(|(_, edge, t)| (edge, t))
    }

    /// The place of the fair curve at a parameter in [0, 1] of an edge: a cubic between the samples, whose second
    /// derivative runs linearly from the one end's to the other's. At the ends of an open curve it is zero.
    #[must_use]
    pub fn place(&self, edge: usize, t: f64) -> DVec3 {
        let (a, b) = self.edge(edge);
        let (s, squared) = (1.0 - t, (self.nodes[b] - self.nodes[a]).length_squared());
        // x'' = (s A + t B), integrated twice with both ends met.
        let rise = self.second_derivative(a) * (1.0 + s) + self.second_derivative(b) * (1.0 + t);
        self.nodes[a].lerp(self.nodes[b], t) - rise * (squared * s * t / 6.0)
    }

    /// Second derivative by arc length at a sample, from the chords to both neighbours.
    pub(crate) fn second_derivative(&self, sample: usize) -> DVec3 {
        let count = self.nodes.len();
        if !self.closed && (sample == 0 || sample + 1 == count) {
            return DVec3::ZERO;
        }
        let before = self.nodes[sample] - self.nodes[(sample + count - 1) % count];
        let after = self.nodes[(sample + 1) % count] - self.nodes[sample];
        let (l, r) = (before.length(), after.length());
        let derivative = (after / r - before / l) * (2.0 / (l + r));
        if derivative.is_finite() { derivative } else { DVec3::ZERO }
    }
}

impl SurfaceShape {
    /// Gives vertices that the mesh has got a place (the origin, until they are put somewhere) and a wanted length.
    pub(crate) fn make_room(&mut self) {
        let slots = self.mesh.vertex_slots();
        self.positions.resize(slots, DVec3::ZERO);
        if !self.wanted.is_empty() {
            self.wanted.resize(slots, self.spacing);
        }
    }

    /// The vertices whose positions are given by controls, with the control that gives them.
    pub fn controlled(&self) -> impl Iterator<Item = VertexId> + '_ {
        let on_curves = self.embeddings.iter().flat_map(|e| e.vertices.iter().copied());
        on_curves.chain(self.pins.iter().map(|pin| pin.vertex))
    }

    /// Target edge length at a vertex.
    #[must_use]
    pub fn wanted_at(&self, v: VertexId) -> f64 {
        self.wanted.get(v.index()).copied().unwrap_or(self.spacing)
    }

    /// The longest edge that is wanted anywhere.
    #[must_use]
    pub fn longest_wanted(&self) -> f64 {
        let all = self.mesh.vertices().filter_map(|v| self.wanted.get(v.index()).copied());
        all.reduce(f64::max).unwrap_or(self.spacing)
    }

    /// Largest distance of a vertex from the centre of their box.
    #[must_use]
    pub fn radius(&self) -> f64 {
        let mut low = DVec3::INFINITY;
        let mut high = DVec3::NEG_INFINITY;
        for v in self.mesh.vertices() {
            low = low.min(self.positions[v.index()]);
            high = high.max(self.positions[v.index()]);
        }
        if low.x > high.x { 0.0 } else { (high - low).length() * 0.5 }
    }

    /// Rough size in memory.
    #[must_use]
    pub fn bytes(&self) -> usize {
        24 * self.positions.len()
            + 8 * self.wanted.len()
            + 16 * self.mesh.vertex_slots()
            + 24 * self.mesh.edge_slots()
            + 40 * self.mesh.face_slots()
    }
}

/// A change to a shared shape copies it first if an undo entry still holds it.
pub(crate) fn edit<T: Clone>(shape: &mut Arc<T>) -> &mut T {
    Arc::make_mut(shape)
}

#[cfg(test)]
mod tests {
    use super::*;
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    /// A circle of radius 1 with so many samples, evenly spread.
    fn circle(samples: u32, closed: bool) -> CurveShape {
        let turn = core::f64::consts::TAU / f64::from(samples);
        let place = |k: u32| DVec3::new(libm::cos(f64::from(k) * turn), libm::sin(f64::from(k) * turn), 0.0);
        CurveShape { nodes: (0..samples).map(place).collect(), closed, controls: Vec::new(), revision: 0 }
    }

    /// The largest distance from the circle of places between the samples.
    fn error(shape: &CurveShape) -> f64 {
        let places =
            (1..shape.edge_count() - 1).flat_map(|e| [0.0, 0.25, 0.5, 0.9].map(|t| shape.place(e, t)));
        places.map(|place| (place.length() - 1.0).abs()).fold(0.0, f64::max)
    }

    #[test]
    fn places_between_the_samples_of_a_circle_are_on_it_to_fourth_order() {
        let [coarse, fine] = [40, 80].map(|samples| error(&circle(samples, true)));
        assert!(fine < coarse / 15.0, "{coarse} and {fine}");
        // The chord itself is off by h²/8.
        assert!(coarse < 0.02 * (0.157 * 0.157 / 8.0), "{coarse}");
    }

    #[test]
    fn samples_are_met_and_an_open_curve_ends_straight() {
        let shape = circle(30, false);
        for edge in 0..shape.edge_count() {
            let (a, b) = shape.edge(edge);
            assert_eq!(shape.place(edge, 0.0), shape.nodes[a]);
            assert_eq!(shape.place(edge, 1.0), shape.nodes[b]);
        }
        let line =
            CurveShape { nodes: vec![DVec3::ZERO, DVec3::X], closed: false, controls: vec![], revision: 0 };
        assert_eq!(line.place(0, 0.3), DVec3::X * 0.3);
    }

    #[test]
    fn coinciding_samples_do_no_harm() {
        let shape = CurveShape { nodes: vec![DVec3::ONE; 4], closed: true, controls: vec![], revision: 0 };
        assert_eq!(shape.place(2, 0.5), DVec3::ONE);
    }
}
