//! A number that depends on two variables, with its first and second derivatives: sums, products and quotients of jets
//! carry the derivatives along by the rules of Leibniz, so that what is built from them has exact ones.

use core::ops::{Add, Div, Mul};

/// Value, first derivatives and second derivatives by x and y.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Jet {
    pub(crate) value: f64,
    pub(crate) x: f64,
    pub(crate) y: f64,
    pub(crate) xx: f64,
    pub(crate) xy: f64,
    pub(crate) yy: f64,
}

impl Jet {
    pub(crate) const ZERO: Self = Self::constant(0.0);
    pub(crate) const ONE: Self = Self::constant(1.0);

    pub(crate) const fn constant(value: f64) -> Self {
        Self::linear(value, 0.0, 0.0)
    }

    /// A linear function with this value and these slopes.
    pub(crate) const fn linear(value: f64, x: f64, y: f64) -> Self {
        Self { value, x, y, xx: 0.0, xy: 0.0, yy: 0.0 }
    }

    pub(crate) fn scaled(self, by: f64) -> Self {
        Self {
            value: self.value * by,
            x: self.x * by,
            y: self.y * by,
            xx: self.xx * by,
            xy: self.xy * by,
            yy: self.yy * by,
        }
    }
}

impl Add for Jet {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            value: self.value + other.value,
            x: self.x + other.x,
            y: self.y + other.y,
            xx: self.xx + other.xx,
            xy: self.xy + other.xy,
            yy: self.yy + other.yy,
        }
    }
}

impl Mul for Jet {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        Self {
            value: self.value * other.value,
            x: self.x * other.value + self.value * other.x,
            y: self.y * other.value + self.value * other.y,
            xx: self.xx * other.value + 2.0 * (self.x * other.x) + self.value * other.xx,
            xy: self.xy * other.value + self.x * other.y + self.y * other.x + self.value * other.xy,
            yy: self.yy * other.value + 2.0 * (self.y * other.y) + self.value * other.yy,
        }
    }
}

impl Div for Jet {
    type Output = Self;

    /// From `quotient * divisor = self`, derivative by derivative.
    fn div(self, by: Self) -> Self {
        let value = self.value / by.value;
        let x = (self.x - value * by.x) / by.value;
        let y = (self.y - value * by.y) / by.value;
        let xx = (self.xx - 2.0 * (x * by.x) - value * by.xx) / by.value;
        let xy = (self.xy - x * by.y - y * by.x - value * by.xy) / by.value;
        let yy = (self.yy - 2.0 * (y * by.y) - value * by.yy) / by.value;
        Self { value, x, y, xx, xy, yy }
    }
}

#[cfg(test)]
mod tests {
    use super::Jet;
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    #[test]
    fn a_rational_function_has_its_derivatives() {
        // f = x^2 y / (1 + x), by hand at (2, 3)
        let (x, y) = (Jet::linear(2.0, 1.0, 0.0), Jet::linear(3.0, 0.0, 1.0));
        let f = x * x * y / (Jet::ONE + x);
        let close = |found: f64, exact: f64| assert!((found - exact).abs() < 1e-15 * 8.0, "{found} {exact}");
        close(f.value, 4.0);
        close(f.x, 3.0 * (2.0 * 2.0 + 4.0) / 9.0); // y (x^2 + 2 x) / (1 + x)^2
        close(f.y, 4.0 / 3.0);
        close(f.xx, 3.0 * 2.0 / 27.0); // 2 y / (1 + x)^3
        close(f.xy, 8.0 / 9.0);
        close(f.yy, 0.0);
        assert_eq!(f.scaled(2.0).x, 2.0 * f.x);
    }
}
