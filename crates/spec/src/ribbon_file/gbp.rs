//! Ribbons in a file of text, `.gbp`: a generalised Bézier patch as the programs of P. Salvi write it (Várady, Salvi and Karikó, *A
//! multi-sided Bézier patch with a simple control structure*, 2016), which his S-patch program fills between, too.
//!
//! ```text
//! n d                 sides and degree
//! x y z               the middle
//! x y z               row 0: of each side its points 0 to d - 1, since the last one is the first of the next side
//! ...
//! x y z               row 1: of each side its points 1 to d - 2; and so on, as far as there are rows
//! ```
//!
//! Only the rows 0 and 1 are ribbons. Of degree 2 there is no row 1 but the middle, which is the twist point of all corners.

use super::RibbonFileError;
use crate::fill::{FillInterior, FillJoin, FillRibbon};
use crate::ribbon_file::RibbonHole;
use glam::DVec3;

/// Most sides, and the highest degree, that are read: what a fill can have.
const MOST: [usize; 2] = [64, 15];

/// Reads a text. None if it does not begin with two whole numbers.
pub(super) fn hole(text: &str) -> Option<Result<RibbonHole, RibbonFileError>> {
    let mut lines = text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty());
    let (first, line) = lines.next()?;
    let sizes: Vec<u64> =
        line.split_whitespace().map(|word| word.parse().ok()).collect::<Option<Vec<_>>>()?;
    // What is too large for a pointer of 32 bits is refused as what is too large at all.
    let [sides, degree] = sizes[..] else { return None };
    let [sides, degree] = [sides, degree].map(|size| usize::try_from(size).unwrap_or(usize::MAX));
    Some(read(lines, first + 1, sides, degree))
}

fn read<'a>(
    mut lines: impl Iterator<Item = (usize, &'a str)>,
    first: usize,
    sides: usize,
    degree: usize,
) -> Result<RibbonHole, RibbonFileError> {
    if !(3..=MOST[0]).contains(&sides) || !(2..=MOST[1]).contains(&degree) {
        let reason = format!("a patch has 3 to {} sides and degree 2 to {}", MOST[0], MOST[1]);
        return Err(RibbonFileError::Line { line: first, reason });
    }
    // Points in their order: the middle, then ⌈d/2⌉ rows, each a point shorter at both ends than the one before.
    let rows = degree.div_ceil(2);
    let count = 1 + sides * (1 + degree / 2) * rows;
    let (mut points, mut last) = (Vec::with_capacity(count), first);
    for (at, line) in lines.by_ref() {
        last = at + 1;
        if points.len() == count {
            let reason =
                format!("nothing was expected after the {count} points of {sides} sides of degree {degree}");
            return Err(RibbonFileError::Line { line: last, reason });
        }
        points.push(point(line).ok_or_else(|| RibbonFileError::Line {
            line: last,
            reason: "here three numbers were expected, with blanks between".to_owned(),
        })?);
    }
    if points.len() < count {
        let reason = format!(
            "the file ends after {} of the {count} points of {sides} sides of degree {degree}",
            points.len()
        );
        return Err(RibbonFileError::Line { line: last, reason });
    }
    let (middle, points) = (points[0], &points[1..]);
    let row0 =
        |side: usize, column: usize| points[(side + column / degree) % sides * degree + column % degree];
    // The twist point at the beginning of a side is the first of its row 1.
    let inner = degree.saturating_sub(2);
    let row1 = |side: usize, column: usize| match column {
        _ if inner == 0 => middle,
        _ if column == degree - 1 => points[sides * degree + (side + 1) % sides * inner],
        _ => points[sides * degree + side * inner + column - 1],
    };
    let ribbon = |side: usize| {
        let (before, after) = (row0((side + sides - 1) % sides, degree - 1), row0((side + 1) % sides, 1));
        let within = (1..degree).map(|column| row1(side, column));
        FillRibbon {
            row0: (0..=degree).map(|column| row0(side, column)).collect(),
            row1: core::iter::once(before).chain(within).chain([after]).collect(),
        }
    };
    let ribbons = (0..sides).map(ribbon).collect();
    Ok(RibbonHole { ribbons, interior: FillInterior::Biharmonic, join: FillJoin::Tangent })
}

fn point(line: &str) -> Option<DVec3> {
    let numbers: Vec<f64> =
        line.split_whitespace().map(|word| word.parse().ok()).collect::<Option<Vec<_>>>()?;
    let [x, y, z] = numbers[..] else { return None };
    Some(DVec3::new(x, y, z)).filter(|at| at.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ribbon_file::ribbon_holes;
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    /// A file whose points tell their own row, side and column.
    fn file(sides: usize, degree: usize) -> String {
        let mut text = format!("{sides} {degree}\n-1 -1 -1\n");
        for row in 0..degree.div_ceil(2) {
            for side in 0..sides {
                for column in row..degree - row {
                    text.push_str(&format!("{row} {side} {column}\n"));
                }
            }
        }
        text
    }

    fn told(at: DVec3) -> (usize, usize, usize) {
        let [row, side, column] = at.to_array().map(|x| format!("{x}").parse().unwrap());
        (row, side, column)
    }

    #[test]
    fn ribbons_of_every_degree_get_their_points_and_fit() {
        for (sides, degree) in [(3, 3), (4, 4), (5, 5), (6, 7), (5, 6)] {
            let hole = ribbon_holes(&file(sides, degree)).unwrap().unwrap().remove(0);
            assert_eq!((hole.ribbons.len(), hole.join), (sides, FillJoin::Tangent));
            for (side, ribbon) in hole.ribbons.iter().enumerate() {
                let (before, after) = ((side + sides - 1) % sides, (side + 1) % sides);
                assert_eq!((ribbon.row0.len(), ribbon.row1.len()), (degree + 1, degree + 1));
                assert!((0..degree).all(|column| told(ribbon.row0[column]) == (0, side, column)));
                assert_eq!(told(ribbon.row0[degree]), (0, after, 0));
                assert_eq!(told(ribbon.row1[0]), (0, before, degree - 1));
                assert!((1..degree - 1).all(|column| told(ribbon.row1[column]) == (1, side, column)));
                assert_eq!(told(ribbon.row1[degree - 1]), (1, after, 1));
                assert_eq!(told(ribbon.row1[degree]), (0, after, 1));
            }
        }
        let hole = ribbon_holes(&file(4, 2)).unwrap().unwrap().remove(0);
        assert!(hole.ribbons.iter().all(|ribbon| ribbon.row1[1] == -DVec3::ONE && ribbon.row1.len() == 3));
    }

    #[test]
    fn what_is_wrong_is_told_by_its_line() {
        let good = file(5, 3);
        let refused = |text: &str| ribbon_holes(text).unwrap().unwrap_err().to_string();
        let lines: Vec<&str> = good.lines().collect();
        let replaced = |line: usize, by: &str| {
            let mut lines = lines.clone();
            lines[line - 1] = by;
            lines.join("\n")
        };
        for (text, wanted) in [
            (replaced(4, "1 2"), "line 4: here three numbers"),
            (replaced(7, "1 2 x"), "line 7: here three numbers"),
            (replaced(7, "1 2 NaN"), "line 7: here three numbers"),
            (replaced(9, "1 2 1e999"), "line 9: here three numbers"),
            (replaced(1, "2 3"), "line 1: a patch has 3 to 64 sides"),
            (replaced(1, "5 1"), "line 1: a patch has 3 to 64 sides"),
            (replaced(1, "5 99999999999"), "line 1: a patch has 3 to 64 sides"),
            (format!("{good}\n1 2 3\n"), "line 24: nothing was expected after the 21 points"),
            (lines[..20].join("\n"), "line 20: the file ends after 19 of the 21 points"),
        ] {
            let reason = refused(&text);
            assert!(reason.contains(wanted), "{reason}");
        }
        for other in ["solid x\n", "5\n1 2 3\n", "5 5 5\n", "5.0 3\n1 2 3\n"] {
            assert_eq!(ribbon_holes(other), None, "{other}");
        }
    }
}
