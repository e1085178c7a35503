//! Tubes between places that face each other: corner faces corner, however the triangles lie (thesis section 7.4.3).

#![allow(clippy::unwrap_used, reason = "a failing test should stop where it fails")]

use acceptance::Bench;
use ductile_spec::{CurveId, Edit, On, Request, SurfaceId, Through};
use glam::{DQuat, DVec3, dvec3};
use std::fmt::Write as _;

fn on(surface: u32, at: DVec3) -> On {
    On { surface: SurfaceId(surface), at }
}

/// Two balls of radius 0.6, on six points each, with their centres apart along a direction; the second is turned, so that its
/// triangles lie otherwise.
fn balls(along: DVec3, turn: f64) -> Bench {
    let axes = [DVec3::X, DVec3::Y, DVec3::NEG_X, DVec3::NEG_Y, DVec3::Z, DVec3::NEG_Z];
    let turned = DQuat::from_axis_angle(dvec3(0.6, 0.0, 0.8), turn);
    let (mut points, mut number) = (String::new(), 0);
    for (centre, rotation) in [(-along, DQuat::IDENTITY), (along, turned)] {
        for axis in axes {
            let at = centre + rotation * axis * 0.6;
            number += 1;
            write!(points, "{}\"{number}\":[{},{},{}]", if number > 1 { "," } else { "" }, at.x, at.y, at.z)
                .unwrap();
        }
    }
    let skeleton = |first: u32| {
        let vertices: Vec<u32> = (first..first + 6).collect();
        format!(
            r#"{{"skeleton":{{"vertices":{vertices:?},
            "triangles":[[0,1,4],[1,2,4],[2,3,4],[3,0,4],[1,0,5],[2,1,5],[3,2,5],[0,3,5]]}}}}"#
        )
    };
    let text = format!(
        r#"{{"ductile":1,"spacing":0.15,"points":{{{points}}},"surfaces":{{"1":{},"2":{}}}}}"#,
        skeleton(1),
        skeleton(7)
    );
    let mut bench = Bench::new();
    bench.accept(Request::OpenText { text });
    bench.rest(600);
    bench
}

/// Angle in degrees from each corner of a loop to the nearest corner of another one, seen along the way between them; the largest.
fn twist(bench: &Bench, loops: [CurveId; 2]) -> f64 {
    let document = bench.document();
    let corners = loops.map(|id| -> Vec<DVec3> {
        document.curves[&id].through.iter().map(|point| document.points[point]).collect()
    });
    let centres = corners.each_ref().map(|all| all.iter().sum::<DVec3>() / all.len() as f64);
    let way = (centres[1] - centres[0]).try_normalize().unwrap();
    let seen =
        |k: usize| corners[k].iter().map(move |at| *at - centres[k]).map(|at| at.reject_from_normalized(way));
    let other: Vec<DVec3> = seen(1).collect();
    let nearest = |a: DVec3| other.iter().map(|b| a.angle_between(*b)).fold(f64::INFINITY, f64::min);
    seen(0).map(nearest).fold(0.0, f64::max).to_degrees()
}

#[test]
fn corners_of_holes_in_balls_that_face_each_other_face_each_other() {
    let (mut worst, mut made): (f64, u32) = (0.0, 0);
    for along in
        [DVec3::X, dvec3(0.0, 0.0, 1.0), dvec3(1.0, 2.0, 3.0), dvec3(-2.0, 1.0, 0.5), dvec3(1.0, -1.0, -1.0)]
    {
        for turn in [0.0, 0.4, 1.1] {
            let way = along.try_normalize().unwrap();
            let mut bench = balls(way, turn);
            let (from, to) = (on(1, -0.4 * way), on(2, 0.4 * way));
            let reply = bench.send(Request::Edit(Edit::Merge { from, to, radius: 0.2, keep: true }));
            if let Some(refusal) = reply.refused {
                // A control point of the second ball stands where its hole would be.
                assert!(refusal.reason.contains("no room"), "{refusal:?}");
                continue;
            }
            made += 1;
            let twist = twist(&bench, [CurveId(1), CurveId(2)]);
            println!("{along} {turn}: {twist:.2}°");
            worst = worst.max(twist);
            if turn == 0.4 {
                bench.rest(600);
            }
        }
    }
    assert!(made >= 10, "{made}");
    assert!(worst < 4.0, "{worst}");
}

#[test]
fn corners_of_holes_in_discs_that_face_each_other_face_each_other() {
    let mut worst: f64 = 0.0;
    for (normal, turn) in [(DVec3::Z, 0.3), (dvec3(1.0, 1.0, 1.0), 0.7), (dvec3(0.3, -1.0, 0.2), 0.2)] {
        let normal = normal.try_normalize().unwrap();
        let (u, v) = normal.any_orthonormal_pair();
        let mut bench = Bench::new();
        for (curve, height, turn) in [(1, 0.0, 0.0), (2, 0.9, turn)] {
            let corner = |k: u32| {
                let (sin, cos) = libm::sincos(turn + f64::from(k) * core::f64::consts::FRAC_PI_2);
                // A little bent, so that no two facets look the same way.
                let bend = if k.is_multiple_of(2) { 0.06 } else { -0.06 };
                Through::Place(u * cos + v * sin + normal * (height + bend))
            };
            bench.edit(Edit::Curve { through: (0..4).map(corner).collect(), closed: true });
            bench.edit(Edit::Sheet { boundary: CurveId(curve) });
        }
        bench.rest(600);
        let (from, to) = (on(1, DVec3::ZERO), on(2, normal * 0.9));
        bench.edit(Edit::Merge { from, to, radius: 0.3, keep: true });
        let twist = twist(&bench, [CurveId(3), CurveId(4)]);
        println!("{normal} {turn}: {twist:.2}°");
        worst = worst.max(twist);
        bench.rest(600);
    }
    assert!(worst < 4.0, "{worst}");
}
