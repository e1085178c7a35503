//! The tools of surgery in the page: what they are aimed at, and what they mark before a click.

use super::page::Page;
use crate::input::Modifiers;
use crate::tool::{Aim, Place, Selection, Surroundings, ToolKind, ties, tube};
use crate::{Highlight, Hit, RimHit, Tinted, Wanted, closest_places, pick_among};
use ductile_spec::{CurveId, SurfaceId};
use glam::{Vec2, Vec3};

/// How much nearer to a rim than to a curve the pointer need not come: rims lie along curves and are met with their surface.
const RIM_REACH: f32 = 1.6;

impl Page {
    /// The surface under the pointer, or, beside its edge, the one nearest to the thing that was hit.
    pub(crate) fn surface_at(&self, at: Vec2, hit: Option<&Hit>) -> Option<SurfaceId> {
        let below = Wanted { points: false, curves: false, ..Wanted::ALL };
        match pick_among(&self.scene, &self.camera, at, 0.0, below) {
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
            let below = Wanted { points: false, curves: false, ..Wanted::ALL };
            stroke.add(at, pick_among(&self.scene, &self.camera, at, 0.0, below));
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

    /// Merges at the closest places of the first surface and the one under the pointer, or the only other one.
    pub(crate) fn merge_closest(&mut self) {
        let Some(from) = self.tools.first_place() else {
            self.notices.refusal("Click where the tube should begin first.");
            return;
        };
        let others =
            || self.scene.structure.surfaces.iter().map(|span| span.id).filter(|id| *id != from.surface);
        let other = match self.hand.hover {
            Some(Hit::Surface { id, .. }) if id != from.surface => Some(id),
            _ if others().count() == 1 => others().next(),
            _ => None,
        };
        let places = other.and_then(|other| closest_places(&self.scene, from.surface, other));
        let Some((from, to)) = places else {
            self.notices.refusal("Point at the other surface, or click where the tube should end.");
            return;
        };
        let acts = self.tools.merge_between(from, to, self.suited_radius());
        self.perform(acts);
    }

    /// A region, or a surface in one piece, is tinted whole: no place in it counts more than another.
    pub(crate) fn mark_region(&self, mark: &mut Highlight) {
        mark.tinted.clear();
        if let Some(Hit::Surface { id, triangle, .. }) = mark.hover {
            let region = self.scene.region_of(triangle);
            mark.tinted.push(region.map_or(Tinted::Surface(id), |region| Tinted::Region(id, region)));
            mark.hover = None;
        }
    }

    /// The first curve is marked; over a second one, how the two would be tied.
    pub(crate) fn mark_ties(&self, mark: &mut Highlight) {
        let Some(from) = self.tools.sweep_from() else { return };
        mark.selected_curve = Some(from);
        let Some(Hit::Curve { id: to, .. }) = mark.hover else { return };
        let closed = |id: CurveId| self.scene.curve(id).is_some_and(|curve| curve.closed);
        if self.tools.kind() != ToolKind::Sweep || from == to || closed(from) != closed(to) {
            return;
        }
        let [one, other]: [Vec<Vec3>; 2] = [from, to].map(|id| self.scene.samples(id).collect());
        mark.sketch = lines(ties(&one, &other, closed(from), self.tools.options().reversed));
    }

    /// The rims that would be joined, and how.
    pub(crate) fn mark_rims(&self, mark: &mut Highlight) {
        mark.hover = None;
        let first = self.tools.first_place();
        let first = first.and_then(|place| self.rims.nearest(&self.scene, place.surface, place.at));
        let over = self.hand.hover_rim.filter(|over| first.is_none_or(|first| first.index != over.index));
        let [one, other] = [first, over].map(|rim| rim.map(|rim| self.rims.places(&self.scene, rim.index)));
        if let (Some(one), Some(other)) = (&one, &other) {
            mark.sketch = lines(ties(one, other, true, self.tools.options().reversed));
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

    /// The first place, and the tube to the pointer or the two surfaces that would be trimmed with the lines in which they meet.
    pub(crate) fn mark_places(&self, mark: &mut Highlight) {
        mark.tinted.clear();
        let first = self.tools.first_place();
        mark.ghost.extend(first.map(|place| place.at));
        let over = match mark.hover {
            Some(Hit::Surface { id, at, normal, .. }) => {
                Some(Place { surface: id, at, normal: Some(normal) })
            }
            _ => None,
        };
        if self.tools.kind() == ToolKind::Trim {
            let both = [first, over].into_iter().flatten();
            mark.tinted.extend(both.map(|place| Tinted::Surface(place.surface)));
            mark.sketch = self.trimmed_pair().map_or(&[][..], |pair| self.meetings.lines(pair)).to_vec();
            return;
        }
        if let Some((from, to)) = first.zip(over) {
            let radius = glam::DVec2::new(self.tube_radius(), 0.0).as_vec2().x;
            mark.sketch = tube(from, to, radius);
            for circle in mark.sketch.iter_mut().take(2) {
                circle.extend(circle.first().copied());
            }
        }
    }
}

fn lines(ties: Vec<[Vec3; 2]>) -> Vec<Vec<Vec3>> {
    ties.into_iter().map(|ends| ends.to_vec()).collect()
}
