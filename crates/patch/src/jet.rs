//! Numbers that carry their derivatives: a value with its first and second derivatives by two parameters. Formulas
//! written in them give exact derivatives, without a second copy of each formula.

use std::ops::{Add, Div, Mul, Neg, Sub};

/// A value and its derivatives by `a` and `b`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Jet {
    pub(crate) value: f64,
    pub(crate) a: f64,
    pub(crate) b: f64,
    pub(crate) aa: f64,
    pub(crate) ab: f64,
    pub(crate) bb: f64,
}

impl Jet {
    pub(crate) const ZERO: Self = Self::constant(0.0);
    pub(crate) const ONE: Self = Self::constant(1.0);

    pub(crate) const fn constant(value: f64) -> Self {
        Self { value, a: 0.0, b: 0.0, aa: 0.0, ab: 0.0, bb: 0.0 }
    }

    /// A linear function with this value and these slopes.
    pub(crate) const fn linear(value: f64, a: f64, b: f64) -> Self {
        Self { a, b, ..Self::constant(value) }
    }

    /// The first parameter itself.
    pub(crate) const fn first(value: f64) -> Self {
        Self { a: 1.0, ..Self::constant(value) }
    }

    /// The second parameter itself.
    pub(crate) const fn second(value: f64) -> Self {
        Self { b: 1.0, ..Self::constant(value) }
    }

    /// A function of this, given by its value and its first and second derivative here.
    pub(crate) fn through(self, [value, slope, bend]: [f64; 3]) -> Self {
        Self {
            value,
            a: slope * self.a,
            b: slope * self.b,
            aa: slope * self.aa + bend * self.a * self.a,
            ab: slope * self.ab + bend * self.a * self.b,
            bb: slope * self.bb + bend * self.b * self.b,
        }
    }

    /// The same function in the parameters of the quad, when its own parameters are those of corner `corner` (recipe,
    /// section 2: `(u, v)`, `(v, 1-u)`, `(1-u, 1-v)`, `(1-v, u)`).
    pub(crate) fn turned(self, corner: usize) -> Self {
        let Self { value, a, b, aa, ab, bb } = self;
        match corner {
            0 => self,
            1 => Self { value, a: -b, b: a, aa: bb, ab: -ab, bb: aa },
            2 => Self { value, a: -a, b: -b, aa, ab, bb },
            _ => Self { value, a: b, b: -a, aa: bb, ab: -ab, bb: aa },
        }
    }
}

impl Add for Jet {
    type Output = Self;
    fn add(self, o: Self) -> Self {
        Self {
            value: self.value + o.value,
            a: self.a + o.a,
            b: self.b + o.b,
            aa: self.aa + o.aa,
            ab: self.ab + o.ab,
            bb: self.bb + o.bb,
        }
    }
}

impl Neg for Jet {
    type Output = Self;
    fn neg(self) -> Self {
        self * -1.0
    }
}

impl Sub for Jet {
    type Output = Self;
    fn sub(self, o: Self) -> Self {
        self + -o
    }
}

impl Mul<f64> for Jet {
    type Output = Self;
    fn mul(self, by: f64) -> Self {
        Self {
            value: self.value * by,
            a: self.a * by,
            b: self.b * by,
            aa: self.aa * by,
            ab: self.ab * by,
            bb: self.bb * by,
        }
    }
}

impl Mul for Jet {
    type Output = Self;
    fn mul(self, o: Self) -> Self {
        Self {
            value: self.value * o.value,
            a: self.a * o.value + self.value * o.a,
            b: self.b * o.value + self.value * o.b,
            aa: self.aa * o.value + 2.0 * self.a * o.a + self.value * o.aa,
            ab: self.ab * o.value + self.a * o.b + self.b * o.a + self.value * o.ab,
            bb: self.bb * o.value + 2.0 * self.b * o.b + self.value * o.bb,
        }
    }
}

impl Div for Jet {
    type Output = Self;
    /// From `self = ratio * o`, one derivative after the other: no power of `o` that could overflow or vanish.
    fn div(self, o: Self) -> Self {
        let value = self.value / o.value;
        let a = (self.a - value * o.a) / o.value;
        let b = (self.b - value * o.b) / o.value;
        Self {
            value,
            a,
            b,
            aa: (self.aa - value * o.aa - 2.0 * a * o.a) / o.value,
            ab: (self.ab - value * o.ab - a * o.b - b * o.a) / o.value,
            bb: (self.bb - value * o.bb - 2.0 * b * o.b) / o.value,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Jet;
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    /// Something of all operations.
    fn formula(a: Jet, b: Jet) -> Jet {
        let root = a + b * 2.0;
        let r = libm::sqrt(root.value);
        (a * b - a / (b + Jet::ONE)) * root.through([r, 0.5 / r, -0.25 / (r * root.value)])
    }

    #[test]
    fn derivatives_agree_with_differences() {
        let (a, b, h) = (0.7, 0.4, 1e-4);
        let at = |i: f64, j: f64| formula(Jet::constant(a + i * h), Jet::constant(b + j * h)).value;
        let jet = formula(Jet::first(a), Jet::second(b));
        let close =
            |exact: f64, difference: f64| assert!((exact - difference).abs() < 1e-6, "{exact} {difference}");
        close(jet.a, (at(1.0, 0.0) - at(-1.0, 0.0)) / (2.0 * h));
        close(jet.b, (at(0.0, 1.0) - at(0.0, -1.0)) / (2.0 * h));
        close(jet.aa, (at(1.0, 0.0) - 2.0 * jet.value + at(-1.0, 0.0)) / (h * h));
        close(jet.bb, (at(0.0, 1.0) - 2.0 * jet.value + at(0.0, -1.0)) / (h * h));
        let mixed = at(1.0, 1.0) - at(1.0, -1.0) - at(-1.0, 1.0) + at(-1.0, -1.0);
        close(jet.ab, mixed / (4.0 * h * h));
    }

    #[test]
    fn a_corner_turns_its_derivatives_as_its_parameters() {
        let (u, v) = (Jet::first(0.3), Jet::second(0.2));
        let local = [(u, v), (v, Jet::ONE - u), (Jet::ONE - u, Jet::ONE - v), (Jet::ONE - v, u)];
        for (corner, (a, b)) in local.into_iter().enumerate() {
            let through = formula(a, b);
            let turned = formula(Jet::first(a.value), Jet::second(b.value)).turned(corner);
            for (x, y) in [
                (through.a, turned.a),
                (through.b, turned.b),
                (through.aa, turned.aa),
                (through.ab, turned.ab),
                (through.bb, turned.bb),
            ] {
                assert!((x - y).abs() < 1e-12, "corner {corner}: {x} {y}");
            }
        }
    }
}
