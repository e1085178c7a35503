//! Which triangle of a chart covers a place of the unit disc: buckets of triangles, so that a place looks at a few only.

use glam::DVec2;

/// The triangles of a chart, by squares of [-1, 1]².
#[derive(Clone, Debug)]
pub(super) struct Lookup {
    /// Squares along a side.
    across: usize,
    buckets: Vec<Vec<u32>>,
}

impl Lookup {
    pub(super) fn new(places: &[DVec2], triangles: &[[u32; 3]]) -> Self {
        let mut across = 1;
        while 2 * across * across < triangles.len() && across < 256 {
            across += 1;
        }
        let mut lookup = Self { across, buckets: vec![Vec::new(); across * across] };
        for (index, corners) in (0..).zip(triangles) {
            let corners = corners.map(|v| places[v as usize]);
            let low = corners[0].min(corners[1]).min(corners[2]);
            let high = corners[0].max(corners[1]).max(corners[2]);
            let ([left, below], [right, above]) = (lookup.square(low), lookup.square(high));
            for row in below..=above {
                for column in left..=right {
                    lookup.buckets[row * across + column].push(index);
                }
            }
        }
        lookup
    }

    /// The triangle that covers a place, or comes nearest to it, and barycentric coordinates, none of them below 0.
    pub(super) fn find(
        &self,
        places: &[DVec2],
        triangles: &[[u32; 3]],
        at: DVec2,
    ) -> Option<([u32; 3], [f64; 3])> {
        let [column, row] = self.square(at);
        // A circle's place may lie just outside of the polygon whose corners are on it: then squares further off count.
        for ring in 0..self.across {
            let rows = row.saturating_sub(ring)..=(row + ring).min(self.across - 1);
            let mut best: Option<(f64, [u32; 3], [f64; 3])> = None;
            for square in rows.flat_map(|row| {
                let columns = column.saturating_sub(ring)..=(column + ring).min(self.across - 1);
                columns.map(move |column| row * self.across + column)
            }) {
                for &index in &self.buckets[square] {
                    let corners = triangles[index as usize];
                    let shares = shares(corners.map(|v| places[v as usize]), at);
                    let least = shares[0].min(shares[1]).min(shares[2]);
                    if least.is_finite() && best.is_none_or(|(most, ..)| least > most) {
                        best = Some((least, corners, shares));
                    }
                }
            }
            if let Some((_, corners, shares)) = best {
                let held = shares.map(|share| share.max(0.0));
                let sum = held[0] + held[1] + held[2];
                return Some((corners, held.map(|share| share / sum)));
            }
        }
        None
    }

    fn square(&self, at: DVec2) -> [usize; 2] {
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "held within the squares before"
        )]
        let of =
            |x: f64| (((x + 1.0) * 0.5 * self.across as f64).clamp(0.0, 255.0) as usize).min(self.across - 1);
        [of(at.x), of(at.y)]
    }
}

fn shares([a, b, c]: [DVec2; 3], at: DVec2) -> [f64; 3] {
    let area = (b - a).perp_dot(c - a);
    let (to_b, to_c) = ((at - a).perp_dot(c - a) / area, (b - a).perp_dot(at - a) / area);
    [1.0 - to_b - to_c, to_b, to_c]
}
