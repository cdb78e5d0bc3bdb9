//! Conserved sums over all particles, and the errors that follow from them.

use super::ledger::{RunState, Totals};
use super::taken_out::{Leave, Removed};
use crate::loads::Loads;
use comm::Comm;
use material::FAILED;
use numerics::exact_sum::{ExactSum, gather_limbs, scatter_limbs};
use numerics::vector::{cross, norm};
use particles::{Active, KeptBlocks, ParticleStore};

/// Sums over inactive particles, kept from one row to the next.
#[derive(Debug, Default)]
pub(crate) struct KeptTotals {
    motion: KeptBlocks<[ExactSum; 11]>,
    failure: KeptBlocks<[ExactSum; 2]>,
}

impl KeptTotals {
    /// Bytes allocated.
    pub fn memory(&self) -> usize {
        self.motion.memory() + self.failure.memory()
    }
}

impl Totals {
    /// Of the particles of all ranks that are no part of a driven body, with the energies of contact and of
    /// self-gravity (J). Collective.
    pub(crate) fn of(
        active: Active,
        kept: &mut KeptTotals,
        loads: &Loads,
        [contact_energy, self_gravity_energy]: [f64; 2],
        comm: &Comm,
    ) -> Self {
        let (particles, g) = (active.particles, &loads.gravity);
        let mut sums = loads.sum_kept(active, &mut kept.motion, |i| {
            let (m, v) = (particles.mass[i], &particles.velocity[i]);
            let x = &particles.position[i];
            let height = -(g[0] * x[0] + g[1] * x[1] + g[2] * x[2]);
            let v2 = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
            let turn = cross(x, v);
            [
                0.5 * m * v2,
                particles.thermal_mass(i) * particles.specific_energy[i],
                m * height,
                m,
                m * v[0],
                m * v[1],
                m * v[2],
                m * v2.sqrt(),
                m * turn[0],
                m * turn[1],
                m * turn[2],
            ]
        });
        reduce(comm, &mut sums);
        let [kinetic, internal, gravity, mass, x, y, z, scale, turn @ ..] =
            sums.map(|sum| sum.value());
        Self {
            kinetic_energy: kinetic,
            internal_energy: internal,
            contact_energy,
            gravity_energy: gravity,
            self_gravity_energy,
            mass,
            momentum: [x, y, z],
            momentum_scale: scale,
            angular_momentum: turn,
            failed_mass: 0.0,
            failure_energy: 0.0,
            yielded_mass: 0.0,
        }
    }

    /// Adds the sums over material that may fail. Collective.
    pub(crate) fn add_failure(
        &mut self,
        active: Active,
        kept: &mut KeptTotals,
        loads: &Loads,
        comm: &Comm,
    ) {
        let particles = active.particles;
        let mut sums = loads.sum_kept(active, &mut kept.failure, |i| {
            let m = particles.thermal_mass(i);
            let failed = if particles.damage[i] >= FAILED {
                m
            } else {
                0.0
            };
            [failed, m * particles.failure_energy[i]]
        });
        reduce(comm, &mut sums);
        [self.failed_mass, self.failure_energy] = sums.map(|sum| sum.value());
    }

    /// Adds the mass in absorbing zones that has yielded or failed. Collective.
    pub(crate) fn add_yielded(&mut self, particles: &ParticleStore, loads: &Loads, comm: &Comm) {
        if !loads.absorb() {
            return;
        }
        let mut sums = loads.sum_free(particles, |i| {
            let damage = particles.damage.get(i).copied().unwrap_or_default();
            let yielded = particles.plastic_strain[i] > 0.0 || damage >= FAILED;
            let counts = yielded && particles.absorption[i] > 0.0;
            [if counts {
                particles.thermal_mass(i)
            } else {
                0.0
            }]
        });
        reduce(comm, &mut sums);
        self.yielded_mass = sums[0].value();
    }
}

/// Mass that has failed (kg) of each of so many bodies. Collective.
pub fn failed_mass(particles: &ParticleStore, bodies: usize, comm: &Comm) -> Vec<f64> {
    let mut sums = vec![ExactSum::default(); bodies];
    // For rows of tables, not in every step.
    let owned = particles.damage.iter().enumerate().take(particles.owned());
    for (i, _) in owned.filter(|(_, damage)| **damage >= FAILED) {
        sums[particles.body[i] as usize].add(particles.thermal_mass(i));
    }
    reduce(comm, &mut sums);
    sums.iter().map(ExactSum::value).collect()
}

/// `Σ |(x − x̄) × m v|` (kg m²/s) over the particles of all ranks that are no part of a driven body,
/// with x̄ (m) their centre of mass now. Collective.
pub(crate) fn angular_momentum_scale(particles: &ParticleStore, loads: &Loads, comm: &Comm) -> f64 {
    let mut sums = loads.sum_free(particles, |i| {
        let m = particles.mass[i];
        let [x, y, z] = particles.position[i].map(|x| m * x);
        [m, x, y, z]
    });
    reduce(comm, &mut sums);
    let [mass, centre @ ..] = sums.map(|sum| sum.value());
    let mut scale = loads.sum_free(particles, |i| {
        let (x, v) = (&particles.position[i], &particles.velocity[i]);
        if *v == [0.0; 3] {
            return [0.0];
        }
        let arm = std::array::from_fn(|a| x[a] - centre[a] / mass);
        [particles.mass[i] * norm(&cross(&arm, v))]
    });
    reduce(comm, &mut scale);
    scale[0].value()
}

/// Joins the sums of all ranks. Collective.
fn reduce(comm: &Comm, sums: &mut [ExactSum]) {
    let mut limbs = Vec::new();
    gather_limbs(sums.iter_mut(), &mut limbs);
    comm.sum_i64(&mut limbs);
    scatter_limbs(sums.iter_mut(), &limbs);
}

impl RunState {
    /// Energy that went with removed particles, those of contact and self-gravity included (J).
    #[must_use]
    pub fn removed_energy(&self) -> f64 {
        self.removed.iter().map(Removed::energy).sum::<f64>()
            + self.removed_contact_energy
            + self.removed_self_gravity_energy
    }

    /// Energy that went with those that left the box of interest, those of contact and self-gravity included (J).
    #[must_use]
    pub fn departed_energy(&self) -> f64 {
        self.departed.iter().map(Removed::energy).sum::<f64>()
            + self.departed_contact_energy
            + self.departed_self_gravity_energy
    }

    /// Mass that left the box of interest (kg).
    #[must_use]
    pub fn departed_mass(&self) -> f64 {
        self.departed.iter().map(|gone| gone.mass).sum()
    }

    /// Sums that all particles that were taken out took with them, by cause and body.
    fn taken_out(&self) -> impl Iterator<Item = &Removed> {
        self.removed.iter().chain(&self.departed)
    }

    /// The ledgers of what leaves for a reason, by body, and of its energies of contact and self-gravity (J).
    pub(crate) fn leaving(&mut self, why: Leave) -> (&mut Vec<Removed>, [&mut f64; 2]) {
        match why {
            Leave::Failed => (
                &mut self.removed,
                [
                    &mut self.removed_contact_energy,
                    &mut self.removed_self_gravity_energy,
                ],
            ),
            Leave::Departed => (
                &mut self.departed,
                [
                    &mut self.departed_contact_energy,
                    &mut self.departed_self_gravity_energy,
                ],
            ),
        }
    }

    /// Momentum that all particles have gained since the start, those taken out included (kg m/s).
    #[must_use]
    pub fn gained_momentum(&self) -> [f64; 3] {
        std::array::from_fn(|a| {
            let taken: f64 = self.taken_out().map(|r| r.momentum[a]).sum();
            self.totals.momentum[a] + taken - self.initial.momentum[a]
        })
    }

    /// Takes sums over all particles, under gravity (m/s²), and their `Σ |(x − x̄) × m v|` (kg m²/s), with the errors that
    /// follow from them.
    pub(crate) fn book_totals(&mut self, totals: Totals, turning: f64, gravity: [f64; 3]) {
        self.totals = totals;
        // The states of programs that kept no largest values have those of the start.
        for sums in [self.initial, totals] {
            self.most_kinetic_energy = self.most_kinetic_energy.max(sums.kinetic_energy);
            self.most_momentum = self.most_momentum.max(sums.momentum_scale);
        }
        let most = &mut self.angular_momentum_scale;
        *most = most.map(|most| most.max(turning));
        let (work, impulse) = (self.load_work(), self.load_impulse());
        let fallen = totals.gravity_energy - self.initial.gravity_energy;
        let drawn = totals.self_gravity_energy - self.initial.self_gravity_energy;
        for work in [work, fallen, drawn] {
            self.work_put_in = self.work_put_in.max(work.abs());
        }
        let removed = self.removed_energy() + self.departed_energy();
        let worst = &mut self.worst;
        let error = totals.energy() + removed - self.initial.energy() - work;
        worst.energy_deviation = worst.energy_deviation.max(error.abs());
        let scale = self.most_kinetic_energy.max(self.work_put_in);
        if scale > 0.0 {
            worst.energy_error = worst.energy_deviation / scale;
            worst.contact_defect = worst.contact_deviation / scale;
        }
        let gained = self.gained_momentum();
        for a in 0..3 {
            let removed = |part: fn(&Removed) -> f64| self.taken_out().map(part).sum::<f64>();
            let mass_time = totals.mass * self.time + removed(|r| r.mass_time);
            let falling = mass_time * gravity[a];
            let outside = impulse[a] + falling;
            let error = gained[a] - self.plane_impulse[a] - self.tree_impulse[a] - outside;
            let worst = &mut self.worst.momentum_deviation[a];
            *worst = worst.max(error.abs());
            for put in [impulse[a], falling] {
                self.momentum_put_in = self.momentum_put_in.max(put.abs());
            }
        }
        self.book_angular_momentum();
        let worst = &mut self.worst;
        let scale = self.most_momentum.max(self.momentum_put_in);
        if scale > 0.0 {
            worst.momentum_error = worst.momentum_deviation.map(|error| error / scale);
        }
    }

    /// Records the error of angular momentum that no angular impulse explains.
    fn book_angular_momentum(&mut self) {
        let Some(scale) = self.angular_momentum_scale else {
            return;
        };
        for a in 0..3 {
            let taken: f64 = self.taken_out().map(|r| r.angular_momentum[a]).sum();
            let gained = self.totals.angular_momentum[a] + taken - self.initial.angular_momentum[a];
            let error = (gained - self.angular_impulse[a]).abs();
            let worst = &mut self.worst.angular_momentum_deviation[a];
            *worst = worst.max(error);
            let put_in = &mut self.angular_momentum_put_in;
            *put_in = put_in.max(self.angular_impulse[a].abs());
        }
        let scale = scale.max(self.angular_momentum_put_in);
        let worst = &mut self.worst;
        if scale > 0.0 {
            worst.angular_momentum_error = worst.angular_momentum_deviation.map(|e| e / scale);
        }
    }

    /// The contact defect, after the sums of a step.
    pub(crate) fn book_defect(&mut self) {
        let heat = self.contact_heat();
        let worst = &mut self.worst;
        let gone = self.removed_contact_energy + self.departed_contact_energy;
        let defect =
            self.contact_work + gone + self.contact_energy - self.initial.contact_energy + heat;
        worst.contact_deviation = worst.contact_deviation.max(defect.abs());
        let scale = self.most_kinetic_energy.max(self.work_put_in);
        if scale > 0.0 {
            worst.contact_defect = worst.contact_deviation / scale;
        }
    }
}
