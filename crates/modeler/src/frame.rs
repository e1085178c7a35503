//! What is drawn: the model in the layout of `ductile-spec`'s frame. This is the only place where f64
//! becomes f32.

use crate::bank;
use crate::displaced::{Displacer, Overlay};
use crate::model::Model;
use crate::region;
use crate::relax::Relaxer;
use crate::shape::SurfaceShape;
use ductile_mesh::Mesh;
use ductile_spec::{
    CurveId, CurveRole, CurveSpan, FootEntry, NO_REGION, Net, PointEntry, PointId, PointRole, RegionEntry,
    Structure, SurfaceId, SurfaceKind, SurfaceSpan, SurfaceSummary, VERTEX_FLOATS,
};
use glam::DVec3;

/// The newest frame, in buffers that are used again and again.
#[derive(Clone, Debug, Default)]
pub(crate) struct Frame {
    /// Vertices, curve samples and points, one after the other.
    pub(crate) floats: Vec<f32>,
    /// Corners of the triangles.
    pub(crate) indices: Vec<u32>,
    /// What the numbers belong to.
    pub(crate) structure: Structure,
    key: Vec<(u32, u64)>,
}

impl Frame {
    /// Writes the model as it is now. Returns whether the structure changed.
    pub(crate) fn write(&mut self, model: &Model, relaxer: &Relaxer, displacer: &Displacer) -> bool {
        let mut key = key(model);
        let overlays = displacer.overlays().map(|(id, overlay)| (id.0, overlay.revision));
        key.extend(overlays);
        let failed_shadows = displacer.failed_shadows();
        let has_other_failures = failed_shadows != self.structure.failed_shadows;
        let changed = key != self.key || has_other_failures || self.structure.version == 0;
        if changed {
            self.key = key;
            self.restructure(model, relaxer, displacer);
            self.structure.failed_shadows = failed_shadows;
        }
        self.floats.clear();
        for (id, shape) in &model.surfaces {
            if let Some((positions, normals)) = displacer.vertices(*id) {
                self.write_vertices(positions, normals);
                continue;
            }
            let Some(bound) = relaxer.surface(*id, shape) else { continue };
            for (vertex, normal) in bound.vertices().iter().zip(bank::shown(model, bound, shape).iter()) {
                push(&mut self.floats, shape.positions[vertex.index()]);
                push(&mut self.floats, *normal);
            }
        }
        for (id, shape) in &model.patches {
            match displacer.vertices(*id) {
                Some((positions, normals)) => self.write_vertices(positions, normals),
                None => self.write_vertices(shape.positions(), shape.normals()),
            }
        }
        for node in model.curves.values().flat_map(|shape| &shape.nodes) {
            push(&mut self.floats, *node);
        }
        for at in model.document.points.values() {
            push(&mut self.floats, *at);
        }
        for at in model.patches.values().flat_map(|shape| shape.net().0) {
            push(&mut self.floats, *at);
        }
        changed
    }

    fn write_vertices(&mut self, positions: &[DVec3], normals: &[DVec3]) {
        for (at, normal) in positions.iter().zip(normals) {
            push(&mut self.floats, *at);
            push(&mut self.floats, *normal);
        }
    }

    fn restructure(&mut self, model: &Model, relaxer: &Relaxer, displacer: &Displacer) {
        let version = self.structure.version.wrapping_add(1).max(1);
        let mut structure = Structure { version, ..Structure::default() };
        self.indices.clear();
        let mut first_vertex = 0;
        for (id, shape) in &model.surfaces {
            let Some(bound) = relaxer.surface(*id, shape) else { continue };
            let first_index = count(self.indices.len());
            let overlay = displacer.get(*id);
            let triangles = overlay.map_or(bound.triangles(), |overlay| overlay.triangles());
            self.indices.extend(triangles.iter().flatten().map(|v| v + first_vertex));
            let vertices = overlay.map_or(bound.vertices().len(), |overlay| overlay.positions().len());
            let vertex_count = count(vertices);
            let index_count = count(self.indices.len()) - first_index;
            let summary = summarise(&shape.mesh);
            divide(&mut structure, *id, shape, model);
            if let Some(overlay) = overlay {
                stand(&mut structure, *id, overlay, first_vertex);
            }
            structure.surfaces.push(SurfaceSpan {
                id: *id,
                first_vertex,
                vertex_count,
                first_index,
                index_count,
                kind: SurfaceKind::Fair,
                summary,
            });
            first_vertex += vertex_count;
        }
        self.append_patches(&mut structure, model, displacer, first_vertex);
        let mut first = 0;
        for (id, shape) in &model.curves {
            let samples = count(shape.nodes.len());
            structure.curves.push(CurveSpan {
                id: *id,
                first,
                count: samples,
                closed: shape.closed,
                role: curve_role(model, *id),
            });
            first += samples;
        }
        structure.points = model
            .document
            .points
            .keys()
            .map(|id| PointEntry { id: *id, role: point_role(model, *id) })
            .collect();
        if structure.regions.is_empty() {
            structure.region_of_triangle.clear();
        }
        self.structure = structure;
    }

    /// Exact surfaces come after the fair ones, and their nets.
    fn append_patches(
        &mut self,
        structure: &mut Structure,
        model: &Model,
        displacer: &Displacer,
        mut first_vertex: u32,
    ) {
        let mut first = 0;
        for (id, shape) in &model.patches {
            let first_index = count(self.indices.len());
            let overlay = displacer.get(*id);
            let triangles = overlay.map_or(shape.triangles(), |overlay| overlay.triangles());
            self.indices.extend(triangles.iter().flatten().map(|v| v + first_vertex));
            let vertex_count = count(overlay.map_or(shape.positions(), |overlay| overlay.positions()).len());
            structure.region_of_triangle.extend(shape.triangles().iter().map(|_| NO_REGION));
            if let Some(overlay) = overlay {
                stand(structure, *id, overlay, first_vertex);
            }
            structure.surfaces.push(SurfaceSpan {
                id: *id,
                first_vertex,
                vertex_count,
                first_index,
                index_count: count(self.indices.len()) - first_index,
                kind: shape.kind(),
                summary: shape.summary(),
            });
            first_vertex += vertex_count;
            let (vertices, edges) = shape.net();
            structure.nets.push(Net {
                surface: *id,
                first,
                count: count(vertices.len()),
                edges: edges.to_vec(),
            });
            first += count(vertices.len());
        }
    }
}

/// Says where the feet of displacements stand, and of which regions the triangles are that were cut there.
fn stand(structure: &mut Structure, surface: SurfaceId, overlay: &Overlay, first_vertex: u32) {
    let own = structure.region_of_triangle.len() - overlay.base_triangles();
    let regions = structure.region_of_triangle.split_off(own);
    structure.region_of_triangle.extend(overlay.parents().iter().map(|&parent| regions[parent as usize]));
    structure.feet.extend(overlay.feet().map(|(index, vertex)| FootEntry {
        surface,
        number: count(index + 1),
        vertex: first_vertex + count(vertex),
    }));
}

/// Says which triangle belongs to which region, where there are several.
fn divide(structure: &mut Structure, id: SurfaceId, shape: &SurfaceShape, model: &Model) {
    let labels = ductile_mesh::regions(&shape.mesh);
    let first = structure.regions.len();
    let room = usize::from(NO_REGION).saturating_sub(first);
    if labels.count() < 2 || labels.count() > room {
        structure.region_of_triangle.extend(shape.mesh.faces().map(|_| NO_REGION));
        return;
    }
    let regions = model.document.surfaces.get(&id).map_or(&[][..], |surface| &surface.regions);
    let objectives = region::own(shape, &labels, regions, |region| region.objective);
    let spacings = region::own(shape, &labels, regions, |region| region.spacing);
    let shadows = region::own(shape, &labels, regions, |region| region.shadow);
    let own = objectives.into_iter().zip(spacings).zip(shadows);
    let entry = |((objective, spacing), shadow)| RegionEntry { surface: id, objective, spacing, shadow };
    structure.regions.extend(own.map(entry));
    let name = |f| u16::try_from(first + labels.of(f)).unwrap_or(NO_REGION);
    structure.region_of_triangle.extend(shape.mesh.faces().map(name));
}

/// Names a structure: what it is made of, in which connectivity and with which roles.
fn key(model: &Model) -> Vec<(u32, u64)> {
    let surfaces = model.surfaces.iter().map(|(id, shape)| (id.0, shape.revision));
    let patches = model.patches.iter().map(|(id, shape)| (id.0, shape.revision()));
    let curves = model.curves.iter().map(|(id, shape)| (id.0, shape.revision));
    let points = model.document.points.keys().map(|id| (id.0, 0));
    let uses = model
        .document
        .surfaces
        .iter()
        .flat_map(|(id, s)| s.skeleton.curves.iter().map(|e| (id.0, u64::from(e.curve.0))));
    let chosen = model.document.surfaces.values().flat_map(|s| &s.regions).flat_map(|r| {
        let objective = r.objective.map_or(0, |objective| objective as u64 + 1);
        let name = (r.from.0, (u64::from(r.curve.0) << 8) | r.side as u64 | (objective << 1));
        let shadow = r.shadow.map_or([(0, 0); 2], |shadow| {
            [(shadow.of.0, shadow.strength.to_bits()), (1, shadow.turn.to_bits())]
        });
        [name, (0, r.spacing.map_or(0, f64::to_bits)), shadow[0], shadow[1]]
    });
    let mark = [(u32::MAX, u64::MAX)];
    surfaces
        .chain(mark)
        .chain(patches)
        .chain(mark)
        .chain(curves)
        .chain(mark)
        .chain(points)
        .chain(mark)
        .chain(uses)
        .chain(mark)
        .chain(chosen)
        .collect()
}

/// The topology of a mesh.
pub(crate) fn summarise(mesh: &Mesh) -> SurfaceSummary {
    let summary = ductile_mesh::summary(mesh);
    SurfaceSummary {
        euler: i32::try_from(summary.euler).unwrap_or(i32::MIN),
        boundaries: count(summary.boundaries),
        components: count(summary.components),
        orientable: summary.is_orientable,
        genus: u32::try_from(summary.genus).unwrap_or(0),
    }
}

fn curve_role(model: &Model, id: CurveId) -> CurveRole {
    let mut role = CurveRole::Free;
    for shape in model.surfaces.values() {
        for embedded in shape.embeddings.iter().filter(|e| e.curve == id) {
            let on_boundary = embedded.vertices.iter().all(|v| shape.mesh.is_boundary_vertex(*v));
            if on_boundary {
                return CurveRole::Boundary;
            }
            role = CurveRole::Inner;
        }
    }
    role
}

fn point_role(model: &Model, id: PointId) -> PointRole {
    if model.document.curves_through(id).next().is_some() {
        PointRole::Curve
    } else if model.surfaces.values().any(|shape| shape.pins.iter().any(|pin| pin.point == id))
        || model.document.cages_on(id).next().is_some()
    {
        PointRole::Surface
    } else {
        PointRole::Free
    }
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "the GPU takes f32; this is the one narrowing of the program"
)]
fn push(floats: &mut Vec<f32>, v: DVec3) {
    floats.extend([v.x as f32, v.y as f32, v.z as f32]);
}

fn count(n: usize) -> u32 {
    u32::try_from(n).unwrap_or(u32::MAX)
}

const _: () = assert!(VERTEX_FLOATS == 6, "write() pushes a position and a normal");
