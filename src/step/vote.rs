//! The next time step: the smallest vote of all particles on all ranks.
//!
//! A vote is (Δt, reason, id), compared in that order, so that ties agree on any ranks.

use rayon::prelude::*;

use super::loads::LoadStep;
use super::search::GRAIN;
use super::simulation::{Simulation, StepError};
use super::state::Reason;
use super::trouble::{Limits, PAST_VOTES, PastVote, TroubleKind};
use crate::comm::Comm;
use crate::model::Case;
use crate::particles::ParticleStore;

/// Largest coordinate that still counts as a position (m).
const FARTHEST: f64 = 1e12;

/// How much corrections enlarge gradients at surfaces of lattices, which steps need not heed.
const SURFACE_CORRECTION: f64 = 2.0;

/// A vote: bits of Δt (s; positive doubles order as their bits), reason, id.
type Vote = (u64, u64, u64);

const ABSTAIN: Vote = (u64::MAX, 0, 0);
/// Reads as an error: no positive Δt has these bits.
const ERROR: u64 = 0;

impl Simulation {
    /// Chooses the next Δt. Collective.
    pub(super) fn vote(&mut self, comm: &Comm) -> Result<(), StepError> {
        let mut words = std::mem::take(&mut self.scratch);
        let (dt, reason, id) = self.local_vote();
        comm.all_gather_u64(&[dt, reason, id, self.wishes], &mut words);
        self.agreed_wishes = words
            .iter()
            .skip(3)
            .step_by(4)
            .fold(0, |all, one| all | one);
        let best = words
            .chunks_exact(4)
            .map(|word| (word[0], word[1], word[2]))
            .min()
            .unwrap_or(ABSTAIN);
        self.scratch = words;
        if best.0 == ERROR {
            return Err(self.trouble(comm, best.1, best.2));
        }
        self.state.dt = f64::from_bits(best.0);
        self.state.dt_reason = Reason::ALL[usize::try_from(best.1)
            .unwrap_or(0)
            .min(Reason::ALL.len() - 1)];
        if best.0 == ABSTAIN.0 {
            self.state.dt = f64::INFINITY;
        }
        if self.case.time_step.max < self.state.dt {
            self.state.dt = self.case.time_step.max;
            self.state.dt_reason = Reason::Maximum;
        }
        if self.votes.len() == PAST_VOTES {
            self.votes.pop_front();
        }
        self.votes.push_back(PastVote {
            step: self.state.step,
            dt: self.state.dt,
            reason: self.state.dt_reason.name(),
            id: best.2,
        });
        let contact = self.state.dt_reason == Reason::Contact;
        self.state.worst.contact_limited_steps += u64::from(contact);
        Ok(())
    }

    /// The step to do now and what limits it: the vote, unless the case ends before.
    pub(super) fn next_step(&self) -> (f64, Reason) {
        let left = self.case.run.end_time - self.state.time;
        if left <= self.state.dt {
            (left, Reason::End)
        } else {
            (self.state.dt, self.state.dt_reason)
        }
    }

    fn voter(&self) -> Voter<'_> {
        Voter {
            store: &self.store,
            case: &self.case,
            contact: self.contact.is_active(),
            loads: &self.loads,
            limits: &self.limits,
        }
    }

    /// What is wrong with a particle of this rank, if anything is.
    pub(super) fn trouble_of(&self, i: usize) -> Option<TroubleKind> {
        let (dt, kind, _) = self.voter().vote(i);
        (dt == ERROR).then(|| kind_of(kind))
    }

    fn local_vote(&self) -> Vote {
        let owned = self.store.owned();
        let voter = self.voter();
        (0..owned.div_ceil(GRAIN))
            .into_par_iter()
            .map(|chunk| {
                (chunk * GRAIN..((chunk + 1) * GRAIN).min(owned))
                    .map(|i| voter.vote(i))
                    .min()
                    .unwrap_or(ABSTAIN)
            })
            .min()
            .unwrap_or(ABSTAIN)
    }

    /// Describes the particle `id`, wherever it is; the same text on all ranks.
    fn trouble(&self, comm: &Comm, kind: u64, id: u64) -> StepError {
        let store = &self.store;
        let found = store.id[..store.owned()].iter().position(|&x| x == id);
        let describe = |i| describe(store, &self.case, i, comm.rank()).into_bytes();
        let mine = found.map_or_else(Vec::new, describe);
        let mut owner = [if mine.is_empty() {
            u64::MAX
        } else {
            comm.rank() as u64
        }];
        comm.min_u64(&mut owner);
        let mut text = mine;
        comm.broadcast_from(usize::try_from(owner[0]).unwrap_or(0), &mut text);
        let kind = kind_of(kind);
        StepError::Trouble {
            step: self.state.step,
            id,
            kind,
            what: kind.describe(&self.case.trouble),
            detail: String::from_utf8_lossy(&text).into_owned(),
        }
    }
}

fn kind_of(number: u64) -> TroubleKind {
    let last = TroubleKind::ALL.len() - 1;
    TroubleKind::ALL[usize::try_from(number).unwrap_or(0).min(last)]
}

/// What a particle's vote depends on.
struct Voter<'a> {
    store: &'a ParticleStore,
    case: &'a Case,
    contact: bool,
    loads: &'a LoadStep,
    limits: &'a Limits,
}

impl Voter<'_> {
    /// Sound and viscosity (Monaghan 1989) `C h / (c + 0.6 (α c + β |μ|))`, acceleration
    /// `C_f √(h/|a|)`, contact `2 f √(m/k)`; none by particles of rigid bodies. A correction that
    /// enlarges gradients more than those of plain surfaces do raises frequencies as much.
    fn vote(&self, i: usize) -> Vote {
        if self.loads.drives() && self.loads.is_rigid(self.store.load[i]) {
            return ABSTAIN;
        }
        let (store, case) = (self.store, self.case);
        let (h, c) = (store.smoothing_length[i], store.sound_speed[i]);
        let signal = c + 0.6 * (case.sph.alpha * c + case.sph.beta * store.approach_speed[i]);
        let correction = store.correction_norm.get(i).or(store.fit_norm.get(i));
        let correction = correction.copied().unwrap_or_default();
        let signal = signal * (correction / SURFACE_CORRECTION).max(1.0);
        let sound = case.time_step.courant * h / signal;
        let mut total = store.acceleration[i];
        for (total, gravity) in total.iter_mut().zip(self.loads.gravity) {
            *total += gravity;
        }
        if self.contact {
            for a in 0..3 {
                total[a] += store.contact_acceleration[i][a];
            }
        }
        let square = total[0] * total[0] + total[1] * total[1] + total[2] * total[2];
        let force = case.time_step.force * (h / square.sqrt()).sqrt();
        let contact = if self.contact {
            2.0 * case.time_step.contact * (store.mass[i] / store.contact_stiffness[i]).sqrt()
        } else {
            f64::INFINITY
        };
        let id = store.id[i];
        let sane = sound > 0.0
            && !force.is_nan()
            && store.density[i].is_finite()
            && store.specific_energy[i].is_finite()
            && store.velocity[i].iter().all(|v| v.is_finite())
            && store.position[i].iter().all(|x| x.abs() < FARTHEST);
        if !sane {
            return (ERROR, TroubleKind::NotFinite as u64, id);
        }
        if let Some(kind) = self.limits.check(store, i) {
            return (ERROR, kind as u64, id);
        }
        let (dt, reason) = [
            (sound, Reason::Sound),
            (force, Reason::Force),
            (contact, Reason::Contact),
        ]
        .into_iter()
        .reduce(|best, next| if next.0 < best.0 { next } else { best })
        .unwrap_or((f64::INFINITY, Reason::Sound));
        if dt < self.limits.step_min {
            return (ERROR, TroubleKind::Step as u64, id);
        }
        (dt.to_bits(), reason as u64, id)
    }
}

fn describe(store: &ParticleStore, case: &Case, i: usize, rank: usize) -> String {
    format!(
        "body `{}`, rank {rank}, position {:?} m, velocity {:?} m/s, density {} kg/m^3, \
         specific energy {} J/kg, pressure {} Pa, sound speed {} m/s; nearest particles {}",
        case.bodies[store.body[i] as usize].name,
        store.position[i],
        store.velocity[i],
        store.density[i],
        store.specific_energy[i],
        store.pressure[i],
        store.sound_speed[i],
        nearest(store, i),
    )
}

/// The particles nearest to particle `i` of those that this rank holds: id, body, distance.
fn nearest(store: &ParticleStore, i: usize) -> String {
    let here = store.position[i];
    let distance = |there: &[f64; 3]| {
        let square: f64 = (0..3)
            .map(|a| (here[a] - there[a]) * (here[a] - there[a]))
            .sum();
        square.sqrt()
    };
    let mut others: Vec<(f64, usize)> = store
        .position
        .iter()
        .enumerate()
        .filter(|&(k, _)| k != i)
        .map(|(k, there)| (distance(there), k))
        .filter(|(r, _)| r.is_finite())
        .collect();
    others.sort_by(|a, b| a.0.total_cmp(&b.0).then(store.id[a.1].cmp(&store.id[b.1])));
    let described: Vec<String> = others
        .iter()
        .take(3)
        .map(|&(r, k)| format!("{} of body {} at {r:.4e} m", store.id[k], store.body[k]))
        .collect();
    if described.is_empty() {
        "unknown".to_owned()
    } else {
        described.join(", ")
    }
}
