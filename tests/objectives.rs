//! What a document, a surface or a region minimises, chosen by the acts of a designer.

#![allow(clippy::unwrap_used, reason = "a failing test should stop where it fails")]

use acceptance::Bench;
use ductile_spec::{
    Curve, CurveId, Document, Edit, Embedding, Example, GrabTarget, Objective, ObjectiveOf, PointId, Request,
    Side, Skeleton, SkeletonVertex, Surface, SurfaceId, from_text, to_text,
};
use glam::{DVec3, dvec3};

/// A tube on three circles of radius 1 at heights -1, 0 and 1, each through four points.
fn tube() -> Document {
    let mut document = Document { spacing: Some(0.15), ..Document::default() };
    let mut triangles = Vec::new();
    let mut curves = Vec::new();
    for level in 0..3_u32 {
        let mut through = Vec::new();
        for k in 0..4_u32 {
            let id = PointId(4 * level + k + 1);
            let (x, y) = [(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0)][k as usize];
            document.points.insert(id, dvec3(x, y, f64::from(level) - 1.0));
            through.push(id);
            if level > 0 {
                let (a, b) = (4 * (level - 1) + k, 4 * (level - 1) + (k + 1) % 4);
                triangles.extend([[a, b, a + 4], [b, b + 4, a + 4]]);
            }
        }
        document.curves.insert(CurveId(level + 1), Curve::new(through, true));
        curves.push(Embedding { curve: CurveId(level + 1), along: (4 * level..4 * level + 4).collect() });
    }
    let vertices = (1..=12).map(|id| SkeletonVertex::Control(PointId(id))).collect();
    document.surfaces.insert(SurfaceId(1), Surface::new(Skeleton { vertices, triangles, curves }));
    document
}

fn opened(document: &Document) -> Bench {
    let mut bench = Bench::new();
    bench.accept(Request::OpenText { text: to_text(document) });
    bench
}

/// Mean distance of the vertices from the axis at about a height.
fn radius_at(bench: &Bench, height: f64) -> f64 {
    let shape = &bench.modeler.model().surfaces[&SurfaceId(1)];
    let places = shape.mesh.vertices().map(|v| shape.positions[v.index()]);
    let radii: Vec<f64> =
        places.filter(|p| (p.z - height).abs() < 0.1).map(|p| p.truncate().length()).collect();
    radii.iter().sum::<f64>() / radii.len() as f64
}

fn choose(bench: &mut Bench, of: ObjectiveOf, objective: Option<Objective>) {
    bench.edit(Edit::Objective { of, objective });
}

fn region(z: f64) -> ObjectiveOf {
    ObjectiveOf::Region { surface: SurfaceId(1), at: dvec3(1.0, 0.0, z) }
}

#[test]
fn a_fair_ball_is_a_sphere_and_stays_one_through_a_drag() {
    let mut bench = Bench::with(Example::Ball);
    let off = |bench: &Bench| {
        let shape = bench.modeler.model().surfaces.values().next().unwrap();
        shape.mesh.vertices().map(|v| (shape.positions[v.index()].length() - 1.0).abs()).fold(0.0, f64::max)
    };
    bench.rest(600);
    let plate = off(&bench);
    choose(&mut bench, ObjectiveOf::Document, Some(Objective::Fair));
    bench.rest(600);
    let fair = off(&bench);
    assert!(fair < 2e-4 && fair < plate, "{fair} after {plate}");
    let (point, at) = bench.document().points.into_iter().next().unwrap();
    bench.accept(Request::Grab(GrabTarget::Point(point)));
    for share in [0.1, 0.3, 0.5, 0.3, 0.1, 0.0] {
        bench.step(Some(at * (1.0 + share)));
    }
    bench.accept(Request::Drop);
    bench.rest(600);
    assert!(off(&bench) < 2e-4, "{}", off(&bench));
}

#[test]
fn the_tubes_between_circles_bulge_stay_or_draw_in() {
    let middle = |objective| {
        let mut bench = opened(&tube());
        choose(&mut bench, ObjectiveOf::Surface(SurfaceId(1)), Some(objective));
        bench.rest(600);
        radius_at(&bench, 0.5)
    };
    let [plate, fair, neutral, membrane] = Objective::ALL.map(middle);
    // The curves are fair themselves and lie up to 1 % outside of circles: the tubes are measured against each other.
    assert!((fair - neutral).abs() < 0.01, "{fair} {neutral}");
    assert!(plate > fair + 0.002, "{plate} {fair}");
    assert!(membrane < fair - 0.05, "{membrane} {fair}");
}

#[test]
fn a_region_is_named_by_what_bounds_it_and_can_be_given_back() {
    let mut bench = opened(&tube());
    bench.rest(600);
    let before = bench.document.clone();
    choose(&mut bench, region(0.5), Some(Objective::Membrane));
    let regions = bench.document().surfaces[&SurfaceId(1)].regions.clone();
    assert_eq!(regions.len(), 1);
    assert_eq!((regions[0].curve, regions[0].from, regions[0].side), (CurveId(2), PointId(5), Side::Left));
    bench.rest(600);
    let (upper, lower) = (radius_at(&bench, 0.5), radius_at(&bench, -0.5));
    assert!(upper < 0.95 && lower > 0.98, "{upper} {lower}");
    // Whoever opens the document gets the same.
    let mut other = opened(&from_text(&bench.document).unwrap());
    other.rest(600);
    assert!((radius_at(&other, 0.5) - upper).abs() < 2e-3);
    // The same region again: no second name for it.
    choose(&mut bench, region(0.7), Some(Objective::Fair));
    assert_eq!(bench.document().surfaces[&SurfaceId(1)].regions.len(), 1);
    choose(&mut bench, region(0.3), None);
    assert_eq!(bench.document, before);
    for _ in 0..3 {
        bench.accept(Request::Undo);
    }
    assert_eq!(bench.document, before);
    bench.accept(Request::Redo);
    assert_eq!(bench.document().surfaces[&SurfaceId(1)].regions, regions);
}

#[test]
fn names_of_regions_outlive_their_control_points_and_go_with_their_curve() {
    let mut bench = opened(&tube());
    choose(&mut bench, region(0.5), Some(Objective::Membrane));
    bench.edit(Edit::Release { point: PointId(5) });
    let regions = bench.document().surfaces[&SurfaceId(1)].regions.clone();
    assert_eq!((regions.len(), regions[0].from), (1, PointId(8)));
    bench.edit(Edit::DeleteCurve { curve: CurveId(2) });
    assert!(bench.document().surfaces[&SurfaceId(1)].regions.is_empty());
    bench.rest(600);
}

#[test]
fn a_surface_in_one_piece_is_its_own_region() {
    let mut bench = Bench::with(Example::RaisedDisc);
    let of = ObjectiveOf::Region { surface: SurfaceId(1), at: DVec3::ZERO };
    choose(&mut bench, of, Some(Objective::Neutral));
    let surface = &bench.document().surfaces[&SurfaceId(1)];
    assert_eq!((surface.objective, surface.regions.len()), (Some(Objective::Neutral), 0));
    bench.rest(600);
}

#[test]
fn choices_for_nothing_are_refused() {
    let mut bench = Bench::with(Example::Disc);
    let before = bench.document.clone();
    for of in [
        ObjectiveOf::Curve(CurveId(99)),
        ObjectiveOf::Surface(SurfaceId(99)),
        ObjectiveOf::Region { surface: SurfaceId(99), at: DVec3::ZERO },
        ObjectiveOf::Region { surface: SurfaceId(1), at: DVec3::NAN },
    ] {
        let reply = bench.send(Request::Edit(Edit::Objective { of, objective: Some(Objective::Fair) }));
        assert!(reply.refused.is_some(), "{of:?}");
    }
    assert_eq!(bench.document, before);
}

#[test]
fn a_region_that_is_nowhere_is_a_defect() {
    let text = |region: &str| {
        let text = to_text(&tube());
        let place = text.rfind('}').map(|_| text.find("\"skeleton\"").unwrap()).unwrap();
        format!("{}\"regions\": [{region}], {}", &text[..place], &text[place..])
    };
    for (region, said) in [
        (r#"{"curve": 9, "from": 1, "side": "left", "objective": "fair"}"#, "does not lie in the surface"),
        (r#"{"curve": 1, "from": 9, "side": "left", "objective": "fair"}"#, "no stretch of the curve begins"),
        (
            r#"{"curve": 1, "from": 1, "side": "left", "objective": "fair"}, {"curve": 1, "from": 1, "side": "left", "objective": "fair"}"#,
            "spoken of twice",
        ),
    ] {
        let error = from_text(&text(region)).unwrap_err().to_string();
        assert!(error.contains(said), "{error}");
    }
}
