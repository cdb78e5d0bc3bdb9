//! Effects of damage, whichever law of failure advances it.
//!
//! Material whose damage D has reached one has failed. With the default [`FailureOptions`] it bears
//! pressure and nothing else; where damage scales, shear and tension are `1 − D` of those of the
//! material between the cracks already before. Damage takes its share in a step of the stress at
//! the end of that step. The elastic energy of this share stays in the material as heat:
//!
//! ```text
//! Δe = [p²/(2 K ρ) + S:S/(4 G ρ)] ΔD/(1 − D)²        (p < 0 in the first term)
//! ```
//!
//! with the stress and the moduli of that moment; for material that fails at once ΔD = 1 and D = 0.
//! This is exact where moduli are constant and strains small, and neglects that both change with
//! the strain otherwise.
//!
//! **Softening.** With a fracture energy `G_f` (J/m²) a law of failure gives the onset of it, not
//! its end: from then on
//!
//! ```text
//! dD/dt = L ⟨σ̄ : D⟩/(2 G_f)
//! ```
//!
//! where σ̄ is the stress of the material between the cracks, without its pressure in compression, D
//! the rate of deformation and L the size of the particle. Whatever the path, the material of a
//! particle has taken `∫ (1 − D) σ̄ : D dt = G_f/L` when it has failed, that is `G_f` over the area
//! of a crack through it, however large particles are; at a limit of tension expansion alone counts, while
//! the limit holds the pressure ([`Spall`](super::Spall)). Crack bands of Bažant & Oh (1983), *Crack
//! band theory for fracture of concrete*, Mater. Struct. 16, 155.
//!
//! Failed material that has lost tension alone has principal stresses of zero at most: it still
//! bears pressure in the other directions, and shear. The strain of open cracks is in the density
//! and not in the material, so the pressure of the equation of state is that of closed ones; with
//! open ones it is the largest principal value of S, for which no direction is pulled.
//!
//! Spray that flies apart is grains and void. Its density follows the velocity gradient, down to a tenth of
//! the reference state's: a particle alone has .145 of that by its own kernel (three dimensions, h = 1.3 Δp),
//! so that sums cannot give less. Without an end, the volume m/ρ by which a particle counts in its
//! neighbours' sums grows for ever, and their gradients with it.

use super::failure::{Effect, FAILED, FailureOptions};
use super::principal_tension::largest;
use super::{Conditions, LANES, Lanes, PointBatch};
use crate::{at_least, at_most};
use numerics::principal::principal;

/// Least density of failed matter, over that of the reference state.
pub(super) const SPRAY: f64 = 0.1;

/// Failed matter does not expand beyond spray, nor does any whose specific energy is below `below` (J/kg): matter whose strength
/// bounds the tension, and what an equation of state tears before it is all vapour.
#[inline(always)]
pub(crate) fn limit_expansion(point: &mut PointBatch, reference_density: f64, below: f64) {
    for k in 0..LANES {
        if point.specific_energy[k] < below || point.damage[k] >= FAILED {
            point.density[k] = at_least(point.density[k], SPRAY * reference_density);
        }
    }
}

/// Failed matter bears no tension, damaged matter what damage leaves of it.
#[inline(always)]
pub(super) fn limit_tension(point: &mut PointBatch, options: &FailureOptions) {
    if options.fades() {
        for k in 0..LANES {
            if point.pressure[k] < 0.0 {
                point.pressure[k] *= 1.0 - options.taken(point.damage[k]);
            }
        }
    }
    let tension_lost = options.effect == Effect::TensionLost;
    for k in 0..LANES {
        if point.damage[k] >= FAILED {
            // Open cracks are in no equation of state: what shear holds tells the pressure with it.
            let least = if tension_lost {
                largest(point, k) + point.pressure[k]
            } else {
                0.0
            };
            point.pressure[k] = at_least(point.pressure[k], least);
        }
    }
}

/// Failed matter has no stiffness in shear and no flow stress, so that no plastic strain is counted;
/// damaged matter has what damage leaves of both. A strength that keeps friction takes its own share.
#[inline(always)]
pub(super) fn soften(point: &PointBatch, now: &mut Conditions) {
    if now.options.effect == Effect::TensionLost {
        return;
    }
    for k in 0..LANES {
        let kept = 1.0 - now.options.taken(point.damage[k]);
        now.kept[k] = kept;
        if now.options.effect == Effect::FrictionKept {
            continue;
        }
        now.shear_modulus[k] *= kept;
        now.softening[k] *= kept;
    }
}

/// Pores that are crushed damage the matter: cube roots of damage add up (Jutzi, Benz & Michel 2008, Icarus 198, 242).
#[inline(always)]
pub(super) fn crush(point: &mut PointBatch, now: &Conditions) {
    for k in 0..LANES {
        if now.crushing[k] > 0.0 {
            let edge = libm::cbrt(point.damage[k]) + now.crushing[k];
            point.damage[k] = edge * edge * edge;
        }
    }
}

/// Matter at the melting temperature fails as soon as nothing presses it.
#[inline(always)]
pub(super) fn melt(point: &mut PointBatch, now: &Conditions) {
    for k in 0..LANES {
        if now.temperature[k] >= now.melting[k] && point.pressure[k] <= 0.0 {
            point.damage[k] = FAILED;
        }
    }
}

/// Limits progress to the onset, `damage` here, of laws that say nothing of the fracture energy left there.
#[inline(always)]
pub(super) fn reach_onset(point: &mut PointBatch, before: &Lanes) {
    for k in 0..LANES {
        point.damage[k] = at_least(at_most(point.damage[k], FAILED), before[k]);
    }
}

/// Limits damage: failed material cannot fail more, however far a step has taken it.
#[inline(always)]
pub(super) fn end(point: &mut PointBatch) {
    for damage in &mut point.damage {
        *damage = at_most(*damage, FAILED);
    }
}

/// Advances the damage of matter that softens.
#[inline(never)]
pub(super) fn open_cracks(point: &mut PointBatch, now: &Conditions) {
    for k in 0..LANES {
        if !(point.failure_onset[k] >= 1.0 && point.damage[k] < FAILED) {
            continue;
        }
        let l = |c: usize| point.velocity_gradient[c][k];
        let s = |c: usize| point.deviatoric_stress[c][k];
        let normal = s(0) * l(0) + s(1) * l(4) + s(2) * l(8);
        let shear = s(3) * (l(1) + l(3)) + s(4) * (l(2) + l(6)) + s(5) * (l(5) + l(7));
        let tension = at_least(-point.pressure[k], 0.0);
        let mut shape = normal + shear;
        if now.options.effect == Effect::FrictionKept {
            // Shear has not faded. Under pressure it is friction, which opens nothing.
            shape *= if tension > 0.0 { now.kept[k] } else { 0.0 };
        }
        let power = shape + tension * (l(0) + l(4) + l(8));
        spend(point, k, power, now);
    }
}

/// Damages one lane by the power of its stress (W/m³) that opens cracks, the faster the less of the
/// fracture energy was left at the onset.
#[inline(always)]
pub(super) fn spend(point: &mut PointBatch, k: usize, power: f64, now: &Conditions) {
    let faster = at_least(point.failure_onset[k], 1.0);
    let spent = faster * now.size(point, k) * at_least(power / now.kept[k], 0.0) * now.dt;
    point.damage[k] += spent / (2.0 * now.options.fracture_energy);
}

/// Matter lets go of what damage has taken since `before`, or of all that failed matter does not
/// bear; `bulk_modulus` is that of the state (Pa). NaN stays NaN.
#[inline(always)]
pub(super) fn let_go(
    point: &mut PointBatch,
    now: &mut Conditions,
    before: &Lanes,
    bulk_modulus: &Lanes,
) {
    if now.options.effect == Effect::TensionLost {
        lose_tension(point, now, bulk_modulus);
        return;
    }
    let keeps_friction = now.options.effect == Effect::FrictionKept;
    for k in 0..LANES {
        let taken = now.options.taken(point.damage[k]);
        if taken <= 0.0 {
            continue;
        }
        let had = now.options.taken(before[k]);
        let s = &mut point.deviatoric_stress;
        let p = point.pressure[k];
        if had < taken {
            let tension = at_most(p, 0.0);
            let square = tensor_square(&s.each_ref().map(|component| component[k]));
            let of_volume = tension * tension / (2.0 * bulk_modulus[k] * (1.0 - had));
            let of_shape = match now.shear_modulus[k] {
                0.0 => 0.0,
                _ if keeps_friction => 0.0,
                g => square / (4.0 * g),
            };
            let share = (taken - had) / (1.0 - had);
            point.failure_energy[k] += share * (of_volume + of_shape) / point.density[k];
        } else if taken < 1.0 {
            continue;
        }
        let left = if had < 1.0 {
            (1.0 - taken) / (1.0 - had)
        } else {
            0.0
        };
        if p < 0.0 {
            point.pressure[k] = if left == 0.0 { 0.0 } else { p * left };
        }
        if keeps_friction {
            // Shear follows by the next return to the yield surface, which heats.
            continue;
        }
        for component in s.iter_mut() {
            component[k] *= left;
        }
        now.shear_modulus[k] *= left;
    }
}

/// `S : S` of `xx yy zz xy xz yz`.
#[inline(always)]
fn tensor_square(s: &[f64; 6]) -> f64 {
    let diagonal = s[0] * s[0] + s[1] * s[1] + s[2] * s[2];
    diagonal + 2.0 * (s[3] * s[3] + s[4] * s[4] + s[5] * s[5])
}

/// Failed matter lets go of its principal tensions, in their own directions.
#[inline(never)]
fn lose_tension(point: &mut PointBatch, now: &mut Conditions, bulk_modulus: &Lanes) {
    for k in 0..LANES {
        if point.damage[k].is_nan() || point.damage[k] < FAILED {
            continue;
        }
        let s = &mut point.deviatoric_stress;
        let held = s.each_ref().map(|component| component[k]);
        let (values, n) = principal(&held);
        let p = point.pressure[k];
        let kept = values.map(|value| at_most(value - p, 0.0));
        if (0..3).all(|a| kept[a].to_bits() == (values[a] - p).to_bits()) {
            continue;
        }
        let pressure = -(kept[0] + kept[1] + kept[2]) / 3.0;
        let of = |i: usize, j: usize| {
            let parts = [0, 1, 2].map(|a| (kept[a] + pressure) * n[i][a] * n[j][a]);
            parts[0] + parts[1] + parts[2]
        };
        let left = [of(0, 0), of(1, 1), of(2, 2), of(0, 1), of(0, 2), of(1, 2)];
        let g = now.shear_modulus[k];
        let of_shape = if g > 0.0 {
            (tensor_square(&held) - tensor_square(&left)) / (4.0 * g)
        } else {
            0.0
        };
        let square = |p: f64| at_most(p, 0.0) * at_most(p, 0.0);
        let of_volume = (square(p) - square(pressure)) / (2.0 * bulk_modulus[k]);
        let released = at_least(of_volume + of_shape, 0.0);
        point.failure_energy[k] += released / point.density[k];
        point.pressure[k] = pressure;
        for (component, value) in s.iter_mut().zip(left) {
            component[k] = value;
        }
    }
}
