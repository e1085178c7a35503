//! Displacements in the page: the tool that pulls the inside of surfaces, its feet, and their numbers in the properties.

use super::dom;
use super::menu;
use super::page::{Page, act};
use crate::input::Modifiers;
use crate::number;
use crate::tool::{Drag, Selection, ToolKind};
use crate::{Highlight, Hit};
use ductile_spec::{
    Blend, Blending, Combination, Displaced, Displacement, Edit, GrabTarget, Hold, LEAST_RANGE, MOST_RANGE,
    Profile, Pulled, Request, SurfaceId,
};
use glam::{Vec2, Vec3};

/// The field of the tool's range, and those of the chosen displacement, in index.html.
pub(crate) const RANGE: &str = "reach-range";
pub(crate) const FIELDS: [&str; 4] = ["displaced-x", "displaced-y", "displaced-z", "displaced-range"];
const PROFILE: &str = "displaced-profile";
const COMBINATION: &str = "displaced-combination";
const BLEND: &str = "displaced-blend";

/// Growth of what a range leaves of 1 per pixel of the wheel: a notch is a tenth.
const WHEEL_GROWTH: f32 = 0.001;
/// The same for a key.
const KEY_STEP: f32 = 100.0;
/// What a pin holds around it, as a part of the surface's radius.
const PIN: f64 = 0.1;

/// A foot in the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct FootMark {
    pub(crate) surface: SurfaceId,
    pub(crate) number: usize,
    pub(crate) at: Vec3,
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
    pub(crate) fn feet(&self) -> Vec<FootMark> {
        if self.tools.kind() != ToolKind::Displace || !self.scene.has_frame() {
            return Vec::new();
        }
        self.all_feet()
    }

    /// All feet of the model.
    pub(crate) fn all_feet(&self) -> Vec<FootMark> {
        let mark = |foot: &ductile_spec::FootEntry| FootMark {
            surface: foot.surface,
            number: foot.number as usize,
            at: self.scene.vertex(foot.vertex),
        };
        self.scene.structure.feet.iter().filter(|_| self.scene.has_frame()).map(mark).collect()
    }

    /// The foot under the pointer.
    pub(crate) fn foot_at(&self, at: Vec2) -> Option<FootMark> {
        let reach = self.hand.reach();
        let distance = |foot: &FootMark| self.camera.project(foot.at).map(|place| place.distance(at));
        let near = self.feet().into_iter().filter_map(|foot| Some((distance(&foot)?, foot)));
        let near = near.filter(|(distance, _)| *distance <= reach);
        near.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, foot)| foot)
    }

    /// Takes hold of a foot, or of a place that becomes one; says whether the tool in hand does that.
    pub(crate) fn grab_foot(&mut self, at: Vec2) -> bool {
        if self.tools.kind() != ToolKind::Displace {
            return false;
        }
        let range = self.tools.options().range;
        let (target, anchor, normal) = match (self.foot_at(at), self.thing_at(at)) {
            (Some(foot), _) => {
                (GrabTarget::Foot { surface: foot.surface, number: foot.number }, foot.at, None)
            }
            (None, Some(Hit::Surface { id, at, normal, .. })) => {
                (GrabTarget::Displace { surface: id, at: at.as_dvec3(), range }, at, Some(normal))
            }
            _ => return true,
        };
        let mut drag = Drag::of_place(target, anchor, at);
        drag.set_normal(normal);
        self.schedule.grab(target);
        self.hand.drag = Some(drag);
        self.panel.welcome_is_over = true;
        self.refresh();
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
        match (self.foot_at(at), self.thing_at(at)) {
            (Some(foot), _) => self.choose_foot(foot.surface, foot.number),
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

    /// The wheel changes the range while the tool is over a surface; says whether it did.
    pub(crate) fn turn_range(&mut self, by: Vec2, modifiers: Modifiers) -> bool {
        let is_over = matches!(self.hand.hover, Some(Hit::Surface { .. })) || self.hand.drag.is_some();
        let is_meant = self.tools.kind() == ToolKind::Displace && is_over;
        if !is_meant || modifiers.ctrl || modifiers.shift || !by.is_finite() {
            return false;
        }
        if self.hand.drag.is_none() {
            self.step_range(by.y);
        }
        true
    }

    /// The keys that change the range.
    pub(crate) fn range_key(&mut self, name: &str) -> bool {
        let by = match name {
            "[" => KEY_STEP,
            "]" => -KEY_STEP,
            _ => return false,
        };
        let is_meant = self.tools.kind() == ToolKind::Displace;
        if is_meant {
            self.step_range(by);
        }
        is_meant
    }

    fn step_range(&mut self, by: f32) {
        let left = (1.0 - self.tools.options().range) * f64::from((by * WHEEL_GROWTH).clamp(-1.0, 1.0).exp());
        let range: f64 = format!("{:.2}", 1.0 - left).parse().unwrap_or(0.0);
        // Adding zero turns -0 into 0.
        self.tools.options_mut().range = range.clamp(LEAST_RANGE, MOST_RANGE) + 0.0;
        self.hand.hover_is_stale = true;
        self.refresh();
    }

    /// Takes the range that was typed for the tool; says what is wrong with it.
    pub(crate) fn typed_range(&mut self, text: &str) -> Option<String> {
        match range(text) {
            Ok(range) => self.tools.options_mut().range = range,
            Err(why) => return Some(why),
        }
        self.hand.hover_is_stale = true;
        self.refresh();
        None
    }

    /// Asks how far the tool would reach from where it points.
    pub(crate) fn ask_reach(&mut self) {
        let Some(Hit::Surface { id, at, .. }) =
            self.hand.hover.filter(|_| self.tools.kind() == ToolKind::Displace)
        else {
            return;
        };
        if self.hand.drag.is_some() || !self.scene.header.settled {
            return;
        }
        if let Some(question) = self.reaching.want(id, at.as_dvec3(), self.tools.options().range) {
            self.schedule.push(question);
        }
    }

    /// The feet, the chosen one with its way, and how far the tool would reach.
    pub(crate) fn mark_displacements(&self, mark: &mut Highlight) {
        if self.tools.kind() != ToolKind::Displace {
            return;
        }
        mark.ghost.extend(self.feet().iter().map(|foot| foot.at));
        if let Some((foot, item)) = self.chosen_item() {
            mark.arms.push((foot.at - item.by.as_vec3(), foot.at, self.hand.drag.is_some()));
        }
        let over = self.hand.cursor.and_then(|at| self.foot_at(at)).filter(|_| self.hand.drag.is_none());
        if let Some(over) = over {
            mark.hover = None;
            let item =
                self.displaced(over.surface).and_then(|displaced| displaced.items.get(over.number - 1));
            let by = item.map_or(Vec3::ZERO, |item| item.by.as_vec3());
            mark.arms.push((over.at - by, over.at, true));
        } else if let Some(Hit::Surface { id, .. }) = mark.hover {
            mark.sketch = self.reaching.lines(id).to_vec();
        }
    }

    fn displaced(&self, surface: SurfaceId) -> Option<&Displaced> {
        self.document.displacements.get(&surface)
    }

    /// The chosen displacement: where its foot is, and what the document says of it.
    fn chosen_item(&self) -> Option<(FootMark, &Displacement)> {
        let (surface, number) = self.chosen_foot?;
        let item = self.displaced(surface)?.items.get(number.checked_sub(1)?)?;
        let foot =
            self.all_feet().into_iter().find(|foot| (foot.surface, foot.number) == (surface, number))?;
        Some((foot, item))
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

    /// What a field of the chosen displacement shows.
    pub(crate) fn displacement_text(&self, field: &str) -> String {
        let Some((_, item)) = self.chosen_item() else { return String::new() };
        match FIELDS.iter().position(|name| *name == field) {
            Some(index) if index < 3 => number::show(item.by[index]),
            _ => number::show(item.range),
        }
    }

    /// Takes what was typed for the chosen displacement; says what is wrong with it.
    pub(crate) fn typed_displacement(&mut self, index: usize, text: &str) -> Option<String> {
        let (foot, item) = self.chosen_item()?;
        let (surface, number, mut to) = (foot.surface, foot.number, item.clone());
        let shown = self.displacement_text(FIELDS[index]);
        if index < 3 {
            match number::parse(text) {
                Ok(value) => to.by[index] = value,
                Err(error) => return Some(error.to_string()),
            }
        } else {
            match range(text) {
                Ok(value) => to.range = value,
                Err(why) => return Some(why),
            }
        }
        let value = if index < 3 { to.by[index] } else { to.range };
        if number::show(value) != shown {
            self.request(Request::Edit(Edit::ChangeDisplacement { surface, number, to }));
        }
        None
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

/// A range that was typed, or what is wrong with it.
fn range(text: &str) -> Result<f64, String> {
    match number::parse(text) {
        Ok(value) if (LEAST_RANGE..=MOST_RANGE).contains(&value) => Ok(value),
        Ok(_) => Err(format!("A range lies between {LEAST_RANGE} and {MOST_RANGE}.")),
        Err(error) => Err(error.to_string()),
    }
}
