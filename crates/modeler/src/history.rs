//! Undo and redo: whole models, whose unchanged parts are shared.
//!
//! Documents are small and are kept without limit of number; shapes are large and are kept while they fit
//! into a budget. An entry without its shapes is rebuilt from its document, which is exact for the document
//! and approximates the shape anew.

use crate::model::Model;
use ductile_spec::{Document, Remembered, from_text};
use std::sync::Arc;

/// Bytes of shapes that the history may hold.
const SHAPE_BUDGET: usize = 64 << 20;
/// Most acts that are remembered; a thousand is promised.
const MOST_ACTS: usize = 10_000;

/// What an entry goes back to.
#[derive(Clone, Debug)]
pub(crate) enum State {
    /// The document and its shapes as they were.
    Whole(Model),
    /// Only the document; the shapes were let go to save memory.
    Document(Arc<Document>),
}

#[derive(Clone, Debug)]
struct Entry {
    act: String,
    state: State,
}

/// The acts that can be taken back and done again.
#[derive(Clone, Debug, Default)]
pub(crate) struct History {
    undo: Vec<Entry>,
    redo: Vec<Entry>,
}

impl History {
    /// The history of a modeler that died. An entry that cannot be read ends it: what is older is out of reach.
    pub(crate) fn remembered(undo: &[Remembered], redo: &[Remembered]) -> Self {
        let read = |entries: &[Remembered]| {
            let readable = entries.iter().rev().map_while(|Remembered { act, document }| {
                let document = from_text(document).ok()?;
                Some(Entry { act: act.clone(), state: State::Document(Arc::new(document)) })
            });
            let mut entries: Vec<Entry> = readable.take(MOST_ACTS).collect();
            entries.reverse();
            entries
        };
        Self { undo: read(undo), redo: read(redo) }
    }

    /// Remembers the model before an act.
    pub(crate) fn record(&mut self, act: &str, before: Model) {
        self.redo.clear();
        self.undo.push(Entry { act: act.to_owned(), state: State::Whole(before) });
        if self.undo.len() > MOST_ACTS {
            self.undo.remove(0);
        }
        self.trim();
    }

    /// Takes back the last act: returns its name and the state before it.
    pub(crate) fn undo(&mut self, now: &Model) -> Option<(String, State)> {
        let Entry { act, state } = self.undo.pop()?;
        self.redo.push(Entry { act: act.clone(), state: State::Whole(now.clone()) });
        Some((act, state))
    }

    /// Does the last undone act again: returns its name and the state after it.
    pub(crate) fn redo(&mut self, now: &Model) -> Option<(String, State)> {
        let Entry { act, state } = self.redo.pop()?;
        self.undo.push(Entry { act: act.clone(), state: State::Whole(now.clone()) });
        Some((act, state))
    }

    /// The act that undo would take back.
    pub(crate) fn next_undo(&self) -> Option<&str> {
        self.undo.last().map(|entry| entry.act.as_str())
    }

    /// The act that redo would do again.
    pub(crate) fn next_redo(&self) -> Option<&str> {
        self.redo.last().map(|entry| entry.act.as_str())
    }

    /// Lets go of the oldest shapes when there are too many. Shared shapes are counted once for each entry:
    /// an upper bound that needs no bookkeeping.
    fn trim(&mut self) {
        let mut bytes = 0;
        for entry in self.undo.iter_mut().rev() {
            if let State::Whole(model) = &entry.state {
                bytes += model.shape_bytes();
                if bytes > SHAPE_BUDGET {
                    entry.state = State::Document(Arc::clone(&model.document));
                }
            }
        }
    }
}
