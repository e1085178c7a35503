//! The same as `step.rs` in a browser's worker: predictor and whole step, and the fit and the gradient on their own.
//!
//! Names and workloads are those of `step.rs`, so that the ratio of wasm to native can be read off. One iteration of a
//! step or of the predictor starts from a copy made outside the measured time, as there.
#![cfg(target_arch = "wasm32")]
#![allow(clippy::unwrap_used, reason = "a failing test or bench should stop where it fails")]

use std::hint::black_box;
use std::time::Duration;

use ductile_solver::{Budget, SurfaceSolver, workload};
use glam::DVec3;
use wasm_bindgen_test::{Criterion, Instant, wasm_bindgen_bench};

struct Case {
    name: &'static str,
    solver: SurfaceSolver,
    positions: Vec<DVec3>,
    handle: u32,
}

fn disc(name: &'static str, rings: usize) -> Case {
    let (solver, positions) = workload::raised_disc(rings, 0.2).unwrap();
    Case { name, solver, positions, handle: 0 }
}

fn closed(name: &'static str, levels: u32) -> Case {
    let (solver, positions) = workload::pulled_sphere(levels, 0.2).unwrap();
    let top = solver.fixed().iter().zip(&positions).position(|(fixed, p)| *fixed && p.z > 1.1).unwrap();
    Case { name, solver, positions, handle: u32::try_from(top).unwrap() }
}

/// Times `work` on copies of the case, `count` times; the copies are made outside the measured time.
fn on_copies(case: &Case, count: u64, mut work: impl FnMut(&mut SurfaceSolver, &mut Vec<DVec3>)) -> Duration {
    let mut total = Duration::ZERO;
    for _ in 0..count {
        let (mut solver, mut positions) = (case.solver.clone(), case.positions.clone());
        let start = Instant::now();
        work(&mut solver, &mut positions);
        total += start.elapsed();
    }
    total
}

impl Case {
    fn measure(&self, criterion: &mut Criterion) {
        // The defaults would take a minute for each figure of a large shape.
        let owned = std::mem::take(criterion);
        *criterion = owned
            .sample_size(10)
            .warm_up_time(Duration::from_millis(300))
            .measurement_time(Duration::from_secs(2));
        let name = self.name;
        criterion.bench_function(&format!("{name}: step after a drag"), |bencher| {
            bencher.iter_custom(|count| {
                on_copies(self, count, |solver, positions| {
                    black_box(solver.step(positions, Budget::default()).unwrap());
                })
            });
        });
        criterion.bench_function(&format!("{name}: predictor"), |bencher| {
            bencher.iter_custom(|count| {
                on_copies(self, count, |solver, positions| {
                    black_box(solver.predict(positions, &[(self.handle, DVec3::Z * 0.01)]).unwrap());
                })
            });
        });
        let mut solver = self.solver.clone();
        // A sweep at the positions of the last one is skipped, so there are two sets of them to go between.
        let mut sets = [self.positions.clone(), self.positions.iter().map(|p| 1.5 * *p).collect()];
        criterion.bench_function(&format!("{name}: fit"), |bencher| {
            bencher.iter(|| {
                sets.swap(0, 1);
                solver.fit_all(&sets[0]);
            });
        });
        // One sweep makes fit and gradient; asked for alone, the gradient sweeps once more.
        criterion.bench_function(&format!("{name}: fit, then fit and gradient"), |bencher| {
            bencher.iter(|| {
                sets.swap(0, 1);
                solver.fit_all(&sets[0]);
                black_box(solver.gradient().len())
            });
        });
    }
}

#[wasm_bindgen_bench]
fn disc_1k(criterion: &mut Criterion) {
    disc("disc 1k", 18).measure(criterion);
}

#[wasm_bindgen_bench]
fn disc_10k(criterion: &mut Criterion) {
    disc("disc 10k", 57).measure(criterion);
}

#[wasm_bindgen_bench]
fn disc_50k(criterion: &mut Criterion) {
    disc("disc 50k", 128).measure(criterion);
}

#[wasm_bindgen_bench]
fn closed_0_6k(criterion: &mut Criterion) {
    closed("closed 0.6k", 3).measure(criterion);
}

#[wasm_bindgen_bench]
fn closed_10k(criterion: &mut Criterion) {
    closed("closed 10k", 5).measure(criterion);
}

#[wasm_bindgen_bench]
fn closed_41k(criterion: &mut Criterion) {
    closed("closed 41k", 6).measure(criterion);
}
