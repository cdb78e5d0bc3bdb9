//! The marks of an axis and their numbers.

use super::units::{fixed, superscript};

/// Marks of an axis, in the axis' own unit.
#[derive(Debug, Clone, PartialEq)]
pub struct Ticks {
    pub values: Vec<f64>,
    pub labels: Vec<String>,
}

impl Ticks {
    /// The multiples of a step within a span; none if the span is no range of numbers.
    pub fn new(span: [f64; 2], step: f64) -> Self {
        let decimals = decimals(step);
        // A mark at the very end of the span is wanted in spite of round-off.
        let first = (span[0] / step - 1e-6).ceil();
        let last = (span[1] / step + 1e-6).floor();
        let mut values = Vec::new();
        let mut k = first;
        while k <= last && values.len() < 1000 {
            values.push(k * step);
            k += 1.0;
        }
        let labels = values.iter().map(|&v| fixed(v, decimals)).collect();
        Self { values, labels }
    }

    /// Marks of a logarithmic axis between two powers of ten (the powers are the axis' own
    /// unit): 1, 2 and 5 times each power of a short span, else the powers, or some of them.
    pub fn powers(span: [f64; 2]) -> Self {
        let decades = span[1] - span[0];
        let factors: &[f64] = if decades < 2.5 {
            &[1.0, 2.0, 5.0]
        } else {
            &[1.0]
        };
        let step = nice_step(decades / 9.0).max(1.0);
        let mut ticks = Self {
            values: Vec::new(),
            labels: Vec::new(),
        };
        let in_full = decades < 4.0 && span[0] > -5.0 && span[1] < 5.0;
        let mut power = (span[0] / step - 1.0).floor() * step;
        while power <= span[1] {
            for factor in factors {
                let value = power + factor.log10();
                if value >= span[0] - 1e-6 && value <= span[1] + 1e-6 {
                    ticks.values.push(value);
                    ticks.labels.push(number(*factor, power, in_full));
                }
            }
            power += step;
        }
        ticks
    }
}

/// A factor times a power of ten, in full if all numbers of the axis are short.
fn number(factor: f64, power: f64, in_full: bool) -> String {
    if in_full {
        return fixed(factor * 10_f64.powf(power), decimals(10_f64.powf(power)));
    }
    #[expect(
        clippy::cast_possible_truncation,
        reason = "a power of ten of a double"
    )]
    let power = superscript(power as i32);
    match factor {
        1.0 => format!("10{power}"),
        factor => format!("{}·10{power}", fixed(factor, 0)),
    }
}

/// The smallest step of 1, 2 or 5 times a power of ten that is not below `least`.
pub fn nice_step(least: f64) -> f64 {
    if !(least > 0.0 && least.is_finite()) {
        return 1.0;
    }
    let power = 10_f64.powf(least.log10().floor());
    [1.0, 2.0, 5.0, 10.0]
        .into_iter()
        .map(|factor| factor * power)
        .find(|&step| step >= least * (1.0 - 1e-9))
        .unwrap_or(10.0 * power)
}

/// Decimals that separate the multiples of a step.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "clamped to 0..=12 first"
)]
fn decimals(step: f64) -> usize {
    (-(step.log10() + 1e-9).floor()).clamp(0.0, 12.0) as usize
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_are_one_two_or_five() {
        for (least, step) in [
            (0.9, 1.0),
            (1.0, 1.0),
            (1.1, 2.0),
            (0.021, 0.05),
            (60.0, 100.0),
        ] {
            assert!((nice_step(least) / step - 1.0).abs() < 1e-12, "{least}");
        }
    }

    #[test]
    fn powers_have_short_labels() {
        let labels = |low: f64, high: f64| Ticks::powers([low, high]).labels;
        assert_eq!(labels(-1.0, 0.31), ["0.1", "0.2", "0.5", "1", "2"]);
        assert_eq!(labels(-6.2, -2.9), ["10⁻⁶", "10⁻⁵", "10⁻⁴", "10⁻³"]);
        assert_eq!(labels(4.9, 6.1), ["10⁵", "2·10⁵", "5·10⁵", "10⁶"]);
    }

    #[test]
    fn labels_have_the_decimals_of_the_step() {
        let ticks = Ticks::new([-0.5, 0.5], 0.25_f64.max(nice_step(0.3)));
        assert_eq!(ticks.labels, ["−0.5", "0.0", "0.5"]);
        assert_eq!(Ticks::new([0.0, 200.0], 100.0).labels, ["0", "100", "200"]);
        assert_eq!(
            Ticks::new([0.0, 0.1], 0.05).labels,
            ["0.00", "0.05", "0.10"]
        );
    }
}
