//! Sliding features (thesis section 7.3.4): curves that lie in a surface migrate through its triangulation as their controls
//! move, and carry with them what is attached there. A handle is led right round the torus that it stands on.

#![allow(clippy::unwrap_used, reason = "a failing test should stop where it fails")]
#![allow(clippy::print_stdout, reason = "the figures are worth seeing with --nocapture")]

use acceptance::Bench;
use ductile_mesh::summary;
use ductile_spec::{CurveId, Edit, Example, PointId, Request, SurfaceId};
use glam::DVec3;
use std::collections::BTreeSet;

/// Steps of the way round: the rims of the handle move by about an edge each.
const STEPS: u32 = 72;
/// Relaxation between one and the next, as much as a hand leaves time for.
const FRAMES: u32 = 6;

#[test]
fn a_handle_is_led_right_round_its_torus() {
    let mut bench = Bench::with(Example::Handle);
    let before = bench.rest(600);
    let surface = SurfaceId(1);
    let kind = |bench: &Bench| {
        let summary = summary(&bench.modeler.model().surfaces[&surface].mesh);
        (summary.euler, summary.boundaries, summary.components, summary.is_orientable)
    };
    assert_eq!(kind(&bench), (-2, 0, 1, true));
    // The torus stands on its first three curves; all others belong to the handle and its rims.
    let document = bench.document();
    let of_handle: BTreeSet<PointId> = document
        .curves
        .iter()
        .filter(|(id, _)| **id > CurveId(3))
        .flat_map(|(_, curve)| curve.through.iter().copied())
        .collect();
    let at: Vec<(PointId, DVec3)> = of_handle.iter().map(|id| (*id, document.points[id])).collect();
    let mut worst = f64::INFINITY;
    for step in 1..=STEPS {
        let (sin, cos) = libm::sincos(f64::from(step % STEPS) * core::f64::consts::TAU / f64::from(STEPS));
        for (point, at) in &at {
            let to = DVec3::new(at.x * cos - at.y * sin, at.x * sin + at.y * cos, at.z);
            let reply = bench.modeler.handle(Request::Edit(Edit::Move { point: *point, to }));
            assert_eq!(reply.refused, None);
            reply.committed.unwrap().document.clone_into(&mut bench.document);
        }
        for _ in 0..FRAMES {
            bench.step(None);
        }
        assert_eq!(kind(&bench), (-2, 0, 1, true), "step {step}");
        let (least, _) = angles(&bench);
        worst = worst.min(least);
    }
    assert_eq!(bench.document(), document, "once round is where it began");
    let after = bench.rest(600);
    let (least, centile) = angles(&bench);
    println!(
        "energy {before} before, {after} after; angles on the way {:.1}, at rest {:.1} least, {:.1} first percentile",
        worst.to_degrees(),
        least.to_degrees(),
        centile.to_degrees()
    );
    assert!((after - before).abs() < 0.01 * before, "{after} and {before}");
    assert!(least.to_degrees() > 25.0 && centile.to_degrees() > 36.0, "a good triangulation");
}

/// Thesis figure 7.2: the script makes the handle on the right of the torus, and leads it to where the page looks from at first.
#[test]
fn the_handle_of_the_example_stands_in_front() {
    let mut bench = Bench::with(Example::Handle);
    bench.rest(600);
    let shape = &bench.modeler.model().surfaces[&SurfaceId(1)];
    let places = shape.mesh.vertices().map(|v| shape.positions[v.index()]);
    // Farther out than the torus, which ends at 1.5.
    let out: Vec<DVec3> = places.filter(|at| at.truncate().length() > 1.7).collect();
    assert!(out.len() > 100, "{} vertices stand out", out.len());
    let azimuths: Vec<f64> = out.iter().map(|at| libm::atan2(at.y, at.x).to_degrees()).collect();
    let least = azimuths.iter().copied().fold(f64::INFINITY, f64::min);
    let most = azimuths.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    println!("the handle stands between {least:.1} and {most:.1} degrees");
    assert!((0.5 * (least + most) + 60.0).abs() < 2.0, "{least} to {most}: in front");
    assert!(most - least < 80.0, "{least} to {most}: as wide as it was made");
}

/// The least angle of the surface, and the one that a hundredth of all are below.
fn angles(bench: &Bench) -> (f64, f64) {
    let shape = &bench.modeler.model().surfaces[&SurfaceId(1)];
    let mut all: Vec<f64> = shape
        .mesh
        .faces()
        .flat_map(|f| f.halfedges())
        .map(|h| ductile_mesh::measure::corner_angle(&shape.mesh, &shape.positions, h))
        .collect();
    all.sort_by(f64::total_cmp);
    (all[0], all[all.len() / 100])
}
