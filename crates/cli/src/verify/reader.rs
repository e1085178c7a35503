//! Reading a file of JSON field by field, so that every flaw has a place and no field is passed over in silence.

use super::json::Json;
use super::report::Report;
use glam::DVec3;
use std::cell::RefCell;
use thiserror::Error;

/// Why a file cannot be read.
#[derive(Debug, Error, PartialEq)]
#[error("{place}: {what}")]
pub(crate) struct Flaw {
    place: String,
    what: String,
}

/// What a file records, or none where that cannot be read: then the report tells what was not checked, and why. Only for results;
/// without an input there is nothing to compute.
pub(crate) fn recorded<T>(read: Result<T, Flaw>, report: &mut Report) -> Option<T> {
    read.map_err(|Flaw { place, what }| report.pass_over(&place, &what)).ok()
}

/// A value and its place in the file, such as `meshes[0].energy`.
#[derive(Clone, Debug)]
pub(crate) struct Item<'a> {
    json: &'a Json,
    pub(crate) place: String,
}

/// An object, with a mark for each field that was read.
#[derive(Debug)]
pub(crate) struct Fields<'a> {
    pub(crate) place: String,
    fields: &'a [(String, Json)],
    is_read: RefCell<Vec<bool>>,
}

/// Coordinates beyond this are nonsense; their squares must stay finite by a wide margin.
const LARGEST_COORDINATE: f64 = 1e50;

impl<'a> Item<'a> {
    pub(crate) fn root(json: &'a Json) -> Self {
        Self { json, place: String::new() }
    }

    /// The flaw that this value is.
    pub(crate) fn flaw(&self, what: impl Into<String>) -> Flaw {
        let place = if self.place.is_empty() { "the file" } else { &self.place };
        Flaw { place: place.to_owned(), what: what.into() }
    }

    pub(crate) fn number(&self) -> Result<f64, Flaw> {
        match *self.json {
            Json::Number(number) if number.is_finite() => Ok(number),
            _ => Err(self.flaw("a finite number is expected")),
        }
    }

    /// A whole number below `limit`; `of_what` is what it counts or names.
    pub(crate) fn index(&self, limit: usize, of_what: &str) -> Result<usize, Flaw> {
        let number = self.number()?;
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "whole and between 0 and 2^32, by the condition before it"
        )]
        let index = (number >= 0.0 && number < f64::from(u32::MAX) && number.fract() == 0.0)
            .then_some(number as usize)
            .ok_or_else(|| self.flaw(format!("{number} is no {of_what}")))?;
        if index < limit {
            Ok(index)
        } else {
            Err(self.flaw(format!("{of_what} {index} does not exist: there are {limit}")))
        }
    }

    pub(crate) fn count(&self) -> Result<usize, Flaw> {
        self.index(usize::MAX, "count")
    }

    pub(crate) fn flag(&self) -> Result<bool, Flaw> {
        match *self.json {
            Json::Flag(flag) => Ok(flag),
            _ => Err(self.flaw("true or false is expected")),
        }
    }

    pub(crate) fn text(&self) -> Result<&'a str, Flaw> {
        match self.json {
            Json::Text(text) => Ok(text),
            _ => Err(self.flaw("a text is expected")),
        }
    }

    pub(crate) fn is_text(&self) -> bool {
        matches!(self.json, Json::Text(_))
    }

    pub(crate) fn is_list(&self) -> bool {
        matches!(self.json, Json::List(_))
    }

    pub(crate) fn list(&self) -> Result<impl ExactSizeIterator<Item = Self> + use<'a>, Flaw> {
        let Json::List(list) = self.json else { return Err(self.flaw("a list is expected")) };
        let place = self.place.clone();
        Ok(list.iter().enumerate().map(move |(at, json)| Item { json, place: format!("{place}[{at}]") }))
    }

    /// A list of as many of one thing as there are of another.
    pub(crate) fn list_of(
        &self,
        count: usize,
        of_what: &str,
        for_what: &str,
    ) -> Result<impl ExactSizeIterator<Item = Self> + use<'a>, Flaw> {
        let list = self.list()?;
        if list.len() == count {
            Ok(list)
        } else {
            Err(self.flaw(format!("{} {of_what} for {count} {for_what}", list.len())))
        }
    }

    /// A list of exactly that many numbers.
    pub(crate) fn numbers<const N: usize>(&self) -> Result<[f64; N], Flaw> {
        let list = self.list()?;
        if list.len() != N {
            return Err(self.flaw(format!("{N} numbers are expected, and there are {}", list.len())));
        }
        let mut numbers = [0.0; N];
        for (number, item) in numbers.iter_mut().zip(list) {
            *number = item.number()?;
        }
        Ok(numbers)
    }

    pub(crate) fn vector(&self) -> Result<DVec3, Flaw> {
        let vector = DVec3::from(self.numbers()?);
        if vector.abs().max_element() <= LARGEST_COORDINATE {
            Ok(vector)
        } else {
            Err(self.flaw(format!("no coordinate may exceed {LARGEST_COORDINATE:e}")))
        }
    }

    pub(crate) fn fields(&self) -> Result<Fields<'a>, Flaw> {
        let Json::Fields(fields) = self.json else { return Err(self.flaw("an object is expected")) };
        let is_read = RefCell::new(vec![false; fields.len()]);
        Ok(Fields { place: self.place.clone(), fields, is_read })
    }

    /// Whether the value says something that could be wrong: anything but prose.
    fn looks_like_a_result(&self) -> bool {
        match self.json {
            Json::Text(text) => text.trim().parse::<f64>().is_ok(),
            _ => true,
        }
    }
}

impl<'a> Fields<'a> {
    /// Whether there is such a field; `list[].name` asks for one in any object of a list.
    pub(crate) fn has(&self, name: &str) -> bool {
        let Some((list, inner)) = name.split_once("[].") else {
            return self.fields.iter().any(|(known, _)| known == name);
        };
        self.fields.iter().filter(|(known, _)| known == list).any(|(_, json)| match json {
            Json::List(items) => items.iter().any(
                |item| matches!(item, Json::Fields(fields) if fields.iter().any(|(known, _)| known == inner)),
            ),
            _ => false,
        })
    }

    pub(crate) fn names(&self) -> impl Iterator<Item = &'a str> {
        self.fields.iter().map(|(name, _)| name.as_str())
    }

    /// The flaw that this object is.
    pub(crate) fn flaw(&self, what: impl Into<String>) -> Flaw {
        let place = if self.place.is_empty() { "the file" } else { &self.place };
        Flaw { place: place.to_owned(), what: what.into() }
    }

    /// All fields with their names, which are all marked as read.
    pub(crate) fn entries(&self) -> impl Iterator<Item = (&'a str, Item<'a>)> {
        self.is_read.borrow_mut().fill(true);
        self.fields.iter().map(|(name, json)| (name.as_str(), Item { json, place: self.at(name) }))
    }

    /// The place of a field.
    pub(crate) fn at(&self, name: &str) -> String {
        if self.place.is_empty() { name.to_owned() } else { format!("{}.{name}", self.place) }
    }

    /// The field, which is marked as read.
    pub(crate) fn get(&self, name: &str) -> Option<Item<'a>> {
        let at = self.fields.iter().position(|(known, _)| known == name)?;
        self.is_read.borrow_mut()[at] = true;
        Some(Item { json: &self.fields[at].1, place: self.at(name) })
    }

    /// The field, without which the file cannot be read.
    pub(crate) fn need(&self, name: &str) -> Result<Item<'a>, Flaw> {
        self.get(name).ok_or_else(|| Flaw { place: self.at(name), what: "this field is missing".into() })
    }

    /// Tells of every field that nobody read, unless it is prose.
    pub(crate) fn finish(self, report: &mut Report) {
        let is_read = self.is_read.borrow();
        for ((name, json), _) in self.fields.iter().zip(is_read.iter()).filter(|(_, is_read)| !**is_read) {
            let item = Item { json, place: self.at(name) };
            if item.looks_like_a_result() {
                report.pass_over(&item.place, "no rule for this field");
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn json(text: &str) -> Json {
        serde_json::from_str(text).unwrap()
    }

    #[test]
    fn flaws_name_their_place() {
        let json = json(r#"{"a": [{"b": [1, 2]}, {"b": null}], "n": 1.5, "big": [1e60, 0, 0]}"#);
        let fields = Item::root(&json).fields().unwrap();
        let inner: Vec<_> = fields.need("a").unwrap().list().unwrap().map(|i| i.fields().unwrap()).collect();
        let said = |flaw: Flaw| flaw.to_string();
        assert!(
            said(inner[0].need("b").unwrap().vector().unwrap_err())
                .starts_with("a[0].b: 3 numbers are expected")
        );
        assert!(said(inner[1].need("b").unwrap().number().unwrap_err()).starts_with("a[1].b: a finite"));
        assert_eq!(said(inner[1].need("c").unwrap_err()), "a[1].c: this field is missing");
        assert!(
            said(fields.need("n").unwrap().index(9, "node").unwrap_err()).starts_with("n: 1.5 is no node")
        );
        assert!(said(fields.need("big").unwrap().vector().unwrap_err()).contains("1e50"));
    }

    #[test]
    fn fields_that_nobody_read_are_told_unless_they_are_prose() {
        let json = json(r#"{"a": 1, "b": 2, "note": "prose", "c": "3.5", "d": null}"#);
        let fields = Item::root(&json).fields().unwrap();
        fields.need("a").unwrap();
        let mut report = Report::default();
        fields.finish(&mut report);
        let places: Vec<_> = report.passed_over().map(|(place, _)| place).collect();
        assert_eq!(places, ["b", "c", "d"]);
    }
}
