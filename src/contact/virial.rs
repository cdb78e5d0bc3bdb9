//! The stress of contact forces: the virial of a particle's pairs, for what snapshots show.
//!
//! A pair force carries momentum along the line between its two particles. SPH stresses hold none
//! of that, so beside an interface they are less than the traction; what the matter bears there is
//! both together (theory page "Contact").

use std::mem;

use rayon::prelude::*;

use super::mode::{fill, virial};
use super::phase::Contact;
use super::view::ContactView;
use crate::model::ContactClass;
use crate::neighbours::{CHUNKS_AT_ONCE, Lists};
use crate::particles::{ParticleStore, Scatter};

/// Sum of `−sym(f ⊗ r)` over forces (J): the stress that they carry times the volume that bears
/// it, tension positive.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Virial([f64; 6]);

impl Virial {
    /// Adds a force (N) that acts on a particle over `arm` (m), which leads to it from where the
    /// matter that carries the force begins.
    #[inline(always)]
    pub fn add(&mut self, force: &[f64; 3], arm: &[f64; 3]) {
        for (sum, [a, b]) in self.0.iter_mut().zip(COMPONENTS) {
            *sum -= 0.5 * (force[a] * arm[b] + force[b] * arm[a]);
        }
    }

    /// Adds its stress (Pa) in a volume (m^d) to another.
    fn spread(&self, volume: f64, stress: &mut [f64; 6]) {
        for (sum, part) in stress.iter_mut().zip(self.0) {
            *sum += part / volume;
        }
    }
}

/// xx, yy, zz, xy, xz, yz.
const COMPONENTS: [[usize; 2]; 6] = [[0, 0], [1, 1], [2, 2], [0, 1], [0, 2], [1, 2]];

impl Contact {
    /// Writes into `contact_stress` what the contact forces of the last step, of `dt` (s), carry:
    /// `σ_i = −1/V_i Σ_j ½ sym(f_ij ⊗ r_ij)` with the volume that the particle has now; of rigid
    /// surfaces the whole arm. Lists and halo must still be those of the step.
    pub fn measure_stress(&self, particles: &mut ParticleStore, lists: &Lists, dt: f64) {
        if !self.table.is_active() {
            return;
        }
        let mut stress = mem::take(&mut particles.contact_stress);
        fill(&mut stress, [0.0; 6]);
        let volume = |i: usize| particles.mass[i] / particles.density[i];
        let view = ContactView::new(particles, lists, &self.table, dt);
        let slots = Scatter::new(&mut stress);
        let friction = self.table.has_friction();
        let chunks = lists.foreign().par_iter().with_max_len(CHUNKS_AT_ONCE);
        chunks.for_each(|chunk| {
            for &class in ContactClass::ALL {
                for (index, neighbours) in chunk.of(class).iter() {
                    let i = view.party(index);
                    let virial = virial(&view, class, &i, neighbours, friction);
                    // SAFETY: a particle is receiver in one chunk.
                    virial.spread(volume(i.base), unsafe { slots.slot(i.base) });
                }
            }
        });
        for (i, virial) in self.surfaces.virials() {
            virial.spread(volume(i), &mut stress[i]);
        }
        particles.contact_stress = stress;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A push is compression along its arm, a drag across it shear.
    #[test]
    fn pushes_are_compression() {
        let mut virial = Virial::default();
        virial.add(&[3.0, 0.0, 0.0], &[0.5, 0.0, 0.0]);
        virial.add(&[0.0, 2.0, 0.0], &[0.0, 0.0, 0.25]);
        let mut stress = [0.0; 6];
        virial.spread(0.5, &mut stress);
        assert_eq!(stress, [-3.0, 0.0, 0.0, 0.0, 0.0, -0.5]);
    }
}
