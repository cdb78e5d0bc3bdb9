//! What damage does, whichever law of failure advances it.
//!
//! Matter whose damage has reached one has failed: it bears pressure and nothing else. In the same
//! step it lets go of the tension and the shear that it held, whose elastic energy stays in it as
//! heat and is told by
//!
//! ```text
//! Δe = p²/(2 K ρ) + S:S/(4 G ρ)        (p < 0)
//! ```
//!
//! with the moduli of that moment. This is exact where they are constant and strains small, and
//! neglects that both change with the strain otherwise. What damage below one does is a matter of
//! the law.
//!
//! Spray that flies apart is grains and void. Its density follows the velocity gradient, down to a tenth of
//! the reference state's: a particle alone has .145 of that by its own kernel (three dimensions, h = 1.3 Δp),
//! so that sums cannot tell less. Without an end, the volume m/ρ by which a particle counts in its
//! neighbours' sums grows for ever, and their gradients with it.

use super::{Conditions, LANES, Lanes, PointBatch};
use crate::material::{at_least, at_most};

/// Damage of matter that has failed.
pub(crate) const FAILED: f64 = 1.0;

/// Least density of failed matter, over that of the reference state.
const SPRAY: f64 = 0.1;

/// Failed matter does not expand beyond spray.
#[inline(always)]
pub(in crate::material) fn limit_expansion(point: &mut PointBatch, reference_density: f64) {
    for k in 0..LANES {
        if point.damage[k] >= FAILED {
            point.density[k] = at_least(point.density[k], SPRAY * reference_density);
        }
    }
}

/// Failed matter bears no tension.
#[inline(always)]
pub(super) fn limit_tension(point: &mut PointBatch) {
    for k in 0..LANES {
        if point.damage[k] >= FAILED {
            point.pressure[k] = at_least(point.pressure[k], 0.0);
        }
    }
}

/// Failed matter has no stiffness in shear and no flow stress, so that no plastic strain is counted.
#[inline(always)]
pub(super) fn soften(point: &PointBatch, now: &mut Conditions) {
    for k in 0..LANES {
        if point.damage[k] >= FAILED {
            now.shear_modulus[k] = 0.0;
            now.softening[k] = 0.0;
        }
    }
}

/// Matter that has failed lets go, `before` (damage) or in this step; `bulk_modulus` is that of the
/// state (Pa). NaN stays NaN.
#[inline(always)]
pub(super) fn let_go(
    point: &mut PointBatch,
    now: &mut Conditions,
    before: &Lanes,
    bulk_modulus: &Lanes,
) {
    for k in 0..LANES {
        if point.damage[k] < FAILED {
            continue;
        }
        let (s, p) = (&mut point.deviatoric_stress, point.pressure[k]);
        if before[k] < FAILED {
            let tension = at_most(p, 0.0);
            let diagonal = s[0][k] * s[0][k] + s[1][k] * s[1][k] + s[2][k] * s[2][k];
            let shear = s[3][k] * s[3][k] + s[4][k] * s[4][k] + s[5][k] * s[5][k];
            let of_volume = tension * tension / (2.0 * bulk_modulus[k]);
            let of_shape = match now.shear_modulus[k] {
                0.0 => 0.0,
                g => (diagonal + 2.0 * shear) / (4.0 * g),
            };
            point.failure_energy[k] += (of_volume + of_shape) / point.density[k];
        }
        point.pressure[k] = at_least(p, 0.0);
        for component in s.iter_mut() {
            component[k] *= 0.0;
        }
        now.shear_modulus[k] = 0.0;
    }
}
