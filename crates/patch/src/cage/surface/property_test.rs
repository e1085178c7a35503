//! What holds over any cage: random ones, cut and pulled about by the edits that a designer has, so that vertices with 3 to 8 faces,
//! faces with 3 corners and more, and boundaries come together as they like.

use super::tests::shaken;
use super::*;
use crate::cage::edit::{delete_face, extrude_face, split_edge, split_face, split_face_at_centre};
use crate::cage::{Tessellation, primitive};
use proptest::prelude::*;
#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

/// Most faces at a vertex of a random cage.
const MOST_FACES: usize = 8;
/// Length of an edge of the cages, about.
const SIZE: f64 = 1.0;

/// An edit by three numbers; a cage that it cannot be done to stays.
fn edited(cage: Cage, (what, where_, how): (u8, prop::sample::Index, f64)) -> Cage {
    let index = where_.index(cage.faces().len());
    let face = u32::try_from(index).unwrap();
    let corners = &cage.faces()[index];
    let second = corners[1 + index % (corners.len() - 1)];
    let outcome = match what {
        0 => extrude_face(&cage, face, 0.4 + 0.4 * how),
        1 => split_face_at_centre(&cage, face),
        2 => split_face(&cage, face, corners[0], second),
        3 => split_edge(&cage, corners[0], corners[1], 0.3 + 0.4 * how),
        _ if cage.faces().len() > 3 => delete_face(&cage, face),
        _ => return cage,
    };
    // What would bring more faces together than is asked for is left out too.
    let fits = |cage: &Cage| (0..cage.positions().len()).all(|vertex| cage.valence(vertex) <= MOST_FACES);
    outcome.ok().filter(fits).unwrap_or(cage)
}

fn cages() -> impl Strategy<Value = Cage> {
    let edits = proptest::collection::vec((0_u8..5, any::<prop::sample::Index>(), 0.0..1.0), 0..8);
    (0_usize..7, edits, any::<u64>()).prop_map(|(which, edits, seed)| {
        let start = match which {
            0 => primitive::cube(SIZE),
            1 => primitive::tetrahedron(SIZE),
            2 => primitive::octahedron(SIZE),
            3 => primitive::torus(3.0 * SIZE, SIZE, 6, 4),
            4 => primitive::grid(SIZE, 3, 2),
            5 => primitive::disc(2.0 * SIZE, 8),
            _ => primitive::disc(SIZE, 3),
        };
        shaken(&edits.into_iter().fold(start.unwrap(), edited), 0.1 * SIZE, seed)
    })
}

fn settings() -> impl Strategy<Value = Settings> {
    let map = prop_oneof![Just(Map::Rational), Just(Map::Smooth)];
    let blend = prop_oneof![
        (1_u32..=6).prop_map(Blend::Hermite),
        (1_u32..=3).prop_map(Blend::Bump),
        Just(Blend::Erbs)
    ];
    let split =
        prop_oneof![Just(Split::None), Just(Split::Linear), Just(Split::Offset), Just(Split::CatmullClark)];
    let boundary = prop_oneof![Just(Boundary::Linear), Just(Boundary::Borrow)];
    (map, blend, split, boundary).prop_map(|(map, blend, split, boundary)| Settings {
        map,
        blend,
        split,
        boundary,
    })
}

/// Both sides of an inner edge at a place of it.
fn across(surface: &CageSurface, h: usize, t: f64) -> Option<[SurfacePoint; 2]> {
    let twin = surface.links.twin(h)?;
    let at = |h: usize, t: f64| {
        let (u, v) = [(t, 0.0), (1.0, t), (1.0 - t, 1.0), (0.0, 1.0 - t)][h % 4];
        surface.evaluate(h / 4, u, v).unwrap()
    };
    Some([at(h, t), at(twin, 1.0 - t)])
}

/// How far two tangent planes are apart, times how far the derivatives are from being parallel: a wild cage may fold, and where it has
/// no normal there is none to compare.
fn kink([a, b]: &[SurfacePoint; 2]) -> f64 {
    let spread = |p: &SurfacePoint| {
        let [u, v] = p.first;
        u.cross(v).length() / (u.length() * v.length()).max(f64::MIN_POSITIVE)
    };
    match (a.normal, b.normal) {
        (Some(m), Some(n)) => m.cross(n).length() * spread(a).min(spread(b)),
        _ => 0.0,
    }
}

proptest! {
    #![proptest_config(crate::property_test::cases(160, 12))]

    #[test]
    fn random_cages_are_met_and_their_patches_join(cage in cages(), settings in settings(), t in 0.02..0.98) {
        let needed = cage.split_needed();
        let settings = if settings.split == Split::None { Settings { split: needed, ..settings } } else { settings };
        let surface = CageSurface::new(&cage, settings).unwrap();
        let extent = cage.positions().iter().map(|p| p.length()).fold(0.0, f64::max);
        if settings.split != Split::CatmullClark {
            prop_assert_eq!(&surface.positions()[..cage.positions().len()], cage.positions());
        }
        for (quad, corners) in surface.quads().iter().enumerate() {
            for (vertex, (u, v)) in corners.iter().zip([(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]) {
                let off = surface.evaluate(quad, u, v).unwrap().point.distance(surface.positions()[*vertex as usize]);
                prop_assert!(off < 1e-12 * extent, "vertex {vertex} is missed by {off:e}");
            }
        }
        for h in surface.links.edges() {
            let Some(pair) = across(&surface, h, t) else { continue };
            let gap = pair[0].point.distance(pair[1].point);
            prop_assert!(gap < 1e-12 * extent, "gap {gap:e}");
            prop_assert!(kink(&pair) < 1e-11, "kink {:e}", kink(&pair));
        }
    }

    /// With the smooth map and a blend that is flat to the second order the surface bends alike on both sides of every edge.
    #[test]
    fn random_cages_bend_alike_across_edges(cage in cages(), settings in settings(), t in 0.05..0.95) {
        let split = if settings.split == Split::None { cage.split_needed() } else { settings.split };
        let blend = if settings.blend == Blend::Hermite(1) { Blend::Hermite(2) } else { settings.blend };
        let surface = CageSurface::new(&cage, Settings { map: Map::Smooth, blend, split, ..settings }).unwrap();
        for h in surface.links.edges() {
            let Some(pair) = across(&surface, h, t) else { continue };
            let [Some([k1, k2]), Some([l1, l2])] = pair.map(|p| p.curvatures) else { continue };
            let most = [k1, k2, l1, l2].into_iter().map(f64::abs).fold(1.0 / SIZE, f64::max);
            // Where it nearly folds, curvatures have no digits left.
            if most < 1e4 {
                let jump = (k1 + k2 - l1 - l2).abs();
                prop_assert!(jump < 1e-8 * most * most, "curvatures differ by {jump:e} at {most:e}");
            }
        }
    }

    #[test]
    fn random_cages_have_meshes_without_gaps(cage in cages(), settings in settings(), resolution in 1_usize..5) {
        let split = if settings.split == Split::None { cage.split_needed() } else { settings.split };
        let surface = CageSurface::new(&cage, Settings { split, ..settings }).unwrap();
        let tessellation = Tessellation::new(&surface, resolution).unwrap();
        let triangles = tessellation.triangles().iter().map(|corners| corners.to_vec()).collect();
        let mesh = Cage::new(tessellation.positions().to_vec(), triangles).unwrap();
        prop_assert_eq!(mesh.is_closed(), cage.is_closed());
        prop_assert_eq!(mesh.euler_characteristic(), cage.euler_characteristic());
        // The mesh is the surface.
        for (corner, &vertex) in surface.quads()[0].iter().enumerate() {
            let (u, v) = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)][corner];
            let exact = surface.evaluate(0, u, v).unwrap().point;
            prop_assert!(tessellation.positions().iter().any(|p| p.distance(exact) < 1e-12), "vertex {vertex}");
        }
    }
}

/// The generator makes what it is meant to: every valence from 3 to 8, faces that are no quads, and boundaries.
#[test]
fn random_cages_are_of_all_kinds() {
    let mut runner = proptest::test_runner::TestRunner::deterministic();
    let mut valences = [0; MOST_FACES + 1];
    let (mut mixed, mut open) = (0, 0);
    for _ in 0..200 {
        let cage = proptest::strategy::ValueTree::current(&cages().new_tree(&mut runner).unwrap());
        (0..cage.positions().len()).for_each(|vertex| valences[cage.valence(vertex)] += 1);
        mixed += usize::from(cage.split_needed() != Split::None);
        open += usize::from(!cage.is_closed());
    }
    assert!(valences[3..].iter().all(|count| *count > 10), "{valences:?}");
    assert!(mixed > 30 && open > 30, "{mixed} {open}");
}
