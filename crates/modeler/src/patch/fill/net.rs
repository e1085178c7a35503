//! The control net that a fill shows: the rows of its ribbons, which a designer has a hand in, or all control points of the S-patch.

use ductile_patch::RibbonLoop;
use ductile_patch::s_patch::{PatchKind, SPatch};
use ductile_spec::FillJoin;
use glam::DVec3;

/// Places, and the edges between them.
pub(super) type Lines = (Vec<DVec3>, Vec<[u32; 2]>);

/// The rows of ribbons, and the legs between them where planes are met.
pub(super) fn of_ribbons(ribbons: &RibbonLoop, join: FillJoin) -> Lines {
    let (mut places, mut edges) = (Vec::new(), Vec::new());
    for ribbon in ribbons.ribbons() {
        let rows: &[&Vec<DVec3>] = match join {
            FillJoin::Tangent => &[&ribbon.row0, &ribbon.row1],
            FillJoin::Position => &[&ribbon.row0],
        };
        let first = u32::try_from(places.len()).unwrap_or(0);
        let count = u32::try_from(ribbon.row0.len()).unwrap_or(0);
        for (row, places_of_row) in (0..).zip(rows) {
            places.extend_from_slice(places_of_row);
            edges.extend((1..count).map(|k| [first + row * count + k - 1, first + row * count + k]));
        }
        if rows.len() == 2 {
            edges.extend((0..count).map(|k| [first + k, first + count + k]));
        }
    }
    (places, edges)
}

/// All control points, with an edge between labels that differ by one step from an entry to the next.
pub(super) fn whole(kind: &PatchKind, patch: &SPatch) -> Lines {
    let ends = |edge: [usize; 2]| Some([u32::try_from(edge[0]).ok()?, u32::try_from(edge[1]).ok()?]);
    let edges = kind.labels().edges().into_iter().filter_map(ends).collect();
    (patch.points().to_vec(), edges)
}

#[cfg(test)]
mod tests {
    use super::*;
    use ductile_patch::s_patch::{Fill, Join, Labels};
    use ductile_patch::{Ribbon, made_compatible};
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    /// Flat ribbons of degree 3 around a regular polygon, each leading straight inwards.
    fn flat(sides: u32) -> RibbonLoop {
        let corner = |k: u32| {
            let (sin, cos) = libm::sincos(f64::from(k % sides) * core::f64::consts::TAU / f64::from(sides));
            DVec3::new(cos, sin, 0.0)
        };
        let ribbons = (0..sides).map(|side| {
            let [before, from, to, after] = [side + sides - 1, side, side + 1, side + 2].map(corner);
            let row0: Vec<DVec3> = [0.0, 1.0, 2.0, 3.0].map(|k| from.lerp(to, k / 3.0)).to_vec();
            let [first, last] = [(before - from) / 3.0, (after - to) / 3.0];
            let row1 = (0..4_u32).map(|k| row0[k as usize] + first.lerp(last, f64::from(k) / 3.0)).collect();
            Ribbon { row0, row1 }
        });
        made_compatible(&ribbons.collect::<Vec<_>>()).expect("a regular polygon is a loop").ribbons
    }

    #[test]
    fn the_whole_net_has_all_points_and_as_many_panels_as_there_are() {
        for sides in 3..=6 {
            let ribbons = flat(sides);
            let kind =
                PatchKind::new(sides as usize, 3, Join::Tangent, Fill::Biharmonic, 4).expect("a small one");
            let patch = kind.filling(&ribbons).expect("of this kind").expect("finite");
            let (places, edges) = whole(&kind, &patch);
            assert_eq!(places, patch.points());
            // Each label of a depth less by one stands for a panel, whose corners follow one another around.
            let panels = Labels::new(sides as usize, patch.depth() - 1).expect("a small one").len();
            assert_eq!(edges.len(), panels * sides as usize);
            let is_step = |[from, to]: [u32; 2]| {
                let [from, to] = [from, to].map(|rank| kind.labels().get(rank as usize).to_vec());
                let apart: Vec<i32> =
                    from.iter().zip(&to).map(|(a, b)| i32::from(*a) - i32::from(*b)).collect();
                let n = apart.len();
                (0..n).any(|k| apart[k] == 1 && apart[(k + 1) % n] == -1)
                    && apart.iter().map(|entry| entry.abs()).sum::<i32>() == 2
            };
            assert!(edges.into_iter().all(is_step));
        }
    }

    #[test]
    fn ribbons_show_two_rows_with_legs_or_one_without() {
        let ribbons = flat(5);
        let (places, edges) = of_ribbons(&ribbons, FillJoin::Tangent);
        assert_eq!((places.len(), edges.len()), (5 * 8, 5 * (3 + 3 + 4)));
        let (places, edges) = of_ribbons(&ribbons, FillJoin::Position);
        assert_eq!((places.len(), edges.len()), (5 * 4, 5 * 3));
    }
}
