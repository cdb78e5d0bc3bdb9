//! The second sweep of the formulations whose stress stands at the particles: accelerations by
//! stress and viscosity, and the power they put into heat.

use rayon::prelude::*;

use crate::domain::MirrorForce;
use crate::neighbours::{CHUNKS_AT_ONCE, Chunk, Cluster, Lists};
use crate::numerics::dispatch::{Vectorised, instructions};
use crate::numerics::kernel::PairScale;
use crate::numerics::lanes::Lanes;
use crate::particles::{Image, ParticleStore, Scatter, empty};
use crate::sph::momentum::{Forces, Momentum, PairStress, Viscosity};
use crate::sph::neighbourhood::Sources;
use crate::sph::normalised::stress_power;
use crate::sph::scale::with_scale;
use crate::sph::step::Side;
use crate::sph::sums::{FromMirrors, Sums, sources};
use crate::sph::terms::{PairTerms, with_terms};

/// The sweep over the clusters of a side, after stresses and pair terms have been shown.
pub(super) fn accelerate<R: PairStress>(
    sums: &mut Sums,
    stresses: &[R],
    particles: &mut ParticleStore,
    lists: &Lists,
    side: Side,
) {
    let instructions = instructions();
    let chunks = lists.chunks();
    let images = lists.images();
    let Sums {
        scale,
        viscosity,
        terms,
        from_mirrors,
        ..
    } = sums;
    from_mirrors.resize_with(chunks.len(), FromMirrors::default);
    let target = &ForceTarget::new(particles, images);
    let shown = &ForceSources {
        stresses,
        mirrored: lists.sequence().mirrored(),
        viscosity: *viscosity,
        terms: terms.of_sums(),
    };
    with_scale!(*scale, scale => chunks
    .par_iter()
    .zip(from_mirrors)
    .with_max_len(CHUNKS_AT_ONCE)
    .for_each(|(chunk, from_mirrors)| {
        if side == Side::Inner {
            empty(&mut from_mirrors.forces);
        }
        with_terms!(shown.terms.set, TERMS => instructions.run(MomentumChunk::<_, R, TERMS> {
            chunk, side, motion: sources(lists, scale), sources: shown, target, from_mirrors,
        }));
    }));
}

/// What the second sweep reads.
struct ForceSources<'a, R> {
    stresses: &'a [R],
    mirrored: &'a [u8],
    viscosity: Viscosity,
    terms: PairTerms<'a>,
}

/// Where the second sweep writes.
struct ForceTarget<'a> {
    images: &'a [Image],
    mass: &'a [f64],
    acceleration: Scatter<'a, [f64; 3]>,
    power: Scatter<'a, f64>,
    approach: Scatter<'a, f64>,
    correction: Option<Scatter<'a, [f64; 3]>>,
    stress_power: StressPower<'a>,
}

impl<'a> ForceTarget<'a> {
    fn new(particles: &'a mut ParticleStore, images: &'a [Image]) -> Self {
        let correction = &mut particles.velocity_correction;
        Self {
            images,
            mass: &particles.mass,
            acceleration: Scatter::new(&mut particles.acceleration),
            power: Scatter::new(&mut particles.d_specific_energy_dt),
            approach: Scatter::new(&mut particles.approach_speed),
            correction: (!correction.is_empty()).then(|| Scatter::new(correction)),
            stress_power: StressPower::new(
                &particles.pressure,
                &particles.deviatoric_stress,
                &particles.velocity_gradient,
                &particles.predicted_density,
            ),
        }
    }

    #[inline(always)]
    fn store<R: PairStress, const TERMS: bool>(&self, cluster: &Cluster, forces: &Forces) {
        for k in 0..cluster.lanes {
            let i = self.images[cluster.receivers[k] as usize].base();
            // SAFETY: particle `i` belongs to this cluster alone, and this thread has the cluster.
            unsafe {
                *self.acceleration.slot(i) = std::array::from_fn(|a| forces.acceleration[a].0[k]);
                *self.power.slot(i) = forces.power.0[k];
                *self.approach.slot(i) = forces.approach.0[k];
                if R::CORRECTED {
                    *self.power.slot(i) += self.stress_power.of(i);
                }
                if TERMS && let Some(correction) = &self.correction {
                    *correction.slot(i) = std::array::from_fn(|a| forces.correction[a].0[k]);
                }
            }
        }
    }
}

/// The power that stresses put into heat.
struct StressPower<'a> {
    pressure: &'a [f64],
    deviatoric_stress: &'a [[f64; 6]],
    velocity_gradient: &'a [[f64; 9]],
    density: &'a [f64],
}

impl<'a> StressPower<'a> {
    /// From fields of the store.
    fn new(
        pressure: &'a [f64],
        deviatoric_stress: &'a [[f64; 6]],
        velocity_gradient: &'a [[f64; 9]],
        predicted_density: &'a [f64],
    ) -> Self {
        Self {
            pressure,
            deviatoric_stress,
            velocity_gradient,
            density: predicted_density,
        }
    }

    /// Of owned particle `i` (W/kg).
    #[inline(always)]
    fn of(&self, i: usize) -> f64 {
        stress_power(
            self.pressure[i],
            &self.deviatoric_stress[i],
            &self.velocity_gradient[i],
            self.density[i],
        )
    }
}

/// The second sweep over one task's clusters.
struct MomentumChunk<'a, S, R, const TERMS: bool> {
    chunk: &'a Chunk,
    side: Side,
    motion: Sources<'a, S>,
    sources: &'a ForceSources<'a, R>,
    target: &'a ForceTarget<'a>,
    from_mirrors: &'a mut FromMirrors,
}

impl<S: PairScale, R: PairStress, const TERMS: bool> Vectorised for MomentumChunk<'_, S, R, TERMS> {
    type Output = ();

    #[inline(always)]
    fn run<V: Lanes>(self) {
        let target = self.target;
        let side = self.side;
        let all = self.chunk.iter();
        for (cluster, neighbours, among) in all.filter(|(_, _, among)| side.takes(among.halo)) {
            let free = |&j: &u32| self.sources.stresses[j as usize].is_free();
            if among.resting || !among.moving && neighbours.iter().all(free) {
                target.store::<R, TERMS>(cluster, &Forces::NONE);
                continue;
            }
            target.store::<R, TERMS>(
                cluster,
                &Self::sum::<V>(self.motion, self.sources, cluster, neighbours),
            );
            if !among.mirrors {
                continue;
            }
            let FromMirrors { indices, forces } = &mut *self.from_mirrors;
            let is_image = |&j: &u32| self.sources.mirrored[j as usize] & 1 == 1;
            indices.clear();
            indices.extend(neighbours.iter().copied().filter(is_image));
            let part = Self::sum::<V>(self.motion, self.sources, cluster, indices).acceleration;
            let around = self.motion.around(cluster.receivers, indices);
            let couple = R::couple::<V, S>(&around, self.sources.stresses);
            for k in 0..cluster.lanes {
                let i = target.images[cluster.receivers[k] as usize].base();
                let mass = target.mass[i];
                forces.push(MirrorForce {
                    particle: i,
                    force: [0, 1, 2].map(|a: usize| mass * part[a].0[k]),
                    couple: [0, 1, 2].map(|a: usize| couple[a].0[k]),
                });
            }
        }
    }
}

impl<S: PairScale, R: PairStress, const TERMS: bool> MomentumChunk<'_, S, R, TERMS> {
    #[inline(always)]
    fn sum<V: Lanes>(
        motion: Sources<S>,
        sources: &ForceSources<R>,
        cluster: &Cluster,
        neighbours: &[u32],
    ) -> Forces {
        let sums = Momentum::<S, R, TERMS> {
            around: motion.around(cluster.receivers, neighbours),
            stresses: sources.stresses,
            viscosity: sources.viscosity,
            terms: sources.terms,
        };
        sums.run::<V>()
    }
}
