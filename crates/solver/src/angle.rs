//! The angle between two vectors, and the direction of an angle, by polynomials.
//!
//! Nearly all angles of a good mesh lie about 60 degrees: those from 15 to 105 are reckoned from there, without a
//! choice (`angle_between`). The others go through `angle`, which takes any. Each lane chooses for itself.
//!
//! Written for [`Real`], so that two nodes share the work. The polynomials are Chebyshev interpolants of the odd and
//! even parts on the reduced ranges, computed with 60 digits; their own error is below 1e-17, so what is left is
//! rounding: 4e-16 absolute, asserted below against `libm`.

use std::f64::consts::{FRAC_2_PI, FRAC_PI_2, FRAC_PI_4, PI};

use crate::lanes::Real;

/// `(atan(z)/z - 1) / z²` in powers of `z²`, for `|z| <= tan(π/8)`.
const ARC_TANGENT: [f64; 11] = [
    -0.333_333_333_333_333_3,
    0.199_999_999_999_955_2,
    -0.142_857_142_846_665_42,
    0.111_111_110_152_563_61,
    -0.090_909_045_781_239_01,
    0.076_921_831_908_260_78,
    -0.066_645_114_473_818_55,
    0.058_581_489_128_015_07,
    -0.050_854_497_379_370_145,
    0.039_231_658_295_503_29,
    -0.019_176_887_118_969_28,
];
/// `(sin(x)/x - 1) / x²` in powers of `x²`, for `|x| <= π/4`.
const SINE: [f64; 6] = [
    -0.166_666_666_666_666_66,
    0.008_333_333_333_330_918,
    -0.000_198_412_698_367_124_95,
    2.755_731_607_868_067e-6,
    -2.505_112_687_608_533_5e-8,
    1.591_777_175_934_168_7e-10,
];
/// `(cos(x) - 1 + x²/2) / x⁴` in powers of `x²`, for `|x| <= π/4`.
const COSINE: [f64; 6] = [
    0.041_666_666_666_666_664,
    -0.001_388_888_888_888_737_8,
    2.480_158_729_873_686_3e-5,
    -2.755_731_725_679_604e-7,
    2.087_614_315_990_943_6e-9,
    -1.138_240_875_415_311_2e-11,
];
/// `π/2` in two parts, the first of 33 bits: small multiples of it are exact.
const QUARTER_HIGH: f64 = 1.570_796_326_734_125_6;
const QUARTER_LOW: f64 = 6.077_100_506_506_192e-11;
/// Adding and taking away rounds to the nearest whole number (1.5 times 2⁵²).
const ROUNDER: f64 = 6_755_399_441_055_744.0;

#[inline(always)]
fn polynomial<T: Real, const N: usize>(coefficients: [f64; N], x: T) -> T {
    let mut sum = T::splat(coefficients[N - 1]);
    for &coefficient in coefficients[..N - 1].iter().rev() {
        sum = sum * x + T::splat(coefficient);
    }
    sum
}

/// Sine of 60 degrees.
const SIN_60: f64 = 0.866_025_403_784_438_6;
/// `π/3` rounded; what is lost, 1.15e-16, is half a unit in its last place.
const SIXTH_TURN: f64 = std::f64::consts::FRAC_PI_3;
/// Square of the largest `tan` of half the way from 60 degrees for which the polynomial holds: `tan²(π/8)`.
const REACH: f64 = 0.171_572_875_253_809_9;

/// The angle whose sine is `height / hypotenuse` and whose cosine is `base / hypotenuse`, in [0, π].
///
/// `is_plane` says in which lanes the height is more than rounding; the others, and angles far from 60 degrees, are
/// those of [`angle`].
#[inline(always)]
pub(crate) fn angle_between<T: Real>(height: T, base: T, hypotenuse: T, is_plane: T::Mask) -> T {
    let (half, sin_60) = (T::splat(0.5), T::splat(SIN_60));
    // The vector turned back by 60 degrees; half its angle by tan(x/2) = sin x / (1 + cos x).
    let over = height * half - base * sin_60;
    let under = hypotenuse + (base * half + height * sin_60);
    let z = over / under;
    let square = z * z;
    let rest = z + z * (square * polynomial(ARC_TANGENT, square));
    let near = T::splat(SIXTH_TURN) + (rest + rest);
    let is_near = T::choose(is_plane, square, T::splat(f64::INFINITY)).less(T::splat(REACH));
    if T::all(is_near) {
        return near;
    }
    T::choose(is_near, near, angle(height, base))
}

/// `atan2(height, base)` for `height >= 0`: an angle in [0, π]. NaN when both are zero.
#[inline(always)]
pub(crate) fn angle<T: Real>(height: T, base: T) -> T {
    let zero = T::splat(0.0);
    let is_obtuse = base.less(zero);
    let base = T::choose(is_obtuse, -base, base);
    // Turned back by 0, 45 or 90 degrees, so that what is left lies within 22.5 of zero.
    let is_flat = (height * T::splat(1.0 + std::f64::consts::SQRT_2)).less(base);
    let is_steep = (base * T::splat(1.0 + std::f64::consts::SQRT_2)).less(height);
    let over = T::choose(is_flat, height, T::choose(is_steep, -base, height - base));
    let under = T::choose(is_flat, base, T::choose(is_steep, height, height + base));
    let (acute, obtuse) = (T::splat(FRAC_PI_4), T::splat(3.0 * FRAC_PI_4));
    let diagonal = T::choose(is_obtuse, obtuse, acute);
    let start = T::choose(is_obtuse, T::splat(PI), zero);
    let turned = T::choose(is_flat, start, T::choose(is_steep, T::splat(FRAC_PI_2), diagonal));
    let z = over / under;
    let square = z * z;
    let rest = z + z * (square * polynomial(ARC_TANGENT, square));
    turned + T::choose(is_obtuse, -rest, rest)
}

/// A direction by its angle and the cosine and sine of that.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Direction {
    pub(crate) angle: f64,
    pub(crate) cos: f64,
    pub(crate) sin: f64,
}

impl Direction {
    /// The direction of an angle.
    pub(crate) fn at(angle: f64) -> Self {
        let (sin, cos) = libm::sincos(angle);
        Self { angle, cos, sin }
    }
}

/// Sine and cosine of an angle, reckoned from a known one where it lies within 45 degrees of that.
#[inline(always)]
pub(crate) fn direction_near<T: Real>(angle: T, known: &Direction) -> (T, T) {
    let x = angle - T::splat(known.angle);
    let square = x * x;
    let (sine, cosine) = near_zero(x, square);
    let (known_sin, known_cos) = (T::splat(known.sin), T::splat(known.cos));
    let (sin, cos) = (cosine * known_sin + sine * known_cos, cosine * known_cos - sine * known_sin);
    let is_near = square.less(T::splat(FRAC_PI_4 * FRAC_PI_4));
    if T::all(is_near) {
        return (sin, cos);
    }
    let (other_sin, other_cos) = direction(angle);
    (T::choose(is_near, sin, other_sin), T::choose(is_near, cos, other_cos))
}

/// Sine and cosine of `|x| <= π/4`.
#[inline(always)]
fn near_zero<T: Real>(x: T, square: T) -> (T, T) {
    let sine = x + x * (square * polynomial(SINE, square));
    let cosine = (T::splat(1.0) - T::splat(0.5) * square) + square * square * polynomial(COSINE, square);
    (sine, cosine)
}

/// Sine and cosine of an angle from 0 to a few turns.
#[inline(always)]
pub(crate) fn direction<T: Real>(angle: T) -> (T, T) {
    let quarters = angle * T::splat(FRAC_2_PI) + T::splat(ROUNDER) - T::splat(ROUNDER);
    let x = angle - quarters * T::splat(QUARTER_HIGH) - quarters * T::splat(QUARTER_LOW);
    let square = x * x;
    let (sine, cosine) = near_zero(x, square);
    // quarters mod 4, as 0, 1, 2 or 3, without leaving the floating-point numbers.
    let quarter = quarters * T::splat(0.25);
    let below = quarter - T::splat(0.375) + T::splat(ROUNDER) - T::splat(ROUNDER);
    let rest = quarters - below * T::splat(4.0);
    let (half, one, two) = (T::splat(0.5), T::splat(1.5), T::splat(2.5));
    // rest 0: (s, c), 1: (c, -s), 2: (-s, -c), 3: (-c, s)
    let is_first = rest.less(half);
    let is_second = rest.less(one);
    let is_third = rest.less(two);
    let sin = T::choose(is_first, sine, T::choose(is_second, cosine, T::choose(is_third, -sine, -cosine)));
    let cos = T::choose(is_first, cosine, T::choose(is_second, -sine, T::choose(is_third, -cosine, sine)));
    (sin, cos)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lanes::Pair;
    use crate::workload::Stream;
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    #[test]
    fn angles_are_those_of_the_library() {
        let mut stream = Stream::new(5);
        let mut worst = 0.0_f64;
        for _ in 0..200_000 {
            let scale = libm::exp(40.0 * (stream.unit() - 0.5));
            let (height, base) = (scale * stream.unit(), scale * (2.0 * stream.unit() - 1.0));
            worst = worst.max((angle(height, base) - libm::atan2(height, base)).abs());
        }
        // One unit in the last place of π.
        assert!(worst <= 4.5e-16, "{worst}");
        assert_eq!(angle(0.0, 1.0), 0.0);
        assert_eq!(angle(0.0, -1.0), PI);
        assert!((angle(1.0, 0.0) - FRAC_PI_2).abs() < 1e-16);
        assert!(angle(0.0, 0.0_f64).is_nan());
        // Needles keep their relative precision.
        assert!((angle(1e-12, 1.0_f64) / 1e-12 - 1.0).abs() < 1e-15);
    }

    #[test]
    fn angles_near_sixty_degrees_are_those_of_the_library() {
        let mut stream = Stream::new(8);
        let mut worst = 0.0_f64;
        for _ in 0..200_000 {
            let (r, truth) = (libm::exp(40.0 * (stream.unit() - 0.5)), 0.2 + 1.8 * stream.unit());
            let (sin, cos) = libm::sincos(truth);
            let (height, base) = (r * sin, r * cos);
            let found = angle_between(height, base, r, true);
            worst = worst.max((found - libm::atan2(height, base)).abs());
        }
        // Two units in the last place of π/2: the hypotenuse is rounded too.
        assert!(worst <= 4.5e-16, "{worst}");
    }

    #[test]
    fn angles_join_where_the_range_of_the_polynomial_ends() {
        for end in [FRAC_PI_4 / 3.0, 7.0 * FRAC_PI_4 / 3.0] {
            for step in -8_i32..=8 {
                let (sin, cos) = libm::sincos(end + 1e-16 * f64::from(step));
                let (found, plain) = (angle_between(sin, cos, 1.0, true), angle(sin, cos));
                assert!((found - plain).abs() <= 4.5e-16, "{end} {step}");
            }
            // A little beyond, it is the other one that speaks.
            let beyond = end + 1e-9 * (end - SIXTH_TURN).signum();
            let (sin, cos) = libm::sincos(beyond);
            assert_eq!(angle_between(sin, cos, 1.0, true).to_bits(), angle(sin, cos).to_bits());
        }
    }

    #[test]
    fn chords_without_a_plane_have_the_plain_angle() {
        // The sides are so short that their products vanish: the hypotenuse knows nothing of the angle.
        assert_eq!(angle_between(0.0, 5e-301, 1e-300, false), 0.0);
        assert!(angle_between(0.0, 0.0, 0.0, false).is_nan());
    }

    #[test]
    fn a_lane_has_the_same_angle_beside_any_other() {
        let turns = [0.1, 0.25, 0.3, 1.0, 1.5, 1.83, 1.84, 3.0];
        let sides = turns.map(libm::sincos);
        for (i, first) in sides.iter().enumerate() {
            for (j, second) in sides.iter().enumerate() {
                let one = Pair::splat(1.0);
                let (height, base) = (Pair::new([first.0, second.0]), Pair::new([first.1, second.1]));
                let found = angle_between(height, base, one, Pair::splat(0.0).less(one));
                for (lane, side) in [(0, first), (1, second)] {
                    let single = angle_between(side.0, side.1, 1.0, true);
                    assert_eq!(found.lane(lane).to_bits(), single.to_bits(), "{i} {j}");
                }
            }
        }
    }

    #[test]
    fn directions_are_those_of_the_library() {
        let mut stream = Stream::new(6);
        for _ in 0..200_000 {
            let angle = 20.0 * stream.unit();
            let ((sin, cos), (sine, cosine)) = (direction(angle), libm::sincos(angle));
            assert!((sin - sine).abs() <= 4e-16 && (cos - cosine).abs() <= 4e-16, "{angle}");
        }
        assert_eq!(direction(0.0), (0.0, 1.0));
    }

    #[test]
    fn directions_near_a_known_one_are_those_of_the_library() {
        let mut stream = Stream::new(9);
        for turn in 0..200_000 {
            let known = Direction::at(std::f64::consts::TAU * stream.unit());
            // Well within its range, and every now and then beyond it.
            let reach = if turn % 10 == 0 { 1.6 } else { 0.78 };
            let angle = (known.angle + reach * (2.0 * stream.unit() - 1.0)).max(0.0);
            let ((sin, cos), (sine, cosine)) = (direction_near(angle, &known), libm::sincos(angle));
            assert!((sin - sine).abs() <= 6e-16 && (cos - cosine).abs() <= 6e-16, "{angle}");
        }
        assert_eq!(direction_near(0.0, &Direction::at(0.0)), (0.0, 1.0));
    }

    #[test]
    fn both_lanes_give_the_bits_of_one() {
        let mut stream = Stream::new(7);
        for _ in 0..10_000 {
            let (a, b) = ([stream.unit(), stream.unit()], [2.0 * stream.unit() - 1.0, stream.unit()]);
            let found = angle(Pair::new(a), Pair::new(b));
            let (sin, cos) = direction(found);
            for lane in 0..2 {
                let single = angle(a[lane], b[lane]);
                assert_eq!(found.lane(lane).to_bits(), single.to_bits());
                let (sine, cosine) = direction(single);
                assert_eq!(sin.lane(lane).to_bits(), sine.to_bits());
                assert_eq!(cos.lane(lane).to_bits(), cosine.to_bits());
            }
        }
    }
}
