//! Free curves that become control curves of a surface near which they lie (thesis sections 4.2.3 and 7.3.3).

#![allow(clippy::unwrap_used, reason = "a failing test should stop where it fails")]

use acceptance::Bench;
use acceptance::kinds::kinds;
use ductile_modeler::Model;
use ductile_spec::{
    CageForm, CageSource, CurveId, Edit, Example, PointId, Request, SpacingOf, SurfaceId, Through, from_text,
};
use glam::{DVec3, dvec3};

const SURFACE: SurfaceId = SurfaceId(1);

/// The unit disc, and curves through space over it.
fn disc(curves: &[(Vec<DVec3>, bool)]) -> Bench {
    let mut bench = Bench::with(Example::Disc);
    bench.edit(Edit::Spacing { of: SpacingOf::Document, spacing: Some(0.14) });
    for (through, closed) in curves {
        let through = through.iter().map(|at| Through::Place(*at)).collect();
        bench.edit(Edit::Curve { through, closed: *closed });
    }
    bench.rest(600);
    bench
}

fn ring(radius: f64, count: u32, height: impl Fn(f64) -> f64) -> Vec<DVec3> {
    let corner = |k: u32| {
        let (sin, cos) = libm::sincos(f64::from(k) * core::f64::consts::TAU / f64::from(count) + 0.1);
        dvec3(radius * cos, radius * sin, height(cos))
    };
    (0..count).map(corner).collect()
}

fn embed(curve: u32) -> Edit {
    Edit::Embed { curve: CurveId(curve), surface: SURFACE }
}

/// Embeds; the document means the same surface, undo and redo bring back the same texts.
fn act(bench: &mut Bench, curve: u32) {
    let before = bench.document.clone();
    bench.edit(embed(curve));
    let after = bench.document.clone();
    let again = Model::from_document(from_text(&after).unwrap()).unwrap();
    assert_eq!(kinds(&again), kinds(bench.modeler.model()), "{after}");
    bench.accept(Request::Undo);
    assert_eq!(bench.document, before);
    bench.accept(Request::Redo);
    assert_eq!(bench.document, after);
}

fn refusal(bench: &mut Bench, edit: Edit) -> String {
    let before = bench.document.clone();
    let reply = bench.send(Request::Edit(edit));
    assert_eq!(bench.document, before);
    reply.refused.expect("it must be refused").reason
}

/// Largest distance of the samples of a curve from the vertices of the surface that follow them.
fn misfit(bench: &Bench, curve: u32) -> f64 {
    let model = bench.modeler.model();
    let shape = &model.surfaces[&SURFACE];
    let embedded = shape.embeddings.iter().find(|e| e.curve == CurveId(curve)).unwrap();
    let nodes = &model.curves[&CurveId(curve)].nodes;
    assert_eq!(embedded.vertices.len(), nodes.len());
    let off = embedded.vertices.iter().zip(nodes).map(|(v, at)| shape.positions[v.index()].distance(*at));
    off.fold(0.0, f64::max)
}

#[test]
fn the_curve_stays_and_the_surface_moves_to_it() {
    let mut bench = disc(&[(ring(0.5, 6, |x| 0.25 + 0.1 * x), true)]);
    let before = (bench.document().points, bench.document().curves);
    act(&mut bench, 2);
    assert_eq!((bench.document().points, bench.document().curves), before, "no point of it has moved");
    assert_eq!(bench.document().surfaces[&SURFACE].skeleton.curves.len(), 2);
    bench.rest(900);
    assert!(misfit(&bench, 2) < 1e-9, "{}", misfit(&bench, 2));
    // It is a control curve like others: moved, the surface follows.
    bench.edit(Edit::Move { point: PointId(5), to: dvec3(0.5, 0.1, 0.8) });
    bench.rest(900);
    assert!(misfit(&bench, 2) < 1e-9, "{}", misfit(&bench, 2));
    assert_eq!(kinds(bench.modeler.model()), [(SURFACE, (1, 1, true))]);
}

#[test]
fn an_open_curve_ends_inside_or_on_the_rim() {
    let inside = vec![dvec3(-0.5, 0.0, 0.1), dvec3(0.0, 0.1, 0.3), dvec3(0.5, 0.0, 0.1)];
    let across = vec![dvec3(-0.94, -0.33, 0.04), dvec3(0.0, -0.4, 0.2), dvec3(0.99, -0.1, 0.03)];
    let mut bench = disc(&[(inside, false), (across, false)]);
    let rim = bench.document().curves[&CurveId(1)].through.clone();
    let points = bench.document().points;
    act(&mut bench, 2);
    assert_eq!(bench.document().curves[&CurveId(1)].through, rim);
    act(&mut bench, 3);
    bench.rest(900);
    let document = bench.document();
    let ends = &document.curves[&CurveId(3)].through;
    let shared = ends.iter().filter(|point| document.curves[&CurveId(1)].through.contains(point)).count();
    assert_eq!(shared, 2, "the rim passes through both ends");
    assert!(points.iter().all(|(point, at)| document.points[point] == *at));
    for curve in [1, 2, 3] {
        assert!(misfit(&bench, curve) < 1e-9, "{curve}: {}", misfit(&bench, curve));
    }
}

#[test]
fn curves_that_cross_get_points_in_common_to_which_the_old_one_is_carried() {
    // The second line runs below a point of the ring, which becomes the common one.
    for (y, points) in [(-0.2, 8), (0.05, 7)] {
        let mut bench = disc(&[(ring(0.5, 6, |_| 0.2), true)]);
        let along = [-0.8, 0.0, 0.8].map(|x| dvec3(x, y, 0.0)).to_vec();
        bench.edit(Edit::SLoop { surface: SURFACE, along, closed: false });
        bench.rest(600);
        act(&mut bench, 2);
        let document = bench.document();
        let [ring, line] = [2, 3].map(|id| document.curves[&CurveId(id)].through.clone());
        let shared: Vec<_> = line.iter().filter(|point| ring.contains(point)).collect();
        assert_eq!((ring.len(), line.len(), shared.len()), (points, 5, 2));
        assert!(shared.iter().all(|point| (document.points[point].z - 0.2).abs() < 1e-3), "on the ring");
        bench.rest(900);
        for curve in [1, 2, 3] {
            assert!(misfit(&bench, curve) < 1e-9, "{curve}: {}", misfit(&bench, curve));
        }
    }
}

#[test]
fn a_curve_without_a_projection_is_refused_with_the_place() {
    let beyond = vec![dvec3(0.0, 0.0, 0.2), dvec3(0.8, 0.0, 0.2), dvec3(1.6, 0.0, 0.2)];
    let eight = [(-0.2, -0.12, 0.1), (0.2, 0.12, 0.2), (0.2, -0.12, 0.3), (-0.2, 0.12, 0.4)];
    let eight = eight.map(|(x, y, z)| dvec3(x, y, z)).to_vec();
    let over_point = vec![dvec3(-0.4, 0.6, 0.1), dvec3(0.0, 0.6, 0.1), dvec3(0.4, 0.6, 0.1)];
    let mut bench = disc(&[(beyond, false), (eight, true), (over_point, false)]);
    bench.edit(Edit::Pin { surface: SURFACE, at: dvec3(0.0, 0.6, 0.0) });
    for (curve, why) in [
        (1, "lies in surface 1 already"),
        (2, "does not lie over surface 1 at [1."),
        (3, "touch"),
        (4, "control point of surface 1 that is not its own"),
        (9, "curve 9 does not exist"),
    ] {
        let told = refusal(&mut bench, embed(curve));
        assert!(told.contains(why), "{curve}: {told}");
    }
    let from = CageSource::BuiltIn { form: CageForm::Cube, centre: DVec3::Z, size: 1.0 };
    bench.edit(Edit::Cage { from });
    let told = refusal(&mut bench, Edit::Embed { curve: CurveId(2), surface: SurfaceId(2) });
    assert!(told.contains("cage"), "{told}");
}
