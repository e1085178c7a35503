//! Tools that want two things: the first is kept until the second is clicked, then both become one act.

use super::{Act, Aim, Options, Place, Surroundings, ToolKind, Toolbox, say, span};
use crate::Hit;
use ductile_spec::{Curve, CurveId, Document, Edit, Extent, PointId, Structure};

/// What was clicked first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Pick {
    /// A curve.
    Curve(CurveId),
    /// The stretch of a curve between two control points: on a closed one from the first to the second, in its sense.
    Stretch(CurveId, [PointId; 2]),
    /// A place on a surface, or on a rim of it.
    Place(Place),
}

impl Toolbox {
    pub(super) fn pair_hint(&self) -> &'static str {
        match (self.kind, self.first.is_some()) {
            (ToolKind::Sweep, _) if self.end.is_some() => {
                "Now click the control point at which the stretch ends."
            }
            (ToolKind::Sweep, false) => "Click the first of two curves, or the ends of a stretch.",
            (ToolKind::Sweep, true) => "Now click the other curve, or the ends of a stretch.",
            (ToolKind::Embed, false) => "Click the curve that should lie in a surface.",
            (ToolKind::Embed, true) => "Now click the surface that should pass through it.",
            (ToolKind::Glue, false) => "Click the first of two rims. It stays where it is.",
            (ToolKind::Glue, true) => "Now click the other rim.",
            (ToolKind::Merge, _) if self.proposal.is_some() => {
                "Enter or a click makes this tube. Wheel: radius, Esc: not so."
            }
            (ToolKind::Merge, false) => "Click where the tube should begin.",
            (ToolKind::Merge, true) => "Click where it should end. Wheel: radius, Enter: closest.",
            (ToolKind::Trim, false) => "Click the part of one surface that should stay.",
            (ToolKind::Trim, true) => "Now click the part of the other that should stay.",
            (ToolKind::Shadow, false) => "Click the region that should take on another's relief.",
            (ToolKind::Shadow, true) => "Now click the stamp: another surface with one rim.",
            _ => "Click the closed curve whose size it should get.",
        }
    }

    /// The first curve of a sweep under way.
    #[must_use]
    pub fn sweep_from(&self) -> Option<CurveId> {
        match self.first {
            Some(Pick::Curve(curve) | Pick::Stretch(curve, _)) => Some(curve),
            _ => None,
        }
    }

    /// The control point at which a stretch, or the split of a face, begins whose other end is awaited.
    #[must_use]
    pub fn stretch_from(&self) -> Option<PointId> {
        self.end
    }

    /// The first place of a tool that wants two.
    #[must_use]
    pub fn first_place(&self) -> Option<Place> {
        match (self.proposal, self.first) {
            (Some([from, _]), _) | (None, Some(Pick::Place(from))) => Some(from),
            _ => None,
        }
    }

    /// The ends of the tube that is shown and waits to be made.
    #[must_use]
    pub fn proposed(&self) -> Option<[Place; 2]> {
        self.proposal
    }

    pub(super) fn pick_sweep(&mut self, hit: Option<&Hit>, around: Surroundings<'_>) -> Vec<Act> {
        let is_closed = |pick: Pick| match pick {
            Pick::Curve(id) => span(around.structure, id).is_some_and(|span| span.closed),
            Pick::Stretch(..) | Pick::Place(_) => false,
        };
        let side = match (hit, self.end.take()) {
            (Some(Hit::Point { id, .. }), None) => {
                self.end = Some(*id);
                return Vec::new();
            }
            (Some(Hit::Point { id, .. }), Some(end)) => match stretch(around.document, end, *id) {
                Some(side) => side,
                None => return say("No curve runs through both points."),
            },
            _ => match curve_hit(hit) {
                Some(curve) => Pick::Curve(curve),
                None => return say("There is no curve here."),
            },
        };
        let Some(first) = self.first else {
            self.first = Some(side);
            return Vec::new();
        };
        if first == side {
            return say("A sweep needs two different curves.");
        }
        if is_closed(first) != is_closed(side) {
            return say(
                "One of these curves is closed and the other is open: nothing can be swept between them.",
            );
        }
        let [(Some(from), one), (Some(to), other)] = [first, side].map(Pick::side) else { return Vec::new() };
        let reversed = self.conclude();
        vec![Act::Edit(Edit::Sweep { from, to, stretches: [one, other], reversed })]
    }

    pub(super) fn pick_embed(&mut self, aim: Aim<'_>) -> Vec<Act> {
        let Some(curve) = self.sweep_from() else {
            let Some(curve) = curve_hit(aim.hit) else {
                return say("There is no curve here. Click a curve near a surface.");
            };
            self.first = Some(Pick::Curve(curve));
            return Vec::new();
        };
        let Some(surface) = aim.surface else { return say("There is no surface here.") };
        self.conclude();
        vec![Act::Edit(Edit::Embed { curve, surface })]
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
        if self.proposal.is_some() {
            return self.make_proposed(suited);
        }
        let Some(to) = place else {
            return say("There is no surface here. A tube begins and ends on surfaces.");
        };
        let Some(from) = self.first_place() else { return self.begin(to) };
        if from.at.distance(to.at) < f32::EPSILON {
            return say("The tube would end where it begins. Click another place.");
        }
        self.proposal = Some([from, to]);
        self.make_proposed(suited)
    }

    /// Shows a tube between places that were not clicked, the closest ones; it is made by Enter or a click.
    pub fn propose(&mut self, ends: [Place; 2]) {
        self.proposal = Some(ends);
    }

    pub(super) fn make_proposed(&mut self, suited: f64) -> Vec<Act> {
        let Some([from, to]) = self.proposal else { return Vec::new() };
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

    fn begin(&mut self, place: Place) -> Vec<Act> {
        self.first = Some(Pick::Place(place));
        Vec::new()
    }

    /// The tool begins anew; says whether the act that it has done was to be the other way round.
    fn conclude(&mut self) -> bool {
        (self.first, self.end, self.proposal) = (None, None, None);
        std::mem::take(&mut self.options.reversed)
    }
}

impl Pick {
    /// The curve, and of which of its stretches this is about.
    fn side(self) -> (Option<CurveId>, Option<[PointId; 2]>) {
        match self {
            Self::Curve(curve) => (Some(curve), None),
            Self::Stretch(curve, ends) => (Some(curve), Some(ends)),
            Self::Place(_) => (None, None),
        }
    }
}

/// The stretch between two control points of a curve; of several curves through both the first.
#[must_use]
pub fn stretch(document: &Document, from: PointId, to: PointId) -> Option<Pick> {
    let has_both = |curve: &Curve| curve.through.contains(&from) && curve.through.contains(&to);
    let curve = document.curves.iter().find(|(_, curve)| has_both(curve)).filter(|_| from != to)?;
    Some(Pick::Stretch(*curve.0, [from, to]))
}

fn curve_hit(hit: Option<&Hit>) -> Option<CurveId> {
    match hit {
        Some(Hit::Curve { id, .. }) => Some(*id),
        _ => None,
    }
}
