//! What settling asks of the door: it begins when the shapes have come to rest, goes on with every step that nobody else
//! needs, and makes way for everything else.

use super::Modeler;
use crate::density;
use crate::model::{Making, Model};
use crate::settle::{FLAT, Hidden, MOST_NODES, Settling, Slide};
use crate::skeleton::carry_free;
use ductile_spec::{Document, Request};

impl Modeler {
    /// How often, since the beginning, a shape that had come to rest was kept although its document opens to another
    /// one, or to a worse one.
    #[must_use]
    pub fn kept(&self) -> u32 {
        self.kept
    }

    /// How far settling is.
    #[cfg(test)]
    pub(crate) fn settling(&self) -> &Settling {
        &self.settling
    }

    /// Whether nothing will move any more, and nothing is left to do out of sight.
    pub(super) fn is_settled(&self) -> bool {
        let is_settling = !matches!(self.settling, Settling::Idle);
        self.relaxer.is_settled() && !is_settling && !self.wants_settling()
    }

    /// Whether the shapes rest, and perhaps not as their document's own.
    fn wants_settling(&self) -> bool {
        let has_shapes = !(self.model.surfaces.is_empty() && self.model.curves.is_empty());
        let is_worked = matches!(self.model.making, Making::Worked | Making::Acted | Making::Moved);
        has_shapes
            && is_worked
            && self.model.node_count() <= MOST_NODES
            && !self.is_holding()
            && self.relaxer.is_settled()
    }

    /// Acts and drags find a model that is whole: a copy out of sight is dropped, a slide is over at once.
    pub(super) fn make_way(&mut self, request: &Request) {
        let only_looks = matches!(
            request,
            Request::Step(_)
                | Request::Describe
                | Request::Export(_)
                | Request::Meet { .. }
                | Request::Reach { .. }
                | Request::Loop { .. }
                | Request::Seams
        );
        if only_looks {
            return;
        }
        if let Settling::Sliding(slide) = core::mem::take(&mut self.settling) {
            self.arrive(&slide);
        }
    }

    /// Does a part of settling, if it is time for that; then the shapes shown are left to themselves in this step.
    pub(super) fn settle(&mut self) -> bool {
        if self.is_holding() {
            return false;
        }
        self.settling = match core::mem::take(&mut self.settling) {
            Settling::Idle if self.wants_settling() => match Hidden::open(&self.model) {
                Ok(hidden) => Settling::Hidden(Box::new(hidden)),
                Err(_) => self.keep(),
            },
            Settling::Idle => return false,
            Settling::Hidden(mut hidden) => {
                if !hidden.advance() {
                    Settling::Hidden(hidden)
                } else if let Some(slide) = hidden.slide_from(&self.model, &self.relaxer) {
                    let (relaxer, revisions) = hidden.into_parts();
                    self.model.continue_revisions(&revisions);
                    self.relaxer = relaxer.in_place_of(&self.relaxer);
                    slide.show(&mut self.model);
                    Settling::Sliding(Box::new(slide))
                } else {
                    self.keep()
                }
            }
            Settling::Sliding(mut slide) => {
                if slide.advance() {
                    self.arrive(&slide);
                    Settling::Idle
                } else {
                    slide.show(&mut self.model);
                    Settling::Sliding(slide)
                }
            }
        };
        self.relaxer.count_step();
        true
    }

    /// What was built from the document and has come to rest is its own. What acts made is kept, unless it rests folded.
    pub(super) fn note_rest(&mut self) {
        self.model.rests = self.relaxer.is_settled() && !self.is_holding();
        if self.model.making == Making::Opened && self.model.rests {
            self.model.making = if self.relaxer.is_stinted() { Making::Worked } else { Making::Own };
        }
        let is_good = match self.model.making {
            Making::Acted => self.relaxer.energy() <= FLAT,
            Making::Moved => true,
            _ => false,
        };
        if is_good && self.model.rests && !self.relaxer.is_folded() {
            self.model.making = Making::Kept;
        }
    }

    fn arrive(&mut self, slide: &Slide) {
        slide.end(&mut self.model);
        self.model.making = Making::Own;
        self.model.rests = true;
        self.relaxer.rest(&self.model);
    }

    fn keep(&mut self) -> Settling {
        let is_expected = self.model.making == Making::Acted && !self.relaxer.is_folded();
        self.model.making = Making::Kept;
        self.kept = self.kept.saturating_add(u32::from(!is_expected));
        Settling::Idle
    }
}

/// What an act leaves: shapes that can settle, or such as are kept. An act that moved control points changed nothing that the
/// document's own shape did not come to rest with before. Other acts change skeletons: what such a one opens to often rests
/// less well than the mesh on which it was made. So do meshes of several densities, which an opening can only guess. Only
/// where it comes to rest with folds is it tried all the same. Skeletons that a move made be taken anew are no other act.
pub(super) fn worked(before: &Model, now: &Model, is_renewed: bool) -> Making {
    let mut moved = Document { points: now.document.points.clone(), ..(*before.document).clone() };
    carry_free(&before.document, &mut moved);
    for (id, surface) in moved.surfaces.iter_mut().filter(|_| is_renewed) {
        if let Some(now) = now.document.surfaces.get(id) {
            surface.skeleton.clone_from(&now.skeleton);
        }
    }
    let has_only_moved =
        moved == *now.document && before.document.points.keys().eq(now.document.points.keys());
    if !has_only_moved {
        return Making::Acted;
    }
    let was_made = matches!(before.making, Making::Kept | Making::Acted | Making::Moved);
    let can_settle = !was_made && density::graded(now).is_empty();
    if can_settle { Making::Worked } else { Making::Moved }
}
