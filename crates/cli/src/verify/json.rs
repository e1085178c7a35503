//! A file of JSON as it stands: with the order of its fields, and refused when a field is given twice.

use serde::de::{Deserialize, Deserializer, Error, MapAccess, SeqAccess, Visitor};
use std::collections::BTreeSet;
use std::fmt;

/// One value.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Json {
    Null,
    Flag(bool),
    Number(f64),
    Text(String),
    List(Vec<Self>),
    Fields(Vec<(String, Self)>),
}

/// What stands in place of a number that is not finite, until its place is known: no file has it.
const NOT_FINITE: &str = "\u{0}not finite";

/// Reads a text. What other programs write for numbers that are not finite (`NaN`, `Infinity`, `1e999`) is no JSON; it is refused with
/// the place that has it.
pub(crate) fn read(text: &str) -> Result<Json, String> {
    serde_json::from_str(text).map_err(|reason| {
        let relaxed = serde_json::from_str(&without_infinities(text)).ok();
        let place = relaxed.as_ref().and_then(|json: &Json| json.place_of_not_finite());
        place.map_or_else(
            || reason.to_string(),
            |place| format!("{}: a finite number is expected", place.trim_start_matches('.')),
        )
    })
}

/// The text with [`NOT_FINITE`] for every word that is a number, but no finite one.
fn without_infinities(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for (at, part) in text.split_inclusive('"').enumerate() {
        // Every second part is a string, but for escaped quotes: then the result is no JSON, and nothing is told.
        if at % 2 == 1 {
            out.push_str(part);
            continue;
        }
        for word in part.split_inclusive(|c: char| !(c.is_ascii_alphanumeric() || "+-.".contains(c))) {
            let bare = word.trim_end_matches(|c: char| !c.is_ascii_alphanumeric());
            if bare.parse::<f64>().is_ok_and(|number| !number.is_finite()) {
                out.push_str("\"\\u0000not finite\"");
                out.push_str(&word[bare.len()..]);
            } else {
                out.push_str(word);
            }
        }
    }
    out
}

impl Json {
    /// Where [`NOT_FINITE`] stands first, as in `ribbons[1].row0[2]`.
    fn place_of_not_finite(&self) -> Option<String> {
        let below = |name: String, value: &Self| value.place_of_not_finite().map(|rest| name + &rest);
        match self {
            Self::Text(text) => (text == NOT_FINITE).then(String::new),
            Self::List(list) => list.iter().enumerate().find_map(|(k, value)| below(format!("[{k}]"), value)),
            Self::Fields(fields) => fields.iter().find_map(|(name, value)| below(format!(".{name}"), value)),
            Self::Null | Self::Flag(_) | Self::Number(_) => None,
        }
    }
}

impl<'de> Deserialize<'de> for Json {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(Reader)
    }
}

struct Reader;

impl<'de> Visitor<'de> for Reader {
    type Value = Json;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a value")
    }

    fn visit_unit<E: Error>(self) -> Result<Json, E> {
        Ok(Json::Null)
    }

    fn visit_bool<E: Error>(self, flag: bool) -> Result<Json, E> {
        Ok(Json::Flag(flag))
    }

    fn visit_f64<E: Error>(self, number: f64) -> Result<Json, E> {
        Ok(Json::Number(number))
    }

    #[expect(clippy::cast_precision_loss, reason = "an index beyond 2^53 is refused where it is used")]
    fn visit_u64<E: Error>(self, number: u64) -> Result<Json, E> {
        Ok(Json::Number(number as f64))
    }

    #[expect(clippy::cast_precision_loss, reason = "as above")]
    fn visit_i64<E: Error>(self, number: i64) -> Result<Json, E> {
        Ok(Json::Number(number as f64))
    }

    fn visit_str<E: Error>(self, text: &str) -> Result<Json, E> {
        Ok(Json::Text(text.to_owned()))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut access: A) -> Result<Json, A::Error> {
        let mut list = Vec::new();
        while let Some(value) = access.next_element()? {
            list.push(value);
        }
        Ok(Json::List(list))
    }

    fn visit_map<A: MapAccess<'de>>(self, mut access: A) -> Result<Json, A::Error> {
        let mut fields = Vec::new();
        let mut known = BTreeSet::new();
        while let Some(name) = access.next_key::<String>()? {
            if !known.insert(name.clone()) {
                return Err(A::Error::custom(format_args!("field `{name}` is given twice")));
            }
            fields.push((name, access.next_value()?));
        }
        Ok(Json::Fields(fields))
    }
}

#[cfg(test)]
mod tests {
    use super::{Json, read};

    #[test]
    fn what_is_written_is_read() {
        let json: Json =
            serde_json::from_str(r#"{"b": [1, -2, 0.5e1], "a": {"c": null, "d": true, "e": "x"}}"#).unwrap();
        let Json::Fields(fields) = json else { panic!("not an object") };
        assert_eq!(fields[0].0, "b");
        assert_eq!(fields[0].1, Json::List([1.0, -2.0, 5.0].map(Json::Number).to_vec()));
    }

    #[test]
    fn what_is_no_json_is_refused_with_its_place() {
        for (text, says) in [
            ("{\"a\": 1,\n \"a\": 2}", "field `a` is given twice at line 2"),
            ("{\"a\": NaN}", "line 1"),
            ("{\"a\": 1e999}", "out of range"),
            ("{\"a\": 1} x", "trailing"),
            ("", "line 1"),
        ] {
            let said = serde_json::from_str::<Json>(text).unwrap_err().to_string();
            assert!(said.contains(says), "{text}: {said}");
        }
    }
    #[test]
    fn a_number_that_is_not_finite_is_refused_with_the_place_that_has_it() {
        for (text, says) in [
            (
                r#"{"ribbons": [{"row0": [[0, 0, 0], [1, NaN, 0]]}]}"#,
                "ribbons[0].row0[1][1]: a finite number",
            ),
            (r#"{"a": "NaN", "b": {"c": -Infinity}}"#, "b.c: a finite number"),
            (r#"[1, 1e999]"#, "[1]: a finite number"),
            (r#"[1, -1e999]"#, "[1]: a finite number"),
            // Nothing else is made better than it is.
            (r#"{"a": nonsense}"#, "line 1"),
            (r#"{"a": "NaN", "a": 1}"#, "field `a` is given twice"),
            (r#"{"a": NaN"#, "line 1"),
            (r#"["\"", NaN]"#, "line 1"),
        ] {
            let said = read(text).unwrap_err();
            assert!(said.contains(says), "{text}: {said}");
        }
        assert_eq!(read(r#"["NaN", "a\"b", 1e308]"#).map(|json| json != Json::Null), Ok(true));
    }
}
