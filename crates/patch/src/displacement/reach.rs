//! How far one item reaches: from its harmonic function to its blend at every vertex, each step kept.
//!
//! Source: P. Salvi, *Editing the interior of arbitrary surfaces using C∞ displacement blends*, eq. (11), and the recipe,
//! sections 5, 6 and 10.

use super::blend::BlendFunction;
use super::combine::Seen;
use super::error::DisplacementError;
use super::extension::Extension;
use super::item::Item;
use super::laplacian::Stiffness;
use glam::DVec3;

/// How a function that is 1 at a foot and 0 at the border is made.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Profile {
    /// `1 - exp(-2 π g)` with the Green's function `g`: independent of the mesh.
    #[default]
    Conformal,
    /// The paper's: `g / g(foot)`. It depends on the mesh and vanishes under refinement.
    Harmonic,
}

/// An item with its functions at all vertices.
#[derive(Clone, Debug)]
pub(super) struct Reach {
    pub(super) item: Item,
    pub(super) operator: usize,
    pub(super) part: u32,
    /// Green's function of a foot, the harmonic function of a curve.
    pub(super) harmonic: Vec<f64>,
    /// `ln ρ`.
    pub(super) logarithm: Vec<f64>,
    pub(super) blend: Vec<f64>,
    /// The weight of the combination times the blend.
    pub(super) share: Vec<f64>,
    pub(super) extension: Option<Extension>,
    /// The displacement at each vertex where it varies.
    pub(super) field: Option<Vec<DVec3>>,
}

impl Reach {
    pub(super) fn new(item: Item, operator: usize, part: u32, harmonic: Vec<f64>) -> Self {
        let (logarithm, blend, share) = (Vec::new(), Vec::new(), Vec::new());
        let (extension, field) = (None, None);
        Self { item, operator, part, harmonic, logarithm, blend, share, extension, field }
    }

    /// `ln ρ` from the harmonic function, within its bounds whatever the mesh; minus infinity on the item itself.
    pub(super) fn profile(&mut self, profile: Profile) {
        let is_curve = self.item.is_curve();
        let at_foot = self.item.at_foot(&self.harmonic);
        let logarithm = |&value: &f64| {
            if !is_curve && profile == Profile::Conformal {
                return (-core::f64::consts::TAU * value).min(0.0);
            }
            // A curve has a positive capacity: its harmonic function converges and needs no exponential.
            let height = if is_curve { value } else { value / at_foot };
            libm::log1p(-height.clamp(0.0, 1.0))
        };
        self.logarithm = self.harmonic.iter().map(logarithm).collect();
        for &vertex in self.item.met() {
            self.logarithm[vertex] = f64::NEG_INFINITY;
        }
    }

    pub(super) fn seen(&self) -> Seen<'_> {
        let rho = self.logarithm.iter().map(|&logarithm| libm::exp(logarithm)).collect();
        Seen { part: self.part, vertices: self.item.met(), rho }
    }

    pub(super) fn refresh_blend(&mut self, function: &BlendFunction) {
        let range = self.item.range;
        let blend = |&logarithm: &f64| function.value(range.apply_to_logarithm(logarithm));
        self.blend = self.logarithm.iter().map(blend).collect();
    }

    /// The blend at the foot of another item. Between vertices `ρ` is linear: so it is where it is a cone.
    pub(super) fn blend_at(&self, other: &Item, function: &BlendFunction) -> f64 {
        let rho: f64 = other.load().map(|(v, share)| libm::exp(self.logarithm[v]) * share).sum();
        function.value(self.item.range.apply_to_logarithm(libm::log(rho)))
    }

    pub(super) fn refresh_field(&mut self, stiffness: &Stiffness) -> Result<(), DisplacementError> {
        self.field = None;
        if self.item.common().is_some() {
            return Ok(());
        }
        let extension = match &mut self.extension {
            Some(extension) => extension,
            none => none.insert(Extension::new(stiffness, &self.item.vertices)?),
        };
        self.field = Some(extension.spread(&self.item.vertices, &self.item.displacements)?);
        Ok(())
    }
}
