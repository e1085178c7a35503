//! Which keys mean what. Every key has one meaning everywhere in the page, named by the key that has it as delivered; a designer may
//! give the meaning to another key, and then the first key means nothing.
//!
//! Keys are written as in `ctrl+shift+z`: what is held, in this order, and the key's name in small letters.

use std::collections::BTreeMap;

/// What can be moved to other keys, with what a refusal calls it.
const MEANINGS: [(&str, &str); 48] = [
    ("v", "Shape"),
    ("p", "Point"),
    ("c", "Curve"),
    ("d", "Draw"),
    ("s", "Sheet"),
    ("w", "Sweep"),
    ("i", "Embed"),
    ("b", "Burn out"),
    ("k", "Crease"),
    ("x", "Split, and the x axis"),
    ("y", "the y axis"),
    ("z", "the z axis"),
    ("g", "Glue"),
    ("m", "Merge"),
    ("t", "Trim"),
    ("r", "Ribbon, and the other way round"),
    ("f", "Fill"),
    ("q", "Cage"),
    ("e", "Displace, and Extrude"),
    ("l", "Shadow"),
    ("[", "a narrower range"),
    ("]", "a wider range"),
    ("ctrl+z", "Undo"),
    ("ctrl+shift+z", "Redo"),
    ("ctrl+y", "Redo"),
    ("ctrl+s", "Save"),
    ("ctrl+o", "Open"),
    ("ctrl+shift+c", "Copy the link"),
    ("delete", "Delete"),
    ("alt+1", "Shaded"),
    ("alt+4", "Isophotes"),
    ("alt+6", "Contours"),
    ("alt+7", "Mean curvature"),
    ("1", "the front view"),
    ("3", "the view from the right"),
    ("7", "the view from above"),
    ("5", "Perspective or orthographic"),
    (".", "Focus"),
    ("home", "Fit all"),
    ("0", "the stored view"),
    ("?", "this list"),
    ("\\", "Hide everything but the model"),
    ("h", "Hide everything but the model"),
    // What people lean on without a pointer stays where they know it.
    ("escape", ""),
    ("enter", ""),
    ("tab", ""),
    (" ", ""),
    ("backspace", ""),
];

/// A key with what is held beside it.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Chord {
    /// Ctrl, or the command key of a Mac.
    pub ctrl: bool,
    /// Shift, where it makes a difference: beside Ctrl.
    pub shift: bool,
    /// Alt.
    pub alt: bool,
    /// The key's name in small letters.
    pub name: String,
}

impl Chord {
    /// Reads what [`Self::text`] writes.
    #[must_use]
    pub fn of(text: &str) -> Self {
        let mut chord = Self::default();
        let mut rest = text;
        for (held, is_held) in
            [("ctrl+", &mut chord.ctrl), ("shift+", &mut chord.shift), ("alt+", &mut chord.alt)]
        {
            if let Some(name) = rest.strip_prefix(held).filter(|name| !name.is_empty()) {
                (*is_held, rest) = (true, name);
            }
        }
        chord.name = rest.to_owned();
        chord
    }

    /// It in one word.
    #[must_use]
    pub fn text(&self) -> String {
        let held = [(self.ctrl, "ctrl+"), (self.shift, "shift+"), (self.alt, "alt+")];
        let held: String = held.into_iter().filter(|(is_held, _)| *is_held).map(|(_, word)| word).collect();
        held + &self.name
    }
}

/// The keys that were changed: which key has the meaning of which.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Keys(BTreeMap<String, String>);

impl Keys {
    /// Reads what [`Self::text`] writes; what makes no sense is left out.
    #[must_use]
    pub fn of(text: &str) -> Self {
        let mut keys = Self::default();
        for (meaning, key) in text.split(' ').filter_map(|word| word.split_once('=')) {
            // In any order: two may have changed places.
            if can_change(meaning) && !is_fixed(key) && !key.is_empty() {
                keys.0.insert(meaning.to_owned(), key.to_owned());
            }
        }
        let is_sound = keys.0.keys().all(|meaning| keys.holder(&keys.key_of(meaning), meaning).is_none());
        if is_sound { keys } else { Self::default() }
    }

    /// All changes in one line.
    #[must_use]
    pub fn text(&self) -> String {
        let words: Vec<String> = self.0.iter().map(|(meaning, key)| format!("{meaning}={key}")).collect();
        words.join(" ")
    }

    /// What a key means: itself, another one, or nothing.
    #[must_use]
    pub fn meaning(&self, key: &str) -> Option<String> {
        if let Some((meaning, _)) = self.0.iter().find(|(_, own)| *own == key) {
            return Some(meaning.clone());
        }
        (!self.0.contains_key(key)).then(|| key.to_owned())
    }

    /// The key that has a meaning now.
    #[must_use]
    pub fn key_of(&self, meaning: &str) -> String {
        if let Some(key) = self.0.get(meaning) {
            return key.clone();
        }
        // A view from the other side goes where the view goes.
        match meaning.strip_prefix("shift+") {
            Some(rest) if !rest.is_empty() => format!("shift+{}", self.key_of(rest)),
            _ => meaning.to_owned(),
        }
    }

    /// Gives a meaning to another key.
    ///
    /// # Errors
    /// Why that key cannot have it.
    pub fn change(&mut self, meaning: &str, key: &str) -> Result<(), String> {
        let shown = shown(key);
        if is_fixed(key) || key.starts_with("arrow") {
            return Err(format!("{shown} cannot be given away: it is needed everywhere. Press another key."));
        }
        if let Some(label) = self.holder(key, meaning) {
            return Err(format!(
                "{shown} is already the key of {label}. Press another, or change that one first."
            ));
        }
        if key == meaning {
            self.0.remove(meaning);
        } else {
            self.0.insert(meaning.to_owned(), key.to_owned());
        }
        Ok(())
    }

    /// What another meaning is called that a key has.
    fn holder(&self, key: &str, but: &str) -> Option<&'static str> {
        MEANINGS
            .into_iter()
            .find(|(meaning, _)| *meaning != but && self.key_of(meaning) == key)
            .map(|(_, label)| label)
    }
}

fn is_fixed(key: &str) -> bool {
    MEANINGS.iter().any(|(meaning, label)| *meaning == key && label.is_empty())
}

/// Whether a key's meaning can be given to another key.
#[must_use]
pub fn can_change(key: &str) -> bool {
    MEANINGS.iter().any(|(meaning, label)| *meaning == key && !label.is_empty())
}

/// A key as the page shows it: `Ctrl ⇧ Z`.
#[must_use]
pub fn shown(key: &str) -> String {
    let chord = Chord::of(key);
    let name = match chord.name.as_str() {
        "delete" => "Del".to_owned(),
        "escape" => "Esc".to_owned(),
        "backspace" => "⌫".to_owned(),
        " " => "Space".to_owned(),
        name => {
            let mut letters = name.chars();
            letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
        }
    };
    let held = [(chord.ctrl, "Ctrl"), (chord.shift, "⇧"), (chord.alt, "Alt"), (true, name.as_str())];
    let words: Vec<&str> = held.into_iter().filter(|(is_held, _)| *is_held).map(|(_, word)| word).collect();
    words.join(" ")
}

/// The key that the page shows so.
#[must_use]
pub fn read(text: &str) -> String {
    let word = |word: &str| match word {
        "⇧" => "shift".to_owned(),
        "⌫" => "backspace".to_owned(),
        "Del" => "delete".to_owned(),
        "Esc" => "escape".to_owned(),
        "Space" => " ".to_owned(),
        word => word.to_lowercase(),
    };
    text.split(' ').map(word).collect::<Vec<_>>().join("+")
}

#[cfg(test)]
mod tests {
    use super::*;
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    #[test]
    fn what_is_shown_is_what_is_read() {
        for (key, _) in MEANINGS {
            assert_eq!(read(&shown(key)), key);
            assert_eq!(Chord::of(key).text(), key);
        }
        assert_eq!(shown("ctrl+shift+z"), "Ctrl ⇧ Z");
        assert_eq!(Chord::of("ctrl++"), Chord { ctrl: true, name: "+".to_owned(), ..Chord::default() });
    }

    #[test]
    fn a_meaning_moves_to_another_key_and_leaves_the_first_without_any() {
        let mut keys = Keys::default();
        assert_eq!(keys.meaning("w"), Some("w".to_owned()));
        assert_eq!(keys.change("w", "n"), Ok(()));
        assert_eq!((keys.meaning("n"), keys.meaning("w")), (Some("w".to_owned()), None));
        assert_eq!((keys.key_of("w"), keys.key_of("v")), ("n".to_owned(), "v".to_owned()));
        assert_eq!(keys.change("v", "w"), Ok(()), "a key that is free now");
        assert_eq!(keys.meaning("w"), Some("v".to_owned()));
        assert_eq!(Keys::of(&keys.text()), keys);
        assert_eq!(keys.change("7", "8"), Ok(()));
        assert_eq!(keys.key_of("shift+7"), "shift+8");
        assert_eq!(
            keys.change("w", "w").unwrap_err(),
            "W is already the key of Shape. Press another, or change that one first."
        );
        assert_eq!(
            (keys.change("v", "v"), keys.change("w", "w"), keys.change("7", "7")),
            (Ok(()), Ok(()), Ok(()))
        );
        assert_eq!(keys, Keys::default(), "all as it was");
    }

    #[test]
    fn a_key_that_is_taken_or_needed_is_refused_by_name() {
        let mut keys = Keys::default();
        for (key, why) in
            [("s", "S is already the key of Sheet"), ("ctrl+z", "Ctrl Z is already the key of Undo")]
        {
            assert!(keys.change("w", key).unwrap_err().starts_with(why));
        }
        for key in ["escape", "enter", "tab", " ", "backspace", "arrowleft"] {
            assert!(keys.change("w", key).unwrap_err().contains("needed everywhere"), "{key}");
        }
        assert_eq!(keys, Keys::default(), "nothing was changed");
        for text in ["w=s", "w=n v=n", "w=escape", "nothing=n", "w", "=", "w="] {
            assert_eq!(Keys::of(text), Keys::default(), "{text}");
        }
        assert_eq!(Keys::of("v=w w=v").meaning("v"), Some("w".to_owned()), "two may change places");
    }
}
