//! Displacements in the page: the tool that pulls the inside of surfaces, its feet, and what the properties show of them.

use super::dom;
use super::menu;
use super::page::{Page, act};
use crate::input::Modifiers;
use crate::pick::{Line, pick_line};
use crate::tool::{Drag, Selection, ToolKind, span};
use crate::{Highlight, Hit, Wanted, pick_among};
use ductile_spec::{
    Blend, Blending, Combination, CurveRole, CurveSpan, Displaced, Displacement, Displacing, Edit, Foot,
    GrabTarget, Hold, Profile, Pulled, Request, SurfaceId,
};
use glam::{Vec2, Vec3};

const PROFILE: &str = "displaced-profile";
const COMBINATION: &str = "displaced-combination";
const BLEND: &str = "displaced-blend";

/// What a pin holds around it, as a part of the surface's radius.
const PIN: f64 = 0.1;

/// A foot in the picture.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct FootMark {
    pub(crate) surface: SurfaceId,
    pub(crate) number: usize,
    pub(crate) at: Vec3,
    /// The way of a curve; of a place only that.
    pub(crate) course: Vec<Vec3>,
}

/// Fills the selects and listens to them.
pub(crate) fn listen() {
    menu::fill(PROFILE, ["Conformal", "Harmonic"], |place| {
        let profile = if place == Some(1) { Profile::Harmonic } else { Profile::Conformal };
        act(move |page| page.blend_otherwise(|blending| blending.profile = profile));
    });
    menu::fill(COMBINATION, ["Exact at every foot", "Plain sum"], |place| {
        let combination = if place == Some(1) { Combination::Plain } else { Combination::Pairwise };
        act(move |page| page.blend_otherwise(|blending| blending.combination = combination));
    });
    menu::fill(BLEND, ["Expo-rational", "Bump", "Eta"], |place| {
        let blend = match place {
            Some(1) => Blend::Bump(1.0),
            Some(2) => Blend::Eta(0.1),
            _ => Blend::Erbs,
        };
        act(move |page| page.blend_otherwise(|blending| blending.blend = blend));
    });
}

impl Page {
    /// The feet that can be taken: with the tool in hand all, else none.
    fn feet(&self) -> Vec<FootMark> {
        if self.tools.kind() == ToolKind::Displace { self.all_feet() } else { Vec::new() }
    }

    /// All feet of the model.
    pub(crate) fn all_feet(&self) -> Vec<FootMark> {
        let mut marks: Vec<FootMark> = Vec::new();
        for foot in self.scene.structure.feet.iter().filter(|_| self.scene.has_frame()) {
            let (surface, number) = (foot.surface, foot.number as usize);
            let at = self.scene.vertex(foot.vertex);
            let is_apart = self.foot_of(surface, number).is_some_and(|foot| foot.curve().is_none());
            match marks.last_mut() {
                Some(last) if !is_apart && (last.surface, last.number) == (surface, number) => {
                    last.course.push(at);
                }
                _ => marks.push(FootMark { surface, number, at, course: vec![at] }),
            }
        }
        for mark in &mut marks {
            let curve = match self.foot_of(mark.surface, mark.number) {
                Some(foot) => foot.curve(),
                None => self.begun().and_then(|begun| begun.along),
            };
            let is_closed = |id| self.document.curves.get(&id).is_some_and(|curve| curve.closed);
            if curve.is_some_and(is_closed) {
                mark.course.push(mark.at);
            }
        }
        marks
    }

    /// The foot of a displacement. One that a drag has just made is not in the document yet.
    fn foot_of(&self, surface: SurfaceId, number: usize) -> Option<&Foot> {
        let item = self.displaced(surface)?.items.get(number.checked_sub(1)?)?;
        Some(&item.foot)
    }

    /// What the drag under way has begun.
    fn begun(&self) -> Option<Displacing> {
        match self.hand.drag?.target() {
            GrabTarget::Displace(begun) => Some(begun),
            _ => None,
        }
    }

    /// The foot under the pointer, and where it is taken.
    pub(crate) fn foot_at(&self, at: Vec2) -> Option<(FootMark, Vec3)> {
        let reach = self.hand.reach();
        let (curves, places): (Vec<_>, Vec<_>) =
            self.feet().into_iter().partition(|foot| foot.course.len() > 1);
        let distance = |foot: &FootMark| self.camera.project(foot.at).map(|place| place.distance(at));
        let near = places.into_iter().filter_map(|foot| Some((distance(&foot)?, foot)));
        let near = near.filter(|(distance, _)| *distance <= reach);
        near.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, foot)| (foot.clone(), foot.at)).or_else(|| {
            let lines = curves.iter().map(|foot| Line { places: foot.course.clone(), closed: false });
            let (found, place) = pick_line(&self.scene, &self.camera, at, reach, lines)?;
            Some((curves.get(found)?.clone(), place))
        })
    }

    /// What the tool takes at a place: a curve inside a fair surface, or a place of any.
    pub(crate) fn displaceable_at(&self, at: Vec2, below: Wanted) -> Option<Hit> {
        let spans = &self.scene.structure.curves;
        let curves: Vec<_> =
            spans.iter().filter(|span| self.canvas_of(span).is_some() && below.curves).collect();
        let lines = curves
            .iter()
            .map(|span| Line { places: self.scene.samples(span.id).collect(), closed: span.closed });
        let found = pick_line(&self.scene, &self.camera, at, self.hand.reach(), lines);
        let curve = found.and_then(|(found, at)| Some(Hit::Curve { id: curves.get(found)?.id, at }));
        curve.or_else(|| pick_among(&self.scene, &self.camera, at, 0.0, Wanted { curves: false, ..below }))
    }

    /// The fair surface inside of which a curve runs that is not displaced with it yet.
    fn canvas_of(&self, span: &CurveSpan) -> Option<SurfaceId> {
        let surface = self.document.surfaces_on(span.id).next().filter(|_| span.role == CurveRole::Inner)?;
        let is_foot =
            self.displaced(surface).is_some_and(|displaced| displaced.curves().any(|id| id == span.id));
        (!is_foot).then_some(surface)
    }

    /// The displacement that a drag of what was hit would begin.
    pub(super) fn displacing(&self, hit: &Hit) -> Option<Displacing> {
        let (surface, along) = match *hit {
            Hit::Surface { id, .. } => (id, None),
            Hit::Curve { id, .. } => (self.canvas_of(span(&self.scene.structure, id)?)?, Some(id)),
            _ => return None,
        };
        let around = self.tools.options().around;
        let (range, direction) = (around.range, around.direction());
        Some(Displacing { surface, at: hit.at().as_dvec3(), along, range, direction })
    }

    /// Takes hold of a foot, or of what becomes one; says whether the tool in hand does that.
    pub(crate) fn grab_foot(&mut self, at: Vec2) -> bool {
        if self.tools.kind() != ToolKind::Displace {
            return false;
        }
        let (target, anchor, trial) = match (self.foot_at(at), self.thing_at(at)) {
            (Some((foot, place)), _) => {
                let target = GrabTarget::Foot { surface: foot.surface, number: foot.number };
                (target, place, self.trial_of(&foot))
            }
            (None, hit) => match hit.and_then(|hit| Some((self.displacing(&hit)?, hit.at()))) {
                Some((begun, place)) => (GrabTarget::Displace(begun), place, Some(begun)),
                None => return true,
            },
        };
        // What it moves stays tinted in the drag.
        if let Some(question) = trial.and_then(|trial| self.reaching.want_now(trial)) {
            self.schedule.push(question);
        }
        self.hold(Drag::of_place(target, anchor, at), at);
        true
    }

    /// The modeler says which foot is held.
    pub(crate) fn pulled(&mut self, pulled: Pulled) {
        self.choose_foot(pulled.surface, pulled.number);
        if let Some(drag) = &mut self.hand.drag {
            drag.set_origin(pulled.at);
            self.follow_cursor();
        }
    }

    fn choose_foot(&mut self, surface: SurfaceId, number: usize) {
        self.selection = Selection::Surface(surface);
        self.chosen_foot = Some((surface, number));
    }

    /// A click with the tool: chooses a foot or a surface; with Shift, pins a place or frees it.
    pub(crate) fn click_displacing(&mut self, at: Vec2, modifiers: Modifiers) -> bool {
        if self.tools.kind() != ToolKind::Displace {
            return false;
        }
        let place = if modifiers.ctrl || modifiers.shift { self.below(at) } else { None };
        match (self.foot_at(at), place.or_else(|| self.thing_at(at))) {
            (Some((foot, _)), _) => self.choose_foot(foot.surface, foot.number),
            (None, Some(Hit::Surface { id, at, .. })) if modifiers.ctrl => self.add_foot(id, at),
            (None, Some(Hit::Surface { id, at, .. })) if modifiers.shift => self.pin_place(id, at),
            (None, hit) => {
                self.selection = Selection::of(hit.as_ref());
                self.chosen_foot = None;
            }
        }
        self.refresh();
        true
    }

    /// Lets a place move with the chosen displacement.
    fn add_foot(&mut self, surface: SurfaceId, at: Vec3) {
        match self.chosen_foot {
            Some((own, number)) if own == surface => {
                self.request(Request::Edit(Edit::AddFoot { surface, number, at: at.as_dvec3() }));
            }
            _ => self
                .notices
                .refusal("Click a foot of this surface first; Ctrl-click lets places move with it."),
        }
    }

    /// Pins a place, or frees the pin that holds it.
    fn pin_place(&mut self, surface: SurfaceId, at: Vec3) {
        let radius = f64::from(self.scene.ball_of(surface).map_or(1.0, |(_, radius)| radius)) * PIN;
        let radius = format!("{radius:.1e}").parse().unwrap_or(radius);
        let at = at.as_dvec3();
        let holds =
            |pin: &Hold| matches!(pin, Hold::Around { at: pin, radius } if pin.distance(at) <= *radius);
        let mut blending =
            self.displaced(surface).map(|displaced| displaced.blending.clone()).unwrap_or_default();
        let before = blending.pins.len();
        blending.pins.retain(|pin| !holds(pin));
        if blending.pins.len() == before {
            blending.pins.push(Hold::Around { at, radius });
        }
        self.selection = Selection::Surface(surface);
        self.request(Request::Edit(Edit::Blending { surface, blending }));
    }

    /// The feet, the chosen one with its way, and how far the tool would reach.
    pub(crate) fn mark_displacements(&self, mark: &mut Highlight) {
        if self.tools.kind() != ToolKind::Displace {
            return;
        }
        for foot in self.feet() {
            match foot.course.len() {
                1 => mark.ghost.push(foot.at),
                _ => mark.sketch.push(foot.course),
            }
        }
        if let Some((foot, item)) = self.chosen_item() {
            mark.arms.push((foot.at - item.by.as_vec3(), foot.at, self.hand.drag.is_some()));
        }
        let over = self.hand.cursor.and_then(|at| self.foot_at(at)).filter(|_| self.hand.drag.is_none());
        if let Some((over, _)) = over {
            mark.hover = None;
            let item =
                self.displaced(over.surface).and_then(|displaced| displaced.items.get(over.number - 1));
            let by = item.map_or(Vec3::ZERO, |item| item.by.as_vec3());
            mark.arms.push((over.at - by, over.at, true));
            mark.ghost_line = over.course;
        } else if let Some(trial) = self.trial() {
            mark.sketch.extend_from_slice(self.reaching.lines(trial.surface));
        }
        let is_held = self.hand.drag.is_some();
        let pointed = if is_held {
            self.chosen_foot.map(|(surface, _)| surface)
        } else {
            self.trial().map(|t| t.surface)
        };
        mark.influence = self.reaching.influence(is_held).filter(|(surface, _)| Some(*surface) == pointed);
    }

    pub(super) fn displaced(&self, surface: SurfaceId) -> Option<&Displaced> {
        self.document.displacements.get(&surface)
    }

    /// The chosen displacement: where its foot is, and what the document says of it.
    pub(super) fn chosen_item(&self) -> Option<(FootMark, &Displacement)> {
        let (surface, number) = self.chosen_foot?;
        let item = self.displaced(surface)?.items.get(number.checked_sub(1)?)?;
        let foot =
            self.all_feet().into_iter().find(|foot| (foot.surface, foot.number) == (surface, number))?;
        Some((foot, item))
    }

    /// Whether a displacement is chosen with the tool in hand.
    pub(crate) fn has_chosen_foot(&self) -> bool {
        self.tools.kind() == ToolKind::Displace && self.chosen_foot.is_some()
    }

    /// The choice of a foot is forgotten with the foot, and with the selection of its surface.
    pub(crate) fn refresh_chosen_foot(&mut self) {
        let is_there = self.chosen_foot.is_some_and(|(surface, number)| {
            let count = self.displaced(surface).map_or(0, |displaced| displaced.items.len());
            // One that was just made is in the document when the answer to the end of its drag has come.
            let is_coming = self.hand.drag.is_some() || !self.schedule.is_at_rest();
            self.selection == Selection::Surface(surface) && (number <= count || is_coming)
        });
        self.chosen_foot = self.chosen_foot.filter(|_| is_there);
    }

    /// Erases the chosen displacement; says whether one was chosen.
    pub(crate) fn erase_chosen(&mut self) -> bool {
        let Some((surface, number)) = self.chosen_foot else { return false };
        self.request(Request::Edit(Edit::EraseDisplacement { surface, number }));
        self.chosen_foot = None;
        true
    }

    /// What the buttons of the properties ask for.
    pub(crate) fn displacement_command(&mut self, command: &str, subject: Option<&str>) -> bool {
        let Selection::Surface(surface) = self.selection else { return false };
        match command {
            "choose-displacement" => {
                let number = subject.and_then(|number| number.parse().ok());
                self.chosen_foot = number.map(|number| (surface, number));
            }
            "erase-displacement" => drop(self.erase_chosen()),
            "bake" => self.request(Request::Edit(Edit::Bake { surface })),
            "drop-displacements" => self.request(Request::Edit(Edit::DropDisplacements { surface })),
            "unpin" => self.blend_otherwise(|blending| blending.pins.clear()),
            _ => return false,
        }
        true
    }

    fn blend_otherwise(&mut self, change: impl FnOnce(&mut Blending)) {
        let Selection::Surface(surface) = self.selection else { return };
        let before = self.displaced(surface).map(|displaced| displaced.blending.clone()).unwrap_or_default();
        let mut blending = before.clone();
        change(&mut blending);
        if blending != before {
            self.request(Request::Edit(Edit::Blending { surface, blending }));
        }
    }

    /// Shows the displacements of the selected surface.
    pub(crate) fn show_displacements(&mut self) {
        self.refresh_chosen_foot();
        let surface = match self.selection {
            Selection::Surface(id) => Some(id),
            _ => None,
        };
        let displaced = surface.and_then(|id| self.displaced(id)).cloned();
        let is_shown = displaced.is_some() || surface.is_some() && self.tools.kind() == ToolKind::Displace;
        dom::show(&dom::element("displaced-properties"), is_shown);
        let displaced = displaced.unwrap_or_default();
        let list = dom::element("displaced-list");
        dom::clear(&list);
        for number in 1..=displaced.items.len() {
            let button = dom::command_button("chip", &number.to_string(), "choose-displacement");
            dom::attribute(&button, "data-subject", &number.to_string());
            dom::attribute(&button, "aria-label", &format!("Displacement {number}"));
            let is_chosen = self.chosen_foot.is_some_and(|(_, chosen)| chosen == number);
            dom::attribute(&button, "aria-pressed", if is_chosen { "true" } else { "false" });
            dom::append(&list, [&button]);
        }
        dom::show(&dom::element("displaced-item"), self.chosen_item().is_some());
        self.show_reach();
        self.ask_reach();
        let has_items = !displaced.items.is_empty();
        dom::show(&dom::element("drop-displacements"), has_items || !displaced.blending.pins.is_empty());
        dom::show(&dom::element("bake"), has_items);
        dom::show(&dom::element("erase-displacement"), self.chosen_item().is_some());
        dom::show(&dom::element("unpin"), !displaced.blending.pins.is_empty());
        let Blending { profile, combination, blend, .. } = displaced.blending;
        menu::show(PROFILE, Some(usize::from(profile == Profile::Harmonic)), None);
        menu::show(COMBINATION, Some(usize::from(combination == Combination::Plain)), None);
        let place = match blend {
            Blend::Erbs => 0,
            Blend::Bump(_) => 1,
            Blend::Eta(_) => 2,
        };
        menu::show(BLEND, Some(place), None);
    }
}
