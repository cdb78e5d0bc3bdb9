//! The material's answer to the velocity gradient, cluster by cluster inside the first sweep.

use super::recording::Recording;
use super::rest;
use super::shared::Sums;
use material::{LANES, Material, PointBatch, Rest};
use numerics::lanes::{F64x8, Lanes};
use particles::neighbours::{Cluster, Lists};
use particles::{Image, MaterialPoints, Records};
use sums::step::Step;

/// Most of the half volumetric strain of a step: lone particles of debris would else have negative densities.
const MOST_STRAIN: f64 = 0.5;

/// Density after a step over that before it, by half of the volumetric strain of the step: second order, between a third and
/// three.
#[inline(always)]
pub(crate) fn thinned(strain: f64) -> f64 {
    let strain = strain.clamp(-MOST_STRAIN, MOST_STRAIN);
    (1.0 - strain) / (1.0 + strain)
}

/// Work for a particle apart from its neighbours, in neighbours of the pair sums: sort, list,
/// material, integration and time-step candidates against both sweeps, as timed by the bench.
const OWN_WORK: u32 = 60;

/// The same for a particle that rests: sort and integration.
const RESTING_WORK: u32 = 45;

/// Inputs and outputs of the update: each owned particle is in exactly one lane of one cluster.
pub(super) struct MaterialUpdate<'a> {
    images: &'a [Image],
    materials: &'a [Material],
    /// Reference states without stress, by body.
    rest: &'a [Option<Rest>],
    material_of_body: &'a [usize],
    /// By group: whether it is a rigid body.
    rigid: &'a [bool],
    /// Sound speed of particles without stress, by body (m/s).
    free_sound: &'a [f64],
    /// By body: mass (kg) of a particle of which a ring has many; empty where there are none.
    grain_masses: &'a [f64],
    dt: f64,
    /// Specific energies are those after the first half kick.
    points: MaterialPoints<'a>,
    recording: Option<Recording<'a>>,
}

/// Points of one material, before and after their update.
pub(super) struct Updated<'a> {
    /// Before.
    pub before: &'a PointBatch,
    /// After.
    pub after: &'a PointBatch,
    /// Elastic shear modulus of the reference state (Pa).
    pub shear_modulus: f64,
    /// Yield stress of the reference state (Pa), infinite without one.
    pub yield_stress: f64,
    /// True if tension has a limit.
    pub limits_tension: bool,
    /// Bit k: lane k is one of them.
    pub lanes: u8,
    /// Their particles.
    pub particles: &'a [usize; LANES],
    /// Their places among the images.
    pub indices: &'a [u32; LANES],
}

impl Updated<'_> {
    /// Calls `visit` with each lane, its particle and its place among the images.
    #[inline(always)]
    pub(super) fn each(&self, mut visit: impl FnMut(usize, usize, usize)) {
        for k in 0..LANES {
            if self.lanes >> k & 1 == 1 {
                visit(k, self.particles[k], self.indices[k] as usize);
            }
        }
    }
}

/// Output of a formulation of eight particles after their update.
pub(super) trait Show {
    /// Sets densities (kg/m³) of eight particles after a step, from their places among the images, where these do not
    /// follow from velocity gradients.
    #[inline(always)]
    fn set_density(&self, _density: &mut [f64; LANES], _indices: &[u32; LANES]) {}

    /// Shows points.
    ///
    /// # Safety
    /// No other thread may read or write what belongs to these particles and places.
    unsafe fn show<V: Lanes>(&self, points: &Updated);
}

/// Nothing is shown.
impl Show for () {
    #[inline(always)]
    unsafe fn show<V: Lanes>(&self, _: &Updated) {}
}

impl<'a> MaterialUpdate<'a> {
    pub(super) fn new(
        (mut points, records): (MaterialPoints<'a>, Records<'a>),
        sums: &'a Sums,
        lists: &'a Lists,
        step: &Step,
    ) -> Self {
        points.needs_particle = sums.needs_particle;
        Self {
            images: lists.images(),
            materials: &sums.materials,
            rest: &sums.resting.states,
            material_of_body: &sums.material_of_body,
            rigid: &lists.groups.rigid,
            free_sound: &sums.free_sound,
            grain_masses: &sums.grain_masses,
            dt: step.dt,
            points,
            recording: Recording::new(records, sums, step),
        }
    }

    /// Advances density, stress and strain of a cluster whose velocity gradient at the end of
    /// the step is `gradient`; `neighbours` is the length of its list.
    #[inline(always)]
    pub(super) fn apply<V: Lanes>(
        &self,
        cluster: &Cluster,
        gradient: &[F64x8; 9],
        neighbours: usize,
        show: &impl Show,
    ) {
        if self.rigid[cluster.group] {
            self.store_free(cluster, 0);
            return;
        }
        let slot = self.slot(cluster);
        let mut before = self.gather(&slot);
        let mut gradient = *gradient;
        let still = rest::finish(&mut gradient, &before, self.dt, |k| {
            self.rest[self.points.body[slot[k]] as usize]
        });
        for c in 0..9 {
            for k in 0..LANES {
                let mean = 0.5 * (before.velocity_gradient[c][k] + gradient[c].0[k]);
                before.velocity_gradient[c][k] = mean;
            }
        }
        self.advance::<V>(cluster, &slot, (before, still), &gradient, neighbours, show);
    }

    /// The same of a cluster of stress points, whose velocity gradient in the middle of the step is
    /// `mean`; `gradient` is what the next step is to know of it.
    #[inline(always)]
    pub(super) fn apply_mean(
        &self,
        cluster: &Cluster,
        mean: &[F64x8; 9],
        gradient: &[F64x8; 9],
        neighbours: usize,
    ) {
        let slot = self.slot(cluster);
        let mut before = self.gather(&slot);
        for c in 0..9 {
            before.velocity_gradient[c] = mean[c].0;
        }
        self.advance::<F64x8>(cluster, &slot, (before, 0), gradient, neighbours, &());
    }

    /// Adds to the specific energy of particle `i` (J/kg).
    #[inline(always)]
    pub(super) fn heat(&self, i: usize, energy: f64) {
        // SAFETY: particle `i` belongs to one cluster alone, and this thread has the cluster.
        unsafe { *self.points.specific_energy.slot(i) += energy };
    }

    /// Rate of the specific energy of particle `i` at the beginning of the step (W/kg).
    #[inline(always)]
    pub(super) fn heating(&self, i: usize) -> f64 {
        self.points.heating[i]
    }

    /// Receivers of a cluster that had failed before this step and bear no shear: bit k is lane k.
    #[inline(always)]
    pub(super) fn loose(&self, cluster: &Cluster) -> u8 {
        if self.points.damage.is_empty() {
            return 0;
        }
        let mut loose = 0;
        for (k, i) in self.slot(cluster).into_iter().enumerate() {
            // SAFETY: particle `i` belongs to this cluster alone, and this thread has the cluster.
            let failed = unsafe { self.points.has_failed(i) };
            let material = || &self.materials[self.material_of_body[self.points.body[i] as usize]];
            loose |= u8::from(failed && !material().failure.options.keeps_shear()) << k;
        }
        loose
    }

    /// The velocity gradient that the last step has left of particle `i`.
    #[inline(always)]
    pub(super) fn last_gradient(&self, i: usize) -> [f64; 9] {
        // SAFETY: particle `i` belongs to one cluster alone, and this thread has the cluster.
        unsafe { *self.points.velocity_gradient.slot(i) }
    }

    #[inline(always)]
    fn slot(&self, cluster: &Cluster) -> [usize; LANES] {
        let at = |k: usize| self.images[cluster.receivers[k] as usize].slot();
        [at(0), at(1), at(2), at(3), at(4), at(5), at(6), at(7)]
    }

    /// Advances what was gathered by the velocity gradients in it; the lanes `still` stay without pressure.
    #[inline(always)]
    fn advance<V: Lanes>(
        &self,
        cluster: &Cluster,
        slot: &[usize; LANES],
        (mut before, still): (PointBatch, u8),
        gradient: &[F64x8; 9],
        neighbours: usize,
        show: &impl Show,
    ) {
        let half = 0.5 * self.dt;
        let [xx, _, _, _, yy, _, _, _, zz] = &before.velocity_gradient;
        for k in 0..LANES {
            let strain = half * (xx[k] + yy[k] + zz[k]);
            before.density[k] *= thinned(strain);
        }
        show.set_density(&mut before.density, &cluster.receivers);
        let material = |k: usize| self.material_of_body[self.points.body[slot[k]] as usize];
        // Empty lanes cost as much as others.
        let work = neighbours * LANES / cluster.lanes;
        let work = OWN_WORK + u32::try_from(work).unwrap_or(u32::MAX / 2);
        let mut done = 0_u8;
        for k in 0..cluster.lanes {
            if done >> k & 1 == 1 {
                continue;
            }
            let own = material(k);
            let mut after = before;
            let before_failure = self.materials[own].update(&mut after, self.dt);
            for lane in (0..LANES).filter(|lane| still >> lane & 1 == 1) {
                after.pressure[lane] = 0.0;
            }
            let mut lanes = 0_u8;
            for lane in k..cluster.lanes {
                if material(lane) == own {
                    lanes |= 1 << lane;
                    self.store(slot[lane], lane, &after, gradient, work);
                }
            }
            done |= lanes;
            if let Some(recording) = &self.recording {
                // SAFETY: the particles belong to this cluster alone, and this thread has it.
                unsafe { recording.book(own, [&before, &after], &before_failure, lanes, slot) };
            }
            let updated = Updated {
                before: &before,
                after: &after,
                shear_modulus: self.materials[own].shear_modulus(),
                yield_stress: self.materials[own].strength.yield_stress(),
                limits_tension: self.materials[own].failure.spall.is_some()
                    || self.materials[own].strength.bounds_tension(),
                lanes,
                particles: slot,
                indices: &cluster.receivers,
            };
            // SAFETY: the places belong to this cluster alone, as its particles do.
            unsafe { show.show::<V>(&updated) };
        }
    }

    /// Particles that rest stay as they are; `show` is told the place of each, its density (kg/m³) and its sound
    /// speed (m/s).
    pub(super) fn rest(&self, cluster: &Cluster, show: impl Fn(usize, [f64; 2])) {
        for &place in cluster.valid() {
            let i = self.images[place as usize].slot();
            let rest = self.rest[self.points.body[i] as usize];
            let speed = rest.map_or(f64::NAN, |rest| rest.sound_speed);
            // SAFETY: particle `i` belongs to this cluster alone, and this thread has the cluster.
            let density = unsafe {
                self.free(i, speed, RESTING_WORK);
                *self.points.density.slot(i)
            };
            show(place as usize, [density, speed]);
        }
    }

    /// Particles of a rigid body, or beside stress points, have no stress; nobody reads their
    /// records.
    #[cold]
    pub(super) fn store_free(&self, cluster: &Cluster, neighbours: usize) {
        let work = OWN_WORK + u32::try_from(neighbours).unwrap_or(u32::MAX / 2);
        for &index in &cluster.receivers[..cluster.lanes] {
            let i = self.images[index as usize].slot();
            let speed = self.free_sound[self.points.body[i] as usize];
            // SAFETY: particle `i` belongs to this cluster alone, and this thread has the cluster.
            unsafe { self.free(i, speed, work) };
        }
    }

    /// Stores a particle without pressure, of this sound speed (m/s), whose step took so much work.
    ///
    /// # Safety
    /// No other thread may read or write what belongs to the particle.
    #[inline(always)]
    unsafe fn free(&self, i: usize, sound_speed: f64, work: u32) {
        // SAFETY: by the contract of this function.
        unsafe {
            *self.points.pressure.slot(i) = 0.0;
            *self.points.sound_speed.slot(i) = sound_speed;
            *self.points.work.slot(i) = work;
        }
    }

    /// The state of a cluster's particles, with the last velocity gradients.
    #[inline(always)]
    fn gather(&self, slot: &[usize; LANES]) -> PointBatch {
        // SAFETY: these particles belong to this cluster alone, and this thread has the cluster.
        let mut batch = unsafe { self.points.gather(slot) };
        let half = 0.5 * self.dt;
        for (k, &i) in slot.iter().enumerate() {
            batch.specific_energy[k] += half * self.points.heating[i];
        }
        // What hangs on the size of particles sees those of a ring.
        if !self.grain_masses.is_empty() {
            for (k, &i) in slot.iter().enumerate() {
                batch.mass[k] = self.grain_masses[self.points.body[i] as usize];
            }
        }
        if self.points.needs_particle
            && let Some(recording) = &self.recording
        {
            // SAFETY: as above.
            batch.plastic_energy = unsafe { recording.plastic_energy(slot) };
        }
        batch
    }

    #[inline(always)]
    fn store(&self, i: usize, k: usize, batch: &PointBatch, gradient: &[F64x8; 9], work: u32) {
        // SAFETY: particle `i` belongs to this cluster alone, and this thread has the cluster.
        unsafe {
            self.points.store(i, k, batch);
            let l = self.points.velocity_gradient.slot(i);
            for c in 0..9 {
                l[c] = gradient[c].0[k];
            }
            *self.points.work.slot(i) = work;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::thinned;

    /// A volume that grows at a constant rate by a hundredth: as the exponential says to third order. No step makes a density
    /// that is not positive.
    #[test]
    fn densities_follow_volumes_and_stay_positive() {
        assert!((thinned(0.005) - (-0.01_f64).exp()).abs() < 1e-7);
        assert!(
            [0.3, 0.5]
                .iter()
                .all(|s| (thinned(-s) * thinned(*s) - 1.0).abs() < 1e-15)
        );
        let wild = [-1e9, -1.0, -0.7, 0.7, 1.0, 40.0];
        assert!(wild.iter().all(|&s| (0.3..=3.1).contains(&thinned(s))));
        assert!(thinned(f64::NAN).is_nan());
    }
}
