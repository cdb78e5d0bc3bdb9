//! Limiters of the artificial viscosity (theory page "Smoothed particle hydrodynamics").

use numerics::lanes::{F64x8, LANES, Lanes};

/// κ, by which the curvature of a flow counts in the share of both terms.
const ROUGH: f64 = 3.0;
/// Closing speed over sound speed at which a neighbourhood takes all of the viscosity.
const STRONG: f64 = 0.3;

/// Limiters of the artificial viscosity, as of the motion of eight neighbourhoods.
///
/// With the symmetric part D of the velocity gradient (1/s) and its norm of Frobenius, the mean velocity w (m/s) of the
/// neighbours that no linear field explains, and the mean square s² (m²) of their distances.
#[derive(Debug, Clone, Copy)]
pub struct Limiter {
    /// The share that the linear term takes: `f = min(1, max(tr D, −2 tr D)²/‖D‖² + (|w|/s)⁴/‖D‖⁴)`.
    ///
    /// It is one where matter closes along one axis or more and where neighbours rattle, and zero in a
    /// smooth flow without change of volume, in rotation and at rest.
    pub linear: F64x8,
    /// `κ (|w|/s)²/‖D‖²`.
    rough: F64x8,
    /// Speed (m/s) at which a neighbourhood closes in: `s max(0, −tr D)`.
    closing: F64x8,
    /// Equivalent rate of strain, `√⅔ ‖dev D‖` (1/s).
    shear: F64x8,
}

impl Limiter {
    /// Of a neighbourhood in which nothing moves against each other.
    pub const RESTING: Self = Self {
        linear: F64x8([0.0; LANES]),
        rough: F64x8([0.0; LANES]),
        closing: F64x8([0.0; LANES]),
        shear: F64x8([0.0; LANES]),
    };

    /// From a velocity gradient (1/s, row-major), w (m/s) and s² (m²).
    #[inline(always)]
    #[must_use]
    pub fn new<V: Lanes>(l: &[V; 9], rest: &[V; 3], square_length: V) -> Self {
        let (zero, few) = (V::splat(0.0), V::splat(f64::MIN_POSITIVE));
        let rate = l[0].add(l[4]).add(l[8]);
        let counted = rate.max(rate.mul(V::splat(-2.0)));
        let rest = rest[2].mul_add(rest[2], rest[1].mul_add(rest[1], rest[0].mul(rest[0])));
        let square_length = square_length.max(few);
        let rough = rest.div(square_length);
        let mut square = few;
        for a in [0, 4, 8] {
            square = l[a].mul_add(l[a], square);
        }
        // Twice the square of each off-diagonal component: that of the sum of the two of L, halved.
        let half = V::splat(0.5);
        for (a, b) in [(1, 3), (2, 6), (5, 7)] {
            let twice = l[a].add(l[b]);
            square = twice.mul_add(twice.mul(half), square);
        }
        let share = rough.div(square);
        let linear = V::splat(1.0).min(share.mul_add(share, counted.mul(counted).div(square)));
        let closing = zero.sub(rate).max(zero).mul(square_length.sqrt());
        let third = V::splat(1.0 / 3.0);
        let deviator = rate.neg_mul_add(rate.mul(third), square).max(zero);
        Self {
            linear: linear.store(),
            rough: share.mul(V::splat(ROUGH)).store(),
            closing: closing.store(),
            shear: deviator.mul(V::splat(2.0 / 3.0)).sqrt().store(),
        }
    }

    /// The share that both terms take, of points with these sound speeds (m/s) and rates of plastic strain (1/s):
    /// `1 − λ (1 − g)` with `g = min(1, (κ (|w|/s)²/‖D‖²)² + (s max(0, −tr D)/.3c)²)` and the share λ of plastic flow in the
    /// equivalent rate of strain.
    ///
    /// In plastic flow it falls with the fourth power of the spacing where the flow is smooth, and is one in a front of a few
    /// particles, where neighbours rattle, and where matter is struck. In matter that does not flow it is one.
    #[inline(always)]
    #[must_use]
    pub fn both<V: Lanes>(&self, sound_speed: V, plastic_rate: V) -> F64x8 {
        let (one, few) = (V::splat(1.0), V::splat(f64::MIN_POSITIVE));
        let limit = sound_speed.mul(V::splat(STRONG)).max(few);
        let strong = V::load(&self.closing).div(limit);
        let rough = V::load(&self.rough);
        let share = one.min(strong.mul_add(strong, rough.mul(rough)));
        let flow = one.min(plastic_rate.div(V::load(&self.shear).max(few)));
        flow.neg_mul_add(one.sub(share), one).store()
    }
}

#[cfg(test)]
mod tests {
    use super::Limiter;
    use numerics::lanes::{F64x8, LANES};
    use proptest::prelude::*;

    fn all(l: &[f64; 9], rest: [f64; 3]) -> Limiter {
        let lanes = |c: f64| F64x8([c; LANES]);
        Limiter::new(&l.map(lanes), &rest.map(lanes), lanes(1.0))
    }

    /// Of the linear term, in one neighbourhood whose neighbours are a metre away.
    fn of(l: &[f64; 9], rest: [f64; 3]) -> f64 {
        all(l, rest).linear.0[0]
    }

    /// Of both terms there, where sound runs a metre in a second and all strain is plastic.
    fn both(l: &[f64; 9], rest: [f64; 3]) -> f64 {
        let lanes = |c: f64| F64x8([c; LANES]);
        all(l, rest).both(lanes(1.0), lanes(1e3)).0[0]
    }

    fn diagonal(x: f64, y: f64, z: f64) -> [f64; 9] {
        [x, 0.0, 0.0, 0.0, y, 0.0, 0.0, 0.0, z]
    }

    const SMOOTH: [f64; 3] = [0.0; 3];

    #[test]
    fn all_of_a_shock_and_nothing_of_a_flow() {
        for rate in [1e-3, 1.0, 1e9] {
            let full = [
                diagonal(-rate, 0.0, 0.0),
                diagonal(-rate, -rate, 0.0),
                diagonal(-rate, -rate, -rate),
                diagonal(rate, 0.0, 0.0),
            ];
            assert!(full.iter().all(|l| of(l, SMOOTH) == 1.0));
            let none = [
                diagonal(rate, -rate, 0.0),
                diagonal(-rate, -rate, 2.0 * rate),
                [0.0, rate, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
                [0.0, rate, 0.0, -rate, 0.0, 0.0, 0.0, 0.0, 0.0],
                [0.0; 9],
            ];
            assert!(none.iter().all(|l| of(l, SMOOTH) == 0.0));
        }
        // Uniaxial stress with ν = .49 opens a fiftieth.
        let f = of(&diagonal(-1.0, 0.49, 0.49), SMOOTH);
        assert!((f - 0.0016 / 1.4802).abs() < 1e-12, "{f}");
        assert!(of(&[f64::NAN; 9], SMOOTH).is_nan());
    }

    #[test]
    fn what_rattles_takes_all() {
        let shear = [0.0, 1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0];
        assert_eq!(of(&shear, [0.0, 1.5, 0.0]), 1.0);
        assert!((of(&shear, [0.0, 0.1, 0.0]) - 0.005 * 0.005).abs() < 1e-18);
        assert_eq!(of(&[0.0; 9], [1e-9, 0.0, 0.0]), 1.0);
    }

    /// Of both terms, a wave of a thousandth of the sound speed takes what its front bends, and a blow of a third all.
    #[test]
    fn fronts_and_blows_take_both_terms() {
        let wave = diagonal(-1e-3, 0.0, 0.0);
        assert!((both(&wave, SMOOTH) - 1e-6 / 0.09).abs() < 1e-15);
        let bend = both(&wave, [1e-4, 0.0, 0.0]);
        assert!((bend - 0.03 * 0.03 - 1e-6 / 0.09).abs() < 1e-12, "{bend}");
        assert_eq!(both(&wave, [6e-4, 0.0, 0.0]), 1.0);
        assert_eq!(both(&diagonal(-0.2, -0.1, -0.1), SMOOTH), 1.0);
        assert_eq!(both(&diagonal(0.2, 0.1, 0.1), SMOOTH), 0.0);
        assert_eq!(both(&[0.0; 9], SMOOTH), 0.0);
        assert!(both(&[f64::NAN; 9], SMOOTH).is_nan());
        let lanes = |c: f64| F64x8([c; LANES]);
        assert_eq!(all(&wave, SMOOTH).both(lanes(0.0), lanes(1e3)).0[0], 1.0);
        // Uniaxial strain of 1/s strains plastically by two thirds of that, or less.
        let plastic = |rate: f64| all(&wave, SMOOTH).both(lanes(1.0), lanes(rate)).0[0];
        assert_eq!(plastic(0.0), 1.0);
        assert!((plastic(1e-3 / 3.0) - 0.5).abs() < 1e-5);
        assert!(plastic(2e-3 / 3.0) < 2e-5);
    }

    /// A body that vibrates while it turns takes as much as one at rest.
    #[test]
    fn rotation_changes_nothing() {
        let vibrates = diagonal(-1.0, 0.3, 0.2);
        let mut turns = vibrates;
        for (a, b) in [(1, 3), (2, 6), (5, 7)] {
            (turns[a], turns[b]) = (-1024.0, 1024.0);
        }
        assert_eq!(of(&turns, SMOOTH), of(&vibrates, SMOOTH));
    }

    proptest! {
        /// It does not know axes or their signs, so that images have that of their particles.
        #[test]
        fn mirrors_and_scales_change_nothing(
            l in prop::array::uniform9(-1.0..1.0_f64),
            rest in prop::array::uniform3(-0.1..0.1_f64),
            axis in 0_usize..3,
        ) {
            let (mut mirrored, mut back) = (l, rest);
            back[axis] = -back[axis];
            for b in (0..3).filter(|&b| b != axis) {
                mirrored[3 * axis + b] = -l[3 * axis + b];
                mirrored[3 * b + axis] = -l[3 * b + axis];
            }
            let f = of(&l, rest);
            prop_assert!((0.0..=1.0).contains(&f));
            prop_assert_eq!(f, of(&mirrored, back));
            prop_assert_eq!(f, of(&l.map(|c| 1024.0 * c), rest.map(|c| 1024.0 * c)));
        }
    }
}
