//! What may be typed into a number field: a number, or simple arithmetic such as `3*4.5` or `(1+2)/8`.
//!
//! A decimal comma is understood; there are no units, because lengths of a document have none.

use thiserror::Error;

/// Deepest nesting of brackets: the parser calls itself.
const DEEPEST: usize = 32;

/// Why a text is no number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum NumberError {
    /// Nothing was typed.
    #[error("Type a number.")]
    Empty,
    /// Something else stands there.
    #[error("This is not a number. Sums such as 3*4.5 are understood.")]
    Form,
    /// The result is infinite or no number, as after a division by zero.
    #[error("This has no finite result.")]
    NotFinite,
}

/// The value of what was typed.
///
/// # Errors
/// [`NumberError`] says what is wrong with it.
pub fn parse(text: &str) -> Result<f64, NumberError> {
    let text: String =
        text.chars().filter(|c| !c.is_whitespace()).map(|c| if c == ',' { '.' } else { c }).collect();
    let text = text.replace('\u{2212}', "-").replace('\u{d7}', "*");
    if text.is_empty() {
        return Err(NumberError::Empty);
    }
    let mut parser = Parser { rest: &text, depth: 0 };
    let value = parser.sum()?;
    if !parser.rest.is_empty() {
        return Err(NumberError::Form);
    }
    if value.is_finite() { Ok(value) } else { Err(NumberError::NotFinite) }
}

/// A coordinate as a field shows it: short, but enough to tell places apart.
#[must_use]
pub fn show(value: f64) -> String {
    let text = format!("{value:.4}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

struct Parser<'a> {
    rest: &'a str,
    depth: usize,
}

impl Parser<'_> {
    fn takes(&mut self, sign: char) -> bool {
        let after = self.rest.strip_prefix(sign);
        self.rest = after.unwrap_or(self.rest);
        after.is_some()
    }

    fn sum(&mut self) -> Result<f64, NumberError> {
        let mut value = self.product()?;
        loop {
            if self.takes('+') {
                value += self.product()?;
            } else if self.takes('-') {
                value -= self.product()?;
            } else {
                return Ok(value);
            }
        }
    }

    fn product(&mut self) -> Result<f64, NumberError> {
        let mut value = self.factor()?;
        loop {
            if self.takes('*') {
                value *= self.factor()?;
            } else if self.takes('/') {
                value /= self.factor()?;
            } else {
                return Ok(value);
            }
        }
    }

    fn factor(&mut self) -> Result<f64, NumberError> {
        self.depth += 1;
        if self.depth > DEEPEST {
            return Err(NumberError::Form);
        }
        let value = if self.takes('-') {
            self.factor().map(|value| -value)
        } else if self.takes('+') {
            self.factor()
        } else if self.takes('(') {
            let value = self.sum()?;
            if self.takes(')') { Ok(value) } else { Err(NumberError::Form) }
        } else {
            self.number()
        };
        self.depth -= 1;
        value
    }

    fn number(&mut self) -> Result<f64, NumberError> {
        let digits = |text: &str| text.bytes().take_while(|b| b.is_ascii_digit() || *b == b'.').count();
        let mut length = digits(self.rest);
        let tail = &self.rest[length..];
        if length > 0 && tail.starts_with(['e', 'E']) {
            let sign = usize::from(tail[1..].starts_with(['+', '-']));
            let exponent = tail[1 + sign..].bytes().take_while(u8::is_ascii_digit).count();
            length += if exponent > 0 { 1 + sign + exponent } else { 0 };
        }
        let (number, rest) = self.rest.split_at(length);
        self.rest = rest;
        number.parse().map_err(|_| NumberError::Form)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    #[test]
    fn arithmetic_keeps_its_precedence() {
        for (text, value) in [
            ("3", 3.0),
            ("-0.5", -0.5),
            (" 3 * 4.5 ", 13.5),
            ("1+2*3-4/8", 6.5),
            ("(1+2)*-3", -9.0),
            ("1,5", 1.5),
            ("1e-3*2E2", 0.2),
            ("\u{2212}2\u{d7}2", -4.0),
            ("--2", 2.0),
        ] {
            assert_eq!(parse(text), Ok(value), "{text}");
        }
    }

    #[test]
    fn what_is_no_number_is_refused() {
        assert_eq!(parse("  "), Err(NumberError::Empty));
        for text in ["x", "1+", "(1", "1)", "1 2 3x", "..", "e5", "nan", "inf", "1.2.3"] {
            assert_eq!(parse(text), Err(NumberError::Form), "{text}");
        }
        assert_eq!(parse("1/0"), Err(NumberError::NotFinite));
        assert_eq!(parse("1e999"), Err(NumberError::NotFinite));
        assert_eq!(parse(&"(".repeat(100_000)), Err(NumberError::Form));
        assert_eq!(parse(&"-".repeat(100_000)), Err(NumberError::Form));
    }

    #[test]
    fn numbers_are_shown_short() {
        assert_eq!(show(1.0), "1");
        assert_eq!(show(-0.000_01), "0");
        assert_eq!(show(0.123_46), "0.1235");
        assert_eq!(show(1200.0), "1200");
    }
}
