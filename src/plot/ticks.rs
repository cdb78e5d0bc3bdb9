//! Where the marks of an axis sit and what stands beside them.

use super::units::fixed;

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

/// Decimals that tell the multiples of a step apart.
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
