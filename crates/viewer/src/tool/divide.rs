//! What is done between two vertices of a cage: dividing a face, and making a curve of a part of a rim. The first is kept until the
//! second is clicked.

use super::{Act, Selection, ToolKind, Toolbox, say};
use crate::Hit;
use ductile_spec::{Document, Edit, PointId, SurfaceId};

impl Toolbox {
    pub(super) fn divide_hint(&self) -> &'static str {
        match (self.rim, self.end) {
            (Some(_), None) => "Click the vertex where the curve begins.",
            (Some(_), Some(_)) => "Now click the vertex where it ends.",
            (None, None) => "Click a corner of the face that should be split.",
            (None, Some(_)) => "Now click another corner of the face, along a line.",
        }
    }

    /// Awaits the corners between which a face should be split; the first of them may be known.
    pub fn choose_divide(&mut self, first: Option<PointId>) {
        self.choose(ToolKind::Divide);
        self.end = first;
    }

    /// Awaits the vertices between which the rim at an edge becomes a curve, the edge within it.
    pub fn choose_rim(&mut self, surface: SurfaceId, ends: [PointId; 2]) {
        self.choose(ToolKind::Divide);
        self.rim = Some((surface, ends));
    }

    /// The edge at a rim of which a part is to become a curve.
    #[must_use]
    pub fn rim(&self) -> Option<(SurfaceId, [PointId; 2])> {
        self.rim
    }

    /// What between vertices would become a curve: the vertices along it.
    #[must_use]
    pub fn rim_part(&self, document: &Document, between: [PointId; 2]) -> Option<Vec<PointId>> {
        let (surface, ends) = self.rim?;
        let cage = document.cages.get(&surface)?;
        cage.rim_between(cage.rim_edge(ends)?, between)
    }

    /// Where a curve of the rim could begin: the vertices of the whole stretch.
    #[must_use]
    pub fn rim_vertices(&self, document: &Document) -> Vec<PointId> {
        let stretch = self.rim.and_then(|(surface, ends)| {
            let cage = document.cages.get(&surface)?;
            Some(cage.rim_stretch(cage.rim_edge(ends)?[0]).0)
        });
        stretch.unwrap_or_default()
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
        if let Some((surface, ends)) = self.rim {
            if self.rim_part(document, between).is_none() {
                return say("The edge that was chosen does not lie between these vertices of the rim.");
            }
            self.choose(ToolKind::Shape);
            return vec![Act::Edit(Edit::Rim { surface, ends, between: Some(between) })];
        }
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
    fn a_part_of_a_rim_is_picked_between_two_vertices() {
        // Three quads in a row, the vertices 1 to 4 along one side.
        let mut document = Document::default();
        let faces = [[1, 2, 6, 5], [2, 3, 7, 6], [3, 4, 8, 7]].map(|face| face.map(PointId).to_vec());
        document.cages.insert(SurfaceId(7), ductile_spec::Cage::new(faces.to_vec()));
        let mut tools = Toolbox::default();
        let (surface, ends) = (SurfaceId(7), [3, 2].map(PointId));
        tools.choose_rim(surface, ends);
        assert_eq!(
            tools.rim_vertices(&document),
            [1, 2, 3, 4].map(PointId),
            "from where the rim turns to where it turns"
        );
        let mut click = |id: u32| {
            let hit = Hit::Point { id: PointId(id), at: Vec3::ZERO };
            tools.pick_corner(Some(&hit), &document)
        };
        click(1);
        assert!(matches!(click(2)[..], [Act::Say(_)]), "the edge lies elsewhere");
        let between = Some([1, 3].map(PointId));
        assert_eq!(click(3), [Act::Edit(Edit::Rim { surface, ends, between })]);
        assert_eq!((tools.kind(), tools.rim()), (ToolKind::Shape, None));
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
