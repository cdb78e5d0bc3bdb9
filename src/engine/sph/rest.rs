//! Particles at rest: material in its reference state whose motion is below what numbers of double precision
//! show (theory page "Smoothed particle hydrodynamics").
//!
//! Ahead of a wave, sums over neighbours pass on ever smaller velocities, two supports farther with each step, so
//! that after a few dozen steps nothing is at rest to the bit, though sound has got nowhere yet. So material in its
//! [reference state](Rest) is not strained and has no pressure, its hourglass displacement does not begin, and a pair has no
//! viscosity, where the strain of a step, or the velocity over that of sound, is below [`NEGLIGIBLE`].

use material::{LANES, NEGLIGIBLE, PointBatch, Rest};
use model::{Body, Case, SphForm};
use numerics::lanes::F64x8;
use particles::ParticleStore;

/// Bodies of a case that can rest.
#[derive(Debug, Clone)]
pub struct Resting {
    /// Reference states without stress, by body.
    pub(super) states: Vec<Option<Rest>>,
    /// True if the sums of what rests among what rests are zero without a look at neighbours.
    alone: bool,
}

impl Resting {
    pub(super) fn new(case: &Case) -> Self {
        let state = |body: &Body| Rest::of(&case.materials[body.material]);
        Self {
            states: case.bodies.iter().map(state).collect(),
            alone: matches!(case.sph.form, SphForm::Conventional | SphForm::Corrected),
        }
    }

    /// True if owned particle `i` is virgin matter in its reference state, nothing changes it, and no sum needs its
    /// neighbours, as long as nothing moves around it.
    #[inline]
    #[must_use]
    pub fn holds(&self, particles: &ParticleStore, i: usize) -> bool {
        let hourglass = particles.hourglass_displacement.get(i);
        let damage = particles.damage.get(i).copied().unwrap_or_default();
        let compaction = particles.compaction.get(i).copied().unwrap_or_default();
        self.alone
            && self.states[particles.body[i] as usize].is_some_and(|rest| {
                let stress = &particles.deviatoric_stress[i];
                rest.holds(particles.density[i], 0.0, compaction, stress)
            })
            && [
                particles.specific_energy[i],
                particles.plastic_strain[i],
                damage,
            ] == [0.0; 3]
            && particles.velocity_gradient[i] == [0.0; 9]
            && particles.d_specific_energy_dt[i] == 0.0
            && hourglass.is_none_or(|w| *w == [0.0; 3])
    }
}

/// Lanes of a batch that are in the reference state `rest` tells of a lane and are strained by less than
/// [`NEGLIGIBLE`] in a step `dt` (s) with the `gradient` (1/s) at its end, which becomes zero in them: bit k is lane k.
#[inline(always)]
pub(super) fn finish(
    gradient: &mut [F64x8; 9],
    before: &PointBatch,
    dt: f64,
    rest: impl Fn(usize) -> Option<Rest>,
) -> u8 {
    // Not the largest of them, which would hide what is NaN.
    let mut size = [0.0; LANES];
    for component in gradient.iter() {
        for k in 0..LANES {
            size[k] += component.0[k].abs();
        }
    }
    let mut still = 0;
    for k in 0..LANES {
        let state = || {
            let deviator = before.deviatoric_stress.map(|s| s[k]);
            let (density, energy) = (before.density[k], before.specific_energy[k]);
            rest(k).is_some_and(|rest| rest.holds(density, energy, before.compaction[k], &deviator))
        };
        if size[k] * dt < NEGLIGIBLE && state() {
            still |= 1 << k;
            for component in gradient.iter_mut() {
                component.0[k] = 0.0;
            }
        }
    }
    still
}

#[cfg(test)]
mod tests {
    use super::*;
    use material::library;

    /// Lanes that are strained, stressed, dense, hot, or without a reference state go on as they were.
    #[test]
    fn what_is_negligible_becomes_nothing_in_the_reference_state_alone() {
        let metal = library::find("aluminium-2024").unwrap();
        let rest = Rest::of(&metal);
        let dt = 1e-9;
        let mut batch = PointBatch::ZERO;
        batch.density = [metal.reference_density; LANES];
        let small = 0.05 * NEGLIGIBLE / dt;
        let mut gradient = [F64x8([small; LANES]); 9];
        gradient[5].0[1] = -13.0 * small;
        batch.deviatoric_stress[3][2] = 1e-12;
        batch.density[3] *= 1.0 + 1e-15;
        batch.specific_energy[4] = 1.0;
        gradient[0].0[6] = f64::NAN;
        let given = gradient;
        let still = finish(&mut gradient, &batch, dt, |k| rest.filter(|_| k != 5));
        assert_eq!(still, 0b1000_0001);
        for (now, before) in gradient.iter().zip(&given) {
            for k in 0..LANES {
                let expected = if still >> k & 1 == 1 {
                    0.0
                } else {
                    before.0[k]
                };
                assert_eq!(now.0[k].to_bits(), expected.to_bits());
            }
        }
    }
}
