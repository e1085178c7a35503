//! The list of keys: it shows which key means what, and lets the designer give a meaning to another key. Kept for all tabs.

use super::page::{Page, act};
use super::{dom, settings};
use crate::keys::{Chord, Keys, can_change, read, shown};
use wasm_bindgen::JsCast;
use web_sys::Element;

const KEPT: &str = "ductile.keys";
const WHAT_TO_DO: &str = "Keys can be changed: click one here, then press the key that is to mean the same. Esc leaves it as it is.";

/// The keys as the designer has them.
#[derive(Debug, Default)]
pub(crate) struct KeyList {
    keys: Keys,
    /// The meaning that waits for a key.
    waiting: Option<String>,
}

impl KeyList {
    /// As they were kept.
    pub(crate) fn load() -> Self {
        let kept = settings::storage().and_then(|storage| storage.get_item(KEPT).ok().flatten());
        Self { keys: Keys::of(&kept.unwrap_or_default()), waiting: None }
    }

    /// Whether the next key is to be given a meaning.
    pub(crate) fn is_waiting(&self) -> bool {
        self.waiting.is_some()
    }

    /// What a key means, if anything.
    pub(crate) fn meaning(&self, chord: &Chord) -> Option<Chord> {
        self.keys.meaning(&chord.text()).map(|meaning| Chord::of(&meaning))
    }

    fn keep(&self) {
        if let Some(storage) = settings::storage() {
            let _ = storage.set_item(KEPT, &self.keys.text());
        }
    }
}

/// Notes the meaning of every key that the page names, and makes buttons of those in the list.
pub(crate) fn listen() {
    for key in all("kbd") {
        let meaning = read(&key.text_content().unwrap_or_default());
        dom::attribute(&key, "data-key", &meaning);
        if can_change(&meaning) && key.closest("#keys dt").ok().flatten().is_some() {
            let button = dom::command_button("key", "", "key");
            dom::attribute(&button, "data-subject", &meaning);
            let _ = key.replace_with_with_node_1(&button);
            dom::append(&button, [&key]);
        }
    }
    act(Page::list_keys);
}

fn all(selector: &str) -> Vec<Element> {
    let Ok(list) = dom::document().query_selector_all(selector) else { return Vec::new() };
    (0..list.length()).filter_map(|index| list.get(index)?.dyn_into().ok()).collect()
}

impl Page {
    /// Shows every key as it is now.
    pub(crate) fn show_keys(&self, note: &str) {
        let list = &self.keys;
        for key in all("kbd[data-key]") {
            let meaning = key.get_attribute("data-key").unwrap_or_default();
            let own = list.keys.key_of(&meaning);
            let is_changed = own != meaning;
            if is_changed || key.class_name() == "changed" {
                dom::text(&key, &shown(&own));
            }
            dom::class(&key, "changed", is_changed);
        }
        for button in all("button.key") {
            let waits = list.waiting.is_some() && list.waiting == button.get_attribute("data-subject");
            dom::attribute(&button, "aria-pressed", if waits { "true" } else { "false" });
        }
        dom::show(&dom::element("keys-reset"), list.keys != Keys::default());
        dom::text(&dom::element("keys-note"), note);
    }

    /// Opens the list, or goes back to what it says at first.
    pub(crate) fn list_keys(&mut self) {
        self.keys.waiting = None;
        self.show_keys(WHAT_TO_DO);
    }

    /// A key of the list was clicked: the next key that is pressed gets its meaning.
    pub(crate) fn await_key(&mut self, meaning: &str) {
        self.keys.waiting = Some(meaning.to_owned());
        self.show_keys(&format!("Press the new key in place of {}.", shown(&self.keys.keys.key_of(meaning))));
    }

    /// That key.
    pub(crate) fn change_key(&mut self, chord: &Chord) {
        let Some(meaning) = self.keys.waiting.clone() else { return };
        if chord.name == "escape" {
            self.list_keys();
            return;
        }
        let key = chord.text();
        match self.keys.keys.change(&meaning, &key) {
            Ok(()) => {
                self.keys.waiting = None;
                self.keys.keep();
                self.show_keys(&format!("{} it is, from now on.", shown(&key)));
            }
            Err(why) => self.show_keys(&why),
        }
    }

    /// All keys as delivered.
    pub(crate) fn reset_keys(&mut self) {
        self.keys.keys = Keys::default();
        self.keys.keep();
        self.list_keys();
    }
}
