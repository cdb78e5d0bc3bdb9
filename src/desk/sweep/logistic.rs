//! The share of shots that fail, by a size: a logistic curve of the largest likelihood.
//!
//! `P(x) = 1/(1 + exp(−(x − m)/s))`, by Newton's method (Cox 1958, The regression analysis of binary sequences, J. R. Statist. Soc.
//! B 20, 215–242).

/// What shots say of the size from which on they fail.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Onset {
    /// They all hold, or all fail, or larger ones fail no more than smaller ones.
    Unknown,
    /// All up to the former size hold, and all from the latter on fail: no curve is the likeliest.
    Between(f64, f64),
    /// Some hold at sizes at which others fail.
    Curve {
        /// Size at which half of them fail.
        middle: f64,
        /// Scale s of the curve.
        scale: f64,
        /// Standard error of the middle.
        error: f64,
    },
}

/// Steps of Newton's method, at most; ten are many.
const STEPS: usize = 100;

/// What shots of some sizes say, of which some failed.
#[must_use]
pub fn onset(shots: &[(f64, bool)]) -> Onset {
    let of = |failed: bool| {
        let those = shots.iter().filter(move |shot| shot.1 == failed);
        those.map(|shot| shot.0)
    };
    let held = of(false).fold(f64::NEG_INFINITY, f64::max);
    let failed = of(true).fold(f64::INFINITY, f64::min);
    if held.is_infinite() || failed.is_infinite() {
        return Onset::Unknown;
    }
    if held < failed {
        return Onset::Between(held, failed);
    }
    #[expect(clippy::cast_precision_loss, reason = "counts are small")]
    let count = shots.len() as f64;
    let centre = shots.iter().map(|shot| shot.0).sum::<f64>() / count;
    let width = shots
        .iter()
        .map(|shot| (shot.0 - centre).abs())
        .fold(0.0, f64::max);
    if width == 0.0 {
        return Onset::Unknown;
    }
    // P of a + b t, with t from −1 to 1.
    let (mut a, mut b) = (0.0, 0.0);
    for _ in 0..STEPS {
        let (slope, curvature) = derivatives(shots, [centre, width], [a, b]);
        let [aa, ab, bb] = curvature;
        let determinant = aa * bb - ab * ab;
        let step = [
            (bb * slope[0] - ab * slope[1]) / determinant,
            (aa * slope[1] - ab * slope[0]) / determinant,
        ];
        if !step.iter().all(|part| part.is_finite()) {
            return Onset::Unknown;
        }
        a += step[0];
        b += step[1];
        if step.iter().all(|part| part.abs() < 1e-10) {
            break;
        }
    }
    if !(b > 0.0 && b.is_finite() && a.is_finite()) {
        return Onset::Unknown;
    }
    let (_, [aa, ab, bb]) = derivatives(shots, [centre, width], [a, b]);
    // The inverse of the curvature is the covariance of a and b.
    let (middle, determinant) = (-a / b, aa * bb - ab * ab);
    let variance = (bb - 2.0 * middle * ab + middle * middle * aa) / (determinant * b * b);
    Onset::Curve {
        middle: centre + width * middle,
        scale: width / b,
        error: width * variance.max(0.0).sqrt(),
    }
}

/// Slope of the logarithm of the likelihood of a and b, and its curvature downwards: aa, ab, bb.
fn derivatives(
    shots: &[(f64, bool)],
    [centre, width]: [f64; 2],
    [a, b]: [f64; 2],
) -> ([f64; 2], [f64; 3]) {
    let (mut slope, mut curvature) = ([0.0; 2], [0.0; 3]);
    for &(size, failed) in shots {
        let t = (size - centre) / width;
        let share = 1.0 / (1.0 + libm::exp(-(a + b * t)));
        let rest = f64::from(u8::from(failed)) - share;
        let weight = share * (1.0 - share);
        slope[0] += rest;
        slope[1] += rest * t;
        curvature[0] += weight;
        curvature[1] += weight * t;
        curvature[2] += weight * t * t;
    }
    (slope, curvature)
}

#[cfg(test)]
mod tests {
    use super::{Onset, onset};

    fn shots(outcomes: &[(f64, u8)]) -> Vec<(f64, bool)> {
        outcomes
            .iter()
            .map(|(size, failed)| (*size, *failed == 1))
            .collect()
    }

    #[test]
    fn shots_apart_and_alike() {
        assert_eq!(onset(&shots(&[(1.0, 0), (2.0, 0)])), Onset::Unknown);
        assert_eq!(onset(&shots(&[(1.0, 1)])), Onset::Unknown);
        assert_eq!(
            onset(&shots(&[(1.0, 0), (3.0, 1), (2.0, 0)])),
            Onset::Between(2.0, 3.0)
        );
        assert_eq!(onset(&shots(&[(1.0, 1), (2.0, 0)])), Onset::Unknown);
        assert_eq!(onset(&shots(&[(1.0, 1), (1.0, 0)])), Onset::Unknown);
    }

    /// Symmetric shots have their middle where they must, and the slopes of the likelihood vanish.
    #[test]
    fn the_likeliest_curve() {
        let all = shots(&[(1.0, 0), (2.0, 0), (3.0, 1), (4.0, 0), (5.0, 1), (6.0, 1)]);
        let Onset::Curve {
            middle,
            scale,
            error,
        } = onset(&all)
        else {
            panic!("a curve");
        };
        assert!(
            (middle - 3.5).abs() < 1e-9 && error > 0.0,
            "{middle} ± {error}"
        );
        let rest = |(size, failed): &(f64, bool)| {
            let share = 1.0 / (1.0 + (-(size - middle) / scale).exp());
            f64::from(u8::from(*failed)) - share
        };
        let slopes = [
            all.iter().map(rest).sum::<f64>(),
            all.iter().map(|shot| rest(shot) * shot.0).sum::<f64>(),
        ];
        assert!(slopes.iter().all(|slope| slope.abs() < 1e-9), "{slopes:?}");
    }
}
