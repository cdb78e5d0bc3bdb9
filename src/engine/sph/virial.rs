//! The virial of the forces by which stresses act between pairs of particles, for what snapshots
//! show (theory page "Contact"). No step needs it, so it is no sweep in vectors.

use crate::sph::phase::Sph;
use model::{Case, SphForm};
use numerics::kernel::Kernel;
use numerics::vector::{dot, minus, norm};
use numerics::virial::Virial;
use particles::Mirrors;
use particles::ParticleStore;
use particles::neighbours::Lists;
use sums::corrected::CorrectedRecord;

/// Forces of stresses after a step, while lists and halo are still those of that step.
pub struct StressForces<'a> {
    form: SphForm,
    /// Records of images in the corrected form.
    corrected: &'a [CorrectedRecord],
    kernel: Kernel,
    particles: &'a ParticleStore,
    lists: &'a Lists,
}

impl<'a> StressForces<'a> {
    /// Of a case.
    #[must_use]
    pub fn new(case: &Case, particles: &'a ParticleStore, lists: &'a Lists, sph: &'a Sph) -> Self {
        Self {
            form: case.sph.form,
            corrected: sph.corrected(),
            kernel: Kernel::new(case.extent()),
            particles,
            lists,
        }
    }

    /// `−Σ_j ½ sym(f_ij ⊗ (x_i − x_j))` (J) of an owned particle, given its place among the images
    /// and the neighbours of its own body. Gradients of the other forms are exact up to faces, or
    /// their particles have no stress: there it is the stress of the particle times its volume.
    #[must_use]
    pub fn virial(&self, place: u32, neighbours: &[u32]) -> Virial {
        let here = self.lists.images()[place as usize].slot();
        if !matches!(self.form, SphForm::Conventional | SphForm::Corrected) {
            let volume = self.particles.mass[here] / self.particles.density[here];
            return Virial(stress(self.particles, here).map(|s| s * volume));
        }
        let own = self.carried(place);
        let motion = self.lists.motion();
        let h = |place: u32| {
            self.particles.smoothing_length[self.lists.images()[place as usize].slot()]
        };
        let mut virial = Virial::default();
        for &other in neighbours {
            let r = minus(
                &motion[place as usize].position,
                &motion[other as usize].position,
            );
            let distance = norm(&r);
            if distance == 0.0 {
                continue;
            }
            let slope = self.kernel.slope(distance, 0.5 * (h(place) + h(other)));
            if slope == 0.0 {
                continue;
            }
            let their = self.carried(other);
            let weights = own.weight * their.weight * slope / distance;
            let pull = dot(&minus(&own.hourglass, &their.hourglass), &r) / (distance * distance);
            let force = std::array::from_fn(|a| {
                let row = |b: usize| (own.stress[3 * a + b] + their.stress[3 * a + b]) * r[b];
                weights * (row(0) + row(1) + row(2) + pull * r[a])
            });
            virial.add(&force, &r.map(|x| 0.5 * x));
        }
        virial
    }

    /// Share of a particle or image in the force `w_i w_j (Q_i + Q_j) ∇W_ij`: of conventional
    /// SPH `w = m` and `Q = σ/ρ²`, of the corrected form `w = V` and `Q = A σ B`, with the terms of
    /// hourglass displacements.
    fn carried(&self, place: u32) -> Carried {
        let image = self.lists.images()[place as usize];
        let (slot, mirror_mask) = (image.slot(), image.mirror_mask());
        let motion = &self.lists.motion()[place as usize];
        let particles = self.particles;
        if self.form == SphForm::Corrected {
            let record = &self.corrected[place as usize];
            return Carried {
                weight: motion.volume,
                stress: record.stress,
                hourglass: record.hourglass,
            };
        }
        let [xx, yy, zz, xy, xz, yz] =
            Mirrors::reflect_symmetric(&stress(particles, slot), mirror_mask);
        let scale = 1.0 / (particles.density[slot] * particles.density[slot]);
        Carried {
            weight: motion.mass,
            stress: [xx, xy, xz, xy, yy, yz, xz, yz, zz].map(|s| s * scale),
            hourglass: [0.0; 3],
        }
    }
}

/// Share of a particle in the force of a pair.
struct Carried {
    weight: f64,
    stress: [f64; 9],
    hourglass: [f64; 3],
}

/// The stress of a particle's material (Pa), tension positive.
#[must_use]
pub fn stress(particles: &ParticleStore, i: usize) -> [f64; 6] {
    let (mut stress, pressure) = (particles.deviatoric_stress[i], particles.pressure[i]);
    for normal in &mut stress[..3] {
        *normal -= pressure;
    }
    stress
}
