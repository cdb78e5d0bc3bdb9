//! The next time step: the smallest vote of all particles on all ranks.
//!
//! A vote is (Δt, reason, id), compared in that order, so that ties agree on any ranks.

use super::simulation::{Simulation, StepError};
use super::state::Reason;
use super::trouble::{Limits, PAST_VOTES, PastVote, TroubleKind};
use crate::comm::Comm;
use crate::model::Case;
use crate::model::readable::{shown, shown_vector};
use crate::numerics::vector::square;
use crate::particles::ParticleStore;
use crate::sph::momentum::Viscosity;
use crate::sph::stress_points;

/// Largest coordinate that still counts as a position (m).
const FARTHEST: f64 = 1e12;

/// How much corrections enlarge gradients at surfaces of lattices, which steps need not heed.
const SURFACE_CORRECTION: f64 = 2.0;

/// A vote: bits of Δt (s; positive doubles order as their bits), reason, id.
pub(super) type Vote = (u64, u64, u64);

pub(super) const ABSTAIN: Vote = (u64::MAX, 0, 0);
/// Reads as an error: no positive Δt has these bits.
const ERROR: u64 = 0;

impl Simulation {
    /// Chooses the next Δt, given this rank's vote. Collective.
    pub(super) fn vote(&mut self, comm: &Comm, own: Vote) -> Result<(), StepError> {
        let mut words = std::mem::take(&mut self.scratch);
        let (dt, reason, id) = own;
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
            return Err(self.trouble(comm, kind_of(best.1), best.2));
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
        let flight = self.longest_flight(comm, self.state.dt);
        if flight < self.state.dt {
            self.state.dt = flight;
            self.state.dt_reason = Reason::Flight;
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

    pub(super) fn voter(&self) -> Voter<'_> {
        Voter {
            store: &self.store,
            case: &self.case,
            contact: self.contact.is_active(),
            gravity: self.loads.gravity,
            limits: &self.limits,
        }
    }

    /// What is wrong with a particle of this rank, if anything is.
    pub(super) fn trouble_of(&self, i: usize) -> Option<TroubleKind> {
        let store = &self.store;
        if self.loads.drives() && self.loads.is_rigid(store.load[i]) {
            return None;
        }
        let moved = Moved {
            velocity: store.velocity[i],
            energy: store.specific_energy[i],
            contact: store
                .contact_acceleration
                .get(i)
                .copied()
                .unwrap_or_default(),
        };
        let (dt, kind, _) = self.voter().vote(i, &moved);
        (dt == ERROR).then(|| kind_of(kind))
    }

    /// Describes the particle `id`, wherever it is; the same text on all ranks.
    pub(super) fn trouble(&self, comm: &Comm, kind: TroubleKind, id: u64) -> StepError {
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

/// What a kick has at hand of a particle: velocity (m/s), specific energy (J/kg), acceleration by
/// contact (m/s²).
pub(super) struct Moved {
    pub velocity: [f64; 3],
    pub energy: f64,
    pub contact: [f64; 3],
}

/// The smallest vote so far, and what tells without roots and divisions that a particle neither
/// undercuts it nor is in trouble.
pub(super) struct Ballot {
    best: Vote,
    /// Steps beyond this one (s) do not matter, with room for rounding.
    step: f64,
    /// Its square and its fourth power, infinite where they cannot tell.
    step2: f64,
    step4: f64,
    /// Smoothing length (m) and signal speed (m/s) of a best vote by sound: where all is at rest,
    /// all votes are this one, and the smallest id has it.
    by_sound: Option<[f64; 2]>,
}

impl Ballot {
    fn new(best: Vote, step_min: f64, by_sound: Option<[f64; 2]>) -> Self {
        let dt = match best {
            ABSTAIN => f64::INFINITY,
            (bits, ..) => f64::from_bits(bits),
        };
        let step = dt.max(step_min) * (1.0 + 1e-9);
        let step2 = step * step;
        let step4 = step2 * step2;
        let tells = step == 0.0 || step4 >= f64::MIN_POSITIVE;
        let [step2, step4] = [step2, step4].map(|power| if tells { power } else { f64::INFINITY });
        Self {
            best,
            step,
            step2,
            step4,
            by_sound,
        }
    }

    /// Whether a vote by sound is the best one too.
    #[inline(always)]
    fn is_matched(&self, h: f64, signal: f64) -> bool {
        self.by_sound == Some([h, signal])
    }

    pub(super) fn vote(&self) -> Vote {
        self.best
    }

    /// The one with the smaller vote.
    pub(super) fn min(self, other: Self) -> Self {
        if other.best < self.best { other } else { self }
    }
}

/// What a particle's vote depends on.
pub(super) struct Voter<'a> {
    store: &'a ParticleStore,
    case: &'a Case,
    contact: bool,
    gravity: [f64; 3],
    limits: &'a Limits,
}

impl Voter<'_> {
    /// Nobody has voted.
    pub(super) fn ballot(&self) -> Ballot {
        Ballot::new(ABSTAIN, self.limits.step_min, None)
    }

    /// Lets a particle vote.
    #[inline(always)]
    pub(super) fn ask(&self, i: usize, moved: &Moved, ballot: &mut Ballot) {
        if !self.is_beyond(i, moved, ballot) {
            let vote = self.vote(i, moved);
            if vote < ballot.best {
                let by_sound = vote.1 == Reason::Sound as u64 && vote.0 != ERROR;
                let by_sound = by_sound.then(|| [self.store.smoothing_length[i], self.signal(i)]);
                *ballot = Ballot::new(vote, self.limits.step_min, by_sound);
            }
        }
    }

    /// Whether a particle is sound and asks for more than the smallest step so far: the criteria of
    /// [`Self::vote`], multiplied out. What is no number is beyond nothing.
    #[inline(always)]
    fn is_beyond(&self, i: usize, moved: &Moved, ballot: &Ballot) -> bool {
        let (store, factors) = (self.store, &self.case.time_step);
        let (h, signal) = (store.smoothing_length[i], self.signal(i));
        let by_sound = (signal >= 0.0 && factors.courant * h > ballot.step * signal)
            || (ballot.is_matched(h, signal) && store.id[i] > ballot.best.2);
        let reach = factors.force * factors.force * h;
        let a = self.acceleration(i, &moved.contact);
        let by_force = reach * reach > ballot.step4 * square(&a);
        let by_contact = !self.contact || {
            let inertia = 4.0 * factors.contact * factors.contact * store.mass[i];
            // Stress points have neither.
            inertia >= ballot.step2 * store.contact_stiffness[i]
        };
        let inside = self.limits.surely_holds(store.density[i], moved);
        let near = store.position[i].iter().all(|x| x.abs() < FARTHEST);
        by_sound & by_force & by_contact & inside & near
    }

    /// Speed (m/s) of sound and viscosity for the step: no less than that of the approach, however
    /// little viscosity there is.
    #[inline(always)]
    fn signal(&self, i: usize) -> f64 {
        let (store, sph) = (self.store, &self.case.sph);
        let c = store.sound_speed[i];
        let approach = store.approach_speed[i];
        let signal = c + 0.6 * (sph.alpha * c + sph.beta * approach);
        // Not `max`, which would hide what is no number.
        let signal = if approach > signal { approach } else { signal };
        if let Some(&norm) = store.fit_norm.get(i) {
            let viscosity = Viscosity {
                alpha: sph.alpha,
                beta: sph.beta,
            };
            let stable = stress_points::signal(norm, c, approach, &viscosity, self.case.dimension);
            return if stable > signal { stable } else { signal };
        }
        let correction = store.correction_norm.get(i).copied().unwrap_or_default();
        signal * (correction / SURFACE_CORRECTION).max(1.0)
    }

    #[inline(always)]
    fn acceleration(&self, i: usize, contact: &[f64; 3]) -> [f64; 3] {
        let a = &self.store.acceleration[i];
        std::array::from_fn(|k| a[k] + self.gravity[k] + contact[k])
    }

    /// Sound and viscosity (Monaghan 1989) `C h / max(c + 0.6 (α c + β |μ|), |μ|)`, acceleration
    /// `C_f √(h/|a|)`, contact `2 f √(m/k)`; none by particles of rigid bodies. A correction that
    /// enlarges gradients more than those of plain surfaces do raises frequencies as much.
    #[cold]
    #[inline(never)]
    fn vote(&self, i: usize, moved: &Moved) -> Vote {
        let (store, case) = (self.store, self.case);
        let h = store.smoothing_length[i];
        let sound = case.time_step.courant * h / self.signal(i);
        let square = square(&self.acceleration(i, &moved.contact));
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
            && moved.energy.is_finite()
            && moved.velocity.iter().all(|v| v.is_finite())
            && store.position[i].iter().all(|x| x.abs() < FARTHEST);
        if !sane {
            return (ERROR, TroubleKind::NotFinite as u64, id);
        }
        if let Some(kind) = self.limits.check(store.body[i], store.density[i], moved) {
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
        "body `{}`, rank {rank}, position {}, velocity {}, density {}, specific energy {}, \
         pressure {}, sound speed {}; nearest particles {}",
        case.bodies[store.body[i] as usize].name,
        case.length_unit.vector(&store.position[i]),
        shown_vector(&store.velocity[i], "m/s"),
        shown(store.density[i], "kg/m^3"),
        shown(store.specific_energy[i], "J/kg"),
        shown(store.pressure[i], "Pa"),
        shown(store.sound_speed[i], "m/s"),
        nearest(store, case, i),
    )
}

/// The particles nearest to particle `i` of those that this rank holds: id, body, distance.
fn nearest(store: &ParticleStore, case: &Case, i: usize) -> String {
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
        .map(|&(r, k)| {
            let distance = case.length_unit.text(r);
            format!("{} of body {} at {distance}", store.id[k], store.body[k])
        })
        .collect();
    if described.is_empty() {
        "unknown".to_owned()
    } else {
        described.join(", ")
    }
}
