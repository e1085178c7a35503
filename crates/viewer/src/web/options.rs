//! The strip beside the hint: the choices of the tool in hand, the radius of a tube, and the angle of a join.

use super::dom;
use super::page::Page;
use crate::input::Modifiers;
use crate::number;
use crate::tool::{Toggle, ToolKind};
use glam::Vec2;

/// The field of the radius in index.html.
pub(crate) const FIELD: &str = "tube-radius";
/// The field of the angle at which a trim joins.
pub(crate) const ANGLE: &str = "join-angle";

/// Growth of the radius per pixel of the wheel: a notch is a tenth.
const WHEEL_GROWTH: f32 = 0.001;
/// What suits a model: a part of its radius.
const SUITED: f32 = 0.15;

impl Page {
    /// Shows the choices of the tool in hand.
    pub(crate) fn show_options(&self) {
        let kind = self.tools.kind();
        let mut any = matches!(kind, ToolKind::Merge | ToolKind::Displace | ToolKind::Fill);
        for id in ["tube", "merge-closest"] {
            dom::show(&dom::element(id), kind == ToolKind::Merge);
        }
        let has_angle = self.tools.options().ribbon && !self.tools.options().smooth;
        dom::show(&dom::element("join"), kind == ToolKind::Trim && has_angle);
        self.show_reach();
        self.show_fill_option();
        any |= self.show_cage_option();
        any |= self.show_ribbon_option();
        for toggle in Toggle::ALL {
            let button = dom::element(&format!("option-{}", toggle.word()));
            let serves = toggle.serves(kind);
            any |= serves;
            dom::show(&button, serves);
            let is_on = self.tools.options().is_on(toggle);
            dom::attribute(&button, "aria-pressed", if is_on { "true" } else { "false" });
        }
        dom::show(&dom::element("options"), any);
    }

    /// Turns a choice.
    pub(crate) fn turn(&mut self, toggle: Toggle) {
        self.tools.options_mut().turn(toggle);
        self.refresh();
    }

    /// The radius that a tube has while nobody chose another, of few digits.
    pub(crate) fn suited_radius(&self) -> f64 {
        let first = self.tools.first_place().and_then(|place| self.scene.ball_of(place.surface));
        let (_, radius) = first.or_else(|| self.scene.bounds()).unwrap_or((glam::Vec3::ZERO, 1.0));
        short(f64::from(SUITED * radius), 1)
    }

    /// The radius that a tube would have.
    pub(crate) fn tube_radius(&self) -> f64 {
        self.tools.options().radius.unwrap_or_else(|| self.suited_radius())
    }

    pub(crate) fn tube_radius_text(&self) -> String {
        number::show(self.tube_radius())
    }

    pub(crate) fn join_angle_text(&self) -> String {
        self.tools.options().angle.map(number::show).unwrap_or_default()
    }

    /// Takes the angle that was typed; says what is wrong with it.
    pub(crate) fn typed_join_angle(&mut self, text: &str) -> Option<String> {
        let angle = if text.trim().is_empty() {
            None
        } else {
            match number::parse(text.trim().trim_end_matches('°')) {
                Ok(value) if value > 0.0 && value <= 180.0 => Some(value),
                Ok(_) => return Some("The angle of a join is above 0 and at most 180 degrees.".to_owned()),
                Err(error) => return Some(error.to_string()),
            }
        };
        self.tools.options_mut().angle = angle;
        self.refresh();
        None
    }

    /// The wheel changes the radius while the end of a tube is chosen; says whether it did.
    pub(crate) fn turn_radius(&mut self, by: Vec2, modifiers: Modifiers) -> bool {
        let chooses = self.tools.kind() == ToolKind::Merge && self.tools.first_place().is_some();
        if !chooses || modifiers.ctrl || modifiers.shift || !by.is_finite() {
            return false;
        }
        let grown = self.tube_radius() * f64::from((-by.y * WHEEL_GROWTH).clamp(-1.0, 1.0).exp());
        self.tools.options_mut().radius = Some(short(grown.clamp(1e-4, 1e5), 2));
        self.refresh();
        true
    }

    /// Takes what was typed; says what is wrong with it.
    pub(crate) fn typed_tube_radius(&mut self, text: &str) -> Option<String> {
        let radius = if text.trim().is_empty() {
            None
        } else {
            match number::parse(text) {
                Ok(value) if value > 0.0 => Some(value),
                Ok(_) => return Some("A radius is above 0.".to_owned()),
                Err(error) => return Some(error.to_string()),
            }
        };
        self.tools.options_mut().radius = radius;
        self.refresh();
        None
    }
}

/// A number of few digits after the first.
fn short(value: f64, digits: usize) -> f64 {
    format!("{value:.digits$e}").parse().unwrap_or(value)
}
