//! A hand faster than the spacing per frame: the mesh waits, catches up without a jump, and is mended under way where it would break.

#![allow(clippy::unwrap_used, reason = "a failing test should stop where it fails")]
#![allow(clippy::print_stdout, reason = "the figures are worth seeing with --nocapture")]

use acceptance::Bench;
use ductile_mesh::{Mesh, SurfaceTree};
use ductile_modeler::SurfaceShape;
use ductile_spec::{Example, GrabTarget, PointId, Request, SurfaceId};
use glam::{DVec3, dvec3};
use std::f64::consts::TAU;

const SURFACE: SurfaceId = SurfaceId(1);
/// Part of the spacing by which a surface may move in a frame without a hand.
const VISIBLE: f64 = 0.15;

fn surface(bench: &Bench) -> &SurfaceShape {
    &bench.modeler.model().surfaces[&SURFACE]
}

/// How the mesh stands: its longest edge in spacings, and the least Jacobian of a fit.
fn state(bench: &Bench) -> (f64, f64) {
    let shape = surface(bench);
    let edges = shape.mesh.edges().map(|e| {
        let [a, b] = shape.mesh.edge_vertices(e).map(|v| shape.positions[v.index()]);
        a.distance(b)
    });
    let longest = edges.fold(0.0, f64::max) / bench.modeler.model().spacing();
    let bound = bench.modeler.relaxer().surface(SURFACE, shape).unwrap();
    (longest, bound.resolution().map(|(_, jacobian)| jacobian).fold(f64::INFINITY, f64::min))
}

/// The largest distance of the vertices of either mesh from the other's triangles.
fn apart(one: (&Mesh, &[DVec3]), other: (&Mesh, &[DVec3])) -> f64 {
    let far = |(mesh, at): (&Mesh, &[DVec3]), (there, place): (&Mesh, &[DVec3])| {
        let tree = SurfaceTree::new(there, place);
        let distance = |p: DVec3| tree.nearest(there, p).unwrap().1.distance(p);
        mesh.vertices().map(|v| distance(at[v.index()])).fold(0.0, f64::max)
    };
    far(one, other).max(far(other, one))
}

/// The raised disc at rest with its highest point in the hand.
fn held() -> (Bench, PointId, DVec3) {
    let mut bench = Bench::with(Example::RaisedDisc);
    bench.rest(600);
    let document = bench.document();
    let (point, at) = document.points.iter().max_by(|a, b| a.1.z.total_cmp(&b.1.z)).unwrap();
    bench.accept(Request::Grab(GrabTarget::Point(*point)));
    (bench, *point, *at)
}

#[test]
fn connectivity_stays_while_the_hand_is_fast_and_the_mesh_bears_it() {
    let (mut bench, _, home) = held();
    let spacing = bench.modeler.model().spacing();
    let version = bench.step(Some(home)).frame.topology_version;
    let revision = surface(&bench).revision;
    let (mut last, mut most) = (home, 0.0_f64);
    for frame in 1..=60 {
        let angle = TAU * f64::from(frame) / 12.0;
        let to = home + dvec3(libm::cos(angle) - 1.0, libm::sin(angle), 0.0) * (2.4 * spacing);
        assert!(to.distance(last) > spacing, "the hand is too slow for this test");
        last = to;
        let reply = bench.step(Some(to));
        most = most.max(state(&bench).0);
        assert_eq!(reply.frame.topology_version, version, "frame {frame}");
        assert_eq!(surface(&bench).revision, revision, "frame {frame}");
    }
    println!("the longest edge came to {most:.2} of the spacing");
    assert!(most > 1.8, "a slow hand would not have had this mesh mended: {most}");
}

#[test]
fn catching_up_after_a_fast_drag_makes_no_visible_jump() {
    let (mut bench, _, home) = held();
    let spacing = bench.modeler.model().spacing();
    let mut to = home;
    for _ in 0..10 {
        to += DVec3::Z * (1.2 * spacing);
        bench.step(Some(to));
    }
    let (mut batches, mut worst, mut relaxing) = (0, 0.0_f64, 0.0_f64);
    for frame in 0..90 {
        let (mesh, positions) = (surface(&bench).mesh.clone(), surface(&bench).positions.clone());
        let before = surface(&bench).revision;
        bench.step(Some(to));
        let shape = surface(&bench);
        let moved = apart((&mesh, &positions), (&shape.mesh, &shape.positions)) / spacing;
        let is_batch = shape.revision != before;
        if is_batch {
            batches += 1;
            worst = worst.max(moved);
        } else if frame > 2 {
            relaxing = relaxing.max(moved);
        }
    }
    println!("{batches} batches, at most {worst:.4} of the spacing; relaxing alone {relaxing:.4}");
    assert!(batches > 5, "{batches}");
    assert!(worst < VISIBLE && relaxing < VISIBLE, "{worst} by a batch, {relaxing} by relaxing");
}

#[test]
fn a_point_drawn_far_out_fast_is_refined_under_way() {
    let mut bench = Bench::with(Example::Disc);
    bench.rest(300);
    let target = GrabTarget::Surface { surface: SURFACE, at: dvec3(0.02, 0.01, 0.0) };
    let grabbed = bench.accept(Request::Grab(target)).grabbed.unwrap();
    for _ in 0..30 {
        bench.step(None);
    }
    let spacing = bench.modeler.model().spacing();
    let count = surface(&bench).mesh.face_count();
    let (mut to, mut longest) = (grabbed.at, 0.0_f64);
    for _ in 0..40 {
        to += DVec3::Z * (1.5 * spacing);
        bench.step(Some(to));
        longest = longest.max(state(&bench).0);
    }
    let under_way = surface(&bench).mesh.face_count();
    let energy = bench.modeler.relaxer().states().map(|(_, state)| state.energy).sum::<f64>();
    let mut highest = energy;
    for _ in 0..60 {
        highest = highest.max(bench.step(Some(to)).frame.figures.energy);
    }
    let still = bench.step(Some(to)).frame.figures.energy;
    println!(
        "{count} triangles became {under_way} under way, edges up to {longest:.2} of the spacing; energy {energy:.2} when the \
         hand stops, at most {highest:.2} after that, then {still:.2}"
    );
    // A mesh that waits comes to edges of eleven spacings and half the energy, and passes through two and a half times as much.
    assert!(under_way > 2 * count && longest < 5.0, "{count}, {under_way}, {longest}");
    assert!((energy / still - 1.0).abs() < 0.02 && highest < 1.05 * still, "{energy}, {highest}, {still}");
}
