//! The model: the document and the shapes that approximate it. Cloning shares what is unchanged.

use crate::density;
use crate::error::ModelError;
use crate::growth::{Beginning, Ground};
use crate::patch::{self, PatchShape};
use crate::rehydrate::{Fineness, build_curve, build_surface, check_extents};
use crate::shape::{CurveShape, SurfaceShape, edit};
use ductile_spec::{CurveId, Document, PointId, SurfaceId};
use glam::DVec3;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Most nodes that a surface may come to have by acts and drags, unless the document asked for more when it was opened or its
/// spacing was chosen: nobody pulls a point far away to have a mesh that is six times as slow.
pub(crate) const NODE_BUDGET: usize = 20_000;
/// Most nodes that a document may ask for by its spacing.
pub(crate) const MOST_NODES: usize = 120_000;
/// Spacing of a new document, as a part of the model's radius: about 700 nodes on a disc.
const DEFAULT_SPACING: f64 = 0.07;

/// A document with its shapes.
#[derive(Clone, Debug, Default)]
pub struct Model {
    /// What was specified.
    pub document: Arc<Document>,
    /// The curves as they are now.
    pub curves: BTreeMap<CurveId, Arc<CurveShape>>,
    /// The surfaces as they are now.
    pub surfaces: BTreeMap<SurfaceId, Arc<SurfaceShape>>,
    /// The exact surfaces as they are now.
    pub patches: BTreeMap<SurfaceId, Arc<PatchShape>>,
    /// Where the shapes come from.
    pub(crate) making: Making,
    /// Whether they had come to rest when they were last seen.
    pub(crate) rests: bool,
    /// Nodes of the largest surface when the document was opened.
    asked: usize,
    revisions: u64,
}

/// Where the shapes of a model come from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Making {
    /// They were built from the document and are on the way to their rest.
    #[default]
    Opened,
    /// They rest as they do whenever the document is opened: a function of the document alone.
    Own,
    /// Moved controls, or steps with other budgets, brought them where they are.
    Worked,
    /// Acts made them what they are; whether they come to rest without folds, and whether what the document opens to is not much
    /// cheaper, is not known yet.
    Acted,
    /// Controls of what acts had made were moved; whether they come to rest without folds is not known yet.
    Moved,
    /// Acts made them what they are, or what the document opens to is another shape or a worse one.
    Kept,
}

impl Model {
    /// Builds the shapes of a document, ready to be relaxed.
    ///
    /// # Errors
    /// [`ModelError`] when the document cannot be built.
    pub fn from_document(document: Document) -> Result<Self, ModelError> {
        document.validate()?;
        Self::build(Arc::new(document), 0, Beginning::Grown)
    }

    /// The same with the linear skins over the skeletons, which nothing has relaxed: all that is to be known of the topology of
    /// a document's surfaces, in a small part of the time.
    ///
    /// # Errors
    /// [`ModelError`] when the document cannot be built.
    pub fn skins_of(document: Document) -> Result<Self, ModelError> {
        document.validate()?;
        Self::build(Arc::new(document), 0, Beginning::Skin)
    }

    /// The document with the least skeletons that hold the topology and the controls of what its surfaces are now (thesis
    /// section 5.2).
    #[must_use]
    pub fn dehydrated(&self) -> Document {
        let mut document = Document::clone(&self.document);
        for (id, shape) in &self.surfaces {
            if let Some(surface) = document.surfaces.get_mut(id) {
                surface.skeleton = crate::skeleton::skeleton_of(self, shape);
            }
        }
        document
    }

    /// Builds the shapes of the same document anew. Revisions go on from this model's, so that the new shapes can take the
    /// place of its own.
    ///
    /// # Errors
    /// [`ModelError`] when the document cannot be built.
    pub(crate) fn reopened(&self) -> Result<Self, ModelError> {
        Self::build(Arc::clone(&self.document), self.revisions, Beginning::Grown)
    }

    fn build(document: Arc<Document>, revisions: u64, beginning: Beginning) -> Result<Self, ModelError> {
        let mut model = Self { document, revisions, asked: MOST_NODES, ..Self::default() };
        for id in model.document.curves.keys().copied().collect::<Vec<_>>() {
            model.build_curve(id)?;
        }
        for id in model.document.surfaces.keys().copied().collect::<Vec<_>>() {
            model.raise_surface(id, beginning)?;
        }
        let exact = model.document.cages.keys().chain(model.document.fills.keys());
        for id in exact.chain(model.document.meshes.keys()).copied().collect::<Vec<_>>() {
            model.build_patch(id)?;
        }
        model.asked = model.surfaces.values().map(|shape| shape.mesh.vertex_count()).max().unwrap_or(0);
        patch::follow(&mut model, None);
        // Whether a loop of curves can be filled changes with the curves; of ribbons it is known once and for all.
        for (surface, fill) in model.document.fills.iter().filter(|(_, fill)| fill.sides.is_empty()) {
            model.check_fill(*surface)?;
            debug_assert!(!fill.ribbons.is_empty(), "the document is valid");
        }
        Ok(model)
    }

    /// Most nodes that a surface may come to have now.
    pub(crate) fn most_nodes(&self) -> usize {
        if self.asked <= NODE_BUDGET { NODE_BUDGET } else { (self.asked + self.asked / 4).min(MOST_NODES) }
    }

    /// Whether the document, whose controls were moved, could be opened again.
    pub(crate) fn check_extents(&self) -> Result<(), ModelError> {
        check_extents(self)
    }

    /// Makes the document different; the shapes follow by their own calls.
    pub(crate) fn document_mut(&mut self) -> &mut Document {
        Arc::make_mut(&mut self.document)
    }

    /// A number that no shape has had yet.
    pub(crate) fn next_revision(&mut self) -> u64 {
        self.revisions += 1;
        self.revisions
    }

    /// Gives every shape a revision that none has had.
    pub(crate) fn renew_revisions(&mut self) {
        for shape in self.curves.values_mut() {
            self.revisions += 1;
            edit(shape).revision = self.revisions;
        }
        for shape in self.surfaces.values_mut() {
            self.revisions += 1;
            edit(shape).revision = self.revisions;
        }
        for shape in self.patches.values_mut() {
            self.revisions += 1;
            edit(shape).set_revision(self.revisions);
        }
    }

    /// Keeps revisions unique after the model was replaced by an older or a new one.
    pub(crate) fn continue_revisions(&mut self, other: &Self) {
        self.revisions = self.revisions.max(other.revisions);
    }

    /// Builds the shape of a curve of the document.
    pub(crate) fn build_curve(&mut self, id: CurveId) -> Result<(), ModelError> {
        let revision = self.next_revision();
        let shape = build_curve(&self.document, id, &density::of_stretches(self, id)?, revision)?;
        self.curves.insert(id, Arc::new(shape));
        Ok(())
    }

    /// Builds the shape of a new surface of the document, from its curves as they are now: its skin, of which the user
    /// sees the rest come (thesis section 7.1.3).
    pub(crate) fn build_surface(&mut self, id: SurfaceId) -> Result<(), ModelError> {
        self.raise_surface(id, Beginning::Skin)
    }

    fn raise_surface(&mut self, id: SurfaceId, beginning: Beginning) -> Result<(), ModelError> {
        let shape = self.grow(id, beginning)?;
        self.surfaces.insert(id, Arc::new(shape));
        Ok(())
    }

    /// What a surface of the document begins as, on its curves as they are now.
    pub(crate) fn grow(&mut self, id: SurfaceId, beginning: Beginning) -> Result<SurfaceShape, ModelError> {
        if !self.document.surfaces.contains_key(&id) {
            return Err(ModelError::NoSurface(id));
        }
        let fineness = Fineness {
            spacing: self.spacing_of(id),
            is_graded: density::graded(self).contains(&id),
            most_nodes: self.most_nodes(),
        };
        let revision = self.next_revision();
        let ground = Ground { document: &self.document, curves: &self.curves, id };
        build_surface(&ground, beginning, fineness, revision)
    }

    /// Whether a fill could follow its curves.
    pub(crate) fn check_fill(&self, surface: SurfaceId) -> Result<(), ModelError> {
        let failure = patch::fill::shape(self, surface).and_then(|shape| shape.failure);
        failure.map_or(Ok(()), |reason| Err(ModelError::Fill { surface, reason }))
    }

    /// Builds an exact surface of the document, from its controls as they are now.
    pub(crate) fn build_patch(&mut self, id: SurfaceId) -> Result<(), ModelError> {
        let revision = self.next_revision();
        let shape = patch::build(self, id, revision)?;
        self.patches.insert(id, Arc::new(shape));
        Ok(())
    }

    /// Target edge length of the document: what it states, or a part of its size.
    #[must_use]
    pub fn spacing(&self) -> f64 {
        self.document.spacing.unwrap_or_else(|| default_spacing(&self.document))
    }

    /// Target edge length of a surface where nothing else is said: its own, or the document's.
    #[must_use]
    pub fn spacing_of(&self, surface: SurfaceId) -> f64 {
        let own = self.document.surfaces.get(&surface).and_then(|surface| surface.spacing);
        own.unwrap_or_else(|| self.spacing())
    }

    /// Where a control point is specified to be.
    pub(crate) fn point(&self, id: PointId) -> Result<DVec3, ModelError> {
        self.document.points.get(&id).copied().ok_or(ModelError::NoPoint(id))
    }

    /// Rough size of the shapes in memory.
    pub(crate) fn shape_bytes(&self) -> usize {
        let surfaces: usize = self.surfaces.values().map(|s| s.bytes()).sum();
        let curves: usize = self.curves.values().map(|c| 24 * c.nodes.len()).sum();
        let patches: usize = self.patches.values().map(|p| p.bytes()).sum();
        surfaces + curves + patches
    }

    /// Mesh nodes of all surfaces and free curves, and vertices of all exact surfaces.
    #[must_use]
    pub fn node_count(&self) -> usize {
        let surfaces: usize = self.surfaces.values().map(|s| s.mesh.vertex_count()).sum();
        let curves: usize = self.curves.values().map(|c| c.nodes.len()).sum();
        let patches: usize = self.patches.values().map(|p| p.positions().len()).sum();
        surfaces + curves + patches
    }
}

/// A spacing with two significant digits, so that a document that states it stays short.
pub(crate) fn default_spacing(document: &Document) -> f64 {
    let (_, radius) = document.extent();
    let wanted = if radius > 0.0 { DEFAULT_SPACING * radius } else { DEFAULT_SPACING };
    round_to_digits(wanted, 2)
}

/// Rounds to a number of significant decimal digits.
pub(crate) fn round_to_digits(value: f64, digits: usize) -> f64 {
    if value == 0.0 || !value.is_finite() {
        return value;
    }
    // Through the decimal text: exact on every machine, which powers and logarithms are not.
    format!("{value:.*e}", digits.saturating_sub(1)).parse().unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::example::example;
    use ductile_spec::Example;
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    #[test]
    fn a_document_may_ask_for_more_nodes_than_an_act_or_a_drag_may_come_to() {
        let mut model = Model::from_document(example(Example::Disc)).unwrap();
        assert_eq!(model.most_nodes(), NODE_BUDGET);
        // The skeleton of a disc of radius 1 is a square of area 2, for which edges of 0.01 ask for 23,100 nodes.
        model.document_mut().spacing = Some(0.01);
        assert!(matches!(model.check_extents(), Err(ModelError::TooFine { limit: NODE_BUDGET, .. })));
        // Had it been opened so, it could go on, with some room for what is pulled.
        model.asked = 36_000;
        assert_eq!((model.most_nodes(), model.check_extents()), (45_000, Ok(())));
        model.asked = 110_000;
        assert_eq!(model.most_nodes(), MOST_NODES);
        model.document_mut().spacing = Some(0.004);
        let opened = Model::from_document((*model.document).clone()).map(drop);
        assert!(matches!(opened, Err(ModelError::TooFine { limit: MOST_NODES, .. })), "{opened:?}");
    }
}
