//! The limit of an answer without spacing (Richardson 1911), and how far the finest one is from it
//! (Roache 1994).

/// The extrapolation of an answer from three spacings.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Extrapolated {
    /// Order of convergence: the error is proportional to this power of the spacing.
    pub rate: f64,
    /// The answer for no spacing.
    pub limit: f64,
    /// Roache's index of the finest answer: 1.25 times its distance from the limit.
    pub uncertainty: f64,
}

/// Orders that are taken for one.
const RATES: (f64, f64) = (0.1, 10.0);
const SAFETY: f64 = 1.25;

/// Extrapolates from the three finest spacings (any unit) and answers, coarsest first; nothing if the
/// answers do not approach one value from one side, or if spacings are not descending.
///
/// The rate p solves `(f₁ − f₂)/(f₂ − f₃) = (h₁ᵖ − h₂ᵖ)/(h₂ᵖ − h₃ᵖ)`, whose right side grows with p.
#[must_use]
pub fn extrapolate(spacings: [f64; 3], answers: [f64; 3]) -> Option<Extrapolated> {
    let [coarse, middle, fine] = spacings;
    if !(coarse > middle && middle > fine && fine > 0.0) {
        return None;
    }
    let (first, second) = (answers[0] - answers[1], answers[1] - answers[2]);
    let wanted = first / second;
    if !wanted.is_finite() || wanted <= 0.0 {
        return None;
    }
    let ratio = |p: f64| {
        let [a, b, c] = spacings.map(|h| libm::pow(h / fine, p));
        (a - b) / (b - c)
    };
    let (mut low, mut high) = RATES;
    if wanted < ratio(low) || wanted > ratio(high) {
        return None;
    }
    for _ in 0..100 {
        let half = 0.5 * (low + high);
        if ratio(half) < wanted {
            low = half;
        } else {
            high = half;
        }
    }
    let rate = 0.5 * (low + high);
    let correction = second / (libm::pow(middle / fine, rate) - 1.0);
    Some(Extrapolated {
        rate,
        limit: answers[2] - correction,
        uncertainty: SAFETY * correction.abs(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_power_of_the_spacing_is_found() {
        for (rate, spacings) in [
            (1.0, [4.0, 2.0, 1.0]),
            (2.0, [0.03, 0.02, 0.015]),
            (1.5, [5.0, 3.0, 2.5]),
        ] {
            let answers = spacings.map(|h: f64| 7.0 - 0.3 * h.powf(rate));
            let extrapolated = extrapolate(spacings, answers).unwrap();
            assert!((extrapolated.rate - rate).abs() < 1e-9, "{extrapolated:?}");
            assert!((extrapolated.limit - 7.0).abs() < 1e-9);
            let error: f64 = 7.0 - answers[2];
            assert!((extrapolated.uncertainty - 1.25 * error).abs() < 1e-9);
        }
    }

    #[test]
    fn what_does_not_converge_has_no_limit() {
        for answers in [
            [1.0, 2.0, 1.5],
            [1.0, 1.0, 1.0],
            [1.0, 2.0, 4.0],
            [f64::NAN, 1.0, 2.0],
        ] {
            assert_eq!(extrapolate([4.0, 2.0, 1.0], answers), None, "{answers:?}");
        }
        assert_eq!(extrapolate([1.0, 2.0, 4.0], [1.0, 1.5, 1.75]), None);
    }
}
