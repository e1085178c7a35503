//! How far displacements reach, in the page: the fields of the tool and of the chosen displacement, wheel and keys, and the line that
//! shows it.

use super::displace::FootMark;
use super::dom;
use super::page::Page;
use crate::Hit;
use crate::input::Modifiers;
use crate::number;
use crate::tool::ToolKind;
use ductile_spec::{Displacing, Edit, LEAST_RANGE, MOST_RANGE, Request};
use glam::Vec2;

/// The fields of the tool in index.html: range, how many times as far, and along which direction.
pub(crate) const TOOL: [&str; 5] = ["reach-range", "reach-times", "reach-x", "reach-y", "reach-z"];
/// Those of the chosen displacement: by what it moves its foot, and then the same.
pub(crate) const CHOSEN: [&str; 8] = [
    "displaced-x",
    "displaced-y",
    "displaced-z",
    "displaced-range",
    "displaced-times",
    "displaced-along-x",
    "displaced-along-y",
    "displaced-along-z",
];

/// Growth of what a range leaves of 1 per pixel of the wheel: a notch is a tenth.
const WHEEL_GROWTH: f32 = 0.001;
/// The same for a key.
const KEY_STEP: f32 = 100.0;

impl Page {
    /// The wheel changes the range while the tool is over a surface; says whether it did.
    pub(crate) fn turn_range(&mut self, by: Vec2, modifiers: Modifiers) -> bool {
        let is_over = matches!(self.hand.hover, Some(Hit::Surface { .. } | Hit::Curve { .. }))
            || self.hand.drag.is_some();
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
        let around = &mut self.tools.options_mut().around;
        let left = (1.0 - around.range) * f64::from((by * WHEEL_GROWTH).clamp(-1.0, 1.0).exp());
        let range: f64 = format!("{:.2}", 1.0 - left).parse().unwrap_or(0.0);
        // Adding zero turns -0 into 0.
        around.range = range.clamp(LEAST_RANGE, MOST_RANGE) + 0.0;
        self.hand.hover_is_stale = true;
        self.refresh();
    }

    /// What a field of the tool shows.
    pub(crate) fn reach_text(&self, field: &str) -> String {
        let place = TOOL.iter().position(|name| *name == field);
        place.map(|place| self.tools.options().around.text(place)).unwrap_or_default()
    }

    /// Takes what was typed for the tool; says what is wrong with it.
    pub(crate) fn typed_reach(&mut self, field: usize, text: &str) -> Option<String> {
        match self.tools.options().around.typed(field, text) {
            Ok(around) => self.tools.options_mut().around = around,
            Err(why) => return Some(why),
        }
        self.hand.hover_is_stale = true;
        self.refresh();
        None
    }

    /// What a field of the chosen displacement shows.
    pub(crate) fn displacement_text(&self, field: &str) -> String {
        let Some((_, item)) = self.chosen_item() else { return String::new() };
        match CHOSEN.iter().position(|name| *name == field) {
            Some(index) if index < 3 => number::show(item.by[index]),
            Some(index) => self.tools.options().around.of(item).text(index - 3),
            None => String::new(),
        }
    }

    /// Takes what was typed for the chosen displacement; says what is wrong with it.
    pub(crate) fn typed_displacement(&mut self, index: usize, text: &str) -> Option<String> {
        let (foot, item) = self.chosen_item()?;
        let (surface, number, mut to) = (foot.surface, foot.number, item.clone());
        if index < 3 {
            match number::parse(text) {
                Ok(value) if number::show(value) == number::show(to.by[index]) => {}
                Ok(value) => to.by[index] = value,
                Err(error) => return Some(error.to_string()),
            }
        } else {
            match self.tools.options().around.of(item).typed(index - 3, text) {
                Ok(around) => (to.range, to.direction) = (around.range, around.direction()),
                Err(why) => return Some(why),
            }
        }
        if to != *item {
            self.request(Request::Edit(Edit::ChangeDisplacement { surface, number, to }));
        }
        None
    }

    /// Directions are shown where they matter.
    pub(crate) fn show_reach(&self) {
        let around = self.tools.options().around;
        let is_displace = self.tools.kind() == ToolKind::Displace;
        dom::show(&dom::element("reach"), is_displace);
        dom::show(&dom::element("reach-along"), is_displace && around.direction().is_some());
        let chosen = self.chosen_item().is_some_and(|(_, item)| item.direction.is_some());
        dom::show(&dom::element("displaced-along"), chosen);
    }

    /// What the line shows: what a drag would begin from where the tool points, or else the chosen displacement.
    pub(super) fn trial(&self) -> Option<Displacing> {
        if self.tools.kind() != ToolKind::Displace || self.hand.drag.is_some() {
            return None;
        }
        if let Some((over, _)) = self.hand.cursor.and_then(|at| self.foot_at(at)) {
            return self.trial_of(&over);
        }
        if let Some(hit) = &self.hand.hover {
            return self.displacing(hit);
        }
        let (foot, _) = self.chosen_item()?;
        self.trial_of(&foot)
    }

    /// A displacement that is there, as if it were to be made.
    pub(super) fn trial_of(&self, foot: &FootMark) -> Option<Displacing> {
        let item = self.displaced(foot.surface)?.items.get(foot.number.checked_sub(1)?)?;
        let (at, along) = (foot.at.as_dvec3(), item.foot.curve());
        Some(Displacing { surface: foot.surface, at, along, range: item.range, direction: item.direction })
    }

    /// Asks how far that would reach.
    pub(crate) fn ask_reach(&mut self) {
        if let Some(trial) = self.trial().filter(|_| self.scene.header.settled)
            && let Some(question) = self.reaching.want(trial)
        {
            self.schedule.push(question);
        }
    }
}
