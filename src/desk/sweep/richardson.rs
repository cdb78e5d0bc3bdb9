//! The limit of an answer without spacing, and how far the finest one may be from it.
//!
//! Richardson (1911), Phil. Trans. R. Soc. A 210, 307: the error of an answer is `C hᵖ`. Roache (1994), J. Fluids
//! Eng. 116, 405, and (1998), Verification and Validation in Computational Science and Engineering: the uncertainty is
//! the distance from the limit times 1.25 if three spacings give p, times 3 if p is assumed. Oberkampf & Roy (2010),
//! Verification and Validation in Scientific Computing, section 8.6: orders that a scheme cannot have are set to the
//! nearest that it can have, with the factor 3.

/// Orders that the sums can have: below them spacings are too coarse to tell, above them differences are small by
/// chance.
const ORDERS: [f64; 2] = [0.5, 2.0];
/// The order that two spacings assume: faces, contact and shocks are of the first order.
const ASSUMED: f64 = 1.0;
/// Factors of the distance from the limit: of an observed order, of one that is not.
const SAFETY: [f64; 2] = [1.25, 3.0];
/// Differences below this part of the answers are round-off.
const ROUND_OFF: f64 = 1e-12;

/// What an estimate rests on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Basis {
    /// The order of three spacings.
    Observed,
    /// Three spacings whose order is outside of [`ORDERS`]: the nearest of these.
    Clamped,
    /// Two spacings and the first order.
    Assumed,
    /// All answers are the same to round-off.
    Same,
    /// Three answers that go to and fro, or of which two are the same: their range.
    Oscillates,
    /// Three answers whose differences grow as spacings fall: there is no limit.
    Diverges,
    /// Fewer than two spacings.
    Alone,
}

impl Basis {
    /// Its word in tables.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Observed => "observed",
            Self::Clamped => "clamped",
            Self::Assumed => "assumed",
            Self::Same => "same",
            Self::Oscillates => "oscillates",
            Self::Diverges => "diverges",
            Self::Alone => "alone",
        }
    }
}

/// An estimate of the limit of an answer; what is not known is absent.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate {
    /// What it rests on.
    pub basis: Basis,
    /// Order of convergence: the error is proportional to this power of the spacing.
    pub order: Option<f64>,
    /// The answer for no spacing, in its unit.
    pub limit: Option<f64>,
    /// Half width of the band about the finest answer, in its unit.
    pub uncertainty: Option<f64>,
}

impl Estimate {
    /// Of spacings (any unit) and finite answers at each, coarsest first, of which the three finest count.
    ///
    /// With the ratios of spacings as they are, p solves `(f₁ − f₂)/(f₂ − f₃) = (h₁ᵖ − h₂ᵖ)/(h₂ᵖ − h₃ᵖ)`, whose right
    /// side grows with p; with equal ratios r it is `p = ln((f₁ − f₂)/(f₂ − f₃))/ln r`. The limit is
    /// `f₃ − (f₂ − f₃)/((h₂/h₃)ᵖ − 1)`. Answers that go to and fro have no limit, and their range as uncertainty.
    ///
    /// # Panics
    /// If there are not as many answers as spacings.
    #[must_use]
    pub fn new(spacings: &[f64], answers: &[f64]) -> Self {
        assert_eq!(spacings.len(), answers.len(), "an answer for each spacing");
        let from = spacings.len().saturating_sub(3);
        let (spacings, answers) = (&spacings[from..], &answers[from..]);
        let largest = answers.iter().fold(0.0, |most: f64, f| most.max(f.abs()));
        let same = |a: f64, b: f64| (a - b).abs() <= ROUND_OFF * largest;
        match (spacings, answers) {
            (_, [.., first, last]) if answers.iter().all(|f| same(*f, *first)) => Self {
                basis: Basis::Same,
                order: None,
                limit: Some(*last),
                uncertainty: Some(0.0),
            },
            (&[coarse, fine], &[first, last]) => {
                Self::of(Basis::Assumed, ASSUMED, coarse / fine, [first, last])
            }
            (&[_, middle, fine], &[first, second, last]) => {
                let to_and_fro = (first - second) * (second - last) < 0.0;
                if to_and_fro || same(first, second) || same(second, last) {
                    let least = answers.iter().copied().fold(f64::INFINITY, f64::min);
                    let most = answers.iter().copied().fold(f64::NEG_INFINITY, f64::max);
                    return Self {
                        uncertainty: Some(most - least),
                        ..Self::without(Basis::Oscillates)
                    };
                }
                match order(spacings, (first - second) / (second - last)) {
                    Some((order, basis)) => Self::of(basis, order, middle / fine, [second, last]),
                    None => Self::without(Basis::Diverges),
                }
            }
            _ => Self::without(Basis::Alone),
        }
    }

    fn without(basis: Basis) -> Self {
        Self {
            basis,
            order: None,
            limit: None,
            uncertainty: None,
        }
    }

    /// Of the two finest answers and the ratio of their spacings.
    fn of(basis: Basis, order: f64, ratio: f64, [coarse, fine]: [f64; 2]) -> Self {
        let safety = SAFETY[usize::from(basis != Basis::Observed)];
        let correction = (coarse - fine) / (libm::pow(ratio, order) - 1.0);
        Self {
            basis,
            order: Some(order),
            limit: Some(fine - correction),
            uncertainty: Some(safety * correction.abs()),
        }
    }
}

/// The order of three spacings whose differences of answers have a ratio; nothing if differences grow.
fn order(spacings: &[f64], wanted: f64) -> Option<(f64, Basis)> {
    let ratio = |p: f64| {
        let power = |k: usize| libm::pow(spacings[k] / spacings[2], p);
        (power(0) - power(1)) / (power(1) - power(2))
    };
    // Of no order at all: the limit of p = 0.
    let least = libm::log(spacings[0] / spacings[1]) / libm::log(spacings[1] / spacings[2]);
    let [mut low, mut high] = ORDERS;
    if wanted <= least {
        return None;
    }
    if wanted < ratio(low) {
        return Some((low, Basis::Clamped));
    }
    if wanted > ratio(high) {
        return Some((high, Basis::Clamped));
    }
    for _ in 0..100 {
        let half = 0.5 * (low + high);
        if ratio(half) < wanted {
            low = half;
        } else {
            high = half;
        }
    }
    Some((0.5 * (low + high), Basis::Observed))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn made(spacings: &[f64], f: impl Fn(f64) -> f64) -> Estimate {
        let answers: Vec<f64> = spacings.iter().map(|&h| f(h)).collect();
        Estimate::new(spacings, &answers)
    }

    #[test]
    fn a_power_of_the_spacing_is_found() {
        for (order, spacings) in [
            (1.0, &[4.0, 2.0, 1.0][..]),
            (2.0 - 1e-9, &[0.03, 0.02, 0.015]),
            (0.6, &[9.0, 8.0, 3.0]),
            (1.5, &[8.0, 5.0, 3.0, 2.5]),
        ] {
            let found = made(spacings, |h| 7.0 - 0.3 * h.powf(order));
            assert_eq!(found.basis, Basis::Observed, "{spacings:?}");
            assert!((found.order.unwrap() - order).abs() < 1e-9, "{found:?}");
            assert!((found.limit.unwrap() - 7.0).abs() < 1e-8, "{found:?}");
            let error = 0.3 * spacings[spacings.len() - 1].powf(order);
            let band = found.uncertainty.unwrap();
            assert!((band - 1.25 * error).abs() < 1e-8, "{found:?}");
        }
    }

    #[test]
    fn two_spacings_assume_the_first_order() {
        let found = made(&[3.0, 2.0], |h| -5.0 + 0.25 * h);
        assert_eq!(found.basis, Basis::Assumed);
        assert!((found.limit.unwrap() + 5.0).abs() < 1e-12);
        assert!((found.uncertainty.unwrap() - 3.0 * 0.5).abs() < 1e-12);
        // A sign that changes is no trouble of the limit.
        let found = made(&[4.0, 1.0], |h| 2.0 - h);
        assert!((found.limit.unwrap() - 2.0).abs() < 1e-12);
    }

    #[test]
    fn orders_that_cannot_be_are_clamped_with_a_wider_band() {
        let spacings = [4.0, 2.0, 1.0];
        let high = made(&spacings, |h| 1.0 + 0.1 * h.powf(4.0));
        assert_eq!((high.basis, high.order), (Basis::Clamped, Some(2.0)));
        assert!((high.uncertainty.unwrap() - 3.0 * 1.5 / 3.0).abs() < 1e-12);
        let low = made(&spacings, |h| 1.0 + 0.1 * h.powf(0.2));
        assert_eq!((low.basis, low.order), (Basis::Clamped, Some(0.5)));
        // The truth is within the band.
        let answer = 1.1;
        for (found, answer) in [(high, answer), (low, answer)] {
            assert!((answer - 1.0_f64).abs() < found.uncertainty.unwrap());
        }
    }

    #[test]
    fn what_goes_to_and_fro_has_its_range() {
        for answers in [[1.0, 2.0, 1.5], [2.0, 1.0, 1.0], [1.0, 1.0, 2.0]] {
            let found = Estimate::new(&[4.0, 2.0, 1.0], &answers);
            assert_eq!(found.basis, Basis::Oscillates, "{answers:?}");
            assert_eq!((found.limit, found.uncertainty), (None, Some(1.0)));
        }
        // Coarser ones than the three finest do not count.
        let found = Estimate::new(&[8.0, 4.0, 2.0, 1.0], &[90.0, 1.0, 2.0, 1.5]);
        assert_eq!(found.uncertainty, Some(1.0));
    }

    #[test]
    fn equal_answers_are_their_limit() {
        for answers in [
            &[3.0; 3][..],
            &[3.0; 2],
            &[0.0; 3],
            &[1.0, 1.0 + 1e-15, 1.0],
        ] {
            let spacings = &[4.0, 2.0, 1.0][..answers.len()];
            let found = Estimate::new(spacings, answers);
            assert_eq!(found.basis, Basis::Same, "{answers:?}");
            assert_eq!(found.limit, answers.last().copied());
            assert_eq!(found.uncertainty, Some(0.0));
        }
    }

    #[test]
    fn growing_differences_and_one_answer_have_no_limit() {
        let spacings = [4.0, 2.0, 1.0];
        for (answers, basis) in [
            (&[1.0, 2.0, 4.0][..], Basis::Diverges),
            (&[1.0, 2.0, 3.0], Basis::Diverges),
            (&[7.0], Basis::Alone),
            (&[], Basis::Alone),
        ] {
            let found = Estimate::new(&spacings[..answers.len()], answers);
            assert_eq!(found, Estimate::without(basis), "{answers:?}");
        }
    }
}
