//! Logarithm, exponential and power of eight numbers by exact operations: the same bits on all instruction sets.

use crate::lanes::{F64x8, LANES, Lanes};

/// `√½`, as a number whose last 32 bits are zero: the least mantissa.
const LEAST_MANTISSA: u64 = 0x3fe6_a09e_0000_0000;
/// Bits of 1.
const ONE: u64 = 0x3ff0_0000_0000_0000;
/// Bits of 2⁵²: an integer below it in the last bits of this number is added to it.
const INTEGER: u64 = 0x4330_0000_0000_0000;
/// `ln 2` to 32 bits, and what is left of it.
const LN_2: [f64; 2] = [0.693_147_180_369_123_8, 1.908_214_929_270_587_7e-10];
/// Coefficients of `(ln(1 + f) − 2s)/s` in powers of `s²` with `s = f/(2 + f)`: the minimax polynomial of Sun's fdlibm.
const LOGARITHM: [f64; 7] = [
    0.666_666_666_666_673_5,
    0.399_999_999_994_094_2,
    0.285_714_287_436_623_9,
    0.222_221_984_321_497_84,
    0.181_835_721_616_180_5,
    0.153_138_376_992_093_73,
    0.147_981_986_051_165_86,
];
/// Largest size of an exponent: results are normal numbers.
const LARGEST_EXPONENT: f64 = 700.0;
/// `1.5 · 2⁵²`: whoever adds it rounds to an integer, which the last bits tell.
const ROUND: f64 = 6_755_399_441_055_744.0;

/// `ln x` of positive normal numbers to about an ulp; NaN of NaN.
#[inline(always)]
#[must_use]
pub fn ln<V: Lanes>(x: V) -> V {
    let given = x.store();
    let (mut mantissa, mut exponent) = (F64x8([0.0; LANES]), F64x8([0.0; LANES]));
    for k in 0..LANES {
        let bits = given.0[k].to_bits().wrapping_add(ONE - LEAST_MANTISSA);
        mantissa.0[k] = f64::from_bits((bits & (!0 >> 12)) + LEAST_MANTISSA);
        let power = f64::from_bits((bits >> 52) | INTEGER) - f64::from_bits(INTEGER);
        exponent.0[k] = power - 1023.0;
    }
    let exponent = V::load(&exponent);
    let f = V::load(&mantissa).sub(V::splat(1.0));
    let s = f.div(f.add(V::splat(2.0)));
    let square = s.mul(s);
    let mut series = V::splat(LOGARITHM[6]);
    for c in [5, 4, 3, 2, 1, 0] {
        series = series.mul_add(square, V::splat(LOGARITHM[c]));
    }
    // ln(1 + f) = f − (½f² − s (½f² + R)).
    let half = f.mul(f).mul(V::splat(0.5));
    let rest = series.mul_add(square, half).mul(s);
    let low = exponent.mul_add(V::splat(LN_2[1]), rest.sub(half));
    let nothing = x.sub(x);
    exponent.mul_add(V::splat(LN_2[0]), low.add(f)).add(nothing)
}

/// `e^x` to about an ulp, of numbers from −700 to 700; beyond, that of the nearest of these. NaN of NaN.
#[inline(always)]
#[must_use]
pub fn exp<V: Lanes>(x: V) -> V {
    let inside = x
        .min(V::splat(LARGEST_EXPONENT))
        .max(V::splat(-LARGEST_EXPONENT));
    let shifted = inside.mul_add(V::splat(std::f64::consts::LOG2_E), V::splat(ROUND));
    let power = shifted.sub(V::splat(ROUND));
    let rest = power.neg_mul_add(V::splat(LN_2[0]), inside);
    let rest = power.neg_mul_add(V::splat(LN_2[1]), rest);
    // The series of Taylor up to the 13th power: what is left is below 5e-18 for |rest| ≤ ½ ln 2.
    let mut series = V::splat(1.0 / 6_227_020_800.0);
    for inverse in [
        1.0 / 479_001_600.0,
        1.0 / 39_916_800.0,
        1.0 / 3_628_800.0,
        1.0 / 362_880.0,
        1.0 / 40_320.0,
        1.0 / 5_040.0,
        1.0 / 720.0,
        1.0 / 120.0,
        1.0 / 24.0,
        1.0 / 6.0,
        0.5,
        1.0,
        1.0,
    ] {
        series = series.mul_add(rest, V::splat(inverse));
    }
    let (shifted, mut result) = (shifted.store(), series.store());
    for k in 0..LANES {
        // The last bits of the shifted number are the power of two, with a sign.
        let bits = result.0[k].to_bits();
        result.0[k] = f64::from_bits(bits.wrapping_add(shifted.0[k].to_bits() << 52));
    }
    V::load(&result).add(x.sub(x))
}

/// `x^y` of positive normal numbers to some ulps for results between `e^−10` and `e^10`; NaN where one is NaN.
#[inline(always)]
#[must_use]
pub fn pow<V: Lanes>(x: V, y: V) -> V {
    exp(y.mul(ln(x)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dispatch::{Vectorised, available};

    /// A function of eight numbers.
    struct Power(F64x8, f64);

    impl Vectorised for Power {
        type Output = [F64x8; 3];

        #[inline(always)]
        fn run<V: Lanes>(self) -> [F64x8; 3] {
            let x = V::load(&self.0);
            let small = ln(x);
            [
                small.store(),
                exp(small.mul(V::splat(0.1))).store(),
                pow(x, V::splat(self.1)).store(),
            ]
        }
    }

    fn off(found: f64, right: f64) -> f64 {
        (found - right).abs() / right.abs().max(1e-3)
    }

    #[test]
    fn they_agree_with_the_library_to_rounding() {
        let mut x = 1e-12;
        while x < 1e9 {
            let numbers = F64x8([0, 1, 2, 3, 4, 5, 6, 7].map(|k| x * (1.0 + 0.07 * f64::from(k))));
            for exponent in [0.1, 0.34, 0.73, 1.0, 1.7, -0.012] {
                let [logarithm, exponential, power] = available()[0].run(Power(numbers, exponent));
                for k in 0..LANES {
                    let own = numbers.0[k];
                    assert!(off(logarithm.0[k], libm::log(own)) < 4e-16, "ln {own}");
                    let right = libm::exp(0.1 * logarithm.0[k]);
                    assert!(off(exponential.0[k], right) < 4e-16, "exp of {own}");
                    let right = libm::pow(own, exponent);
                    let bound = 4e-16 * (2.0 + libm::log(right).abs());
                    assert!((power.0[k] / right - 1.0).abs() < bound, "{own}^{exponent}");
                }
            }
            x *= 1.37;
        }
    }

    #[test]
    fn all_instruction_sets_agree_to_the_bit() {
        let numbers = F64x8([
            1e-300,
            0.3,
            1.0,
            1.5,
            7e5,
            f64::NAN,
            f64::MIN_POSITIVE,
            1e300,
        ]);
        for exponent in [0.34, -1.7] {
            let bits = |set: crate::dispatch::Instructions| {
                let all = set.run(Power(numbers, exponent));
                all.map(|lanes| lanes.0.map(|x| if x.is_nan() { 0 } else { x.to_bits() }))
            };
            let sets = available();
            for set in &sets {
                assert_eq!(bits(*set), bits(sets[0]), "{}", set.name());
            }
        }
        let [logarithm, _, power] = available()[0].run(Power(numbers, 0.5));
        assert!(logarithm.0[5].is_nan() && power.0[5].is_nan());
        assert_eq!((logarithm.0[2], power.0[2]), (0.0, 1.0));
    }
}
