//! The journal: the document after every act, in the browser's own storage.
//!
//! Each tab writes under its own identity, so two tabs never overwrite each other; a fresh tab goes on with a
//! copy of the newest journal. A record is `1 <milliseconds> <checksum>`, a line break, and the text of the
//! document. The identity is kept in the session storage, which a duplicated tab copies: a lock of the
//! browser tells such a tab that its identity is taken.

use super::dom;
use super::page::{Page, act};
use js_sys::{Date, Function, Math, Object, Promise};
use wasm_bindgen::closure::Closure;
use wasm_bindgen::{JsCast, JsValue};
use web_sys::Storage;

const PREFIX: &str = "ductile.journal.";
const TAB: &str = "ductile.tab";
/// Journals of other tabs that are kept.
const MOST_JOURNALS: usize = 24;

const REFUSED: &str = "This browser does not keep your work: its storage is full or refused. Save the file before you leave the page.";

/// The journal of this tab.
#[derive(Debug)]
pub(crate) struct Journal {
    tab: String,
    /// A write was refused: what is on the screen is kept nowhere.
    pub(crate) is_refused: bool,
}

impl Journal {
    /// Finds the identity of this tab, or makes one.
    pub(crate) fn open() -> Self {
        let session = session();
        let known = session.as_ref().and_then(|session| session.get_item(TAB).ok().flatten());
        let mut journal = Self { tab: known.unwrap_or_default(), is_refused: false };
        if journal.tab.is_empty() {
            journal.take_new_identity();
        } else {
            claim(&journal.tab);
        }
        journal
    }

    /// The text of this tab's journal, or of the newest one.
    pub(crate) fn read(&self) -> Option<String> {
        self.own().or_else(|| newest(&storage()?))
    }

    /// The text of this tab's own journal.
    pub(crate) fn own(&self) -> Option<String> {
        let record = storage()?.get_item(&self.key()).ok().flatten()?;
        unpack(&record).map(|(_, text)| text.to_owned())
    }

    /// Writes under another identity from now on; what was written stays.
    pub(crate) fn take_new_identity(&mut self) {
        self.tab = format!("{:x}{:x}", Date::now().to_bits(), Math::random().to_bits());
        if let Some(session) = session() {
            let _ = session.set_item(TAB, &self.tab);
        }
        claim(&self.tab);
    }

    /// Writes the document. Says whether the browser took it.
    pub(crate) fn write(&mut self, text: &str) -> bool {
        let record = pack(Date::now(), text);
        let written = storage().is_some_and(|storage| {
            let key = self.key();
            let attempt = || storage.set_item(&key, &record).is_ok();
            // Full: what is oldest goes first.
            let written = attempt() || (prune(&storage, &key, MOST_JOURNALS / 4) && attempt());
            written && storage.get_item(&key).ok().flatten().as_deref() == Some(&record)
        });
        self.is_refused = !written;
        written
    }

    fn key(&self) -> String {
        format!("{PREFIX}{}", self.tab)
    }
}

impl Page {
    /// Keeps the document, or warns at once.
    pub(crate) fn keep(&mut self, text: &str) {
        if self.journal.write(text) {
            self.notices.dismiss("storage");
        } else {
            self.notices.banner("storage", REFUSED, &[("Save file", "save")]);
        }
    }

    /// Another tab has this identity: this one goes on with a copy.
    fn fork(&mut self) {
        self.journal.take_new_identity();
        if let Some(committed) = &self.committed {
            let text = committed.document.clone();
            self.keep(&text);
        }
    }
}

/// Removes journals that are beyond counting.
pub(crate) fn tidy(journal: &Journal) {
    if let Some(storage) = storage() {
        prune(&storage, &journal.key(), MOST_JOURNALS);
    }
}

fn storage() -> Option<Storage> {
    dom::window().local_storage().ok().flatten()
}

fn session() -> Option<Storage> {
    dom::window().session_storage().ok().flatten()
}

fn records(storage: &Storage) -> Vec<(f64, String)> {
    let count = storage.length().unwrap_or(0);
    let keys = (0..count).filter_map(|index| storage.key(index).ok().flatten());
    let journals = keys.filter(|key| key.starts_with(PREFIX));
    let mut records: Vec<(f64, String)> = journals
        .map(|key| {
            let record = storage.get_item(&key).ok().flatten();
            (record.as_deref().and_then(unpack).map_or(0.0, |(time, _)| time), key)
        })
        .collect();
    records.sort_by(|a, b| b.0.total_cmp(&a.0).then_with(|| a.1.cmp(&b.1)));
    records
}

fn newest(storage: &Storage) -> Option<String> {
    let (_, key) = records(storage).into_iter().next()?;
    let record = storage.get_item(&key).ok().flatten()?;
    unpack(&record).map(|(_, text)| text.to_owned())
}

/// Removes all but the newest; says whether there was anything to remove.
fn prune(storage: &Storage, own: &str, keep: usize) -> bool {
    let surplus: Vec<String> =
        records(storage).into_iter().map(|(_, key)| key).filter(|key| key != own).skip(keep).collect();
    surplus.iter().for_each(|key| {
        let _ = storage.remove_item(key);
    });
    !surplus.is_empty()
}

/// Holds a lock for the life of the tab. If another tab holds it, this one is a copy and forks.
fn claim(tab: &str) {
    let locks = dom::field(&dom::field(&dom::window(), "navigator"), "locks");
    let Ok(request) = dom::field(&locks, "request").dyn_into::<Function>() else { return };
    let options = Object::new();
    dom::put(&options, "ifAvailable", true);
    let granted = Closure::once_into_js(|lock: JsValue| -> JsValue {
        if lock.is_null() {
            act(Page::fork);
            return JsValue::UNDEFINED;
        }
        // A promise that is never kept: the lock goes with the tab.
        Promise::new(&mut |_, _| {}).into()
    });
    let _ = request.call3(&locks, &JsValue::from_str(&format!("{PREFIX}{tab}")), &options, &granted);
}

fn pack(time: f64, text: &str) -> String {
    format!("1 {time} {:016x}\n{text}", checksum(text))
}

fn unpack(record: &str) -> Option<(f64, &str)> {
    let (head, text) = record.split_once('\n')?;
    let mut parts = head.split(' ');
    let (Some("1"), Some(time), Some(sum)) = (parts.next(), parts.next(), parts.next()) else { return None };
    let right = u64::from_str_radix(sum, 16).is_ok_and(|sum| sum == checksum(text));
    Some((time.parse().ok()?, text)).filter(|_| right)
}

/// FNV-1a, 64 bits (Fowler, Noll and Vo): finds a torn or altered record; it guards against no malice.
fn checksum(text: &str) -> u64 {
    text.bytes()
        .fold(0xcbf2_9ce4_8422_2325, |sum, byte| (sum ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3))
}
