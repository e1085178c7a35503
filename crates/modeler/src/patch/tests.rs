use super::*;
use crate::modeler::Modeler;
use ductile_spec::{Cage, Document, Edit, GrabTarget, PointId, Reply, Request, Step};
#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

/// A cube of edge 2 as a cage, its corners the points 1 to 8.
fn cube() -> Document {
    let mut document = Document::default();
    for k in 0..8_u32 {
        let side = |bit: u32| if k & bit == 0 { -1.0 } else { 1.0 };
        document.points.insert(PointId(k + 1), DVec3::new(side(1), side(2), side(4)));
    }
    let faces = [[1, 3, 4, 2], [5, 6, 8, 7], [1, 2, 6, 5], [3, 7, 8, 4], [1, 5, 7, 3], [2, 4, 8, 6]];
    let faces = faces.map(|face| face.map(PointId).to_vec());
    document.cages.insert(SurfaceId(1), Cage::new(faces.to_vec()));
    document
}

fn open(document: &Document) -> Modeler {
    let mut modeler = Modeler::new();
    let text = ductile_spec::to_text(document);
    assert_eq!(modeler.handle(Request::OpenText { text }).refused, None);
    modeler
}

/// The distance of a point of the document from the nearest vertex of the surface.
fn distance(modeler: &Modeler, point: PointId) -> f64 {
    let at = modeler.model().document.points[&point];
    let vertices = modeler.model().patches[&SurfaceId(1)].positions().iter();
    vertices.map(|vertex| vertex.distance(at)).fold(f64::INFINITY, f64::min)
}

fn step(modeler: &mut Modeler, drag: Option<DVec3>) -> Reply {
    modeler.handle(Request::Step(Step { drag, iterations: 10 }))
}

#[test]
fn a_surface_over_a_cage_is_shown_and_passes_through_its_points() {
    let mut modeler = open(&cube());
    let reply = modeler.handle(Request::Describe);
    let structure = reply.structure.unwrap();
    let [span] = structure.surfaces[..] else { panic!("one surface") };
    assert_eq!((span.kind, span.summary.euler, span.summary.boundaries), (SurfaceKind::Cage, 2, 0));
    assert_eq!((structure.nets[0].count, structure.nets[0].edges.len()), (8, 12));
    assert_eq!(modeler.floats().len(), structure.float_count());
    assert!((1..=8).all(|k| distance(&modeler, PointId(k)) < 1e-12));
    assert!(step(&mut modeler, None).frame.settled);
}

#[test]
fn it_follows_a_drag_at_once_and_comes_back_with_undo() {
    let mut modeler = open(&cube());
    let before = modeler.model().clone();
    modeler.handle(Request::Grab(GrabTarget::Point(PointId(8))));
    let target = DVec3::new(1.5, 1.25, 2.0);
    step(&mut modeler, Some(target));
    assert_eq!(modeler.model().document.points[&PointId(8)], target);
    assert!(distance(&modeler, PointId(8)) < 1e-12);
    assert!(modeler.handle(Request::Drop).committed.is_some());
    let moved = modeler.model().clone();
    modeler.handle(Request::Undo);
    assert_eq!(modeler.model().document, before.document);
    let places = |model: &Model| model.patches[&SurfaceId(1)].positions().to_vec();
    assert_eq!(places(modeler.model()), places(&before));
    modeler.handle(Request::Redo);
    assert_eq!((&modeler.model().document, places(modeler.model())), (&moved.document, places(&moved)));
    // Evaluated in parts, it is what it is when built anew.
    assert_eq!(places(open(&moved.document).model()), places(&moved));
}

#[test]
fn what_a_cage_needs_stays_and_acts_for_fair_surfaces_say_so() {
    let mut modeler = open(&cube());
    let before = modeler.model().document.clone();
    let point = PointId(3);
    for edit in [Edit::DeletePoint { point }, Edit::Release { point }] {
        let refused = modeler.handle(Request::Edit(edit)).refused.unwrap();
        assert!(refused.reason.contains("vertex of the cage"), "{refused:?}");
    }
    let refused = modeler.handle(Request::Edit(Edit::Reverse { surface: SurfaceId(1) })).refused.unwrap();
    assert!(refused.reason.contains("over a cage") && refused.reason.contains("Reverse"), "{refused:?}");
    assert_eq!(modeler.model().document, before);
    let reply = modeler.handle(Request::Edit(Edit::DeleteSurface { surface: SurfaceId(1) }));
    assert!(reply.committed.is_some() && modeler.model().patches.is_empty());
    assert_eq!(*modeler.model().document, Document::default());
}

#[test]
fn a_cage_that_is_no_surface_is_refused_with_its_name() {
    let mut document = cube();
    let cage = document.cages.get_mut(&SurfaceId(1)).unwrap();
    let face = cage.faces[0].clone();
    cage.faces.push(face);
    let reply = Modeler::new().handle(Request::OpenText { text: ductile_spec::to_text(&document) });
    let reason = reply.refused.unwrap().reason;
    assert!(reason.contains("surface 1"), "{reason}");
}
