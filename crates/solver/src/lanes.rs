//! One number, or the numbers of two nodes side by side: the fit and its gradient are written once for both.
//!
//! [`Pair`] is one vector register of two `f64`, natively and in wasm. Every operation used here is exact to the last
//! bit of IEEE 754 and works on each lane alone, so a node has the same fit whichever lane it sits in and whichever
//! ordinary node sits beside it. There is no fused multiply-add on purpose: it would give other bits where it exists.

use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

use glam::DVec3;
use wide::f64x2;

/// The numbers of two nodes.
pub(crate) type Pair = f64x2;

/// What the formulas of a node need of a number.
pub(crate) trait Real:
    Copy
    + Default
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + AddAssign
    + SubAssign
{
    /// How many nodes.
    const LANES: usize;
    /// The outcome of a comparison, per lane.
    type Mask: Copy;

    /// The same in every lane.
    fn splat(value: f64) -> Self;
    /// A value for each lane.
    fn gather(value: impl FnMut(usize) -> f64) -> Self;
    /// The value of one lane.
    fn lane(self, lane: usize) -> f64;
    fn sqrt(self) -> Self;
    /// Per lane: is `self < other`? False for NaN.
    fn less(self, other: Self) -> Self::Mask;
    /// Per lane one or the other.
    fn choose(mask: Self::Mask, then: Self, otherwise: Self) -> Self;
    /// Whether it holds in every lane.
    fn all(mask: Self::Mask) -> bool;
}

impl Real for f64 {
    const LANES: usize = 1;
    type Mask = bool;

    #[inline(always)]
    fn splat(value: f64) -> Self {
        value
    }
    #[inline(always)]
    fn gather(mut value: impl FnMut(usize) -> Self) -> Self {
        value(0)
    }
    #[inline(always)]
    fn lane(self, _: usize) -> f64 {
        self
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Self::sqrt(self)
    }
    #[inline(always)]
    fn less(self, other: Self) -> bool {
        self < other
    }
    #[inline(always)]
    fn choose(mask: bool, then: Self, otherwise: Self) -> Self {
        if mask { then } else { otherwise }
    }
    #[inline(always)]
    fn all(mask: bool) -> bool {
        mask
    }
}

impl Real for Pair {
    const LANES: usize = 2;
    type Mask = Self;

    #[inline(always)]
    fn splat(value: f64) -> Self {
        Self::splat(value)
    }
    #[inline(always)]
    fn gather(mut value: impl FnMut(usize) -> f64) -> Self {
        Self::new([value(0), value(1)])
    }
    #[inline(always)]
    fn lane(self, lane: usize) -> f64 {
        self.to_array()[lane]
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Self::sqrt(self)
    }
    #[inline(always)]
    fn less(self, other: Self) -> Self {
        self.simd_lt(other)
    }
    #[inline(always)]
    fn choose(mask: Self, then: Self, otherwise: Self) -> Self {
        mask.select(then, otherwise)
    }
    #[inline(always)]
    fn all(mask: Self) -> bool {
        mask.all()
    }
}

/// A vector in space, or two of them.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Vector<T> {
    pub(crate) x: T,
    pub(crate) y: T,
    pub(crate) z: T,
}

impl<T: Real> Vector<T> {
    #[inline(always)]
    pub(crate) fn zero() -> Self {
        Self::default()
    }

    #[inline(always)]
    pub(crate) fn gather(mut value: impl FnMut(usize) -> DVec3) -> Self {
        // One closure call a lane: callers index memory in it.
        let lanes: [DVec3; 2] = [value(0), if T::LANES > 1 { value(1) } else { DVec3::ZERO }];
        Self {
            x: T::gather(|lane| lanes[lane].x),
            y: T::gather(|lane| lanes[lane].y),
            z: T::gather(|lane| lanes[lane].z),
        }
    }

    #[inline(always)]
    pub(crate) fn lane(self, lane: usize) -> DVec3 {
        DVec3::new(self.x.lane(lane), self.y.lane(lane), self.z.lane(lane))
    }

    #[inline(always)]
    pub(crate) fn dot(self, other: Self) -> T {
        self.x * other.x + self.y * other.y + self.z * other.z
    }

    #[inline(always)]
    pub(crate) fn cross(self, other: Self) -> Self {
        Self {
            x: self.y * other.z - self.z * other.y,
            y: self.z * other.x - self.x * other.z,
            z: self.x * other.y - self.y * other.x,
        }
    }

    #[inline(always)]
    pub(crate) fn length(self) -> T {
        self.dot(self).sqrt()
    }
}

impl<T: Real> Add for Vector<T> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self { x: self.x + other.x, y: self.y + other.y, z: self.z + other.z }
    }
}

impl<T: Real> Sub for Vector<T> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self { x: self.x - other.x, y: self.y - other.y, z: self.z - other.z }
    }
}

impl<T: Real> Mul<T> for Vector<T> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, factor: T) -> Self {
        Self { x: self.x * factor, y: self.y * factor, z: self.z * factor }
    }
}

impl<T: Real> AddAssign for Vector<T> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl<T: Real> SubAssign for Vector<T> {
    #[inline(always)]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}
