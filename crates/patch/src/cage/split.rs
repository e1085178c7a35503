//! From polygons to quads: the central split, which divides every face once into a quad at each of its corners.
//!
//! Source: P. Salvi, *Polyhedral design with blended n-sided interpolants*, section 1, "retaining all original vertices". The
//! paper's own program does a true Catmull-Clark step instead, which moves them; both are here, and a third rule that keeps
//! the vertices and is rounder than straight lines.
//!
//! New vertices stand after the old ones: one for each edge in order of first sight, then one for each face. Corner `i` of a
//! face gives the quad `[corner i, edge point i, face point, edge point i-1]`.

use super::links::{Links, name};
use glam::DVec3;

/// Where the split puts its vertices.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum Split {
    /// No split: every face must be a quad.
    None,
    /// Edge points in the middle, face points at the centroid: the surface stays near the polyhedron.
    #[default]
    Linear,
    /// A Catmull-Clark step that is moved back onto the old vertices: they are kept, and the shape is rounder.
    Offset,
    /// A Catmull-Clark step: the roundest, but the surface misses the vertices of the cage.
    CatmullClark,
}

/// The connectivity of the quads and what they came from.
#[derive(Clone, Debug)]
pub(super) struct Quads {
    pub(super) corners: Vec<[u32; 4]>,
    /// For each face of the cage its first quad; as long as there are faces, and one more.
    pub(super) first: Vec<u32>,
}

/// Divides every face. `edge_of` gives the number of the edge of each half-edge.
pub(super) fn quads(links: &Links, edge_of: &[u32]) -> Quads {
    let vertices = links.vertex_count();
    let edge_point = |h: usize| name(vertices) + edge_of[h];
    let edges = links.edges().count();
    let (mut corners, mut first) = (Vec::with_capacity(links.half_edge_count()), vec![0]);
    for face in 0..links.face_count() {
        let face_point = name(vertices + edges + face);
        corners.extend(
            links
                .half_edges(face)
                .map(|h| [name(links.origin(h)), edge_point(h), face_point, edge_point(links.before(h))]),
        );
        first.push(name(corners.len()));
    }
    Quads { corners, first }
}

/// The number of the edge of each half-edge: edges are numbered in order of first sight.
pub(super) fn number_edges(links: &Links) -> Vec<u32> {
    let mut numbers = vec![0; links.half_edge_count()];
    for (number, h) in (0..).zip(links.edges()) {
        numbers[h] = number;
        if let Some(twin) = links.twin(h) {
            numbers[twin] = number;
        }
    }
    numbers
}

/// Positions of all vertices after the split. Linear in the old positions.
pub(super) fn positions(links: &Links, rule: Split, old: &[DVec3]) -> Vec<DVec3> {
    let middle = |h: usize| (old[links.origin(h)] + old[links.origin(links.after(h, 1))]) / 2.0;
    let centres: Vec<DVec3> = (0..links.face_count())
        .map(|face| mean(links.half_edges(face).map(|h| old[links.origin(h)])))
        .collect();
    let mut new = old.to_vec();
    if rule == Split::Linear {
        new.extend(links.edges().map(middle));
        new.extend(centres);
        return new;
    }
    let edges = links.edges().map(|h| match links.twin(h) {
        None => middle(h),
        Some(twin) => (middle(h) * 2.0 + centres[links.face(h)] + centres[links.face(twin)]) / 4.0,
    });
    new.extend(edges);
    new.extend_from_slice(&centres);
    let moved: Vec<DVec3> =
        (0..old.len()).map(|vertex| catmull_clark(links, old, &centres, vertex)).collect();
    if rule == Split::CatmullClark {
        new[..old.len()].copy_from_slice(&moved);
        return new;
    }
    // `offset`: everything moves back as the vertices do.
    let back: Vec<DVec3> = old.iter().zip(&moved).map(|(old, moved)| *old - *moved).collect();
    let faces_from = new.len() - centres.len();
    let (before, face_points) = new.split_at_mut(faces_from);
    let edge_points = &mut before[old.len()..];
    for (point, h) in edge_points.iter_mut().zip(links.edges()) {
        *point += (back[links.origin(h)] + back[links.origin(links.after(h, 1))]) / 2.0;
    }
    for (face, point) in face_points.iter_mut().enumerate() {
        *point += mean(links.half_edges(face).map(|h| back[links.origin(h)]));
    }
    new
}

/// Where a Catmull-Clark step moves an old vertex: `(F + 2R + (n-3)V)/n`, with R the mean of edge middles; along a boundary
/// (1/8, 3/4, 1/8); a vertex of one face stays.
fn catmull_clark(links: &Links, old: &[DVec3], centres: &[DVec3], vertex: usize) -> DVec3 {
    let own = old[vertex];
    let valence = links.valence(vertex);
    if links.is_boundary(vertex) {
        let fan: Vec<usize> = links.fan(vertex).collect();
        return match fan[..] {
            [first, .., last] => {
                let ends = old[links.origin(links.after(first, 1))] + old[links.origin(links.before(last))];
                ends / 8.0 + own * 0.75
            }
            _ => own,
        };
    }
    if valence == 0 {
        return own;
    }
    let faces = mean(links.fan(vertex).map(|h| centres[links.face(h)]));
    let edges = mean(links.fan(vertex).map(|h| (own + old[links.origin(links.after(h, 1))]) / 2.0));
    let n = valence as f64;
    (faces + edges * 2.0 + own * (n - 3.0)) / n
}

fn mean(points: impl Iterator<Item = DVec3>) -> DVec3 {
    let (sum, count) = points.fold((DVec3::ZERO, 0.0), |(sum, count), p| (sum + p, count + 1.0));
    sum / count
}
