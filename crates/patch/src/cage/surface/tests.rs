//! What the paper promises, measured: vertices are met, edges join, affine maps commute; and controls that must fail.

use super::*;
use crate::cage::primitive;
use proptest::prelude::*;
#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

/// Displaces every vertex by up to `by` in each coordinate, always the same way for one seed.
pub(super) fn shaken(cage: &Cage, by: f64, seed: u64) -> Cage {
    let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1;
    let mut random = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5) * 2.0 * by
    };
    let positions = cage.positions().iter().map(|p| *p + DVec3::new(random(), random(), random())).collect();
    Cage::new(positions, cage.faces().to_vec()).unwrap()
}

fn family() -> Vec<Cage> {
    let wide = |p: &DVec3| *p * DVec3::new(1.0, 1.1, 0.9);
    let solids = [
        primitive::cube(1.0).unwrap(),
        primitive::torus(3.0, 1.0, 8, 4).unwrap(),
        primitive::icosahedron(1.5).unwrap(),
        primitive::tetrahedron(1.0).unwrap(),
        primitive::octahedron(1.0).unwrap(),
        primitive::dodecahedron(2.0).unwrap(),
        primitive::trebol(2.0).unwrap(),
        primitive::grid(1.0, 3, 3).unwrap(),
        primitive::grid(1.0, 1, 2).unwrap(),
        primitive::disc(1.0, 7).unwrap(),
        primitive::disc(1.0, 8).unwrap(),
    ];
    let turned =
        |cage: &Cage| Cage::new(cage.positions().iter().map(wide).collect(), cage.faces().to_vec()).unwrap();
    solids.iter().map(turned).collect()
}

fn settings(cage: &Cage, map: Map, blend: Blend) -> Settings {
    Settings { map, blend, split: cage.split_needed(), boundary: Boundary::Linear }
}

/// The angle between two directions, without the cancellation of an arc cosine.
pub(super) fn angle(a: DVec3, b: DVec3) -> f64 {
    libm::atan2(a.cross(b).length(), a.dot(b))
}

/// The largest distance and the largest angle between normals on both sides of inner edges, with the larger of both
/// mean-curvature differences.
fn seams(surface: &CageSurface) -> (f64, f64, f64) {
    seams_with(surface, &|quad, u, v| surface.evaluate(quad, u, v).unwrap())
}

fn seams_with(surface: &CageSurface, at: &dyn Fn(usize, f64, f64) -> SurfacePoint) -> (f64, f64, f64) {
    let along = |side: usize, t: f64| match side {
        0 => (t, 0.0),
        1 => (1.0, t),
        2 => (1.0 - t, 1.0),
        _ => (0.0, 1.0 - t),
    };
    let mut worst = (0.0_f64, 0.0_f64, 0.0_f64);
    for h in surface.links.edges() {
        let Some(twin) = surface.links.twin(h) else { continue };
        for t in [0.1, 0.35, 0.5, 0.8] {
            let [(u, v), (s, r)] = [along(h % 4, t), along(twin % 4, 1.0 - t)];
            let (here, there) = (at(h / 4, u, v), at(twin / 4, s, r));
            let bend = |p: &SurfacePoint| p.curvatures.map_or(f64::NAN, |[a, b]| (a + b) / 2.0);
            worst.0 = worst.0.max(here.point.distance(there.point));
            worst.1 = worst.1.max(angle(here.normal.unwrap(), there.normal.unwrap()));
            worst.2 = worst.2.max((bend(&here) - bend(&there)).abs());
        }
    }
    worst
}

#[test]
fn edges_of_faces_run_from_corner_to_corner_and_both_faces_have_the_same_one() {
    for (number, cage) in (0_u64..).zip(family()) {
        let cage = shaken(&cage, 0.05, number);
        for split in [Split::None, Split::Linear, Split::Offset] {
            let settings = Settings { split, ..settings(&cage, Map::Smooth, Blend::Hermite(2)) };
            let Ok(surface) = CageSurface::new(&cage, settings) else { continue };
            for (face, corners) in cage.faces().iter().enumerate() {
                for corner in 0..corners.len() {
                    let ends = [corners[corner], corners[(corner + 1) % corners.len()]];
                    let at = |t: f64| surface.on_edge(face, corner, t).unwrap();
                    for (end, t) in ends.into_iter().zip([0.0, 1.0]) {
                        assert!(at(t).0.point.distance(cage.positions()[end as usize]) < 1e-12);
                    }
                    for t in [0.2, 0.45, 0.8] {
                        let step = 1e-6;
                        let slope = (at(t + step).0.point - at(t - step).0.point) / (2.0 * step);
                        assert!(
                            slope.distance(at(t).1) < 1e-7 * (1.0 + slope.length()),
                            "{number} {split:?}"
                        );
                    }
                    let mirrored = cage.faces().iter().enumerate().find_map(|(face, corners)| {
                        let next = |k: usize| corners[(k + 1) % corners.len()];
                        let k = (0..corners.len()).find(|k| corners[*k] == ends[1] && next(*k) == ends[0])?;
                        Some((face, k))
                    });
                    if let Some((face, k)) = mirrored {
                        let other = surface.on_edge(face, k, 0.7).unwrap();
                        assert!(other.0.point.distance(at(0.3).0.point) < 1e-12);
                        assert!(angle(other.1, -at(0.3).1) < 1e-9);
                    }
                }
                assert!(surface.on_edge(face, corners.len(), 0.5).is_err());
            }
            assert!(surface.on_edge(cage.faces().len(), 0, 0.5).is_err());
            assert!(surface.on_edge(0, 0, 1.5).is_err() && surface.on_edge(0, 0, f64::NAN).is_err());
        }
    }
}

#[test]
fn vertices_are_met_and_edges_join() {
    for (number, cage) in (0_u64..).zip(family()) {
        let cage = shaken(&cage, 0.08, number);
        for map in [Map::Rational, Map::Smooth] {
            for blend in [Blend::Hermite(1), Blend::default(), Blend::Bump(1), Blend::Erbs] {
                for boundary in [Boundary::Linear, Boundary::Borrow] {
                    let settings = Settings { boundary, ..settings(&cage, map, blend) };
                    let surface = CageSurface::new(&cage, settings).unwrap();
                    for (quad, corners) in surface.quads().iter().enumerate() {
                        for (vertex, (u, v)) in
                            corners.iter().zip([(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)])
                        {
                            let met = surface.evaluate(quad, u, v).unwrap().point;
                            let off = met.distance(surface.positions()[*vertex as usize]);
                            assert!(off < 1e-13, "cage {number}, {settings:?}: vertex {vertex} by {off:e}");
                        }
                    }
                    let (gap, kink, _) = seams(&surface);
                    assert!(gap < 2e-14 && kink < 2e-13, "cage {number}, {settings:?}: {gap:e} {kink:e}");
                }
            }
        }
    }
}

/// With the closed map and a blend of second order curvatures agree too; with the paper's map they do not.
#[test]
fn curvature_is_continuous_with_the_smooth_map_only() {
    for (number, cage) in [
        (3_u64, primitive::cube(1.0).unwrap()),
        (4, primitive::icosahedron(1.5).unwrap()),
        (5, primitive::trebol(2.0).unwrap()),
    ] {
        let cage = shaken(&cage, 0.1, number);
        let jump = |map| seams(&CageSurface::new(&cage, settings(&cage, map, Blend::default())).unwrap()).2;
        assert!(jump(Map::Smooth) < 1e-9, "{number}: {:e}", jump(Map::Smooth));
        assert!(jump(Map::Rational) > 1e-3, "{number}: {:e}", jump(Map::Rational));
    }
}

/// The control that must fail: with the bilinear map of the paper's figure 3a neighbours meet at an angle.
#[test]
fn the_bilinear_map_leaves_kinks() {
    let cage = shaken(&primitive::cube(1.0).unwrap(), 0.1, 9);
    let surface = CageSurface::new(&cage, settings(&cage, Map::Smooth, Blend::default())).unwrap();
    let blender = Blender::new(Blend::default()).unwrap();
    let bilinear = |quad: usize, u: f64, v: f64| {
        let mut sum = [DVec3::ZERO; 6];
        for corner in 0..4 {
            let (a, b) = local(corner, u, v);
            let (ja, jb) = (Jet::first(a), Jet::second(b));
            let phi = ja.through(blender.at(a)) * jb.through(blender.at(b));
            let n = surface.ring(quad, corner).valence();
            let half = std::f64::consts::PI / n as f64;
            let (x, y) = (libm::cos(half) * libm::cos(half), libm::cos(half) * libm::sin(half));
            let px = (ja * (Jet::ONE - jb) + jb * (Jet::ONE - ja)) * x + ja * jb;
            let py = (jb * (Jet::ONE - ja) - ja * (Jet::ONE - jb)) * y;
            for (weight, point) in weights(n, px, py).iter().zip(surface.ring_points(quad, corner)) {
                add(&mut sum, (*weight * phi).turned(corner), point);
            }
        }
        let [point, du, dv, ..] = sum;
        let normal = unit_normal(du, dv);
        SurfacePoint { point, first: [du, dv], second: None, normal, curvatures: None }
    };
    let (gap, kink, _) = seams_with(&surface, &bilinear);
    assert!(gap < 1e-14, "it still interpolates: {gap:e}");
    assert!(kink > 0.05, "{kink}");
}

/// The control that must fail: a blend that is not flat at its ends.
#[test]
fn a_blend_that_is_not_flat_leaves_kinks() {
    let cage = shaken(&primitive::cube(1.0).unwrap(), 0.1, 9);
    let surface = CageSurface::new(&cage, settings(&cage, Map::Smooth, Blend::default())).unwrap();
    let slanted = |quad: usize, u: f64, v: f64| {
        let mut sum = [DVec3::ZERO; 6];
        for corner in 0..4 {
            let (a, b) = local(corner, u, v);
            let phi = (Jet::ONE - Jet::first(a)) * (Jet::ONE - Jet::second(b));
            let n = surface.ring(quad, corner).valence();
            let [x, y] = kite::jets(Map::Smooth, n, a, b);
            for (weight, point) in weights(n, x, y).iter().zip(surface.ring_points(quad, corner)) {
                add(&mut sum, (*weight * phi).turned(corner), point);
            }
        }
        let [point, du, dv, ..] = sum;
        SurfacePoint { point, first: [du, dv], second: None, normal: unit_normal(du, dv), curvatures: None }
    };
    assert!(seams_with(&surface, &slanted).1 > 0.1);
}

#[test]
fn a_cube_has_the_recorded_middle() {
    let cage = primitive::cube(1.0).unwrap();
    let surface = CageSurface::new(&cage, settings(&cage, Map::Rational, Blend::default())).unwrap();
    for quad in 0..6 {
        let middle = surface.evaluate(quad, 0.5, 0.5).unwrap();
        assert!((middle.point.length() - 1.421_798_974_002_619).abs() < 1e-14);
        assert!(angle(middle.point, middle.normal.unwrap()) < 1e-14);
        let [k1, k2] = middle.curvatures.unwrap();
        assert!(k1 < 0.0 && k2 < 0.0, "normals are outward, so it bends away from them");
    }
}

/// Derivatives against differences, also across the whole construction.
#[test]
fn derivatives_agree_with_differences() {
    let h = 1e-4;
    for (number, cage) in (0_u64..).zip(family()) {
        let cage = shaken(&cage, 0.1, 40 + number);
        for map in [Map::Rational, Map::Smooth] {
            let surface = CageSurface::new(&cage, settings(&cage, map, Blend::default())).unwrap();
            let at = |i: f64, j: f64| surface.evaluate(0, 0.3 + i * h, 0.6 + j * h).unwrap();
            let here = at(0.0, 0.0);
            let [duu, duv, dvv] = here.second.unwrap();
            let close = |exact: DVec3, difference: DVec3| {
                assert!(exact.distance(difference) < 1e-5, "cage {number}: {exact} {difference}");
            };
            close(here.first[0], (at(1.0, 0.0).point - at(-1.0, 0.0).point) / (2.0 * h));
            close(here.first[1], (at(0.0, 1.0).point - at(0.0, -1.0).point) / (2.0 * h));
            close(duu, (at(1.0, 0.0).first[0] - at(-1.0, 0.0).first[0]) / (2.0 * h));
            close(duv, (at(0.0, 1.0).first[0] - at(0.0, -1.0).first[0]) / (2.0 * h));
            close(dvv, (at(0.0, 1.0).first[1] - at(0.0, -1.0).first[1]) / (2.0 * h));
        }
    }
}

/// Curvature is attained at irregular vertices: every sector tends to that of the vertex's own surface.
#[test]
fn sectors_agree_in_the_curvature_of_a_vertex() {
    for (number, cage) in [
        (1_u64, primitive::cube(1.0).unwrap()),
        (2, primitive::icosahedron(1.5).unwrap()),
        (3, primitive::trebol(2.0).unwrap()),
    ] {
        let cage = shaken(&cage, 0.1, number);
        let surface = CageSurface::new(&cage, settings(&cage, Map::Smooth, Blend::default())).unwrap();
        for h in 0..surface.links.half_edge_count() {
            let near = |r: f64| {
                let (a, b) = (r * 0.6, r * 0.8);
                let (u, v) = [(a, b), (1.0 - b, a), (1.0 - a, 1.0 - b), (b, 1.0 - a)][h % 4];
                surface.evaluate(h / 4, u, v).unwrap()
            };
            let (exact, beside, close) = (near(0.0), near(2e-9), near(1e-5));
            let is_irregular = surface.links.valence(surface.links.origin(h)) != 4;
            assert_eq!(exact.second.is_none(), is_irregular);
            for other in [beside, close] {
                let off = (0..2).map(|k| exact.curvatures.unwrap()[k] - other.curvatures.unwrap()[k]);
                assert!(off.map(f64::abs).fold(0.0, f64::max) < 2e-3, "{exact:?} {other:?}");
                assert!(angle(exact.normal.unwrap(), other.normal.unwrap()) < 1e-4);
            }
        }
    }
}

#[test]
fn what_cannot_be_asked_is_refused() {
    let solid = primitive::icosahedron(1.0).unwrap();
    let none = Settings { split: Split::None, ..Settings::default() };
    assert_eq!(CageSurface::new(&solid, none).unwrap_err(), CageError::NotQuads { face: 0, corners: 3 });
    let mut surface = CageSurface::new(&solid, Settings::default()).unwrap();
    assert_eq!(surface.evaluate(60, 0.0, 0.0).unwrap_err(), CageError::NoSuchQuad { quad: 60, count: 60 });
    for (u, v) in [(-1e-9, 0.0), (0.0, 1.1), (f64::NAN, 0.0)] {
        assert!(matches!(surface.evaluate(0, u, v), Err(CageError::Parameter { .. })));
    }
    let before = surface.positions().to_vec();
    assert_eq!(surface.move_to(&[]).unwrap_err(), CageError::PositionCount { found: 0, vertices: 12 });
    assert_eq!(surface.move_to(&[DVec3::NAN; 12]).unwrap_err(), CageError::Position { vertex: 0 });
    assert_eq!(surface.positions(), before);
    assert_eq!(surface.quads_of_face(19), 57..60);
    assert_eq!(surface.quads_of_face(20), 0..0);
}

/// The sphere cap of the recipe: continuing the inner surface is ten times nearer than mirroring.
#[test]
fn borrowing_is_nearer_to_a_sphere_than_mirroring() {
    let lift = |p: &DVec3| DVec3::new(p.x, p.y, libm::sqrt(1.0 - p.x * p.x - p.y * p.y));
    let flat = primitive::grid(0.12, 8, 8).unwrap();
    let cap = Cage::new(flat.positions().iter().map(lift).collect(), flat.faces().to_vec()).unwrap();
    let worst = |boundary, from: f64, to: f64| {
        let rule = Settings { boundary, ..settings(&cap, Map::Smooth, Blend::default()) };
        let surface = CageSurface::new(&cap, rule).unwrap();
        let edge: Vec<usize> = (1..7).collect();
        edge.into_iter()
            .flat_map(|quad| (0..=20).map(move |k| (quad, from + (to - from) * f64::from(k) / 20.0)))
            .map(|(quad, v)| (surface.evaluate(quad, 0.5, v).unwrap().point.length() - 1.0).abs())
            .fold(0.0, f64::max)
    };
    let (mirrored, borrowed) = (worst(Boundary::Linear, 0.0, 0.9), worst(Boundary::Borrow, 0.0, 0.9));
    assert!(borrowed < mirrored / 4.0, "{borrowed:e} {mirrored:e}");
}

proptest! {
    #![proptest_config(ProptestConfig { cases: if cfg!(target_arch = "wasm32") { 8 } else { 48 }, ..Default::default() })]

    /// Random cages of mixed valence, random affine maps.
    #[test]
    fn affine_maps_commute_and_edges_join(
        which in 0_usize..11,
        seed in any::<u64>(),
        rule in prop_oneof![Just(Split::Linear), Just(Split::Offset), Just(Split::CatmullClark)],
        borrow in any::<bool>(),
        matrix in prop::array::uniform9(-2.0..2.0),
        shift in prop::array::uniform3(-5.0..5.0),
    ) {
        let cage = shaken(&family()[which], 0.15, seed);
        let affine = |p: DVec3| {
            let rows = [0, 3, 6].map(|k| DVec3::new(matrix[k], matrix[k + 1], matrix[k + 2]).dot(p));
            DVec3::from(rows) + DVec3::from(shift)
        };
        let image = Cage::new(cage.positions().iter().map(|p| affine(*p)).collect(), cage.faces().to_vec()).unwrap();
        let boundary = if borrow { Boundary::Borrow } else { Boundary::Linear };
        let settings = Settings { split: rule, boundary, ..Settings::default() };
        let [surface, mapped] = [&cage, &image].map(|cage| CageSurface::new(cage, settings).unwrap());
        for (quad, u, v) in [(0, 0.3, 0.9), (1, 0.0, 0.2), (2, 1.0, 1.0), (3, 0.6, 0.55)] {
            let (here, there) = (surface.evaluate(quad, u, v).unwrap(), mapped.evaluate(quad, u, v).unwrap());
            prop_assert!(affine(here.point).distance(there.point) < 1e-12);
        }
        let (gap, kink, _) = seams(&surface);
        prop_assert!(gap < 1e-13, "{gap:e}");
        prop_assert!(kink < 1e-10, "{kink:e}");
        if rule != Split::CatmullClark {
            prop_assert_eq!(&surface.positions()[..cage.positions().len()], cage.positions());
        }
    }
}
