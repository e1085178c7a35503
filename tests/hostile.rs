//! Hostile documents at the modeler's one door: a refusal with a reason, or a shape that comes to
//! rest; never a hang, a crash, a number that is none, or a document that is lost.

#![allow(clippy::unwrap_used, reason = "a failing test should stop where it fails")]

use acceptance::Bench;
use ductile_spec::{
    CurveId, Document, Embedding, Example, PointId, Request, Skeleton, SkeletonVertex, SurfaceId, from_text,
    to_text,
};
use glam::{DVec3, dvec3};

/// What must come of a document.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Expected {
    Opened,
    /// With these words in the reason.
    Refused(&'static str),
}
use Expected::{Opened, Refused};

/// A document changed by a function.
fn with(example: Example, change: impl FnOnce(&mut Document)) -> Document {
    let mut document = ductile_modeler::example(example);
    document.spacing = Some(0.25);
    change(&mut document);
    document
}

fn skeleton(document: &mut Document) -> &mut Skeleton {
    &mut document.surfaces.get_mut(&SurfaceId(1)).unwrap().skeleton
}

fn scaled(example: Example, scale: f64) -> Document {
    with(example, |document| {
        document.points.values_mut().for_each(|p| *p *= scale);
        document.spacing = Some(0.25 * scale);
    })
}

/// An octahedron of free vertices, whose positions a document may choose freely.
fn free_ball(change: impl FnOnce(&mut Vec<DVec3>, &mut Vec<[u32; 3]>)) -> Document {
    let mut at = vec![DVec3::X, DVec3::Y, DVec3::NEG_X, DVec3::NEG_Y, DVec3::Z, DVec3::NEG_Z];
    let mut triangles =
        vec![[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4], [1, 0, 5], [2, 1, 5], [3, 2, 5], [0, 3, 5]];
    change(&mut at, &mut triangles);
    // One control, so that there is something to take hold of.
    let mut document = with(Example::Ball, |d| d.points.retain(|id, _| *id == PointId(1)));
    document.spacing = Some(0.5);
    skeleton(&mut document).vertices = at.into_iter().map(SkeletonVertex::Free).collect();
    skeleton(&mut document).vertices[0] = SkeletonVertex::Control(PointId(1));
    skeleton(&mut document).triangles = triangles;
    document
}

#[expect(clippy::too_many_lines, reason = "a table: one entry after the other")]
fn table() -> Vec<(&'static str, Expected, Document)> {
    let disc = Example::RaisedDisc;
    vec![
        ("good", Opened, with(disc, |_| {})),
        (
            "a control in the plane of its neighbours",
            Opened,
            with(disc, |d| d.points.values_mut().for_each(|p| p.z = 0.0)),
        ),
        (
            "two inner controls at one place",
            Opened,
            with(disc, |d| {
                d.points.insert(PointId(6), d.points[&PointId(5)]);
            }),
        ),
        (
            "two neighbours of a curve at one place",
            Refused("no extent"),
            with(disc, |d| {
                d.points.insert(PointId(2), d.points[&PointId(1)]);
            }),
        ),
        (
            "an inner control on the boundary's",
            Opened,
            with(disc, |d| {
                d.points.insert(PointId(5), d.points[&PointId(1)]);
            }),
        ),
        (
            "all points equal",
            Refused("no extent"),
            with(disc, |d| d.points.values_mut().for_each(|p| *p = DVec3::ONE)),
        ),
        (
            "all points on a line",
            Refused("no extent"),
            with(disc, |d| {
                for (k, p) in (0..).zip(d.points.values_mut()) {
                    *p = DVec3::X * f64::from(k);
                }
            }),
        ),
        (
            "an inner control far outside its boundary",
            Opened,
            with(disc, |d| {
                d.points.insert(PointId(5), dvec3(-1.2, -1.2, 0.0));
            }),
        ),
        (
            "a boundary that crosses itself",
            Opened,
            with(disc, |d| {
                let (a, b) = (d.points[&PointId(1)], d.points[&PointId(2)]);
                d.points.insert(PointId(1), b);
                d.points.insert(PointId(2), a);
            }),
        ),
        (
            "NaN",
            Refused("coordinate"),
            with(disc, |d| {
                d.points.insert(PointId(5), DVec3::NAN);
            }),
        ),
        (
            "infinite",
            Refused("coordinate"),
            with(disc, |d| {
                d.points.insert(PointId(5), DVec3::INFINITY);
            }),
        ),
        ("scale 1e150", Refused("must be a"), scaled(disc, 1e150)),
        ("scale 1e-150", Refused("no extent"), scaled(disc, 1e-150)),
        ("scale 1e5", Opened, scaled(disc, 1e5)),
        ("scale 1e-5", Opened, scaled(disc, 1e-5)),
        ("far from the origin", Opened, with(disc, |d| d.points.values_mut().for_each(|p| *p += 9e5))),
        ("a spacing of nothing", Refused("spacing"), with(disc, |d| d.spacing = Some(0.0))),
        ("a spacing that is no number", Refused("spacing"), with(disc, |d| d.spacing = Some(f64::NAN))),
        ("a spacing far too fine", Refused("nodes"), with(disc, |d| d.spacing = Some(1e-9))),
        ("a spacing far too coarse", Opened, with(disc, |d| d.spacing = Some(1e6))),
        ("index out of range", Refused("does not exist"), with(disc, |d| skeleton(d).triangles[0][2] = 99)),
        ("largest index", Refused("does not exist"), with(disc, |d| skeleton(d).triangles[0][2] = u32::MAX)),
        ("repeated corner", Refused("repeated"), with(disc, |d| skeleton(d).triangles[0] = [0, 0, 1])),
        (
            "duplicate face",
            Refused("not a surface"),
            with(disc, |d| {
                let first = skeleton(d).triangles[0];
                skeleton(d).triangles.push(first);
            }),
        ),
        (
            "non-manifold edge",
            Refused("not a surface"),
            with(disc, |d| {
                skeleton(d).vertices.push(SkeletonVertex::Free(DVec3::Z));
                skeleton(d).triangles.push([4, 5, 7]);
            }),
        ),
        (
            "pinched vertex",
            Refused("not a surface"),
            with(disc, |d| {
                skeleton(d).vertices.extend([DVec3::Z, DVec3::splat(2.0)].map(SkeletonVertex::Free));
                skeleton(d).triangles.push([4, 7, 8]);
            }),
        ),
        (
            "isolated vertex",
            Refused("not a surface"),
            with(disc, |d| {
                skeleton(d).vertices.push(SkeletonVertex::Free(DVec3::Z));
            }),
        ),
        ("flipped face", Opened, with(disc, |d| skeleton(d).triangles[3].swap(0, 1))),
        ("no triangles", Refused("no triangles"), with(disc, |d| skeleton(d).triangles.clear())),
        (
            "a point that is not there",
            Refused("does not exist"),
            with(disc, |d| {
                d.points.remove(&PointId(5));
            }),
        ),
        (
            "a curve that is not there",
            Refused("does not exist"),
            with(disc, |d| {
                d.curves.remove(&CurveId(1));
            }),
        ),
        (
            "a curve along no edges",
            Refused("no edge"),
            with(disc, |d| {
                skeleton(d).curves[0].along = vec![0, 1, 2, 3];
                skeleton(d).triangles = vec![[0, 2, 4], [1, 3, 5], [4, 5, 6]];
            }),
        ),
        (
            "a curve twice",
            Refused("shares"),
            with(disc, |d| {
                d.curves.insert(CurveId(2), d.curves[&CurveId(1)].clone());
                skeleton(d).curves.push(Embedding { curve: CurveId(2), along: vec![0, 1, 2, 3] });
            }),
        ),
        (
            "a curve of one point",
            Refused("at least"),
            with(disc, |d| {
                let mut curve = d.curves[&CurveId(1)].clone();
                (curve.through, curve.closed) = (vec![PointId(5)], false);
                d.curves.insert(CurveId(2), curve);
            }),
        ),
        ("free vertices, good", Opened, free_ball(|_, _| {})),
        ("free vertices, two at one place", Opened, free_ball(|at, _| at[2] = at[1])),
        ("free vertices, a sliver", Opened, free_ball(|at, _| at[4] = dvec3(0.5, 0.5, 1e-12))),
        ("free vertices, folded", Opened, free_ball(|at, _| at[5] = DVec3::Z * 0.9)),
        ("free vertices, flat", Opened, free_ball(|at, _| at.iter_mut().for_each(|p| p.z = 0.0))),
        ("free vertices, all equal", Refused("no extent"), free_ball(|at, _| at.fill(DVec3::X))),
        ("free vertices, NaN", Refused("coordinate"), free_ball(|at, _| at[3].y = f64::NAN)),
        ("free vertices, one far away", Opened, free_ball(|at, _| at[3].y = -4.0)),
        ("free vertices, one beyond the budget", Refused("nodes"), free_ball(|at, _| at[3].y = -9e5)),
    ]
}

/// After so many steps a shape counts as settled, whatever it does (`modeler/relax`).
const MOST_STEPS: u32 = 600;

#[test]
fn a_document_is_opened_whole_or_refused_with_a_reason() {
    for (name, expected, document) in table() {
        let mut bench = Bench::with(Example::Disc);
        let before = bench.document.clone();
        let text = to_text(&document);
        let refused = bench.send(Request::OpenText { text: text.clone() }).refused;
        match expected {
            Refused(why) => {
                // A text has no word for what is no number; it may then say something else, that can be opened.
                let is_sayable = from_text(&text).is_ok_and(|back| back == document);
                assert!(refused.is_some() || !is_sayable, "{name}");
                if refused.is_some() {
                    bench.accept(Request::Describe);
                    assert_eq!(bench.document, before, "{name}");
                }
                let reason = ductile_modeler::Model::from_document(document).unwrap_err().to_string();
                assert!(reason.contains(why), "{name}: {reason}");
            }
            Opened => {
                assert_eq!(refused, None, "{name}");
                let energy = bench.rest(MOST_STEPS);
                assert!(energy.is_finite() && energy >= 0.0, "{name}: {energy}");
                // It can be dragged, let go, undone, and opened again.
                let point = *document.points.keys().next_back().unwrap();
                let home = document.points[&point];
                bench.accept(Request::Grab(ductile_spec::GrabTarget::Point(point)));
                let (_, radius) = document.extent();
                for _ in 0..8 {
                    bench.step(Some(home + DVec3::Z * (0.3 * radius)));
                }
                bench.send(Request::Drop);
                // Once moved, the document is opened a second time out of sight, which may take as long again.
                let energy = bench.rest(2 * MOST_STEPS);
                assert!(energy.is_finite(), "{name}: {energy}");
                let mut again = Bench::new();
                again.accept(Request::OpenText { text: bench.document.clone() });
            }
        }
    }
}
