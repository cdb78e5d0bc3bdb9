//! The material's answer to the velocity gradient, cluster by cluster inside the first sweep.

use super::sums::Sums;
use crate::material::{LANES, Material, PointBatch};
use crate::neighbours::{Cluster, Lists};
use crate::numerics::lanes::F64x8;
use crate::particles::{Image, Scatter};
use crate::sph::momentum::StressRecord;

/// Work for a particle apart from its neighbours, in neighbours of the pair sums: sort, list,
/// material, integration and votes against both sweeps, as timed by the bench.
const OWN_WORK: u32 = 60;

/// What the update reads and writes: each owned particle stands in exactly one lane of one
/// cluster.
pub(super) struct MaterialUpdate<'a> {
    images: &'a [Image],
    materials: &'a [Material],
    material_of_body: &'a [usize],
    /// By group: whether it is a rigid body.
    rigid: &'a [bool],
    dt: f64,
    body: &'a [u32],
    /// Specific energy after the first half kick, and its last rate.
    specific_energy: Scatter<'a, f64>,
    heating: &'a [f64],
    stresses: Scatter<'a, StressRecord>,
    density: Scatter<'a, f64>,
    velocity_gradient: Scatter<'a, [f64; 9]>,
    deviatoric_stress: Scatter<'a, [f64; 6]>,
    plastic_strain: Scatter<'a, f64>,
    pressure: Scatter<'a, f64>,
    sound_speed: Scatter<'a, f64>,
    work: Scatter<'a, u32>,
}

/// The fields that the update reads and writes, borrowed one by one so that a formulation may write
/// others meanwhile.
pub(super) struct PointFields<'a> {
    pub body: &'a [u32],
    pub specific_energy: &'a mut [f64],
    pub heating: &'a [f64],
    pub density: &'a mut [f64],
    pub velocity_gradient: &'a mut [[f64; 9]],
    pub deviatoric_stress: &'a mut [[f64; 6]],
    pub plastic_strain: &'a mut [f64],
    pub pressure: &'a mut [f64],
    pub sound_speed: &'a mut [f64],
    pub work: &'a mut [u32],
}

/// Borrows [`PointFields`] of a store.
macro_rules! point_fields {
    ($particles:expr) => {
        $crate::sph::material_update::PointFields {
            body: &$particles.body,
            specific_energy: &mut $particles.specific_energy,
            heating: &$particles.d_specific_energy_dt,
            density: &mut $particles.density,
            velocity_gradient: &mut $particles.velocity_gradient,
            deviatoric_stress: &mut $particles.deviatoric_stress,
            plastic_strain: &mut $particles.plastic_strain,
            pressure: &mut $particles.pressure,
            sound_speed: &mut $particles.sound_speed,
            work: &mut $particles.work,
        }
    };
}
pub(super) use point_fields;

impl<'a> MaterialUpdate<'a> {
    pub(super) fn new(
        fields: PointFields<'a>,
        sums: &'a mut Sums,
        lists: &'a Lists,
        dt: f64,
    ) -> Self {
        let PointFields {
            body,
            specific_energy,
            heating,
            density,
            velocity_gradient,
            deviatoric_stress,
            plastic_strain,
            pressure,
            sound_speed,
            work,
        } = fields;
        Self {
            images: lists.images(),
            materials: &sums.materials,
            material_of_body: &sums.material_of_body,
            rigid: &lists.groups.rigid,
            dt,
            body,
            specific_energy: Scatter::new(specific_energy),
            heating,
            stresses: Scatter::new(&mut sums.stresses),
            density: Scatter::new(density),
            velocity_gradient: Scatter::new(velocity_gradient),
            deviatoric_stress: Scatter::new(deviatoric_stress),
            plastic_strain: Scatter::new(plastic_strain),
            pressure: Scatter::new(pressure),
            sound_speed: Scatter::new(sound_speed),
            work: Scatter::new(work),
        }
    }

    /// Advances density, stress and strain of a cluster whose velocity gradient at the end of
    /// the step is `gradient`; `neighbours` is the length of its list.
    #[inline(always)]
    pub(super) fn apply(&self, cluster: &Cluster, gradient: &[F64x8; 9], neighbours: usize) {
        if self.rigid[cluster.group] {
            self.store_free(cluster, 0);
            return;
        }
        let base = self.base(cluster);
        let mut before = self.gather(&base);
        for c in 0..9 {
            for k in 0..LANES {
                let mean = 0.5 * (before.velocity_gradient[c][k] + gradient[c].0[k]);
                before.velocity_gradient[c][k] = mean;
            }
        }
        self.advance(cluster, &base, before, gradient, neighbours);
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
        let base = self.base(cluster);
        let mut before = self.gather(&base);
        for c in 0..9 {
            before.velocity_gradient[c] = mean[c].0;
        }
        self.advance(cluster, &base, before, gradient, neighbours);
    }

    /// Adds to the specific energy of particle `i` (J/kg).
    #[inline(always)]
    pub(super) fn heat(&self, i: usize, energy: f64) {
        // SAFETY: particle `i` belongs to one cluster alone, and this thread has the cluster.
        unsafe { *self.specific_energy.slot(i) += energy };
    }

    /// Rate of the specific energy of particle `i` at the beginning of the step (W/kg).
    #[inline(always)]
    pub(super) fn heating(&self, i: usize) -> f64 {
        self.heating[i]
    }

    /// The velocity gradient that the last step has left of particle `i`.
    #[inline(always)]
    pub(super) fn last_gradient(&self, i: usize) -> [f64; 9] {
        // SAFETY: particle `i` belongs to one cluster alone, and this thread has the cluster.
        unsafe { *self.velocity_gradient.slot(i) }
    }

    #[inline(always)]
    fn base(&self, cluster: &Cluster) -> [usize; LANES] {
        let at = |k: usize| self.images[cluster.receivers[k] as usize].base();
        [at(0), at(1), at(2), at(3), at(4), at(5), at(6), at(7)]
    }

    /// Advances what was gathered by the velocity gradients in it.
    #[inline(always)]
    fn advance(
        &self,
        cluster: &Cluster,
        base: &[usize; LANES],
        mut before: PointBatch,
        gradient: &[F64x8; 9],
        neighbours: usize,
    ) {
        let half = 0.5 * self.dt;
        let [xx, _, _, _, yy, _, _, _, zz] = &before.velocity_gradient;
        for k in 0..LANES {
            let strain = half * (xx[k] + yy[k] + zz[k]);
            before.density[k] *= (1.0 - strain) / (1.0 + strain);
        }
        let places = &cluster.receivers;
        let material = |k: usize| self.material_of_body[self.body[base[k]] as usize];
        // Empty lanes cost as much as others.
        let work = neighbours * LANES / cluster.lanes;
        let work = OWN_WORK + u32::try_from(work).unwrap_or(u32::MAX / 2);
        let mut done = 0_u32;
        for k in 0..cluster.lanes {
            if done >> k & 1 == 1 {
                continue;
            }
            let own = material(k);
            let mut after = before;
            self.materials[own].update(&mut after, self.dt);
            for lane in k..cluster.lanes {
                if material(lane) == own {
                    done |= 1 << lane;
                    self.store(base[lane], lane, &after, gradient, work);
                    let s = |c: usize| after.deviatoric_stress[c][lane];
                    let record = StressRecord::new(
                        after.pressure[lane],
                        &[s(0), s(1), s(2), s(3), s(4), s(5)],
                        after.density[lane],
                        after.sound_speed[lane],
                    );
                    // SAFETY: the place belongs to this cluster alone, as its particle does.
                    unsafe { *self.stresses.slot(places[lane] as usize) = record };
                }
            }
        }
    }

    /// Particles of a rigid body, or beside stress points, have no stress; nobody reads their
    /// records.
    #[cold]
    pub(super) fn store_free(&self, cluster: &Cluster, neighbours: usize) {
        let work = OWN_WORK + u32::try_from(neighbours).unwrap_or(u32::MAX / 2);
        for &place in &cluster.receivers[..cluster.lanes] {
            let i = self.images[place as usize].base();
            // SAFETY: particle `i` belongs to this cluster alone, and this thread has the cluster.
            unsafe {
                *self.pressure.slot(i) = 0.0;
                *self.sound_speed.slot(i) = 0.0;
                *self.work.slot(i) = work;
            }
        }
    }

    /// The state of a cluster's particles, with the last velocity gradients.
    #[inline(always)]
    fn gather(&self, base: &[usize; LANES]) -> PointBatch {
        let mut batch = PointBatch {
            density: [0.0; LANES],
            specific_energy: [0.0; LANES],
            velocity_gradient: [[0.0; LANES]; 9],
            deviatoric_stress: [[0.0; LANES]; 6],
            plastic_strain: [0.0; LANES],
            pressure: [0.0; LANES],
            sound_speed: [0.0; LANES],
        };
        let half = 0.5 * self.dt;
        for (k, &i) in base.iter().enumerate() {
            // SAFETY: particle `i` belongs to this cluster alone, and this thread has the cluster.
            let (e, rho, l, s, plastic) = unsafe {
                (
                    &*self.specific_energy.slot(i),
                    &*self.density.slot(i),
                    &*self.velocity_gradient.slot(i),
                    &*self.deviatoric_stress.slot(i),
                    &*self.plastic_strain.slot(i),
                )
            };
            batch.density[k] = *rho;
            for c in 0..9 {
                batch.velocity_gradient[c][k] = l[c];
            }
            for c in 0..6 {
                batch.deviatoric_stress[c][k] = s[c];
            }
            batch.plastic_strain[k] = *plastic;
            batch.specific_energy[k] = *e + half * self.heating[i];
        }
        batch
    }

    #[inline(always)]
    fn store(&self, i: usize, k: usize, batch: &PointBatch, gradient: &[F64x8; 9], work: u32) {
        // SAFETY: particle `i` belongs to this cluster alone, and this thread has the cluster.
        unsafe {
            *self.density.slot(i) = batch.density[k];
            let l = self.velocity_gradient.slot(i);
            for c in 0..9 {
                l[c] = gradient[c].0[k];
            }
            let s = self.deviatoric_stress.slot(i);
            for c in 0..6 {
                s[c] = batch.deviatoric_stress[c][k];
            }
            *self.plastic_strain.slot(i) = batch.plastic_strain[k];
            *self.pressure.slot(i) = batch.pressure[k];
            *self.sound_speed.slot(i) = batch.sound_speed[k];
            *self.work.slot(i) = work;
        }
    }
}
