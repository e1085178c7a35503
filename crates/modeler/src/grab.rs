//! A drag: from taking hold of something to letting it go. A whole drag is one act.
//!
//! While it lasts, the document's position of the held point follows the hand, and the shapes follow the
//! document as they relax. A hand can ask for anything: what is not a number is ignored, what is far is
//! cut to a reach, and in the end the position is rounded to what a document keeps.

use crate::error::ModelError;
use crate::model::Model;
use crate::operation::{insert, kept_position, pin};
use crate::relax::Relaxer;
use ductile_spec::{GrabTarget, MAX_COORDINATE, PointId};
use glam::DVec3;

/// How far one drag can reach, in radii of the model at its beginning.
const REACH: f64 = 5.0;
/// A shape whose energy rises by more than this factor and this much in one drag is a wreck: no fair shape
/// within reach costs as much, only crumpled ones do.
const WRECK_FACTOR: f64 = 3.0;
const WRECK_RISE: f64 = 60.0;
/// A shape whose point came home is not the one of before if its energy differs by more than this part: it is caught in
/// a fold, or only its mesh has become another one.
const LOST: f64 = 1e-6;
/// Steps that a shape at home has to find back by itself, and steps between two returns to the shape at the beginning of the drag.
const PATIENCE: u32 = 30;

/// A drag in progress.
#[derive(Clone, Debug)]
pub(crate) struct Grab {
    /// The control point that is held.
    pub(crate) point: PointId,
    /// Whether the grab made it.
    pub(crate) is_new: bool,
    /// Whether the hand has moved it yet.
    pub(crate) has_moved: bool,
    /// The model before.
    pub(crate) before: Model,
    /// The shapes at the beginning, with the new control in place.
    home: Model,
    energy_before: f64,
    steps_since_return: u32,
    /// Steps since the hand last moved.
    still: u32,
    /// Whether it has been given its shapes of before since then.
    is_home_again: bool,
    centre: DVec3,
    reach: f64,
}

impl Grab {
    /// Takes hold; a place on a curve or surface becomes a control point.
    pub(crate) fn begin(
        model: &mut Model,
        relaxer: &Relaxer,
        target: GrabTarget,
    ) -> Result<Self, ModelError> {
        let before = model.clone();
        let (centre, radius) = model.document.extent();
        let point = match target {
            GrabTarget::Point(point) => model.point(point).map(|_| point)?,
            GrabTarget::Curve { curve, at } => insert(model, curve, at)?,
            GrabTarget::Surface { surface, at } => pin(model, relaxer, surface, at)?,
        };
        let is_new = !matches!(target, GrabTarget::Point(_));
        let reach = REACH * if radius > 0.0 { radius } else { 1.0 };
        let home = model.clone();
        let steps_since_return = PATIENCE;
        Ok(Self {
            point,
            is_new,
            has_moved: false,
            before,
            home,
            energy_before: relaxer.energy(),
            steps_since_return,
            still: 0,
            is_home_again: false,
            centre,
            reach,
        })
    }

    /// A hand that shakes a surface hard enough crumples it, and a crumpled surface may stay so: its energy has other
    /// valleys. Then the shapes go back to what they were when the drag began, and are carried straight
    /// to where the hand is now. The same when the hand has brought the point home and waits there, and the shape has
    /// not become what it was by itself. Returns whether that was needed.
    pub(crate) fn rescue(&mut self, model: &mut Model, energy: f64, is_over: bool) -> bool {
        self.steps_since_return = self.steps_since_return.saturating_add(1);
        self.still = self.still.saturating_add(1);
        let is_wreck = energy.is_nan() || energy > WRECK_FACTOR * self.energy_before + WRECK_RISE;
        let is_other = (energy - self.energy_before).abs() > LOST * self.energy_before;
        // Once for each time that the hand comes to rest.
        let is_lost = is_other && self.still >= PATIENCE && !self.is_home_again && self.is_home(model);
        let is_due = self.steps_since_return >= PATIENCE || is_over;
        if !(is_lost || is_wreck && is_due) {
            return false;
        }
        self.steps_since_return = 0;
        self.is_home_again = is_lost;
        model.curves.clone_from(&self.home.curves);
        model.surfaces.clone_from(&self.home.surfaces);
        true
    }

    /// Whether the point is back where the drag took hold of it.
    fn is_home(&self, model: &Model) -> bool {
        let at = |model: &Model| model.document.points.get(&self.point).copied();
        self.has_moved && at(model) == at(&self.home)
    }

    /// Follows the hand. Returns how far the point was moved; nothing for what is not a position.
    pub(crate) fn follow(&mut self, model: &mut Model, to: DVec3) -> Option<f64> {
        if !to.is_finite() {
            return None;
        }
        // Divided before it is measured: the length of a huge vector would overflow.
        let offset = (to - self.centre) / self.reach;
        let to = if offset.abs().max_element() > 1.0 {
            let direction = offset / offset.abs().max_element();
            self.centre + direction.normalize_or_zero() * self.reach
        } else {
            to
        };
        let to = to.clamp(DVec3::splat(-MAX_COORDINATE), DVec3::splat(MAX_COORDINATE));
        let at = model.document_mut().points.get_mut(&self.point)?;
        let moved = (to - *at).length();
        *at = to;
        self.has_moved |= moved > 0.0;
        if moved > 0.0 {
            (self.still, self.is_home_again) = (0, false);
        }
        Some(moved)
    }

    /// Lets go: the position becomes one that a document keeps. Returns the name of the act.
    pub(crate) fn finish(&self, model: &mut Model) -> Result<&'static str, ModelError> {
        let at = model.point(self.point)?;
        let kept = kept_position(&self.before, at)?;
        model.document_mut().points.insert(self.point, kept);
        model.check_extents()?;
        Ok(if self.is_new { "Control point" } else { "Move" })
    }
}
