use super::*;
use crate::Modeler;
use ductile_spec::{
    Curve, Embedding, GrabTarget, Request, Skeleton, SkeletonVertex, Step, Surface, SurfaceId, to_text,
};
use glam::DVec3;
#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

const POLE: PointId = PointId(1);
const SURFACE: SurfaceId = SurfaceId(1);

/// A dome over six points of a circle: three curves from side to side cross at its top.
fn dome(spacing: f64) -> Document {
    let mut document = Document { spacing: Some(spacing), ..Document::default() };
    document.points.insert(POLE, DVec3::Z * 0.5);
    let mut skeleton = Skeleton { vertices: vec![SkeletonVertex::Control(POLE)], ..Skeleton::default() };
    for k in 0..6 {
        let (y, x) = libm::sincos(core::f64::consts::FRAC_PI_3 * f64::from(k));
        document.points.insert(PointId(2 + k), DVec3::new(x, y, 0.0));
        skeleton.vertices.push(SkeletonVertex::Control(PointId(2 + k)));
        skeleton.triangles.push([0, 1 + k, 1 + (k + 1) % 6]);
    }
    let mut add = |along: Vec<u32>, closed| {
        let through = along.iter().map(|v| PointId(v + 1)).collect();
        let curve = CurveId(u32::try_from(skeleton.curves.len()).unwrap() + 1);
        document.curves.insert(curve, Curve::new(through, closed));
        skeleton.curves.push(Embedding { curve, along });
    };
    add((1..7).collect(), true);
    for k in 1..4 {
        add(vec![k, 0, k + 3], false);
    }
    document.surfaces.insert(SURFACE, Surface::new(skeleton));
    document
}

fn rest(modeler: &mut Modeler) {
    let step = || Request::Step(Step { drag: None, iterations: 20 });
    assert!((0..600).any(|_| modeler.handle(step()).frame.settled));
}

fn open(document: &Document) -> Modeler {
    let mut modeler = Modeler::new();
    assert_eq!(modeler.handle(Request::OpenText { text: to_text(document) }).refused, None);
    rest(&mut modeler);
    modeler
}

/// Drags three feet of the dome up and down, so that every curve wants to pass the top in another direction.
fn twist(modeler: &mut Modeler) {
    for (point, height) in [(2, 0.5), (4, -0.3), (6, 0.4)] {
        let at = modeler.model().document.points[&PointId(point)];
        modeler.handle(Request::Grab(GrabTarget::Point(PointId(point))));
        for step in 1..=8 {
            let drag = Some(at + DVec3::Z * (height * f64::from(step) / 8.0));
            modeler.handle(Request::Step(Step { drag, iterations: 20 }));
        }
        assert!(modeler.handle(Request::Drop).committed.is_some());
    }
    rest(modeler);
}

/// What is seen at the top of a twisted dome.
struct Seen {
    /// Largest sine of the angle between the plane of the hub and a tangent, as the solver has it.
    exact: f64,
    /// The same as the samples have it to second order, on both sides.
    sampled: f64,
    /// Sine of the angle between the surface's normal and the plane's.
    tilt: f64,
    /// Mean curvature of the surface, and of the quadratic form that the curves' normal curvatures make.
    mean: [f64; 2],
}

fn look(spacing: f64) -> Seen {
    let mut modeler = open(&dome(spacing));
    twist(&mut modeler);
    let model = modeler.model();
    let networks = &modeler.relaxer().networks.bound;
    assert_eq!((networks.len(), networks[0].group.hubs.len()), (1, 1));
    let normal = networks[0].network.as_ref().unwrap().normals()[0];
    let (mut exact, mut sampled) = (0.0_f64, 0.0_f64);
    let mut rows = Vec::new();
    let (one, other) = normal.any_orthonormal_pair();
    for id in (2..5).map(CurveId) {
        let (shape, solver) = (&model.curves[&id], &modeler.relaxer().curves[&id].solver);
        let top = shape.sample_of(POLE).unwrap();
        let tangent = solver.tangents()[top];
        exact = exact.max(tangent.dot(normal).abs());
        let at = |sample: usize| shape.nodes[sample] - shape.nodes[top];
        for [near, far] in [[at(top + 1), at(top + 2)], [at(top - 1), at(top - 2)]] {
            sampled = sampled.max((near * 4.0 - far).try_normalize().unwrap().dot(normal).abs());
        }
        let (u, v) = (tangent.dot(one), tangent.dot(other));
        rows.push((DVec3::new(u * u, 2.0 * u * v, v * v), solver.curvatures()[top].dot(normal)));
    }
    // Cramer's rule for L11, L12, L22 as the three curvatures have them.
    let columns = [0, 1, 2].map(|k| DVec3::new(rows[0].0[k], rows[1].0[k], rows[2].0[k]));
    let kappa = DVec3::new(rows[0].1, rows[1].1, rows[2].1);
    let [a, b, c] = columns;
    let (l11, l22) = (kappa.dot(b.cross(c)) / a.dot(b.cross(c)), a.dot(b.cross(kappa)) / a.dot(b.cross(c)));
    let shape = &model.surfaces[&SURFACE];
    let sample = model.curves[&CurveId(2)].sample_of(POLE).unwrap();
    let followed = shape.embeddings.iter().find(|e| e.curve == CurveId(2)).unwrap();
    let bound = modeler.relaxer().surface(SURFACE, shape).unwrap();
    let node = bound.node(followed.vertices[sample]);
    let of_surface = bound.normals()[node as usize];
    let mean = bound.solver.curvatures().nth(node as usize).unwrap().mean * of_surface.dot(normal).signum();
    Seen { exact, sampled, tilt: of_surface.cross(normal).length(), mean: [mean, 0.5 * (l11 + l22)] }
}

/// Every curve alone has its tangent 0.1 and more out of the plane of the other two.
#[test]
fn curves_that_cross_have_one_tangent_plane_and_the_surface_has_it_too() {
    let [coarse, fine] = [0.12, 0.06].map(look);
    for seen in [&coarse, &fine] {
        assert!(seen.exact < 1e-12, "{}", seen.exact);
        assert!((seen.mean[0] / seen.mean[1] - 1.0).abs() < 0.06, "{:?}", seen.mean);
    }
    assert!(
        fine.sampled < 2e-3 && coarse.sampled / fine.sampled > 3.0,
        "{} {}",
        coarse.sampled,
        fine.sampled
    );
    assert!(fine.tilt < 3e-3 && coarse.tilt / fine.tilt > 1.6, "{} {}", coarse.tilt, fine.tilt);
}

#[test]
fn two_curves_make_no_hub_nor_do_curves_of_different_surfaces_nor_films() {
    let count = |document: &Document| hubs(document, &BTreeMap::new()).len();
    let whole = dome(0.2);
    assert_eq!(count(&whole), 1);
    let mut pair = whole.clone();
    pair.surfaces.get_mut(&SURFACE).unwrap().skeleton.curves.pop();
    assert_eq!(count(&pair), 0);
    // The third curve lies in another surface only.
    let mut other = pair.clone();
    let mut skeleton = whole.surfaces[&SURFACE].skeleton.clone();
    skeleton.curves.drain(..3);
    other.surfaces.insert(SurfaceId(2), Surface::new(skeleton));
    assert_eq!(count(&other), 0);
    let mut film = whole;
    film.objective = Objective::Membrane;
    assert_eq!(count(&film), 0);
}

/// A curve whose bending is let go at a hub is a curve by itself again.
#[test]
fn a_hub_can_come_and_go() {
    let mut modeler = open(&dome(0.2));
    twist(&mut modeler);
    let places = |modeler: &Modeler| modeler.model().curves[&CurveId(2)].nodes.clone();
    let together = places(&modeler);
    let of = ductile_spec::ObjectiveOf::Curve(CurveId(4));
    let edit = ductile_spec::Edit::Objective { of, objective: Some(Objective::Membrane) };
    assert_eq!(modeler.handle(Request::Edit(edit)).refused, None);
    rest(&mut modeler);
    let apart = |a: &[DVec3], b: &[DVec3]| a.iter().zip(b).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
    assert!(apart(&together, &places(&modeler)) > 1e-2);
    modeler.handle(Request::Undo);
    rest(&mut modeler);
    assert!(apart(&together, &places(&modeler)) < 1e-3);
}
