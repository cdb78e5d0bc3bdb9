//! What a step adds up over all particles and ranks: exact sums, counts and extremes.

use rayon::prelude::*;

use super::contact_sums::{ContactSums, Meetings, least, pair_key};
use super::search::GRAIN;
use super::simulation::Simulation;
use super::span::Span;
use super::state::{Closest, NearestPair, PairExtremes, Totals};
use super::trouble::Removed;
use crate::comm::Comm;
use crate::contact::ContactTable;
use crate::model::SphForm;
use crate::numerics::exact_sum::ExactSum;
use crate::particles::ParticleStore;

/// Sums of one step, first of this rank, then (after [`StepSums::reduce`]) of all.
pub struct StepSums {
    /// How long a particle may be enclosed before it counts as interpenetrated (s).
    pub(super) enclosed_limit: f64,
    pub(super) contact_work: ExactSum,
    pub(super) crossing_impulse: [ExactSum; 3],
    /// Particles that crossed a symmetry plane in this step.
    pub(super) crossings: i64,
    /// What contact adds up.
    pub(super) contact: ContactSums,
    /// The same by thread, until they are joined.
    pub(super) parts: Vec<ContactSums>,
    pub(super) meetings: Meetings,
    /// The case's pairs of bodies with contact, in the order of [`super::RunState::pairs`].
    pair_keys: Vec<usize>,
    /// Whether there is friction or damping between bodies, whose heat is summed.
    friction: bool,
    /// Impulse and work of prescribed velocities and of rigid bodies in this step.
    pub(super) loads: Vec<[ExactSum; 4]>,
    /// Force of each rigid surface, and its torque about the axis that it turns about.
    pub(super) pushes: Vec<[ExactSum; 4]>,
    /// Heat of each, if they have friction or damping.
    pub(super) push_heat: Vec<ExactSum>,
    /// Particles whose gradient has no correction, in the normalised form.
    pub(super) uncorrected: i64,
    /// Where all particles are and how they move, after the step.
    pub(super) span: Span,
    limbs: Vec<i64>,
    words: Vec<u64>,
}

impl StepSums {
    pub(super) fn new(
        contact: &ContactTable,
        enclosed_limit: f64,
        loads: usize,
        [surfaces, resisting]: [usize; 2],
    ) -> Self {
        let bodies = contact.foreign.bodies;
        let pairs = contact.active_pairs().into_iter();
        Self {
            pair_keys: pairs.map(|[a, b]| pair_key(bodies, a, b)).collect(),
            friction: contact.has_friction(),
            meetings: Meetings::default(),
            enclosed_limit,
            contact_work: ExactSum::default(),
            crossing_impulse: Default::default(),
            crossings: 0,
            parts: vec![ContactSums::default(); rayon::current_num_threads()],
            contact: ContactSums::default(),
            loads: (0..loads).map(|_| Default::default()).collect(),
            pushes: (0..surfaces).map(|_| Default::default()).collect(),
            push_heat: vec![ExactSum::default(); resisting],
            uncorrected: 0,
            span: Span::NONE,
            limbs: Vec::new(),
            words: Vec::new(),
        }
    }

    pub(super) fn memory(&self) -> usize {
        let parts = self.parts.iter().map(ContactSums::memory).sum::<usize>();
        self.contact.memory()
            + parts
            + self.meetings.memory()
            + size_of::<usize>() * self.pair_keys.capacity()
            + 4 * size_of::<ExactSum>() * (self.loads.capacity() + self.pushes.capacity())
            + size_of::<ExactSum>() * self.push_heat.capacity()
            + 8 * (self.limbs.capacity() + self.words.capacity())
    }

    /// Forgets what belongs to the last positions; work and impulses of the step stay.
    pub(super) fn clear_rates(&mut self) {
        self.contact.clear();
        self.pushes.fill_with(Default::default);
        self.push_heat.fill_with(ExactSum::default);
    }

    /// Books impulse (N s) along `axis` and work (J) of a load.
    pub(super) fn add_load(&mut self, load: usize, axis: usize, impulse: f64, work: f64) {
        self.loads[load][axis].add(impulse);
        self.loads[load][3].add(work);
    }

    /// Books the force (N) and torque (N m) that a rigid surface exerts on a particle.
    pub(super) fn add_push(&mut self, surface: usize, force: &[f64; 3], torque: f64) {
        let push = &mut self.pushes[surface];
        for a in 0..3 {
            push[a].add(force[a]);
        }
        push[3].add(torque);
    }

    fn exact(&mut self) -> impl Iterator<Item = &mut ExactSum> {
        [&mut self.contact_work]
            .into_iter()
            .chain(&mut self.crossing_impulse)
            .chain(self.loads.iter_mut().flatten())
            .chain(self.pushes.iter_mut().flatten())
            .chain(&mut self.push_heat)
            .chain([&mut self.contact.energy])
            .chain(&mut self.contact.plane_force)
    }

    /// Joins the sums of all ranks.
    fn reduce(&mut self, comm: &Comm) {
        let news = self.meetings.news(&self.contact.pairs);
        if comm.size() == 1 {
            if news > 0 {
                let (friction, book) = (self.friction, &mut self.contact.pairs);
                self.meetings.admit(comm, book, friction);
            }
            self.meetings.note(&self.contact.pairs);
            return;
        }
        let mut limbs = std::mem::take(&mut self.limbs);
        limbs.clear();
        gather_limbs(self.exact(), &mut limbs);
        limbs.extend([self.uncorrected, self.crossings]);
        limbs.extend([
            self.contact.interpenetrated,
            i64::try_from(news).unwrap_or(1),
        ]);
        let (friction, book) = (self.friction, &mut self.contact.pairs);
        self.meetings.gather(book, friction, &mut limbs);
        comm.sum_i64(&mut limbs);
        let rest = scatter_limbs(self.exact(), &limbs);
        let (counts, rest) = rest.split_at(4);
        [self.uncorrected, self.crossings] = [counts[0], counts[1]];
        self.contact.interpenetrated = counts[2];
        let book = &mut self.contact.pairs;
        self.meetings.scatter(book, friction, rest);
        if counts[3] > 0 {
            self.meetings.admit(comm, book, friction);
        }
        self.meetings.note(book);
        self.limbs = limbs;
        self.reduce_extremes(comm);
    }

    /// Words whose smallest over the ranks are all ranks' extremes: positive doubles order as their
    /// bits do, and a largest value is the smallest complement.
    fn reduce_extremes(&mut self, comm: &Comm) {
        let contact = &mut self.contact;
        self.words.clear();
        self.words.extend([
            contact.closest.map_or(u64::MAX, f64::to_bits),
            !contact.foreign_fraction.to_bits(),
        ]);
        self.span.write(&mut self.words);
        comm.min_u64(&mut self.words);
        let [closest, fraction] = [self.words[0], !self.words[1]];
        contact.closest = (closest != u64::MAX).then(|| f64::from_bits(closest));
        contact.foreign_fraction = f64::from_bits(fraction);
        self.span = Span::read(&self.words[2..]);
    }
}

pub(super) fn gather_limbs<'a>(sums: impl Iterator<Item = &'a mut ExactSum>, limbs: &mut Vec<i64>) {
    for sum in sums {
        sum.normalise();
        limbs.extend_from_slice(sum.limbs());
    }
}

/// Gives the sums their limbs back; returns what is left of `limbs`.
pub(super) fn scatter_limbs<'a, 'b>(
    sums: impl Iterator<Item = &'a mut ExactSum>,
    mut limbs: &'b [i64],
) -> &'b [i64] {
    for sum in sums {
        let (own, rest) = limbs.split_at(sum.limbs().len());
        sum.limbs_mut().copy_from_slice(own);
        limbs = rest;
    }
    limbs
}

impl Simulation {
    /// Impulse of symmetry planes and rigid surfaces in the first half of a step.
    pub(super) fn book_plane_force(&mut self, dt: f64) {
        self.book_pushes(dt, true);
        for a in 0..3 {
            self.state.plane_impulse[a] += 0.5 * dt * self.state.plane_force[a];
        }
        for pair in &mut self.state.pairs {
            for a in 0..3 {
                pair.impulse[a] += 0.5 * dt * pair.force[a];
            }
            pair.heat += 0.5 * dt * pair.heat_power;
        }
    }

    /// Joins the sums of all ranks into the state, after the second half of a step `dt` (s).
    pub(super) fn book_step(&mut self, comm: &Comm, dt: f64) {
        let mirrors = !self.halo.mirrors().is_empty();
        let corrects = self.case.sph.form != SphForm::Conventional;
        if self.contact.is_active() || mirrors || self.loads.drives() || corrects {
            self.sums.reduce(comm);
        }
        self.book_load_sums(dt);
        let (sums, state) = (&mut self.sums, &mut self.state);
        state.contact_energy = sums.contact.energy.value();
        state.contact_work += sums.contact_work.value();
        sums.contact_work = ExactSum::default();
        for a in 0..3 {
            state.plane_force[a] = sums.contact.plane_force[a].value();
            state.plane_impulse[a] +=
                0.5 * dt * state.plane_force[a] + sums.crossing_impulse[a].value();
            sums.crossing_impulse[a] = ExactSum::default();
        }
        state.plane_crossings += std::mem::take(&mut sums.crossings);
        for (pair, &key) in state.pairs.iter_mut().zip(&sums.pair_keys) {
            pair.book(sums.contact.pairs.get(key), dt);
        }
        let contact = &sums.contact;
        state.interpenetrated = state.interpenetrated.max(contact.interpenetrated);
        state.uncorrected = sums.uncorrected;
        let worst = &mut state.worst;
        worst.interpenetrated = worst.interpenetrated.max(contact.interpenetrated);
        worst.uncorrected = worst.uncorrected.max(sums.uncorrected);
        worst.foreign_fraction = worst.foreign_fraction.max(contact.foreign_fraction);
        worst.closest = least(worst.closest, contact.closest);
        self.book_defect();
    }

    /// Joins what the pairs of bodies have come to since the last time on all ranks into the state:
    /// before rows and checkpoints. Collective.
    pub fn join_extremes(&mut self, comm: &Comm) {
        let (sums, bodies) = (&mut self.sums, self.case.bodies.len());
        for (key, extremes) in sums.meetings.join(comm) {
            let Ok(at) = sums.pair_keys.binary_search(&key) else {
                continue;
            };
            self.state.pairs[at].extremes.join(&extremes);
            let Some(Closest {
                distance,
                particles,
            }) = extremes.closest
            else {
                continue;
            };
            let nearest = NearestPair {
                distance,
                bodies: [key / bodies, key % bodies],
                particles,
            };
            let worst = &mut self.state.worst.nearest;
            *worst = Some(worst.map_or(nearest, |worst| worst.min(nearest)));
        }
    }

    /// Begins the next interval between rows of tables: extremes are of what comes from now on.
    pub fn begin_interval(&mut self) {
        self.state.interpenetrated = 0;
        for pair in &mut self.state.pairs {
            pair.extremes = PairExtremes::default();
        }
    }

    /// The contact defect, after the sums of a step.
    pub(super) fn book_defect(&mut self) {
        let state = &mut self.state;
        let heat = state.contact_heat();
        let worst = &mut state.worst;
        let defect = state.contact_work + state.removed_contact_energy + state.contact_energy
            - state.initial.contact_energy
            + heat;
        worst.contact_deviation = worst.contact_deviation.max(defect.abs());
        let scale = state.initial.kinetic_energy.max(state.work_put_in);
        if scale > 0.0 {
            worst.contact_defect = worst.contact_deviation / scale;
        }
    }

    /// Sums over all particles, into the state, with the errors that follow from them, and the
    /// extremes since the last row. Collective.
    pub fn diagnose(&mut self, comm: &Comm) {
        self.join_extremes(comm);
        let totals = self.totals(comm);
        let gravity = self.loads.gravity;
        let state = &mut self.state;
        state.totals = totals;
        let (work, impulse) = (state.load_work(), state.load_impulse());
        let fallen = totals.gravity_energy - state.initial.gravity_energy;
        state.work_put_in = state.work_put_in.max(work.abs()).max(fallen.abs());
        let removed = state.removed_energy();
        let worst = &mut state.worst;
        let error = totals.energy() + removed - state.initial.energy() - work;
        worst.energy_deviation = worst.energy_deviation.max(error.abs());
        let scale = state.initial.kinetic_energy.max(state.work_put_in);
        if scale > 0.0 {
            worst.energy_error = worst.energy_deviation / scale;
            worst.contact_defect = worst.contact_deviation / scale;
        }
        for a in 0..3 {
            let removed = |part: fn(&Removed) -> f64| state.removed.iter().map(part).sum::<f64>();
            let mass_time = totals.mass * state.time + removed(|r| r.mass_time);
            let falling = mass_time * gravity[a];
            let outside = impulse[a] + falling;
            let taken: f64 = state.removed.iter().map(|r| r.momentum[a]).sum();
            let gained = totals.momentum[a] + taken - state.initial.momentum[a];
            let error = gained - state.plane_impulse[a] - outside;
            worst.momentum_deviation[a] = worst.momentum_deviation[a].max(error.abs());
            for put in [impulse[a], falling] {
                state.momentum_put_in = state.momentum_put_in.max(put.abs());
            }
        }
        let scale = state.initial.momentum_scale.max(state.momentum_put_in);
        if scale > 0.0 {
            worst.momentum_error = worst.momentum_deviation.map(|error| error / scale);
        }
    }

    pub(super) fn totals(&self, comm: &Comm) -> Totals {
        let (store, loads) = (&self.store, &self.loads);
        let owned = store.owned();
        let mut sums = (0..owned.div_ceil(GRAIN))
            .into_par_iter()
            // same bits in any order: exact sums are integers
            .fold(TotalSums::default, |mut sums, chunk| {
                for i in chunk * GRAIN..((chunk + 1) * GRAIN).min(owned) {
                    if loads.drives() && loads.is_rigid(store.load[i]) {
                        continue;
                    }
                    sums.add(store, i, &loads.gravity);
                }
                sums
            })
            // same bits in any order, as above
            .reduce(TotalSums::default, TotalSums::merge)
            .0;
        let mut limbs = Vec::new();
        gather_limbs(sums.iter_mut(), &mut limbs);
        comm.sum_i64(&mut limbs);
        scatter_limbs(sums.iter_mut(), &limbs);
        let [kinetic, internal, gravity, mass, x, y, z, scale] = sums.map(|sum| sum.value());
        Totals {
            kinetic_energy: kinetic,
            internal_energy: internal,
            contact_energy: self.state.contact_energy,
            gravity_energy: gravity,
            mass,
            momentum: [x, y, z],
            momentum_scale: scale,
        }
    }
}

/// Kinetic, internal and gravity's energy, mass, momentum, and the sum of its magnitudes.
#[derive(Default)]
struct TotalSums([ExactSum; 8]);

impl TotalSums {
    fn add(&mut self, store: &ParticleStore, i: usize, gravity: &[f64; 3]) {
        let (m, v, x) = (store.mass[i], &store.velocity[i], &store.position[i]);
        let height = -(gravity[0] * x[0] + gravity[1] * x[1] + gravity[2] * x[2]);
        let v2 = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
        let terms = [
            0.5 * m * v2,
            store.thermal_mass(i) * store.specific_energy[i],
            m * height,
            m,
            m * v[0],
            m * v[1],
            m * v[2],
            m * v2.sqrt(),
        ];
        for (sum, term) in self.0.iter_mut().zip(terms) {
            sum.add(term);
        }
    }

    #[allow(clippy::needless_pass_by_value, reason = "the form of a reduction")]
    fn merge(mut self, other: Self) -> Self {
        for (sum, other) in self.0.iter_mut().zip(&other.0) {
            sum.merge(other);
        }
        self
    }
}
