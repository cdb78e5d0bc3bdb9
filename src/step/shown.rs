//! What snapshots show and no step needs.

use std::mem;

use rayon::prelude::*;

use super::simulation::Simulation;
use crate::neighbours::CHUNKS_AT_ONCE;
use crate::numerics::vector::norm;
use crate::numerics::virial::Virial;
use crate::particles::Scatter;
use crate::sph::{StressForces, stress};

impl Simulation {
    /// Writes into `contact_stress` what the traction across a particle in contact is more than
    /// that of its own stress. Right after a step, before the particles change.
    ///
    /// The traction is that of the virial of all its pair forces, by stress and by contact, on the
    /// plane that contact presses on (theory page "Contact").
    pub fn measure_contact_stress(&mut self) {
        if !self.contact.table.is_active() {
            return;
        }
        let mut shown = mem::take(&mut self.particles.contact_stress);
        shown.fill([0.0; 6]);
        let (particles, lists) = (&self.particles, &self.lists);
        let borne = self.contact.borne(particles, lists, self.state.last_dt);
        let forces = StressForces::new(&self.case, particles, lists);
        let slots = Scatter::new(&mut shown);
        let chunks = lists.chunks().par_iter().with_max_len(CHUNKS_AT_ONCE);
        chunks.for_each(|chunk| {
            for (cluster, neighbours, _) in chunk.iter() {
                for &place in &cluster.receivers[..cluster.lanes] {
                    let i = lists.images()[place as usize].base();
                    let press = norm(&borne[i].press);
                    if press == 0.0 {
                        continue;
                    }
                    let mut virial = forces.virial(place, neighbours);
                    virial.join(&borne[i].virial);
                    let normal = borne[i].press.map(|f| f / press);
                    let volume = particles.mass[i] / particles.density[i];
                    let more = excess(&virial, volume, &stress(particles, i));
                    // SAFETY: a particle is receiver in one chunk.
                    *unsafe { slots.slot(i) } = on_plane(&more, &normal);
                }
            }
        });
        self.particles.contact_stress = shown;
    }
}

/// The stress of a virial in a volume (m^d) less another (Pa).
fn excess(virial: &Virial, volume: f64, stress: &[f64; 6]) -> [f64; 6] {
    std::array::from_fn(|k| virial.0[k] / volume - stress[k])
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
