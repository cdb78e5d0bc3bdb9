//! Sums of doubles without rounding: the same bits in any order, on any ranks and threads.
//!
//! A superaccumulator (Kulisch; in the form of Neal (2015), *Fast exact summation using small and
//! large superaccumulators*, arXiv:1505.05571): one fixed-point number that covers the whole
//! range of `f64`, in digits of 32 bits that each have an `i64` to themselves. The upper half of
//! each limb is room for carries, so that most additions touch three limbs and nothing else.
//!
//! Ranks are joined by a plain integer sum of limbs:
//!
//! ```
//! use numerics::exact_sum::ExactSum;
//!
//! let mut here = ExactSum::new();
//! let mut there = ExactSum::new();
//! here.add(1e300);
//! here.add(1.0);
//! there.add(-1e300);
//! here.normalise();
//! there.normalise();
//! for (limb, other) in here.limbs_mut().iter_mut().zip(there.limbs()) {
//!     *limb += other; // what MPI_SUM does
//! }
//! assert_eq!(here.value(), 1.0);
//! ```
//!
//! # Headroom
//!
//! One addition moves a limb by less than 2³², and a normalised limb lies in `[0, 2³²)` (the top
//! one is signed and small), so that 2³¹ − 1 additions fit into an `i64`. The accumulator counts
//! them and carries by itself after [`MOST_PENDING`] = 2³⁰. The limbs of up to 2³⁰ ranks may be
//! summed if each has called [`ExactSum::normalise`] before. The top limb ends the range: 2⁴⁵
//! terms of the largest magnitude fit, and correspondingly more smaller ones.

use super::dispatch::{Vectorised, instructions};
use super::lanes::{LANES, Lanes};

/// Bits of a digit.
const DIGIT_BITS: u32 = 32;

/// Mask of a digit.
const DIGIT_MASK: i64 = (1 << DIGIT_BITS) - 1;

/// Digits from 2⁻¹⁰⁷⁴ up; the largest double ends in the last one.
const DIGITS: usize = 66;

/// Limb that counts NaN terms.
const NAN: usize = DIGITS;

/// Limb that counts terms of +∞.
const PLUS_INFINITY: usize = DIGITS + 1;

/// Limb that counts terms of −∞.
const MINUS_INFINITY: usize = DIGITS + 2;

/// Number of limbs: digits, lowest first, and three counters of terms that are not finite.
pub const LIMBS: usize = DIGITS + 3;

/// Additions after which an [`ExactSum`] carries by itself.
pub const MOST_PENDING: u32 = 1 << 30;

/// Fraction bits of an `f64`.
const FRACTION_BITS: u32 = f64::MANTISSA_DIGITS - 1;

/// Mask of the fraction of an `f64`.
const FRACTION_MASK: u64 = (1 << FRACTION_BITS) - 1;

/// Biased exponent of infinities and NaN.
const NOT_FINITE: u64 = 0x7ff;

/// Position of the lowest bit of the largest double.
const LARGEST_SHIFT: usize = 2045;

/// Terms that [`ExactSum::add_all`] splits at once.
pub(super) const BLOCK: usize = 256;

/// Biased exponents of the largest terms that it can split: neither the numbers by which it rounds nor the
/// units to which leave the normal range.
const SPLIT: std::ops::RangeInclusive<u64> = 200..=2000;

/// Bits that a split takes off the top of all terms: of 53 that a double has those that 256 terms need are room
/// for carries, and another that of the rounding.
const SPLIT_BITS: u64 = 45;

/// Splits after which what is left of terms is added one by one.
const SPLITS: usize = 4;

/// The exact sum of any number of doubles.
#[derive(Debug, Clone)]
pub struct ExactSum {
    limbs: [i64; LIMBS],
    /// Bound of the limbs: each is below `(pending + 1) 2³²` in magnitude.
    pending: u32,
}

impl Default for ExactSum {
    fn default() -> Self {
        Self::new()
    }
}

impl ExactSum {
    /// The empty sum.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            limbs: [0; LIMBS],
            pending: 0,
        }
    }

    /// Adds a term, without rounding.
    ///
    /// A NaN makes the sum NaN and an infinity makes it infinite, for good.
    #[inline]
    pub fn add(&mut self, term: f64) {
        if self.pending >= MOST_PENDING {
            self.normalise();
        }
        self.pending += 1;
        let bits = term.to_bits();
        let exponent = (bits >> FRACTION_BITS) & NOT_FINITE;
        if exponent == NOT_FINITE {
            self.count_not_finite(term);
            return;
        }
        // term = ± mantissa × 2^shift × 2⁻¹⁰⁷⁴; subnormals share the shift of exponent 1.
        let normal = u64::from(exponent != 0);
        let mantissa = (bits & FRACTION_MASK) | (normal << FRACTION_BITS);
        let shift = exponent - normal;
        let bit = shift & u64::from(DIGIT_BITS - 1);
        let low = mantissa << bit;
        let high = (mantissa >> DIGIT_BITS) >> (u64::from(DIGIT_BITS) - bit);
        let sign = bits.cast_signed() >> 63;
        let signed = |digit: i64| (digit ^ sign) - sign;
        #[allow(clippy::cast_possible_truncation)] // at most 63
        let first = (shift >> DIGIT_BITS.ilog2()) as usize;
        self.limbs[first] += signed(low.cast_signed() & DIGIT_MASK);
        self.limbs[first + 1] += signed((low >> DIGIT_BITS).cast_signed());
        self.limbs[first + 2] += signed(high.cast_signed());
    }

    /// Adds terms, without rounding, faster than one by one.
    ///
    /// Of a block of terms of at most 2ᵉ the parts that are multiples of 2ᵉ⁻⁴⁴ are added as doubles: 256 of them
    /// lose no bit. What is left is at most 2ᵉ⁻⁴⁵, and is split the same way, until nothing is (the idea of
    /// Rump, Ogita & Oishi (2008), SIAM J. Sci. Comput. 31, 189, with the sums of the parts kept whole).
    pub fn add_all(&mut self, terms: &[f64]) {
        for block in terms.chunks(BLOCK) {
            self.add_block(block);
        }
    }

    fn add_block(&mut self, block: &[f64]) {
        let mut rest = [0.0; BLOCK];
        rest[..block.len()].copy_from_slice(block);
        let rest = rest[..block.len().next_multiple_of(LANES)]
            .as_chunks_mut()
            .0;
        let split = instructions().run(Split { terms: rest });
        for &sum in &split.sums[..split.count] {
            self.add(sum);
        }
        if !split.is_done {
            for &term in rest.as_flattened().iter().filter(|term| **term != 0.0) {
                self.add(term);
            }
        }
    }

    /// Adds all terms of another sum.
    pub fn merge(&mut self, other: &Self) {
        if self.pending >= MOST_PENDING {
            self.normalise();
        }
        self.pending += 1;
        let mut other = other.limbs;
        carry(&mut other);
        for (limb, other) in self.limbs.iter_mut().zip(other) {
            *limb += other;
        }
    }

    /// Carries, so that equal sums have equal limbs and limbs of other ranks may be added.
    pub fn normalise(&mut self) {
        carry(&mut self.limbs);
        self.pending = 0;
    }

    /// The limbs, for a sum over ranks; [`Self::normalise`] first.
    #[must_use]
    pub fn limbs(&self) -> &[i64] {
        &self.limbs
    }

    /// The limbs, to receive a sum of the normalised limbs of at most 2³⁰ ranks.
    #[must_use]
    pub fn limbs_mut(&mut self) -> &mut [i64] {
        self.pending = MOST_PENDING;
        &mut self.limbs
    }

    /// The sum, rounded once to the nearest double, ties to even; an exact zero is `+0.0`.
    #[must_use]
    pub fn value(&self) -> f64 {
        let [nan, plus, minus] = [NAN, PLUS_INFINITY, MINUS_INFINITY].map(|i| self.limbs[i] > 0);
        if nan || (plus && minus) {
            return f64::NAN;
        }
        if plus {
            return f64::INFINITY;
        }
        if minus {
            return f64::NEG_INFINITY;
        }
        let mut limbs = self.limbs;
        carry(&mut limbs);
        let negative = limbs[DIGITS - 1] < 0;
        if negative {
            limbs = limbs.map(|limb| -limb);
            carry(&mut limbs);
        }
        let magnitude = round(&limbs[..DIGITS]);
        if negative { -magnitude } else { magnitude }
    }

    #[cold]
    fn count_not_finite(&mut self, term: f64) {
        let counter = if term.is_nan() {
            NAN
        } else if term > 0.0 {
            PLUS_INFINITY
        } else {
            MINUS_INFINITY
        };
        self.limbs[counter] += 1;
    }
}

/// Takes multiples of ever smaller units off all terms.
struct Split<'a> {
    terms: &'a mut [[f64; LANES]],
}

/// Sums of the multiples, one for each unit, and whether nothing is left of the terms.
struct Parts {
    sums: [f64; SPLITS],
    count: usize,
    is_done: bool,
}

impl Vectorised for Split<'_> {
    type Output = Parts;

    #[inline(always)]
    fn run<V: Lanes>(self) -> Parts {
        let mut parts = Parts {
            sums: [0.0; SPLITS],
            count: 0,
            is_done: false,
        };
        let zero = V::splat(0.0);
        // A term minus itself is no number where the term is not finite.
        let (mut most, mut odd) = (zero, zero);
        for eight in &*self.terms {
            let terms = V::read(eight);
            most = most.max(terms.max(zero.sub(terms)));
            odd = odd.add(terms.sub(terms));
        }
        let is_finite = odd.store().0.iter().all(|&odd| odd == 0.0);
        let largest = most.store().0.into_iter().fold(0.0, f64::max);
        let exponent = largest.to_bits() >> FRACTION_BITS;
        parts.is_done = is_finite && largest == 0.0;
        if parts.is_done || !is_finite || !SPLIT.contains(&exponent) {
            return parts;
        }
        // 1.5 × 2⁵² units of 2^(e − 44), with all terms at most 2^e.
        let mut rounder = exponent + 9;
        for sum in &mut parts.sums {
            let unit = V::splat(f64::from_bits((rounder << FRACTION_BITS) | 1 << 51));
            let (mut multiples, mut left) = (zero, zero);
            for eight in &mut *self.terms {
                let terms = V::read(eight);
                let multiple = terms.add(unit).sub(unit);
                let rest = terms.sub(multiple);
                multiples = multiples.add(multiple);
                left = left.max(rest.max(zero.sub(rest)));
                *eight = rest.store().0;
            }
            *sum = multiples.store().0.iter().sum();
            parts.count += 1;
            parts.is_done = left.store().0.iter().all(|&left| left == 0.0);
            if parts.is_done {
                break;
            }
            rounder = rounder.saturating_sub(SPLIT_BITS);
        }
        parts
    }
}

/// Brings all digits but the signed top one into `[0, 2³²)`.
fn carry(limbs: &mut [i64; LIMBS]) {
    let mut carry = 0;
    for limb in &mut limbs[..DIGITS - 1] {
        let sum = *limb + carry;
        *limb = sum & DIGIT_MASK;
        carry = sum >> DIGIT_BITS;
    }
    limbs[DIGITS - 1] += carry;
}

/// The double nearest to a number of carried, non-negative digits, ties to even.
fn round(digits: &[i64]) -> f64 {
    let Some(top) = digits.iter().rposition(|&digit| digit != 0) else {
        return 0.0;
    };
    let length = top * DIGIT_BITS as usize + digits[top].ilog2() as usize + 1;
    // The lowest bit that is kept; every double above 2⁻¹⁰²² keeps 53.
    let lowest = length.saturating_sub(f64::MANTISSA_DIGITS as usize);
    if lowest > LARGEST_SHIFT {
        return f64::INFINITY;
    }
    let (digit, bit) = split(lowest);
    let window = (0..3).fold(0u128, |window, i| {
        window | (u128::from(digits[digit + i].cast_unsigned()) << (DIGIT_BITS as usize * i))
    });
    #[allow(clippy::cast_possible_truncation)] // 53 bits remain
    let mut mantissa = (window >> bit) as u64;
    if lowest > 0 {
        let (digit, bit) = split(lowest - 1);
        let half = digits[digit] >> bit & 1 == 1;
        let more = digits[digit] & ((1 << bit) - 1) != 0 || digits[..digit].iter().any(|&d| d != 0);
        if half && (more || mantissa & 1 == 1) {
            mantissa += 1;
        }
    }
    // The leading bit of the mantissa raises the exponent field from `lowest` to `lowest + 1`;
    // so does a carry out of the mantissa, up to infinity.
    f64::from_bits(((lowest as u64) << FRACTION_BITS) + mantissa)
}

/// Digit and bit in it of a position.
fn split(position: usize) -> (usize, usize) {
    let width = DIGIT_BITS as usize;
    (position / width, position % width)
}

/// Appends the limbs of sums, normalised.
pub fn gather_limbs<'a>(sums: impl Iterator<Item = &'a mut ExactSum>, limbs: &mut Vec<i64>) {
    for sum in sums {
        sum.normalise();
        limbs.extend_from_slice(sum.limbs());
    }
}

/// Gives the sums their limbs back; returns what is left of `limbs`.
pub fn scatter_limbs<'a, 'b>(
    sums: impl Iterator<Item = &'a mut ExactSum>,
    mut limbs: &'b [i64],
) -> &'b [i64] {
    for sum in sums {
        let (own, rest) = limbs.split_at(sum.limbs().len());
        sum.limbs_mut().copy_from_slice(own);
        limbs = rest;
    }
    limbs
}
