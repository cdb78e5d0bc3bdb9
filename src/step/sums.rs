//! What a step adds up over all particles and ranks: exact sums, counts and extremes.

use rayon::prelude::*;

use super::search::GRAIN;
use super::simulation::Simulation;
use super::state::{PairState, Totals};
use super::trouble::Removed;
use crate::comm::Comm;
use crate::contact::BodyReaction;
use crate::diagnose::exact_sum::ExactSum;
use crate::model::SphForm;
use crate::particles::ParticleStore;

/// Sums of one step, first of this rank, then (after [`StepSums::reduce`]) of all.
pub struct StepSums {
    /// How long a particle may be enclosed before it counts as interpenetrated (s).
    pub(super) enclosed_limit: f64,
    /// Whether there is friction or damping, whose heat is summed.
    friction: bool,
    pub(super) contact_work: ExactSum,
    pub(super) contact_energy: ExactSum,
    pub(super) crossing_impulse: [ExactSum; 3],
    plane_force: [ExactSum; 3],
    /// Impulse and work of prescribed velocities and of rigid bodies in this step.
    pub(super) loads: Vec<[ExactSum; 4]>,
    /// Force of each rigid surface, and its torque about the axis that it turns about.
    pub(super) pushes: Vec<[ExactSum; 4]>,
    pair_bodies: Vec<[usize; 2]>,
    pairs: Vec<PairSums>,
    interpenetrated: i64,
    /// Particles whose gradient has no correction, in the normalised form.
    pub(super) uncorrected: i64,
    closest: f64,
    foreign_fraction: f64,
    limbs: Vec<i64>,
    extremes: Vec<u64>,
}

struct PairSums {
    force: [ExactSum; 3],
    energy: ExactSum,
    heat: ExactSum,
    touching: i64,
    largest_excess: f64,
    closest: f64,
    contact_dt: f64,
}

impl Default for PairSums {
    fn default() -> Self {
        Self {
            force: Default::default(),
            energy: ExactSum::default(),
            heat: ExactSum::default(),
            touching: 0,
            largest_excess: 0.0,
            closest: f64::INFINITY,
            contact_dt: f64::INFINITY,
        }
    }
}

impl StepSums {
    pub(super) fn new(
        pair_bodies: Vec<[usize; 2]>,
        enclosed_limit: f64,
        friction: bool,
        loads: usize,
        surfaces: usize,
    ) -> Self {
        Self {
            enclosed_limit,
            friction,
            contact_work: ExactSum::default(),
            contact_energy: ExactSum::default(),
            crossing_impulse: Default::default(),
            plane_force: Default::default(),
            loads: (0..loads).map(|_| Default::default()).collect(),
            pushes: (0..surfaces).map(|_| Default::default()).collect(),
            pairs: pair_bodies.iter().map(|_| PairSums::default()).collect(),
            pair_bodies,
            interpenetrated: 0,
            uncorrected: 0,
            closest: f64::INFINITY,
            foreign_fraction: 0.0,
            limbs: Vec::new(),
            extremes: Vec::new(),
        }
    }

    pub(super) fn memory(&self) -> usize {
        size_of::<PairSums>() * self.pairs.capacity()
            + 4 * size_of::<ExactSum>() * (self.loads.capacity() + self.pushes.capacity())
            + 8 * (self.limbs.capacity() + self.extremes.capacity())
    }

    /// Forgets what belongs to the last positions; work and impulses of the step stay.
    pub(super) fn clear_rates(&mut self) {
        self.contact_energy = ExactSum::default();
        self.plane_force = Default::default();
        self.pushes.fill_with(Default::default);
        self.pairs.fill_with(PairSums::default);
        self.interpenetrated = 0;
        self.closest = f64::INFINITY;
        self.foreign_fraction = 0.0;
    }

    pub(super) fn add_plane_force(&mut self, force: &[f64; 3]) {
        for a in 0..3 {
            self.plane_force[a].add(force[a]);
        }
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

    pub(super) fn note_particle(&mut self, inside: bool, closest: f64, fraction: f64) {
        self.interpenetrated += i64::from(inside);
        self.closest = self.closest.min(closest);
        self.foreign_fraction = self.foreign_fraction.max(fraction);
    }

    /// Books what a body does to a particle of `body` with excess `excess` and contact step `dt`.
    pub(super) fn note_pair(&mut self, body: usize, reaction: &BodyReaction, excess: f64, dt: f64) {
        let bodies = [body.min(reaction.body), body.max(reaction.body)];
        let Some(index) = self.pair_bodies.iter().position(|&pair| pair == bodies) else {
            return;
        };
        let pair = &mut self.pairs[index];
        if body == bodies[0] {
            for a in 0..3 {
                pair.force[a].add(reaction.force[a]);
            }
        }
        pair.energy.add(reaction.energy);
        if self.friction {
            pair.heat.add(reaction.heat);
        }
        pair.touching += i64::from(excess > 0.0);
        pair.largest_excess = pair.largest_excess.max(excess);
        pair.closest = pair.closest.min(reaction.closest);
        pair.contact_dt = pair.contact_dt.min(dt);
    }

    fn exact(&mut self) -> impl Iterator<Item = &mut ExactSum> {
        let friction = self.friction;
        [&mut self.contact_work, &mut self.contact_energy]
            .into_iter()
            .chain(&mut self.crossing_impulse)
            .chain(&mut self.plane_force)
            .chain(self.loads.iter_mut().flatten())
            .chain(self.pushes.iter_mut().flatten())
            .chain(self.pairs.iter_mut().flat_map(move |pair| {
                let heat = friction.then_some(&mut pair.heat);
                pair.force.iter_mut().chain([&mut pair.energy]).chain(heat)
            }))
    }

    /// Joins the sums of all ranks.
    fn reduce(&mut self, comm: &Comm) {
        if comm.size() == 1 {
            return;
        }
        let mut limbs = std::mem::take(&mut self.limbs);
        limbs.clear();
        gather_limbs(self.exact(), &mut limbs);
        limbs.extend([self.interpenetrated, self.uncorrected]);
        limbs.extend(self.pairs.iter().map(|pair| pair.touching));
        comm.sum_i64(&mut limbs);
        let mut rest = scatter_limbs(self.exact(), &limbs).iter();
        let mut next = || rest.next().copied().unwrap_or(0);
        self.interpenetrated = next();
        self.uncorrected = next();
        for pair in &mut self.pairs {
            pair.touching = next();
        }
        self.limbs = limbs;
        self.reduce_extremes(comm);
    }

    /// Positive doubles order as their bits do, and a largest value is the smallest complement.
    fn reduce_extremes(&mut self, comm: &Comm) {
        let mut bits = std::mem::take(&mut self.extremes);
        bits.clear();
        bits.extend([self.closest.to_bits(), !self.foreign_fraction.to_bits()]);
        for pair in &self.pairs {
            bits.extend([
                pair.closest.to_bits(),
                pair.contact_dt.to_bits(),
                !pair.largest_excess.to_bits(),
            ]);
        }
        comm.min_u64(&mut bits);
        self.closest = f64::from_bits(bits[0]);
        self.foreign_fraction = f64::from_bits(!bits[1]);
        for (pair, bits) in self.pairs.iter_mut().zip(bits[2..].chunks_exact(3)) {
            pair.closest = f64::from_bits(bits[0]);
            pair.contact_dt = f64::from_bits(bits[1]);
            pair.largest_excess = f64::from_bits(!bits[2]);
        }
        self.extremes = bits;
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
        state.contact_energy = sums.contact_energy.value();
        state.contact_work += sums.contact_work.value();
        sums.contact_work = ExactSum::default();
        for a in 0..3 {
            state.plane_force[a] = sums.plane_force[a].value();
            state.plane_impulse[a] +=
                0.5 * dt * state.plane_force[a] + sums.crossing_impulse[a].value();
            sums.crossing_impulse[a] = ExactSum::default();
        }
        for (pair, sum) in state.pairs.iter_mut().zip(&sums.pairs) {
            let finite = |x: f64| x.is_finite().then_some(x);
            let force: [f64; 3] = std::array::from_fn(|a| sum.force[a].value());
            let heat_power = sum.heat.value();
            *pair = PairState {
                force,
                impulse: std::array::from_fn(|a| pair.impulse[a] + 0.5 * dt * force[a]),
                energy: sum.energy.value(),
                heat_power,
                heat: pair.heat + 0.5 * dt * heat_power,
                touching: sum.touching,
                largest_excess: sum.largest_excess,
                closest: finite(sum.closest),
                contact_dt: finite(sum.contact_dt),
            };
        }
        state.interpenetrated = sums.interpenetrated;
        state.uncorrected = sums.uncorrected;
        let worst = &mut state.worst;
        worst.interpenetrated = worst.interpenetrated.max(sums.interpenetrated);
        worst.uncorrected = worst.uncorrected.max(sums.uncorrected);
        worst.foreign_fraction = worst.foreign_fraction.max(sums.foreign_fraction);
        if sums.closest.is_finite() {
            let closest = worst.closest.map_or(sums.closest, |c| c.min(sums.closest));
            worst.closest = Some(closest);
        }
        self.book_defect();
    }

    /// The contact defect, after the sums of a step.
    pub(super) fn book_defect(&mut self) {
        let state = &mut self.state;
        let worst = &mut state.worst;
        let defect = state.contact_work + state.removed_contact_energy + state.contact_energy
            - state.initial.contact_energy
            + state.pairs.iter().map(|pair| pair.heat).sum::<f64>();
        worst.contact_deviation = worst.contact_deviation.max(defect.abs());
        let scale = state.initial.kinetic_energy.max(state.work_put_in);
        if scale > 0.0 {
            worst.contact_defect = worst.contact_deviation / scale;
        }
    }

    /// Sums over all particles, into the state, with the errors that follow from them.
    /// Collective.
    pub fn diagnose(&mut self, comm: &Comm) {
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
