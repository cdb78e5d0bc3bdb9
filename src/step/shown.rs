//! What snapshots show and no step needs.

use rayon::prelude::*;

use super::simulation::Simulation;
use crate::comm::Comm;
use crate::domain::Mirrors;
use crate::neighbours::{CHUNKS_AT_ONCE, Lists};
use crate::numerics::kernel::Kernel;
use crate::numerics::vector::{minus, norm};
use crate::particles::{HaloPhase, ParticleStore, Scatter};
use crate::sph::{StressForces, stress};

/// What the pair forces of a particle carry.
#[derive(Debug, Clone, Copy, Default)]
pub struct Carried {
    /// Virial of all its pair forces, by stress and by contact, over its volume (Pa, tension
    /// positive).
    pub stress: [f64; 6],
    /// The direction in which contact presses on it; none where it does not.
    pub normal: Option<[f64; 3]>,
}

impl Simulation {
    /// What the pair forces of each owned particle in contact carry, and zeros of all others.
    /// Right after a step, before the particles change.
    #[must_use]
    pub fn carried_in_contact(&self) -> Vec<Carried> {
        let (particles, lists) = (&self.particles, &self.lists);
        let borne = self.contact.borne(particles, lists, self.state.last_dt);
        let forces = StressForces::new(&self.case, particles, lists);
        let mut carried = vec![Carried::default(); borne.len()];
        let slots = Scatter::new(&mut carried);
        for_each_receiver(lists, |place, neighbours| {
            let i = lists.images()[place as usize].base();
            let press = norm(&borne[i].press);
            if press == 0.0 {
                return;
            }
            let mut virial = forces.virial(place, neighbours);
            virial.join(&borne[i].virial);
            let volume = particles.mass[i] / particles.density[i];
            // SAFETY: a particle is receiver once.
            *unsafe { slots.slot(i) } = Carried {
                stress: virial.0.map(|v| v / volume),
                normal: Some(borne[i].press.map(|f| f / press)),
            };
        });
        carried
    }

    /// Writes into `contact_stress` what the traction across a particle in contact is more than
    /// that of its own stress. Right after a step, before the particles change. Collective.
    ///
    /// The traction is that of [`Self::carried_in_contact`], as the kernel averages it over the
    /// particles of the body that are in contact, on the plane that contact presses on (theory page
    /// "Contact").
    pub fn measure_contact_stress(&mut self, comm: &Comm) {
        if !self.contact.table.is_active() {
            return;
        }
        let carried = self.carried_in_contact();
        for (field, of) in self.particles.contact_stress.iter_mut().zip(&carried) {
            *field = of.stress;
        }
        self.halo
            .exchange(comm, &mut self.particles, HaloPhase::SHOWN);
        let mut shown = vec![[0.0; 6]; carried.len()];
        let slots = Scatter::new(&mut shown);
        let (particles, lists) = (&self.particles, &self.lists);
        let kernel = Kernel::new(self.case.dimension);
        for_each_receiver(lists, |place, neighbours| {
            let i = lists.images()[place as usize].base();
            if let Some(normal) = carried[i].normal {
                let mean = mean_carried(&kernel, particles, lists, (place, neighbours));
                let own = stress(particles, i);
                let more = std::array::from_fn(|k| mean[k] - own[k]);
                // SAFETY: a particle is receiver once.
                *unsafe { slots.slot(i) } = on_plane(&more, &normal);
            }
        });
        self.particles.contact_stress[..shown.len()].copy_from_slice(&shown);
    }
}

/// Mean over a particle in contact and its neighbours that are in contact too,
/// `Σ V_j W_ij S_j / Σ V_j W_ij`, of what stands in `contact_stress`.
fn mean_carried(
    kernel: &Kernel,
    particles: &ParticleStore,
    lists: &Lists,
    (place, neighbours): (u32, &[u32]),
) -> [f64; 6] {
    let (images, motion) = (lists.images(), lists.motion());
    let h = |place: u32| particles.smoothing_length[images[place as usize].base()];
    let (mut sum, mut weights) = ([0.0; 6], 0.0);
    for &other in neighbours {
        let (image, record) = (images[other as usize], &motion[other as usize]);
        let carried = &particles.contact_stress[image.base()];
        if *carried == [0.0; 6] {
            continue;
        }
        let distance = norm(&minus(&motion[place as usize].position, &record.position));
        let weight = record.volume * kernel.value(distance, 0.5 * (h(place) + h(other)));
        let carried = Mirrors::reflect_symmetric(carried, image.code());
        weights += weight;
        for k in 0..6 {
            sum[k] += weight * carried[k];
        }
    }
    let weights = weights.max(f64::MIN_POSITIVE);
    sum.map(|s| s / weights)
}

/// Calls `work` with the place of each owned particle among the images and its neighbours in its
/// own body, itself among them.
fn for_each_receiver(lists: &Lists, work: impl Fn(u32, &[u32]) + Sync) {
    let chunks = lists.chunks().par_iter().with_max_len(CHUNKS_AT_ONCE);
    chunks.for_each(|chunk| {
        for (cluster, neighbours, _) in chunk.iter() {
            for &place in &cluster.receivers[..cluster.lanes] {
                work(place, neighbours);
            }
        }
    });
}

/// The part of a symmetric tensor that acts on the plane of a unit normal: with the same traction
/// there, and none between directions in the plane.
fn on_plane(tensor: &[f64; 6], n: &[f64; 3]) -> [f64; 6] {
    let [xx, yy, zz, xy, xz, yz] = *tensor;
    let t = [
        xx * n[0] + xy * n[1] + xz * n[2],
        xy * n[0] + yy * n[1] + yz * n[2],
        xz * n[0] + yz * n[1] + zz * n[2],
    ];
    let normal = t[0] * n[0] + t[1] * n[1] + t[2] * n[2];
    let part = |a: usize, b: usize| n[a] * t[b] + t[a] * n[b] - normal * (n[a] * n[b]);
    [
        part(0, 0),
        part(1, 1),
        part(2, 2),
        part(0, 1),
        part(0, 2),
        part(1, 2),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The traction stays on the plane itself, and vanishes between directions in it.
    #[test]
    fn only_the_plane_of_contact_bears_more() {
        let tensor = [3.0, -1.0, 2.0, 0.5, 0.25, -2.0];
        let along_y = on_plane(&tensor, &[0.0, 1.0, 0.0]);
        assert_eq!(along_y, [0.0, -1.0, 0.0, 0.5, 0.0, -2.0]);
        let n = [0.6, 0.0, 0.8];
        let [xx, yy, zz, xy, xz, yz] = on_plane(&tensor, &n);
        let traction = [
            xx * n[0] + xz * n[2],
            xy * n[0] + yz * n[2],
            xz * n[0] + zz * n[2],
        ];
        let expected = [
            3.0 * 0.6 + 0.25 * 0.8,
            0.5 * 0.6 - 2.0 * 0.8,
            0.25 * 0.6 + 2.0 * 0.8,
        ];
        for a in 0..3 {
            assert!((traction[a] - expected[a]).abs() < 1e-14);
        }
        let across = [0.8, 0.0, -0.6];
        let in_plane = xx * across[0] * across[0]
            + 2.0 * xz * across[0] * across[2]
            + zz * across[2] * across[2];
        assert!(yy.abs() < 1e-14 && in_plane.abs() < 1e-14);
    }
}
