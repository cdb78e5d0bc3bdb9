//! Rigid planes: a frictionless penalty on particles nearer than half a spacing.
//!
//! With the gap `g` between particle and plane and `δ = ⟨½Δp − g⟩₊` each particle has the energy
//! `½ κ M V (δ/Δp)²`, M its reference p-wave modulus and V its reference volume: a function of the
//! gap alone, whose gradient `κ M V δ/Δp²` pushes along the normal.

use rayon::prelude::*;

use super::loads::PlaneStep;
use super::search::GRAIN;
use super::simulation::Simulation;
use crate::contact::ContactTable;
use crate::model::{Case, RigidPlane};
use crate::particles::ParticleStore;

/// What a plane does to one particle.
#[derive(Debug, Clone, Copy)]
pub(super) struct Push {
    particle: usize,
    plane: usize,
    /// Along the normal (N).
    force: f64,
    energy: f64,
    stiffness: f64,
    approach: f64,
}

/// Constants of a plane and a body that it acts on.
#[derive(Debug, Clone, Copy)]
struct Penalty {
    /// Stiffness over volume, `κ M/Δp²` (Pa/m²).
    stiffness: f64,
    /// Where it begins, ½Δp (m).
    reach: f64,
    h: f64,
}

/// The planes of a case and what they do, kept from step to step.
#[derive(Debug, Default)]
pub(super) struct PlaneForces {
    /// By plane and body; absent where a plane does not act.
    penalties: Vec<Vec<Option<Penalty>>>,
    /// By task.
    pushes: Vec<Vec<Push>>,
}

impl PlaneForces {
    pub(super) fn new(case: &Case) -> Self {
        let penalties = case.loads.planes.iter().map(|plane| {
            let bodies = case.bodies.iter().zip(&plane.bodies);
            let penalty = bodies.map(|(body, &acts)| {
                let spacing = body.lattice.spacing;
                acts.then(|| Penalty {
                    stiffness: plane.stiffness * case.materials[body.material].p_wave_modulus()
                        / (spacing * spacing),
                    reach: 0.5 * spacing,
                    h: body.smoothing_length,
                })
            });
            penalty.collect()
        });
        Self {
            penalties: penalties.collect(),
            pushes: Vec::new(),
        }
    }

    pub(super) fn memory(&self) -> usize {
        let penalties = self.penalties.iter().map(Vec::capacity).sum::<usize>();
        let pushes = self.pushes.iter().map(Vec::capacity).sum::<usize>();
        penalties * size_of::<Option<Penalty>>() + pushes * size_of::<Push>()
    }
}

impl Penalty {
    /// What a particle of reference volume `volume` (m^d) feels at a gap (m) that changes at
    /// `rate` (m/s): force, energy, stiffness, approach speed.
    fn push(&self, volume: f64, gap: f64, rate: f64) -> [f64; 4] {
        let k = self.stiffness * volume;
        let depth = (self.reach - gap).max(0.0);
        // As with its mirror image, see `contact::Gap::approach`.
        let soft = 4.0 * (gap * gap) + 0.01 * (self.h * self.h);
        let approach = (-4.0 * self.h * rate * gap.abs() / soft).max(0.0);
        [k * depth, 0.5 * k * (depth * depth), k, approach]
    }
}

impl Simulation {
    /// Adds what the rigid planes do to the forces of contact.
    pub(super) fn plane_forces(&mut self) {
        if self.loads.planes.is_empty() {
            return;
        }
        self.find_pushes();
        let (store, sums) = (&mut self.store, &mut self.sums);
        for push in self.plane_forces.pushes.iter().flatten() {
            let i = push.particle;
            let normal = &self.case.loads.planes[push.plane].normal;
            let per_mass = push.force / store.mass[i];
            for a in 0..3 {
                store.contact_acceleration[i][a] += normal[a] * per_mass;
            }
            store.contact_energy[i] += push.energy;
            store.contact_stiffness[i] += push.stiffness;
            store.approach_speed[i] = store.approach_speed[i].max(push.approach);
            sums.contact_energy.add(push.energy);
            sums.add_push(push.plane, push.force);
        }
    }

    /// The particles near planes, chunk after chunk.
    fn find_pushes(&mut self) {
        let owned = self.store.owned();
        let PlaneForces { penalties, pushes } = std::mem::take(&mut self.plane_forces);
        let mut pushes = pushes;
        pushes.resize(owned.div_ceil(GRAIN), Vec::new());
        let view = View {
            store: &self.store,
            table: &self.contact,
            planes: &self.case.loads.planes,
            steps: &self.loads.planes,
            penalties: &penalties,
        };
        let chunks = pushes.par_iter_mut().enumerate();
        chunks.for_each(|(chunk, pushes)| {
            pushes.clear();
            for i in chunk * GRAIN..((chunk + 1) * GRAIN).min(owned) {
                pushes.extend((0..view.planes.len()).filter_map(|n| view.push(i, n)));
            }
        });
        self.plane_forces = PlaneForces { penalties, pushes };
    }
}

/// What a push depends on.
struct View<'a> {
    store: &'a ParticleStore,
    table: &'a ContactTable,
    planes: &'a [RigidPlane],
    steps: &'a [PlaneStep],
    penalties: &'a [Vec<Option<Penalty>>],
}

impl View<'_> {
    /// What plane `n` does to particle `i`, if that is near it.
    fn push(&self, i: usize, n: usize) -> Option<Push> {
        let (plane, step) = (&self.planes[n], &self.steps[n]);
        let body = self.store.body[i] as usize;
        let penalty = self.penalties[n][body].as_ref()?;
        let gap = plane.along(&self.store.position[i]) - step.position;
        if gap >= penalty.h.max(penalty.reach) {
            return None;
        }
        let rate = plane.along(&self.store.predicted_velocity[i]) - step.velocity[2];
        let volume = self.store.mass[i] * self.table.inverse_density(body);
        let [force, energy, stiffness, approach] = penalty.push(volume, gap, rate);
        Some(Push {
            particle: i,
            plane: n,
            force,
            energy,
            stiffness,
            approach,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The force is the gradient of the energy, to the order of a central difference.
    #[test]
    fn the_force_is_the_gradient_of_the_energy() {
        let penalty = Penalty {
            stiffness: 3e11,
            reach: 0.5e-3,
            h: 1.3e-3,
        };
        let volume = 1e-9;
        for gap in [-2e-3, -1e-4, 1e-4, 4.9e-4, 6e-4] {
            let at = |gap| penalty.push(volume, gap, 0.0);
            let step = 1e-9;
            let slope = (at(gap + step)[1] - at(gap - step)[1]) / (2.0 * step);
            assert!((at(gap)[0] + slope).abs() <= 1e-6 * at(0.0)[0], "{gap}");
        }
        // At its own mirror image, twice the speed at twice the distance.
        let [.., approach] = penalty.push(volume, 0.5e-3, -10.0);
        let expected = 1.3e-3 * 20.0 * 1e-3 / (1e-6 + 0.01 * 1.69e-6);
        assert!((approach / expected - 1.0).abs() < 1e-14);
    }
}
