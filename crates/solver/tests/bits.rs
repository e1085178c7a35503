//! The same bits everywhere: 200 frames on two shapes, hashed; the constants were recorded on x86-64.
//!
//! `cargo xtask test wasm` runs it on the other target.

#![allow(clippy::unwrap_used, reason = "a failing test or bench should stop where it fails")]

use ductile_solver::workload::{self, Stream};
use ductile_solver::{Budget, CurveSettings, CurveSolver, SurfaceSolver, resample};
use glam::DVec3;
#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

/// FNV-1a over the bits of all coordinates.
fn hash(positions: &[DVec3]) -> u64 {
    let bits = positions
        .iter()
        .flat_map(|position| position.to_array())
        .flat_map(|value| value.to_bits().to_le_bytes());
    bits.fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3))
}

/// 200 frames of a handle that jumps, with steps and smoothing.
fn frames(solver: &mut SurfaceSolver, positions: &mut [DVec3], handle: u32) {
    let home = positions[handle as usize];
    let movable: Vec<bool> = solver.fixed().iter().map(|fixed| !fixed).collect();
    let mut stream = Stream::new(11);
    let mut target = home;
    for frame in 0..200 {
        if frame % 10 == 0 {
            target = home + 0.4 * stream.vector();
        }
        let rest = target - positions[handle as usize];
        solver.predict(positions, &[(handle, rest)]).unwrap();
        solver.step(positions, Budget::default()).unwrap();
        if frame % 5 == 4 {
            solver.smooth(positions, &movable, 0.5);
        }
    }
}

#[test]
fn disc_gives_the_recorded_bits() {
    let (mut solver, mut positions) = workload::raised_disc(8, 0.3).unwrap();
    frames(&mut solver, &mut positions, 0);
    assert_eq!(hash(&positions), DISC, "{:#018x}", hash(&positions));
}

#[test]
fn pinned_sphere_gives_the_recorded_bits() {
    let mut shape = workload::sphere(3);
    let pins = workload::pin_axes(&mut shape);
    let mut solver = shape.solver().unwrap();
    frames(&mut solver, &mut shape.positions, pins[4]);
    assert_eq!(hash(&shape.positions), SPHERE, "{:#018x}", hash(&shape.positions));
}

#[test]
fn curve_gives_the_recorded_bits() {
    let fixed: Vec<bool> = (0..64).map(|i| i % 16 == 0).collect();
    let mut solver = CurveSolver::new(64, true, fixed.clone(), CurveSettings::default()).unwrap();
    let turn = |i: i32| libm::sincos(std::f64::consts::TAU * f64::from(i) / 64.0);
    let mut positions: Vec<DVec3> = (0..64).map(|i| DVec3::new(turn(i).1, turn(i).0, 0.0)).collect();
    let mut stream = Stream::new(12);
    for _ in 0..200 {
        let rest = DVec3::X + 0.4 * stream.vector() - positions[0];
        solver.predict(&mut positions, &[(0, rest)]).unwrap();
        solver.step(&mut positions).unwrap();
    }
    let even = resample(&positions, true, &fixed, 0.05, 2).unwrap();
    assert_eq!(hash(&even.positions), CURVE, "{:#018x}", hash(&even.positions));
}

const DISC: u64 = 0x8f6c_87e9_6d36_82be;
const SPHERE: u64 = 0x0f5f_9ad1_5c86_d084;
const CURVE: u64 = 0xf496_117b_d39c_54ee;
