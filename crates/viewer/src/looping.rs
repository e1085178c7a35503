//! The loop that a fill or a sheet would take through the place of a curve that a tool points at, as the modeler says. One question at a
//! time: the newest place is asked about when the answer to the last one has come, which is shown meanwhile.

use ductile_spec::{CurveId, FoundLoop, Request};
use glam::{DVec3, Vec3};

/// What is known, and what was asked.
#[derive(Clone, Debug, Default)]
pub struct Looping {
    is_asked: bool,
    last: Option<(CurveId, DVec3, bool)>,
    known: Option<CurveId>,
    sides: Vec<Vec<Vec3>>,
    why: Option<String>,
}

impl Looping {
    /// What to ask now that a tool points at a place of a curve; a sheet's loop is the same wherever that is.
    pub fn want(&mut self, curve: CurveId, at: DVec3, sheet: bool) -> Option<Request> {
        let asked = (curve, if sheet { DVec3::ZERO } else { at }, sheet);
        if self.is_asked || self.last == Some(asked) {
            return None;
        }
        self.is_asked = true;
        self.last = Some(asked);
        Some(Request::Loop { curve, at, sheet })
    }

    /// An answer came; none if there is no telling.
    pub fn came(&mut self, found: Option<FoundLoop>) {
        self.is_asked = false;
        self.known = found.as_ref().map(|found| found.curve);
        let (sides, why) = found.map(|found| (found.sides, found.why)).unwrap_or_default();
        self.sides = sides.iter().map(|side| side.iter().map(|at| at.as_vec3()).collect()).collect();
        self.why = why;
    }

    /// The shapes have moved, or are others.
    pub fn moved(&mut self) {
        self.last = None;
    }

    /// There will be no answer, and what is known may be of another model.
    pub fn forget(&mut self) {
        *self = Self::default();
    }

    /// The sides of the loop through the place of a curve; none while it is unknown, or where there is no loop.
    #[must_use]
    pub fn sides(&self, curve: CurveId) -> &[Vec<Vec3>] {
        if self.known == Some(curve) { &self.sides } else { &[] }
    }

    /// Why there is no loop through the curve.
    #[must_use]
    pub fn why(&self, curve: CurveId) -> Option<&str> {
        self.why.as_deref().filter(|_| self.known == Some(curve))
    }

    /// Lines across the loop, from its sides to its middle: a hint of the patch.
    #[must_use]
    pub fn spokes(&self, curve: CurveId) -> Vec<Vec<Vec3>> {
        let (sides, middle) = (self.sides(curve), self.middle(curve));
        sides.iter().filter_map(|side| side.get(side.len() / 2)).map(|at| vec![*at, middle]).collect()
    }

    /// Triangles from the sides of the loop to its middle: a likeness of the patch.
    #[must_use]
    pub fn fan(&self, curve: CurveId) -> Vec<[Vec3; 3]> {
        let middle = self.middle(curve);
        let edges = self.sides(curve).iter().flat_map(|side| side.windows(2));
        edges.map(|ends| [ends[0], ends[1], middle]).collect()
    }

    fn middle(&self, curve: CurveId) -> Vec3 {
        let corners = || self.sides(curve).iter().filter_map(|side| side.first());
        let count = glam::DVec2::new(corners().count().max(1) as f64, 0.0).as_vec2().x;
        corners().sum::<Vec3>() / count
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    #[test]
    fn one_question_at_a_time_and_what_is_known_belongs_to_its_curve() {
        let (mut looping, one) = (Looping::default(), CurveId(1));
        assert!(looping.want(one, DVec3::X, false).is_some());
        assert_eq!(looping.want(one, DVec3::Y, false), None, "the last is not answered");
        let sides = vec![vec![DVec3::ZERO, DVec3::X], vec![DVec3::X, DVec3::Y], vec![DVec3::Y, DVec3::ZERO]];
        looping.came(Some(FoundLoop { curve: one, at: DVec3::X, sides, why: None }));
        assert_eq!(looping.want(one, DVec3::X, false), None, "that is known");
        assert_eq!((looping.sides(one).len(), looping.sides(CurveId(2)).len()), (3, 0));
        let spokes = looping.spokes(one);
        assert!(spokes.iter().all(|spoke| spoke[1].distance(Vec3::new(1.0, 1.0, 0.0) / 3.0) < 1e-6));
        assert_eq!((looping.fan(one).len(), looping.fan(one)[0][2]), (3, spokes[0][1]));
        assert!(looping.want(one, DVec3::X, true).is_some(), "a sheet may take another loop");
        looping.came(None);
        assert_eq!(looping.want(one, DVec3::Y, true), None, "wherever it is pointed at");
        looping.moved();
        assert!(looping.want(one, DVec3::X, false).is_some(), "the shape is another");
        let why = Some("no loop".to_owned());
        looping.came(Some(FoundLoop { curve: one, at: DVec3::X, sides: Vec::new(), why }));
        assert_eq!((looping.sides(one).len(), looping.why(one)), (0, Some("no loop")));
        assert_eq!(looping.why(CurveId(2)), None);
    }
}
