//! What displacements ask of the door: acts happen on the surface below what is shown, displacements follow the surfaces that
//! acts change, and feet can be dragged.

use super::{Modeler, Outcome};
use crate::displaced::{Footprints, give_back};
use crate::error::ModelError;
use crate::model::Model;
use crate::operation;
use crate::patch;
use crate::pull::Pull;
use ductile_spec::{Document, Edit, GrabTarget, Pulled};
use glam::DVec3;

impl Modeler {
    /// Does an act; what fails leaves a model to be dropped.
    pub(super) fn act(&mut self, edit: &Edit, before: &Model) -> Result<(), ModelError> {
        if operation::displaces(edit) {
            return operation::apply(&mut self.model, &self.relaxer, &mut self.displacer, edit);
        }
        let edit = self.displacer.edit_on_base(edit);
        if before.document.displacements.is_empty() {
            return operation::apply(&mut self.model, &self.relaxer, &mut self.displacer, &edit);
        }
        let footprints = self.displacer.footprints();
        // The act knows nothing of them: it may leave surfaces with other names, or none.
        let taken = std::mem::take(&mut self.model.document_mut().displacements);
        operation::apply(&mut self.model, &self.relaxer, &mut self.displacer, &edit)?;
        give_back(&mut self.model, before, taken)?;
        self.displacer.adopt(&self.model);
        patch::follow(&mut self.model, Some(&self.relaxer));
        self.displacer.carry_exact(&mut self.model, &self.relaxer, &footprints)
    }

    /// Whether a drag is under way.
    pub(super) fn is_holding(&self) -> bool {
        self.grab.is_some() || self.pull.is_some()
    }

    /// Takes hold of a foot, or makes one; nothing if something else is meant.
    pub(super) fn pull(&mut self, target: GrabTarget) -> Option<Result<Outcome, ModelError>> {
        let begun = match target {
            GrabTarget::Displace(begun) => {
                let before = self.model.clone();
                let all = (&mut self.model, &self.relaxer, &mut self.displacer);
                let begun = Pull::begin(all, &begun);
                if begun.is_err() {
                    self.restore(before);
                }
                begun
            }
            GrabTarget::Foot { surface, number } => Pull::take(&self.model, surface, number),
            _ => return None,
        };
        Some(begun.map(|pull| {
            let at = pull.at(&self.model, &self.displacer).unwrap_or(DVec3::ZERO);
            let pulled = Pulled { surface: pull.surface, number: pull.index + 1, at };
            self.pull = Some(pull);
            Outcome { pulled: Some(pulled), ..Outcome::default() }
        }))
    }

    /// The foot that is held follows the hand.
    pub(super) fn pull_to(&mut self, to: DVec3) {
        if let Some(pull) = &mut self.pull
            && pull.follow(&mut self.model, &self.displacer, to).is_none()
        {
            self.relaxer.count_rescue();
        }
    }

    /// Ends the drag of a foot and keeps its result. The shapes below have no reason to move.
    pub(super) fn end_pull(&mut self, pull: Pull) -> Result<Outcome, ModelError> {
        let done = if pull.has_moved { pull.finish(&mut self.model).map(Some) } else { Ok(None) };
        match done {
            Ok(Some(act)) if self.model.document != pull.before.document => {
                self.history.record(act, pull.before);
                Ok(Outcome { committed: Some(act.to_owned()), ..Outcome::default() })
            }
            Ok(_) => {
                self.restore(pull.before);
                Ok(Outcome::default())
            }
            Err(error) => {
                self.restore(pull.before);
                Err(error)
            }
        }
    }

    /// A drag of a control is over: feet stay where the surface carried them.
    pub(super) fn carry_feet(&mut self, footprints: &Footprints) -> Result<(), ModelError> {
        self.displacer.carry(&mut self.model, footprints)
    }
}

/// Whether two documents differ in displacements, and in nothing else.
pub(super) fn is_over_shapes(before: &Document, now: &Document) -> bool {
    let is_displaced_otherwise = before.displacements != now.displacements;
    is_displaced_otherwise && {
        let bare = Document { displacements: now.displacements.clone(), ..before.clone() };
        bare == *now
    }
}
