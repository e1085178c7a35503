//! The tools: what a click, a key and a drag mean, as state machines without a page.
//!
//! A tool is told what lies under the pointer and answers with [`Act`]s. It stays for repeated use until
//! the designer leaves it. Nothing here talks to the worker or to the document object model.

use crate::{Hit, Scene};
use ductile_spec::{CurveId, CurveSpan, Edit, PointEntry, PointId, PointRole, Structure, SurfaceId, Through};
use glam::Vec3;

mod drag;
mod ghost;
mod handle;
#[cfg(test)]
mod tests;

pub use drag::{Arrow, Axis, Drag, grid_step, nudge_direction, work_plane};
pub use ghost::ghost_line;
pub use handle::{Arm, handles_at};

/// The tools, in the order of the bar.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ToolKind {
    /// Takes hold of anything.
    #[default]
    Shape,
    /// Places control points.
    Point,
    /// Makes curves through points.
    Curve,
    /// Skins a closed curve.
    Sheet,
    /// Skins the space between two closed curves.
    Sweep,
}

impl ToolKind {
    /// All of them.
    pub const ALL: [Self; 5] = [Self::Shape, Self::Point, Self::Curve, Self::Sheet, Self::Sweep];

    /// Its word in the page: `tool-shape` is its button.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Shape => "shape",
            Self::Point => "point",
            Self::Curve => "curve",
            Self::Sheet => "sheet",
            Self::Sweep => "sweep",
        }
    }

    /// The tool that a key chooses.
    #[must_use]
    pub fn of_key(key: &str) -> Option<Self> {
        match key {
            "v" => Some(Self::Shape),
            "p" => Some(Self::Point),
            "c" => Some(Self::Curve),
            "s" => Some(Self::Sheet),
            "w" => Some(Self::Sweep),
            _ => None,
        }
    }
}

/// What is selected.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Selection {
    /// Nothing.
    #[default]
    None,
    /// A control point.
    Point(PointId),
    /// A curve.
    Curve(CurveId),
    /// A surface.
    Surface(SurfaceId),
}

impl Selection {
    /// What a click on something selects.
    #[must_use]
    pub fn of(hit: Option<&Hit>) -> Self {
        match hit {
            None => Self::None,
            Some(Hit::Point { id, .. }) => Self::Point(*id),
            Some(Hit::Curve { id, .. }) => Self::Curve(*id),
            Some(Hit::Surface { id, .. }) => Self::Surface(*id),
        }
    }

    /// The same if the model still has it, else nothing.
    #[must_use]
    pub fn still_in(self, structure: &Structure) -> Self {
        let exists = match self {
            Self::None => true,
            Self::Point(id) => structure.points.iter().any(|point| point.id == id),
            Self::Curve(id) => structure.curves.iter().any(|curve| curve.id == id),
            Self::Surface(id) => structure.surfaces.iter().any(|surface| surface.id == id),
        };
        if exists { self } else { Self::None }
    }

    /// The edit that removes it: a control that something hangs on is released, and its shape relaxes.
    #[must_use]
    pub fn removal(self, structure: &Structure) -> Option<Edit> {
        match self {
            Self::None => None,
            Self::Point(point) => match entry(structure, point)?.role {
                PointRole::Free => Some(Edit::DeletePoint { point }),
                PointRole::Curve | PointRole::Surface => Some(Edit::Release { point }),
            },
            Self::Curve(curve) => Some(Edit::DeleteCurve { curve }),
            Self::Surface(surface) => Some(Edit::DeleteSurface { surface }),
        }
    }

    /// The next control point after the selected one, or before it, round and round.
    #[must_use]
    pub fn walk(self, structure: &Structure, backwards: bool) -> Self {
        let points = &structure.points;
        if points.is_empty() {
            return Self::None;
        }
        let here = match self {
            Self::Point(id) => points.iter().position(|point| point.id == id),
            _ => None,
        };
        let next = match (here, backwards) {
            (None, false) => 0,
            (None, true) => points.len() - 1,
            (Some(index), false) => (index + 1) % points.len(),
            (Some(index), true) => (index + points.len() - 1) % points.len(),
        };
        Self::Point(points[next].id)
    }
}

/// What a tool wants done.
#[derive(Clone, Debug, PartialEq)]
pub enum Act {
    /// Asks the modeler.
    Edit(Edit),
    /// Selects.
    Select(Selection),
    /// Says why it cannot, or what it did.
    Say(String),
    /// The designer leaves the tool.
    Leave,
}

/// What lies under the pointer when it clicks.
#[derive(Clone, Copy, Debug, Default)]
pub struct Aim<'a> {
    /// The thing, if any.
    pub hit: Option<&'a Hit>,
    /// The place on the work plane, where nothing is hit.
    pub place: Option<Vec3>,
    /// The corner of the curve under way, if the pointer is on one.
    pub corner: Option<usize>,
}

/// What the model is when a tool acts.
#[derive(Clone, Copy, Debug)]
pub struct Surroundings<'a> {
    /// The things of the model.
    pub structure: &'a Structure,
    /// Where the eye looks.
    pub forward: Vec3,
}

/// A key that a tool understands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ToolKey {
    /// Enter: done.
    Done,
    /// Backspace: one step back.
    Back,
    /// Escape: give up, then leave.
    Escape,
}

/// A corner of a curve under way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Corner {
    /// The point it takes over, if it stands on one.
    pub point: Option<PointId>,
    /// Where it is.
    pub at: Vec3,
}

/// The tool in hand and how far it has come.
#[derive(Clone, Debug, Default)]
pub struct Toolbox {
    kind: ToolKind,
    corners: Vec<Corner>,
    from: Option<CurveId>,
}

impl Toolbox {
    /// The tool in hand.
    #[must_use]
    pub fn kind(&self) -> ToolKind {
        self.kind
    }

    /// The corners of the curve under way.
    #[must_use]
    pub fn corners(&self) -> &[Corner] {
        &self.corners
    }

    /// The first curve of a sweep under way.
    #[must_use]
    pub fn sweep_from(&self) -> Option<CurveId> {
        self.from
    }

    /// Takes a tool in hand; what was under way is given up.
    pub fn choose(&mut self, kind: ToolKind) {
        *self = Self { kind, ..Self::default() };
    }

    /// Whether a drag takes hold of things, rather than turning the view.
    #[must_use]
    pub fn holds(&self) -> bool {
        self.kind == ToolKind::Shape
    }

    /// What the tool wants next, in one line.
    #[must_use]
    pub fn hint(&self) -> &'static str {
        match self.kind {
            ToolKind::Shape => "Drag the surface, a curve or a point. Double-click a point to release it.",
            ToolKind::Point => {
                "Click where a control point should be: on a surface, on a curve, or in the work plane."
            }
            ToolKind::Curve => match self.corners.len() {
                0 => "Click where the curve begins. Points that exist are taken over.",
                1 => "Click the next point. Backspace takes the last one away, Esc gives up.",
                2 => "Click the next point, or Enter to end the curve here.",
                _ => "Click the next point, the first one to close the curve, or Enter to end it.",
            },
            ToolKind::Sheet => "Click a closed curve to skin it.",
            ToolKind::Sweep => match self.from {
                None => "Click the first of two closed curves.",
                Some(_) => "Now click the other closed curve.",
            },
        }
    }

    /// A click.
    pub fn click(&mut self, aim: Aim<'_>, around: Surroundings<'_>) -> Vec<Act> {
        match self.kind {
            ToolKind::Shape => vec![Act::Select(Selection::of(aim.hit))],
            ToolKind::Point => Self::place_point(aim),
            ToolKind::Curve => self.place_corner(aim, around),
            ToolKind::Sheet => match closed_curve(aim.hit, around.structure) {
                Ok(boundary) => vec![Act::Edit(Edit::Sheet { boundary })],
                Err(why) => vec![Act::Say(why)],
            },
            ToolKind::Sweep => self.pick_end(aim.hit, around.structure),
        }
    }

    /// A key.
    pub fn key(&mut self, key: ToolKey, around: Surroundings<'_>) -> Vec<Act> {
        match (self.kind, key) {
            (ToolKind::Curve, ToolKey::Done) if !self.corners.is_empty() => self.end_curve(false, around),
            (ToolKind::Curve, ToolKey::Back) if self.corners.pop().is_some() => Vec::new(),
            (ToolKind::Curve, ToolKey::Escape) if !self.corners.is_empty() => {
                self.corners.clear();
                Vec::new()
            }
            (ToolKind::Sweep, ToolKey::Back | ToolKey::Escape) if self.from.take().is_some() => Vec::new(),
            (_, ToolKey::Escape) => vec![Act::Leave],
            _ => Vec::new(),
        }
    }

    /// Whether Backspace belongs to the tool rather than to the selection.
    #[must_use]
    pub fn is_under_way(&self) -> bool {
        !self.corners.is_empty() || self.from.is_some()
    }

    /// Forgets what the model no longer has.
    pub fn refresh(&mut self, scene: &Scene) {
        let structure = &scene.structure;
        for corner in &mut self.corners {
            corner.point = corner.point.filter(|id| entry(structure, *id).is_some());
            if let Some(at) = corner.point.and_then(|id| scene.point(id)) {
                corner.at = at;
            }
        }
        self.from = self.from.filter(|id| span(structure, *id).is_some());
    }

    fn place_point(aim: Aim<'_>) -> Vec<Act> {
        let edit = match (aim.hit, aim.place) {
            (Some(Hit::Point { id, .. }), _) => {
                let say = "There is a control point here already; it is selected.";
                return vec![Act::Select(Selection::Point(*id)), Act::Say(say.to_owned())];
            }
            (Some(Hit::Curve { id, at }), _) => Edit::Insert { curve: *id, at: at.as_dvec3() },
            (Some(Hit::Surface { id, at, .. }), _) => Edit::Pin { surface: *id, at: at.as_dvec3() },
            (None, Some(at)) => Edit::Point { at: at.as_dvec3() },
            (None, None) => return vec![Act::Say(NO_PLACE.to_owned())],
        };
        vec![Act::Edit(edit)]
    }

    fn place_corner(&mut self, aim: Aim<'_>, around: Surroundings<'_>) -> Vec<Act> {
        let hit_point = match aim.hit {
            Some(Hit::Point { id, .. }) => Some(*id),
            _ => None,
        };
        let met = aim
            .corner
            .or_else(|| self.corners.iter().position(|c| c.point.is_some() && c.point == hit_point));
        match met {
            Some(0) if self.corners.len() >= 3 => return self.end_curve(true, around),
            Some(0) => return say("A closed curve needs at least three points."),
            Some(last) if last + 1 == self.corners.len() => {
                return if last >= 1 { self.end_curve(false, around) } else { Vec::new() };
            }
            Some(_) => return say("The curve passes through this point already."),
            None => {}
        }
        let at = match aim.hit {
            Some(Hit::Point { at, .. } | Hit::Curve { at, .. } | Hit::Surface { at, .. }) => Some(*at),
            None => aim.place,
        };
        let Some(at) = at else { return say(NO_PLACE) };
        self.corners.push(Corner { point: hit_point, at });
        Vec::new()
    }

    fn end_curve(&mut self, closed: bool, around: Surroundings<'_>) -> Vec<Act> {
        if self.corners.len() < 2 {
            return say("A curve needs at least two points.");
        }
        let mut corners = std::mem::take(&mut self.corners);
        if closed && turns_away(&corners, around.forward) {
            // A sheet over the curve then shows its outside to the designer.
            corners[1..].reverse();
        }
        let through = corners.iter().map(|c| c.point.map_or(Through::Place(c.at.as_dvec3()), Through::Point));
        vec![Act::Edit(Edit::Curve { through: through.collect(), closed })]
    }

    fn pick_end(&mut self, hit: Option<&Hit>, structure: &Structure) -> Vec<Act> {
        let curve = match closed_curve(hit, structure) {
            Ok(curve) => curve,
            Err(why) => return vec![Act::Say(why)],
        };
        match self.from {
            None => {
                self.from = Some(curve);
                Vec::new()
            }
            Some(from) if from == curve => say("A sweep needs two different curves."),
            Some(from) => {
                self.from = None;
                vec![Act::Edit(Edit::Sweep { from, to: curve, reversed: false })]
            }
        }
    }
}

/// Whether a closed polygon runs clockwise as the eye sees it (the sum is Newell's normal).
fn turns_away(corners: &[Corner], forward: Vec3) -> bool {
    let next = corners.iter().cycle().skip(1);
    let normal: Vec3 = corners.iter().zip(next).map(|(a, b)| a.at.cross(b.at)).sum();
    normal.dot(forward) > 0.0
}

const NO_PLACE: &str = "The work plane is seen edge-on here: turn the view a little.";

fn say(text: &str) -> Vec<Act> {
    vec![Act::Say(text.to_owned())]
}

fn closed_curve(hit: Option<&Hit>, structure: &Structure) -> Result<CurveId, String> {
    let Some(Hit::Curve { id, .. }) = hit else {
        return Err("There is no curve here. Click a closed curve.".to_owned());
    };
    match span(structure, *id) {
        Some(span) if span.closed => Ok(*id),
        _ => Err("This curve is open; only a closed curve can be skinned.".to_owned()),
    }
}

/// The entry of a control point.
#[must_use]
pub fn entry(structure: &Structure, id: PointId) -> Option<&PointEntry> {
    structure.points.iter().find(|point| point.id == id)
}

/// The span of a curve.
#[must_use]
pub fn span(structure: &Structure, id: CurveId) -> Option<&CurveSpan> {
    structure.curves.iter().find(|curve| curve.id == id)
}
