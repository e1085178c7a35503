//! A drag: from taking hold of something to letting it go. A whole drag is one act.
//!
//! What is held is a control point, or a direction at one (a handle), which the hand turns about it.
//! While it lasts, the document's position of the held point follows the hand, and the shapes follow the
//! document as they relax. A hand can ask for anything: what is not a number is ignored, what is far is
//! cut to a reach, and in the end the position is rounded to what a document keeps.

use crate::error::ModelError;
use crate::handle::{self, direction};
use crate::model::{Making, Model};
use crate::operation::{insert, kept_position, pin};
use crate::patch::caged;
use crate::relax::Relaxer;
use crate::skeleton::carry_free;
use ductile_spec::{GrabTarget, Handle, MAX_COORDINATE, PointId};
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
/// Digits of a direction that a document keeps after a drag: a unit vector is rounded to so many parts.
const DIRECTION_PARTS: f64 = 1e4;
/// Part of the reach by which a hand must be away from a point to say a direction.
const LEAST_ARM: f64 = 1e-6;
/// Steps that a shape at home has to find back by itself, and steps between two returns to the shape at the beginning of the drag.
const PATIENCE: u32 = 30;

/// A drag in progress.
#[derive(Clone, Debug)]
pub(crate) struct Grab {
    /// The control point that is held, or at which something is.
    pub(crate) point: PointId,
    /// The direction there that is held, if it is not the point itself.
    handle: Option<Handle>,
    /// All points that go with the hand and where they were, if it holds an edge or a face; the hand took hold at `anchor`.
    group: Vec<(PointId, DVec3)>,
    anchor: DVec3,
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
        let (group, anchor) = group(model, &target)?;
        let point = match target {
            GrabTarget::Point(point) => model.point(point).map(|_| point)?,
            GrabTarget::Curve { curve, at } => insert(model, curve, at)?,
            GrabTarget::Surface { surface, at } => pin(model, relaxer, surface, at)?,
            // A foot is no control point: `Pull` drags it.
            GrabTarget::Displace { .. } | GrabTarget::Foot { .. } => return Err(ModelError::NothingHeld),
            GrabTarget::Edge { .. } | GrabTarget::Face { .. } => {
                group.first().map(|(point, _)| *point).ok_or(ModelError::NothingHeld)?
            }
            GrabTarget::Handle(handle) => handle::foot(model, handle)?,
        };
        let is_new = matches!(target, GrabTarget::Curve { .. } | GrabTarget::Surface { .. });
        let handle = if let GrabTarget::Handle(handle) = target { Some(handle) } else { None };
        let reach = REACH * if radius > 0.0 { radius } else { 1.0 };
        let home = model.clone();
        let steps_since_return = PATIENCE;
        Ok(Self {
            point,
            handle,
            group,
            anchor,
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

    /// Where the hand is that took hold.
    pub(crate) fn hand(&self, model: &Model) -> DVec3 {
        let point = model.document.points.get(&self.point).copied();
        if self.group.is_empty() { point.unwrap_or(DVec3::ZERO) } else { self.anchor }
    }

    /// The points that follow it.
    pub(crate) fn points(&self) -> Vec<PointId> {
        if self.group.is_empty() {
            vec![self.point]
        } else {
            self.group.iter().map(|(point, _)| *point).collect()
        }
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

    /// Whether the shapes were just given back as they were, and rested so. Relaxed and improved once more a coarse mesh would
    /// go on to be another one.
    pub(crate) fn rests_at_home(&self) -> bool {
        self.is_home_again && !self.is_new && (self.before.rests || self.before.making == Making::Own)
    }

    /// Whether what is held is back where the drag took hold of it.
    fn is_home(&self, model: &Model) -> bool {
        let at = |model: &Model| match self.handle {
            None => model.document.points.get(&self.point).copied(),
            Some(handle) => direction(model, handle),
        };
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
        if let Some(handle) = self.handle {
            return self.turn(model, handle, to);
        }
        let kept = |to: DVec3| to.clamp(DVec3::splat(-MAX_COORDINATE), DVec3::splat(MAX_COORDINATE));
        let moved = if self.group.is_empty() {
            let at = model.document_mut().points.get_mut(&self.point)?;
            let to = kept(to);
            let moved = (to - *at).length();
            *at = to;
            moved
        } else {
            let mut most = 0.0_f64;
            for (point, home) in &self.group {
                let at = model.document_mut().points.get_mut(point)?;
                let to = kept(*home + (to - self.anchor));
                most = most.max((to - *at).length());
                *at = to;
            }
            most
        };
        self.has_moved |= moved > 0.0;
        if moved > 0.0 {
            (self.still, self.is_home_again) = (0, false);
        }
        Some(moved)
    }

    /// Turns the direction that is held towards the hand. Returns how far that would move something at a model's radius.
    fn turn(&mut self, model: &mut Model, handle: Handle, to: DVec3) -> Option<f64> {
        let arm = to - model.document.points.get(&self.point)?;
        let unit = arm.try_normalize().filter(|_| arm.length() > LEAST_ARM * self.reach)?;
        let unit = handle::possible(model, handle, unit)?;
        let before = direction(model, handle).map_or(DVec3::ZERO, DVec3::normalize_or_zero);
        let moved = (unit - before).length() * self.reach / REACH;
        if moved > 0.0 {
            handle::point_to(model, handle, unit);
            self.has_moved = true;
            (self.still, self.is_home_again) = (0, false);
        }
        Some(moved)
    }

    /// Lets go: the position becomes one that a document keeps. Returns the name of the act.
    pub(crate) fn finish(&self, model: &mut Model) -> Result<&'static str, ModelError> {
        if let Some(handle) = self.handle {
            let unit = direction(model, handle).unwrap_or(DVec3::X);
            handle::point_to(model, handle, (unit * DIRECTION_PARTS).round() / DIRECTION_PARTS);
            model.document.validate()?;
            return Ok(handle::act(handle));
        }
        let one = [(self.point, DVec3::ZERO)];
        for (point, _) in if self.group.is_empty() { &one[..] } else { &self.group } {
            let kept = kept_position(&self.before, model.point(*point)?)?;
            model.document_mut().points.insert(*point, kept);
        }
        carry_free(&self.home.document, model.document_mut());
        model.check_extents()?;
        // What it leaves could be opened again, but not be filled.
        for fill in model.document.fills.keys().filter(|fill| self.before.check_fill(**fill).is_ok()) {
            model.check_fill(*fill)?;
        }
        Ok(if self.is_new { "Control point" } else { "Move" })
    }
}

/// The corners of an edge or a face of a cage with their places, and where the hand takes hold of it; no corners for other
/// targets.
fn group(model: &Model, target: &GrabTarget) -> Result<(Vec<(PointId, DVec3)>, DVec3), ModelError> {
    let (points, at) = match target {
        GrabTarget::Edge { surface, ends, at } => {
            let cage = caged(&model.document, *surface, "Dragging an edge")?;
            let [a, b] = *ends;
            if !cage.edges().contains(&[a.min(b), a.max(b)]) {
                return Err(ModelError::NoEdge { surface: *surface, ends: *ends });
            }
            (ends.to_vec(), *at)
        }
        GrabTarget::Face { surface, face, at } => {
            let faces = &caged(&model.document, *surface, "Dragging a face")?.faces;
            let no_face = ModelError::NoFace { surface: *surface, face: *face, count: faces.len() };
            (faces.get(*face as usize).ok_or(no_face)?.clone(), *at)
        }
        _ => return Ok((Vec::new(), DVec3::ZERO)),
    };
    if !at.to_array().iter().all(|x| x.is_finite() && x.abs() <= MAX_COORDINATE) {
        return Err(ModelError::BadPosition);
    }
    let place = |point: PointId| Ok((point, model.point(point)?));
    Ok((points.into_iter().map(place).collect::<Result<_, ModelError>>()?, at))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::example::example;
    use crate::shape::edit;
    use ductile_spec::{Example, SurfaceId};
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    fn places(model: &Model) -> Vec<DVec3> {
        model.surfaces[&SurfaceId(1)].positions.clone()
    }

    /// Something that a drag made of the disc.
    fn crumple(model: &mut Model) {
        let shape = edit(model.surfaces.get_mut(&SurfaceId(1)).unwrap());
        shape.positions.iter_mut().for_each(|at| at.z += 1.0);
    }

    #[test]
    fn a_wreck_returns_to_the_beginning_of_its_drag_at_most_every_thirty_steps_but_always_at_its_end() {
        let mut model = Model::from_document(example(Example::Disc)).unwrap();
        let mut relaxer = Relaxer::default();
        relaxer.bind(&model);
        let mut grab = Grab::begin(&mut model, &relaxer, GrabTarget::Point(PointId(1))).unwrap();
        let home = places(&model);
        let away = model.point(PointId(1)).unwrap() + DVec3::Z;
        assert_eq!(grab.follow(&mut model, away), Some(1.0));
        let (fair, wreck) = (WRECK_RISE - 1.0, WRECK_FACTOR * relaxer.energy() + WRECK_RISE + 1.0);
        crumple(&mut model);
        assert!(!grab.rescue(&mut model, fair, false) && !grab.rescue(&mut model, fair, true));
        assert_ne!(places(&model), home);
        for energy in [wreck, f64::NAN] {
            assert!(grab.rescue(&mut model, energy, false));
            assert_eq!(places(&model), home);
            crumple(&mut model);
            // It is given time to find a shape on the way to the hand.
            assert!((1..PATIENCE).all(|_| !grab.rescue(&mut model, energy, false)));
        }
        assert!(grab.rescue(&mut model, wreck, true));
        assert_eq!(places(&model), home);
        // The hand is where it was: the document follows it, only the shapes went back.
        assert_eq!(model.point(PointId(1)), Ok(away));
    }
}
