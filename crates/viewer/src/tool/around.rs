//! How far around a displacement reaches, as fields show it and take it: its range, how many times as far it reaches along a
//! direction as across, and that direction.

use crate::number;
use ductile_spec::{Displacement, LEAST_RANGE, MOST_RANGE, Stretch};
use glam::DVec3;

/// Most times as far along as across; the least is its inverse.
const MOST_TIMES: f64 = 64.0;

/// How far around.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Around {
    /// As a displacement says it.
    pub range: f64,
    /// How many times as far along as across: 1 is all round.
    times: f64,
    /// The direction. It is kept while it does not matter.
    along: DVec3,
}

impl Default for Around {
    fn default() -> Self {
        Self { range: 0.0, times: 1.0, along: DVec3::X }
    }
}

impl Around {
    /// How far a displacement reaches; one that reaches as far all round gets the direction of `self`.
    #[must_use]
    pub fn of(self, item: &Displacement) -> Self {
        let Stretch { along, times } = item.direction.unwrap_or(Stretch { along: self.along, times: 1.0 });
        Self { range: item.range, times, along }
    }

    /// The direction, if it reaches further there.
    #[must_use]
    pub fn direction(self) -> Option<Stretch> {
        (self.times != 1.0).then_some(Stretch { along: self.along, times: self.times })
    }

    /// What a field shows: 0 is the range, 1 how many times as far, 2 to 4 the direction.
    #[must_use]
    pub fn text(self, field: usize) -> String {
        number::show(self.value(field))
    }

    fn value(self, field: usize) -> f64 {
        match field {
            0 => self.range,
            1 => self.times,
            _ => self.along[(field - 2).min(2)],
        }
    }

    /// What it becomes by what was typed into a field; itself if that is what the field shows.
    ///
    /// # Errors
    /// What is wrong with it, for the designer.
    pub fn typed(self, field: usize, text: &str) -> Result<Self, String> {
        let value = match text.trim() {
            "" if field == 1 => 1.0,
            text => number::parse(text).map_err(|error| error.to_string())?,
        };
        if number::show(value) == self.text(field) {
            return Ok(self);
        }
        let mut to = self;
        match field {
            0 if (LEAST_RANGE..=MOST_RANGE).contains(&value) => to.range = value,
            0 => return Err(format!("A range lies between {LEAST_RANGE} and {MOST_RANGE}.")),
            1 if (1.0 / MOST_TIMES..=MOST_TIMES).contains(&value) => to.times = value,
            1 => return Err(format!("This lies between 1/{MOST_TIMES} and {MOST_TIMES}; 1 is all round.")),
            _ => to.along[(field - 2).min(2)] = value,
        }
        if to.along == DVec3::ZERO {
            return Err("A direction has a length: type another number first.".to_owned());
        }
        Ok(to)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    #[test]
    fn what_is_typed_is_what_is_shown_and_said() {
        let plain = Around::default();
        assert_eq!([0, 1, 2, 3, 4].map(|field| plain.text(field)), ["0", "1", "1", "0", "0"]);
        assert_eq!(plain.direction(), None);
        let far = plain.typed(1, "3").unwrap().typed(3, "1/2").unwrap().typed(2, "0").unwrap();
        assert_eq!(far.direction(), Some(Stretch { along: 0.5 * DVec3::Y, times: 3.0 }));
        assert_eq!(far.typed(0, "0.2").unwrap().range, 0.2);
        assert_eq!(far.typed(1, " ").unwrap().direction(), None, "an empty field is all round");
        let exact = Around { range: 0.123_456, ..plain };
        assert_eq!(exact.typed(0, "0.1235"), Ok(exact), "what the field shows changes nothing");
    }

    #[test]
    fn what_makes_no_sense_is_refused_in_words() {
        let plain = Around::default();
        for (field, text, says) in [
            (0, "1", "between -20 and 0.99"),
            (1, "65", "between 1/64 and 64"),
            (1, "0", "between 1/64 and 64"),
            (2, "0", "has a length"),
            (4, "north", "not a number"),
        ] {
            let why = plain.typed(field, text).unwrap_err();
            assert!(why.contains(says), "{field} {text}: {why}");
        }
    }

    #[test]
    fn a_displacement_says_how_far_it_reaches_and_else_the_direction_is_kept() {
        let own = Around::default().typed(3, "2").unwrap();
        let mut item = Displacement::new(DVec3::ZERO, DVec3::Z);
        item.range = -1.0;
        assert_eq!(own.of(&item), Around { range: -1.0, ..own });
        item.direction = Some(Stretch { along: DVec3::Z, times: 0.5 });
        assert_eq!(own.of(&item).direction(), item.direction);
    }
}
