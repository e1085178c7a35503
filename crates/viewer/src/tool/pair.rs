//! Tools that want two things: the first is kept until the second is clicked, then both become one act.

use super::{Act, Options, Place, ToolKind, Toolbox, say, span};
use crate::Hit;
use ductile_spec::{CurveId, Edit, Extent, Structure};

/// What was clicked first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Pick {
    /// A curve.
    Curve(CurveId),
    /// A place on a surface, or on a rim of it.
    Place(Place),
}

impl Toolbox {
    pub(super) fn pair_hint(&self) -> &'static str {
        match (self.kind, self.first.is_some()) {
            (ToolKind::Sweep, false) => "Click the first of two curves, both closed or both open.",
            (ToolKind::Sweep, true) => "Now click the other curve. R runs through it the other way.",
            (ToolKind::Glue, false) => "Click the first of two rims. It stays where it is.",
            (ToolKind::Glue, true) => {
                "Now click the other rim. S: with a band between them or without. R: the other way round."
            }
            (ToolKind::Merge, false) => "Click where the tube should begin.",
            (ToolKind::Merge, true) => {
                "Now click where it should end; Enter takes the closest places. The wheel sets the radius, K keeps the rims."
            }
            (ToolKind::Trim, false) => "Click the part of the first surface that should stay.",
            (ToolKind::Trim, true) => {
                "Now click the part of the second surface that should stay. S: smooth where they join, or a crease. R: a ribbon holds the join."
            }
            (ToolKind::Shadow, false) => {
                "Click the region that should take on the relief of another surface."
            }
            (ToolKind::Shadow, true) => "Now click the stamp: another surface with one rim.",
            _ => "Click the closed curve whose size it should get.",
        }
    }

    /// The first curve of a sweep under way.
    #[must_use]
    pub fn sweep_from(&self) -> Option<CurveId> {
        match self.first {
            Some(Pick::Curve(curve)) => Some(curve),
            _ => None,
        }
    }

    /// The first place of a tool that wants two.
    #[must_use]
    pub fn first_place(&self) -> Option<Place> {
        match self.first {
            Some(Pick::Place(place)) => Some(place),
            _ => None,
        }
    }

    pub(super) fn pick_sweep(&mut self, hit: Option<&Hit>, structure: &Structure) -> Vec<Act> {
        let Some(curve) = curve_hit(hit) else { return say("There is no curve here.") };
        let is_closed = |id| span(structure, id).is_some_and(|span| span.closed);
        match self.sweep_from() {
            None => {
                self.first = Some(Pick::Curve(curve));
                Vec::new()
            }
            Some(from) if from == curve => say("A sweep needs two different curves."),
            Some(from) if is_closed(from) != is_closed(curve) => {
                say("One of these curves is closed and the other is open: nothing can be swept between them.")
            }
            Some(from) => {
                let reversed = self.conclude();
                vec![Act::Edit(Edit::Sweep { from, to: curve, reversed })]
            }
        }
    }

    pub(super) fn pick_match(&mut self, hit: Option<&Hit>, structure: &Structure) -> Vec<Act> {
        let Some(like) = curve_hit(hit) else { return say("There is no curve here.") };
        match self.sweep_from() {
            Some(curve) if curve == like => say("This is the curve itself. Click another one."),
            Some(_) if !span(structure, like).is_some_and(|span| span.closed) => {
                say("This curve is open; only a closed one has a size to match.")
            }
            Some(curve) => {
                vec![Act::Edit(Edit::Expand { curve, to: Extent::Like(like) }), Act::Leave]
            }
            None => vec![Act::Leave],
        }
    }

    pub(super) fn pick_glue(&mut self, rim: Option<Place>) -> Vec<Act> {
        let Some(to) = rim else { return say("There is no rim here. A rim is where a surface ends.") };
        match self.first_place() {
            None => self.begin(to),
            Some(from) => {
                let skirt = self.options.skirt;
                let reversed = self.conclude();
                vec![Act::Edit(Edit::Glue { from: from.on(), to: to.on(), skirt, reversed })]
            }
        }
    }

    pub(super) fn pick_merge(&mut self, place: Option<Place>, suited: f64) -> Vec<Act> {
        let Some(to) = place else {
            return say("There is no surface here. A tube begins and ends on surfaces.");
        };
        let Some(from) = self.first_place() else { return self.begin(to) };
        if from.at.distance(to.at) < f32::EPSILON {
            return say("The tube would end where it begins. Click another place.");
        }
        self.conclude();
        let Options { radius, keep, .. } = self.options;
        let radius = radius.unwrap_or(suited);
        vec![Act::Edit(Edit::Merge { from: from.on(), to: to.on(), radius, keep })]
    }

    pub(super) fn pick_trim(&mut self, place: Option<Place>) -> Vec<Act> {
        let Some(second) = place else { return say("There is no surface here.") };
        match self.first_place() {
            None => self.begin(second),
            Some(first) if first.surface == second.surface => {
                say("This is the same surface. Trim joins two that cross one another.")
            }
            Some(first) => {
                self.conclude();
                let (smooth, ribbon) = (self.options.smooth, self.options.join_ribbon());
                vec![Act::Edit(Edit::Trim { first: first.on(), second: second.on(), smooth, ribbon })]
            }
        }
    }

    pub(super) fn pick_shadow(&mut self, place: Option<Place>) -> Vec<Act> {
        let Some(place) = place else { return say("There is no surface here.") };
        match self.first_place() {
            None => self.begin(place),
            Some(first) if first.surface == place.surface => {
                say("This is the same surface. A region takes on the relief of another one.")
            }
            Some(first) => {
                self.conclude();
                let of = Some(place.surface);
                vec![Act::Edit(Edit::Shadow { region: first.on(), of, strength: 1.0, turn: None })]
            }
        }
    }

    /// Ends a merge at places that were not clicked: the closest ones.
    pub fn merge_between(&mut self, from: Place, to: Place, suited: f64) -> Vec<Act> {
        self.first = Some(Pick::Place(from));
        self.pick_merge(Some(to), suited)
    }

    fn begin(&mut self, place: Place) -> Vec<Act> {
        self.first = Some(Pick::Place(place));
        Vec::new()
    }

    /// The tool begins anew; says whether the act that it has done was to be the other way round.
    fn conclude(&mut self) -> bool {
        self.first = None;
        std::mem::take(&mut self.options.reversed)
    }
}

fn curve_hit(hit: Option<&Hit>) -> Option<CurveId> {
    match hit {
        Some(Hit::Curve { id, .. }) => Some(*id),
        _ => None,
    }
}
