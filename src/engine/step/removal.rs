//! Particles whose state is out of range, or that have left the box of interest, are taken out of a run, and
//! everything that they carry is booked. Frozen ones are out of all sums like removed ones, and kept for the files.
//!
//! Were a particle to stay in the sums at rest, it would push others without being pushed: momentum
//! and energy would be lost in each step, and its state, which is out of range, would go on to act.
//! So it takes part in nothing, the rest of the run is that of a removal to the last bit, and its
//! momentum and energy are booked in the same way. Files have of it the place and the material, the fields that are
//! [`FieldInfo::kept`]. All else of it, velocity and stress among it, is zero.

use super::candidate::{Criteria, CriteriaInputs, criteria_fields};
use super::error::StepError;
use crate::diagnose::{Leave, Moved, Removed, RunState};
use crate::loads::Loads;
use crate::sph::{SignalSpeed, with_formulation};
use comm::Comm;
use model::{Region, SphForm};
use numerics::collector::Collector;
use numerics::exact_sum::{ExactSum, gather_limbs, scatter_limbs};
use numerics::vector::cross;
use particles::{FieldInfo, GRAIN, Owner, ParticleStore};

/// Steps between two searches for particles that have left the box of interest. They fly some spacings meanwhile, ten in
/// the fastest impacts, and the new sums after a removal take as long as a step.
const EVERY: u64 = 20;

/// Particles that are taken out of a run, and those that are frozen.
#[derive(Debug)]
pub(super) struct Removal {
    frozen: Frozen,
    /// Owned particles that are chosen to be taken out.
    leaving: Vec<u32>,
    collector: Collector,
}

/// The particles and the ledgers that a removal changes.
pub(super) struct RemovalInputs<'a> {
    pub particles: &'a mut ParticleStore,
    pub state: &'a mut RunState,
    pub loads: &'a Loads,
    /// Number of bodies.
    pub bodies: usize,
}

impl Leave {
    /// Why nothing is left, in words.
    fn of_all(self) -> &'static str {
        match self {
            Self::Failed => "all were out of range",
            Self::Departed => "the last ones have left the box of interest (domain.keep)",
        }
    }
}

impl Removal {
    /// Of no particles, with frozen ones in a store like that of a case.
    pub(super) fn new(particles: &ParticleStore) -> Self {
        Self {
            frozen: Frozen(particles.clone()),
            leaving: Vec::new(),
            collector: Collector::default(),
        }
    }

    /// Bytes allocated.
    pub(super) fn memory(&self) -> usize {
        self.frozen.0.memory() + 4 * self.leaving.capacity() + self.collector.memory()
    }

    /// Number of frozen particles.
    pub(super) fn frozen(&self) -> usize {
        self.frozen.count()
    }

    /// Separates frozen particles from those that a checkpoint holds with them, whatever becomes of the next ones;
    /// gives up the fields `unused` and sizes all others. Collective.
    pub(super) fn restore(&mut self, comm: &Comm, particles: &mut ParticleStore, unused: Owner) {
        self.frozen = Frozen::separate(comm, particles, unused);
    }

    /// Appends frozen particles to owned ones, in place of the halo.
    pub(super) fn append_frozen(&self, particles: &mut ParticleStore) {
        if self.frozen() > 0 {
            particles.append(&self.frozen.0);
        }
    }

    /// Takes back those that [`Self::append_frozen`] has appended.
    pub(super) fn drop_frozen(&self, particles: &mut ParticleStore) {
        if self.frozen() > 0 {
            particles.resize_owned(particles.owned() - self.frozen());
        }
    }

    /// Chooses the owned particles whose state is out of range.
    pub(super) fn choose_failed(
        &mut self,
        particles: &ParticleStore,
        loads: &Loads,
        form: SphForm,
        criteria: CriteriaInputs,
    ) {
        self.leaving = with_formulation!(form, Form => {
            let criteria = Criteria::<Form>::new(criteria_fields!(particles), criteria);
            failed(particles, loads, &criteria)
        });
    }

    /// Keeps the chosen particles for the files.
    pub(super) fn freeze(&mut self, particles: &ParticleStore) {
        self.frozen.freeze(particles, &self.leaving);
    }

    /// At every few steps chooses the owned particles that have left a region. Particles of rigid bodies stay wherever
    /// they go. Returns whether any rank has chosen some. Collective.
    pub(super) fn choose_departed(
        &mut self,
        comm: &Comm,
        particles: &ParticleStore,
        loads: &Loads,
        keep: &Region,
        step: u64,
    ) -> bool {
        if !step.is_multiple_of(EVERY) {
            return false;
        }
        let goes = |i: &usize| {
            let bits = particles.load.get(*i);
            keep.is_left_by(&particles.position[*i])
                && !bits.is_some_and(|&bits| loads.is_rigid(bits))
        };
        self.leaving.clear();
        let all = (particles.owned(), GRAIN);
        self.collector.extend(&mut self.leaving, all, |i| {
            Some(i)
                .filter(goes)
                .map(|i| u32::try_from(i).unwrap_or(u32::MAX))
        });
        comm.any(!self.leaving.is_empty())
    }

    /// The chosen particles.
    pub(super) fn leaving(&self) -> &[u32] {
        &self.leaving
    }

    /// Takes the chosen particles out of the store and books them. Returns their number on all ranks. Collective.
    ///
    /// # Errors
    /// The same on all ranks if no particle is left.
    pub(super) fn take_out(
        &mut self,
        comm: &Comm,
        why: Leave,
        mut inputs: RemovalInputs,
    ) -> Result<u64, StepError> {
        let mut count = [self.leaving.len() as u64, inputs.particles.owned() as u64];
        book(comm, why, &mut inputs, &self.leaving);
        let RemovalInputs {
            particles, state, ..
        } = inputs;
        particles.remove(&mut self.leaving, &mut Vec::new());
        comm.sum_u64(&mut count);
        if count[0] == count[1] {
            return Err(StepError::NothingLeft {
                step: state.step,
                why: why.of_all(),
            });
        }
        Ok(count[0])
    }
}

/// Particles that this rank has frozen: they are in files, and in nothing else.
#[derive(Debug, Default)]
struct Frozen(ParticleStore);

impl Frozen {
    /// Number of them.
    fn count(&self) -> usize {
        self.0.owned()
    }

    /// Keeps the owned particles `indices` for the files.
    fn freeze(&mut self, particles: &ParticleStore, indices: &[u32]) {
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

    /// See [`Removal::restore`].
    fn separate(comm: &Comm, particles: &mut ParticleStore, unused: Owner) -> Self {
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
}

/// Owned particles whose state is out of range.
fn failed<F: SignalSpeed>(
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

/// Sums that particle `i` takes with it, under gravity (m/s²): mass, momentum, kinetic and internal energy,
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

/// Books the sums that the owned particles `leaving` take with them. Collective.
fn book(comm: &Comm, why: Leave, inputs: &mut RemovalInputs, leaving: &[u32]) {
    let RemovalInputs {
        particles,
        state,
        loads,
        bodies,
    } = inputs;
    let bodies = *bodies;
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
