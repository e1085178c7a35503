//! Objectives: how a fitted node is priced, and how that price answers to the fit.
//!
//! An objective is two functions of a [`Fit`](crate::fit::Fit): its value and its adjoint, the derivative with
//! respect to the coefficients, the area and the mean chord. The gradient carries any adjoint back to the positions,
//! so a new objective that looks at one node at a time needs nothing but these two.

pub(crate) mod fair;
pub(crate) mod membrane;
pub(crate) mod thin_plate;

use crate::lanes::Vector;

/// Derivative of an objective with respect to what the fit of a node (or of two) produced.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Adjoint<T> {
    /// With respect to D1 to D5, in normalised coordinates.
    pub(crate) d: [Vector<T>; 5],
    /// With respect to the area.
    pub(crate) area: T,
    /// With respect to the mean chord `h`, the coefficients held fixed.
    pub(crate) h: T,
}
