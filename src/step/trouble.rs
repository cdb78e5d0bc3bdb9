//! Numerical trouble: who is in it, and taking particles out with all that they carry booked.
//!
//! The check is part of the vote, which the last kick of a step takes of each particle. What is no number
//! can be neither booked nor kept from its neighbours, so it always ends the run; what is out of
//! range but finite may be removed: the forces on the others are then summed anew where they stand,
//! as at the start of a case, and the run goes on from there.

use serde::{Deserialize, Serialize};

use super::gain;
use super::simulation::{Simulation, StepError};
use super::sums::{gather_limbs, scatter_limbs};
use super::vote::Moved;
use crate::comm::Comm;
use crate::model::readable::{short, shown};
use crate::model::{Case, Trouble, TroublePolicy};
use crate::numerics::exact_sum::ExactSum;
use crate::numerics::vector::square;

/// What is wrong with a particle, the worst first.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TroubleKind {
    /// A number is none.
    NotFinite,
    /// The density left its range.
    Density,
    /// The specific energy left its range.
    Energy,
    /// The speed left its range.
    Speed,
    /// It asks for a time step below the floor.
    Step,
    /// It is the fastest of a model whose kinetic energy has come from nowhere.
    Gain,
}

impl TroubleKind {
    /// What a particle may vote for, in the order of votes.
    pub const ALL: [Self; 5] = [
        Self::NotFinite,
        Self::Density,
        Self::Energy,
        Self::Speed,
        Self::Step,
    ];

    /// Whether taking particles out is no cure: what is no number has reached its neighbours, and
    /// energy that comes from nowhere is everybody's.
    #[must_use]
    pub fn is_of_all(self) -> bool {
        matches!(self, Self::NotFinite | Self::Gain)
    }

    /// What is wrong and which key says so.
    #[must_use]
    pub fn describe(self, limits: &Trouble) -> String {
        match self {
            Self::NotFinite => "has a non-finite or absurd state".to_owned(),
            Self::Density => format!(
                "has a density outside of {} to {} of that at the start \
                 (trouble.density_min, density_max)",
                short(limits.density_min),
                short(limits.density_max)
            ),
            Self::Energy => format!(
                "has a specific energy beyond {} (trouble.energy_max)",
                shown(limits.energy_max, "J/kg")
            ),
            Self::Speed => format!(
                "is faster than {} (trouble.speed_max)",
                shown(limits.speed_max, "m/s")
            ),
            Self::Step => format!(
                "asks for a time step below {} (trouble.step_min)",
                shown(limits.step_min, "s")
            ),
            Self::Gain => format!(
                "is the fastest where the kinetic energy of all is beyond {} times the energy that \
                 there was or has been put in: the sums are not stable, more viscosity (sph.alpha) or \
                 shorter steps (time_step) may help (trouble.gain_max)",
                short(limits.gain_max)
            ),
        }
    }
}

/// The ranges of a case, by body where they depend on it.
pub(super) struct Limits {
    speed2_max: f64,
    energy_max: f64,
    pub step_min: f64,
    /// Energy at the start that no sum shows (J).
    pub hidden_energy: f64,
    /// Smallest and largest density of each body (kg/m³).
    density: Vec<[f64; 2]>,
    /// Densities that are in range for all bodies (kg/m³).
    common_density: [f64; 2],
}

impl Limits {
    /// Of a case. Collective.
    pub(super) fn new(case: &Case, comm: &Comm) -> Self {
        let limits = &case.trouble;
        let range = |body| {
            let first = case.initial_density(body);
            [limits.density_min * first, limits.density_max * first]
        };
        let density: Vec<[f64; 2]> = case.bodies.iter().map(range).collect();
        let common = |[low, high]: [f64; 2], of: &[f64; 2]| [low.max(of[0]), high.min(of[1])];
        Self {
            speed2_max: limits.speed_max * limits.speed_max,
            energy_max: limits.energy_max,
            step_min: limits.step_min,
            hidden_energy: gain::hidden_energy(case, comm),
            common_density: density.iter().fold([f64::MIN, f64::MAX], common),
            density,
        }
    }

    /// Whether a particle's numbers are numbers and in range whatever its body is. Where it says
    /// no, [`Self::check`] knows.
    #[inline(always)]
    pub(super) fn surely_holds(&self, rho: f64, moved: &Moved) -> bool {
        let [lower, upper] = self.common_density;
        let heat = moved.energy.abs();
        let speed2 = square(&moved.velocity);
        let dense = (lower..=upper).contains(&rho);
        dense & (heat <= self.energy_max.min(f64::MAX)) & (speed2 <= self.speed2_max.min(f64::MAX))
    }

    /// What is out of range of a particle whose numbers are numbers.
    pub(super) fn check(&self, body: u32, rho: f64, moved: &Moved) -> Option<TroubleKind> {
        let [lower, upper] = self.density[body as usize];
        if rho < lower || rho > upper {
            Some(TroubleKind::Density)
        } else if moved.energy.abs() > self.energy_max {
            Some(TroubleKind::Energy)
        } else if square(&moved.velocity) > self.speed2_max {
            Some(TroubleKind::Speed)
        } else {
            None
        }
    }
}

/// What removed particles took with them, of one body.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Removed {
    /// How many.
    pub particles: u64,
    /// `Σ m` (kg).
    pub mass: f64,
    /// `Σ m v` (kg m/s).
    pub momentum: [f64; 3],
    /// `Σ ½ m v²` (J).
    pub kinetic_energy: f64,
    /// `Σ m e` (J).
    pub internal_energy: f64,
    /// `−Σ m g·x` (J).
    pub gravity_energy: f64,
    /// `Σ m t` with the time of removal (kg s): how long gravity has pulled.
    pub mass_time: f64,
}

impl Removed {
    /// All energy of the particles (J); that of contact is booked for the whole model.
    #[must_use]
    pub fn energy(&self) -> f64 {
        self.kinetic_energy + self.internal_energy + self.gravity_energy
    }
}

/// A step's vote, for post-mortems.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PastVote {
    /// Steps done.
    pub step: u64,
    /// Step chosen (s).
    pub dt: f64,
    /// What limits it.
    pub reason: &'static str,
    /// Who asks for it.
    pub id: u64,
}

/// Votes kept for post-mortems.
pub(super) const PAST_VOTES: usize = 16;

impl Simulation {
    /// Takes out all particles whose state is out of range, books them (and keeps them for the files
    /// if they are to be frozen), and sums the forces on the others anew. For a step that
    /// [`StepError::Trouble`] has ended and whose particles are all finite. Collective. Gives the number of particles taken out on all ranks.
    ///
    /// # Errors
    /// The same on all ranks if there is trouble again, or nothing left.
    pub fn remove_troubled(&mut self, comm: &Comm) -> Result<u64, StepError> {
        let mut leaving = std::mem::take(&mut self.order);
        leaving.clear();
        for i in 0..self.store.owned() {
            if self.trouble_of(i).is_some() {
                leaving.push(u32::try_from(i).unwrap_or(u32::MAX));
            }
        }
        let mut count = [leaving.len() as u64, self.store.owned() as u64];
        self.book_removal(comm, &leaving);
        if self.case.trouble.policy == TroublePolicy::Freeze {
            self.freeze(&leaving);
        }
        self.store.remove(&mut leaving, &mut Vec::new());
        self.order = leaving;
        comm.sum_u64(&mut count);
        if count[0] == count[1] {
            return Err(StepError::NothingLeft {
                step: self.state.step,
            });
        }
        let contact_energy = self.state.contact_energy;
        let owned = self.store.owned();
        let store = &mut self.store;
        store.predicted_velocity[..owned].copy_from_slice(&store.velocity[..owned]);
        store.predicted_density[..owned].copy_from_slice(&store.density[..owned]);
        self.loads
            .prepare(&self.case, self.state.time, self.state.time);
        self.evaluate(comm, 0.0);
        let vote = self.kick(0.0);
        self.removed_contact(comm, contact_energy);
        self.vote(comm, vote)?;
        Ok(count[0])
    }

    /// Sums of the remaining particles, and what contact has lost with the others.
    fn removed_contact(&mut self, comm: &Comm, before: f64) {
        // The sums of a step of no length have no work in them. Its defect is taken with what has
        // been lost, so the loss must be known first.
        let worst = self.state.worst;
        self.book_step(comm, 0.0);
        self.state.removed_contact_energy += before - self.state.contact_energy;
        self.state.worst = worst;
        self.book_defect();
    }

    fn book_removal(&mut self, comm: &Comm, leaving: &[u32]) {
        let (store, bodies) = (&self.store, self.case.bodies.len());
        let mut sums: Vec<[ExactSum; 7]> = (0..bodies).map(|_| Default::default()).collect();
        let mut counts = vec![0_u64; bodies];
        let g = self.loads.gravity;
        for &i in leaving {
            let i = i as usize;
            let (m, v, x) = (store.mass[i], &store.velocity[i], &store.position[i]);
            let body = store.body[i] as usize;
            counts[body] += 1;
            let terms = [
                m,
                m * v[0],
                m * v[1],
                m * v[2],
                0.5 * m * (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]),
                store.thermal_mass(i) * store.specific_energy[i],
                -m * (g[0] * x[0] + g[1] * x[1] + g[2] * x[2]),
            ];
            for (sum, term) in sums[body].iter_mut().zip(terms) {
                sum.add(term);
            }
        }
        let mut limbs = Vec::new();
        gather_limbs(sums.iter_mut().flatten(), &mut limbs);
        comm.sum_i64(&mut limbs);
        scatter_limbs(sums.iter_mut().flatten(), &limbs);
        comm.sum_u64(&mut counts);
        let time = self.state.time;
        self.state.removed.resize(bodies, Removed::default());
        for ((booked, sums), count) in self.state.removed.iter_mut().zip(&sums).zip(counts) {
            let [mass, x, y, z, kinetic, internal, gravity] =
                std::array::from_fn(|k| sums[k].value());
            booked.particles += count;
            booked.mass += mass;
            for (total, part) in booked.momentum.iter_mut().zip([x, y, z]) {
                *total += part;
            }
            booked.kinetic_energy += kinetic;
            booked.internal_energy += internal;
            booked.gravity_energy += gravity;
            booked.mass_time += mass * time;
        }
    }
}
