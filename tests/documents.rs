//! Documents become shapes: the examples relax to what theory says, acts change document and shape together,
//! undo and redo restore the identical document.

use acceptance::Bench;
use core::f64::consts::PI;
use ductile_spec::{
    CurveId, Edit, Example, PointId, Remembered, Request, Resume, SurfaceId, Through, to_fragment,
};
use glam::{DVec3, dvec3};

#[test]
fn every_example_comes_to_rest() {
    for example in Example::PLAIN {
        let mut bench = Bench::with(example);
        let energy = bench.rest(300);
        assert!(energy.is_finite() && energy >= 0.0, "{example:?}: {energy}");
    }
}

#[test]
fn a_flat_disc_has_no_energy() {
    let energy = Bench::with(Example::Disc).rest(300);
    assert!(energy < 1e-6, "energy {energy}");
}

#[test]
fn six_points_hold_a_round_ball() {
    let mut bench = Bench::with(Example::Ball);
    let energy = bench.rest(300);
    assert!((energy / (8.0 * PI) - 1.0).abs() < 0.02, "energy {energy}, a sphere has 25.13");
    let shape = &bench.modeler.model().surfaces[&SurfaceId(1)];
    let radii = shape.mesh.vertices().map(|v| shape.positions[v.index()].length());
    let (low, high) = radii.fold((f64::INFINITY, 0.0_f64), |(low, high), r| (low.min(r), high.max(r)));
    assert!(low > 0.985 && high < 1.015, "radii from {low} to {high}");
}

#[test]
fn controls_are_met_exactly_at_rest() {
    for example in Example::PLAIN {
        let mut bench = Bench::with(example);
        bench.rest(300);
        let model = bench.modeler.model();
        for shape in model.surfaces.values() {
            for pin in &shape.pins {
                assert_eq!(
                    shape.positions[pin.vertex.index()],
                    model.document.points[&pin.point],
                    "{example:?}"
                );
            }
            for embedded in &shape.embeddings {
                let curve = &model.curves[&embedded.curve];
                for (v, node) in embedded.vertices.iter().zip(&curve.nodes) {
                    assert_eq!(shape.positions[v.index()], *node, "{example:?}");
                }
            }
        }
        for curve in model.curves.values() {
            for (sample, point) in &curve.controls {
                assert_eq!(curve.nodes[*sample as usize], model.document.points[point], "{example:?}");
            }
        }
    }
}

#[test]
fn a_shape_does_not_depend_on_its_spacing() {
    let energy_at = |spacing: f64| {
        let mut bench = Bench::with(Example::RaisedDisc);
        bench.edit(Edit::Spacing { of: ductile_spec::SpacingOf::Document, spacing: Some(spacing) });
        bench.rest(600)
    };
    let (coarse, fine) = (energy_at(0.08), energy_at(0.04));
    assert!((coarse / fine - 1.0).abs() < 0.03, "{coarse} at 0.08, {fine} at 0.04");
}

#[test]
fn a_document_built_by_acts_is_undone_to_nothing_and_redone_to_itself() {
    let mut bench = Bench::new();
    let square = [dvec3(1., 0., 0.), dvec3(0., 1., 0.), dvec3(-1., 0., 0.), dvec3(0., -1., 0.)];
    bench.edit(Edit::Curve { through: square.map(Through::Place).to_vec(), closed: true });
    bench.edit(Edit::Sheet { boundary: CurveId(1) });
    bench.rest(300);
    bench.edit(Edit::Pin { surface: SurfaceId(1), at: dvec3(0.1, 0.2, 0.0) });
    bench.edit(Edit::Move { point: PointId(5), to: dvec3(0.1, 0.2, 0.6) });
    bench.rest(300);
    bench.edit(Edit::Insert { curve: CurveId(1), at: dvec3(0.7, 0.7, 0.0) });
    bench.edit(Edit::Move { point: PointId(6), to: dvec3(0.9, 0.9, 0.3) });
    bench.rest(300);
    let above = square.map(|p| Through::Place(p * 0.6 + DVec3::Z * 1.5));
    bench.edit(Edit::Curve { through: above.to_vec(), closed: true });
    bench.edit(Edit::Sweep { from: CurveId(1), to: CurveId(2), stretches: [None; 2], reversed: false });
    bench.rest(300);
    bench.edit(Edit::Release { point: PointId(5) });
    bench.edit(Edit::Rename { name: "Hat".into() });
    let last = bench.document();
    assert_eq!(last.surfaces.len(), 2);
    assert_eq!(
        last.surfaces[&SurfaceId(1)].skeleton.triangles.len(),
        3,
        "a disc in five points needs three triangles"
    );
    let mut documents = vec![bench.document.clone()];
    while bench.send(Request::Undo).refused.is_none() {
        documents.push(bench.document.clone());
    }
    assert_eq!(documents.len(), 11);
    assert!(bench.document().points.is_empty() && bench.document().surfaces.is_empty());
    for expected in documents.iter().rev().skip(1) {
        bench.accept(Request::Redo);
        assert_eq!(&bench.document, expected);
    }
    assert!(bench.send(Request::Redo).refused.is_some());
    bench.rest(300);
}

#[test]
fn a_new_modeler_goes_on_with_the_history_of_one_that_died() {
    let mut first = Bench::with(Example::Disc);
    let mut documents = vec![first.document.clone()];
    for z in [0.2, 0.4] {
        first.edit(Edit::Move { point: PointId(1), to: dvec3(0.7, 0.7, z) });
        documents.push(first.document.clone());
    }
    let entry = |act: &str, document: &String| Remembered { act: act.into(), document: document.clone() };
    let [opened, moved, again] = documents.as_slice() else { panic!("{} documents", documents.len()) };
    let resume = Resume {
        document: moved.clone(),
        undo: vec![entry("Move", opened)],
        redo: vec![entry("Move", again)],
    };
    let mut second = Bench::new();
    let committed = second.accept(Request::Resume(resume.clone())).committed.unwrap();
    assert_eq!((committed.undo.as_deref(), committed.redo.as_deref()), (Some("Move"), Some("Move")));
    assert_eq!(&second.document, moved);
    for (request, expected) in [(Request::Undo, opened), (Request::Redo, moved), (Request::Redo, again)] {
        second.accept(request);
        assert_eq!(&second.document, expected);
        second.rest(300);
    }

    // A torn history is taken up as far as it can be read, a torn document not at all.
    let torn = Resume { undo: vec![entry("Move", opened), entry("Torn", &"{".into())], ..resume.clone() };
    let committed = second.accept(Request::Resume(torn)).committed.unwrap();
    assert_eq!((committed.undo, committed.redo.as_deref()), (None, Some("Move")));
    assert!(second.send(Request::Resume(Resume { document: "{".into(), ..resume })).refused.is_some());
    assert_eq!(&second.document, moved);
}

#[test]
fn a_curve_through_old_points_and_new_places_is_one_act() {
    let mut bench = Bench::with(Example::Disc);
    let before = bench.document.clone();
    let place = |x, y, z| Through::Place(dvec3(x, y, z));
    let through =
        vec![Through::Point(PointId(1)), place(0., 0., 1.), Through::Point(PointId(3)), place(0., 0., -1.)];
    let reply = bench.edit(Edit::Curve { through, closed: true });
    assert_eq!(reply.committed.map(|c| c.act), Some("Curve".to_owned()));
    let through: Vec<u32> = bench.document().curves[&CurveId(2)].through.iter().map(|id| id.0).collect();
    assert_eq!(through, [1, 5, 3, 6]);
    bench.accept(Request::Undo);
    assert_eq!(bench.document, before, "curve and points go together");
}

#[test]
fn a_sweep_between_curves_in_one_plane_is_a_flat_ring() {
    // As four clicks on the ground make them, seen at a slant: no two sides alike.
    let outer = [dvec3(-1.4, 1.2, 0.), dvec3(1.5, 1.4, 0.), dvec3(1.2, -1.1, 0.), dvec3(-1.2, -0.9, 0.)];
    let flat = |[x, y]: [f64; 2]| dvec3(x, y, 0.0);
    let pairs = [
        (outer, outer.map(|p| 0.4 * p + dvec3(0.05, 0.02, 0.0))),
        (outer, outer.map(|p| dvec3(p.y, p.x, 0.0) * 0.4)),
        // The inner curve bulges far into the ring.
        (
            [[-1.58, 0.86], [-0.45, -0.71], [0.79, -0.18], [-0.31, 2.01]].map(flat),
            [[-0.745, 0.494], [-0.361, -0.147], [0.195, 0.079], [-0.294, 0.879]].map(flat),
        ),
    ];
    for (outer, inner) in pairs {
        let mut bench = Bench::new();
        for corners in [outer, inner] {
            bench.edit(Edit::Curve { through: corners.map(Through::Place).to_vec(), closed: true });
        }
        bench.edit(Edit::Sweep { from: CurveId(1), to: CurveId(2), stretches: [None; 2], reversed: false });
        let energy = bench.rest(300);
        assert!(energy.abs() < 1e-6, "energy {energy}");
    }
}

#[test]
fn a_link_brings_the_same_document_and_the_same_surface() {
    let mut sender = Bench::with(Example::RaisedDisc);
    sender.rest(300);
    sender.edit(Edit::Pin { surface: SurfaceId(1), at: dvec3(0.5, 0.3, 0.3) });
    let point = *sender.document().points.last_key_value().unwrap().0;
    sender.edit(Edit::Move { point, to: dvec3(0.5, 0.3, 0.8) });
    let sent = sender.rest(300);
    let mut friend = Bench::new();
    friend.accept(Request::OpenLink { link: format!("#{}", to_fragment(&sender.document())) });
    assert_eq!(friend.document, sender.document);
    let received = friend.rest(300);
    assert!((sent / received - 1.0).abs() < 0.02, "energy {sent} sent, {received} received");
}

#[test]
fn damaged_documents_leave_the_model() {
    let mut bench = Bench::with(Example::Saddle);
    bench.rest(300);
    let before = bench.document.clone();
    let floats = bench.modeler.floats().to_vec();
    let bad = [
        "",
        "{",
        "{\"ductile\":9}",
        r#"{"ductile":1,"points":{"1":[0,0,null]}}"#,
        // Three triangles on an edge; then two triangles that only touch in a point.
        r#"{"ductile":1,"points":{},"surfaces":{"1":{"skeleton":{"vertices":[[0,0,0],[1,0,0],[0,1,0],[0,0,1],[1,1,1]],"triangles":[[0,1,2],[0,1,3],[0,1,4]]}}}}"#,
        r#"{"ductile":1,"points":{},"surfaces":{"1":{"skeleton":{"vertices":[[0,0,0],[1,0,0],[0,1,0],[0,0,1],[1,1,1]],"triangles":[[0,1,2],[0,3,4]]}}}}"#,
        // All in one place.
        r#"{"ductile":1,"points":{},"surfaces":{"1":{"skeleton":{"vertices":[[0,0,0],[0,0,0],[0,0,0]],"triangles":[[0,1,2]]}}}}"#,
        r#"{"ductile":1,"points":{"1":[0,0,0],"2":[0,0,0],"3":[0,0,0]},"curves":{"1":{"through":[1,2,3],"closed":true}}}"#,
    ];
    for text in bad {
        let reply = bench.send(Request::OpenText { text: text.into() });
        assert!(reply.refused.is_some_and(|r| r.reason.len() > 10), "{text} was accepted");
        assert_eq!(bench.modeler.floats(), floats, "{text} changed the model");
    }
    bench.accept(Request::Describe);
    assert_eq!(bench.document, before);
}

#[test]
fn surfaces_with_one_side_are_welcome() {
    // A Möbius strip of five triangles, all corners free.
    let corners: Vec<String> = (0..5)
        .map(|k| {
            let turn = 2.0 * PI * f64::from(k) / 5.0;
            let lift = if k % 2 == 0 { 0.35 } else { -0.35 };
            format!("[{}, {}, {lift}]", libm::cos(turn), libm::sin(turn))
        })
        .collect();
    let triangles = "[[0,1,2],[1,2,3],[2,3,4],[3,4,0],[4,0,1]]";
    let points: Vec<String> = corners.iter().zip(1..).map(|(at, id)| format!("\"{id}\": {at}")).collect();
    let text = format!(
        r#"{{"ductile":1,"spacing":0.12,"points":{{{}}},"surfaces":{{"1":{{"skeleton":{{"vertices":[1,2,3,4,5],"triangles":{triangles}}}}}}}}}"#,
        points.join(",")
    );
    let mut bench = Bench::new();
    let reply = bench.accept(Request::OpenText { text });
    let summary = reply.structure.unwrap().surfaces[0].summary;
    assert_eq!((summary.euler, summary.boundaries, summary.orientable), (0, 1, false));
    // Five corners hold a strip so loosely that it may creep: the modeler calls it settled after 600 steps at most.
    bench.rest(600);
    let shape = &bench.modeler.model().surfaces[&SurfaceId(1)];
    let summary = ductile_mesh::summary(&shape.mesh);
    assert!(!summary.is_orientable && summary.euler == 0, "{summary:?}");
}

/// What a million wild drags came upon: a rim drawn out so far that the cuts along it gave one node more neighbours than can be fitted.
#[test]
fn a_rim_drawn_far_out_opens_and_comes_to_rest() {
    let text = r#"{"ductile":1,"objective":"thin-plate","spacing":0.25,"points":{"1":[0.7071,0.7071,0.0],
        "2":[1.811718,0.790307,0.328654],"3":[-0.7071,-0.7071,0.0],"4":[0.7071,-0.7071,0.0],"5":[0.0,0.45,0.5],
        "6":[-0.39,-0.22,0.35],"7":[0.39,-0.22,0.35]},"curves":{"1":{"through":[1,2,3,4],"closed":true}},
        "surfaces":{"1":{"skeleton":{"vertices":[1,2,3,4,5,6,7],"triangles":[[0,1,4],[1,5,4],[1,2,5],[2,6,5],[2,3,6],
        [3,0,6],[0,4,6],[4,5,6]],"curves":[{"curve":1,"along":[0,1,2,3]}]}}}}"#;
    let mut bench = Bench::new();
    bench.accept(Request::OpenText { text: text.to_owned() });
    bench.rest(600);
}

/// A history may hold a document that can be read and yet not be built: undo says so, and the entry is not lost.
#[test]
fn an_undo_that_cannot_be_built_is_refused_and_stays_in_the_history() {
    let mut bench = Bench::with(Example::Disc);
    bench.rest(300);
    let good = bench.document.clone();
    let mut flat = bench.document();
    let at = flat.points.values().next().copied().unwrap();
    flat.points.values_mut().for_each(|place| *place = at);
    let entry = |act: &str, document: String| Remembered { act: act.into(), document };
    let undo = vec![entry("Point", good.clone()), entry("Flatten", ductile_spec::to_compact_text(&flat))];
    let redo = vec![entry("Unflatten", ductile_spec::to_compact_text(&flat))];
    bench.accept(Request::Resume(Resume { document: good.clone(), undo, redo }));
    for _ in 0..2 {
        for request in [Request::Undo, Request::Redo] {
            assert!(bench.send(request).refused.is_some());
        }
        let committed = bench.accept(Request::Describe).committed.unwrap();
        assert_eq!(
            (committed.undo.as_deref(), committed.redo.as_deref()),
            (Some("Flatten"), Some("Unflatten"))
        );
        assert_eq!(committed.document, good);
    }
}
