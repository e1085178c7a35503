//! Lines between analytic shapes in any position: they close or end at a boundary, and they part what they should part.

use proptest::prelude::*;

use super::*;
use crate::primitive;
use crate::property_test::cases;
#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

type Shape = (Mesh, Vec<DVec3>);

fn moved((mesh, positions): &Shape, turn: DVec3, shift: DVec3) -> Shape {
    let [x, y, z] = [turn.x, turn.y, turn.z].map(|t| [libm::cos(t), libm::sin(t)]);
    let about_x = |p: DVec3| DVec3::new(p.x, x[0] * p.y - x[1] * p.z, x[1] * p.y + x[0] * p.z);
    let about_y = |p: DVec3| DVec3::new(y[0] * p.x + y[1] * p.z, p.y, y[0] * p.z - y[1] * p.x);
    let about_z = |p: DVec3| DVec3::new(z[0] * p.x - z[1] * p.y, z[1] * p.x + z[0] * p.y, p.z);
    (mesh.clone(), positions.iter().map(|&p| about_z(about_y(about_x(p))) + shift).collect())
}

fn lines(one: &Shape, other: &Shape) -> Result<Vec<CommonLine>, IntersectError> {
    let lines = intersections((&one.0, &one.1), (&other.0, &other.1))?;
    for line in &lines {
        check(one, other, line);
    }
    Ok(lines)
}

/// What holds for every line.
fn check(one: &Shape, other: &Shape, line: &CommonLine) {
    let count = line.points.len();
    assert!(count >= if line.is_closed { 3 } else { 2 });
    for point in &line.points {
        for (place, (mesh, positions)) in point.places.iter().zip([one, other]) {
            let position = place.position(mesh, positions).unwrap();
            assert!(position.distance(point.position) < 1e-6, "{position} {}", point.position);
        }
        assert!(matches!(
            point.places,
            [Place::Edge { .. }, Place::Face { .. }] | [Place::Face { .. }, Place::Edge { .. }]
        ));
    }
    // Neighbours lie in one face of either surface.
    let faces = |shape: &Shape, place: &Place| match *place {
        Place::Edge { edge, .. } => {
            let (f, g) = shape.0.edge_faces(edge);
            [Some(f), g]
        }
        other => [Some(other.face(&shape.0)), None],
    };
    for k in 0..if line.is_closed { count } else { count - 1 } {
        let (p, q) = (&line.points[k], &line.points[(k + 1) % count]);
        for (side, shape) in [one, other].into_iter().enumerate() {
            let (here, next) = (faces(shape, &p.places[side]), faces(shape, &q.places[side]));
            assert!(here.iter().flatten().any(|f| next.contains(&Some(*f))), "{p:?} {q:?}");
        }
    }
    if !line.is_closed {
        for end in [&line.points[0], &line.points[count - 1]] {
            let is_rim = |shape: &Shape, place: &Place| match *place {
                Place::Edge { edge, .. } => shape.0.is_boundary_edge(edge),
                _ => false,
            };
            assert!(is_rim(one, &end.places[0]) || is_rim(other, &end.places[1]), "{end:?}");
        }
    }
}

/// Whether a point lies inside a closed surface, by the solid angle that the surface fills as seen from there.
fn is_inside((mesh, positions): &Shape, at: DVec3) -> bool {
    let angle = |f: FaceId| {
        let [a, b, c] = mesh.face_vertices(f).map(|v| positions[v.index()] - at);
        let (x, y, z) = (a.length(), b.length(), c.length());
        let volume = a.dot(b.cross(c));
        2.0 * libm::atan2(volume, x * y * z + a.dot(b) * z + b.dot(c) * x + c.dot(a) * y)
    };
    mesh.faces().map(angle).sum::<f64>().abs() > core::f64::consts::TAU
}

/// Edges whose ends lie on different sides of a closed surface are crossed an odd number of times, others an even number.
fn parity_holds(closed: &Shape, other: &Shape, lines: &[CommonLine], side: usize) {
    let mut crossings = vec![0; other.0.edge_slots()];
    for point in lines.iter().flat_map(|line| &line.points) {
        if let Place::Edge { edge, .. } = point.places[side] {
            crossings[edge.index()] += 1;
        }
    }
    let inside: Vec<bool> = other.1.iter().map(|p| is_inside(closed, *p)).collect();
    for e in other.0.edges() {
        let [a, b] = other.0.edge_vertices(e).map(|v| inside[v.index()]);
        assert_eq!(crossings[e.index()] % 2 == 1, a != b, "{e:?}");
    }
}

/// A plane cuts a ball in a circle, and laid on the ball the circle parts it.
fn cut_a_ball(turn: DVec3, height: f64) {
    let ball = primitive::icosphere(4);
    let (sheet, flat) = primitive::plane(20, 20, 0.2);
    let centred: Vec<_> = flat.iter().map(|p| *p - DVec3::new(2.0, 2.0, height)).collect();
    let plane = moved(&(sheet, centred), turn, DVec3::ZERO);
    let lines = lines(&ball, &plane).unwrap();
    assert!(lines.len() == 1 && lines[0].is_closed);
    let axis = moved(&(Mesh::default(), vec![DVec3::Z]), turn, DVec3::ZERO).1[0];
    for point in &lines[0].points {
        assert!((point.position.dot(axis) + height).abs() < 1e-8);
        // Facets lie at most 0.3 % inside the ball.
        let radius = point.position.length();
        assert!((0.997..1.0 + 1e-8).contains(&radius), "{}", radius);
    }
    // Laid on the ball the line parts it.
    let (mut mesh, positions) = ball;
    let path = mesh.lay_path(&lines[0].places_on(0), true, &positions).unwrap();
    mesh.cut(&path.edges);
    assert_eq!((crate::validate(&mesh), crate::components(&mesh).count()), (Ok(()), 2));
}

/// Two points of the line lie near one vertex here, and a third between them does not.
#[test]
fn a_line_that_runs_by_a_vertex_is_laid_there_too() {
    let turn = DVec3::new(-2.8434522129758246, 0.8148229869666902, -1.367773354632456);
    cut_a_ball(turn, -0.5195801874269574);
}

proptest! {
    #![proptest_config(cases(128, 16))]

    #[test]
    fn surfaces_in_any_position_meet_in_lines_that_part_them(
        turn in (-3.0..3.0, -3.0..3.0, -3.0..3.0),
        shift in (-2.0..2.0, -2.0..2.0, -1.0..1.0),
        which in 0_usize..4,
    ) {
        let torus = primitive::torus(24, 12, 2.0, 0.7);
        let others = [
            primitive::torus(15, 9, 1.5, 0.5),
            primitive::icosphere(2),
            primitive::plane(13, 11, 0.4),
            primitive::moebius(21, 4, 1.8, 1.1),
        ];
        let other = moved(&others[which], DVec3::from(turn), DVec3::from(shift));
        let lines = lines(&torus, &other).unwrap();
        parity_holds(&torus, &other, &lines, 1);
        if which < 2 {
            prop_assert!(lines.iter().all(|line| line.is_closed));
            parity_holds(&other, &torus, &lines, 0);
        }
        // The same lines whichever surface comes first.
        let turned = intersections((&other.0, &other.1), (&torus.0, &torus.1)).unwrap();
        let count = |lines: &[CommonLine]| {
            let mut counts: Vec<_> = lines.iter().map(|line| (line.points.len(), line.is_closed)).collect();
            counts.sort_unstable();
            counts
        };
        prop_assert_eq!(count(&lines), count(&turned));
    }

    #[test]
    fn a_plane_cuts_a_ball_in_a_circle(
        turn in (-3.0..3.0, -3.0..3.0, -3.0..3.0),
        height in -0.9..0.9,
    ) {
        cut_a_ball(DVec3::from(turn), height);
    }

    #[test]
    fn a_cylinder_runs_through_a_ball_in_two_circles(turn in (-3.0..3.0, -3.0..3.0, -3.0..3.0), radius in 0.2..0.8) {
        let ball = primitive::icosphere(2);
        let ring = |z: f64| -> Vec<DVec3> {
            (0..24)
                .map(|k| core::f64::consts::TAU * f64::from(k) / 24.0)
                .map(|t| DVec3::new(radius * libm::cos(t), radius * libm::sin(t), z))
                .collect()
        };
        let tube = primitive::cylinder(&ring(-1.5), &ring(1.5), 12).unwrap();
        let tube = moved(&tube, DVec3::from(turn), DVec3::ZERO);
        let lines = lines(&ball, &tube).unwrap();
        prop_assert!(lines.len() == 2 && lines.iter().all(|line| line.is_closed));
        parity_holds(&ball, &tube, &lines, 1);
    }
}

#[test]
fn a_plane_through_the_axis_cuts_a_torus_in_two_circles_and_across_it_too() {
    let torus = primitive::torus(32, 16, 2.0, 0.5);
    let sheet = primitive::plane(30, 30, 0.2);
    let half = core::f64::consts::FRAC_PI_2;
    // Rows of vertices and whole edges lie in these planes.
    let upright = moved(&sheet, DVec3::new(half, 0.0, 0.0), DVec3::new(-3.0, 0.0, -3.0));
    let level = moved(&sheet, DVec3::ZERO, DVec3::new(-3.0, -3.0, 0.0));
    for plane in [upright, level] {
        let lines = lines(&torus, &plane).unwrap();
        assert_eq!(lines.iter().map(|line| line.is_closed).collect::<Vec<_>>(), [true, true]);
    }
}

#[test]
fn sheets_cross_in_a_line_from_rim_to_rim() {
    let sheet = primitive::plane(6, 6, 1.0);
    let upright =
        moved(&sheet, DVec3::new(core::f64::consts::FRAC_PI_2, 0.0, 0.0), DVec3::new(1.0, 3.0, -2.0));
    let lines = lines(&sheet, &upright).unwrap();
    assert!(lines.len() == 1 && !lines[0].is_closed);
    let ends = [lines[0].points[0], lines[0].points[lines[0].points.len() - 1]].map(|p| p.position);
    assert!((ends[0].distance(ends[1]) - 5.0).abs() < 1e-8, "{ends:?}");
}

#[test]
fn surfaces_that_touch_are_told_or_resolved() {
    let ball = primitive::icosphere(2);
    assert!(matches!(lines(&ball, &ball), Err(IntersectError::Tangent(..))));
    let sheet = primitive::plane(3, 3, 1.0);
    let beside = moved(&sheet, DVec3::ZERO, DVec3::new(0.3, 0.4, 0.0));
    assert!(matches!(lines(&sheet, &beside), Err(IntersectError::Tangent(..))));
    // Tip to tip, tip to face, edge on edge: nothing, or a line too small to see, but no error.
    let stone = primitive::octahedron();
    for shift in
        [DVec3::new(2.0, 0.0, 0.0), DVec3::new(1.0, 1.0, 0.0), DVec3::new(4.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0)]
    {
        let other = moved(&stone, DVec3::new(0.0, 0.0, 0.1), shift);
        for line in lines(&stone, &other).unwrap() {
            assert!(line.is_closed);
        }
    }
    let far = moved(&ball, DVec3::ZERO, DVec3::splat(9.0));
    assert_eq!(lines(&ball, &far), Ok(Vec::new()));
    let empty = (Mesh::default(), Vec::new());
    assert_eq!(lines(&ball, &empty), Ok(Vec::new()));
    let mut lost = ball.clone();
    lost.1[7] = DVec3::NAN;
    assert_eq!(lines(&ball, &lost), Err(IntersectError::NotFinite(1, VertexId::from_index(7))));
    assert_eq!(
        intersections((&ball.0, &[]), (&ball.0, &ball.1)),
        Err(IntersectError::NotFinite(0, VertexId::from_index(0)))
    );
}
