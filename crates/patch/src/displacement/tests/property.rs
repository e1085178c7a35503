//! Whatever the mesh and the feet: bounds, borders, exact feet, no order.

use crate::{
    Blend, Combination, Direction, Displacements, Domain, Item, Laplacian, Profile, Range, Settings,
};
use ductile_solver::workload::{self, Stream, Workload};
use glam::DVec3;
use proptest::prelude::*;
use proptest::test_runner::{Config, RngSeed};
#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

/// In the browser there are fewer cases, the same ones in every run.
fn cases(native: u32) -> Config {
    if cfg!(target_arch = "wasm32") {
        Config { rng_seed: RngSeed::Fixed(1995), failure_persistence: None, ..Config::with_cases(4) }
    } else {
        Config::with_cases(native)
    }
}

/// A shape with and without boundary, with one side and two, its vertices thrown about by that share of their distance.
fn shape(kind: u8, size: u32, jitter: f64, seed: u64) -> Domain {
    let Workload { mut positions, triangles, .. } = match kind {
        0 => workload::disc(size as usize),
        1 => workload::cylinder(6 + size, 2 + size, 2.0),
        2 => workload::moebius(8 + 2 * size, 4, 0.4),
        3 => workload::torus(6 + size, 5, 2.0, 0.7),
        _ => workload::sphere(2),
    };
    let mut stream = Stream::new(seed);
    positions.iter_mut().for_each(|p| *p += jitter * stream.vector());
    let domain = Domain::new(&positions, &triangles).unwrap();
    if domain.held().contains(&true) { domain } else { domain.with_pins(&[0, 1, 2]).unwrap() }
}

proptest! {
    #![proptest_config(cases(60))]

    #[test]
    fn blends_keep_their_promises(
        kind in 0_u8..5,
        size in 3_u32..8,
        jitter in 0.0..0.3,
        seed in any::<u64>(),
        range in -3.0..0.95,
        settings in (any::<bool>(), any::<bool>(), 0_usize..3),
        picks in proptest::collection::btree_set(0_usize..1000, 1..5),
        stretch in prop_oneof![Just(None), (0.25..4.0).prop_map(Some)],
    ) {
        let domain = shape(kind, size, jitter, seed);
        let free: Vec<usize> = (0..domain.len()).filter(|&v| !domain.held()[v]).collect();
        let feet: std::collections::BTreeSet<usize> = picks.iter().map(|pick| free[pick % free.len()]).collect();
        let (intrinsic, conformal, blend) = settings;
        let settings = Settings {
            laplacian: if intrinsic { Laplacian::IntrinsicDelaunay } else { Laplacian::Cotangent },
            profile: if conformal { Profile::Conformal } else { Profile::Harmonic },
            combination: Combination::Pairwise,
            blend: [Blend::Erbs, Blend::Bump(1.5), Blend::Eta(0.2)][blend],
        };
        let mut stream = Stream::new(seed ^ 1);
        let items: Vec<Item> = feet
            .iter()
            .map(|&foot| {
                let item = Item::foot(foot, stream.vector()).with_range(Range::new(range).unwrap());
                match stretch {
                    Some(stretch) => item.with_direction(Direction::new(DVec3::new(1.0, 0.5, 0.2), stretch).unwrap()),
                    None => item,
                }
            })
            .collect();
        let build = |items: &mut dyn Iterator<Item = &Item>| {
            let mut surface = Displacements::new(domain.clone(), settings).unwrap();
            for item in items {
                surface.add(item.clone()).unwrap();
            }
            surface
        };
        let mut surface = build(&mut items.iter());
        let offsets = surface.offsets().unwrap();
        let largest = items.iter().map(|item| item.displacements[0].length()).fold(0.0, f64::max);
        for (vertex, offset) in offsets.iter().enumerate() {
            prop_assert!(offset.length() <= largest * (1.0 + 1e-12), "overshoot at {vertex}");
            prop_assert!(!domain.held()[vertex] || *offset == DVec3::ZERO, "the border moved at {vertex}");
        }
        for (index, item) in items.iter().enumerate() {
            prop_assert_eq!(offsets[item.vertices[0]], item.displacements[0]);
            prop_assert!(surface.blend(index).unwrap().iter().all(|b| (0.0..=1.0).contains(b)));
            if intrinsic && stretch.is_none() {
                let green = surface.solution(index).unwrap();
                let most = green[item.vertices[0]];
                prop_assert!(green.iter().all(|&g| g >= -1e-12 * most && g <= most * (1.0 + 1e-12)));
            }
        }
        let backwards = build(&mut items.iter().rev()).offsets().unwrap();
        prop_assert!(offsets.iter().zip(&backwards).all(|(x, y)| x.distance(*y) < 1e-12));
        // The cardinal functions meet all feet too; the plain sum meets each foot alone.
        surface.set_settings(Settings { combination: Combination::Cardinal, ..settings }).unwrap();
        let cardinal = surface.offsets().unwrap();
        prop_assert!(items.iter().all(|item| cardinal[item.vertices[0]] == item.displacements[0]));
        let alone = build(&mut items.iter().take(1)).offsets().unwrap();
        surface.set_settings(Settings { combination: Combination::Plain, ..settings }).unwrap();
        while surface.items().len() > 1 {
            surface.remove(1).unwrap();
        }
        prop_assert_eq!(surface.offsets().unwrap(), alone);
    }
}
