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

    /// The state before the last act. Nothing changes until it was gone back to.
    pub(crate) fn before_last(&self) -> Option<State> {
        self.undo.last().map(|entry| entry.state.clone())
    }

    /// The state after the last undone act.
    pub(crate) fn after_next(&self) -> Option<State> {
        self.redo.last().map(|entry| entry.state.clone())
    }

    /// The last act was taken back, from the model as it was: returns its name.
    pub(crate) fn undone(&mut self, now: &Model) -> Option<String> {
        let Entry { act, .. } = self.undo.pop()?;
        self.redo.push(Entry { act: act.clone(), state: State::Whole(now.clone()) });
        Some(act)
    }

    /// The last undone act was done again, from the model as it was: returns its name.
    pub(crate) fn redone(&mut self, now: &Model) -> Option<String> {
        let Entry { act, .. } = self.redo.pop()?;
        self.undo.push(Entry { act: act.clone(), state: State::Whole(now.clone()) });
        Some(act)
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::SurfaceShape;
    use ductile_mesh::Mesh;
    use ductile_spec::SurfaceId;
    use glam::DVec3;
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    /// A model whose shapes need a third of what a history may hold, and a little more.
    fn large() -> Model {
        let shape = SurfaceShape {
            mesh: Mesh::from_triangles(3, &[[0, 1, 2]]).unwrap(),
            positions: vec![DVec3::ZERO; SHAPE_BUDGET / 24 / 3 + 1000],
            embeddings: Vec::new(),
            pins: Vec::new(),
            spacing: 1.0,
            wanted: Vec::new(),
            age: 0,
            revision: 1,
        };
        let mut model = Model::default();
        model.surfaces.insert(SurfaceId(1), Arc::new(shape));
        model
    }

    #[test]
    fn the_oldest_shapes_are_let_go_for_memory_and_their_documents_stay() {
        let (mut history, model) = (History::default(), large());
        for act in ["one", "two", "three", "four"] {
            history.record(act, model.clone());
        }
        let is_whole = |entry: &Entry| matches!(entry.state, State::Whole(_));
        assert_eq!(history.undo.iter().map(is_whole).collect::<Vec<_>>(), [false, false, true, true]);
        for act in ["four", "three", "two", "one"] {
            assert!(history.before_last().is_some());
            assert_eq!(history.undone(&model).as_deref(), Some(act));
        }
        assert_eq!(history.next_redo(), Some("one"));
    }
}
