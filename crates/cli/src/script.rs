//! What a script says: a JSON list of acts by name, in the words of the page.
//!
//! `[{"curve": {...}}, "rest", {"sheet": {"boundary": 1}}, "undo"]`: an act is an [`Edit`] as it is written everywhere, and
//! three words stand for what is no act of the document: `"rest"`, `"undo"`, `"redo"`.

use ductile_spec::Edit;
use serde_json::Value;
use thiserror::Error;

/// One entry of a script.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Entry {
    /// An act, with its name in the script.
    Act(String, Box<Edit>),
    /// Relax until nothing moves.
    Rest,
    /// Take back the last act.
    Undo,
    /// Do it again.
    Redo,
}

impl Entry {
    /// Its name in a script.
    pub(crate) fn name(&self) -> &str {
        match self {
            Self::Act(name, _) => name,
            Self::Rest => "rest",
            Self::Undo => "undo",
            Self::Redo => "redo",
        }
    }
}

/// Why a text is no script. Acts count from 1.
#[derive(Debug, Error)]
pub(crate) enum ScriptError {
    /// It is not JSON.
    #[error("not JSON: {0}")]
    Json(serde_json::Error),
    /// It is no list.
    #[error("a script is a JSON list of acts, such as [{{\"sheet\": {{\"boundary\": 1}}}}, \"rest\"]")]
    NoList,
    /// An entry is no act.
    #[error("act {number} is none: {reason}")]
    NoAct {
        /// Which entry, from 1.
        number: usize,
        /// What is wrong with it.
        reason: String,
    },
}

/// Reads a script.
pub(crate) fn parse(text: &str) -> Result<Vec<Entry>, ScriptError> {
    let Value::Array(entries) = serde_json::from_str(text).map_err(ScriptError::Json)? else {
        return Err(ScriptError::NoList);
    };
    let read = |(number, value): (usize, Value)| {
        entry(value).map_err(|reason| ScriptError::NoAct { number: number + 1, reason })
    };
    entries.into_iter().enumerate().map(read).collect()
}

fn entry(value: Value) -> Result<Entry, String> {
    match &value {
        Value::String(word) => match word.as_str() {
            "rest" => Ok(Entry::Rest),
            "undo" => Ok(Entry::Undo),
            "redo" => Ok(Entry::Redo),
            other => Err(format!("the words are \"rest\", \"undo\" and \"redo\", not {other:?}")),
        },
        Value::Object(fields) if fields.len() == 1 => {
            let name = fields.keys().next().cloned().unwrap_or_default();
            match serde_json::from_value(value) {
                Ok(edit) => Ok(Entry::Act(name, Box::new(edit))),
                Err(reason) => Err(format!("{name}: {reason}")),
            }
        }
        _ => Err(
            "an act is an object with one field, its name, or one of the words \"rest\", \"undo\", \"redo\""
                .to_owned(),
        ),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn acts_and_words_are_read_in_order() {
        let script = parse(r#"[{"sheet": {"boundary": 4}}, "rest", "undo", "redo"]"#).unwrap();
        let names: Vec<&str> = script.iter().map(Entry::name).collect();
        assert_eq!(names, ["sheet", "rest", "undo", "redo"]);
        let sheet = Edit::Sheet { boundary: ductile_spec::CurveId(4) };
        assert_eq!(script[0], Entry::Act("sheet".to_owned(), Box::new(sheet)));
    }

    #[test]
    fn what_is_no_act_is_named_by_its_number() {
        for (text, says) in [
            ("{}", "a JSON list"),
            ("[", "not JSON"),
            (r#"["rest", "sleep"]"#, "act 2 is none: the words are"),
            (r#"[{"sheet": {"boundary": 1}, "sweep": {}}]"#, "act 1 is none: an act is an object"),
            (r#"[{"sheat": {}}]"#, "act 1 is none: sheat: unknown variant"),
            (r#"[{"sheet": {"bound": 1}}]"#, "unknown field"),
        ] {
            let said = parse(text).unwrap_err().to_string();
            assert!(said.contains(says), "{text}: {said}");
        }
    }
}
