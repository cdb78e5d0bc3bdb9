//! The first sweep of stress points: velocities and strain rates by fits, then the material.

use std::sync::atomic::{AtomicI64, Ordering};

use rayon::prelude::*;

use crate::sph::material_update::MaterialUpdate;
use crate::sph::shared::{Sums, sources};
use numerics::dispatch::{Vectorised, instructions};
use numerics::kernel::PairScale;
use numerics::lanes::{F64x8, LANES, Lanes};
use particles::neighbours::{CHUNKS_AT_ONCE, Chunk, Lists};
use particles::{Image, ParticleStore, Scatter, material_points, records_of};
use sums::linear_fit::{Fit, Fitted, LinearFit};
use sums::mid_step::{MidStep, mid_step};
use sums::neighbourhood::Sources;
use sums::normalised::stress_power;
use sums::step::Step;
use sums::with_scale;

/// Target of the first sweep at stress points: velocities, and the geometry of fits in place of
/// the moments that follow from it.
struct FitTarget<'a> {
    moment: Scatter<'a, [f64; 9]>,
    offset: Scatter<'a, [f64; 3]>,
    gradient: Scatter<'a, [f64; 9]>,
    velocity: Scatter<'a, [f64; 3]>,
    acceleration: Scatter<'a, [f64; 3]>,
    heat: Scatter<'a, f64>,
    norm: Scatter<'a, f64>,
    specific_stress: &'a [[f64; 6]],
    mass: &'a [f64],
    incomplete: AtomicI64,
    step: &'a Step,
}

impl FitTarget<'_> {
    /// Stores lane `k` for particle `i`, whose velocity gradient was `last` (1/s); gives the
    /// gradients of this step's mid-step velocities.
    #[inline(always)]
    fn store(&self, i: usize, k: usize, fitted: &Fitted, last: &[f64; 9]) -> MidStep {
        let mut predicted = [0.0; 9];
        for c in 0..9 {
            predicted[c] = fitted.gradient[c].0[k];
        }
        let fit = &fitted.fits[k];
        if !fit.complete {
            // same bits in any order: a count
            self.incomplete.fetch_add(1, Ordering::Relaxed);
        }
        // SAFETY: particle `i` belongs to one cluster alone, and this thread has the cluster.
        let (v, drift) = unsafe {
            *self.moment.slot(i) = fit.inverse;
            *self.offset.slot(i) = fit.offset;
            *self.norm.slot(i) = fit.norm;
            *self.gradient.slot(i) = predicted;
            (self.velocity.slot(i), self.acceleration.slot(i))
        };
        for a in 0..3 {
            // Half kicks know gravity alone, as long as the other half is to come.
            let pull = 0.5 * self.step.dt * self.step.gravity[a];
            let after = fitted.velocity[a].0[k];
            if self.step.dt > 0.0 {
                drift[a] = (after - (v[a] - pull)) / self.step.dt;
            }
            v[a] = after - pull;
        }
        mid_step(&predicted, last, self.step.dt, self.step.last_dt)
    }

    /// Heat (J/kg) that stress point `i` lacks by the kicks about the beginning of this step, with
    /// `rate` (W/kg) at the predicted velocity, against that at the mean of the mid-step velocities
    /// before and after, whose gradients there were `last` and `next` (1/s).
    #[inline(always)]
    fn late_heat(&self, i: usize, fit: &Fit, rate: f64, last: &[f64; 9], next: &[f64; 9]) -> f64 {
        let mut mean = [0.0; 9];
        for c in 0..9 {
            mean[c] = 0.5 * (last[c] + next[c]);
        }
        let power = stress_power(0.0, &self.specific_stress[i], &mean, 1.0);
        let (mut late, mut heat) = (0.0, 0.0);
        if self.step.dt > 0.0 && fit.weight > 0.0 {
            late = 0.5 * (self.step.dt + self.step.last_dt) * (power - rate);
            heat = self.mass[i] * late / fit.weight;
        }
        // SAFETY: particle `i` belongs to one cluster alone, and this thread has the cluster.
        unsafe { *self.heat.slot(i) = heat };
        late
    }
}

/// The first sweep over one task's clusters.
struct FitChunk<'a, S> {
    chunk: &'a Chunk,
    motion: Sources<'a, S>,
    dimension: usize,
    body_groups: usize,
    images: &'a [Image],
    update: &'a MaterialUpdate<'a>,
    target: &'a FitTarget<'a>,
}

impl<S: PairScale> Vectorised for FitChunk<'_, S> {
    type Output = ();

    #[inline(always)]
    fn run<V: Lanes>(self) {
        for (cluster, neighbours, _) in self.chunk.iter() {
            if cluster.group < self.body_groups {
                self.update.store_free(cluster, neighbours.len());
                continue;
            }
            let sums = LinearFit {
                around: self.motion.around(cluster.receivers, neighbours),
                dimension: self.dimension,
            };
            let fitted = sums.run::<V>();
            let none = [F64x8([0.0; LANES]); 9];
            let (mut ends, mut means) = (none, none);
            for k in 0..cluster.lanes {
                let i = self.images[cluster.receivers[k] as usize].slot();
                let last = self.update.last_gradient(i);
                let MidStep { start, mean, end } = self.target.store(i, k, &fitted, &last);
                for c in 0..9 {
                    (ends[c].0[k], means[c].0[k]) = (end[c], mean[c]);
                }
                let (fit, rate) = (&fitted.fits[k], self.update.heating(i));
                let late = self.target.late_heat(i, fit, rate, &last, &start);
                self.update.heat(i, late);
            }
            self.update
                .apply_mean(cluster, &means, &ends, neighbours.len());
        }
    }
}

/// First sweep: velocities and strain rates at stress points, and the material there. Gives the
/// number of fits without enough neighbours.
pub(super) fn strain(
    sums: &mut Sums,
    particles: &mut ParticleStore,
    lists: &Lists,
    step: &Step,
) -> i64 {
    let set = instructions();
    let (scale, dimension) = (sums.scale, sums.dimension);
    let (images, body_groups) = (lists.images(), lists.groups.of_bodies);
    let target = &FitTarget {
        moment: Scatter::new(&mut particles.stress_moment),
        offset: Scatter::new(&mut particles.stress_offset),
        gradient: Scatter::new(&mut particles.predicted_gradient),
        velocity: Scatter::new(&mut particles.velocity),
        acceleration: Scatter::new(&mut particles.drift_acceleration),
        heat: Scatter::new(&mut particles.stress_heat),
        norm: Scatter::new(&mut particles.fit_norm),
        specific_stress: &particles.specific_stress,
        mass: &particles.stress_mass,
        incomplete: AtomicI64::new(0),
        step,
    };
    let points = (material_points!(particles), records_of!(particles));
    let update = &MaterialUpdate::new(points, sums, lists, step);
    let chunks = lists.chunks().par_iter().with_max_len(CHUNKS_AT_ONCE);
    with_scale!(scale, scale => chunks.for_each(|chunk| {
        let motion = sources(lists, scale);
        set.run(FitChunk {
            chunk, motion, dimension, body_groups, images, update, target,
        });
    }));
    target.incomplete.load(Ordering::Relaxed)
}
