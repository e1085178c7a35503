//! Dividing a face of a cage between two of its corners: the first is kept until the second is clicked.

use super::{Act, Selection, ToolKind, Toolbox, say};
use crate::Hit;
use ductile_spec::{Document, Edit, PointId, SurfaceId};

impl Toolbox {
    pub(super) fn divide_hint(&self) -> &'static str {
        match self.end {
            None => "Click a corner of the face that should be split.",
            Some(_) => "Now click another corner of the face, along a line.",
        }
    }

    /// Awaits the corners between which a face should be split; the first of them may be known.
    pub fn choose_divide(&mut self, first: Option<PointId>) {
        self.choose(ToolKind::Divide);
        self.end = first;
    }

    pub(super) fn pick_corner(&mut self, hit: Option<&Hit>, document: &Document) -> Vec<Act> {
        let corner = match hit {
            Some(Hit::Point { id, .. }) if document.cages_on(*id).next().is_some() => *id,
            _ => return say("There is no vertex of a cage here."),
        };
        let Some(first) = self.end.filter(|first| *first != corner) else {
            // The first once more lets it go.
            self.end = if self.end.is_none() { Some(corner) } else { None };
            return vec![Act::Select(Selection::Point(corner))];
        };
        let between = [first, corner];
        match face_between(document, between) {
            Ok((surface, face)) => {
                self.end = None;
                vec![Act::Edit(Edit::SplitFace { surface, face, between: Some(between) })]
            }
            Err(why) => say(why),
        }
    }
}

/// The face of a cage that two points can divide: both are corners of it, and no neighbours.
///
/// # Errors
/// Why there is none, for the designer.
pub fn face_between(document: &Document, [a, b]: [PointId; 2]) -> Result<(SurfaceId, u32), &'static str> {
    let mut why = "No face of a cage has both corners.";
    for (surface, cage) in &document.cages {
        for (face, corners) in (0_u32..).zip(&cage.faces) {
            let place = |point| corners.iter().position(|corner| *corner == point);
            let (Some(from), Some(to)) = (place(a), place(b)) else { continue };
            let apart = from.abs_diff(to);
            if apart > 1 && apart + 1 < corners.len() {
                return Ok((*surface, face));
            }
            why = "An edge joins these corners already: a face is split between corners that are no neighbours.";
        }
    }
    Err(why)
}

#[cfg(test)]
mod tests {
    use super::super::{ToolKey, Toolbox};
    use super::*;
    use glam::Vec3;
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    /// A pentagon and a triangle with the edge 2-3 in common.
    fn cage() -> Document {
        let mut document = Document::default();
        let faces =
            [&[1, 2, 3, 4, 5][..], &[3, 2, 6]].map(|face| face.iter().copied().map(PointId).collect());
        document.cages.insert(SurfaceId(7), ductile_spec::Cage::new(faces.to_vec()));
        document
    }

    fn click(tools: &mut Toolbox, id: u32) -> Vec<Act> {
        tools.pick_corner(Some(&Hit::Point { id: PointId(id), at: Vec3::ZERO }), &cage())
    }

    #[test]
    fn two_corners_of_a_face_divide_it_and_the_tool_stays() {
        let mut tools = Toolbox::default();
        tools.choose_divide(None);
        assert_eq!(click(&mut tools, 1), [Act::Select(Selection::Point(PointId(1)))]);
        assert!(tools.is_under_way());
        let between = Some([1, 3].map(PointId));
        let split = Edit::SplitFace { surface: SurfaceId(7), face: 0, between };
        assert_eq!(click(&mut tools, 3), [Act::Edit(split)]);
        assert_eq!((tools.kind(), tools.is_under_way()), (ToolKind::Divide, false));
        tools.choose_divide(Some(PointId(4)));
        assert_eq!(click(&mut tools, 4).len(), 1);
        assert!(!tools.is_under_way(), "the first once more lets it go");
    }

    #[test]
    fn what_divides_nothing_is_refused_with_its_reason_and_the_first_corner_stays() {
        let mut tools = Toolbox::default();
        tools.choose_divide(Some(PointId(1)));
        for (other, says) in [(2, "An edge joins"), (6, "No face"), (8, "no vertex of a cage")] {
            let [Act::Say(why)] = &click(&mut tools, other)[..] else { panic!("{other}") };
            assert!(why.contains(says), "{why}");
        }
        assert_eq!(tools.stretch_from(), Some(PointId(1)));
        assert!(matches!(tools.pick_corner(None, &cage())[..], [Act::Say(_)]));
    }

    #[test]
    fn escape_lets_the_corner_go_and_then_goes_back_to_the_cage_tool() {
        let mut tools = Toolbox::default();
        tools.choose_divide(Some(PointId(1)));
        let (structure, document) = (ductile_spec::Structure::default(), cage());
        let around = super::super::Surroundings {
            structure: &structure,
            document: &document,
            forward: Vec3::NEG_Z,
            radius: 1.0,
            size: 1.0,
        };
        assert!(tools.key(ToolKey::Escape, around).is_empty());
        assert_eq!((tools.kind(), tools.is_under_way()), (ToolKind::Divide, false));
        assert!(tools.key(ToolKey::Escape, around).is_empty());
        assert_eq!(tools.kind(), ToolKind::Cage);
    }
}
