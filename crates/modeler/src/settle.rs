//! The shape at rest as a function of the document alone ("settling").
//!
//! A mesh remembers how its shape came about, and the energy of a shape depends on its mesh by a fraction of a percent. So when
//! a model that was worked on has come to rest, its document is opened once more out of sight and relaxed there, by the
//! steps that any opening takes; and if that leads to the same shape, the shape shown slides onto that mesh. Then it is what
//! anybody sees who opens the document, to the bit, whatever way it came (thesis figures 2.9, 5.6 and 8.2, where meshes decay).
//!
//! It is not the same shape when it lies farther away than two meshes of one shape do, or costs more; and not a better one when
//! its triangles are worse than those shown or when it does not come to rest. Then what is shown is kept. A shape that has come to
//! rest with folds is no shape that anybody wants: it makes way for one without, however far away that lies.

mod likeness;
mod slide;

use crate::error::ModelError;
use crate::model::{Making, Model};
use crate::patch;
use crate::relax::Relaxer;

pub(crate) use likeness::FLAT;
pub(crate) use slide::Slide;

/// Conjugate-gradient iterations of a step out of sight: always the same, whatever the clock of the page gives to steps in
/// sight. They rarely take ten.
pub(crate) const ITERATIONS: u32 = 20;
/// Nodes that may be stepped out of sight in one step of the modeler: a small model settles in a few, a large one needs many.
/// Nobody waits for a frame then, but a press may come at any time.
const NODES_AT_ONCE: usize = 20_000;

/// Most nodes of a model that settles: while it is open twice, it takes the memory of a model of twice as many.
pub(crate) const MOST_NODES: usize = 5_000;

/// How far settling is.
#[derive(Clone, Debug, Default)]
pub(crate) enum Settling {
    /// Nothing is under way.
    #[default]
    Idle,
    /// The document is open a second time.
    Hidden(Box<Hidden>),
    /// What is shown is on its way.
    Sliding(Box<Slide>),
}

/// The document, opened out of sight.
#[derive(Clone, Debug)]
pub(crate) struct Hidden {
    model: Model,
    relaxer: Relaxer,
}

impl Hidden {
    /// Opens the document of the model that is shown.
    pub(crate) fn open(shown: &Model) -> Result<Self, ModelError> {
        let mut hidden = Self { model: shown.reopened()?, relaxer: Relaxer::default() };
        hidden.bind();
        Ok(hidden)
    }

    /// Relaxes it further; returns whether it has come to rest or has had its time.
    pub(crate) fn advance(&mut self) -> bool {
        for _ in 0..(NODES_AT_ONCE / self.model.node_count().max(1)).max(1) {
            // In the order of a step in sight.
            patch::follow(&mut self.model, Some(&self.relaxer));
            self.relaxer.step(&mut self.model, ITERATIONS);
            self.bind();
            if self.relaxer.is_settled() {
                return true;
            }
        }
        false
    }

    fn bind(&mut self) {
        self.relaxer.bind(&self.model);
        patch::follow(&mut self.model, Some(&self.relaxer));
    }

    /// The way from the shape shown to this one, if it is the same shape and no worse.
    pub(crate) fn slide_from(&self, shown: &Model, relaxer: &Relaxer) -> Option<Slide> {
        let (hidden, old) = ((&self.model, &self.relaxer), (shown, relaxer));
        let unfolds = relaxer.is_folded() && !self.relaxer.is_folded();
        if !self.relaxer.is_at_rest() {
            return None;
        }
        if shown.making == Making::Acted && !relaxer.is_folded() {
            let is_taken = !self.relaxer.is_folded() && likeness::is_much_cheaper(hidden, old);
            return is_taken.then(|| Slide::new(shown, &self.model));
        }
        if !likeness::is_no_worse(hidden, old, unfolds) {
            return None;
        }
        let slide = Slide::new(shown, &self.model);
        (unfolds || likeness::is_near(&slide, shown)).then_some(slide)
    }

    /// The solvers, and the model that knows which revisions were given.
    pub(crate) fn into_parts(self) -> (Relaxer, Model) {
        (self.relaxer, self.model)
    }
}

#[cfg(test)]
mod tests;
