//! The tools: what a click, a key and a drag mean, as state machines without a page.
//!
//! A tool is told what lies under the pointer and answers with [`Act`]s. It stays for repeated use until
//! the designer leaves it. Nothing here talks to the worker or to the document object model.

use crate::{Hit, Scene};
use ductile_spec::{CurveId, CurveSpan, Document, Edit, On, PointEntry, PointId, Structure, SurfaceId};
use glam::Vec3;

mod around;
mod cage;
mod divide;
mod drag;
mod fill;
mod ghost;
mod handle;
mod kind;
mod options;
mod pair;
mod path;
mod preview;
mod ribbon;
mod room;
mod selection;
mod sketch;
mod skin;
mod surgery;
#[cfg(test)]
mod surgery_test;
#[cfg(test)]
mod tests;

pub use around::Around;
pub use divide::face_between;
pub use drag::{Arrow, Axis, Drag, grid_step, nudge_direction, work_plane};
pub use ghost::ghost_line;
pub use handle::{Arm, handles_at};
pub use kind::ToolKind;
pub use options::{Options, Toggle};
pub use pair::{Pick, stretch};
pub use path::Corner;
pub use preview::{Tube, drawn_ties, mean_radius, ties, tube};
pub use ribbon::{handles_along, surface_of};
pub use room::no_room;
pub use selection::Selection;
pub use sketch::Stroke;
pub use skin::{Facet, least_skin, loft};
pub use surgery::would_smooth;

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
    /// The surface under the pointer, or else the one nearest to the thing.
    pub surface: Option<SurfaceId>,
    /// The rim that would be taken.
    pub rim: Option<Place>,
}

/// What the model is when a tool acts.
#[derive(Clone, Copy, Debug)]
pub struct Surroundings<'a> {
    /// The things of the model.
    pub structure: &'a Structure,
    /// The document behind them.
    pub document: &'a Document,
    /// Where the eye looks.
    pub forward: Vec3,
    /// Radius of a tube that suits the model, while nobody has chosen another.
    pub radius: f64,
    /// Size of a cage that suits the view, while nobody has chosen another.
    pub size: f64,
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

/// A place on a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// Which surface.
    pub surface: SurfaceId,
    /// Where.
    pub at: Vec3,
    /// The unit normal there; none where a rim was picked.
    pub normal: Option<Vec3>,
}

impl Place {
    /// As an act names it.
    #[must_use]
    pub fn on(self) -> On {
        On { surface: self.surface, at: self.at.as_dvec3() }
    }

    fn of(hit: Option<&Hit>) -> Option<Self> {
        match hit {
            Some(Hit::Surface { id, at, normal, .. }) => {
                Some(Self { surface: *id, at: *at, normal: Some(*normal) })
            }
            _ => None,
        }
    }
}

/// The tool in hand and how far it has come.
#[derive(Clone, Debug, Default)]
pub struct Toolbox {
    kind: ToolKind,
    corners: Vec<Corner>,
    first: Option<Pick>,
    /// The ends of a tube that is shown and waits to be made.
    proposal: Option<[Place; 2]>,
    /// Where a stretch, the split of a face, or a part of a rim begins whose other end is awaited.
    end: Option<PointId>,
    /// The edge of the rim of a cage of which a part is to become a curve.
    rim: Option<(SurfaceId, [PointId; 2])>,
    /// The corners that were picked for a fill.
    picked: Vec<PointId>,
    options: Options,
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

    /// What a tool that wants two things has got already.
    #[must_use]
    pub fn first(&self) -> Option<Pick> {
        self.first
    }

    /// How the tools do what they do.
    #[must_use]
    pub fn options(&self) -> &Options {
        &self.options
    }

    /// As [`Self::options`], to be changed.
    pub fn options_mut(&mut self) -> &mut Options {
        &mut self.options
    }

    /// Takes a tool in hand; what was under way is given up, but for the choices made.
    pub fn choose(&mut self, kind: ToolKind) {
        let options = Options { reversed: false, ..self.options };
        *self = Self { kind, options, ..Self::default() };
    }

    /// Awaits the closed curve whose size another one is to get.
    pub fn choose_match(&mut self, curve: CurveId) {
        self.choose(ToolKind::Match);
        self.first = Some(Pick::Curve(curve));
    }

    /// Whether a drag takes hold of things, rather than turning the view.
    #[must_use]
    pub fn holds(&self) -> bool {
        matches!(self.kind, ToolKind::Shape | ToolKind::Cage | ToolKind::Displace)
    }

    /// Whether a drag takes hold of handles.
    #[must_use]
    pub fn turns(&self) -> bool {
        self.holds() || self.kind == ToolKind::Ribbon
    }

    /// What the tool wants next, in one line.
    #[must_use]
    pub fn hint(&self) -> &'static str {
        match self.kind {
            ToolKind::Shape => "Drag anything. Double-click a point to release it.",
            ToolKind::Point => "Click where a control point should be.",
            ToolKind::Curve | ToolKind::Draw => self.path_hint(),
            ToolKind::Displace => "Drag a surface, or a curve in it. Wheel: how far around.",
            ToolKind::Sheet => "Click a closed curve, or one of a loop, to skin it.",
            ToolKind::Ribbon => "Click a rim, a curve or a point. Drag green handles.",
            ToolKind::Fill => self.fill_hint(),
            ToolKind::Burnout => "Click a region to burn it out. Its curves stay.",
            ToolKind::Crease => "Click a curve or region to crease, a crease to smooth.",
            ToolKind::Split => "Click a curve or region to cut the surface there.",
            ToolKind::Cage => "Click to place a cage, or drag one. E extrudes, X splits.",
            ToolKind::Divide => self.divide_hint(),
            ToolKind::Sweep
            | ToolKind::Embed
            | ToolKind::Glue
            | ToolKind::Merge
            | ToolKind::Trim
            | ToolKind::Shadow
            | ToolKind::Match => self.pair_hint(),
        }
    }

    /// A click.
    pub fn click(&mut self, aim: Aim<'_>, around: Surroundings<'_>) -> Vec<Act> {
        match self.kind {
            ToolKind::Shape | ToolKind::Displace => vec![Act::Select(Selection::of(aim.hit))],
            ToolKind::Point => place_point(aim),
            ToolKind::Curve | ToolKind::Draw => self.place_corner(aim, around),
            ToolKind::Sheet => match aim.hit {
                Some(Hit::Curve { id, .. }) => vec![Act::Edit(Edit::Sheet { boundary: *id })],
                _ => vec![Act::Say("There is no curve here. Click the curve to skin.".to_owned())],
            },
            ToolKind::Ribbon => ribbon::click(aim, around),
            ToolKind::Fill => self.click_fill(aim, around.document),
            ToolKind::Burnout => surgery::burn_out(aim),
            ToolKind::Crease => surgery::crease(aim, around),
            ToolKind::Split => surgery::split(aim, around),
            ToolKind::Sweep => self.pick_sweep(aim.hit, around),
            ToolKind::Embed => self.pick_embed(aim),
            ToolKind::Glue => self.pick_glue(aim.rim),
            ToolKind::Merge => self.pick_merge(Place::of(aim.hit), around.radius),
            ToolKind::Trim => self.pick_trim(Place::of(aim.hit)),
            ToolKind::Shadow => self.pick_shadow(Place::of(aim.hit)),
            ToolKind::Match => self.pick_match(aim.hit, around.structure),
            ToolKind::Cage => cage::click(aim, &self.options, around.size),
            ToolKind::Divide => self.pick_corner(aim.hit, around.document),
        }
    }

    /// What fills all loops of the network of a curve, or of all curves.
    #[must_use]
    pub fn fill_all(&self, curve: Option<CurveId>) -> Edit {
        fill::all_loops(curve, &self.options)
    }

    /// A key.
    pub fn key(&mut self, key: ToolKey, around: Surroundings<'_>) -> Vec<Act> {
        match key {
            ToolKey::Done if !self.corners.is_empty() => self.end_path(false, around),
            ToolKey::Done if !self.picked.is_empty() => self.fill_between(around.document, None),
            ToolKey::Done if self.proposal.is_some() => self.make_proposed(around.radius),
            ToolKey::Back if self.corners.pop().is_some() || self.picked.pop().is_some() => Vec::new(),
            ToolKey::Back | ToolKey::Escape if self.proposal.take().is_some() => Vec::new(),
            ToolKey::Escape if !self.picked.is_empty() => {
                self.picked.clear();
                Vec::new()
            }
            ToolKey::Escape if !self.corners.is_empty() => {
                self.corners.clear();
                Vec::new()
            }
            ToolKey::Back | ToolKey::Escape if self.end.take().is_some() => Vec::new(),
            ToolKey::Back | ToolKey::Escape
                if self.kind != ToolKind::Match && self.first.take().is_some() =>
            {
                self.options.reversed = false;
                Vec::new()
            }
            ToolKey::Escape if self.kind == ToolKind::Divide => {
                let is_rim = self.rim.is_some();
                self.choose(if is_rim { ToolKind::Shape } else { ToolKind::Cage });
                Vec::new()
            }
            ToolKey::Escape => vec![Act::Leave],
            ToolKey::Back if self.kind == ToolKind::Match => vec![Act::Leave],
            ToolKey::Done | ToolKey::Back => Vec::new(),
        }
    }

    /// Whether Backspace belongs to the tool rather than to the selection.
    #[must_use]
    pub fn is_under_way(&self) -> bool {
        let has_begun = self.first.is_some() || self.end.is_some() || self.proposal.is_some();
        has_begun || !self.corners.is_empty() || !self.picked.is_empty()
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
        let has = |id: SurfaceId| structure.surfaces.iter().any(|surface| surface.id == id);
        self.corners.retain(|corner| corner.surface.is_none_or(has));
        self.proposal = self.proposal.filter(|ends| ends.iter().all(|end| has(end.surface)));
        let is_there = |id: &PointId| entry(structure, *id).is_some();
        self.end = self.end.filter(is_there);
        self.picked.retain(is_there);
        if self.rim.is_some_and(|(surface, ends)| !has(surface) || !ends.iter().all(is_there)) {
            self.choose(ToolKind::Shape);
        }
        self.first = self.first.filter(|first| match *first {
            Pick::Curve(id) => span(structure, id).is_some(),
            Pick::Stretch(id, ends) => {
                span(structure, id).is_some() && ends.iter().all(|end| entry(structure, *end).is_some())
            }
            Pick::Place(place) => has(place.surface),
        });
        if self.kind == ToolKind::Match && self.first.is_none() {
            self.choose(ToolKind::Shape);
        }
    }
}

fn place_point(aim: Aim<'_>) -> Vec<Act> {
    let edit = match (aim.hit, aim.place) {
        (Some(Hit::Point { id, .. }), _) => {
            let say = "There is a control point here already; it is selected.";
            return vec![Act::Select(Selection::Point(*id)), Act::Say(say.to_owned())];
        }
        (Some(Hit::Curve { id, at }), _) => Edit::Insert { curve: *id, at: at.as_dvec3() },
        (Some(Hit::Surface { id, at, .. }), _) => Edit::Pin { surface: *id, at: at.as_dvec3() },
        // Only tools that take hold of cages are shown their parts.
        (Some(Hit::Edge { surface, at, .. } | Hit::Face { surface, at, .. }), _) => {
            Edit::Pin { surface: *surface, at: at.as_dvec3() }
        }
        (None, Some(at)) => Edit::Point { at: at.as_dvec3() },
        (None, None) => return vec![Act::Say(path::NO_PLACE.to_owned())],
    };
    vec![Act::Edit(edit)]
}

fn say(text: &str) -> Vec<Act> {
    vec![Act::Say(text.to_owned())]
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
