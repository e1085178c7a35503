//! Banners at the top, a toast at the bottom, and the line that says what the tool wants.

use super::dom;
use super::page::act;
use web_sys::{Element, HtmlElement};

/// How long a toast stays: long enough to reach its button.
const TOAST_MILLISECONDS: i32 = 6000;

/// What the page says at the moment.
#[derive(Debug)]
pub(crate) struct Notices {
    banners: Vec<(&'static str, String, HtmlElement)>,
    shelf: HtmlElement,
    toast: HtmlElement,
    toast_text: HtmlElement,
    toast_button: HtmlElement,
    hint: HtmlElement,
    /// Tells a toast from those before it, whose time may still be running.
    toasts: u32,
}

impl Default for Notices {
    fn default() -> Self {
        Self {
            banners: Vec::new(),
            shelf: dom::element("banners"),
            toast: dom::element("toast"),
            toast_text: dom::element("toast-text"),
            toast_button: dom::element("toast-button"),
            hint: dom::element("hint"),
            toasts: 0,
        }
    }
}

impl Notices {
    /// Shows a banner in place of the one with the same key. It stays until it is closed.
    pub(crate) fn banner(&mut self, key: &'static str, text: &str, buttons: &[(&'static str, &'static str)]) {
        if self.banners.iter().any(|(own, said, _)| *own == key && said == text) {
            return;
        }
        self.dismiss(key);
        let banner = dom::create_with("div", "banner", "");
        dom::append(&banner, [&dom::create_with("p", "", text)]);
        let close = dom::command_button("icon-button", "", "dismiss");
        dom::attribute(&close, "data-banner", key);
        dom::attribute(&close, "aria-label", "Close");
        dom::append(&close, [&dom::icon("i-close")]);
        dom::append(&banner, [&close]);
        if !buttons.is_empty() {
            let deeds = dom::create_with("div", "deeds", "");
            for (label, command) in buttons {
                dom::append(&deeds, [&dom::command_button("button", label, command)]);
            }
            dom::append(&banner, [&deeds]);
        }
        dom::append(&self.shelf, [&banner]);
        self.banners.push((key, text.to_owned(), banner));
    }

    /// Shows a banner that goes by itself.
    pub(crate) fn banner_for(&mut self, key: &'static str, text: &str, milliseconds: i32) {
        self.banner(key, text, &[]);
        let text = text.to_owned();
        dom::after(milliseconds, move || {
            act(move |page| {
                if page.notices.banners.iter().any(|(own, said, _)| *own == key && *said == text) {
                    page.notices.dismiss(key);
                }
            });
        });
    }

    /// Takes a banner away.
    pub(crate) fn dismiss(&mut self, key: &str) {
        self.banners.retain(|(own, _, element)| {
            if *own == key {
                element.remove();
            }
            *own != key
        });
    }

    /// What the banners say.
    pub(crate) fn texts(&self) -> impl Iterator<Item = &str> {
        self.banners.iter().map(|(_, text, _)| text.as_str())
    }

    /// What the toast says, while it is shown.
    pub(crate) fn toast_said(&self) -> Option<String> {
        if self.toast.hidden() { None } else { self.toast_text.text_content() }
    }

    /// Names an act, with a button (its label and its command).
    pub(crate) fn toast(&mut self, text: &str, button: Option<(&str, &str)>) {
        self.show_toast(text, button, false);
    }

    /// Says why something cannot be done.
    pub(crate) fn refusal(&mut self, text: &str) {
        self.show_toast(text, None, true);
    }

    /// Says something by the way.
    pub(crate) fn say(&mut self, text: &str) {
        self.show_toast(text, None, false);
    }

    /// Takes the toast away.
    pub(crate) fn hide_toast(&mut self) {
        dom::show(&self.toast, false);
    }

    /// What the tool wants next.
    pub(crate) fn hint(&self, text: &str) {
        dom::text(&self.hint, text);
    }

    fn show_toast(&mut self, text: &str, button: Option<(&str, &str)>, refusal: bool) {
        self.toasts += 1;
        let number = self.toasts;
        dom::text(&self.toast_text, text);
        dom::class(&self.toast, "refusal", refusal);
        dom::show(&self.toast_button, button.is_some());
        if let Some((label, command)) = button {
            dom::text(&self.toast_button, label);
            dom::attribute(&self.toast_button, "data-command", command);
        }
        dom::show(&self.toast, true);
        wait(number, self.toast.clone().into());
    }
}

/// Takes a toast away when its time is over, unless the pointer or the focus rests on it.
fn wait(number: u32, toast: Element) {
    dom::after(TOAST_MILLISECONDS, move || {
        let rests = toast.matches(":hover, :focus-within").unwrap_or(false);
        if rests {
            wait(number, toast);
            return;
        }
        act(move |page| {
            if page.notices.toasts == number {
                page.notices.hide_toast();
            }
        });
    });
}
