use super::*;
use crate::example::example;
use ductile_mesh::Mesh;
use ductile_spec::{Example, PointId};
use glam::DVec3;
use std::sync::Arc;
#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

const SURFACE: SurfaceId = SurfaceId(1);

/// A coarse disc with a control point that no solver can go to: beyond what documents allow, and solvers.
fn without_rest() -> (Model, Relaxer) {
    let mut document = example(Example::RaisedDisc);
    document.spacing = Some(0.3);
    let mut model = Model::from_document(document).unwrap();
    let point = *model.document.points.keys().last().unwrap();
    model.document_mut().points.insert(point, DVec3::Z * 1e60);
    let mut relaxer = Relaxer::default();
    relaxer.bind(&model);
    (model, relaxer)
}

#[test]
fn what_never_comes_to_rest_is_called_settled_after_most_steps_and_wakes_by_an_act() {
    let (mut model, mut relaxer) = without_rest();
    for step in 1..=MOST_STEPS {
        relaxer.step(&mut model, 4);
        assert!(relaxer.states().all(|(_, state)| !state.at_rest));
        assert_eq!(relaxer.is_settled(), step == MOST_STEPS, "{step}");
    }
    assert!(relaxer.rescues >= MOST_STEPS, "what is refused is counted");
    relaxer.wake();
    assert!(!relaxer.is_settled());
}

#[test]
fn a_mesh_is_improved_for_most_rounds_and_then_left_as_it_is() {
    let (mut model, mut relaxer) = without_rest();
    for _ in 0..MAINTENANCE_PERIOD * MOST_ROUNDS {
        relaxer.step(&mut model, 4);
        assert!(relaxer.states().all(|(_, state)| !state.is_quiet));
    }
    assert_eq!(relaxer.rounds, MOST_ROUNDS);
    // A mesh that is far too coarse for its spacing would be split from now on, but for the limit.
    let shape = edit(model.surfaces.get_mut(&SURFACE).unwrap());
    shape.spacing *= 0.5;
    let vertices = shape.mesh.vertex_count();
    for _ in 0..3 * MAINTENANCE_PERIOD {
        relaxer.step(&mut model, 4);
    }
    assert_eq!(relaxer.rounds, MOST_ROUNDS);
    assert_eq!(model.surfaces[&SURFACE].mesh.vertex_count(), vertices);
    assert!(relaxer.states().all(|(_, state)| state.is_quiet));
    // An act gives it rounds again.
    relaxer.wake();
    for _ in 0..MAINTENANCE_PERIOD {
        relaxer.step(&mut model, 4);
    }
    assert!(model.surfaces[&SURFACE].mesh.vertex_count() > vertices);
}

/// A fan whose middle has more neighbours than a solver can hold.
fn crowded() -> Model {
    let count = 40_u32;
    let triangles: Vec<[u32; 3]> = (0..count).map(|k| [count, k, (k + 1) % count]).collect();
    let at = |k: u32| {
        let (y, x) = libm::sincos(core::f64::consts::TAU * f64::from(k) / f64::from(count));
        DVec3::new(x, y, 0.0)
    };
    let positions = (0..count).map(at).chain([DVec3::ZERO]).collect();
    let shape = SurfaceShape {
        mesh: Mesh::from_triangles(count as usize + 1, &triangles).unwrap(),
        positions,
        embeddings: Vec::new(),
        pins: Vec::new(),
        spacing: 0.3,
        wanted: Vec::new(),
        age: 0,
        revision: 1,
    };
    let mut model = Model::default();
    model.surfaces.insert(SURFACE, Arc::new(shape));
    model
}

#[test]
fn a_shape_that_no_solver_can_hold_is_counted_and_left_as_it_is() {
    let mut model = crowded();
    let mut relaxer = Relaxer::default();
    relaxer.bind(&model);
    assert_eq!(relaxer.rescues, 1);
    assert!(relaxer.surface(SURFACE, &model.surfaces[&SURFACE]).is_none());
    let before = model.surfaces[&SURFACE].positions.clone();
    for _ in 0..10 {
        relaxer.step(&mut model, 4);
    }
    assert_eq!(model.surfaces[&SURFACE].positions, before);
    assert!(relaxer.is_settled() && relaxer.energy() == 0.0);
}

#[test]
fn a_curve_that_no_solver_can_hold_is_counted_and_left_as_it_is() {
    let mut model = Model::from_document(example(Example::Disc)).unwrap();
    let id = CurveId(1);
    // A direction that is none; documents refuse it.
    model.document_mut().curves.get_mut(&id).unwrap().tangents.insert(PointId(1), DVec3::ZERO);
    let mut relaxer = Relaxer::default();
    relaxer.bind(&model);
    assert_eq!(relaxer.rescues, 1);
    assert!(!relaxer.curves.contains_key(&id) && relaxer.surfaces.contains_key(&SURFACE));
    let before = model.curves[&id].nodes.clone();
    relaxer.step(&mut model, 4);
    assert_eq!(model.curves[&id].nodes, before);
}

#[test]
fn a_motion_that_the_solver_refuses_is_counted_and_the_shape_relaxes_without_it() {
    let (mut model, mut relaxer) = without_rest();
    let place = |model: &Model| model.surfaces[&SURFACE].positions.clone();
    let before = place(&model);
    relaxer.step(&mut model, 4);
    // Once for the motion; the step itself is as good as any.
    assert_eq!(relaxer.rescues, 1);
    let pin = model.surfaces[&SURFACE].pins[0].vertex.index();
    assert_eq!(place(&model)[pin], before[pin]);
    assert!(place(&model).iter().all(|at| at.is_finite()));
    assert!(relaxer.states().all(|(_, state)| !state.at_rest && state.energy.is_finite()));
}

/// A neutral disc crushed to a line, at which a hand pulls while a plane is held: it comes a part of the way at a time, and the
/// steps between find no way on.
#[test]
fn a_part_of_a_motion_whose_step_is_damped_is_counted_by_itself() {
    let mut document = example(Example::RaisedDisc);
    document.spacing = Some(0.3);
    document.objective = ductile_spec::Objective::Neutral;
    let mut model = Model::from_document(document).unwrap();
    let crush = |at: &mut DVec3| *at = DVec3::X * at.x;
    let point = *model.document.points.keys().last().unwrap();
    model.document_mut().points.values_mut().for_each(crush);
    model.document_mut().points.insert(point, DVec3::Z * 3.0);
    let surface = model.document_mut().surfaces.get_mut(&SURFACE).unwrap();
    surface.normals.insert(point, DVec3::Z);
    edit(model.surfaces.get_mut(&SURFACE).unwrap()).positions.iter_mut().for_each(crush);
    model.curves.values_mut().for_each(|curve| edit(curve).nodes.iter_mut().for_each(crush));
    let mut relaxer = Relaxer::default();
    relaxer.bind(&model);
    relaxer.step(&mut model, 8);
    // At most one of them is that of the step at the end.
    assert!(relaxer.rescues > 1, "{}", relaxer.rescues);
    assert!(model.surfaces[&SURFACE].positions.iter().all(|at| at.is_finite()));
}
