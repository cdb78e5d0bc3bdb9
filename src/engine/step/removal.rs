//! Particles that are out of range, or have left the box of interest, are taken out of a run with all
//! that they carry booked, and frozen ones are out of all sums like removed ones, kept for the files.
//!
//! Were a particle to stay in the sums at rest, it would push others without being pushed: momentum
//! and energy would be lost in each step, and its state, which is out of range, would go on to act.
//! So it takes part in nothing, the rest of the run is that of a removal to the last bit, and what
//! it carried is booked in the same way. What is left of it in files is where it was and of what,
//! the fields that are [`FieldInfo::kept`]. All else of it, velocity and stress among it, is zero.

use super::candidate::Criteria;
use crate::diagnose::{Leave, Moved, Removed, RunState};
use crate::loads::Loads;
use crate::sph::SignalSpeed;
use comm::Comm;
use model::Region;
use numerics::collector::Collector;
use numerics::exact_sum::{ExactSum, gather_limbs, scatter_limbs};
use numerics::vector::cross;
use particles::{FieldInfo, GRAIN, Owner, ParticleStore};

/// Particles that this rank has frozen: they are in files, and in nothing else.
#[derive(Debug, Default)]
pub(super) struct Frozen(ParticleStore);

impl Frozen {
    /// None, in a store like that of a case.
    pub(super) fn like(particles: &ParticleStore) -> Self {
        Self(particles.clone())
    }

    /// How many there are.
    pub(super) fn count(&self) -> usize {
        self.0.owned()
    }

    pub(super) fn memory(&self) -> usize {
        self.0.memory()
    }

    /// Keeps the owned particles `indices` for the files.
    pub(super) fn freeze(&mut self, particles: &ParticleStore, indices: &[u32]) {
        let mut remains = Vec::new();
        particles.pack(FieldInfo::is_kept, indices, &mut remains);
        let (frozen, count) = (&mut self.0, indices.len());
        let first = frozen.owned();
        frozen.resize_owned(first + count);
        frozen.unpack(FieldInfo::is_kept, first, count, &remains);
        for mark in &mut frozen.frozen[first..] {
            *mark = 1;
        }
    }

    /// Parts frozen particles from those that a checkpoint holds with them, whatever becomes of the
    /// next ones, gives up the fields `unused` and sizes all others. Collective.
    pub(super) fn part(comm: &Comm, particles: &mut ParticleStore, unused: Owner) -> Self {
        let marks = (0_u32..).zip(&particles.frozen);
        let mut leaving: Vec<u32> = marks
            .filter(|&(_, &frozen)| frozen != 0)
            .map(|(i, _)| i)
            .collect();
        let any = comm.any(!leaving.is_empty());
        let unused = if any { unused - Owner::FREEZE } else { unused };
        particles.drop_fields(unused);
        particles.resize_owned(particles.owned());
        let mut frozen = Self::default();
        frozen.0.drop_fields(unused);
        frozen.freeze(particles, &leaving);
        particles.remove(&mut leaving, &mut Vec::new());
        frozen
    }

    /// Appends them to owned particles, in place of the halo.
    pub(super) fn append_to(&self, particles: &mut ParticleStore) {
        if self.count() > 0 {
            particles.append(&self.0);
        }
    }

    /// Takes back what [`Self::append_to`] appended.
    pub(super) fn take_from(&self, particles: &mut ParticleStore) {
        if self.count() > 0 {
            particles.resize_owned(particles.owned() - self.count());
        }
    }
}

/// Owned particles whose state is out of range.
pub(super) fn failed<F: SignalSpeed>(
    particles: &ParticleStore,
    loads: &Loads,
    criteria: &Criteria<F>,
) -> Vec<u32> {
    let has_failed = |&i: &usize| {
        if loads.has_motions() && loads.is_rigid(particles.load[i]) {
            return false;
        }
        let contact = particles.contact_acceleration.get(i);
        let moved = Moved {
            velocity: particles.velocity[i],
            energy: particles.specific_energy[i],
            contact: contact.copied().unwrap_or_default(),
        };
        criteria.failure(i, &moved).is_some()
    };
    // Looked for where a step cannot be chosen: not in every step.
    let failed = (0..particles.owned()).filter(has_failed);
    failed
        .map(|i| u32::try_from(i).unwrap_or(u32::MAX))
        .collect()
}

/// Puts the owned particles that have left a region into `leaving`; what is part of a rigid body stays
/// wherever it goes.
pub(super) fn find_departed(
    particles: &ParticleStore,
    loads: &Loads,
    keep: &Region,
    (leaving, collector): (&mut Vec<u32>, &mut Collector),
) {
    let goes = |i: &usize| {
        let bits = particles.load.get(*i);
        keep.is_left_by(&particles.position[*i]) && !bits.is_some_and(|&bits| loads.is_rigid(bits))
    };
    leaving.clear();
    collector.extend(leaving, (particles.owned(), GRAIN), |i| {
        Some(i)
            .filter(goes)
            .map(|i| u32::try_from(i).unwrap_or(u32::MAX))
    });
}

/// What particle `i` takes with it, under gravity (m/s²): mass, momentum, kinetic and internal energy,
/// that of gravity, and angular momentum.
fn terms(particles: &ParticleStore, i: usize, g: &[f64; 3]) -> [f64; 10] {
    let (m, v, x) = (
        particles.mass[i],
        &particles.velocity[i],
        &particles.position[i],
    );
    let turn = cross(x, v);
    [
        m,
        m * v[0],
        m * v[1],
        m * v[2],
        0.5 * m * (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]),
        particles.thermal_mass(i) * particles.specific_energy[i],
        -m * (g[0] * x[0] + g[1] * x[1] + g[2] * x[2]),
        m * turn[0],
        m * turn[1],
        m * turn[2],
    ]
}

/// Books what the owned particles `leaving` take with them, of so many bodies, and why. Collective.
pub(super) fn book(
    comm: &Comm,
    (state, why): (&mut RunState, Leave),
    (particles, bodies): (&ParticleStore, usize),
    loads: &Loads,
    leaving: &[u32],
) {
    let mut sums: Vec<[ExactSum; 10]> = (0..bodies).map(|_| Default::default()).collect();
    let mut counts = vec![0_u64; bodies];
    for &i in leaving {
        let i = i as usize;
        let body = particles.body[i] as usize;
        counts[body] += 1;
        let terms = terms(particles, i, &loads.gravity);
        for (sum, term) in sums[body].iter_mut().zip(terms) {
            sum.add(term);
        }
    }
    let mut limbs = Vec::new();
    gather_limbs(sums.iter_mut().flatten(), &mut limbs);
    comm.sum_i64(&mut limbs);
    scatter_limbs(sums.iter_mut().flatten(), &limbs);
    comm.sum_u64(&mut counts);
    let time = state.time;
    let (ledgers, _) = state.leaving(why);
    ledgers.resize(bodies, Removed::default());
    for ((booked, sums), count) in ledgers.iter_mut().zip(&sums).zip(counts) {
        if count == 0 {
            continue;
        }
        let values: [f64; 10] = std::array::from_fn(|k| sums[k].value());
        let [mass, x, y, z, kinetic, internal, gravity, turn @ ..] = values;
        booked.particles += count;
        booked.mass += mass;
        for (total, part) in booked.momentum.iter_mut().zip([x, y, z]) {
            *total += part;
        }
        for (total, part) in booked.angular_momentum.iter_mut().zip(turn) {
            *total += part;
        }
        booked.kinetic_energy += kinetic;
        booked.internal_energy += internal;
        booked.gravity_energy += gravity;
        booked.mass_time += mass * time;
        let [first, _] = booked.times.unwrap_or([time; 2]);
        booked.times = Some([first, time]);
    }
}
