use super::*;
use crate::example::example;
use crate::model::Making;
use crate::modeler::Modeler;
use crate::shape::{SurfaceShape, edit};
use ductile_spec::{Edit, Example, GrabTarget, PointId, Reply, Request, Step, SurfaceId};
use glam::DVec3;
use std::sync::Arc;
#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

const SURFACE: SurfaceId = SurfaceId(1);

fn step(modeler: &mut Modeler, drag: Option<DVec3>) -> Reply {
    modeler.handle(Request::Step(Step { drag, iterations: ITERATIONS }))
}

fn rest(modeler: &mut Modeler) -> Reply {
    for _ in 0..600 {
        let reply = step(modeler, None);
        if reply.frame.settled {
            return reply;
        }
    }
    panic!("no rest");
}

/// A raised disc at rest, whose topmost point was led aside by as much.
fn led(aside: DVec3) -> (Modeler, PointId) {
    let mut modeler = Modeler::new();
    modeler.handle(Request::OpenExample(Example::RaisedDisc));
    rest(&mut modeler);
    let document = &modeler.model().document;
    let (point, home) = document.points.iter().max_by(|a, b| a.1.z.total_cmp(&b.1.z)).unwrap();
    let (point, home) = (*point, *home);
    modeler.handle(Request::Grab(GrabTarget::Point(point)));
    for part in 1..=8 {
        step(&mut modeler, Some(home + aside * (f64::from(part) / 8.0)));
    }
    assert!(modeler.handle(Request::Drop).committed.is_some());
    (modeler, point)
}

/// Whether two models have the same triangles and samples at the same places, to the bit.
fn are_same(one: &Model, other: &Model) -> bool {
    let curves = one.curves.iter().map(|(id, c)| (id, &c.nodes));
    let is_same = |a: &SurfaceShape, b: &SurfaceShape| {
        let corners = |shape: &SurfaceShape| -> Vec<_> {
            shape
                .mesh
                .faces()
                .map(|f| shape.mesh.face_vertices(f).map(|v| shape.positions[v.index()]))
                .collect()
        };
        corners(a) == corners(b)
    };
    curves.eq(other.curves.iter().map(|(id, c)| (id, &c.nodes)))
        && one.surfaces.len() == other.surfaces.len()
        && one.surfaces.iter().all(|(id, shape)| other.surfaces.get(id).is_some_and(|o| is_same(shape, o)))
}

/// The same document opened by somebody else, at rest.
fn opened(modeler: &Modeler) -> Modeler {
    let mut other = Modeler::new();
    let text = ductile_spec::to_compact_text(&modeler.model().document);
    // Whatever stood there before must not matter.
    other.handle(Request::OpenExample(Example::Disc));
    step(&mut other, None);
    assert_eq!(other.handle(Request::OpenText { text }).refused, None);
    rest(&mut other);
    other
}

#[test]
fn what_rests_is_what_its_document_opens_to() {
    let (mut modeler, _) = led(DVec3::new(0.3, 0.1, 0.1));
    rest(&mut modeler);
    assert_eq!(modeler.kept(), 0);
    assert!(are_same(modeler.model(), opened(&modeler).model()));
    // And stays so, however often it is stepped.
    let before = modeler.model().clone();
    for _ in 0..10 {
        assert!(step(&mut modeler, None).frame.settled);
    }
    assert!(are_same(modeler.model(), &before));
}

#[test]
fn other_budgets_lead_to_the_same_shape() {
    let mut modeler = Modeler::new();
    modeler.handle(Request::OpenExample(Example::Cylinder));
    for _ in 0..600 {
        if modeler.handle(Request::Step(Step { drag: None, iterations: 2 })).frame.settled {
            break;
        }
    }
    assert!(are_same(modeler.model(), opened(&modeler).model()));
}

#[test]
fn undo_and_redo_lead_to_the_very_shapes_that_rested() {
    let (mut modeler, _) = led(DVec3::new(0.2, 0.0, 0.0));
    rest(&mut modeler);
    let after = modeler.model().clone();
    assert!(modeler.handle(Request::Undo).frame.settled);
    assert!(are_same(modeler.model(), opened(&modeler).model()));
    assert!(modeler.handle(Request::Redo).frame.settled);
    assert!(are_same(modeler.model(), &after));
}

#[test]
fn nothing_jumps_on_the_way() {
    let (mut modeler, _) = led(DVec3::new(0.3, 0.1, 0.1));
    let before = |modeler: &Modeler| {
        let shape = &modeler.model().surfaces[&SURFACE];
        (ductile_mesh::SurfaceTree::new(&shape.mesh, &shape.positions), Arc::clone(shape))
    };
    let mut slides = 0;
    loop {
        let (tree, old) = before(&modeler);
        let is_sliding = matches!(modeler.settling(), Settling::Sliding(_));
        let settled = step(&mut modeler, None).frame.settled;
        let shape = &modeler.model().surfaces[&SURFACE];
        let far = shape.mesh.vertices().map(|v| {
            let at = shape.positions[v.index()];
            tree.nearest(&old.mesh, at).unwrap().1.distance(at)
        });
        let far = far.fold(0.0, f64::max) / shape.radius();
        let begins = matches!(modeler.settling(), Settling::Sliding(_));
        if is_sliding || begins {
            slides += 1;
            assert!(far < 0.3 * 0.02, "{far}");
        }
        if settled {
            break;
        }
    }
    assert!(slides > 5, "{slides}");
}

#[test]
fn acts_and_drags_find_the_shape_whole() {
    for wait in 0..60 {
        let (mut modeler, point) = led(DVec3::new(0.3, 0.1, 0.1));
        while !modeler.relaxer().is_settled() {
            step(&mut modeler, None);
        }
        (0..wait).for_each(|_| drop(step(&mut modeler, None)));
        let was = !matches!(modeler.settling(), Settling::Idle);
        let reply = modeler.handle(Request::Grab(GrabTarget::Point(point)));
        assert_eq!(reply.refused, None);
        assert!(matches!(modeler.settling(), Settling::Idle));
        modeler.handle(Request::Cancel);
        rest(&mut modeler);
        assert!(are_same(modeler.model(), opened(&modeler).model()), "after {wait} steps");
        if !was && wait > 0 {
            return;
        }
    }
}

#[test]
fn another_valley_is_not_taken() {
    // A shape that is lower than what its document opens to is kept, and one far from it.
    let (mut modeler, _) = led(DVec3::new(0.3, 0.1, 0.1));
    rest(&mut modeler);
    let (model, relaxer) = (modeler.model().clone(), modeler.relaxer().clone());
    let mut hidden = Hidden::open(&model).unwrap();
    assert!(hidden.slide_from(&model, &relaxer).is_none(), "it does not rest yet");
    while !hidden.advance() {}
    assert!(hidden.slide_from(&model, &relaxer).is_some());
    let mut far = model.clone();
    let shape = edit(far.surfaces.get_mut(&SURFACE).unwrap());
    let reach = shape.radius() * 0.03;
    shape.positions.iter_mut().for_each(|at| at.z += reach);
    assert!(hidden.slide_from(&far, &relaxer).is_none(), "it is far");
    let mut dear = Hidden::open(&Model::from_document(example(Example::RaisedDisc)).unwrap()).unwrap();
    dear.relaxer.rest(&dear.model);
    assert!(dear.slide_from(&model, &relaxer).is_none(), "it costs more");
}

#[test]
fn worse_triangles_are_not_taken() {
    let (mut modeler, _) = led(DVec3::new(0.3, 0.1, 0.1));
    rest(&mut modeler);
    let (model, relaxer) = (modeler.model().clone(), modeler.relaxer().clone());
    let mut hidden = Hidden { model: model.clone(), relaxer: relaxer.clone() };
    assert!(hidden.slide_from(&model, &relaxer).is_some());
    // Two vertices of a triangle close up on each other: hardly dearer by what the fits of before say, but a needle.
    let shape = edit(hidden.model.surfaces.get_mut(&SURFACE).unwrap());
    let is_fixed = |v| shape.controlled().any(|other| other == v);
    let is_free = |f| shape.mesh.face_vertices(f).iter().all(|v| !is_fixed(*v));
    let [a, b, _] = shape.mesh.face_vertices(shape.mesh.faces().find(|f| is_free(*f)).unwrap());
    let near = shape.positions[a.index()].lerp(shape.positions[b.index()], 0.9);
    shape.positions[a.index()] = near;
    assert!(hidden.slide_from(&model, &relaxer).is_none());
}

/// A shape with waves in it that cost so many times what it does, as if it rested so.
fn waved(model: &Model, relaxer: &Relaxer, times: f64) -> (Model, Relaxer) {
    let mut height = 1e-3;
    loop {
        let (mut model, mut waved) = (model.clone(), relaxer.clone());
        let shape = edit(model.surfaces.get_mut(&SURFACE).unwrap());
        for v in shape.mesh.vertices() {
            let at = &mut shape.positions[v.index()];
            at.z += height * libm::sin(5.0 * at.x);
        }
        waved.rest(&model);
        if waved.energy() > times * relaxer.energy() {
            return (model, waved);
        }
        height *= 1.1;
    }
}

#[test]
fn what_an_act_left_makes_way_for_what_costs_less_than_half() {
    let (mut modeler, _) = led(DVec3::new(0.3, 0.1, 0.1));
    rest(&mut modeler);
    let (model, relaxer) = (modeler.model().clone(), modeler.relaxer().clone());
    let hidden = Hidden { model: model.clone(), relaxer: relaxer.clone() };
    for (times, making, is_taken) in [
        (2.1, Making::Acted, true),
        (1.5, Making::Acted, false),
        // Nobody knows by which way what was moved came where it is.
        (2.1, Making::Moved, false),
        (2.1, Making::Worked, false),
    ] {
        let (mut shown, waved) = waved(&model, &relaxer, times);
        shown.making = making;
        assert!(!waved.is_folded());
        assert_eq!(hidden.slide_from(&shown, &waved).is_some(), is_taken, "{times} times, {making:?}");
    }
}

#[test]
fn what_acts_made_is_kept_and_undo_of_them_settles_again() {
    let (mut modeler, point) = led(DVec3::new(0.3, 0.1, 0.1));
    rest(&mut modeler);
    assert_eq!(modeler.model().making, Making::Own);
    let spacing = Some(modeler.model().spacing() * 0.9);
    let act = Edit::Spacing { of: ductile_spec::SpacingOf::Document, spacing };
    assert_eq!(modeler.handle(Request::Edit(act)).refused, None);
    rest(&mut modeler);
    assert_eq!((modeler.model().making, modeler.kept()), (Making::Kept, 0));
    let to = modeler.model().document.points[&point] + DVec3::Z * 0.05;
    assert_eq!(modeler.handle(Request::Edit(Edit::Move { point, to })).refused, None);
    rest(&mut modeler);
    assert_eq!(modeler.model().making, Making::Kept);
    modeler.handle(Request::Undo);
    modeler.handle(Request::Undo);
    assert_eq!(modeler.model().making, Making::Own);
    assert_eq!(modeler.handle(Request::Edit(Edit::Move { point, to })).refused, None);
    rest(&mut modeler);
    assert_eq!(modeler.model().making, Making::Own);
}

#[test]
fn a_document_without_shapes_has_nothing_to_settle() {
    let mut modeler = Modeler::new();
    assert!(modeler.handle(Request::Edit(Edit::Point { at: DVec3::ONE })).refused.is_none());
    assert!(step(&mut modeler, None).frame.settled);
}
