//! The same as `cage.rs`, `displacement.rs` and `s_patch.rs` in a browser's worker, under the same names, so that the ratio of
//! wasm to native can be read off. How to run it: docs/performance.md.
#![cfg(target_arch = "wasm32")]
#![allow(clippy::unwrap_used, reason = "a failing bench should stop where it fails")]

use ductile_patch::cage::{Cage, CageSurface, Settings as CageSettings, Split, Tessellation, primitive};
use ductile_patch::s_patch::{Domain as Polygon, Fill, Join, MaskCache, SPatch, Tessellation as Grid};
use ductile_patch::{Displacements, Domain, Item, Ribbon, Settings, made_compatible};
use ductile_solver::workload;
use glam::DVec3;
use std::hint::black_box;
use std::time::Duration;
use wasm_bindgen_test::{Criterion, Instant, wasm_bindgen_bench};

/// The defaults would take a minute for each figure.
fn quick(criterion: &mut Criterion) {
    let owned = std::mem::take(criterion);
    *criterion = owned
        .sample_size(10)
        .warm_up_time(Duration::from_millis(300))
        .measurement_time(Duration::from_secs(2));
}

/// Times `work` on what `make` makes outside the measured time.
fn on_fresh<T>(count: u64, make: impl Fn() -> T, mut work: impl FnMut(&mut T)) -> Duration {
    let mut total = Duration::ZERO;
    for _ in 0..count {
        let mut fresh = make();
        let start = Instant::now();
        work(&mut fresh);
        total += start.elapsed();
    }
    total
}

fn cage(criterion: &mut Criterion, name: &str, cage: &Cage, split: Split) {
    quick(criterion);
    let mut surface = CageSurface::new(cage, CageSettings { split, ..CageSettings::default() }).unwrap();
    let mut tessellation = Tessellation::new(&surface, 8).unwrap();
    let count = tessellation.positions().len();
    criterion.bench_function(&format!("cage/{name}: tables and first evaluation"), |bencher| {
        bencher.iter(|| black_box(Tessellation::new(&surface, 8)).is_ok());
    });
    criterion.bench_function(&format!("cage/{name}: evaluate all, {count} vertices"), |bencher| {
        bencher.iter(|| tessellation.evaluate(black_box(surface.positions())));
    });
    let mut positions = cage.positions().to_vec();
    let mut by = 0.01;
    positions[0].z += by;
    let moved = surface.move_to(&positions).unwrap();
    let touched = tessellation.update(surface.positions(), &moved);
    criterion.bench_function(&format!("cage/{name}: one dragged vertex, {touched} vertices"), |bencher| {
        bencher.iter(|| {
            by = -by;
            positions[0].z += by;
            let moved = surface.move_to(&positions).unwrap();
            tessellation.update(surface.positions(), &moved)
        });
    });
}

#[wasm_bindgen_bench]
fn torus_cage(criterion: &mut Criterion) {
    cage(criterion, "torus-64x32", &primitive::torus(3.0, 1.0, 64, 32).unwrap(), Split::None);
}

#[wasm_bindgen_bench]
fn icosahedron_cage(criterion: &mut Criterion) {
    cage(criterion, "icosahedron-split", &primitive::icosahedron(1.0).unwrap(), Split::Offset);
}

#[wasm_bindgen_bench]
fn trebol_cage(criterion: &mut Criterion) {
    cage(criterion, "trebol", &primitive::trebol(2.0).unwrap(), Split::None);
}

fn displacement(criterion: &mut Criterion, name: &str, rings: usize) {
    quick(criterion);
    let disc = workload::disc(rings);
    let set_up = || {
        let domain = Domain::new(&disc.positions, &disc.triangles).unwrap();
        Displacements::new(domain, Settings::default()).unwrap()
    };
    let empty = set_up();
    let foot = |turn: usize| Item::foot(1 + 3 * (rings / 2) * (rings / 2 - 1) + turn * rings / 2, DVec3::Z);
    criterion.bench_function(&format!("displacement/{name}: set-up"), |bencher| {
        bencher.iter_custom(|count| on_fresh(count, || (), |()| drop(black_box(set_up()))));
    });
    criterion.bench_function(&format!("displacement/{name}: first foot"), |bencher| {
        bencher.iter_custom(|count| {
            on_fresh(
                count,
                || empty.clone(),
                |s| {
                    s.add(foot(0)).unwrap();
                },
            )
        });
    });
    let mut surface = empty.clone();
    surface.add(foot(0)).unwrap();
    surface.add(foot(2)).unwrap();
    let mut height = 0.0;
    criterion.bench_function(&format!("displacement/{name}: drag one of two"), |bencher| {
        bencher.iter(|| {
            height += 1e-3;
            surface.set_displacement(0, &[DVec3::Z * height]).unwrap();
            black_box(surface.offsets()).is_ok()
        });
    });
}

#[wasm_bindgen_bench]
fn displacement_10k(criterion: &mut Criterion) {
    displacement(criterion, "10k", 57);
}

#[wasm_bindgen_bench]
fn displacement_100k(criterion: &mut Criterion) {
    displacement(criterion, "100k", 182);
}

fn s_patch(criterion: &mut Criterion, name: &str, n: usize, d: usize) {
    quick(criterion);
    let corners = Polygon::new(n);
    let at = |side: usize, u: f64, inward: f64| {
        let p = corners.on_side(side, u) * (1.0 - inward);
        DVec3::new(p.x, p.y, 0.3 * p.x * p.x - 0.2 * p.x * p.y + 0.1 * p.y)
    };
    let row = |side, inward| (0..=d).map(|j| at(side, j as f64 / d as f64, inward)).collect();
    let ribbons: Vec<Ribbon> =
        (0..n).map(|side| Ribbon { row0: row(side, 0.0), row1: row(side, 0.8 / d as f64) }).collect();
    let ring = made_compatible(&ribbons).unwrap().ribbons;
    let build =
        |cache: &mut MaskCache| SPatch::filling(&ring, Join::Tangent, Fill::Biharmonic, cache).unwrap();
    criterion.bench_function(&format!("{name}: first build"), |bencher| {
        bencher.iter_custom(|count| on_fresh(count, MaskCache::new, |cache| drop(black_box(build(cache)))));
    });
    let mut cache = MaskCache::new();
    let patch = build(&mut cache);
    criterion.bench_function(&format!("{name}: build again"), |bencher| {
        bencher.iter(|| drop(black_box(build(&mut cache))));
    });
    let own = Grid::new(n, d + 3, 16).unwrap();
    let count = own.vertex_count();
    criterion.bench_function(&format!("{name}: vertices and normals, {count} of them"), |bencher| {
        bencher.iter(|| own.evaluate(&patch));
    });
}

#[wasm_bindgen_bench]
fn five_sided_quintic(criterion: &mut Criterion) {
    s_patch(criterion, "5-sided quintic", 5, 5);
}

/// What a hole with five sides gets by itself.
#[wasm_bindgen_bench]
fn five_sided_septic(criterion: &mut Criterion) {
    s_patch(criterion, "5-sided septic", 5, 7);
}

/// What a hole with four sides gets by itself at the rim of a cage.
#[wasm_bindgen_bench]
fn four_sided_of_degree_ten(criterion: &mut Criterion) {
    s_patch(criterion, "4-sided of degree 10", 4, 10);
}

/// The same with five sides.
#[wasm_bindgen_bench]
fn five_sided_of_degree_eight(criterion: &mut Criterion) {
    s_patch(criterion, "5-sided of degree 8", 5, 8);
}

#[wasm_bindgen_bench]
fn eight_sided_cubic(criterion: &mut Criterion) {
    s_patch(criterion, "8-sided cubic", 8, 3);
}
