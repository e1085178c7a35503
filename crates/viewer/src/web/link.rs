//! The share link: the whole document in the fragment of an address.

use super::dom;
use super::page::{Page, act};
use ductile_spec::{Document, MAX_LINK_BYTES, to_fragment};
use js_sys::{Function, Promise};
use wasm_bindgen::{JsCast, JsValue};
use wasm_bindgen_futures::JsFuture;
use web_sys::{Event, HtmlDialogElement, HtmlTextAreaElement};

/// Above this some chat programs cut an address.
const LONG: usize = 2000;

/// Selects the whole link when its field is entered.
pub(crate) fn listen() {
    let field: HtmlTextAreaElement = dom::element_as("link-field");
    let own = field.clone();
    dom::listen(&field, "focus", move |_: Event| own.select());
}

impl Page {
    /// Copies the link, or shows it where it can be copied by hand.
    pub(crate) fn copy_link(&mut self) {
        if self.committed.is_none() {
            self.notices.refusal("There is nothing to share yet.");
            return;
        }
        let link = format!("{}#{}", clean_address(), to_fragment(&self.document));
        let length = link.chars().count();
        if length > MAX_LINK_BYTES {
            let text = format!(
                "A link that holds this model would have {length} characters, and browsers take {MAX_LINK_BYTES} at most: save it as a file."
            );
            self.notices.refusal(&text);
            return;
        }
        let holds = holds(&self.document);
        // The clipboard wants to be asked in the very event of the designer's act.
        let copying = copy(&link);
        wasm_bindgen_futures::spawn_local(async move {
            let copied = match copying {
                Some(copying) => JsFuture::from(copying).await.is_ok(),
                None => false,
            };
            act(move |page| {
                if copied && length <= LONG {
                    page.notices.say(&format!("Link copied: {length} characters that hold {holds}."));
                } else {
                    show(&link, &described(copied, length, &holds));
                }
            });
        });
    }
}

fn described(copied: bool, length: usize, holds: &str) -> String {
    let head = if copied {
        format!("The link was copied. It has {length} characters and holds {holds}.")
    } else {
        format!(
            "The browser does not let this page write to the clipboard: copy the link from here. It has {length} characters and holds {holds}."
        )
    };
    let tail = if length > LONG {
        " Some chat programs cut links longer than 2,000; a file always arrives whole."
    } else {
        ""
    };
    head + tail
}

fn show(link: &str, text: &str) {
    let dialog: HtmlDialogElement = dom::element_as("link-dialog");
    let field: HtmlTextAreaElement = dom::element_as("link-field");
    dom::text(&dom::element("link-text"), text);
    field.set_value(link);
    if !dialog.open() {
        let _ = dialog.show_modal();
    }
    let _ = field.focus();
    field.select();
    field.set_scroll_top(0);
}

fn copy(link: &str) -> Option<Promise> {
    let clipboard = dom::field(&dom::field(&dom::window(), "navigator"), "clipboard");
    let write: Function = dom::field(&clipboard, "writeText").dyn_into().ok()?;
    write.call1(&clipboard, &JsValue::from_str(link)).ok()?.dyn_into().ok()
}

/// The address of the page without fragment and query.
pub(crate) fn clean_address() -> String {
    let location = dom::window().location();
    let origin = location.origin().unwrap_or_default();
    let path = location.pathname().unwrap_or_default();
    format!("{origin}{path}")
}

fn holds(document: &Document) -> String {
    let count = |count: usize, one: &str| {
        if count == 1 { format!("1 {one}") } else { format!("{count} {one}s") }
    };
    let Document { points, curves, surfaces, cages, fills, meshes, .. } = document;
    format!(
        "{}, {} and {}",
        count(points.len(), "point"),
        count(curves.len(), "curve"),
        count(surfaces.len() + cages.len() + fills.len() + meshes.len(), "surface")
    )
}
