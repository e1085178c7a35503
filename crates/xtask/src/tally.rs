//! Adding up the closing lines of the test runners.

use std::fmt;
use std::ops::AddAssign;

/// Tests passed and failed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Tally {
    pub(crate) passed: u64,
    pub(crate) failed: u64,
}

impl Tally {
    /// What one line of output adds: the closing lines of cargo's and wasm-bindgen's runner
    /// (`test result: ok. 3 passed; 0 failed; …`) and of node's (`ℹ pass 3`, `# fail 1`).
    pub(crate) fn of_line(line: &str) -> Self {
        let line = line.trim();
        if let Some(result) = line.strip_prefix("test result:") {
            return Self { passed: count_before(result, "passed"), failed: count_before(result, "failed") };
        }
        let words: Vec<&str> = line.split_whitespace().collect();
        match words[..] {
            ["ℹ" | "#", "pass", count] => Self { passed: count.parse().unwrap_or(0), failed: 0 },
            // node counts a test that ran into its time limit apart, as cancelled
            ["ℹ" | "#", "fail" | "cancelled", count] => {
                Self { passed: 0, failed: count.parse().unwrap_or(0) }
            }
            _ => Self::default(),
        }
    }
}

/// The number before that word.
fn count_before(text: &str, word: &str) -> u64 {
    let words: Vec<&str> = text.split([' ', ';', '.']).filter(|part| !part.is_empty()).collect();
    let pair = words.windows(2).find(|pair| pair[1] == word);
    pair.and_then(|pair| pair[0].parse().ok()).unwrap_or(0)
}

impl AddAssign for Tally {
    fn add_assign(&mut self, other: Self) {
        self.passed += other.passed;
        self.failed += other.failed;
    }
}

impl fmt::Display for Tally {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} passed, {} failed", self.passed, self.failed)
    }
}

#[cfg(test)]
mod tests {
    use super::Tally;

    #[test]
    fn cargo_closes_with_a_result_line() {
        let line = "test result: FAILED. 12 passed; 3 failed; 1 ignored; 0 measured; 0 filtered out; finished in 0.05s";
        assert_eq!(Tally::of_line(line), Tally { passed: 12, failed: 3 });
        let line = "test result: ok. 6 passed; 0 failed; 0 ignored; 0 filtered out; finished in 0.41s";
        assert_eq!(Tally::of_line(line), Tally { passed: 6, failed: 0 });
    }

    #[test]
    fn node_closes_with_a_line_for_each_count() {
        let report = "✔ the page loads (812.1ms)\nℹ tests 9\nℹ suites 0\nℹ pass 5\nℹ fail 2\nℹ cancelled 1\nℹ skipped 1";
        let mut tally = Tally::default();
        report.lines().for_each(|line| tally += Tally::of_line(line));
        assert_eq!(tally, Tally { passed: 5, failed: 3 });
        assert_eq!(Tally::of_line("# pass 7"), Tally { passed: 7, failed: 0 });
    }

    #[test]
    fn other_lines_add_nothing() {
        for line in
            ["", "test mesh::flip ... ok", "running 3 tests", "12 passed", "ℹ tests 4", "# pass the salt"]
        {
            assert_eq!(Tally::of_line(line), Tally::default(), "{line}");
        }
    }

    #[test]
    fn the_total_is_plain() {
        assert_eq!(Tally { passed: 41, failed: 1 }.to_string(), "41 passed, 1 failed");
    }
}
