//! The next time step: the smallest vote of all particles on all ranks.
//!
//! A vote is (Δt, reason, id), compared in that order, so that ties agree on any ranks.

use std::collections::VecDeque;
use std::marker::PhantomData;

use super::flight::{Flight, Sky};
use crate::comm::Comm;
use crate::contact::ContactTable;
use crate::diagnose::{Limits, Moved, PAST_VOTES, PastVote, Reason, RunState, TroubleKind};
use crate::domain::Span;
use crate::model::{Case, TimeStepOptions};
use crate::numerics::vector::square;
use crate::sph::{SignalSpeed, Signals, Sph};

/// Largest coordinate that still counts as a position (m).
const FARTHEST: f64 = 1e12;

/// A vote: bits of Δt (s; positive doubles order as their bits), reason, id.
pub(super) type Vote = (u64, u64, u64);

pub(super) const ABSTAIN: Vote = (u64::MAX, 0, 0);
/// Reads as an error: no positive Δt has these bits.
const ERROR: u64 = 0;

/// Votes on steps, and what a run remembers of them.
pub struct Votes {
    /// What this rank wishes (a set of bits): all ranks' wishes are joined by the next step's vote.
    pub wishes: u64,
    /// The joined wishes of all ranks as of the last vote.
    pub agreed_wishes: u64,
    pub(super) limits: Limits,
    flight: Flight,
    /// Largest step (s).
    longest: f64,
    /// Who had the last vote.
    id: u64,
    /// The last votes, for post-mortems.
    past: VecDeque<PastVote>,
    words: Vec<u64>,
}

impl Votes {
    /// Of a case. Collective.
    pub(super) fn new(case: &Case, table: &ContactTable, comm: &Comm) -> Self {
        Self {
            wishes: 0,
            agreed_wishes: 0,
            limits: Limits::new(case, comm),
            flight: Flight::new(table),
            longest: case.time_step.max,
            id: 0,
            past: VecDeque::with_capacity(PAST_VOTES),
            words: Vec::new(),
        }
    }

    /// The next step (s) and its reason, given this rank's vote and what all particles span; or who is in
    /// trouble. Collective.
    pub(super) fn choose(
        &mut self,
        comm: &Comm,
        (dt, reason, id): Vote,
        sky: &Sky,
        span: &Span,
    ) -> Result<(f64, Reason), (TroubleKind, u64)> {
        let words = &mut self.words;
        comm.all_gather_u64(&[dt, reason, id, self.wishes], words);
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
        let (dt, reason, id) = best;
        if dt == ERROR {
            return Err((kind_of(reason), id));
        }
        self.id = id;
        let last = Reason::ALL.len() - 1;
        let mut reason = Reason::ALL[usize::try_from(reason).unwrap_or(0).min(last)];
        let mut dt = if dt == ABSTAIN.0 {
            f64::INFINITY
        } else {
            f64::from_bits(dt)
        };
        if self.longest < dt {
            (dt, reason) = (self.longest, Reason::Maximum);
        }
        let flight = self.flight.longest_step(comm, sky, span, dt);
        if flight < dt {
            (dt, reason) = (flight, Reason::Flight);
        }
        Ok((dt, reason))
    }

    /// Remembers the last vote, of which the state knows the rest.
    pub(super) fn keep(&mut self, state: &RunState) {
        if self.past.len() == PAST_VOTES {
            self.past.pop_front();
        }
        self.past.push_back(PastVote {
            step: state.step,
            dt: state.dt,
            reason: state.dt_reason.name(),
            id: self.id,
        });
    }

    /// The last votes, oldest first.
    pub(super) fn past(&self) -> &VecDeque<PastVote> {
        &self.past
    }

    pub(super) fn memory(&self) -> usize {
        self.flight.memory() + 8 * self.words.capacity()
    }
}

fn kind_of(number: u64) -> TroubleKind {
    let last = TroubleKind::ALL.len() - 1;
    TroubleKind::ALL[usize::try_from(number).unwrap_or(0).min(last)]
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

/// Fields that votes follow from.
pub(super) struct VoteFields<'a> {
    pub id: &'a [u64],
    pub body: &'a [u32],
    pub mass: &'a [f64],
    pub density: &'a [f64],
    pub position: &'a [[f64; 3]],
    pub smoothing_length: &'a [f64],
    pub acceleration: &'a [[f64; 3]],
    pub contact_stiffness: &'a [f64],
    pub sound_speed: &'a [f64],
    pub approach_speed: &'a [f64],
    pub correction_norm: &'a [f64],
    pub fit_norm: &'a [f64],
}

/// Borrows [`VoteFields`] of a fields.
macro_rules! vote_fields {
    ($particles:expr) => {
        $crate::step::vote::VoteFields {
            id: &$particles.id,
            body: &$particles.body,
            mass: &$particles.mass,
            density: &$particles.density,
            position: &$particles.position,
            smoothing_length: &$particles.smoothing_length,
            acceleration: &$particles.acceleration,
            contact_stiffness: &$particles.contact_stiffness,
            sound_speed: &$particles.sound_speed,
            approach_speed: &$particles.approach_speed,
            correction_norm: &$particles.correction_norm,
            fit_norm: &$particles.fit_norm,
        }
    };
}
pub(super) use vote_fields;

/// What a particle's vote depends on, in the formulation `F`.
pub(super) struct Voter<'a, F> {
    pub fields: VoteFields<'a>,
    signals: Signals<'a>,
    factors: TimeStepOptions,
    contact: bool,
    gravity: [f64; 3],
    limits: &'a Limits,
    formulation: PhantomData<F>,
}

impl<'a, F: SignalSpeed> Voter<'a, F> {
    pub(super) fn new(
        fields: VoteFields<'a>,
        sph: &Sph,
        limits: &'a Limits,
        (factors, gravity): (TimeStepOptions, [f64; 3]),
    ) -> Self {
        let speeds = [fields.sound_speed, fields.approach_speed];
        Self {
            signals: sph.signals(speeds, [fields.correction_norm, fields.fit_norm]),
            contact: !fields.contact_stiffness.is_empty(),
            fields,
            factors,
            gravity,
            limits,
            formulation: PhantomData,
        }
    }

    /// What is wrong with a particle, if anything is.
    pub(super) fn trouble(&self, i: usize, moved: &Moved) -> Option<TroubleKind> {
        let (dt, kind, _) = self.vote(i, moved);
        (dt == ERROR).then(|| kind_of(kind))
    }

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
                let by_sound =
                    by_sound.then(|| [self.fields.smoothing_length[i], self.signals.of::<F>(i)]);
                *ballot = Ballot::new(vote, self.limits.step_min, by_sound);
            }
        }
    }

    /// Whether a particle is sound and asks for more than the smallest step so far: the criteria of
    /// [`Self::vote`], multiplied out. What is no number is beyond nothing.
    #[inline(always)]
    fn is_beyond(&self, i: usize, moved: &Moved, ballot: &Ballot) -> bool {
        let (fields, factors) = (&self.fields, &self.factors);
        let (h, signal) = (fields.smoothing_length[i], self.signals.of::<F>(i));
        let by_sound = (signal >= 0.0 && factors.courant * h > ballot.step * signal)
            || (ballot.is_matched(h, signal) && fields.id[i] > ballot.best.2);
        let reach = factors.force * factors.force * h;
        let a = self.acceleration(i, &moved.contact);
        let by_force = reach * reach > ballot.step4 * square(&a);
        let by_contact = !self.contact || {
            let inertia = 4.0 * factors.contact * factors.contact * fields.mass[i];
            // Stress points have neither.
            inertia >= ballot.step2 * fields.contact_stiffness[i]
        };
        let inside = self.limits.surely_holds(fields.density[i], moved);
        let near = fields.position[i].iter().all(|x| x.abs() < FARTHEST);
        by_sound & by_force & by_contact & inside & near
    }

    #[inline(always)]
    fn acceleration(&self, i: usize, contact: &[f64; 3]) -> [f64; 3] {
        let a = &self.fields.acceleration[i];
        std::array::from_fn(|k| a[k] + self.gravity[k] + contact[k])
    }

    /// Sound and viscosity (Monaghan 1989) `C h / max(c + 0.6 (α c + β |μ|), |μ|)`, acceleration
    /// `C_f √(h/|a|)`, contact `2 f √(m/k)`; none by particles of rigid bodies. A correction that
    /// enlarges gradients more than those of plain surfaces do raises frequencies as much.
    #[cold]
    #[inline(never)]
    fn vote(&self, i: usize, moved: &Moved) -> Vote {
        let (fields, factors) = (&self.fields, &self.factors);
        let h = fields.smoothing_length[i];
        let sound = factors.courant * h / self.signals.of::<F>(i);
        let square = square(&self.acceleration(i, &moved.contact));
        let force = factors.force * (h / square.sqrt()).sqrt();
        let contact = if self.contact {
            2.0 * factors.contact * (fields.mass[i] / fields.contact_stiffness[i]).sqrt()
        } else {
            f64::INFINITY
        };
        let id = fields.id[i];
        let sane = sound > 0.0
            && !force.is_nan()
            && fields.density[i].is_finite()
            && moved.energy.is_finite()
            && moved.velocity.iter().all(|v| v.is_finite())
            && fields.position[i].iter().all(|x| x.abs() < FARTHEST);
        if !sane {
            return (ERROR, TroubleKind::NotFinite as u64, id);
        }
        if let Some(kind) = self.limits.check(fields.body[i], fields.density[i], moved) {
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
