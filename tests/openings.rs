//! What the constructions among the examples open to when their documents ask for other densities than they were made at: the
//! same shape, at rest. A document holds no mesh, so the way to its shape begins at the creased skin over a few triangles.

#![allow(clippy::unwrap_used, reason = "a failing test should stop where it fails")]
#![allow(clippy::print_stdout, reason = "the figures are worth seeing with --nocapture")]

use acceptance::Bench;
use ductile_spec::{Example, Request, to_text};

/// Most steps to rest.
const STEPS: u32 = 400;
/// How far an energy may lie from that at the example's own density: what coarse meshes err by is half of this.
const TOLERANCE: f64 = 0.06;

/// The energy at rest of an example's document at so many times its spacing.
fn at_rest(example: Example, factor: f64) -> f64 {
    let mut document = Bench::with(example).document();
    let spacing = document.spacing.unwrap();
    document.spacing = Some(spacing * factor);
    let mut bench = Bench::new();
    bench.accept(Request::OpenText { text: to_text(&document) });
    let first = bench.step(None).frame.figures.energy;
    let energy = bench.rest(STEPS);
    println!("{example:?} x{factor}: {first:.3} at the first step, {energy:.3} at rest");
    energy
}

fn open_at(factors: &[f64], examples: impl IntoIterator<Item = Example>) {
    for example in examples {
        let own = at_rest(example, 1.0);
        for factor in factors {
            let energy = at_rest(example, *factor);
            assert!(
                (energy / own - 1.0).abs() < TOLERANCE,
                "{example:?} x{factor}: {energy}, {own} at its own"
            );
        }
    }
}

/// All but the bored ball, which is slow: as a thin plate, which it is at first, it swells.
fn thin_plates() -> impl Iterator<Item = Example> {
    Example::BUILT.into_iter().filter(|example| *example != Example::BoredBall)
}

#[test]
fn constructions_open_at_finer_densities() {
    open_at(&[0.75, 0.9], thin_plates());
}

#[test]
fn constructions_open_at_coarser_densities() {
    open_at(&[1.2, 1.33], thin_plates());
}

/// Not at any coarser one: at 1.25 and 1.28 times its spacing, say, no way to begin resolves it, and it ends in a crumple.
#[test]
fn the_bored_ball_opens_at_other_densities() {
    open_at(&[0.75, 0.9, 1.2, 1.33], [Example::BoredBall]);
}
