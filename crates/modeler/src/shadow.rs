//! Shadowing (thesis section 7.3.3): an embedded curve follows its control curve node for node, so a
//! refinement of the curve is at once a refinement of every surface that follows it.

use crate::error::ModelError;
use crate::model::Model;
use crate::shape::edit;
use ductile_mesh::VertexId;
use ductile_mesh::remesh::Limits;
use ductile_spec::CurveId;
use glam::DVec3;

/// Puts a new sample into an edge of a curve and a new vertex into every surface that follows it.
/// Returns the index of the sample.
///
/// # Errors
/// Before anything has changed: [`ModelError::TornOff`] if a surface has no edge where the curve has one,
/// [`ModelError::Crowded`] if too many triangles meet beside it.
pub(crate) fn insert_sample(
    model: &mut Model,
    id: CurveId,
    edge: usize,
    at: DVec3,
) -> Result<usize, ModelError> {
    let (a, b) = model.curves.get(&id).ok_or(ModelError::NoCurve(id))?.edge(edge);
    for surface in model.document.surfaces_on(id) {
        let Some(shape) = model.surfaces.get(&surface) else { continue };
        for followed in shape.embeddings.iter().filter(|followed| followed.curve == id) {
            let ends = followed.vertices.get(a).zip(followed.vertices.get(b));
            let edge = ends.and_then(|(from, to)| shape.mesh.edge_between(*from, *to));
            let edge = edge.ok_or(ModelError::TornOff { curve: id, surface })?;
            // The split gives the corners opposite one neighbour more.
            let (c, d) = shape.mesh.edge_opposites(edge);
            let is_full = |v: VertexId| shape.mesh.valence(v) >= Limits::default().most_neighbours;
            if is_full(c) || d.is_some_and(is_full) {
                return Err(ModelError::Crowded { curve: id, surface });
            }
        }
    }
    let revision = model.next_revision();
    let shape = edit(model.curves.get_mut(&id).ok_or(ModelError::NoCurve(id))?);
    let sample = edge + 1;
    shape.nodes.insert(sample, at);
    for (index, _) in &mut shape.controls {
        if *index as usize >= sample {
            *index += 1;
        }
    }
    shape.revision = revision;
    for surface in model.document.surfaces_on(id).collect::<Vec<_>>() {
        let revision = model.next_revision();
        let Some(shape) = model.surfaces.get_mut(&surface).map(edit) else { continue };
        for k in 0..shape.embeddings.len() {
            if shape.embeddings[k].curve != id {
                continue;
            }
            let (from, to) = (shape.embeddings[k].vertices[a], shape.embeddings[k].vertices[b]);
            let Some(between) = shape.mesh.edge_between(from, to) else { continue };
            let vertex = shape.mesh.split_edge(between);
            shape.positions.resize(shape.mesh.vertex_slots(), at);
            shape.positions[vertex.index()] =
                shape.positions[from.index()].midpoint(shape.positions[to.index()]);
            if !shape.wanted.is_empty() {
                let middle = shape.wanted_at(from).midpoint(shape.wanted_at(to));
                shape.wanted.resize(shape.mesh.vertex_slots(), middle);
                shape.wanted[vertex.index()] = middle;
            }
            shape.embeddings[k].vertices.insert(sample, vertex);
        }
        shape.revision = revision;
    }
    Ok(sample)
}

/// Takes a sample out of a curve and its vertices out of every surface that follows it. Returns whether
/// that was possible; if not, nothing has changed.
pub(crate) fn remove_sample(model: &mut Model, id: CurveId, sample: usize) -> bool {
    let Some(shape) = model.curves.get(&id) else { return false };
    let count = shape.nodes.len();
    if count <= 4 || shape.is_control(sample) || (!shape.closed && (sample == 0 || sample + 1 == count)) {
        return false;
    }
    let before = (sample + count - 1) % count;
    let surfaces: Vec<_> = model.document.surfaces_on(id).collect();
    let possible = surfaces.iter().all(|surface| {
        model.surfaces.get(surface).is_some_and(|shape| {
            let mut on_curve = shape.embeddings.iter().filter(|e| e.curve == id);
            on_curve.all(|e| {
                let (gone, kept) = (e.vertices[sample], e.vertices[before]);
                // Of the neighbours of both, the two are none any more, and the two between them count once.
                let ring = shape.mesh.valence(gone) + shape.mesh.valence(kept) - 4;
                ring <= Limits::default().most_neighbours && shape.mesh.can_collapse(gone, kept).is_ok()
            })
        })
    });
    if !possible {
        return false;
    }
    let revision = model.next_revision();
    if let Some(shape) = model.curves.get_mut(&id).map(edit) {
        shape.nodes.remove(sample);
        for (index, _) in &mut shape.controls {
            if *index as usize > sample {
                *index -= 1;
            }
        }
        shape.revision = revision;
    }
    for surface in surfaces {
        let revision = model.next_revision();
        let Some(shape) = model.surfaces.get_mut(&surface).map(edit) else { continue };
        for k in 0..shape.embeddings.len() {
            if shape.embeddings[k].curve == id {
                let (gone, kept) =
                    (shape.embeddings[k].vertices[sample], shape.embeddings[k].vertices[before]);
                shape.mesh.collapse(gone, kept);
                shape.embeddings[k].vertices.remove(sample);
            }
        }
        shape.revision = revision;
    }
    true
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::example::example;
    use ductile_spec::{Example, SurfaceId};
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    #[test]
    fn a_curve_that_its_surface_has_lost_takes_no_sample_and_nothing_changes() {
        let (curve, surface) = (CurveId(1), SurfaceId(1));
        let mut model = Model::from_document(example(Example::Disc)).unwrap();
        let whole = insert_sample(&mut model, curve, 0, DVec3::X);
        assert_eq!(whole, Ok(1));
        let shape = edit(model.surfaces.get_mut(&surface).unwrap());
        let followed = &mut shape.embeddings[0].vertices;
        let half = followed.len() / 2;
        followed.swap(1, half);
        let (nodes, vertices) =
            (model.curves[&curve].nodes.clone(), model.surfaces[&surface].mesh.vertex_count());
        assert_eq!(
            insert_sample(&mut model, curve, 0, DVec3::X),
            Err(ModelError::TornOff { curve, surface })
        );
        assert_eq!(model.curves[&curve].nodes, nodes);
        assert_eq!(model.surfaces[&surface].mesh.vertex_count(), vertices);
    }
}
