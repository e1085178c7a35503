//! What the page remembers of the acts, so that undo goes on when the worker has died.
//!
//! The worker owns the history, with its shapes; the page keeps the documents before and after each act, as they come
//! back with every act. A new worker is given them and rebuilds the shapes that are wanted.

use ductile_spec::{Committed, Remembered, Resume};

/// Most bytes of documents that are remembered; a document has a few hundred, so these are thousands of acts.
const MOST_BYTES: usize = 8 << 20;

/// The documents around the present one.
#[derive(Debug, Default)]
pub struct Memory {
    undo: Vec<Remembered>,
    redo: Vec<Remembered>,
    now: Option<String>,
}

impl Memory {
    /// An act was committed, undo and redo included.
    pub fn committed(&mut self, committed: &Committed) {
        let before = self.now.replace(committed.document.clone());
        if let Some(document) = before {
            self.follow(&committed.act, document);
        }
        let agrees = |stack: &[Remembered], next: &Option<String>| {
            stack.last().map(|entry| entry.act.as_str()) == next.as_deref()
        };
        // The worker has the last word: what it would not take back is not remembered, nor what cannot be followed.
        if !agrees(&self.undo, &committed.undo) || !agrees(&self.redo, &committed.redo) {
            self.undo.clear();
            self.redo.clear();
        }
        self.trim();
    }

    /// What a new worker needs to go on; nothing when nothing was committed yet.
    #[must_use]
    pub fn resume(&self) -> Option<Resume> {
        let document = self.now.clone()?;
        Some(Resume { document, undo: self.undo.clone(), redo: self.redo.clone() })
    }

    /// Does with the stacks what the worker did with its own.
    fn follow(&mut self, act: &str, before: String) {
        let (from, to) = if act.starts_with("Undo ") {
            (&mut self.undo, &mut self.redo)
        } else if act.starts_with("Redo ") {
            (&mut self.redo, &mut self.undo)
        } else {
            self.redo.clear();
            self.undo.push(Remembered { act: act.to_owned(), document: before });
            return;
        };
        if let Some(entry) = from.pop() {
            to.push(Remembered { act: entry.act, document: before });
        }
    }

    /// Forgets what is oldest when there is too much.
    fn trim(&mut self) {
        let mut room = MOST_BYTES;
        let mut fits = |entry: &Remembered| {
            room = room.saturating_sub(entry.document.len());
            room > 0
        };
        let kept = self.undo.iter().rev().take_while(|entry| fits(entry)).count();
        self.undo.drain(..self.undo.len() - kept);
        let kept = self.redo.iter().rev().take_while(|entry| fits(entry)).count();
        self.redo.drain(..self.redo.len() - kept);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    fn commit(memory: &mut Memory, act: &str, document: &str, undo: Option<&str>, redo: Option<&str>) {
        memory.committed(&Committed {
            act: act.into(),
            document: document.into(),
            name: String::new(),
            undo: undo.map(str::to_owned),
            redo: redo.map(str::to_owned),
        });
    }

    fn shown(stack: &[Remembered]) -> Vec<(&str, &str)> {
        stack.iter().map(|entry| (entry.act.as_str(), entry.document.as_str())).collect()
    }

    fn worked() -> Memory {
        let mut memory = Memory::default();
        commit(&mut memory, "Disc", "a", None, None);
        commit(&mut memory, "Move", "b", Some("Move"), None);
        commit(&mut memory, "Sheet", "c", Some("Sheet"), None);
        memory
    }

    #[test]
    fn acts_undo_and_redo_are_followed() {
        let mut memory = worked();
        commit(&mut memory, "Undo Sheet", "b", Some("Move"), Some("Sheet"));
        let resume = memory.resume().unwrap();
        assert_eq!(resume.document, "b");
        assert_eq!(shown(&resume.undo), [("Move", "a")]);
        assert_eq!(shown(&resume.redo), [("Sheet", "c")]);
        commit(&mut memory, "Redo Sheet", "c", Some("Sheet"), None);
        assert_eq!(shown(&memory.resume().unwrap().undo), [("Move", "a"), ("Sheet", "b")]);
        commit(&mut memory, "Undo Sheet", "b", Some("Move"), Some("Sheet"));
        commit(&mut memory, "Pull", "d", Some("Pull"), None);
        assert_eq!(shown(&memory.resume().unwrap().undo), [("Move", "a"), ("Pull", "b")]);
        assert!(memory.resume().unwrap().redo.is_empty(), "a new act ends what could be done again");
    }

    #[test]
    fn nothing_committed_is_nothing_to_resume() {
        assert_eq!(Memory::default().resume(), None);
    }

    #[test]
    fn what_the_worker_does_not_know_is_forgotten() {
        let mut memory = worked();
        commit(&mut memory, "Move", "d", None, None);
        let resume = memory.resume().unwrap();
        assert_eq!(resume.document, "d");
        assert!(resume.undo.is_empty() && resume.redo.is_empty());
    }

    #[test]
    fn the_oldest_goes_when_there_is_too_much() {
        let mut memory = Memory::default();
        let large = "x".repeat(MOST_BYTES / 4);
        commit(&mut memory, "Open", &large, None, None);
        for _ in 0..10 {
            commit(&mut memory, "Move", &large, Some("Move"), None);
        }
        assert_eq!(memory.resume().unwrap().undo.len(), 3);
    }
}
