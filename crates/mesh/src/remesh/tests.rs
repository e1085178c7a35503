use proptest::prelude::*;

use super::*;
use crate::property_test::cases;
use crate::{SourceTag, measure, primitive, quality, summary, validate};
#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

/// No length is too long.
const FREE: Sizing = Sizing::Uniform(f64::INFINITY);

/// Moves every point by up to `size` in each direction, repeatably.
fn jitter(positions: &mut [DVec3], size: f64, mut seed: u64) {
    let mut next = || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        f64::from(u32::try_from(seed >> 33).unwrap()) / f64::from(1_u32 << 30) - 1.0
    };
    for p in positions {
        *p += size * DVec3::new(next(), next(), next());
    }
}

/// The same, within the plane z = 0 and keeping the boundary.
fn jitter_inside(mesh: &Mesh, positions: &mut [DVec3], size: f64, seed: u64) {
    let before = positions.to_vec();
    jitter(positions, size, seed);
    for v in mesh.vertices() {
        let p = &mut positions[v.index()];
        *p = if mesh.is_boundary_vertex(v) { before[v.index()] } else { p.with_z(0.0) };
    }
}

fn nothing_to_flip(mesh: &Mesh, positions: &[DVec3]) -> bool {
    mesh.edges().filter(|&e| mesh.can_flip(e).is_ok()).all(|e| {
        let d = diagonal::Diagonal::of(mesh, e).unwrap();
        let degrees =
            d.ends.iter().all(|&v| mesh.valence(v) > if mesh.is_boundary_vertex(v) { 3 } else { 5 });
        !degrees || !d.is_flat_enough(mesh, positions) || {
            let mut degrees = potential::Degrees::new(mesh);
            potential::fall(mesh, &mut degrees, positions, &d) <= 0.1
        }
    })
}

#[test]
fn splitting_reaches_the_target_everywhere() {
    let (mut mesh, mut positions) = primitive::plane(4, 4, 1.0);
    let kind = summary(&mesh).kind();
    let mut sizing = Sizing::Uniform(0.3);
    let mut batches = 0;
    loop {
        let before = mesh.vertex_count();
        let edits =
            split_long(&mut mesh, &mut positions, &mut sizing, Seeds::All, &Limits::default(), &mut midpoint);
        assert_eq!(validate(&mesh), Ok(()));
        assert!(mesh.vertex_count() - before <= (before / 10).max(LEAST_GROWTH), "growth is bounded");
        assert_eq!(edits.splits, mesh.vertex_count() - before);
        batches += 1;
        if !edits.is_cut_short {
            break;
        }
    }
    assert!(batches > 3);
    assert!(quality(&mesh, &positions).longest_edge <= 1.33 * 0.3);
    assert_eq!(summary(&mesh).kind(), kind);
    assert!((measure::total_area(&mesh, &positions) - 16.0).abs() < 1e-9);
}

#[test]
fn curves_and_boundaries_are_split_only_on_request() {
    let (mut start, positions) = primitive::plane(3, 3, 1.0);
    let v = VertexId::from_index;
    for j in 0..3 {
        let e = start.edge_between(v(4 + j), v(5 + j)).unwrap();
        start.set_edge_source(e, Some(SourceTag(1)));
    }
    let count = |mesh: &Mesh, what: &dyn Fn(EdgeId) -> bool| mesh.edges().filter(|&e| what(e)).count();
    for (curves, boundary) in [(false, false), (true, false), (false, true)] {
        let (mut mesh, mut positions) = (start.clone(), positions.clone());
        let limits =
            Limits { may_edit_curves: curves, may_edit_boundary: boundary, growth: 9.0, ..Limits::default() };
        split_long(&mut mesh, &mut positions, &mut Sizing::Uniform(0.5), Seeds::All, &limits, &mut midpoint);
        assert_eq!(validate(&mesh), Ok(()));
        assert_eq!(count(&mesh, &|e| mesh.is_source_edge(e)) > 3, curves);
        assert_eq!(count(&mesh, &|e| mesh.is_boundary_edge(e)) > 12, boundary);
    }
}

#[test]
fn the_vertex_budget_holds() {
    let (mut mesh, mut positions) = primitive::icosphere(1);
    let limits = Limits { most_vertices: 50, ..Limits::default() };
    for _ in 0..5 {
        let edits = improve(&mut mesh, &mut positions, &mut Sizing::Uniform(0.01), &limits, &mut midpoint);
        assert!(edits.is_cut_short);
        assert!(mesh.vertex_count() <= 50);
    }
    assert_eq!(mesh.vertex_count(), 50);
}

#[test]
fn an_odd_position_or_target_does_no_harm() {
    let (mut mesh, mut positions) = primitive::plane(2, 2, 1.0);
    let mut nowhere = |_: &Mesh, _: &[DVec3], _: EdgeId| DVec3::NAN;
    split_long(
        &mut mesh,
        &mut positions,
        &mut Sizing::Uniform(0.5),
        Seeds::All,
        &Limits::default(),
        &mut nowhere,
    );
    assert!(positions.iter().all(|p| p.is_finite()));
    for target in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let edits = split_long(
            &mut mesh,
            &mut positions,
            &mut Sizing::Uniform(target),
            Seeds::All,
            &Limits::default(),
            &mut nowhere,
        );
        assert_eq!(edits.splits, 0, "{target}");
    }
}

#[test]
fn crowds_are_thinned_but_pins_stay() {
    let (mut mesh, mut positions) = primitive::icosphere(3);
    let kind = summary(&mesh).kind();
    let is_pinned = |v: VertexId| v.index() < 12;
    let limits = Limits { is_pinned: &is_pinned, ..Limits::default() };
    mesh.set_vertex_source(VertexId::from_index(40), Some(SourceTag(0)));
    let stays = |v: VertexId| v.index() < 12 || v.index() == 40;
    for _ in 0..10 {
        improve(&mut mesh, &mut positions, &mut Sizing::Uniform(0.4), &limits, &mut midpoint);
        assert_eq!(validate(&mesh), Ok(()));
        // Passes over the connectivity move nothing: that is for whoever smooths, and without it what lies in the way of a
        // collapse stays there with any angle. Here it is Laplace's smoothing on the sphere.
        for v in mesh.vertices().filter(|&v| !stays(v)).collect::<Vec<_>>() {
            let sum: DVec3 = mesh.neighbours(v).map(|w| positions[w.index()]).sum();
            positions[v.index()] = sum.normalize_or_zero();
        }
    }
    assert_eq!(summary(&mesh).kind(), kind);
    assert!(mesh.vertex_count() < 642 / 2, "{}", mesh.vertex_count());
    assert!((0..12).chain([40]).all(|i| mesh.has_vertex(VertexId::from_index(i))));
    let q = quality(&mesh, &positions);
    // Goal g of the engine: no triangle under 30°, here not even around what stays.
    assert!(q.least_angle > 30_f64.to_radians() && q.inner_valences[3] + q.inner_valences[4] == 0, "{q:?}");
    for f in mesh.faces() {
        let p = positions[mesh.face_vertices(f)[0].index()];
        assert!(measure::face_normal(&mesh, &positions, f).dot(p) > 0.0, "nothing folds over");
    }
}

#[test]
fn flips_end_with_their_budget_and_say_so() {
    let (mut mesh, mut positions) = primitive::plane(12, 12, 1.0);
    jitter_inside(&mesh, &mut positions, 0.45, 4);
    let limits = Limits::default();
    let whole = flip_pass(&mut mesh.clone(), &positions, &FREE, Seeds::All, &limits);
    assert!(whole.flips > 5 && !whole.is_cut_short);
    let part = flip_pass::flips_within(&mut mesh, &positions, &FREE, Seeds::All, &limits, 3);
    assert!(part.flips == 3 && part.is_cut_short);
    assert_eq!(validate(&mesh), Ok(()));
    // What is left is done by the next pass; the work that just suffices is not called short.
    let rest = flip_pass(&mut mesh, &positions, &FREE, Seeds::All, &limits);
    assert!(rest.flips > 0 && !rest.is_cut_short && nothing_to_flip(&mesh, &positions));
}

#[test]
fn flips_lower_the_potential_as_far_as_they_may() {
    let (mut mesh, mut positions) = primitive::plane(10, 10, 1.0);
    jitter_inside(&mesh, &mut positions, 0.45, 7);
    let before = quality(&mesh, &positions);
    let edits = flip_pass(&mut mesh, &positions, &FREE, Seeds::All, &Limits::default());
    assert_eq!(validate(&mesh), Ok(()));
    assert!(edits.flips > 5 && !edits.is_cut_short);
    assert!(quality(&mesh, &positions).mean_least_angle > before.mean_least_angle);
    assert!(nothing_to_flip(&mesh, &positions));
    let again = flip_pass(&mut mesh, &positions, &FREE, Seeds::All, &Limits::default());
    assert_eq!((again.flips, again.touched.len()), (0, 0));
}

#[test]
fn flips_among_cocircular_points_come_to_an_end() {
    // Each square of the grid has four points on a circle: no shape decides, only the valences and the hysteresis do.
    for seed in 0..20_u64 {
        let (mut mesh, positions) = primitive::plane(12, 9, 1.0);
        let diagonals: Vec<_> =
            mesh.edges().filter(|&e| measure::edge_length(&mesh, &positions, e) > 1.2).collect();
        let mut choice = vec![DVec3::ZERO; diagonals.len()];
        jitter(&mut choice, 1.0, seed);
        for (&e, choice) in diagonals.iter().zip(&choice) {
            if choice.x > 0.0 && mesh.can_flip(e).is_ok() {
                mesh.flip(e);
            }
        }
        let before = potential::total(&mesh, &positions);
        let edits = flip_pass(&mut mesh, &positions, &FREE, Seeds::All, &Limits::default());
        assert!(edits.flips > 10 && !edits.is_cut_short, "{edits:?}");
        // Here every fall is one of squares of integers, and 2 at the least.
        assert!(potential::total(&mesh, &positions) < before - 1.99 * edits.flips as f64);
        assert_eq!(flip_pass(&mut mesh, &positions, &FREE, Seeds::All, &Limits::default()).flips, 0);
        assert!(mesh.faces().all(|f| measure::face_normal(&mesh, &positions, f).z > 0.9));
    }
}

#[test]
fn flipping_around_the_touched_vertices_is_enough() {
    let (mut mesh, positions) = primitive::plane(8, 8, 1.0);
    let regular = potential::total(&mesh, &positions);
    let v = VertexId::from_index(40);
    let e = mesh.spokes(v).find(|&e| mesh.can_flip(e).is_ok()).unwrap();
    let ends = mesh.edge_vertices(e);
    mesh.flip(e);
    let near = flip_pass(&mut mesh, &positions, &FREE, Seeds::Around(&ends), &Limits::default());
    assert!(near.flips > 0 && ends.iter().all(|v| near.touched.contains(v)));
    assert!((potential::total(&mesh, &positions) - regular).abs() < 1e-9);
}

#[test]
fn a_batch_where_nothing_changed_looks_at_nothing() {
    let (mut mesh, mut positions) = primitive::icosphere(4);
    let mut sizing = Sizing::Uniform(measure::mean_edge_length(&mesh, &positions));
    let (mut ledger, limits) = (Ledger::default(), Limits::default());
    let mut run = |positions: &mut Vec<DVec3>, slack| {
        improve_changed(&mut mesh, positions, &mut sizing, (&mut ledger, slack), &limits, &mut midpoint)
            .count()
    };
    assert_eq!(run(&mut positions, 0.0), 0);
    // A pair of vertices on top of each other, which only a look at them can find.
    positions[7] = positions[700];
    let (mesh, _) = primitive::icosphere(4);
    let far = mesh.neighbours(VertexId::from_index(7)).next().unwrap();
    positions[7] = positions[far.index()].lerp(positions[7], 0.01);
    assert!(run(&mut positions, 0.02) > 0);
}

#[test]
fn sharp_creases_and_curves_are_not_flipped() {
    // A long roof: flipping its ridge would cut through the air.
    let mut mesh = Mesh::from_triangles(4, &[[0, 1, 2], [1, 0, 3]]).unwrap();
    let roof =
        |z: f64| [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [2.0, 0.5, z], [2.0, -0.5, z]].map(DVec3::from_array);
    let flat = Limits::default();
    assert_eq!(
        flip_pass(&mut mesh.clone(), &roof(-2.0), &FREE, Seeds::All, &flat).flips,
        0,
        "dihedral above 90°"
    );
    // The ends of the ridge have three neighbours and are on the boundary: degree forbids it, flat or not.
    assert_eq!(flip_pass(&mut mesh.clone(), &roof(0.0), &FREE, Seeds::All, &flat).flips, 0);
    let ridge = mesh.edge_between(VertexId(0), VertexId(1)).unwrap();
    mesh.set_edge_source(ridge, Some(SourceTag(0)));
    assert_eq!(flip_pass(&mut mesh, &roof(0.0), &FREE, Seeds::All, &flat).flips, 0);
}

#[test]
fn a_triangle_that_a_moved_rim_turned_over_is_unfolded() {
    // The rim runs from 4 over 0, 2 and 1 to 5; 2 has come up above the edge from 0 to 1, which should lie inside.
    let triangles = [[0, 2, 1], [0, 1, 3], [0, 3, 6], [1, 7, 3], [4, 0, 6], [1, 5, 7], [6, 3, 8], [3, 7, 8]];
    let mut mesh = Mesh::from_triangles(9, &triangles).unwrap();
    let mut positions: Vec<DVec3> = [
        (-1.0, 0.0),
        (1.0, 0.0),
        (0.0, 0.1),
        (0.0, 1.0),
        (-3.0, 0.0),
        (3.0, 0.0),
        (-2.0, 1.0),
        (2.0, 1.0),
        (0.0, 2.0),
    ]
    .map(|(x, y)| DVec3::new(x, y, 0.0))
    .to_vec();
    let is_upright = |mesh: &Mesh, positions: &[DVec3]| {
        mesh.faces().all(|f| {
            let [a, b, c] = mesh.face_vertices(f).map(|v| positions[v.index()]);
            (b - a).cross(c - a).z > 0.0
        })
    };
    assert!(!is_upright(&mesh, &positions));
    flip_pass(&mut mesh, &positions, &FREE, Seeds::All, &Limits::default());
    assert!(is_upright(&mesh, &positions) && mesh.are_neighbours(VertexId(2), VertexId(3)));
    assert_eq!(validate(&mesh), Ok(()));
    // Two real sides of a fold that stand at an angle are left alone, though one lies above the other.
    let mut sharp = Mesh::from_triangles(9, &triangles).unwrap();
    positions[2] = DVec3::new(0.0, 0.1, 0.3);
    flip_pass(&mut sharp, &positions, &FREE, Seeds::All, &Limits::default());
    assert!(sharp.are_neighbours(VertexId(0), VertexId(1)));
}

#[test]
fn poor_vertices_are_mended() {
    let (mut mesh, mut positions) = primitive::icosphere(2);
    for f in mesh.faces().step_by(9).collect::<Vec<_>>() {
        let corners = mesh.face_vertices(f).map(|v| positions[v.index()]);
        let v = mesh.split_face(f);
        positions.resize(mesh.vertex_slots(), DVec3::ZERO);
        positions[v.index()] = corners.into_iter().sum::<DVec3>().normalize_or_zero();
    }
    assert!(quality(&mesh, &positions).inner_valences[3] > 10);
    let edits = repair_valence(&mut mesh, &positions, &Sizing::Uniform(0.32), Seeds::All, &Limits::default());
    assert_eq!(validate(&mesh), Ok(()));
    let q = quality(&mesh, &positions);
    assert_eq!(q.inner_valences[..5], [0; 5], "{edits:?}");
    assert!(q.least_angle > 15_f64.to_radians());
}

/// What the proof of `repair_valence` counts: vertices, surplus neighbours, missing neighbours.
fn repairs_left(mesh: &Mesh, limits: &Limits<'_>) -> (usize, usize, usize) {
    let surplus = mesh.vertices().map(|v| mesh.valence(v).saturating_sub(limits.most_neighbours)).sum();
    let inner = mesh.vertices().filter(|&v| !mesh.is_boundary_vertex(v));
    let missing = inner.map(|v| 5_usize.saturating_sub(mesh.valence(v))).sum();
    (mesh.vertex_count(), surplus, missing)
}

#[test]
fn every_repair_lowers_what_its_proof_counts_and_repairs_end_with_their_budget() {
    let mut one_by_one = [0; 3];
    for seed in 0..12_u64 {
        let (mut mesh, mut positions) = primitive::icosphere(2);
        // Any edges are flipped, whatever comes of it: crowds, and many with three or four neighbours.
        let mut choice = vec![DVec3::ZERO; 2 * mesh.edge_count()];
        jitter(&mut choice, 1.0, seed);
        let edges: Vec<_> = mesh.edges().collect();
        for (k, at) in choice.iter().enumerate() {
            let e = edges[k % edges.len()];
            if at.x > 0.0 && mesh.can_flip(e).is_ok() {
                mesh.flip(e);
            }
        }
        jitter(&mut positions, 0.05, seed);
        let limits = Limits { most_neighbours: 9, may_collapse: seed % 3 > 0, ..Limits::default() };
        let start = repairs_left(&mesh, &limits);
        assert!(start.1 > 0 && start.2 > 10, "{start:?}");
        let whole = repair_valence(&mut mesh.clone(), &positions, &FREE, Seeds::All, &limits);
        assert!(!whole.is_cut_short && whole.count() < mesh.edge_count(), "{whole:?}");
        loop {
            let before = repairs_left(&mesh, &limits);
            let edits = repair_valence::repairs_within(&mut mesh, &positions, &FREE, Seeds::All, &limits, 1);
            assert!(edits.count() <= 1, "{edits:?}");
            if edits.count() == 0 {
                break;
            }
            let after = repairs_left(&mesh, &limits);
            assert!(after < before, "{before:?} became {after:?}");
            one_by_one[0] += edits.flips;
            one_by_one[1] += edits.collapses;
            one_by_one[2] += usize::from(edits.is_cut_short);
        }
        assert_eq!(validate(&mesh), Ok(()));
    }
    assert!(one_by_one.iter().all(|count| *count > 10), "{one_by_one:?}");
}

/// A hub with spokes to 60 samples of a curve, with and without a surface beyond them, flat and crumpled.
#[test]
fn a_crowded_vertex_gives_neighbours_away() {
    let around = 60_u32;
    let ring = |radius: f64| {
        (0..around).map(move |k| {
            let t = core::f64::consts::TAU * f64::from(k) / f64::from(around);
            DVec3::new(libm::cos(t), libm::sin(t), 0.0) * radius
        })
    };
    let next = |k: u32| (k + 1) % around;
    let inner = (0..around).map(|k| [0, 1 + k, 1 + next(k)]);
    let beyond = (0..around).flat_map(|k| {
        let (low, high) = ([1 + k, 1 + next(k)], [1 + around + k, 1 + around + next(k)]);
        [[low[0], high[0], low[1]], [low[1], high[0], high[1]]]
    });
    let fan: Vec<_> = inner.collect();
    let whole: Vec<_> = fan.iter().copied().chain(beyond).collect();
    for (triangles, size) in [(&fan, 0.0), (&fan, 0.5), (&whole, 0.0), (&whole, 0.5)] {
        let mut positions: Vec<DVec3> =
            core::iter::once(DVec3::ZERO).chain(ring(1.0)).chain(ring(1.2)).collect();
        positions.truncate(if triangles.len() > 60 { 121 } else { 61 });
        jitter(&mut positions, size, 5);
        let mut mesh = Mesh::from_triangles(positions.len(), triangles).unwrap();
        let before = summary(&mesh).kind();
        let limits = Limits { may_collapse: false, ..Limits::default() };
        repair_valence(&mut mesh, &positions, &FREE, Seeds::All, &limits);
        assert_eq!(validate(&mesh), Ok(()));
        assert_eq!(summary(&mesh).kind(), before);
        let most = mesh.vertices().map(|v| mesh.valence(v)).max();
        assert!(most <= Some(24), "{most:?} neighbours are left");
    }
}

#[test]
fn batches_come_to_rest_on_a_moving_shape() {
    let (mut mesh, mut positions) = primitive::icosphere(3);
    let mut sizing = Sizing::Uniform(measure::mean_edge_length(&mesh, &positions));
    let mut edits = 0;
    for frame in 0..100_u64 {
        let mut seen = positions.clone();
        jitter(&mut seen, 0.02 * 0.14, frame);
        let done = improve(&mut mesh, &mut seen, &mut sizing, &Limits::default(), &mut midpoint);
        edits += done.count();
        positions.resize(seen.len(), DVec3::ZERO);
        done.touched.iter().for_each(|v| positions[v.index()] = seen[v.index()]);
    }
    assert_eq!(edits, 0, "jitter of a fiftieth of an edge must not cause edits");
    for p in &mut positions {
        p.z *= 2.0;
    }
    let stretched = improve(&mut mesh, &mut positions, &mut sizing, &Limits::default(), &mut midpoint);
    assert!(stretched.splits > 10);
}

#[test]
fn batches_come_to_rest_without_smoothing() {
    let on_ball = |mesh: &Mesh, at: &[DVec3], e| midpoint(mesh, at, e).normalize_or_zero();
    for (name, (mut mesh, mut positions)) in [
        ("ball", primitive::icosphere(1)),
        ("torus", primitive::torus(10, 6, 1.0, 0.4)),
        ("klein", primitive::klein_bottle(12, 8, 1.0, 0.4)),
        ("plane", primitive::plane(4, 4, 0.5)),
    ] {
        for target in [0.2, 0.15, 0.1] {
            let mut sizing = Sizing::Uniform(target);
            let rested = (0..60).any(|round| {
                let limits = Limits { may_collapse: round < 20, ..Limits::default() };
                let is_ball = name == "ball";
                let mut place =
                    |m: &Mesh, p: &[DVec3], e| if is_ball { on_ball(m, p, e) } else { midpoint(m, p, e) };
                let edits = improve(&mut mesh, &mut positions, &mut sizing, &limits, &mut place);
                edits.count() == 0
            });
            let q = quality(&mesh, &positions);
            assert!(rested, "{name} {target}: splits, flips and collapses undo each other");
            assert!(q.longest_edge <= 1.6 * target && q.least_angle > 0.2, "{name} {target}: {q:?}");
            let poor: usize = q.inner_valences[..5].iter().sum();
            assert!(100 * poor <= mesh.vertex_count(), "{name} {target}: {q:?}");
        }
    }
}

proptest! {
    #![proptest_config(cases(32, 16))]

    #[test]
    fn improving_is_safe_and_repeatable(seed in any::<u64>(), target in 0.15_f64..0.8, size in 0.0_f64..0.15) {
        let family = [
            primitive::icosphere(2),
            primitive::torus(14, 8, 1.0, 0.4),
            primitive::moebius(14, 3, 1.0, 0.6),
            primitive::klein_bottle(14, 10, 1.0, 0.4),
            primitive::plane(6, 5, 0.4),
        ];
        for (mut mesh, mut positions) in family {
            // A curve along some edges, which must come out as it went in.
            let curve: Vec<_> = mesh.edges().step_by(17).collect();
            for (tag, &e) in (0..).zip(&curve) {
                mesh.set_edge_source(e, Some(SourceTag(tag)));
            }
            jitter(&mut positions, size, seed);
            let before = summary(&mesh).kind();
            let ends: Vec<_> = curve.iter().map(|&e| mesh.edge_vertices(e)).collect();
            let mut sizing = Sizing::PerVertex(vec![target; mesh.vertex_slots()]);
            let limits = Limits { most_vertices: 400, ..Limits::default() };
            for _ in 0..4 {
                let (mut twin, mut twin_positions) = (mesh.clone(), positions.clone());
                let mut twin_sizing = sizing.clone();
                let edits = improve(&mut mesh, &mut positions, &mut sizing, &limits, &mut midpoint);
                let same = improve(&mut twin, &mut twin_positions, &mut twin_sizing, &limits, &mut midpoint);
                prop_assert_eq!(&edits, &same);
                prop_assert_eq!(&twin_positions, &positions);
                prop_assert_eq!(validate(&mesh), Ok(()));
                prop_assert_eq!(summary(&mesh).kind(), before);
                prop_assert!(edits.touched.iter().all(|&v| mesh.has_vertex(v)));
                prop_assert!(mesh.vertices().all(|v| mesh.valence(v) <= 24));
                for (&e, ends) in curve.iter().zip(&ends) {
                    prop_assert!(mesh.has_edge(e) && mesh.is_source_edge(e));
                    prop_assert!(mesh.edge_vertices(e).iter().all(|v| ends.contains(v)));
                }
            }
        }
    }

    /// The proof that flips end, checked: each lowers the potential by more than 0.1, in space as in the plane.
    #[test]
    fn every_flip_lowers_the_potential(seed in any::<u64>(), size in 0.0_f64..0.4) {
        for (mut mesh, mut positions) in
            [primitive::plane(7, 6, 1.0), primitive::icosphere(2), primitive::klein_bottle(14, 10, 1.0, 0.4)]
        {
            let edge = measure::mean_edge_length(&mesh, &positions);
            jitter(&mut positions, size * edge, seed);
            let before = potential::total(&mesh, &positions);
            let edits = flip_pass(&mut mesh, &positions, &FREE, Seeds::All, &Limits::default());
            prop_assert!(!edits.is_cut_short);
            let after = potential::total(&mesh, &positions);
            prop_assert!(after <= before - 0.1 * f64::from(u32::try_from(edits.flips).unwrap()));
        }
    }

    /// The promise of the ledger: when a batch around what has changed finds nothing more, neither does one everywhere.
    #[test]
    fn what_a_ledger_leaves_out_needs_no_edit(seed in any::<u64>(), size in 0.01_f64..0.3, part in 2_usize..40) {
        for (mut mesh, mut positions) in
            [primitive::icosphere(3), primitive::torus(20, 12, 1.0, 0.4), primitive::plane(12, 12, 0.15)]
        {
            let mut sizing = Sizing::Uniform(measure::mean_edge_length(&mesh, &positions));
            let (mut ledger, limits) = (Ledger::default(), Limits { growth: 1.0, ..Limits::default() });
            for round in 0..3 {
                let slack = if round == 1 { 0.02 } else { 0.0 };
                let mut moved = positions.clone();
                jitter(&mut moved, size * 0.15, seed.wrapping_add(round));
                for (k, p) in positions.iter_mut().enumerate() {
                    *p = if k % part == 0 { moved[k] } else { *p };
                }
                let mut step = |slack, may_collapse| {
                    let limits = Limits { may_collapse, ..limits };
                    let ledger = (&mut ledger, slack);
                    improve_changed(&mut mesh, &mut positions, &mut sizing, ledger, &limits, &mut midpoint).count()
                };
                step(slack, true);
                // The last batch that may collapse is answered by some that may not, and then none does anything.
                let counts: Vec<_> = (0..40).map(|k| step(0.0, k < 20)).take_while(|&count| count > 0).collect();
                prop_assert!(counts.len() < 40, "comes to no end: {counts:?}");
                let limits = Limits { may_collapse: counts.len() < 20, ..limits };
                prop_assert_eq!(validate(&mesh), Ok(()));
                let whole = improve(&mut mesh.clone(), &mut positions.clone(), &mut sizing, &limits, &mut midpoint);
                prop_assert_eq!(whole.count(), 0, "{:?}", whole);
            }
        }
    }
}
