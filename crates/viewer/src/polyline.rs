//! The segments of a drawn curve: each pulls its two ends and the samples before and after them.

use crate::uniforms::Segment;

/// Appends the segments of a polyline whose samples lie one after the other, three floats each.
pub(crate) fn append_polyline(segments: &mut Vec<Segment>, first: u32, count: u32, closed: bool, style: u32) {
    if count < 2 {
        return;
    }
    let last = count - 1;
    // With two samples there is nothing to close.
    let closed = closed && count > 2;
    let at = |i: u32| first + 3 * (i % count);
    for i in 0..if closed { count } else { last } {
        segments.push(Segment {
            before: if i > 0 {
                at(i - 1)
            } else if closed {
                at(last)
            } else {
                at(i)
            },
            start: at(i),
            stop: at(i + 1),
            after: if i + 1 < last || closed { at(i + 2) } else { at(i + 1) },
            style,
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    fn polyline(count: u32, closed: bool) -> Vec<[u32; 4]> {
        let mut segments = Vec::new();
        append_polyline(&mut segments, 30, count, closed, 7);
        segments.iter().map(|s| [s.before, s.start, s.stop, s.after]).collect()
    }

    #[test]
    fn open_ends_repeat_themselves() {
        assert_eq!(polyline(3, false), [[30, 30, 33, 36], [30, 33, 36, 36]]);
        assert_eq!(polyline(2, false), [[30, 30, 33, 33]]);
        assert_eq!(polyline(2, true), [[30, 30, 33, 33]]);
        assert_eq!(polyline(1, true), [[0; 4]; 0]);
        assert_eq!(polyline(0, false), [[0; 4]; 0]);
    }

    #[test]
    fn closed_curves_go_round() {
        assert_eq!(polyline(3, true), [[36, 30, 33, 36], [30, 33, 36, 30], [33, 36, 30, 33]]);
    }
}
