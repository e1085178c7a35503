//! What the page opens with: a link, a spec file at an address, the journal, or an example.

use super::dom;
use super::files::as_float;
use super::journal;
use super::link::clean_address;
use super::page::{Page, act};
use crate::address::{Asked, asked};
use ductile_spec::{Document, Example, MAX_TEXT_BYTES, Request, from_fragment, from_text};
use js_sys::Uint8Array;
use wasm_bindgen::{JsCast, JsValue};
use wasm_bindgen_futures::JsFuture;
use web_sys::{Event, ReadableStreamDefaultReader, Response};

/// Opens what the address asks for, and follows it when it changes.
pub(crate) fn begin() {
    dom::listen(&dom::window(), "hashchange", |_: Event| {
        if let Asked::Link(link) = address() {
            act(move |page| page.request(Request::OpenLink { link }));
        }
    });
    match address() {
        Asked::Link(link) => act(move |page| {
            page.panel.welcome_is_over = true;
            page.spare_journal(from_fragment(&link).ok().as_ref());
            page.request(Request::OpenLink { link });
        }),
        Asked::Spec(url) => wasm_bindgen_futures::spawn_local(async move {
            let fetched = fetch(&url).await;
            act(move |page| page.spec_came(&url, fetched));
        }),
        Asked::Nothing => act(Page::open_kept),
    }
    act(|page| journal::tidy(&page.journal));
}

fn address() -> Asked {
    let location = dom::window().location();
    asked(&location.hash().unwrap_or_default(), &location.search().unwrap_or_default())
}

impl Page {
    /// Opens the journal, or the example that everybody sees first.
    fn open_kept(&mut self) {
        match self.journal.read() {
            Some(text) => {
                self.panel.welcome_is_over = true;
                self.request(Request::OpenText { text });
            }
            None => self.request(Request::OpenExample(Example::RaisedDisc)),
        }
    }

    /// What was asked for cannot be opened and nothing is there: the journal, else the example, once each.
    pub(crate) fn open_fallback(&mut self) {
        self.fallbacks += 1;
        self.falling_back = true;
        match self.fallbacks {
            1 => self.open_kept(),
            2 => self.request(Request::OpenExample(Example::RaisedDisc)),
            _ => {}
        }
    }

    /// A document from elsewhere must not overwrite what this tab has kept: it gets a journal of its own.
    fn spare_journal(&mut self, document: Option<&Document>) {
        let Some(own) = self.journal.own() else { return };
        if document.is_some() && from_text(&own).ok().as_ref() != document {
            self.journal.take_new_identity();
        }
    }

    fn spec_came(&mut self, url: &str, fetched: Result<String, String>) {
        match fetched {
            Ok(text) => {
                self.panel.welcome_is_over = true;
                self.spare_journal(from_text(&text).ok().as_ref());
                self.request(Request::OpenText { text });
            }
            Err(why) => {
                self.notices.banner("opening", &format!("{url} was not opened: {why}."), &[]);
                self.open_fallback();
            }
        }
    }

    /// After the first act the address no longer tells what is on the screen.
    pub(crate) fn leave_address(&mut self) {
        if address() == Asked::Nothing {
            return;
        }
        let clean = clean_address();
        if let Ok(history) = dom::window().history() {
            let _ = history.replace_state_with_url(&JsValue::NULL, "", Some(&clean));
        }
    }
}

/// Fetches a spec file, and stops reading as soon as it is larger than any document.
async fn fetch(url: &str) -> Result<String, String> {
    let window = dom::window();
    let response = JsFuture::from(window.fetch_with_str(url)).await.map_err(|_| {
        "it cannot be reached, or its server does not allow other pages to read it".to_owned()
    })?;
    let response: Response = response.unchecked_into();
    if !response.ok() {
        return Err(format!("its server answers {} {}", response.status(), response.status_text())
            .trim_end()
            .to_owned());
    }
    let announced = response.headers().get("content-length").ok().flatten();
    let announced = announced.and_then(|length| length.parse::<f64>().ok());
    let too_long = || format!("it is larger than {MAX_TEXT_BYTES} bytes, the limit for documents");
    if announced.is_some_and(|length| length > as_float(MAX_TEXT_BYTES)) {
        return Err(too_long());
    }
    let Some(body) = response.body() else { return Ok(String::new()) };
    let reader: ReadableStreamDefaultReader = body.get_reader().unchecked_into();
    let mut bytes = Vec::new();
    loop {
        let part = JsFuture::from(reader.read()).await.map_err(|error| dom::message(&error))?;
        if dom::field(&part, "done").is_truthy() {
            break;
        }
        let part: Uint8Array = dom::field(&part, "value").unchecked_into();
        if bytes.len() + part.length() as usize > MAX_TEXT_BYTES {
            let _ = JsFuture::from(reader.cancel()).await;
            return Err(too_long());
        }
        bytes.extend(part.to_vec());
    }
    String::from_utf8(bytes).map_err(|_| "it is not a text".to_owned())
}
