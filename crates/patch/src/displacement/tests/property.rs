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

/// A shape with and without boundary, with one side and two, its vertices thrown about by that share of their distance, and pressed
/// flat to that share of its height: the flatter, the more obtuse its triangles.
fn shape(kind: u8, size: u32, jitter: f64, seed: u64, height: f64) -> Domain {
    let Workload { mut positions, triangles, .. } = match kind {
        0 => workload::disc(size as usize),
        1 => workload::cylinder(6 + size, 2 + size, 2.0),
        2 => workload::moebius(8 + 2 * size, 4, 0.4),
        3 => workload::torus(6 + size, 5, 2.0, 0.7),
        _ => workload::sphere(2),
    };
    let mut stream = Stream::new(seed);
    positions.iter_mut().for_each(|p| {
        *p += jitter * stream.vector();
        p.y *= height;
    });
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
        let domain = shape(kind, size, jitter, seed, 1.0);
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

    /// What an item adds is gone with it, to the last bit; and under the plain sum a foot moves by exactly what it is dragged by,
    /// whatever the others do. On flat triangles too.
    #[test]
    fn what_is_dragged_moves_so_and_what_is_erased_is_gone(
        kind in 0_u8..5,
        size in 3_u32..8,
        jitter in 0.0..0.3,
        height in prop_oneof![Just(1.0), 0.02..1.0],
        seed in any::<u64>(),
        ranges in prop::array::uniform3(-3.0..0.95),
        way in (any::<bool>(), any::<bool>(), 0_usize..3),
        picks in prop::array::uniform3(any::<prop::sample::Index>()),
        drag in prop::array::uniform3(-2.0..2.0),
    ) {
        let domain = shape(kind, size, jitter, seed, height);
        let free: Vec<usize> = (0..domain.len()).filter(|&v| !domain.held()[v]).collect();
        let feet = picks.map(|pick| *pick.get(&free));
        prop_assume!(feet[0] != feet[1] && feet[1] != feet[2] && feet[0] != feet[2]);
        let (conformal, plain, blend) = way;
        let settings = Settings {
            profile: if conformal { Profile::Conformal } else { Profile::Harmonic },
            combination: if plain { Combination::Plain } else { Combination::Pairwise },
            blend: [Blend::Erbs, Blend::Bump(1.0), Blend::Eta(0.0)][blend],
            ..Settings::default()
        };
        let mut stream = Stream::new(seed ^ 2);
        let items: Vec<Item> = feet
            .iter()
            .zip(ranges)
            .map(|(&foot, range)| Item::foot(foot, stream.vector()).with_range(Range::new(range).unwrap()))
            .collect();
        let mut surface = Displacements::new(domain.clone(), settings).unwrap();
        for item in &items[..2] {
            surface.add(item.clone()).unwrap();
        }
        let before = surface.offsets().unwrap();
        for index in 0..2 {
            let green = surface.solution(index).unwrap();
            let most = green[feet[index]];
            prop_assert!(green.iter().all(|&g| (-1e-12 * most..=most * (1.0 + 1e-12)).contains(&g)), "0 <= h <= 1");
            prop_assert!(surface.blend(index).unwrap().iter().all(|b| (0.0..=1.0).contains(b)));
            prop_assert_eq!(surface.blend(index).unwrap()[feet[index]], 1.0);
        }
        // A third comes and goes.
        surface.add(items[2].clone()).unwrap();
        let three = surface.offsets().unwrap();
        surface.remove(2).unwrap();
        prop_assert_eq!(&surface.offsets().unwrap(), &before);
        // One is dragged and brought back.
        let drag = DVec3::from(drag);
        let (own, to) = (items[0].displacements[0], items[0].displacements[0] + drag);
        surface.set_displacement(0, &[to]).unwrap();
        let moved = surface.offsets().unwrap();
        let by = moved[feet[0]] - before[feet[0]];
        prop_assert!(by.distance(drag) < 1e-14 * (4.0 + drag.length()), "moved by {by}, dragged by {drag}");
        prop_assert!(plain || (moved[feet[0]] == to && moved[feet[1]] == items[1].displacements[0]));
        prop_assert!(!plain || three[feet[2]] != before[feet[2]]);
        surface.set_displacement(0, &[own]).unwrap();
        prop_assert_eq!(&surface.offsets().unwrap(), &before);
        // What was first goes, and comes back last.
        surface.remove(0).unwrap();
        surface.add(items[0].clone()).unwrap();
        let again = surface.offsets().unwrap();
        prop_assert!(again.iter().zip(&before).all(|(x, y)| x.distance(*y) < 1e-13));
    }
}
