//! The superaccumulator against `xsum`, in any order and any split, and at its limits.

#![allow(clippy::float_cmp)] // the sums are exact

use numerics::exact_sum::{ExactSum, LIMBS};
use proptest::prelude::*;
use xsum::{Xsum, XsumLarge, XsumSmall};

fn sum_of(terms: &[f64]) -> ExactSum {
    let mut sum = ExactSum::new();
    for &term in terms {
        sum.add(term);
    }
    sum
}

fn value_of(terms: &[f64]) -> f64 {
    sum_of(terms).value()
}

/// The sum by `xsum`, whose version 0.1.6 returns −1 − ε for the single term −1 (and likewise for
/// all negative powers of two): negative sums are taken with all signs turned.
fn reference(terms: &[f64], negative: bool) -> f64 {
    let sign = if negative { -1.0 } else { 1.0 };
    let mut sum = XsumSmall::new();
    for term in terms {
        sum.add(sign * term);
    }
    sign * sum.sum()
}

/// Joins sums as ranks do: normalised limbs, added as integers.
fn over_ranks(parts: &[ExactSum]) -> ExactSum {
    let mut limbs = [0_i64; LIMBS];
    for part in parts {
        let mut part = part.clone();
        part.normalise();
        for (limb, other) in limbs.iter_mut().zip(part.limbs()) {
            *limb += other;
        }
    }
    let mut joined = ExactSum::new();
    joined.limbs_mut().copy_from_slice(&limbs);
    joined
}

/// Finite doubles of every kind, by bits: exponents are spread evenly.
fn any_finite() -> impl Strategy<Value = f64> {
    any::<u64>().prop_map(|bits| {
        let value = f64::from_bits(bits);
        if value.is_finite() { value } else { 0.0 }
    })
}

/// Terms of like magnitude, of all magnitudes, subnormals, and terms that cancel others.
fn terms() -> impl Strategy<Value = Vec<f64>> {
    let term = prop_oneof![
        any_finite(),
        -1.0..1.0f64,
        (0u64..1 << 53).prop_map(f64::from_bits),
        (-40i32..40, any::<bool>()).prop_map(|(n, minus)| {
            let power = libm::ldexp(1.0, n);
            if minus { -power } else { power }
        }),
    ];
    (prop::collection::vec(term, 0..200), any::<bool>()).prop_map(|(mut terms, cancel)| {
        if cancel {
            let opposite: Vec<f64> = terms.iter().skip(1).map(|t| -t).collect();
            terms.extend(opposite);
        }
        terms
    })
}

/// Terms of a few magnitudes, as those of particles, up to several blocks.
fn many_terms() -> impl Strategy<Value = Vec<f64>> {
    let term = (-1.0..1.0f64, -8i32..8).prop_map(|(x, n)| libm::ldexp(x, 12 * n));
    (prop::collection::vec(term, 0..900), -1000i32..900).prop_map(|(mut terms, n)| {
        for term in &mut terms {
            *term = libm::ldexp(*term, n);
        }
        terms
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn terms_at_once_are_terms_one_by_one(any in terms(), many in many_terms()) {
        for terms in [any, many] {
            let mut all = ExactSum::new();
            all.add_all(&terms);
            let mut one_by_one = sum_of(&terms);
            all.normalise();
            one_by_one.normalise();
            prop_assert_eq!(all.limbs(), one_by_one.limbs());
        }
    }

    #[test]
    fn agrees_with_xsum(terms in terms()) {
        let ours = value_of(&terms);
        let theirs = reference(&terms, ours < 0.0);
        prop_assert!(ours == theirs, "{ours:e} and {theirs:e}");
    }

    #[test]
    fn smallest_doubles_sum_as_integers(
        terms in prop::collection::vec((0u64..1 << 53, any::<bool>()), 0..50)
    ) {
        // The bits of a double below 2⁻¹⁰²¹ are its value in units of 2⁻¹⁰⁷⁴.
        let mut units = 0_i128;
        let mut doubles = Vec::new();
        for (bits, minus) in terms {
            units += if minus { -i128::from(bits) } else { i128::from(bits) };
            doubles.push(if minus { -f64::from_bits(bits) } else { f64::from_bits(bits) });
        }
        #[allow(clippy::cast_precision_loss)] // rounds to nearest even, as the sum has to
        let units = units as f64;
        prop_assert!(value_of(&doubles) == libm::ldexp(units, -1074));
    }

    #[test]
    fn order_and_split_do_not_matter(
        (terms, shuffled) in terms().prop_flat_map(|t| (Just(t.clone()), Just(t).prop_shuffle())),
        ranks in 1usize..9,
        owners in prop::collection::vec(any::<usize>(), 64),
    ) {
        let mut whole = sum_of(&terms);
        whole.normalise();
        let mut parts = vec![ExactSum::new(); ranks];
        for (i, &term) in shuffled.iter().enumerate() {
            parts[owners[i % 64] % ranks].add(term);
        }
        let mut merged = ExactSum::new();
        for part in &parts {
            merged.merge(part);
        }
        merged.normalise();
        prop_assert_eq!(merged.limbs(), whole.limbs());
        let mut joined = over_ranks(&parts);
        prop_assert_eq!(joined.value().to_bits(), whole.value().to_bits());
        joined.normalise();
        prop_assert_eq!(joined.limbs(), whole.limbs());
    }

    #[test]
    fn a_double_sums_to_itself(term in any_finite()) {
        prop_assert!(value_of(&[term]) == term);
    }

    #[test]
    fn two_terms_round_as_the_processor_does(a in any_finite(), n in -60i32..60, b in -1.0..1.0f64) {
        let b = libm::ldexp(a, n) * b;
        if b.is_finite() {
            prop_assert!(value_of(&[a, b]) == a + b);
        }
    }
}

#[test]
fn long_sums_agree_with_xsum() {
    let terms: Vec<f64> = (0..100_000_u32)
        .map(|i| {
            let x = f64::from(i.wrapping_mul(2_654_435_769)) - 2_147_483_648.0;
            libm::ldexp(x, i32::try_from(i % 97).unwrap() - 48)
        })
        .collect();
    let mut large = XsumLarge::new();
    large.add_list(&terms);
    assert!(value_of(&terms) == large.sum());
}

#[test]
fn cancellation_is_exact() {
    assert!(value_of(&[1e300, 1.0, -1e300]) == 1.0);
    assert!(value_of(&[1.0, f64::EPSILON * 0.25, -1.0]) == f64::EPSILON * 0.25);
    let nothing = value_of(&[0.1, -1e-320, 7e200, -0.1, -7e200, 1e-320]);
    assert_eq!(nothing.to_bits(), 0);
    assert_eq!(value_of(&[]).to_bits(), 0);
    assert_eq!(value_of(&[-0.0]).to_bits(), 0);
}

#[test]
fn subnormals_count() {
    let tiny = f64::from_bits(1);
    assert!(value_of(&[tiny; 3]) == f64::from_bits(3));
    assert!(value_of(&[f64::MIN_POSITIVE, -tiny]) == f64::from_bits((1 << 52) - 1));
    assert!(value_of(&[1e308, -tiny, -1e308]) == -tiny);
}

#[test]
fn overflow_on_the_way_is_harmless() {
    assert!(value_of(&[f64::MAX, f64::MAX, f64::MAX, -f64::MAX, -f64::MAX]) == f64::MAX);
    assert!(value_of(&[f64::MAX, f64::MAX]) == f64::INFINITY);
    assert!(value_of(&[-f64::MAX, -f64::MAX]) == f64::NEG_INFINITY);
    // Half an ulp beyond the largest double is a tie to even, that is infinity; less is not.
    let half_ulp = libm::ldexp(1.0, 970);
    assert!(value_of(&[f64::MAX, half_ulp]) == f64::INFINITY);
    assert!(value_of(&[f64::MAX, half_ulp, -f64::from_bits(1)]) == f64::MAX);
}

#[test]
fn ties_go_to_even() {
    let half_ulp = 0.5 * f64::EPSILON;
    assert!(value_of(&[1.0, half_ulp]) == 1.0);
    assert!(value_of(&[1.0, half_ulp, f64::from_bits(1)]) == 1.0 + f64::EPSILON);
    assert!(value_of(&[1.0, f64::EPSILON, half_ulp]) == 1.0 + 2.0 * f64::EPSILON);
    assert!(value_of(&[-1.0, -half_ulp]) == -1.0);
    assert!(value_of(&[-1.0, -half_ulp, -f64::from_bits(1)]) == -1.0 - f64::EPSILON);
}

#[test]
fn terms_that_are_not_finite_reach_all_ranks() {
    let finite = sum_of(&[1.0, 2.0]);
    let joined = |term: f64| over_ranks(&[finite.clone(), sum_of(&[term, 5.0]), finite.clone()]);
    assert!(joined(f64::NAN).value().is_nan());
    assert!(joined(f64::INFINITY).value() == f64::INFINITY);
    assert!(joined(f64::NEG_INFINITY).value() == f64::NEG_INFINITY);
    let mut both = joined(f64::INFINITY);
    both.merge(&sum_of(&[f64::NEG_INFINITY]));
    assert!(both.value().is_nan());
    // It sticks.
    let mut sticky = joined(f64::NAN);
    sticky.normalise();
    sticky.add(1.0);
    assert!(sticky.value().is_nan());
}

#[test]
fn limbs_carry_before_they_overflow() {
    // Doubled 45 times, 2⁴⁵ terms: without carries in between, 31 doublings would overflow.
    for term in [1.0 - f64::EPSILON, -0.1, f64::from_bits((1 << 53) - 1)] {
        let mut sum = sum_of(&[term]);
        for _ in 0..45 {
            let twin = sum.clone();
            sum.merge(&twin);
        }
        assert!(sum.value() == libm::ldexp(term, 45), "{term:e}");
    }
}

#[test]
fn limbs_of_many_ranks_fit() {
    // 2³⁰ ranks with all digits set: the sum of their limbs, and one more addition.
    let terms: Vec<f64> = (0..32)
        .map(|i| libm::ldexp(1.0 - f64::EPSILON / 2.0, 53 * i))
        .collect();
    let mut rank = sum_of(&terms);
    rank.normalise();
    let mut all = rank.clone();
    for limb in all.limbs_mut() {
        *limb = limb
            .checked_mul(1 << 30)
            .expect("limbs have room for 2^30 ranks");
    }
    all.add(1.0);
    all.add(-1.0);
    assert!(all.value() == libm::ldexp(rank.value(), 30));
}
