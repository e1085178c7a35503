//! How often something may be tried again before the page stops and says so.

use std::collections::VecDeque;

/// At most so many times within so many milliseconds.
#[derive(Clone, Debug)]
pub struct Limit {
    most: usize,
    within: f64,
    times: VecDeque<f64>,
}

impl Limit {
    /// At most `most` times within `within` milliseconds.
    #[must_use]
    pub fn new(most: usize, within: f64) -> Self {
        Self { most, within, times: VecDeque::new() }
    }

    /// Whether it may be tried at this time; if so, it counts.
    pub fn allows(&mut self, now: f64) -> bool {
        self.times.retain(|time| now - time < self.within);
        if self.times.len() >= self.most {
            return false;
        }
        self.times.push_back(now);
        true
    }

    /// Begins anew: the designer asked for it.
    pub fn reset(&mut self) {
        self.times.clear();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    #[test]
    fn three_times_a_minute_and_no_more() {
        let mut limit = Limit::new(3, 60_000.0);
        assert!([0.0, 30_000.0, 59_000.0].into_iter().all(|now| limit.allows(now)));
        assert!(!limit.allows(59_500.0));
        assert!(limit.allows(60_500.0), "the first one has been forgotten");
        assert!(!limit.allows(60_501.0));
        limit.reset();
        assert!(limit.allows(60_502.0));
    }
}
