//! How well surfaces meet, as the modeler says: asked when somebody looks and the shapes rest, and again when they have moved.

use ductile_spec::{FillFigures, Request, Seams, SurfaceId};

/// What is known, and what was asked.
#[derive(Clone, Debug)]
pub struct Reporting {
    is_asked: bool,
    /// The shapes have moved since the question.
    is_stale: bool,
    known: Option<Seams>,
}

impl Default for Reporting {
    fn default() -> Self {
        Self { is_asked: false, is_stale: true, known: None }
    }
}

impl Reporting {
    /// What to ask now that somebody looks.
    pub fn want(&mut self, rests: bool) -> Option<Request> {
        if self.is_asked || !self.is_stale || !rests {
            return None;
        }
        (self.is_asked, self.is_stale) = (true, false);
        Some(Request::Seams)
    }

    /// An answer came.
    pub fn came(&mut self, seams: Option<Seams>) {
        self.is_asked = false;
        self.known = seams;
    }

    /// The shapes have moved, or are others.
    pub fn moved(&mut self) {
        self.is_stale = true;
    }

    /// There will be no answer, and what is known may be of another model.
    pub fn forget(&mut self) {
        *self = Self::default();
    }

    /// The report, if it is about the shapes as they are.
    #[must_use]
    pub fn report(&self) -> Option<&Seams> {
        self.known.as_ref().filter(|_| !self.is_stale)
    }

    /// What it says of a fill.
    #[must_use]
    pub fn of_fill(&self, id: SurfaceId) -> Option<&FillFigures> {
        self.report()?.fills.iter().find(|fill| fill.surface == id)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    #[test]
    fn it_is_asked_for_at_rest_and_again_only_when_shapes_have_moved() {
        let mut reporting = Reporting::default();
        assert_eq!(reporting.want(false), None, "figures of a moving shape mean nothing");
        assert_eq!(reporting.want(true), Some(Request::Seams));
        assert_eq!(reporting.want(true), None, "it is on its way");
        reporting.came(Some(Seams::default()));
        assert!(reporting.report().is_some());
        assert_eq!(reporting.want(true), None);
        reporting.moved();
        assert!(reporting.report().is_none(), "that was another shape");
        assert_eq!(reporting.want(true), Some(Request::Seams));
        // Moved while the answer was on its way: it is about what is no more.
        reporting.moved();
        reporting.came(Some(Seams::default()));
        assert!(reporting.report().is_none());
        assert!(reporting.want(true).is_some());
    }
}
