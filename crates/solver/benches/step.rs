//! What a frame costs: the predictor, and one full step (fit, gradient, assembly, conjugate gradients, line search);
//! and the fit and the gradient on their own.
//!
//! The workloads live in the library, so that `wasm_step.rs` can run the same ones in a browser. Native only.

#![allow(clippy::unwrap_used, reason = "a failing test or bench should stop where it fails")]

#[cfg(not(target_arch = "wasm32"))]
mod native {
    use std::time::Duration;

    use criterion::{BatchSize, Criterion};
    use ductile_solver::{Budget, SurfaceSolver, workload};
    use glam::DVec3;

    type Case = (&'static str, SurfaceSolver, Vec<DVec3>, u32);

    fn cases() -> Vec<Case> {
        let disc = |name, rings| {
            let (solver, positions) = workload::raised_disc(rings, 0.2).unwrap();
            (name, solver, positions, 0)
        };
        let sphere = |name, levels| {
            let (solver, positions) = workload::pulled_sphere(levels, 0.2).unwrap();
            let top =
                solver.fixed().iter().zip(&positions).position(|(fixed, p)| *fixed && p.z > 1.1).unwrap();
            (name, solver, positions, u32::try_from(top).unwrap())
        };
        vec![
            disc("disc 1k", 18),
            disc("disc 10k", 57),
            disc("disc 50k", 128),
            sphere("closed 0.6k", 3),
            sphere("closed 10k", 5),
            sphere("closed 41k", 6),
        ]
    }

    pub(super) fn main() {
        let mut criterion = Criterion::default()
            .sample_size(10)
            .warm_up_time(Duration::from_millis(300))
            .measurement_time(Duration::from_secs(2))
            .configure_from_args();
        for (name, solver, positions, handle) in cases() {
            criterion.bench_function(&format!("{name}: step after a drag"), |bencher| {
                bencher.iter_batched_ref(
                    || (solver.clone(), positions.clone()),
                    |(solver, positions)| solver.step(positions, Budget::default()).unwrap(),
                    BatchSize::LargeInput,
                );
            });
            criterion.bench_function(&format!("{name}: predictor"), |bencher| {
                bencher.iter_batched_ref(
                    || (solver.clone(), positions.clone()),
                    |(solver, positions)| solver.predict(positions, &[(handle, DVec3::Z * 0.01)]).unwrap(),
                    BatchSize::LargeInput,
                );
            });
            // A sweep at the positions of the last one is skipped, so there are two sets of them to go between.
            let mut solver = solver.clone();
            let mut sets = [positions.clone(), positions.iter().map(|p| 1.5 * *p).collect()];
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
                    solver.gradient().len()
                });
            });
        }
        criterion.final_summary();
    }
}

fn main() {
    #[cfg(not(target_arch = "wasm32"))]
    native::main();
}
