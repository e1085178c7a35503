//! From a document to shapes: the skeleton is cut along its curves' samples and refined to the spacing
//! ("rehydrated"). The result is the linear skin over the skeleton, which thesis section 7.1.3 found to be
//! a good start; what a document says is grown from several such skins ([`crate::growth`]), and the relaxer does the rest.

use crate::bound::{BoundCurve, Motion};
use crate::density::{self, Along};
use crate::error::ModelError;
use crate::growth::{Beginning, Ground, Laying, Start};
use crate::maintain::{self, FEWEST_EDGES};
use crate::model::{Model, NODE_BUDGET};
use crate::patch::led_nodes;
use crate::shape::{CurveShape, EmbeddedCurve, Pin, SurfaceShape};
use ductile_mesh::{Mesh, SourceTag, VertexId, measure, propagate_orientation};
use ductile_spec::{CurveId, Document, Embedding, PointId, Skeleton, SkeletonVertex, Surface, SurfaceId};
use glam::DVec3;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Steps that a new curve may take to come to rest.
const CURVE_STEPS: usize = 80;
/// Below this part of the largest coordinate a shape has no extent.
const LEAST_EXTENT: f64 = 1e-9;

/// Nodes of a regular mesh for each square of its edge length: 2 / √3.
pub(crate) const NODES_FOR_A_SQUARE: f64 = 1.155;

/// How fine a surface is to be.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Fineness {
    /// Length of its edges.
    pub(crate) spacing: f64,
    /// Whether the document asks for other lengths somewhere.
    pub(crate) is_graded: bool,
    /// Nodes that it may not need more than.
    pub(crate) most_nodes: usize,
}

/// Samples a curve of the document and brings it to rest.
pub(crate) fn build_curve(
    document: &Document,
    id: CurveId,
    spacings: &[f64],
    revision: u64,
) -> Result<CurveShape, ModelError> {
    let (corners, stretches) = curve_corners(document, id, spacings)?;
    let curve = document.curves.get(&id).ok_or(ModelError::NoCurve(id))?;
    let count = corners.len();
    let mut shape = CurveShape { nodes: Vec::new(), closed: curve.closed, controls: Vec::new(), revision };
    for k in 0..stretches {
        let (from, to) = (corners[k], corners[(k + 1) % count]);
        let edges = edges_of_stretch(document, id, k, (to - from).length() / spacings[k]);
        shape.controls.push((count_u32(shape.nodes.len()), curve.through[k]));
        let given =
            |i: usize| curve.tangents.get(&curve.through[i]).map(|direction| direction.normalize_or_zero());
        let tangent = |i: usize| given(i).unwrap_or_else(|| tangent(&corners, i, curve.closed));
        let (leaving, arriving) = (tangent(k), tangent((k + 1) % count));
        shape.nodes.extend((0..edges).map(|j| hermite(from, to, leaving, arriving, j as f64 / edges as f64)));
    }
    if !curve.closed {
        shape.controls.push((count_u32(shape.nodes.len()), curve.through[count - 1]));
        shape.nodes.push(corners[count - 1]);
    }
    if let Some(nodes) = led_nodes(document, id, &shape)? {
        shape.nodes = nodes;
        return Ok(shape);
    }
    let mut bound = BoundCurve::new(document, id, &shape)?;
    for round in 0..CURVE_STEPS {
        let (_, rests) = bound
            .relax(&mut shape.nodes, &Motion::default())
            .map_err(|reason| ModelError::Unsolvable { what: id.to_string(), reason })?;
        if rests && round > 3 {
            break;
        }
        if round % 3 == 2 {
            // Evenly within each stretch, however fine it is.
            maintain::spread(&mut shape, &Along::Even(1.0));
        }
    }
    Ok(shape)
}

/// The places that a curve runs through and the number of its stretches, if each can be sampled at its spacing.
fn curve_corners(
    document: &Document,
    id: CurveId,
    spacings: &[f64],
) -> Result<(Vec<DVec3>, usize), ModelError> {
    let curve = document.curves.get(&id).ok_or(ModelError::NoCurve(id))?;
    let at = |point: &PointId| document.points.get(point).copied().ok_or(ModelError::NoPoint(*point));
    let corners = curve.through.iter().map(at).collect::<Result<Vec<_>, _>>()?;
    let count = corners.len();
    let stretches = if curve.closed { count } else { count - 1 };
    let length = |k: usize| (corners[(k + 1) % count] - corners[k]).length();
    let finest = spacings.iter().copied().fold(f64::INFINITY, f64::min);
    check_budget(finest, (0..stretches).map(|k| length(k) / spacings[k]).sum(), NODE_BUDGET / 4)?;
    let is_empty = |k: usize| !has_extent(length(k), corners[k].abs().max_element());
    if (0..stretches).any(is_empty) {
        return Err(ModelError::NoExtent(id.to_string()));
    }
    Ok((corners, stretches))
}

/// Whether a length is one, among coordinates of a size.
pub(crate) fn has_extent(length: f64, size: f64) -> bool {
    length > LEAST_EXTENT * (1.0 + size)
}

/// Whether a document with sound topology could be opened: every stretch of a curve has an extent, every surface
/// an area, and both are within the budget. An act that only moves controls must leave such a document behind:
/// one that could not be opened again would be lost.
pub(crate) fn check_extents(model: &Model) -> Result<(), ModelError> {
    let document = &model.document;
    for id in document.curves.keys() {
        curve_corners(document, *id, &density::of_stretches(model, *id)?)?;
    }
    for (id, surface) in &document.surfaces {
        let positions = surface.skeleton.vertices.iter().map(|vertex| match vertex {
            SkeletonVertex::Free(at) => Ok(*at),
            SkeletonVertex::Control(point) => {
                document.points.get(point).copied().ok_or(ModelError::NoPoint(*point))
            }
        });
        let positions = positions.collect::<Result<Vec<_>, _>>()?;
        let corners = surface.skeleton.triangles.iter().map(|t| t.map(|v| positions[v as usize]));
        let area: f64 = corners.map(|[a, b, c]| 0.5 * (b - a).cross(c - a).length()).sum();
        check_area(*id, area, &positions, (model.spacing_of(*id), model.most_nodes()))?;
    }
    Ok(())
}

/// Whether a surface has an area, and one that can be meshed at a spacing.
fn check_area(
    id: SurfaceId,
    area: f64,
    positions: &[DVec3],
    (spacing, most_nodes): (f64, usize),
) -> Result<(), ModelError> {
    let largest = positions.iter().map(|p| p.abs().max_element()).fold(0.0, f64::max);
    let least = LEAST_EXTENT * (1.0 + largest);
    if area.is_nan() || area <= least * least {
        return Err(ModelError::NoExtent(id.to_string()));
    }
    check_budget(spacing, NODES_FOR_A_SQUARE * area / (spacing * spacing), most_nodes)
}

/// Edges of a stretch: as many as its length asks for, and no fewer than a skeleton's path has there.
fn edges_of_stretch(document: &Document, id: CurveId, stretch: usize, wanted: f64) -> usize {
    let mut edges = count_edges(wanted).max(FEWEST_EDGES);
    for skeleton in document.surfaces.values().map(|s| &s.skeleton) {
        for embedding in skeleton.curves.iter().filter(|e| e.curve == id) {
            edges =
                edges.max(chains(skeleton, &embedding.along).get(stretch).map_or(0, |chain| chain.len() - 1));
        }
    }
    edges
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "the budget was checked: small and positive"
)]
fn count_edges(wanted: f64) -> usize {
    wanted.ceil().clamp(1.0, NODE_BUDGET as f64) as usize
}

fn count_u32(n: usize) -> u32 {
    u32::try_from(n).unwrap_or(u32::MAX)
}

/// Direction of the first guess at a control point: along the chord of its neighbours.
fn tangent(corners: &[DVec3], i: usize, closed: bool) -> DVec3 {
    let n = corners.len();
    let before = if closed || i > 0 { corners[(i + n - 1) % n] } else { corners[i] };
    let after = if closed || i + 1 < n { corners[(i + 1) % n] } else { corners[i] };
    (after - before).normalize_or_zero()
}

/// A cubic with the given ends and directions, as long as its chord.
fn hermite(from: DVec3, to: DVec3, leaving: DVec3, arriving: DVec3, t: f64) -> DVec3 {
    let chord = (to - from).length();
    let (s, tt) = (1.0 - t, t * t);
    from * (s * s * (1.0 + 2.0 * t))
        + to * (tt * (3.0 - 2.0 * t))
        + (leaving * (s * s * t) - arriving * (tt * s)) * chord
}

/// Meshes a surface of the document over its curves as they are now.
pub(crate) fn build_surface(
    ground: &Ground<'_>,
    beginning: Beginning,
    fineness: Fineness,
    revision: u64,
) -> Result<SurfaceShape, ModelError> {
    let Ground { document, curves, id } = *ground;
    let surface = document.surfaces.get(&id).ok_or(ModelError::NoSurface(id))?;
    let skeleton = &surface.skeleton;
    let mut mesh = Mesh::from_triangles(skeleton.vertices.len(), &skeleton.triangles)
        .map_err(|reason| ModelError::NotASurface { surface: id, reason })?;
    propagate_orientation(&mut mesh);
    let mut positions = Vec::with_capacity(skeleton.vertices.len());
    for (index, vertex) in skeleton.vertices.iter().enumerate() {
        positions.push(match vertex {
            SkeletonVertex::Free(at) => *at,
            SkeletonVertex::Control(point) => {
                mesh.set_vertex_source(VertexId::from_index(index), Some(SourceTag(point.0)));
                *document.points.get(point).ok_or(ModelError::NoPoint(*point))?
            }
        });
    }
    let Fineness { spacing, is_graded, most_nodes } = fineness;
    check_area(id, measure::total_area(&mesh, &positions), &positions, (spacing, most_nodes))?;
    for embedding in &skeleton.curves {
        let curve = curves.get(&embedding.curve).ok_or(ModelError::NoCurve(embedding.curve))?;
        mark_path(&mut mesh, embedding, curve.closed);
    }
    let (embeddings, pins, wanted) = (Vec::new(), pins(skeleton), Vec::new());
    let bare = SurfaceShape { mesh, positions, embeddings, pins, spacing, wanted, age: 0, revision };
    let graded = is_graded.then_some(surface);
    let skin = |start: Start| {
        let mut shape = bare.clone();
        start.turn(&mut shape);
        embed_curves(&mut shape, ground, start, graded).map(|()| shape)
    };
    match beginning {
        Beginning::Skin => ground.plain(skin),
        Beginning::Grown => ground.grown(skin),
    }
}

/// The control points of a skeleton that lie on none of its curves.
fn pins(skeleton: &Skeleton) -> Vec<Pin> {
    let is_on_curve = |index: u32| skeleton.curves.iter().any(|e| e.along.contains(&index));
    let pin = |(index, vertex): (u32, &SkeletonVertex)| match vertex {
        SkeletonVertex::Control(point) if !is_on_curve(index) => {
            Some(Pin { vertex: VertexId::from_index(index as usize), point: *point })
        }
        _ => None,
    };
    (0_u32..).zip(&skeleton.vertices).filter_map(pin).collect()
}

fn check_budget(spacing: f64, nodes: f64, limit: usize) -> Result<(), ModelError> {
    if nodes <= limit as f64 {
        return Ok(());
    }
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "only shown to the user; saturates"
    )]
    Err(ModelError::TooFine { spacing, nodes: nodes as usize, limit })
}

/// A control curve on its way into a mesh: the samples that have a vertex already, in order.
struct Path {
    curve: CurveId,
    placed: Vec<(usize, VertexId)>,
}

/// Cuts the skeleton's edges at the samples of its curves, from coarse to fine, and refines the inside along
/// with it. All samples at once would make fans of needles that no flip can mend.
fn embed_curves(
    shape: &mut SurfaceShape,
    ground: &Ground<'_>,
    start: Start,
    graded: Option<&Surface>,
) -> Result<(), ModelError> {
    let (curves, laying) = (ground.curves, start.laying);
    let skeleton =
        &ground.document.surfaces.get(&ground.id).ok_or(ModelError::NoSurface(ground.id))?.skeleton;
    let mut paths = Vec::with_capacity(skeleton.curves.len());
    for embedding in &skeleton.curves {
        let curve = curves.get(&embedding.curve).ok_or(ModelError::NoCurve(embedding.curve))?;
        paths.push(lay_path(shape, skeleton, curve, embedding, laying));
    }
    let longest = |path: &Path| path.placed.windows(2).map(|w| w[1].0 - w[0].0).max().unwrap_or(1);
    let mut stride = paths.iter().map(longest).max().unwrap_or(1).next_power_of_two();
    while stride >= 1 {
        for path in &mut paths {
            if let Some(curve) = curves.get(&path.curve) {
                cut_path(shape, curve, path, stride, laying);
            }
        }
        shape.embeddings = paths.iter().map(|path| embedded(path, curves)).collect();
        if let Some(surface) = graded {
            density::begin(shape, surface, stride);
        }
        maintain::refine(shape, stride);
        start.grow(ground, shape, stride);
        stride /= 2;
    }
    Ok(())
}

/// A curve as far as it is placed.
fn embedded(path: &Path, curves: &BTreeMap<CurveId, Arc<CurveShape>>) -> EmbeddedCurve {
    // A closed path ends with its first vertex again. It begins at a control, which is not the curve's first sample any
    // more when another control was there once and was released.
    let closed = curves.get(&path.curve).filter(|curve| curve.closed);
    let placed = &path.placed[..path.placed.len() - usize::from(closed.is_some())];
    let turned = closed.and_then(|curve| placed.iter().position(|(sample, _)| *sample >= curve.nodes.len()));
    let mut vertices: Vec<VertexId> = placed.iter().map(|(_, v)| *v).collect();
    vertices.rotate_left(turned.unwrap_or(0));
    EmbeddedCurve { curve: path.curve, vertices }
}

/// Marks the skeleton's edges on a curve.
pub(crate) fn mark_path(mesh: &mut Mesh, embedding: &Embedding, is_closed: bool) {
    let along: Vec<VertexId> = embedding.along.iter().map(|v| VertexId::from_index(*v as usize)).collect();
    let last = along.last().filter(|_| is_closed);
    for (from, to) in
        last.into_iter().chain(&along).zip(if is_closed { &along[..] } else { along.get(1..).unwrap_or(&[]) })
    {
        if let Some(edge) = mesh.edge_between(*from, *to) {
            mesh.set_edge_source(edge, Some(SourceTag(embedding.curve.0)));
        }
    }
}

/// Gives each vertex of the skeleton on a curve a sample. A closed path ends with its first vertex again, one turn later.
fn lay_path(
    shape: &mut SurfaceShape,
    skeleton: &Skeleton,
    curve: &CurveShape,
    embedding: &Embedding,
    laying: Laying,
) -> Path {
    let mut placed = Vec::new();
    let mut end = None;
    for (chain, (first, count)) in chains(skeleton, &embedding.along).iter().zip(curve.stretches()) {
        let vertex = |j: usize| VertexId::from_index(chain[j] as usize);
        for j in 0..chain.len() - 1 {
            // Path vertex j of the chain takes the sample at its share of the stretch.
            let sample = first + j * count / (chain.len() - 1);
            if laying == Laying::OnCurves {
                shape.positions[vertex(j).index()] = curve.nodes[sample % curve.nodes.len()];
            }
            placed.push((sample, vertex(j)));
        }
        end = Some((first + count, vertex(chain.len() - 1)));
    }
    placed.extend(end);
    Path { curve: embedding.curve, placed }
}

/// Halves every gap of a path that spans more than `stride` samples.
fn cut_path(shape: &mut SurfaceShape, curve: &CurveShape, path: &mut Path, stride: usize, laying: Laying) {
    let mut k = 0;
    while k + 1 < path.placed.len() {
        let ((low, from), (high, to)) = (path.placed[k], path.placed[k + 1]);
        let edge = shape.mesh.edge_between(from, to);
        let (true, Some(edge)) = (high - low > stride, edge) else {
            k += 1;
            continue;
        };
        let sample = low.midpoint(high);
        let vertex = shape.mesh.split_edge(edge);
        shape.positions.resize(shape.mesh.vertex_slots(), DVec3::ZERO);
        shape.positions[vertex.index()] = match laying {
            Laying::OnCurves => curve.nodes[sample % curve.nodes.len()],
            Laying::OnEdges => {
                let part = (sample - low) as f64 / (high - low) as f64;
                shape.positions[from.index()].lerp(shape.positions[to.index()], part)
            }
        };
        path.placed.insert(k + 1, (sample, vertex));
    }
}

/// The path of a curve in a skeleton, cut at its control points: one chain of vertices for each stretch.
fn chains(skeleton: &Skeleton, along: &[u32]) -> Vec<Vec<u32>> {
    let is_control = |v: &u32| matches!(skeleton.vertices.get(*v as usize), Some(SkeletonVertex::Control(_)));
    let mut chains: Vec<Vec<u32>> = Vec::new();
    for v in along {
        if let Some(chain) = chains.last_mut() {
            chain.push(*v);
        }
        if is_control(v) {
            chains.push(vec![*v]);
        }
    }
    // The last chain closes the curve, or is the lone end of an open one.
    if let (Some(chain), Some(first)) = (chains.last_mut(), along.first()) {
        chain.push(*first);
    }
    chains
}
