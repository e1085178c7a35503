//! The tools of surgery in the page: what they are aimed at, and what they mark before a click.

use super::page::Page;
use crate::input::Modifiers;
use crate::tool::{
    Aim, Pick, Place, Selection, Surroundings, ToolKey, ToolKind, Tube, drawn_ties, loft, no_room, stretch,
    ties, tube,
};
use crate::{Highlight, Hit, RimHit, Skin, Tinted, closest_places};
use ductile_spec::SurfaceId;
use glam::{Vec2, Vec3};

/// How much nearer to a rim than to a curve the pointer need not come: rims lie along curves and are met with their surface.
const RIM_REACH: f32 = 1.6;

/// Lines from a curve to the surface that it would be embedded in, at most.
const DROPS: usize = 32;

impl Page {
    /// The surface under the pointer, or, beside its edge, the one nearest to the thing that was hit.
    pub(crate) fn surface_at(&self, at: Vec2, hit: Option<&Hit>) -> Option<SurfaceId> {
        match self.below(at) {
            Some(Hit::Surface { id, .. }) => Some(id),
            _ => hit.and_then(|hit| self.scene.surface_near(hit.at())),
        }
    }

    /// The rim that a click would take: under the pointer, or else the nearest one of the surface there.
    pub(crate) fn rim_at(&mut self, at: Vec2) -> Option<RimHit> {
        if self.tools.kind() != ToolKind::Glue {
            return None;
        }
        self.rims.refresh(&self.scene);
        let reach = RIM_REACH * self.hand.reach();
        self.rims.under(&self.scene, &self.camera, at, reach).or_else(|| match self.thing_at(at) {
            Some(Hit::Surface { id, at, .. }) => self.rims.nearest(&self.scene, id, at),
            _ => None,
        })
    }

    /// A curve that is being sketched goes on to the pointer.
    pub(crate) fn sketch(&mut self, at: Vec2) {
        let Some(mut stroke) = self.hand.stroke.take() else { return };
        if stroke.wants(at) {
            stroke.add(at, self.below(at));
        }
        self.hand.stroke = Some(stroke);
    }

    /// The sketched curve is done.
    pub(crate) fn end_sketch(&mut self) {
        let Some(stroke) = self.hand.stroke.take() else { return };
        let radius = self.suited_radius();
        let (structure, document) = (&self.scene.structure, &self.document);
        let size = self.suited_size();
        let around = Surroundings { structure, document, forward: self.camera.forward(), radius, size };
        let acts = self.tools.sketched(&stroke, around);
        self.perform(acts);
    }

    /// The tool in hand takes the selected thing, or the middle of the picture: for those without a pointer.
    pub(crate) fn take_selected(&mut self) {
        let hit = match self.selection {
            Selection::Point(id) => self.scene.point(id).map(|at| Hit::Point { id, at }),
            Selection::Curve(id) => self.scene.samples(id).next().map(|at| Hit::Curve { id, at }),
            Selection::Surface(id) if self.tools.kind().wants_surfaces() => {
                let centre = self.scene.ball_of(id).map_or(Vec3::ZERO, |(centre, _)| centre);
                self.scene.hit_near(id, self.picked_place(id).unwrap_or(centre))
            }
            Selection::Surface(_) | Selection::Edge { .. } | Selection::Face { .. } | Selection::None => None,
        };
        let middle = self.camera.middle();
        let place = self.place_on_plane(middle, Modifiers::default());
        let hit = hit.filter(|_| self.tools.kind() != ToolKind::Point);
        let surface = match hit {
            Some(Hit::Surface { id, .. }) => Some(id),
            _ => hit.and_then(|hit| self.scene.surface_near(hit.at())),
        };
        self.rims.refresh(&self.scene);
        let rim =
            surface.zip(hit).and_then(|(surface, hit)| self.rims.nearest(&self.scene, surface, hit.at()));
        let rim = rim.map(|rim| Place { surface: rim.surface, at: rim.at, normal: None });
        self.click_with(Aim { hit: hit.as_ref(), place, corner: None, surface, rim });
    }

    /// Shows the tube at the closest places of the first surface and the one under the pointer, or the only other one; if it
    /// is shown already, makes it.
    pub(crate) fn merge_closest(&mut self) {
        if self.tools.proposed().is_some() {
            self.tool_key(ToolKey::Done);
            return;
        }
        let all: Vec<SurfaceId> = self.scene.structure.surfaces.iter().map(|span| span.id).collect();
        let picked = self.tools.first_place().map(|place| place.surface);
        let Some(from) = picked.or_else(|| all.first().copied().filter(|_| all.len() == 2)) else {
            self.notices.refusal("Click where the tube should begin first.");
            return;
        };
        let mut others = all.into_iter().filter(|id| *id != from);
        let other = match self.hand.hover {
            Some(Hit::Surface { id, .. }) if id != from => Some(id),
            _ => others.next().filter(|_| others.next().is_none()),
        };
        match other.and_then(|other| closest_places(&self.scene, from, other)) {
            Some((from, to)) => {
                self.tools.propose([from, to]);
                self.refresh();
            }
            None => self.notices.refusal("Point at the other surface, or click where the tube should end."),
        }
    }

    /// The line of a curve, or of a stretch of it, and whether it closes.
    fn line_of(&self, pick: Pick) -> Option<(Vec<Vec3>, bool)> {
        let (id, ends) = match pick {
            Pick::Curve(id) => (id, None),
            Pick::Stretch(id, ends) => (id, Some(ends)),
            Pick::Place(_) => return None,
        };
        let closed = self.scene.curve(id)?.closed;
        let line: Vec<Vec3> = self.scene.samples(id).collect();
        match ends {
            None => Some((line, closed)),
            Some([from, to]) => {
                let [from, to] = [self.scene.point(from)?, self.scene.point(to)?];
                Some((between(&line, closed, from, to), false))
            }
        }
    }

    /// What a click of the sweep would take: a curve, or the stretch to the point under the pointer.
    fn swept_at(&self, hover: Option<Hit>) -> Option<Pick> {
        match (hover, self.tools.stretch_from()) {
            (Some(Hit::Curve { id, .. }), _) => Some(Pick::Curve(id)),
            (Some(Hit::Point { id, .. }), Some(from)) => stretch(&self.document, from, id),
            _ => None,
        }
    }

    /// The first curve or stretch is marked; over a second one, how the two would be tied.
    pub(crate) fn mark_ties(&self, mark: &mut Highlight) {
        mark.ghost.extend(self.tools.stretch_from().and_then(|end| self.scene.point(end)));
        let over = if self.tools.kind() == ToolKind::Sweep { self.swept_at(mark.hover) } else { None };
        let first = self.tools.first();
        let [one, other] = [first, over].map(|pick| pick.and_then(|pick| self.line_of(pick)));
        match first {
            Some(Pick::Curve(id)) => mark.selected_curve = Some(id),
            Some(Pick::Stretch(..)) => mark.sketch.extend(one.iter().map(|(line, _)| line.clone())),
            Some(Pick::Place(_)) | None => {}
        }
        if let (Some(Pick::Stretch(..)), Some((line, _))) = (over, &other) {
            mark.sketch.push(line.clone());
        }
        if let (Some((one, closed)), Some((other, too))) = (one, other)
            && first != over
            && closed == too
        {
            let ties = ties(&one, &other, closed, self.tools.options().reversed);
            mark.sketch.extend(drawn_ties(&ties));
            mark.skins.extend((self.tools.kind() == ToolKind::Sweep).then(|| between_ties(&ties, closed)));
        }
    }

    /// The curve is marked that would be embedded, the surface under the pointer, and how it would come to the curve.
    pub(crate) fn mark_embedding(&self, mark: &mut Highlight) {
        mark.tinted.clear();
        let Some(curve) = self.tools.sweep_from() else {
            mark.hover = mark.hover.filter(|hit| matches!(hit, Hit::Curve { .. }));
            return;
        };
        mark.selected_curve = Some(curve);
        let over = self.hand.cursor.and_then(|cursor| self.surface_at(cursor, mark.hover.as_ref()));
        let Some(surface) = over.filter(|_| mark.hover.take().is_some()) else { return };
        mark.tinted.push(Tinted::Surface(surface));
        let line: Vec<Vec3> = self.scene.samples(curve).collect();
        let step = line.len().div_ceil(DROPS).max(1);
        let drop = |at: &Vec3| Some(vec![*at, self.scene.hit_near(surface, *at)?.at()]);
        mark.sketch = line.iter().step_by(step).filter_map(drop).collect();
    }

    /// The rims that would be joined, and how.
    pub(crate) fn mark_rims(&self, mark: &mut Highlight) {
        mark.hover = None;
        let first = self.tools.first_place();
        let first = first.and_then(|place| self.rims.nearest(&self.scene, place.surface, place.at));
        let over = self.hand.hover_rim.filter(|over| first.is_none_or(|first| first.index != over.index));
        let [one, other] = [first, over].map(|rim| rim.map(|rim| self.rims.places(&self.scene, rim.index)));
        if let (Some(one), Some(other)) = (&one, &other) {
            let ties = ties(one, other, true, self.tools.options().reversed);
            mark.sketch = drawn_ties(&ties);
            mark.skins.extend(self.tools.options().skirt.then(|| between_ties(&ties, true)));
        }
        mark.rims = [one, other].into_iter().flatten().collect();
    }

    /// The two surfaces that would be trimmed, once the pointer is on the second.
    fn trimmed_pair(&self) -> Option<(SurfaceId, SurfaceId)> {
        let first = self.tools.first_place().filter(|_| self.tools.kind() == ToolKind::Trim)?.surface;
        match self.hand.hover {
            Some(Hit::Surface { id, .. }) if id != first => Some((first, id)),
            _ => None,
        }
    }

    /// Asks where they meet, if that is not known.
    pub(crate) fn ask_meeting(&mut self) {
        let Some(pair) = self.trimmed_pair() else { return };
        if let Some(question) = self.meetings.want(pair, self.scene.header.settled) {
            self.schedule.push(question);
        }
    }

    /// The tube that a click would make: to the pointer, or as it was proposed.
    fn tube_ends(&self, hover: Option<Hit>) -> Option<[Place; 2]> {
        let first = self.tools.first_place().filter(|_| self.tools.kind() == ToolKind::Merge)?;
        self.tools.proposed().or_else(|| Some([first, place_of(hover)?]))
    }

    /// Why that tube would be refused, as far as the picture tells.
    pub(crate) fn why_no_tube(&self) -> Option<&'static str> {
        let ends = self.tube_ends(self.hand.hover)?;
        no_room(&self.scene, &self.document, &self.rims, ends, self.tube_radius())
    }

    /// The hint says why a tube has no room as soon as it is so.
    pub(crate) fn watch_tube(&mut self) {
        if self.tools.kind() == ToolKind::Merge {
            self.rims.refresh(&self.scene);
        }
        let why = self.why_no_tube();
        if std::mem::replace(&mut self.hand.no_tube, why) != why {
            self.refresh();
        }
    }

    /// The first place, and the tube to the pointer or the two surfaces that would be trimmed with the lines in which they meet.
    pub(crate) fn mark_places(&self, mark: &mut Highlight) {
        mark.tinted.clear();
        let first = self.tools.first_place();
        mark.ghost.extend(first.map(|place| place.at));
        if self.tools.kind() == ToolKind::Trim {
            mark.sketch = self.trimmed_pair().map_or(&[][..], |pair| self.meetings.lines(pair)).to_vec();
            for place in [first, place_of(mark.hover)].into_iter().flatten() {
                self.mark_kept(mark, place);
            }
            return;
        }
        if let Some([from, to]) = self.tube_ends(mark.hover) {
            if self.tools.proposed().is_some() {
                // A click makes this tube, wherever it falls.
                mark.hover = None;
                mark.ghost.push(to.at);
            }
            let radius = glam::DVec2::new(self.tube_radius(), 0.0).as_vec2().x;
            let Tube { lines, struts } = tube(from, to, radius);
            let is_refused = self.hand.no_tube.is_some();
            mark.skins.push(Skin { facets: loft(&struts, true), is_refused });
            mark.sketch = lines;
        }
    }
}

/// The place on a surface under the pointer.
fn place_of(hover: Option<Hit>) -> Option<Place> {
    match hover {
        Some(Hit::Surface { id, at, normal, .. }) => Some(Place { surface: id, at, normal: Some(normal) }),
        _ => None,
    }
}

/// The part of a polyline from the sample nearest to one place to that nearest to another: on a closed one in its sense.
fn between(line: &[Vec3], closed: bool, from: Vec3, to: Vec3) -> Vec<Vec3> {
    let nearest = |at: Vec3| {
        let distance = |k: &usize| line[*k].distance_squared(at);
        (0..line.len()).min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap_or(0)
    };
    let (first, last, count) = (nearest(from), nearest(to), line.len());
    let (first, last) = if closed { (first, last) } else { (first.min(last), first.max(last)) };
    let steps = if last >= first { last - first } else { last + count - first };
    (0..=steps).filter_map(|step| line.get((first + step) % count.max(1)).copied()).collect()
}

fn between_ties(ties: &[[Vec3; 2]], closed: bool) -> Skin {
    let lines: Vec<Vec<Vec3>> = ties.iter().map(|ends| ends.to_vec()).collect();
    Skin { facets: loft(&lines, closed), is_refused: false }
}
