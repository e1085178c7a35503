//! How the designer wants the page to look; kept for all tabs.

use super::dom;
use super::page::Page;
use crate::{Look, Shading};
use web_sys::Storage;

const KEY: &str = "ductile.look";

/// Light, dark, or as the system has it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Theme {
    #[default]
    System,
    Light,
    Dark,
}

impl Theme {
    fn word(self) -> &'static str {
        match self {
            Self::System => "system",
            Self::Light => "light",
            Self::Dark => "dark",
        }
    }

    fn of(word: &str) -> Option<Self> {
        [Self::System, Self::Light, Self::Dark].into_iter().find(|theme| theme.word() == word)
    }
}

/// What is shown, and how.
#[derive(Debug, Default)]
pub(crate) struct Settings {
    pub(crate) look: Look,
    theme: Theme,
}

impl Settings {
    /// As they were kept. A word that is not understood is left out.
    pub(crate) fn load() -> Self {
        let mut settings = Self::default();
        let kept = storage().and_then(|storage| storage.get_item(KEY).ok().flatten()).unwrap_or_default();
        for word in kept.split(' ').filter(|word| !word.is_empty()) {
            settings.take(word);
        }
        settings
    }

    fn take(&mut self, word: &str) {
        if let Some(theme) = word.strip_prefix("theme-").and_then(Theme::of) {
            self.theme = theme;
        } else if let Some(word) = word.strip_prefix("shading-") {
            let kept = Shading::ALL.into_iter().find(|shading| shading.word() == word);
            self.look.shading = kept.unwrap_or_default();
        } else if let Some(name) = word.strip_prefix("no-") {
            self.set(name, false);
        } else {
            self.set(word, true);
        }
    }

    fn set(&mut self, name: &str, shown: bool) {
        if let Some(switch) = self.switch(name) {
            *switch = shown;
        }
    }

    /// The switch of a thing that can be shown or hidden.
    pub(crate) fn switch(&mut self, name: &str) -> Option<&mut bool> {
        let look = &mut self.look;
        match name {
            "surface" => Some(&mut look.surface),
            "wireframe" => Some(&mut look.wireframe),
            "skeleton" => Some(&mut look.skeleton),
            "grid" => Some(&mut look.grid),
            "triad" => Some(&mut look.triad),
            _ => None,
        }
    }

    fn keep(&mut self) {
        let shading = self.look.shading.word();
        let mut words = vec![format!("theme-{}", self.theme.word()), format!("shading-{shading}")];
        for name in SWITCHES {
            let shown = self.switch(name).is_some_and(|shown| *shown);
            words.push(if shown { name.to_owned() } else { format!("no-{name}") });
        }
        if let Some(storage) = storage() {
            let _ = storage.set_item(KEY, &words.join(" "));
        }
    }
}

const SWITCHES: [&str; 5] = ["surface", "wireframe", "skeleton", "grid", "triad"];

impl Page {
    /// Shows or hides a thing.
    pub(crate) fn toggle_look(&mut self, name: &str) {
        if let Some(shown) = self.settings.switch(name) {
            *shown = !*shown;
            self.settings.keep();
            self.apply_settings();
        }
    }

    /// Chooses a theme.
    pub(crate) fn choose_theme(&mut self, word: &str) {
        if let Some(theme) = Theme::of(word) {
            self.settings.theme = theme;
            self.settings.keep();
            self.apply_settings();
        }
    }

    /// Keeps what was chosen for the next visit.
    pub(crate) fn keep_settings(&mut self) {
        self.settings.keep();
    }

    /// Makes page and picture look as wanted.
    pub(crate) fn apply_settings(&mut self) {
        let theme = self.settings.theme;
        let system_is_dark = dom::media("(prefers-color-scheme: dark)");
        self.settings.look.dark = theme == Theme::Dark || (theme == Theme::System && system_is_dark);
        if let Some(root) = dom::document().document_element() {
            dom::attribute(&root, "data-theme", theme.word());
        }
        for name in SWITCHES {
            let shown = self.settings.switch(name).is_some_and(|shown| *shown);
            check(&format!("look-{name}"), shown);
        }
        for other in Shading::ALL {
            check(&format!("look-{}", other.word()), other == self.settings.look.shading);
        }
        self.show_legend();
        for other in [Theme::System, Theme::Light, Theme::Dark] {
            check(&format!("theme-{}", other.word()), other == theme);
        }
        self.hand.hover_is_stale = true;
        self.redraw();
    }
}

fn check(command: &str, checked: bool) {
    let selector = format!("[data-command=\"{command}\"]");
    if let Ok(Some(item)) = dom::document().query_selector(&selector) {
        dom::attribute(&item, "aria-checked", if checked { "true" } else { "false" });
    }
}

pub(crate) fn storage() -> Option<Storage> {
    dom::window().local_storage().ok().flatten()
}
