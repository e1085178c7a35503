//! What a verification found: for each quantity the worst deviation beside its tolerance, and what was passed over.

use std::collections::BTreeMap;
use std::fmt::{self, Write};

/// How far a recomputed number may be from the recorded one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Tolerance {
    /// A share of the recorded number.
    pub(crate) relative: f64,
    /// What rounding of the recorded number alone explains.
    pub(crate) absolute: f64,
}

impl Tolerance {
    pub(crate) const EXACT: Self = Self { relative: 0.0, absolute: 0.0 };

    pub(crate) const fn absolute(absolute: f64) -> Self {
        Self { relative: 0.0, absolute }
    }

    fn around(self, recorded: f64) -> f64 {
        self.relative * recorded.abs() + self.absolute
    }
}

/// The comparisons of one quantity.
#[derive(Debug)]
struct Row {
    quantity: String,
    compared: usize,
    /// The comparison that came closest to failing, or failed worst.
    deviation: f64,
    allowed: f64,
    place: String,
}

impl Row {
    fn holds(&self) -> bool {
        self.deviation <= self.allowed
    }
}

/// Everything found in one file.
#[derive(Debug, Default)]
pub(crate) struct Report {
    rows: Vec<Row>,
    /// The row of each quantity.
    row_of: BTreeMap<String, usize>,
    passed_over: Vec<(String, String)>,
}

/// How much of its tolerance a deviation takes; above 1 it fails. Not a number is the worst.
fn share(deviation: f64, allowed: f64) -> f64 {
    if deviation <= allowed && allowed > 0.0 {
        deviation / allowed
    } else if deviation == 0.0 {
        0.0
    } else if deviation.is_nan() || allowed.is_nan() {
        f64::INFINITY
    } else {
        (deviation / allowed).max(1.0 + f64::EPSILON)
    }
}

impl Report {
    /// Compares one number; `place` is where the recorded one stands.
    pub(crate) fn compare(&mut self, quantity: &str, place: &str, recorded: f64, found: f64, by: Tolerance) {
        self.judge(quantity, place, (recorded - found).abs(), by.around(recorded));
    }

    /// The same for a deviation that the caller worked out.
    pub(crate) fn judge(&mut self, quantity: &str, place: &str, deviation: f64, allowed: f64) {
        let new = Row { quantity: quantity.into(), compared: 1, deviation, allowed, place: place.into() };
        let Some(&at) = self.row_of.get(quantity) else {
            self.row_of.insert(quantity.to_owned(), self.rows.len());
            return self.rows.push(new);
        };
        let row = &mut self.rows[at];
        let compared = row.compared + 1;
        if share(deviation, allowed) > share(row.deviation, row.allowed) {
            *row = new;
        }
        row.compared = compared;
    }

    /// Notes a quantity of the file that was not checked.
    pub(crate) fn pass_over(&mut self, place: &str, reason: &str) {
        self.passed_over.push((place.to_owned(), reason.to_owned()));
    }

    #[cfg(test)]
    pub(crate) fn passed_over(&self) -> impl Iterator<Item = (&str, &str)> {
        self.passed_over.iter().map(|(place, reason)| (place.as_str(), reason.as_str()))
    }

    /// Whether something was compared, everything was, and all of it within its tolerance.
    pub(crate) fn holds(&self) -> bool {
        !self.rows.is_empty() && self.passed_over.is_empty() && self.rows.iter().all(Row::holds)
    }

    fn verdict(&self) -> String {
        let failed = self.rows.iter().filter(|row| !row.holds()).count();
        let mut words = Vec::new();
        if self.rows.is_empty() {
            words.push("nothing was compared".to_owned());
        }
        if failed > 0 {
            words.push(format!("{failed} of {} quantities beyond their tolerance", self.rows.len()));
        }
        if !self.passed_over.is_empty() {
            words.push(format!("{} not checked", self.passed_over.len()));
        }
        if words.is_empty() {
            format!("verified: {} quantities within their tolerance", self.rows.len())
        } else {
            format!("NOT verified: {}", words.join(", "))
        }
    }
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let width = self.rows.iter().map(|row| row.quantity.len()).max().unwrap_or(0).max("quantity".len());
        if !self.rows.is_empty() {
            writeln!(
                f,
                "  {:width$}  {:>8}  {:>9}  {:>9}  worst at",
                "quantity", "compared", "deviation", "tolerance"
            )?;
        }
        for row in &self.rows {
            let mut line = format!(
                "  {:width$}  {:>8}  {:>9.2e}  {:>9.2e}  {}",
                row.quantity, row.compared, row.deviation, row.allowed, row.place
            );
            if !row.holds() {
                write!(line, "  EXCEEDED")?;
            }
            writeln!(f, "{line}")?;
        }
        for (place, reason) in &self.passed_over {
            writeln!(f, "  not checked: {place}: {reason}")?;
        }
        writeln!(f, "  {}", self.verdict())
    }
}

#[cfg(test)]
mod tests {
    use super::{Report, Tolerance};

    const CENT: Tolerance = Tolerance::absolute(0.01);

    #[test]
    fn the_worst_comparison_stands_for_its_quantity() {
        let mut report = Report::default();
        report.compare("energy", "a", 1.0, 1.001, CENT);
        report.compare("energy", "b", 1.0, 1.008, CENT);
        report.compare("energy", "c", 1.0, 1.002, CENT);
        assert!(report.holds());
        let text = report.to_string();
        assert!(text.contains("8.00e-3") && text.contains("  b\n") && text.contains(" 3 "), "{text}");
        report.compare("energy", "d", 1.0, 1.02, CENT);
        assert!(!report.holds());
        assert!(report.to_string().contains("d  EXCEEDED"), "{report}");
    }

    #[test]
    fn what_is_not_a_number_never_holds() {
        for found in [f64::NAN, f64::INFINITY] {
            let mut report = Report::default();
            report.compare("energy", "a", 1.0, 5.0, CENT);
            report.compare("energy", "b", 1.0, found, CENT);
            report.compare("energy", "c", 1.0, 1.0, CENT);
            assert!(!report.holds());
            assert!(report.to_string().contains("b  EXCEEDED"), "{report}");
        }
        let mut report = Report::default();
        report.compare("energy", "a", 1.0, 1.0, Tolerance::absolute(f64::NAN));
        assert!(!report.holds());
    }

    #[test]
    fn nothing_compared_or_something_passed_over_is_no_verification() {
        let mut report = Report::default();
        assert!(!report.holds());
        report.compare("energy", "a", 1.0, 1.0, Tolerance::EXACT);
        assert!(report.holds());
        report.pass_over("b", "no rule for this field");
        assert!(!report.holds());
        assert!(report.to_string().contains("not checked: b"), "{report}");
    }
}
