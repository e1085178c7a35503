//! What a solver minimises: the choices, and how several of them share one surface.
//!
//! Sources: thesis eq. (4.2) for the thin plate; recipe section 9 for the others.

/// What a fair shape minimises.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Objective {
    /// `∫ (κ₁² + κ₂²) dA`; of a curve, `∫ κ² ds`.
    #[default]
    ThinPlate,
    /// The variation of curvature, `∫ |∇L|² dA`; of a curve, `∫ κ'² ds`. Spheres, cylinders, circles and lines cost nothing.
    Fair,
    /// `Δ H = 0`, of a curve `κ'' = 0`: the frozen first-order condition of the thin plate. No energy falls on the way.
    Neutral,
    /// The area; of a curve, the length.
    Membrane,
}
