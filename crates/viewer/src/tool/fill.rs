//! The Fill tool: a click on a curve fills the loop through that place. Corners can be picked: of a closed curve among its points, of a loop
//! of several curves those inside them.

use super::{Act, Aim, Options, Toolbox, say};
use crate::Hit;
use ductile_spec::{CurveId, Document, Edit, Hole, PointId};

/// Fewest corners of a patch.
const LEAST: usize = 3;

impl Toolbox {
    /// The corners that were picked for a fill.
    #[must_use]
    pub fn picked(&self) -> &[PointId] {
        &self.picked
    }

    pub(super) fn fill_hint(&self) -> &'static str {
        match self.picked.len() {
            0 => "Click a curve to fill its loop, or points as corners.",
            1..LEAST => "Click more corners, three or more; where curves meet, Enter.",
            _ => "Enter fills between these corners. Or click more.",
        }
    }

    /// Whether a point could be a corner: one of a closed curve that has those picked, too, or of curves that may make a loop.
    #[must_use]
    pub fn could_be_corner(&self, document: &Document, point: PointId) -> bool {
        let all = self.picked.iter().copied().chain([point]);
        curve_of(document, all.clone()).is_some()
            || all.clone().all(|point| chain_at(document, point).is_some())
    }

    pub(super) fn click_fill(&mut self, aim: Aim<'_>, document: &Document) -> Vec<Act> {
        match aim.hit {
            Some(Hit::Point { id, .. }) if !self.could_be_corner(document, *id) => {
                say("Corners are picked among the points of one closed curve, or inside curves that meet.")
            }
            Some(Hit::Point { id, .. }) => {
                let before = self.picked.len();
                self.picked.retain(|other| other != id);
                if self.picked.len() == before {
                    self.picked.push(*id);
                }
                Vec::new()
            }
            Some(Hit::Curve { id, .. }) if !self.picked.is_empty() => self.fill_between(document, Some(*id)),
            Some(Hit::Curve { id, at }) => {
                let hole = Hole::Near { curve: *id, at: Some(at.as_dvec3()) };
                vec![Act::Edit(Edit::Fill { hole, style: self.options.fill })]
            }
            _ => say("There is no curve here. Click a curve of the loop, or a rim that a curve holds."),
        }
    }

    /// Something was filled: the corners have done what they were picked for.
    pub fn filled(&mut self) {
        self.picked.clear();
    }

    /// Fills between the corners that were picked, along a curve that was clicked. They stay until that is done, for another join if this
    /// one is refused.
    pub(super) fn fill_between(&mut self, document: &Document, along: Option<CurveId>) -> Vec<Act> {
        let points = self.picked.clone();
        let closed = curve_of(document, points.iter().copied()).filter(|_| points.len() >= LEAST);
        let chain = || points.iter().find_map(|point| chain_at(document, *point));
        // Among curves that meet at a corner the one that was clicked is meant.
        let curve = closed.or_else(|| chain().map(|first| along.unwrap_or(first)));
        match curve {
            Some(curve) => {
                let hole = Hole::Corners { curve, points };
                vec![Act::Edit(Edit::Fill { hole, style: self.options.fill })]
            }
            None => say("A patch needs at least three corners: click more points of this curve."),
        }
    }
}

/// The closed curve that has all these points.
fn curve_of(document: &Document, points: impl Iterator<Item = PointId> + Clone) -> Option<CurveId> {
    let has_all = |(_, curve): &(&CurveId, &ductile_spec::Curve)| {
        curve.closed && points.clone().all(|point| curve.through.contains(&point))
    };
    document.curves.iter().find(has_all).map(|(id, _)| *id)
}

/// A curve that meets others, so that it may be one of a loop, and has this point inside: where it ends there is a corner anyway.
fn chain_at(document: &Document, point: PointId) -> Option<CurveId> {
    let is_inside = |id: &CurveId| {
        let through = &document.curves[id].through;
        let ends = through.first() == Some(&point) || through.last() == Some(&point);
        !ends && through.iter().any(|point| document.curves_through(*point).nth(1).is_some())
    };
    document.curves_through(point).find(is_inside)
}

/// What fills all loops: of the network of a curve, or of all curves.
pub(super) fn all_loops(curve: Option<CurveId>, options: &Options) -> Edit {
    Edit::FillNetwork { curve, style: options.fill }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ductile_spec::{FillJoin, FillStyle};
    use glam::{DVec3, Vec3};
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    fn click(tools: &mut Toolbox, document: &Document, hit: Option<Hit>) -> Vec<Act> {
        tools.click_fill(Aim { hit: hit.as_ref(), ..Aim::default() }, document)
    }

    #[test]
    fn a_click_on_a_curve_fills_there_as_chosen_and_one_beside_it_says_why_not() {
        let style = FillStyle { degree: Some(4), join: FillJoin::Position, ..FillStyle::default() };
        let mut tools = Toolbox::default();
        tools.options_mut().fill = style;
        let hit = Hit::Curve { id: CurveId(3), at: Vec3::Y };
        let hole = Hole::Near { curve: CurveId(3), at: Some(DVec3::Y) };
        let document = Document::default();
        assert_eq!(click(&mut tools, &document, Some(hit)), [Act::Edit(Edit::Fill { hole, style })]);
        assert!(matches!(click(&mut tools, &document, None)[..], [Act::Say(_)]));
        assert_eq!(tools.fill_all(None), Edit::FillNetwork { curve: None, style });
    }

    #[test]
    fn corners_are_picked_among_the_points_of_one_closed_curve() {
        let mut document = Document::default();
        for (id, through, closed) in
            [(1, [1, 2, 3, 4], true), (2, [5, 6, 7, 8], true), (3, [12, 9, 10, 11], false)]
        {
            let through = through.map(PointId).to_vec();
            document.curves.insert(CurveId(id), ductile_spec::Curve::new(through, closed));
        }
        let mut tools = Toolbox::default();
        tools.choose(super::super::ToolKind::Fill);
        let point = |id: u32| Some(Hit::Point { id: PointId(id), at: Vec3::ZERO });
        let on_curve = Some(Hit::Curve { id: CurveId(1), at: Vec3::ZERO });
        assert!(
            matches!(click(&mut tools, &document, point(9))[..], [Act::Say(_)]),
            "its curve is open and alone"
        );
        for id in [4, 1, 3, 3] {
            assert!(click(&mut tools, &document, point(id)).is_empty());
        }
        assert_eq!(tools.picked(), [4, 1].map(PointId), "the same once more is let go");
        assert!(matches!(click(&mut tools, &document, point(5))[..], [Act::Say(_)]), "of another curve");
        assert!(matches!(click(&mut tools, &document, on_curve)[..], [Act::Say(_)]), "two are too few");
        assert!(tools.is_under_way());
        click(&mut tools, &document, point(2));
        let hole = Hole::Corners { curve: CurveId(1), points: [4, 1, 2].map(PointId).to_vec() };
        let filled = Act::Edit(Edit::Fill { hole, style: FillStyle::default() });
        assert_eq!(click(&mut tools, &document, on_curve), [filled]);
        assert_eq!(tools.picked().len(), 3, "it may be refused");
        tools.filled();
        assert!(!tools.is_under_way());
    }

    #[test]
    fn corners_inside_curves_that_meet_are_picked_one_or_more() {
        let mut document = Document::default();
        for (id, through) in [(1, [1, 2, 3]), (2, [3, 4, 1]), (3, [7, 8, 9])] {
            document
                .curves
                .insert(CurveId(id), ductile_spec::Curve::new(through.map(PointId).to_vec(), false));
        }
        let mut tools = Toolbox::default();
        tools.choose(super::super::ToolKind::Fill);
        let point = |id: u32| Some(Hit::Point { id: PointId(id), at: Vec3::ZERO });
        assert!(
            matches!(click(&mut tools, &document, point(8))[..], [Act::Say(_)]),
            "it meets no other curve"
        );
        assert!(click(&mut tools, &document, point(4)).is_empty());
        let filled = |curve| {
            let hole = Hole::Corners { curve: CurveId(curve), points: vec![PointId(4)] };
            vec![Act::Edit(Edit::Fill { hole, style: FillStyle::default() })]
        };
        assert_eq!(tools.fill_between(&document, None), filled(2), "the curve in which the corner lies");
        let on_curve = Some(Hit::Curve { id: CurveId(1), at: Vec3::ZERO });
        assert_eq!(click(&mut tools, &document, on_curve), filled(1));
        assert!(
            matches!(click(&mut tools, &document, point(1))[..], [Act::Say(_)]),
            "there is a corner anyway"
        );
    }
}
