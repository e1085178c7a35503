//! What gestures do: to the tools, to what is held, to the eye.

use super::dom;
use super::page::Page;
use crate::input::{Button, Gesture, Modifiers, Pointer, Recogniser};
use crate::tool::{
    Act, Aim, Arm, Drag, Place, Selection, Stroke, Surroundings, ToolKind, entry, grid_step, handles_along,
    handles_at, work_plane,
};
use crate::{Hit, Pose, RimHit, View, Wanted, pick, pick_among};
use ductile_spec::{Edit, GrabTarget, PointRole, Request};
use glam::{Vec2, Vec3};

/// How near the pointer must come to a point or a curve, in CSS pixels: a mouse, a fingertip.
const REACH: f32 = 9.0;
const FINGER_REACH: f32 = 20.0;
/// A model that is brought into view keeps clear of what floats at the edges.
pub(crate) const MARGIN: f32 = 1.14;
/// How near to a corner of a curve under way.
const CORNER_REACH: f32 = 12.0;

/// The hand on the canvas.
#[derive(Debug, Default)]
pub(crate) struct Hand {
    recogniser: Recogniser,
    pub(crate) drag: Option<Drag>,
    /// A curve that is being sketched.
    pub(crate) stroke: Option<Stroke>,
    pub(crate) cursor: Option<Vec2>,
    pub(crate) modifiers: Modifiers,
    pub(crate) hover: Option<Hit>,
    pub(crate) hover_arm: Option<Arm>,
    pub(crate) hover_rim: Option<RimHit>,
    pub(crate) hover_view: Option<View>,
    pub(crate) hover_is_stale: bool,
    /// Why the tube that is shown has no room, as the hint says it.
    pub(crate) no_tube: Option<&'static str>,
    pub(crate) is_finger: bool,
    pivot: Vec3,
}

impl Hand {
    /// What is pressed means nothing any more.
    pub(crate) fn forget(&mut self) {
        self.drag = None;
        self.stroke = None;
        self.recogniser.abandon();
    }

    pub(crate) fn reach(&self) -> f32 {
        if self.is_finger { FINGER_REACH } else { REACH }
    }
}

impl Page {
    /// A button or finger goes down on the canvas.
    pub(crate) fn pointer_down(&mut self, pointer: Pointer, button: Button) {
        self.hand.cursor = Some(pointer.at);
        self.hand.modifiers = pointer.modifiers;
        let on_triad = self.shows_triad() && self.camera.triad_hit(pointer.at).is_some();
        let is_thing = || self.foot_at(pointer.at).is_some() || self.thing_at(pointer.at).is_some();
        let draws = || self.tools.sketches() && self.thing_at(pointer.at).is_some();
        let turns = || self.tools.turns() && self.arm_at(pointer.at).is_some();
        let holds = !on_triad && (turns() || draws() || self.tools.holds() && is_thing());
        let gestures = self.hand.recogniser.down(pointer, button, holds);
        self.run(gestures);
    }

    /// A pointer moves over the canvas.
    pub(crate) fn pointer_moved(&mut self, pointer: Pointer, pressed: bool) {
        self.hand.modifiers = pointer.modifiers;
        let gestures = self.hand.recogniser.moved(pointer, pressed);
        self.run(gestures);
    }

    /// A button or finger goes up.
    pub(crate) fn pointer_up(&mut self, pointer: Pointer) {
        let gestures = self.hand.recogniser.up(pointer);
        self.run(gestures);
    }

    /// The browser takes a pointer away, or its capture was lost.
    pub(crate) fn pointer_lost(&mut self, id: i32) {
        let gestures = self.hand.recogniser.cancelled(id);
        self.run(gestures);
    }

    /// The pointer leaves the canvas.
    pub(crate) fn pointer_left(&mut self) {
        if !self.hand.recogniser.is_busy() {
            self.hand.cursor = None;
            self.hand.hover_is_stale = true;
            self.redraw();
        }
    }

    /// The wheel turns.
    pub(crate) fn wheel(&mut self, at: Vec2, by: Vec2, modifiers: Modifiers) {
        if !self.turn_radius(by, modifiers) && !self.turn_range(by, modifiers) {
            self.run(Recogniser::wheel(at, by, modifiers));
        }
    }

    /// Gives up a drag; says whether there was one.
    pub(crate) fn abandon_drag(&mut self) -> bool {
        let had = self.hand.drag.is_some() || self.hand.stroke.is_some();
        let gestures = self.hand.recogniser.abandon();
        self.run(gestures);
        had
    }

    fn run(&mut self, gestures: impl IntoIterator<Item = Gesture>) {
        for gesture in gestures {
            self.meant(gesture);
        }
        self.hand.hover_is_stale = true;
        self.redraw();
    }

    fn meant(&mut self, gesture: Gesture) {
        match gesture {
            Gesture::Hover(at) => self.hand.cursor = Some(at),
            Gesture::Click { at, modifiers } => self.clicked(at, modifiers),
            Gesture::DoubleClick { at } => self.double_clicked(at),
            Gesture::Grab { at } => self.grab(at),
            Gesture::Drag { at, modifiers } => {
                self.hand.cursor = Some(at);
                self.hand.modifiers = modifiers;
                self.sketch(at);
                self.follow_cursor();
            }
            Gesture::Drop if self.hand.stroke.is_some() => self.end_sketch(),
            Gesture::Abandon if self.hand.stroke.take().is_some() => self.refresh(),
            Gesture::Drop => {
                self.schedule.drop_held();
                self.hand.drag = None;
                self.refresh();
            }
            Gesture::Abandon => {
                self.schedule.cancel_held();
                self.hand.drag = None;
                self.notices.say("Everything is back where it was.");
                self.refresh();
            }
            Gesture::OrbitFrom(at) => {
                self.hand.pivot = self.place_under(at);
            }
            Gesture::Orbit(by) => self.camera.orbit(self.hand.pivot, by),
            Gesture::Pan { by, at } => {
                let under = self.place_under(at);
                self.camera.pan(under, by);
            }
            Gesture::Zoom { at, factor } => match self.thing_at(at) {
                Some(hit) => self.camera.zoom_about(hit.at(), factor),
                None => self.camera.zoom_to(at, factor),
            },
            Gesture::Undo => self.request(Request::Undo),
            Gesture::Redo => self.request(Request::Redo),
        }
    }

    /// What a press at a place would take.
    pub(crate) fn thing_at(&self, at: Vec2) -> Option<Hit> {
        let wanted = self.wanted();
        let among = |wanted| pick_among(&self.scene, &self.camera, at, self.hand.reach(), wanted);
        match self.tools.kind() {
            // It is about curves: their points do not stand before them.
            ToolKind::Ribbon => among(Wanted { points: false, ..wanted }).or_else(|| among(wanted)),
            // Points that are no corners do not stand before the curve.
            ToolKind::Fill => match among(wanted) {
                Some(Hit::Point { id, .. }) if !self.tools.could_be_corner(&self.document, id) => {
                    among(Wanted { points: false, ..wanted })
                }
                hit => hit,
            },
            ToolKind::Displace => self.displaceable_at(at, wanted),
            _ => self.cage_part_at(at, among(wanted)),
        }
    }

    /// The surface under the pointer, whatever lies on it.
    pub(crate) fn below(&self, at: Vec2) -> Option<Hit> {
        let below = Wanted { points: false, curves: false, ..Wanted::ALL };
        pick_among(&self.scene, &self.camera, at, 0.0, below)
    }

    /// What the tool in hand could take, among what is shown.
    fn wanted(&self) -> Wanted {
        let look = &self.settings.look;
        let kind = self.tools.kind();
        Wanted {
            points: look.skeleton && kind.wants_points(),
            curves: look.skeleton && kind.wants_curves(),
            surfaces: look.surface && kind.wants_surfaces(),
            hidden: kind.sees_through(),
            except: None,
        }
    }

    /// The thing under the pointer, or the middle of the model.
    fn place_under(&self, at: Vec2) -> Vec3 {
        if let Some(hit) = pick(&self.scene, &self.camera, at, self.hand.reach()) {
            return hit.at();
        }
        let centre = self.scene.bounds().map_or(Vec3::ZERO, |(centre, _)| centre);
        if self.camera.project(centre).is_some() { centre } else { self.camera.pose().centre }
    }

    /// The step of the grid that suits the model.
    pub(crate) fn grid(&self) -> f64 {
        grid_step(self.scene.bounds().map_or(1.0, |(_, radius)| radius))
    }

    fn clicked(&mut self, at: Vec2, modifiers: Modifiers) {
        if self.shows_triad()
            && let Some(view) = self.camera.triad_hit(at)
        {
            let pose = self.camera.pose_from(view);
            self.fly_to(pose);
            return;
        }
        if self.tools.turns() && self.arm_at(at).is_some() {
            // A handle is there to be dragged; what lies below it is not meant.
            return;
        }
        if self.click_displacing(at, modifiers) {
            return;
        }
        let hit = self.thing_at(at);
        let surface_beside = self.surface_at(at, hit.as_ref());
        self.meant = surface_beside;
        self.picked = match hit {
            Some(Hit::Surface { id, at, .. }) => Some((id, at)),
            _ => None,
        };
        let aim = Aim {
            hit: hit.as_ref(),
            place: self.place_on_plane(at, modifiers),
            corner: self.corner_at(at),
            surface: surface_beside,
            rim: self.rim_at(at).map(|rim| Place { surface: rim.surface, at: rim.at, normal: None }),
        };
        self.click_with(aim);
    }

    /// Gives a click to the tool in hand, and does what it wants done.
    pub(crate) fn click_with(&mut self, aim: Aim<'_>) {
        if let (ToolKind::Ribbon, Some(Hit::Point { id, .. })) = (self.tools.kind(), aim.hit) {
            self.take_normal(*id);
            return;
        }
        let radius = self.suited_radius();
        let (structure, document) = (&self.scene.structure, &self.document);
        let size = self.suited_size();
        let around = Surroundings { structure, document, forward: self.camera.forward(), radius, size };
        let acts = self.tools.click(aim, around);
        self.perform(acts);
    }

    fn double_clicked(&mut self, at: Vec2) {
        if self.tools.kind() == ToolKind::Cage {
            // The first click has placed a cage: a second one in the same place is not meant.
            return;
        }
        if self.tools.kind() != ToolKind::Shape {
            self.clicked(at, self.hand.modifiers);
            return;
        }
        match self.thing_at(at) {
            Some(Hit::Point { id, .. }) => {
                let role = entry(&self.scene.structure, id).map(|entry| entry.role);
                if role.is_some_and(|role| role != PointRole::Free) {
                    self.request(Request::Edit(Edit::Release { point: id }));
                }
            }
            Some(hit) => {
                let pose = self.camera.pose_that_focuses(hit.at());
                self.fly_to(pose);
            }
            None => self.fit_all(),
        }
    }

    /// The handles of the selected point or curve; the one that is held ends where the hand is.
    pub(crate) fn arms(&self) -> Vec<Arm> {
        if !self.settings.look.skeleton || self.tools.kind() == ToolKind::Displace {
            return Vec::new();
        }
        let at = |point| handles_at(&self.document, point).into_iter();
        let handles = match self.selection {
            Selection::Point(point) => at(point).map(|(handle, way)| (handle, point, way)).collect(),
            Selection::Curve(curve) => handles_along(&self.document, curve),
            _ => Vec::new(),
        };
        let arm = |(handle, point, direction)| {
            let arm = Arm::new(handle, self.scene.point(point)?, direction, &self.camera);
            let held = self.hand.drag.filter(|drag| drag.target() == GrabTarget::Handle(handle));
            let place = held.zip(self.hand.cursor).and_then(|(drag, cursor)| {
                drag.place(&self.camera, cursor, self.hand.modifiers, self.grid())
            });
            Some(Arm { end: place.map_or(arm.end, |place| place.as_vec3()), ..arm })
        };
        handles.into_iter().filter_map(arm).collect()
    }

    /// The handle that a press at a place would take.
    pub(crate) fn arm_at(&self, at: Vec2) -> Option<Arm> {
        Arm::nearest(&self.arms(), &self.camera, at, self.hand.reach())
    }

    fn grab(&mut self, at: Vec2) {
        if self.tools.sketches() {
            self.hand.stroke = Some(Stroke::default());
            self.sketch(at);
            return;
        }
        if self.grab_foot(at) {
            return;
        }
        if let Some(arm) = self.arm_at(at) {
            let drag = arm.drag(at);
            self.schedule.grab(drag.target());
            self.hand.drag = Some(drag);
            self.refresh();
            return;
        }
        if let Some(hit) = self.thing_at(at) {
            self.hold(Drag::begin(&hit, at), at);
        }
    }

    /// A drag begins.
    pub(crate) fn hold(&mut self, mut drag: Drag, at: Vec2) {
        if let Some(Hit::Surface { normal, .. }) = self.below(at) {
            drag.set_normal(Some(normal));
        }
        self.schedule.grab(drag.target());
        self.hand.drag = Some(drag);
        self.panel.welcome_is_over = true;
        self.refresh();
    }

    /// The held thing goes where the pointer is.
    pub(crate) fn follow_cursor(&mut self) {
        let (Some(drag), Some(cursor)) = (&self.hand.drag, self.hand.cursor) else { return };
        if let Some(place) = drag.place(&self.camera, cursor, self.hand.modifiers, self.grid()) {
            self.schedule.drag_to(place);
        }
    }

    /// The place on the work plane under the pointer, on the grid with Ctrl.
    pub(crate) fn place_on_plane(&self, at: Vec2, modifiers: Modifiers) -> Option<Vec3> {
        let plane = work_plane(self.camera.forward());
        let place = self.camera.ray(at).meets_plane(plane.origin, plane.normal())?;
        let far = 50.0 * self.camera.pose().distance;
        if !place.is_finite() || place.distance(self.camera.eye()) > far {
            return None;
        }
        if !modifiers.ctrl {
            return Some(place);
        }
        let grid = self.grid();
        Some(((place.as_dvec3() / grid).round() * grid).as_vec3())
    }

    pub(crate) fn corner_at(&self, at: Vec2) -> Option<usize> {
        let near = |corner: &crate::tool::Corner| {
            self.camera.project(corner.at).is_some_and(|place| place.distance(at) < CORNER_REACH)
        };
        self.tools.corners().iter().position(near)
    }

    /// Does what a tool wants done.
    pub(crate) fn perform(&mut self, acts: Vec<Act>) {
        for act in acts {
            match act {
                Act::Edit(edit) => self.request(Request::Edit(edit)),
                Act::Select(selection) => self.selection = selection,
                Act::Say(text) => self.notices.refusal(&text),
                Act::Leave => self.tools.choose(ToolKind::Shape),
            }
        }
        self.refresh();
    }

    /// Brings everything into view.
    pub(crate) fn fit_all(&mut self) {
        if let Some((centre, radius)) = self.scene.bounds() {
            let pose = self.camera.pose_that_fits(centre, MARGIN * radius);
            self.fly_to(pose);
        }
    }

    /// Goes to a pose, in flight unless the designer wants no motion.
    pub(crate) fn fly_to(&mut self, pose: Pose) {
        if dom::media("(prefers-reduced-motion: reduce)") {
            self.camera.set_pose(pose);
        } else {
            self.camera.fly_to(pose, dom::now());
        }
        self.redraw();
    }

    /// Finds out what lies under the pointer, if it may have changed.
    pub(crate) fn update_hover(&mut self) {
        if !std::mem::take(&mut self.hand.hover_is_stale) {
            return;
        }
        self.hand.hover = None;
        self.hand.hover_view = None;
        self.hand.hover_arm = None;
        self.hand.hover_rim = None;
        let Some(at) = self.hand.cursor else { return };
        if self.hand.recogniser.is_busy() || self.hand.is_finger {
            return;
        }
        self.hand.hover_view = self.camera.triad_hit(at).filter(|_| self.shows_triad());
        if self.hand.hover_view.is_none() {
            self.hand.hover_arm = self.arm_at(at).filter(|_| self.tools.turns());
        }
        if self.hand.hover_view.is_none() && self.hand.hover_arm.is_none() {
            let kind = self.tools.kind();
            self.hand.hover = self
                .thing_at(at)
                .filter(|hit| kind.takes(hit, &self.scene.structure) && self.could_divide(hit));
            self.hand.hover_rim = self.rim_at(at);
        }
        self.ask_meeting();
        self.ask_loop();
        self.ask_reach();
    }
}
