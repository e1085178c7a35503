//! Cages through the one door: laid, changed, dragged, imported; taken back and opened again.

use crate::model::Model;
use crate::modeler::Modeler;
use crate::patch::PatchShape;
use ductile_patch::cage::primitive;
use ductile_spec::{
    CageBlend, CageBoundary, CageForm, CageMap, CageSettings, CageSource, CageSplit, Document, Edit, Example,
    GrabTarget, ImportFormat, PointId, Reply, Request, Step, SurfaceId,
};
use glam::{DVec3, dvec3};
#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

const ONE: SurfaceId = SurfaceId(1);

fn act(modeler: &mut Modeler, edit: Edit) {
    let refused = modeler.handle(Request::Edit(edit.clone())).refused;
    assert_eq!(refused, None, "{edit:?}");
}

fn refusal(modeler: &mut Modeler, edit: Edit) -> String {
    let before = modeler.model().document.clone();
    let refused = modeler.handle(Request::Edit(edit.clone())).refused;
    assert_eq!(modeler.model().document, before, "{edit:?}");
    refused.unwrap_or_else(|| panic!("{edit:?} was done")).reason
}

fn built_in(form: CageForm, size: f64) -> Edit {
    Edit::Cage { from: CageSource::BuiltIn { form, centre: dvec3(0.5, -1.0, 0.25), size } }
}

fn with(form: CageForm) -> Modeler {
    let mut modeler = Modeler::new();
    act(&mut modeler, built_in(form, 2.0));
    modeler
}

fn document(modeler: &Modeler) -> Document {
    (*modeler.model().document).clone()
}

/// Vertices and normals of all exact surfaces, bit by bit.
fn bits(model: &Model) -> Vec<u64> {
    let shapes = model.patches.values();
    let all = shapes.flat_map(|shape| shape.positions().iter().chain(shape.normals()));
    all.flat_map(|v| v.to_array()).map(f64::to_bits).collect()
}

/// The largest distance of a vertex of a cage from the nearest vertex of the surface over it.
fn farthest(model: &Model, surface: SurfaceId) -> f64 {
    let positions = model.patches[&surface].positions();
    let missed = |point: PointId| {
        let at = model.document.points[&point];
        positions.iter().map(|vertex| vertex.distance(at)).fold(f64::INFINITY, f64::min)
    };
    model.document.cages[&surface].points().into_iter().map(missed).fold(0.0, f64::max)
}

/// What was made can be opened again and is the same to the bit; undo leads back step by step.
fn check(modeler: &mut Modeler, documents: &[Document]) {
    let mut again = Modeler::new();
    let text = ductile_spec::to_text(&modeler.model().document);
    assert_eq!(again.handle(Request::OpenText { text }).refused, None);
    assert_eq!(again.model().document, modeler.model().document);
    assert_eq!(bits(again.model()), bits(modeler.model()));
    for before in documents.iter().rev() {
        assert_eq!(modeler.handle(Request::Undo).refused, None);
        assert_eq!(document(modeler), *before);
    }
    for _ in documents {
        assert_eq!(modeler.handle(Request::Redo).refused, None);
    }
    assert_eq!(bits(again.model()), bits(modeler.model()));
}

fn step(modeler: &mut Modeler, drag: DVec3) -> Reply {
    modeler.handle(Request::Step(Step { drag: Some(drag), iterations: 5 }))
}

#[test]
fn surfaces_over_built_in_cages_pass_through_all_their_vertices() {
    for form in CageForm::ALL {
        for size in [1e-3, 2.0, 3e4] {
            let mut modeler = Modeler::new();
            act(&mut modeler, built_in(form, size));
            let missed = farthest(modeler.model(), ONE);
            assert!(missed <= 1e-12 * size.max(1.0), "{form:?} of {size}: {missed:e}");
            check(&mut modeler, &[]);
        }
    }
}

#[test]
fn a_cage_is_changed_face_by_face_and_edge_by_edge() {
    let mut modeler = with(CageForm::Cube);
    let surface = ONE;
    let ends = [PointId(1), PointId(2)];
    let mut documents = Vec::new();
    let edits = [
        Edit::Extrude { surface, face: 1, distance: 1.5 },
        Edit::SplitEdge { surface, ends, at: 0.25 },
        Edit::SplitFace { surface, face: 2, between: None },
        Edit::DeleteFace { surface, face: 0 },
        Edit::Shift { points: vec![PointId(9), PointId(10), PointId(9)], by: dvec3(0.0, 0.5, 0.0) },
        Edit::Extrude { surface, face: 3, distance: -0.25 },
        Edit::Move { point: PointId(3), to: dvec3(-2.0, 2.0, -1.0) },
    ];
    for edit in edits {
        documents.push(document(&modeler));
        act(&mut modeler, edit.clone());
        modeler.model().document.validate().unwrap();
        assert!(farthest(modeler.model(), ONE) < 1e-12, "{edit:?}");
    }
    let [cube, tower, ..] = &documents[..] else { panic!("there are more") };
    assert_eq!((tower.points.len(), tower.cages[&ONE].faces.len()), (12, 10));
    assert_eq!(tower.cages[&ONE].faces[1], [9, 10, 11, 12].map(PointId));
    let raised = [9, 10, 11, 12].map(|k| tower.points[&PointId(k)].z);
    assert!(raised.iter().all(|z| *z == 0.25 + 2.0 + 1.5), "{raised:?}");
    assert!(cube.points.iter().all(|(id, at)| tower.points[id] == *at), "old vertices stay");
    let split = documents[2].points[&PointId(13)];
    assert_eq!(split, cube.points[&PointId(1)].lerp(cube.points[&PointId(2)], 0.25));
    let shifted = documents[5].points[&PointId(9)] - documents[4].points[&PointId(9)];
    assert!(
        shifted.distance(dvec3(0.0, 0.5, 0.0)) < 1e-12,
        "a point that is named twice moves once: {shifted}"
    );
    check(&mut modeler, &documents);
}

#[test]
fn points_that_only_a_deleted_face_used_go_with_it() {
    let mut modeler = Modeler::new();
    act(&mut modeler, Edit::Point { at: DVec3::splat(9.0) });
    act(&mut modeler, built_in(CageForm::Grid, 1.0));
    let before = document(&modeler);
    act(&mut modeler, Edit::DeleteFace { surface: ONE, face: 0 });
    let gone: Vec<_> =
        before.points.keys().filter(|id| !document(&modeler).points.contains_key(id)).collect();
    assert_eq!(gone, [&PointId(2)], "the corner of the grid; the lone point stays");
    check(&mut modeler, &[before]);
}

#[test]
fn only_what_a_moved_vertex_enters_is_evaluated_again() {
    let torus = primitive::torus(3.0, 1.0, 60, 30).unwrap();
    let from = CageSource::Given { vertices: torus.positions().to_vec(), faces: torus.faces().to_vec() };
    let mut modeler = Modeler::new();
    act(&mut modeler, Edit::Cage { from });
    assert_eq!(modeler.handle(Request::Grab(GrabTarget::Point(PointId(700)))).refused, None);
    let home = modeler.model().document.points[&PointId(700)];
    for k in 1..5 {
        step(&mut modeler, home + DVec3::Z * (0.1 * f64::from(k)));
        let PatchShape::Cage(shape) = &*modeler.model().patches[&ONE] else { panic!("a cage") };
        // The vertex enters the four by four quads about it.
        let (evaluated, all) = (shape.evaluated(), shape.positions().len());
        assert!(evaluated > 0 && 1800 * evaluated <= 20 * all, "{evaluated} of {all}");
        assert!(farthest(modeler.model(), ONE) < 1e-12);
    }
    assert!(modeler.handle(Request::Drop).committed.is_some());
    check(&mut modeler, &[]);
}

#[test]
fn an_edge_and_a_face_go_with_the_hand_and_are_one_act() {
    let mut modeler = with(CageForm::Cube);
    let first = document(&modeler);
    let at = dvec3(0.3, -1.2, 2.25);
    let targets = [
        (GrabTarget::Face { surface: ONE, face: 1, at }, vec![5, 6, 8, 7]),
        (GrabTarget::Edge { surface: ONE, ends: [PointId(4), PointId(2)], at }, vec![2, 4]),
    ];
    let mut documents = Vec::new();
    for (target, moved) in targets {
        let before = document(&modeler);
        documents.push(before.clone());
        let grabbed = modeler.handle(Request::Grab(target)).grabbed.unwrap();
        assert_eq!(grabbed.at, at);
        let by = dvec3(0.25, 0.5, 1.0);
        for part in [2.0, -1.0, 0.5, 1.0] {
            step(&mut modeler, at + by * part);
            assert!(farthest(modeler.model(), ONE) < 1e-12);
        }
        assert_eq!(modeler.handle(Request::Drop).committed.map(|done| done.act).as_deref(), Some("Move"));
        for (id, was) in &before.points {
            let by = if moved.contains(&id.0) { by } else { DVec3::ZERO };
            assert!(document(&modeler).points[id].distance(*was + by) < 1e-12, "{target:?}, {id}");
        }
    }
    check(&mut modeler, &documents);
    // Brought back to where it was it is no act, and given up it leaves nothing.
    let target = GrabTarget::Face { surface: ONE, face: 0, at };
    let before = document(&modeler);
    for end in [Request::Drop, Request::Cancel] {
        modeler.handle(Request::Grab(target));
        step(&mut modeler, at + DVec3::X);
        let to = if end == Request::Drop { at } else { at + DVec3::Y };
        step(&mut modeler, to);
        assert_eq!(modeler.handle(end).committed, None);
        assert_eq!(document(&modeler), before);
    }
    assert_ne!(document(&modeler), first);
}

#[test]
fn a_hand_gone_wild_leaves_a_cage_that_can_be_opened() {
    let mut modeler = with(CageForm::Trebol);
    let target = GrabTarget::Face { surface: ONE, face: 3, at: DVec3::ZERO };
    assert_eq!(modeler.handle(Request::Grab(target)).refused, None);
    for wild in [DVec3::NAN, DVec3::splat(1e300), DVec3::NEG_X * f64::INFINITY, DVec3::splat(-1e9)] {
        step(&mut modeler, wild);
        assert!(modeler.floats().iter().all(|x| x.is_finite()));
    }
    modeler.handle(Request::Drop);
    modeler.model().document.validate().unwrap();
    check(&mut modeler, &[]);
    let nowhere = GrabTarget::Face { surface: ONE, face: 0, at: DVec3::NAN };
    assert!(modeler.handle(Request::Grab(nowhere)).refused.is_some());
}

#[test]
fn settings_are_kept_and_those_that_make_no_sense_are_refused() {
    let surface = ONE;
    let mut modeler = with(CageForm::Icosahedron);
    let default = CageSettings::default();
    let mut seen = vec![bits(modeler.model())];
    let kinds = [
        CageSettings { split: Some(CageSplit::Linear), ..default },
        CageSettings { map: CageMap::Rational, ..default },
        CageSettings { blend: CageBlend::Erbs, ..default },
        CageSettings { blend: CageBlend::Bump(2), ..default },
        CageSettings { blend: CageBlend::Hermite(3), ..default },
        CageSettings { resolution: Some(5), ..default },
        CageSettings { split: Some(CageSplit::CatmullClark), boundary: CageBoundary::Borrow, ..default },
    ];
    for settings in kinds {
        let before = document(&modeler);
        act(&mut modeler, Edit::CageSettings { surface, settings });
        let now = bits(modeler.model());
        assert!(!seen.contains(&now), "{settings:?} changes nothing");
        seen.push(now);
        let missed = farthest(modeler.model(), ONE);
        // A true Catmull-Clark step moves the vertices themselves.
        assert_eq!(
            missed < 1e-12,
            settings.split != Some(CageSplit::CatmullClark),
            "{settings:?} {missed:e}"
        );
        check(&mut modeler, &[before]);
    }
    for (settings, says) in [
        (CageSettings { blend: CageBlend::Hermite(0), ..default }, "order of the Hermite blend"),
        (CageSettings { blend: CageBlend::Bump(9), ..default }, "exponent of the bump"),
        (CageSettings { resolution: Some(65), ..default }, "resolution"),
        (CageSettings { split: Some(CageSplit::None), ..default }, "every face needs 4"),
    ] {
        let said = refusal(&mut modeler, Edit::CageSettings { surface, settings });
        assert!(said.contains(says) && said.contains("surface 1"), "{said}");
    }
}

#[test]
fn what_cannot_be_done_is_named() {
    let mut modeler = Modeler::new();
    modeler.handle(Request::OpenExample(Example::Disc));
    act(&mut modeler, built_in(CageForm::Cube, 1.0));
    let (fair, cage) = (ONE, SurfaceId(2));
    let point = |number: u32| PointId(number + 4);
    let ends = [point(1), point(8)];
    let given = |vertices: usize, faces: &[&[u32]]| Edit::Cage {
        from: CageSource::Given {
            vertices: vec![DVec3::ZERO; vertices],
            faces: faces.iter().map(|face| face.to_vec()).collect(),
        },
    };
    for (edit, says) in [
        (built_in(CageForm::Torus, 0.0), "a size must be"),
        (built_in(CageForm::Torus, f64::NAN), "a size must be"),
        (built_in(CageForm::Torus, 1e6), "between -1e6 and 1e6"),
        (given(2, &[&[0, 1, 2]]), "face 0 names vertex 2, and there are 2"),
        (given(3, &[]), "no cage: the cage has no faces"),
        (given(4, &[&[0, 1, 2], &[0, 1, 3]]), "same direction along the edge 0-1"),
        (Edit::Extrude { surface: fair, face: 0, distance: 1.0 }, "surface 1 is a fair surface: Extrude"),
        (Edit::Extrude { surface: SurfaceId(9), face: 0, distance: 1.0 }, "surface 9 does not exist"),
        (Edit::Extrude { surface: cage, face: 6, distance: 1.0 }, "face 6 does not exist"),
        (Edit::Extrude { surface: cage, face: 0, distance: 0.0 }, "a distance must be"),
        (Edit::DeleteFace { surface: cage, face: 77 }, "face 77 does not exist"),
        (Edit::SplitEdge { surface: cage, ends, at: 0.5 }, "no edge joins vertices 5 and 12"),
        (Edit::SplitEdge { surface: cage, ends: [point(1), point(2)], at: 1.0 }, "no place on an edge"),
        (Edit::SplitEdge { surface: cage, ends: [PointId(1), point(2)], at: 0.5 }, "point 1 is no vertex"),
        (
            Edit::SplitFace { surface: cage, face: 0, between: Some([point(1), point(3)]) },
            "between the vertices 5 and 7",
        ),
        (Edit::CageSettings { surface: fair, settings: CageSettings::default() }, "works on cages only"),
        (Edit::Shift { points: vec![], by: DVec3::X }, "no points were named"),
        (Edit::Shift { points: vec![PointId(5), PointId(99)], by: DVec3::X }, "point 99 does not exist"),
        (Edit::Shift { points: vec![PointId(5)], by: DVec3::NAN }, "a position must consist of numbers"),
    ] {
        let said = refusal(&mut modeler, edit.clone());
        assert!(said.contains(says), "{edit:?}: {said}");
    }
    for (target, says) in [
        (GrabTarget::Edge { surface: cage, ends, at: DVec3::ZERO }, "no edge of the cage of surface 2"),
        (GrabTarget::Face { surface: cage, face: 6, at: DVec3::ZERO }, "face 6 does not exist"),
        (GrabTarget::Face { surface: fair, face: 0, at: DVec3::ZERO }, "works on cages only"),
        (GrabTarget::Surface { surface: cage, at: DVec3::ZERO }, "over a cage"),
    ] {
        let said = modeler.handle(Request::Grab(target)).refused.unwrap().reason;
        assert!(said.contains(says), "{target:?}: {said}");
    }
    // The last face cannot go: the surface can.
    let mut modeler = Modeler::new();
    act(&mut modeler, given(3, &[&[0, 1, 2]]));
    assert!(refusal(&mut modeler, Edit::DeleteFace { surface: ONE, face: 0 }).contains("no faces"));
    act(&mut modeler, Edit::DeleteSurface { surface: ONE });
    assert_eq!(document(&modeler), Document::default());
}

#[test]
fn files_become_cages_and_bad_ones_are_refused_with_their_place() {
    let obj = "v 0 0 0\nv 1 0 0\nv 1 1 0.1\nv 9 9 9\nv 0 1 0\nvn 0 0 1\nf 1//1 2//1 3//1 5//1\n";
    let ply = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty double z\n\
               element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n1 1 0.1\n0 1 0\n4 0 1 2 3\n";
    let files = [(ImportFormat::Obj, obj), (ImportFormat::Ply, ply)];
    let made = files.map(|(format, text)| {
        let mut modeler = with(CageForm::Cube);
        let before = document(&modeler);
        let done = modeler.handle(Request::Import { format, bytes: text.into(), into: None });
        assert_eq!((done.refused, done.committed.map(|done| done.act).as_deref()), (None, Some("Import")));
        check(&mut modeler, &[before]);
        document(&modeler)
    });
    assert_eq!(made[0], made[1]);
    assert_eq!((made[0].points.len(), made[0].points[&PointId(11)]), (12, dvec3(1.0, 1.0, 0.1)), "exactly");
    let mut modeler = Modeler::new();
    for (format, bytes, says) in [
        (ImportFormat::Obj, b"v 0 0 zero\n".to_vec(), "line 1: a coordinate"),
        (ImportFormat::Obj, vec![0xff, 0xfe], "it is not a text"),
        (ImportFormat::Obj, b"v 0 0 0\n".to_vec(), "the cage has no faces"),
        (ImportFormat::Obj, b"v 0 0 0\nv 1 0 0\nv 0 2e6 0\nf 1 2 3\n".to_vec(), "point 3"),
        (ImportFormat::Ply, obj.as_bytes().to_vec(), "this is no PLY file"),
    ] {
        let said = modeler.handle(Request::Import { format, bytes, into: None }).refused.unwrap();
        assert!(said.act == "Import" && said.reason.contains(says), "{said:?}");
        assert_eq!(document(&modeler), Document::default());
    }
}
