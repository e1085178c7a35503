//! Edge lengths that vary: by curvature, between surfaces that share a curve, and from region to region.

#![allow(clippy::unwrap_used, reason = "a failing test should stop where it fails")]
#![allow(clippy::print_stdout, reason = "the figures are worth seeing with --nocapture")]

use acceptance::Bench;
use acceptance::shapes::{ridged_saddle, torus};
use acceptance::solved::{deviation, opened, solve};
use ductile_modeler::SurfaceShape;
use ductile_spec::{
    Border, CurveId, Density, Document, Edit, Example, GrabTarget, PointId, Request, SpacingOf, SurfaceId,
    Through, to_text,
};
use glam::{DVec3, dvec3};

fn surface(bench: &Bench) -> &SurfaceShape {
    bench.modeler.model().surfaces.values().next().unwrap()
}

fn by_curvature(document: &Document) -> Document {
    Document { density: Density::Curvature, ..document.clone() }
}

/// The raised disc with a small bump beside its summit: four points hold the plate, one between them lifts it.
fn bumpy_disc() -> Document {
    let mut bench = Bench::with(Example::RaisedDisc);
    bench.rest(600);
    let (middle, reach) = (dvec3(0.5, 0.1, 0.3), 0.14);
    let id = SurfaceId(1);
    for aside in [DVec3::X, DVec3::Y, DVec3::NEG_X, DVec3::NEG_Y] {
        bench.edit(Edit::Pin { surface: id, at: middle + aside * reach });
        bench.rest(600);
    }
    bench.edit(Edit::Pin { surface: id, at: middle });
    let (point, at) = bench.document().points.into_iter().next_back().unwrap();
    bench.edit(Edit::Move { point, to: at + DVec3::Z * 0.06 });
    bench.document()
}

/// Solves a document at spacings of both densities and prints what they cost and how far they are off.
fn compared(name: &str, document: &Document, spacings: [&[f64]; 2], fine: f64) -> [Vec<(usize, f64)>; 2] {
    let fine = solve(document, fine);
    let size = fine.positions.iter().map(|p| p.length()).fold(0.0, f64::max);
    let of = |density: Density, spacing: f64| {
        let shape = solve(&Document { density, ..document.clone() }, spacing);
        let (worst, mean) = deviation(&shape, &fine);
        println!(
            "{name}, {density:?} at {spacing}: {} nodes, energy off by {:.2} %, worst {:.3} %, rms {:.3} % of the size",
            shape.positions.len(),
            100.0 * (shape.energy / fine.energy - 1.0),
            100.0 * worst / size,
            100.0 * mean / size
        );
        (shape.positions.len(), mean / size)
    };
    let [uniform, graded] = spacings;
    [
        uniform.iter().map(|h| of(Density::Uniform, *h)).collect(),
        graded.iter().map(|h| of(Density::Curvature, *h)).collect(),
    ]
}

#[test]
fn half_the_nodes_tell_as_much_where_most_of_a_shape_is_calm() {
    let [uniform, graded] = compared("bumpy disc", &bumpy_disc(), [&[0.08, 0.065], &[0.08, 0.065]], 0.025);
    for ((nodes, _), (fewer, _)) in uniform.iter().zip(&graded) {
        assert!(2 * fewer < *nodes, "{fewer} of {nodes}");
    }
    // How the triangles happen to lie under the bump makes a tenth of the error of a single mesh.
    let mean =
        |meshes: &[(usize, f64)]| meshes.iter().map(|(_, error)| error).sum::<f64>() / meshes.len() as f64;
    assert!(mean(&graded) < 1.05 * mean(&uniform), "{graded:?} instead of {uniform:?}");
}

#[test]
fn a_shape_that_bends_everywhere_loses_nothing() {
    let [uniform, graded] = compared("torus", &torus(), [&[0.4, 0.3], &[0.4, 0.2]], 0.12);
    assert!(graded[0].0 < uniform[1].0 && graded[0].1 < uniform[0].1, "{uniform:?} {graded:?}");
    let [uniform, graded] = compared("ridged saddle", &ridged_saddle(), [&[0.105], &[0.08]], 0.03);
    assert!(graded[0].0 < uniform[0].0 && graded[0].1 < 0.7 * uniform[0].1, "{uniform:?} {graded:?}");
}

#[test]
fn every_bend_is_resolved() {
    for document in [bumpy_disc(), torus()] {
        let spacing = 0.1 * document.extent().1;
        let mut bench = opened(&by_curvature(&document), spacing);
        bench.rest(600);
        let (model, shape) = (bench.modeler.model(), surface(&bench));
        let bound = bench.modeler.relaxer().surface(SurfaceId(1), shape).unwrap();
        let floor = 0.1 * spacing;
        for (v, (turn, jacobian)) in bound.vertices().iter().zip(bound.resolution()) {
            // A point that holds a plate bends it without bound; there the shortest edge is what decides.
            let is_control = shape.controlled().any(|c| c == *v);
            let is_shortest = shape.wanted_at(*v) < 1.2 * floor;
            assert!(
                (turn <= 0.7 && jacobian >= 0.7) || is_control || is_shortest,
                "{v:?}: {turn} {jacobian}"
            );
        }
        assert!(model.node_count() > 100);
    }
}

/// The mean length of the edges whose middle is somewhere.
fn mean_edge(shape: &SurfaceShape, is_there: impl Fn(DVec3) -> bool) -> f64 {
    let ends = shape.mesh.edges().map(|e| shape.mesh.edge_vertices(e).map(|v| shape.positions[v.index()]));
    let lengths: Vec<f64> =
        ends.filter(|[a, b]| is_there(a.midpoint(*b))).map(|[a, b]| a.distance(b)).collect();
    assert!(lengths.len() > 10, "{} edges", lengths.len());
    lengths.iter().sum::<f64>() / lengths.len() as f64
}

/// Wanted lengths that differ between neighbours by more than the slope and the band allow.
fn is_graded(shape: &SurfaceShape) {
    for e in shape.mesh.edges() {
        let [a, b] = shape.mesh.edge_vertices(e);
        let step = shape.positions[a.index()].distance(shape.positions[b.index()]);
        let (low, high) =
            (shape.wanted_at(a).min(shape.wanted_at(b)), shape.wanted_at(a).max(shape.wanted_at(b)));
        assert!(high <= 1.35 * (low + 0.25 * step), "{low} beside {high} over {step}");
        assert!(step < 1.9 * high, "an edge of {step} where {high} is wanted");
    }
}

#[test]
fn a_trembling_hand_takes_no_vertex_away() {
    let mut bench = Bench::with(Example::RaisedDisc);
    bench.edit(Edit::Density { of: None, density: Some(Density::Curvature) });
    bench.rest(600);
    let (point, _) = bench.document().points.into_iter().max_by(|a, b| a.1.z.total_cmp(&b.1.z)).unwrap();
    let counts = tremble(&mut bench, point);
    let (first, last) = (counts[0], counts[counts.len() - 1]);
    assert!(counts.is_sorted() && last <= first + 19, "{counts:?}");
}

/// Against the short edges at the end of a curve the hand trembles twice as far. What had hardly room may go, but nothing comes and goes.
#[test]
fn a_hand_that_trembles_at_the_end_of_a_curve_sets_nothing_ringing() {
    let counts = tremble(&mut opened(&ridged_saddle(), 0.12), PointId(9));
    assert!(counts.len() <= 4, "{counts:?}");
}

/// Shakes a point by a fiftieth of the spacing; returns the numbers of vertices that there were, one after the other.
fn tremble(bench: &mut Bench, point: PointId) -> Vec<usize> {
    let (spacing, home) = (surface(bench).spacing, bench.document().points[&point]);
    bench.accept(Request::Grab(GrabTarget::Point(point)));
    // The mesh is looked after only while the hand pauses, so it pauses between the tremors.
    bench.step(Some(home));
    let mut counts = vec![surface(bench).mesh.vertex_count()];
    for frame in 0..200_u32 {
        let (sin, cos) = libm::sincos(2.4 * f64::from(frame));
        bench.step(Some(home + dvec3(cos, sin, libm::sin(f64::from(frame))) * 0.02 * spacing));
        for _ in 0..4 {
            bench.step(None);
        }
        counts.push(surface(bench).mesh.vertex_count());
        counts.dedup();
    }
    println!("numbers of vertices {counts:?}");
    counts
}

/// Whether edges grow from the ends of the ridge as they should: a third as long right there, all as long as said away from it.
fn is_sharp(bench: &Bench, ends: [DVec3; 2]) {
    let shape = surface(bench);
    let from_ends = |at: DVec3| ends.iter().map(|end| end.distance(at)).fold(f64::INFINITY, f64::min);
    let [at_ends, beside, away] = [(0.0, 0.06), (0.06, 0.15), (0.3, 0.5)]
        .map(|(low, high)| mean_edge(shape, |at| from_ends(at) > low && from_ends(at) < high));
    println!("{} nodes, edges of {at_ends} at ends, {beside} beside, {away} away", shape.mesh.vertex_count());
    let spacing = shape.spacing;
    assert!(
        at_ends < 0.62 * spacing && beside < 0.85 * spacing && at_ends < 0.85 * beside,
        "{at_ends} {beside}"
    );
    assert!(away > 0.85 * spacing && away < 1.15 * spacing, "{away}");
    is_graded(shape);
}

#[test]
fn edges_are_short_where_a_curve_ends_inside_whatever_is_done_to_it() {
    let ridge = [PointId(9), PointId(11)];
    let mut bench = opened(&ridged_saddle(), 0.1);
    let places = |bench: &Bench| ridge.map(|id| bench.document().points[&id]);
    is_sharp(&bench, places(&bench));
    let nodes = surface(&bench).mesh.vertex_count();
    // The samples of the curve crowd with them.
    let curve = &bench.modeler.model().curves[&CurveId(2)].nodes;
    let (first, middle) =
        (curve[0].distance(curve[1]), curve[curve.len() / 2].distance(curve[curve.len() / 2 - 1]));
    assert!(first < 0.6 * middle, "{first} and {middle}");
    // A dragged end takes the short edges with it, and home again.
    let home = places(&bench)[0];
    for to in [home + dvec3(0.1, -0.25, 0.1), home] {
        bench.edit(Edit::Move { point: ridge[0], to });
        bench.rest(600);
        is_sharp(&bench, places(&bench));
    }
    let again = surface(&bench).mesh.vertex_count() as f64;
    assert!((again / nodes as f64 - 1.0).abs() < 0.1, "{nodes} nodes became {again}");
    // A slit has the same ends, opened anew as well.
    bench.edit(Edit::Split { border: Border::Curve(CurveId(2)) });
    bench.rest(600);
    is_sharp(&bench, places(&bench));
    is_sharp(&opened(&bench.document(), 0.1), places(&bench));
    // Without a curve that ends inside there is nothing to be graded for.
    let mut bench = opened(&ridged_saddle(), 0.1);
    bench.edit(Edit::DeleteCurve { curve: CurveId(2) });
    bench.rest(600);
    assert!(surface(&bench).wanted.is_empty());
}

#[test]
fn density_comes_back_with_the_shape() {
    let mut bench = Bench::with(Example::RaisedDisc);
    bench.edit(Edit::Density { of: None, density: Some(Density::Curvature) });
    let energy = bench.rest(600);
    let (point, home) = {
        let document = bench.document();
        let (id, at) = document.points.iter().max_by(|a, b| a.1.z.total_cmp(&b.1.z)).unwrap();
        (*id, *at)
    };
    let wanted = |bench: &Bench| mean_edge(surface(bench), |at| at.distance(home) < 0.25);
    let (nodes, fine) = (surface(&bench).mesh.vertex_count(), wanted(&bench));
    bench.edit(Edit::Move { point, to: dvec3(0.5, 0.0, 0.2) });
    bench.rest(600);
    assert!(mean_edge(surface(&bench), |at| at.truncate().distance(home.truncate()) < 0.2) > 0.0);
    bench.edit(Edit::Move { point, to: home });
    let back = bench.rest(600);
    let (count, again) = (surface(&bench).mesh.vertex_count(), wanted(&bench));
    println!("{nodes} nodes, {fine} at the summit; then {count} and {again}; energy {energy} and {back}");
    assert!((count as f64 / nodes as f64 - 1.0).abs() < 0.2, "{nodes} nodes became {count}");
    assert!((again / fine - 1.0).abs() < 0.2, "edges of {fine} became {again}");
    assert!((back / energy - 1.0).abs() < 0.01, "{energy} became {back}");
}

#[test]
fn density_is_a_choice_like_others() {
    let mut bench = Bench::with(Example::RaisedDisc);
    bench.rest(600);
    let (before, uniform) = (bench.document(), surface(&bench).mesh.vertex_count());
    let id = SurfaceId(1);
    bench.edit(Edit::Density { of: Some(id), density: Some(Density::Curvature) });
    assert_eq!(bench.document().surfaces[&id].density, Some(Density::Curvature));
    bench.rest(600);
    assert!(4 * surface(&bench).mesh.vertex_count() < 3 * uniform);
    is_graded(surface(&bench));
    // What is written down gives the same mesh, about.
    let mut again = Bench::new();
    again.accept(Request::OpenText { text: to_text(&bench.document()) });
    again.rest(600);
    let [one, other] = [&bench, &again].map(|bench| surface(bench).mesh.vertex_count() as f64);
    assert!((one / other - 1.0).abs() < 0.2, "{one} and {other}");
    bench.accept(Request::Undo);
    assert_eq!(bench.document(), before);
    bench.rest(600);
    assert!(surface(&bench).wanted.is_empty());
    let unknown = Edit::Density { of: Some(SurfaceId(9)), density: None };
    assert!(bench.send(Request::Edit(unknown)).refused.is_some());
}

#[test]
fn of_two_surfaces_at_a_curve_the_coarser_grades_to_the_finer() {
    let mut bench = Bench::with(Example::Cylinder);
    bench.rest(600);
    bench.edit(Edit::Sheet { boundary: CurveId(2) });
    let (tube, lid) = (SurfaceId(1), SurfaceId(2));
    let spacing = bench.modeler.model().spacing_of(tube);
    for fine in [0.5 * spacing, 2.0 * spacing] {
        bench.edit(Edit::Spacing { of: SpacingOf::Surface(lid), spacing: Some(fine) });
        assert_eq!(bench.document().surfaces[&lid].spacing, Some(fine));
        bench.rest(600);
        let model = bench.modeler.model();
        let [tube, lid] = [tube, lid].map(|id| &model.surfaces[&id]);
        let curve = &model.curves[&CurveId(2)].nodes;
        let mean = curve.iter().zip(curve.iter().cycle().skip(1)).map(|(a, b)| a.distance(*b)).sum::<f64>()
            / curve.len() as f64;
        let finer = fine.min(spacing);
        assert!(mean > 0.7 * finer && mean < 1.36 * finer, "samples {mean} apart, {finer} wanted");
        let height = curve[0].z;
        let far = |at: DVec3| (at.z - height).abs() > 0.8;
        let far_edge = mean_edge(tube, far);
        assert!(far_edge > 0.75 * spacing && far_edge < 1.25 * spacing, "{far_edge} far from the lid");
        let inner = mean_edge(lid, |at| at.truncate().length() < 0.3);
        assert!(inner > 0.7 * fine && inner < 1.3 * fine, "{inner} in the lid, {fine} wanted");
        is_graded(tube);
        is_graded(lid);
    }
    bench.edit(Edit::Spacing { of: SpacingOf::Surface(lid), spacing: None });
    bench.rest(600);
    assert!(bench.modeler.model().surfaces.values().all(|shape| shape.wanted.is_empty()));
}

#[test]
fn a_region_has_a_density_of_its_own() {
    let mut document = torus();
    document.spacing = Some(0.3);
    let mut bench = Bench::new();
    bench.accept(Request::OpenText { text: to_text(&document) });
    bench.rest(600);
    // Three meridians cut the torus; the middle of the first piece lies at a sixth of a turn.
    let angle = |at: DVec3| libm::atan2(at.y, at.x).rem_euclid(std::f64::consts::TAU) / std::f64::consts::TAU;
    let of = SpacingOf::Region { surface: SurfaceId(1), at: dvec3(1.0, 3.0_f64.sqrt(), 0.0) * 1.4 };
    bench.edit(Edit::Spacing { of, spacing: Some(0.15) });
    let regions = bench.document().surfaces[&SurfaceId(1)].regions.clone();
    assert!(matches!(regions[..], [r] if r.spacing == Some(0.15) && r.objective.is_none()), "{regions:?}");
    bench.rest(600);
    let shape = surface(&bench);
    let within = mean_edge(shape, |at| (angle(at) - 1.0 / 6.0).abs() < 0.1);
    let beyond = mean_edge(shape, |at| (angle(at) - 4.0 / 6.0).abs() < 0.1);
    assert!(within > 0.11 && within < 0.19 && beyond > 0.22 && beyond < 0.38, "{within} and {beyond}");
    is_graded(shape);
    // Given back, it is gone from the document and from the mesh.
    bench.edit(Edit::Spacing { of, spacing: None });
    assert_eq!(bench.document(), document);
    bench.rest(600);
    assert!(surface(&bench).wanted.is_empty());
    let mut nameless = bench.document();
    let region = ductile_spec::Region { objective: None, spacing: None, ..regions[0] };
    nameless.surfaces.get_mut(&SurfaceId(1)).unwrap().regions.push(region);
    assert!(nameless.validate().unwrap_err().to_string().contains("nothing is said"));
}

#[test]
fn samples_of_a_free_curve_crowd_where_it_bends() {
    let mut bench = Bench::new();
    // A hairpin.
    let places = [(-6.0, 0.5), (0.0, 0.5), (0.5, 0.0), (0.0, -0.5), (-6.0, -0.5)];
    let through = places.into_iter().map(|(x, y)| Through::Place(dvec3(x, y, 0.0))).collect();
    bench.edit(Edit::Curve { through, closed: false });
    bench.edit(Edit::Spacing { of: SpacingOf::Document, spacing: Some(0.4) });
    bench.rest(600);
    let spread = |bench: &Bench| {
        let nodes = &bench.modeler.model().curves[&CurveId(1)].nodes;
        let lengths: Vec<(f64, f64)> =
            nodes.windows(2).map(|w| (w[0].midpoint(w[1]).length(), w[0].distance(w[1]))).collect();
        let mean = |is_there: &dyn Fn(f64) -> bool| {
            let there: Vec<f64> = lengths.iter().filter(|(at, _)| is_there(*at)).map(|(_, l)| *l).collect();
            there.iter().sum::<f64>() / there.len() as f64
        };
        (mean(&|at| at < 0.6), mean(&|at| at > 2.0 && at < 5.0))
    };
    let (near, far) = spread(&bench);
    assert!(near > 0.8 * far, "evenly: {near} and {far}");
    bench.edit(Edit::Density { of: None, density: Some(Density::Curvature) });
    bench.rest(600);
    let (near, far) = spread(&bench);
    println!("by curvature {near} and {far}");
    assert!(near < 0.6 * far, "by curvature: {near} and {far}");
}
