//! The second sweep of the formulations whose stress stands at the particles: accelerations by
//! stress and viscosity, and the power they put into heat.

use rayon::prelude::*;

use crate::sph::shared::{Sums, sources};
use particles::neighbours::{CHUNKS_AT_ONCE, Lists};
use particles::{ParticleStore, Scatter, empty};
use sums::force_sweep::{ForceSweep, ForceTarget, StressPower, Swept};
use sums::from_mirrors::FromMirrors;
use sums::step::Side;

/// The sweep over the clusters of a side, after stresses and pair terms have been shown.
pub(super) fn accelerate<R: Swept>(
    sums: &mut Sums,
    stresses: &[R],
    particles: &mut ParticleStore,
    lists: &Lists,
    side: Side,
) {
    let mut from_mirrors = std::mem::take(&mut sums.from_mirrors);
    accelerate_with(sums, (stresses, &mut from_mirrors), particles, lists, side);
    sums.from_mirrors = from_mirrors;
}

/// The same, where forces of mirror images go elsewhere.
pub(super) fn accelerate_with<R: Swept>(
    sums: &Sums,
    (stresses, from_mirrors): (&[R], &mut Vec<FromMirrors>),
    particles: &mut ParticleStore,
    lists: &Lists,
    side: Side,
) {
    let chunks = lists.chunks();
    let Sums {
        scale,
        viscosity,
        terms,
        ..
    } = sums;
    from_mirrors.resize_with(chunks.len(), FromMirrors::default);
    let correction = &mut particles.velocity_correction;
    let all = &ForceSweep {
        motion: sources(lists, *scale),
        images: lists.images(),
        mirrored: lists.sequence().mirrored(),
        stresses,
        viscosity: *viscosity,
        terms: terms.of_sums(),
        side,
        elsewhere: &lists.elsewhere,
        target: ForceTarget {
            mass: &particles.mass,
            acceleration: Scatter::new(&mut particles.acceleration),
            power: Scatter::new(&mut particles.d_specific_energy_dt),
            approach: Scatter::new(&mut particles.approach_speed),
            correction: (!correction.is_empty()).then(|| Scatter::new(correction)),
            stress_power: StressPower {
                pressure: &particles.pressure,
                deviatoric_stress: &particles.deviatoric_stress,
                velocity_gradient: &particles.velocity_gradient,
                predicted_density: &particles.predicted_density,
            },
        },
    };
    chunks
        .par_iter()
        .zip(from_mirrors)
        .with_max_len(CHUNKS_AT_ONCE)
        .for_each(|(chunk, from_mirrors)| {
            if side == Side::Inner {
                empty(&mut from_mirrors.forces);
            }
            R::sweep(all, chunk, from_mirrors);
            comm::progress();
        });
}
