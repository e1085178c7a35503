//! Curves by their corners, one click each: free ones through space, and those drawn on a surface.
//!
//! Both close by a click on the first corner and end by Enter or by a click on the last one again.

use super::{Act, Aim, Surroundings, ToolKind, Toolbox, say};
use crate::Hit;
use ductile_spec::{Edit, PointId, SurfaceId, Through};
use glam::Vec3;

pub(super) const NO_PLACE: &str = "The work plane is seen edge-on here: turn the view a little.";

/// A corner of a curve under way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Corner {
    /// The point it takes over, if it stands on one.
    pub point: Option<PointId>,
    /// Where it is.
    pub at: Vec3,
    /// The surface on which it was drawn; none for a free curve.
    pub surface: Option<SurfaceId>,
}

impl Toolbox {
    pub(super) fn path_hint(&self) -> &'static str {
        match (self.kind, self.corners.len()) {
            (ToolKind::Draw, 0) => "Click where the curve begins, or sketch it in one stroke.",
            (ToolKind::Draw, 1) => "Click the next place. Backspace: one back, Esc gives up.",
            (ToolKind::Draw, 2) => "Click the next place, or Enter to end the curve here.",
            (ToolKind::Draw, _) => "Click the next place, the first one to close, or Enter.",
            (_, 0) => "Click where the curve begins; points are taken over.",
            (_, 1) => "Click the next point. Backspace: one back, Esc gives up.",
            (_, 2) => "Click the next point, or Enter to end the curve here.",
            _ => "Click the next point, the first one to close, or Enter.",
        }
    }

    /// The surface on which the curve under way is drawn.
    #[must_use]
    pub fn canvas(&self) -> Option<SurfaceId> {
        self.corners.first().and_then(|corner| corner.surface)
    }

    pub(super) fn place_corner(&mut self, aim: Aim<'_>, around: Surroundings<'_>) -> Vec<Act> {
        let hit_point = match aim.hit {
            Some(Hit::Point { id, .. }) => Some(*id),
            _ => None,
        };
        let met = aim
            .corner
            .or_else(|| self.corners.iter().position(|c| c.point.is_some() && c.point == hit_point));
        match met {
            Some(0) if self.corners.len() >= 3 => return self.end_path(true, around),
            Some(0) => return say("A closed curve needs at least three points."),
            Some(last) if last + 1 == self.corners.len() => {
                return if last >= 1 { self.end_path(false, around) } else { Vec::new() };
            }
            Some(_) => return say("The curve passes through this point already."),
            None => {}
        }
        let corner = if self.kind == ToolKind::Draw {
            self.corner_on_surface(aim)
        } else {
            let at = aim.hit.map(Hit::at).or(aim.place);
            at.map(|at| Corner { point: hit_point, at, surface: None }).ok_or(NO_PLACE)
        };
        match corner {
            Ok(corner) => {
                self.corners.push(corner);
                Vec::new()
            }
            Err(why) => say(why),
        }
    }

    fn corner_on_surface(&self, aim: Aim<'_>) -> Result<Corner, &'static str> {
        let (Some(hit), Some(surface)) = (aim.hit, aim.surface) else {
            return Err("There is no surface here. The curve is drawn on a surface.");
        };
        // A place of the curve or point itself is on its surface, whichever of two that meet there is named.
        let is_mark = !matches!(hit, Hit::Surface { .. });
        match self.canvas() {
            Some(canvas) if canvas != surface && !is_mark => {
                Err("This is another surface: a curve is drawn on one. Enter ends it here.")
            }
            canvas => Ok(Corner { point: None, at: hit.at(), surface: Some(canvas.unwrap_or(surface)) }),
        }
    }

    pub(super) fn end_path(&mut self, closed: bool, around: Surroundings<'_>) -> Vec<Act> {
        if self.corners.len() < 2 {
            return say("A curve needs at least two points.");
        }
        let canvas = self.canvas();
        let mut corners = std::mem::take(&mut self.corners);
        if closed && turns_away(&corners, around.forward) {
            // A sheet over the curve then shows its outside to the designer.
            corners[1..].reverse();
        }
        let edit = match canvas {
            Some(surface) => {
                Edit::SLoop { surface, along: corners.iter().map(|c| c.at.as_dvec3()).collect(), closed }
            }
            None => {
                let corner = |c: &Corner| c.point.map_or(Through::Place(c.at.as_dvec3()), Through::Point);
                Edit::Curve { through: corners.iter().map(corner).collect(), closed }
            }
        };
        vec![Act::Edit(edit)]
    }
}

/// Whether a closed polygon runs clockwise as the eye sees it (the sum is Newell's normal).
fn turns_away(corners: &[Corner], forward: Vec3) -> bool {
    let next = corners.iter().cycle().skip(1);
    let normal: Vec3 = corners.iter().zip(next).map(|(a, b)| a.at.cross(b.at)).sum();
    normal.dot(forward) > 0.0
}
