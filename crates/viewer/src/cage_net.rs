//! Edges and faces of cages under the pointer. Edges are met as lines of the control net; faces through the surface over
//! the cage, which is what is seen of them: its triangles stand quad by quad, and its quads face by face.

use crate::camera::Camera;
use crate::pick::{Hit, Line, pick_line};
use crate::scene::Scene;
use ductile_spec::{Document, PointId, SurfaceId, SurfaceKind};
use glam::{Vec2, Vec3};

/// The edge of a cage under the pointer, the cursor in CSS pixels.
#[must_use]
pub fn cage_edge_at(
    scene: &Scene,
    document: &Document,
    camera: &Camera,
    cursor: Vec2,
    reach_px: f32,
) -> Option<Hit> {
    let mut edges: Vec<(SurfaceId, [PointId; 2], [Vec3; 2])> = Vec::new();
    for net in &scene.structure.nets {
        let Some(cage) = document.cages.get(&net.surface) else { continue };
        // The vertices of the net are those of the cage, in order of identity.
        let points: Vec<PointId> = cage.points().into_iter().collect();
        for ends in &net.edges {
            let [Some(a), Some(b)] = ends.map(|end| points.get(end as usize)) else { continue };
            let [Some(from), Some(to)] = ends.map(|end| scene.net_vertex(net.surface, end)) else { continue };
            edges.push((net.surface, [*a, *b], [from, to]));
        }
    }
    let lines = edges.iter().map(|(.., places)| Line { places: places.to_vec(), closed: false });
    let (found, at) = pick_line(scene, camera, cursor, reach_px, lines)?;
    let (surface, ends, _) = *edges.get(found)?;
    Some(Hit::Edge { surface, ends, at })
}

/// The face of a cage over which a place of a surface lies; what is hit of other surfaces stays as it is.
#[must_use]
pub fn with_cage_face(scene: &Scene, document: &Document, hit: Hit) -> Hit {
    let Hit::Surface { id, at, normal, triangle } = hit else { return hit };
    match face_of(scene, document, id, triangle) {
        Some(face) => {
            let normal = cage_face_normal(scene, document, id, face).unwrap_or(normal);
            Hit::Face { surface: id, face, at, normal }
        }
        None => hit,
    }
}

fn face_of(scene: &Scene, document: &Document, surface: SurfaceId, triangle: u32) -> Option<u32> {
    let span = scene.structure.surfaces.iter().find(|span| span.id == surface)?;
    let cage = document.cages.get(&surface).filter(|_| span.kind == SurfaceKind::Cage)?;
    let quads: Vec<usize> = cage.face_of_quads().collect();
    let triangles = span.index_count as usize / 3;
    let each = triangles.checked_div(quads.len()).filter(|each| each * quads.len() == triangles)?;
    let own = (triangle as usize).checked_sub(span.first_index as usize / 3)?;
    quads.get(own.checked_div(each)?).and_then(|face| u32::try_from(*face).ok())
}

/// The corners of a face of a cage, where they are now.
#[must_use]
pub fn cage_face(scene: &Scene, document: &Document, surface: SurfaceId, face: u32) -> Option<Vec<Vec3>> {
    let corners = document.cages.get(&surface)?.faces.get(face as usize)?;
    corners.iter().map(|corner| scene.point(*corner)).collect()
}

/// The unit normal of a face of a cage, outward.
fn cage_face_normal(scene: &Scene, document: &Document, surface: SurfaceId, face: u32) -> Option<Vec3> {
    let corners = cage_face(scene, document, surface, face)?;
    let first = *corners.first()?;
    corners.windows(2).map(|pair| (pair[0] - first).cross(pair[1] - first)).sum::<Vec3>().try_normalize()
}

#[cfg(test)]
mod tests {
    use super::*;
    use ductile_spec::{
        Cage, FrameHeader, Net, PointEntry, PointRole, Structure, SurfaceSpan, SurfaceSummary,
    };
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    /// Two squares side by side in the ground, the surface over each two triangles.
    fn squares() -> (Scene, Document) {
        let places = [[0., 0.], [1., 0.], [2., 0.], [0., 1.], [1., 1.], [2., 1.]];
        let ids = [3, 4, 6, 7, 8, 9].map(PointId);
        let faces = [[3, 4, 8, 7], [4, 6, 9, 8]].map(|face| face.map(PointId).to_vec());
        let (mut document, id) = (Document::default(), SurfaceId(5));
        document.points.extend(ids.into_iter().zip(places.map(|[x, y]| glam::DVec3::new(x, y, 0.0))));
        document.cages.insert(id, Cage::new(faces.to_vec()));
        let edges = vec![[0, 1], [1, 2], [0, 3], [1, 4], [2, 5], [3, 4], [4, 5]];
        let span = SurfaceSpan {
            id,
            first_vertex: 0,
            vertex_count: 6,
            first_index: 0,
            index_count: 12,
            kind: SurfaceKind::Cage,
            summary: SurfaceSummary::default(),
        };
        let structure = Structure {
            version: 1,
            surfaces: vec![span],
            points: ids.map(|id| PointEntry { id, role: PointRole::Surface }).to_vec(),
            nets: vec![Net { surface: id, first: 0, count: 6, edges }],
            ..Structure::default()
        };
        let at = places.map(|[x, y]| glam::DVec2::new(x, y).as_vec2());
        let mut floats: Vec<f32> = at.iter().flat_map(|p| [p.x, p.y, 0.0, 0.0, 0.0, 1.0]).collect();
        let net = || at.iter().flat_map(|p| [p.x, p.y, 0.0]);
        floats.extend(net().chain(net()));
        let mut scene = Scene::default();
        scene.set_structure(structure, vec![0, 1, 4, 0, 4, 3, 1, 2, 5, 1, 5, 4]).unwrap();
        let header = FrameHeader { topology_version: 1, ..FrameHeader::default() };
        scene.set_frame(header, &floats).unwrap();
        (scene, document)
    }

    fn from_above() -> Camera {
        let mut camera = Camera::default();
        camera.set_viewport(800.0, 600.0);
        camera.set_pose(camera.pose_from(crate::View::Top));
        camera
    }

    #[test]
    fn edges_are_met_as_lines_and_named_by_their_points() {
        let (scene, document) = squares();
        let camera = from_above();
        let near = |x: f32, y: f32| {
            let cursor = camera.project(Vec3::new(x, y, 0.0)).unwrap() + Vec2::splat(2.0);
            cage_edge_at(&scene, &document, &camera, cursor, 9.0)
        };
        let Some(Hit::Edge { surface, ends, at }) = near(1.0, 0.4) else { panic!("the edge between them") };
        assert_eq!((surface, ends), (SurfaceId(5), [PointId(4), PointId(8)]));
        assert!(at.distance(Vec3::new(1.0, 0.4, 0.0)) < 0.05, "{at}");
        assert_eq!(near(1.5, 0.5), None);
        assert_eq!(cage_edge_at(&scene, &Document::default(), &camera, Vec2::splat(300.0), 500.0), None);
    }

    #[test]
    fn a_place_of_the_surface_is_one_of_the_face_below_it() {
        let (scene, document) = squares();
        let hit = |triangle| Hit::Surface { id: SurfaceId(5), at: Vec3::X, normal: Vec3::X, triangle };
        for (triangle, face) in [(0, 0), (1, 0), (2, 1), (3, 1)] {
            let found = with_cage_face(&scene, &document, hit(triangle));
            assert_eq!(found, Hit::Face { surface: SurfaceId(5), face, at: Vec3::X, normal: Vec3::Z });
        }
        // A document of a moment ago, with another number of faces, says nothing.
        let mut other = document.clone();
        other.cages.get_mut(&SurfaceId(5)).unwrap().faces.push([6, 9, 8].map(PointId).to_vec());
        assert_eq!(with_cage_face(&scene, &other, hit(0)), hit(0));
        assert_eq!(with_cage_face(&scene, &document, hit(99)), hit(99));
        let corners = cage_face(&scene, &document, SurfaceId(5), 1).unwrap();
        assert_eq!(corners[2], Vec3::new(2.0, 1.0, 0.0));
        assert_eq!(cage_face(&scene, &document, SurfaceId(5), 2), None);
    }
}
