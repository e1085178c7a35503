//! Sliding features (thesis section 7.3.4): curves that lie in a surface migrate through its triangulation as their controls
//! move, and carry with them what is attached there. A handle is led right round the torus that it stands on.

#![allow(clippy::unwrap_used, reason = "a failing test should stop where it fails")]
#![allow(clippy::print_stdout, reason = "the figures are worth seeing with --nocapture")]

use acceptance::Bench;
use ductile_mesh::summary;
use ductile_modeler::Modeler;
use ductile_spec::{CurveId, Document, Edit, Example, PointId, Request, Step, SurfaceId, to_text};
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
    assert_eq!(kind(&bench.modeler), KIND);
    let document = bench.document();
    let at = handle_of(&document);
    let mut worst = f64::INFINITY;
    for step in 1..=STEPS {
        lead(&mut bench, &at, step % STEPS, 1.0);
        assert_eq!(kind(&bench.modeler), KIND, "step {step}");
        let (least, _) = angles(&bench);
        worst = worst.min(least);
    }
    let round = bench.document();
    assert_eq!((&round.points, &round.curves), (&document.points, &document.curves), "where it began");
    let after = bench.rest(600);
    let (least, centile) = angles(&bench);
    let opened = opened(&round);
    println!(
        "energy {before} before, {after} after, {opened} opened; angles on the way {:.1}, at rest {:.1} least, {:.1} first percentile",
        worst.to_degrees(),
        least.to_degrees(),
        centile.to_degrees()
    );
    assert!((after - before).abs() < 0.01 * before, "{after} and {before}");
    assert!((after - opened).abs() < 0.01 * opened, "{after} and {opened}");
    assert!(least.to_degrees() > 25.0 && centile.to_degrees() > 36.0, "a good triangulation");
}

/// The skeleton was dragged along and wound round the torus: at 90° the document opened to an energy of 210, later to folds.
#[test]
fn a_handle_that_was_slid_far_opens_where_it_is() {
    let mut bench = Bench::with(Example::Handle);
    bench.rest(600);
    let at = handle_of(&bench.document());
    let triangles = |bench: &Bench| bench.document().surfaces[&SurfaceId(1)].skeleton.triangles.clone();
    let mut renewed = 0;
    for step in 1..=STEPS / 2 {
        let before = triangles(&bench);
        lead(&mut bench, &at, step, -1.0);
        if triangles(&bench) != before {
            renewed += 1;
            // A part of the act that found it out, not one of its own.
            let (after, acts) = (bench.document.clone(), at.len());
            (0..acts).for_each(|_| drop(bench.accept(Request::Undo)));
            assert_eq!(triangles(&bench), before, "step {step}");
            (0..acts).for_each(|_| drop(bench.accept(Request::Redo)));
            assert_eq!(bench.document, after, "step {step}");
        }
        if step % (STEPS / 4) == 0 {
            let document = bench.document();
            // At rest it would be what its document opens to, if that is near.
            let live = rest(&mut bench.modeler.clone());
            let opened = opened(&document);
            println!("{} degrees: {live} live, {opened} opened", 360 / STEPS * step);
            assert!((live - opened).abs() < 0.01 * live, "{live} and {opened}");
        }
    }
    println!("the skeleton was taken anew {renewed} times");
    assert!((1..5).contains(&renewed), "{renewed}");
}

/// Euler characteristic, boundaries, components, orientability of a torus with a handle.
const KIND: (i64, usize, usize, bool) = (-2, 0, 1, true);

fn kind(modeler: &Modeler) -> (i64, usize, usize, bool) {
    let summary = summary(&modeler.model().surfaces[&SurfaceId(1)].mesh);
    (summary.euler, summary.boundaries, summary.components, summary.is_orientable)
}

/// The controls of the handle and its rims, where they are: the torus stands on its first three curves.
fn handle_of(document: &Document) -> Vec<(PointId, DVec3)> {
    let of_handle: BTreeSet<PointId> = document
        .curves
        .iter()
        .filter(|(id, _)| **id > CurveId(3))
        .flat_map(|(_, curve)| curve.through.iter().copied())
        .collect();
    of_handle.iter().map(|id| (*id, document.points[id])).collect()
}

/// Moves the handle on to its place after so many steps.
fn lead(bench: &mut Bench, at: &[(PointId, DVec3)], step: u32, sense: f64) {
    let (sin, cos) = libm::sincos(sense * f64::from(step) * core::f64::consts::TAU / f64::from(STEPS));
    for (point, at) in at {
        let to = DVec3::new(at.x * cos - at.y * sin, at.x * sin + at.y * cos, at.z);
        let reply = bench.modeler.handle(Request::Edit(Edit::Move { point: *point, to }));
        assert_eq!(reply.refused, None);
        reply.committed.unwrap().document.clone_into(&mut bench.document);
    }
    for _ in 0..FRAMES {
        bench.step(None);
    }
}

/// Steps until nothing moves; gives the energy.
fn rest(modeler: &mut Modeler) -> f64 {
    let mut step = || modeler.handle(Request::Step(Step { drag: None, iterations: 20 })).frame;
    let rested = (0..600).map(|_| step()).find(|frame| frame.settled);
    rested.expect("it comes to rest").figures.energy
}

/// The energy at rest of what a document opens to, which is a torus with a handle.
fn opened(document: &Document) -> f64 {
    let mut modeler = Modeler::new();
    modeler.handle(Request::OpenText { text: to_text(document) });
    assert_eq!(kind(&modeler), KIND);
    rest(&mut modeler)
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
