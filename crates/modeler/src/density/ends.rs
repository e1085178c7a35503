//! Finer edges around the ends of curves inside a surface.
//!
//! A plate that is held along a line bends without bound at the line's end, of a curve or of a slit: its deflection goes as `r^(3/2)` there
//! and its bending as `r^(-1/2)` (Williams 1951, "Surface stress singularities resulting from various boundary conditions in
//! angular corners of plates under bending"). On a mesh of even density the energy is then exact to the first order only, since
//! `∫ h² (∂L/∂r)² dA = ∫ h² r⁻³ r dr` begins at an edge's length. With edges that grow as the root of the distance, `h² ~ r`,
//! it is of the second order but for a logarithm (Babuška, Kellogg and Pitkäranta 1979, "Direct and inverse error estimates for
//! finite elements with mesh refinements", for the general case).
//!
//! The law `h = h₀ √(r/R)` ends at the edge that it gives itself, `h₀²/R`. What holds the plate elsewhere limits how far the
//! bending goes on alike, so `R` is the distance to the nearest other line, or a part of the curve's length. A point that holds
//! a plate bends it as `log r` only, and needs nothing.
//!
//! Where curves meet, the widest gap between them counts: one that goes on as another bends nothing, and two that come back
//! beside each other are an end. All this depends on places of controls alone, not on the mesh, so that nothing rings.

use crate::model::Model;
use crate::shape::SurfaceShape;
use core::f64::consts::PI;
use ductile_mesh::VertexId;

/// Part of the length of a curve that edges are graded over at its ends.
const REACH: f64 = 0.25;
/// Edges at an end are no shorter than this part of those around.
const LEAST: f64 = 0.1;
/// The widest gap between the lines through a vertex at which nothing is graded, and the one from which on all is: between a curve
/// that goes on and one that ends.
const GOES_ON: f64 = 1.2 * PI;
const ENDS: f64 = 1.7 * PI;

/// The end of a curve inside a surface.
struct End {
    vertex: VertexId,
    /// How much it is one, from 0 for a curve that goes on as another to 1.
    share: f64,
    /// How far lengths are graded at most.
    reach: f64,
    /// Whether the curve with this rank among the embeddings ends here.
    ends: Vec<bool>,
}

/// Whether any curve ends inside of a surface.
pub(super) fn has_any(model: &Model, shape: &SurfaceShape) -> bool {
    !all(model, shape).is_empty()
}

/// The longest edges around the ends of curves, where `field` is wanted for other reasons; elsewhere infinite.
pub(super) fn longest(field: &[f64], model: &Model, shape: &SurfaceShape) -> Vec<f64> {
    let mut longest = vec![f64::INFINITY; field.len()];
    for end in all(model, shape) {
        let (near, is_other) = (around(shape, &end), others(shape, &end));
        let own = field[end.vertex.index()];
        let away = near.iter().filter(|(v, _)| is_other[v.index()]).map(|(_, r)| *r);
        let reach = away.fold(end.reach, f64::min);
        let least = (own / reach).max(LEAST);
        for (v, r) in near {
            let part = (r / reach).sqrt().max(least);
            if part < 1.0 {
                let graded = field[v.index()] * (1.0 - end.share * (1.0 - part));
                longest[v.index()] = longest[v.index()].min(graded);
            }
        }
    }
    longest
}

/// The ends of curves inside of a surface, in the order of its embeddings.
fn all(model: &Model, shape: &SurfaceShape) -> Vec<End> {
    let mut ends: Vec<End> = Vec::new();
    for (rank, embedded) in shape.embeddings.iter().enumerate() {
        let Some(curve) = model.curves.get(&embedded.curve).filter(|curve| !curve.closed) else { continue };
        let length: f64 = curve.nodes.windows(2).map(|edge| edge[0].distance(edge[1])).sum();
        for vertex in [embedded.vertices.first(), embedded.vertices.last()].into_iter().flatten().copied() {
            let known = ends.iter().position(|end| end.vertex == vertex);
            let known = known.or_else(|| {
                let share = ((widest_gap(shape, vertex) - GOES_ON) / (ENDS - GOES_ON)).min(1.0);
                (share > 0.0).then(|| {
                    let none = vec![false; shape.embeddings.len()];
                    ends.push(End { vertex, share, reach: f64::INFINITY, ends: none });
                    ends.len() - 1
                })
            });
            if let Some(end) = known.and_then(|known| ends.get_mut(known)) {
                end.reach = end.reach.min(REACH * length);
                end.ends[rank] = true;
            }
        }
    }
    ends
}

/// The widest angle around a vertex between lines: curves through it, and the rim.
fn widest_gap(shape: &SurfaceShape, v: VertexId) -> f64 {
    let (mesh, at) = (&shape.mesh, shape.positions[v.index()]);
    let mut ring = Vec::new();
    let is_closed = mesh.ring(v, &mut ring);
    let is_line = |w: VertexId| mesh.edge_between(v, w).is_some_and(|e| mesh.is_source_edge(e));
    if is_closed {
        // From the first line on all the way round to it again.
        let first = ring.iter().position(|w| is_line(*w)).unwrap_or(0);
        ring.rotate_left(first);
        ring.push(ring[0]);
    }
    let (mut widest, mut gap) = (0.0_f64, 0.0);
    for pair in ring.windows(2) {
        let [one, other] = [pair[0], pair[1]].map(|w| shape.positions[w.index()] - at);
        gap += libm::atan2(one.cross(other).length(), one.dot(other));
        widest = widest.max(gap);
        if is_line(pair[1]) {
            gap = 0.0;
        }
    }
    widest
}

/// The vertices from which the straight way to an end is no longer than its reach, as far as they hang together, with that
/// distance.
fn around(shape: &SurfaceShape, end: &End) -> Vec<(VertexId, f64)> {
    let at = shape.positions[end.vertex.index()];
    let mut is_seen = vec![false; shape.mesh.vertex_slots()];
    is_seen[end.vertex.index()] = true;
    let mut near = vec![(end.vertex, 0.0)];
    let mut next = 0;
    while let Some((v, _)) = near.get(next).copied() {
        next += 1;
        for w in shape.mesh.neighbours(v) {
            let r = shape.positions[w.index()].distance(at);
            if !core::mem::replace(&mut is_seen[w.index()], true) && r < end.reach {
                near.push((w, r));
            }
        }
    }
    near
}

/// By vertex slot, whether it lies on a line that does not end at this end: a curve through or beside it, or a rim.
fn others(shape: &SurfaceShape, end: &End) -> Vec<bool> {
    let mesh = &shape.mesh;
    let mut is_other = vec![false; mesh.vertex_slots()];
    mesh.vertices().for_each(|v| is_other[v.index()] = mesh.is_boundary_vertex(v));
    // What a bank of a slit runs along is rim, too; so its own curves come before the others.
    for own in [true, false] {
        for (embedded, _) in shape.embeddings.iter().zip(&end.ends).filter(|(_, ends)| **ends == own) {
            embedded.vertices.iter().for_each(|v| is_other[v.index()] = !own);
        }
    }
    is_other
}

#[cfg(test)]
mod tests {
    use super::*;
    use ductile_spec::{
        Curve, CurveId, Document, Embedding, PointId, Skeleton, SkeletonVertex, Surface, SurfaceId,
    };
    use glam::{DVec3, dvec3};
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    const SPACING: f64 = 0.1;

    /// A square of width 4 with a straight curve inside, from (-1, 0) to `end`.
    fn square(end: DVec3) -> Model {
        let corners =
            [dvec3(2.0, 2.0, 0.0), dvec3(-2.0, 2.0, 0.0), dvec3(-2.0, -2.0, 0.0), dvec3(2.0, -2.0, 0.0)];
        let mut document = Document { spacing: Some(SPACING), ..Document::default() };
        let places = corners.into_iter().chain([dvec3(-1.0, 0.0, 0.0), end]);
        document.points.extend((1..).map(PointId).zip(places));
        // Four sides that meet in corners, and the curve.
        let sides = [[1, 2], [2, 3], [3, 4], [4, 1], [5, 6]];
        for (id, side) in (1..).map(CurveId).zip(sides) {
            document.curves.insert(id, Curve::new(side.map(PointId).to_vec(), false));
        }
        let triangles = vec![[0, 1, 4], [0, 4, 5], [1, 2, 4], [2, 3, 4], [3, 5, 4], [3, 0, 5]];
        let embedded =
            |(id, side): (CurveId, [u32; 2])| Embedding { curve: id, along: side.map(|v| v - 1).to_vec() };
        let curves = (1..).map(CurveId).zip(sides).map(embedded).collect();
        let vertices = (1..=6).map(|id| SkeletonVertex::Control(PointId(id))).collect();
        document.surfaces.insert(SurfaceId(1), Surface::new(Skeleton { vertices, triangles, curves }));
        Model::from_document(document).unwrap()
    }

    /// Every vertex with the longest edge wanted there.
    fn lengths(model: &Model) -> Vec<(DVec3, f64)> {
        let shape = &model.surfaces[&SurfaceId(1)];
        let longest = longest(&vec![SPACING; shape.mesh.vertex_slots()], model, shape);
        shape.mesh.vertices().map(|v| (shape.positions[v.index()], longest[v.index()])).collect()
    }

    #[test]
    fn lengths_grow_as_the_root_of_the_distance_from_both_ends() {
        let model = square(dvec3(1.0, 0.0, 0.0));
        let mut graded = 0;
        for (at, longest) in lengths(&model) {
            // The curve is 2 long, and the sides are farther away than a quarter of that.
            let r = dvec3(at.x.abs() - 1.0, at.y, at.z).length();
            let wanted = if r < 0.5 { SPACING * (r / 0.5).sqrt().max(SPACING / 0.5) } else { f64::INFINITY };
            let is_at_the_reach = (r - 0.5).abs() < 1e-9;
            assert!(
                longest == wanted || (longest / wanted - 1.0).abs() < 1e-12 || is_at_the_reach,
                "{at}: {longest}, not {wanted}"
            );
            graded += usize::from(r < 0.5);
        }
        assert!(graded > 100, "{graded}");
        let shape = &model.surfaces[&SurfaceId(1)];
        assert_eq!(all(&model, shape).len(), 2, "the corners of the square are none");
    }

    #[test]
    fn another_line_nearby_leaves_less_room() {
        // A tenth of the square's width is left between the end and the side.
        let model = square(dvec3(1.6, 0.0, 0.0));
        let shortest = |end: f64| {
            let near =
                lengths(&model).into_iter().filter(move |(at, _)| at.distance(dvec3(end, 0.0, 0.0)) < 1e-9);
            near.map(|(_, longest)| longest).fold(f64::INFINITY, f64::min)
        };
        let expected = |reach: f64| SPACING * SPACING / reach;
        assert!((shortest(1.6) / expected(0.4) - 1.0).abs() < 0.02, "{}", shortest(1.6));
        assert!((shortest(-1.0) / expected(0.65) - 1.0).abs() < 1e-9, "{}", shortest(-1.0));
    }

    #[test]
    fn gaps_are_angles_between_lines() {
        let model = square(dvec3(1.0, 0.0, 0.0));
        let shape = &model.surfaces[&SurfaceId(1)];
        let gap = |place: DVec3| {
            let v =
                shape.mesh.vertices().find(|v| shape.positions[v.index()].distance(place) < 1e-9).unwrap();
            widest_gap(shape, v)
        };
        assert!((gap(dvec3(1.0, 0.0, 0.0)) - 2.0 * PI).abs() < 1e-9);
        assert!((gap(dvec3(2.0, 2.0, 0.0)) - 0.5 * PI).abs() < 1e-9);
        // Inside a curve both sides are half a turn.
        let inside = shape.embeddings[4].vertices[3];
        assert!((widest_gap(shape, inside) - PI).abs() < 1e-9);
    }
}
