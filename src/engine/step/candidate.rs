//! The next time step: the smallest candidate of all particles on all ranks.
//!
//! A candidate is Δt, reason and id, compared in that order, so that ties agree on any ranks.

use std::collections::VecDeque;
use std::marker::PhantomData;

use super::flight::{Flight, FlightInputs};
use crate::contact::ContactTable;
use crate::diagnose::{Limits, Moved, NumericalFailure, PAST_STEPS, PastStep, Reason, RunState};
use crate::domain::Span;
use crate::sph::{SignalSpeed, Signals, Sph};
use comm::Comm;
use material::FAILED;
use model::{Case, TimeStepOptions};
use numerics::vector::square;

/// Largest coordinate that still counts as a position (m).
const FARTHEST: f64 = 1e12;

/// A candidate: bits of Δt (s; positive doubles order as their bits), reason, id.
pub(super) type Candidate = [u64; 3];

pub(super) const NO_CANDIDATE: Candidate = [u64::MAX, 0, 0];
/// Reads as an error: no positive Δt has these bits.
const ERROR: u64 = 0;

/// The choice of steps, and the last ones.
pub struct StepControl {
    /// Requests of this rank, such as to stop (a set of bits). All ranks' requests are joined with their candidates for
    /// the next step.
    pub requests: u64,
    /// The joined requests of all ranks as of the last candidate.
    pub agreed_requests: u64,
    /// Fill all fields that are not state with NaN between steps, and deactivate no particle: for tests.
    pub poison: bool,
    pub(super) limits: Limits,
    flight: Flight,
    options: TimeStepOptions,
    /// Sound speed of each body's material at rest (m/s).
    cold_sound: Vec<f64>,
    /// Particle of the last candidate that was chosen.
    id: u64,
    /// The last candidates, for post-mortems.
    past: VecDeque<PastStep>,
}

impl StepControl {
    /// Of a case. Collective.
    pub(super) fn new(case: &Case, table: &ContactTable, comm: &Comm) -> Self {
        Self {
            requests: 0,
            agreed_requests: 0,
            poison: false,
            limits: Limits::new(case, comm),
            flight: Flight::new(table),
            options: case.time_step,
            cold_sound: (case.bodies.iter())
                .map(|body| case.materials[body.material].longitudinal_speed())
                .collect(),
            id: 0,
            past: VecDeque::with_capacity(PAST_STEPS),
        }
    }

    /// Inputs of the candidates of particles, under gravity (m/s²).
    pub(super) fn criteria<'a>(&'a self, sph: &'a Sph, gravity: [f64; 3]) -> CriteriaInputs<'a> {
        CriteriaInputs {
            sph,
            limits: &self.limits,
            options: self.options,
            cold_sound: &self.cold_sound,
            gravity,
        }
    }

    /// The next step (s) and its reason, given the first candidate of all ranks and the extent of all
    /// particles; or the particle that has failed numerically. Collective.
    pub(super) fn choose(
        &mut self,
        comm: &Comm,
        [dt, reason, id]: Candidate,
        inputs: &FlightInputs,
        span: &Span,
    ) -> Result<(f64, Reason), (NumericalFailure, u64)> {
        if dt == ERROR {
            return Err((kind_of(reason), id));
        }
        self.id = id;
        let last = Reason::ALL.len() - 1;
        let mut reason = Reason::ALL[usize::try_from(reason).unwrap_or(0).min(last)];
        let mut dt = if dt == NO_CANDIDATE[0] {
            f64::INFINITY
        } else {
            f64::from_bits(dt)
        };
        if self.options.max < dt {
            (dt, reason) = (self.options.max, Reason::Maximum);
        }
        let flight = self.flight.longest_step(comm, inputs, span, dt);
        if flight < dt {
            (dt, reason) = (flight, Reason::Flight);
        }
        Ok((dt, reason))
    }

    /// Remembers the last choice, whose step and reason stand in the state.
    pub(super) fn keep(&mut self, state: &RunState) {
        if self.past.len() == PAST_STEPS {
            self.past.pop_front();
        }
        self.past.push_back(PastStep {
            step: state.step,
            dt: state.dt,
            reason: state.dt_reason.name(),
            id: self.id,
        });
    }

    /// The last candidates, oldest first.
    pub(super) fn past(&self) -> &VecDeque<PastStep> {
        &self.past
    }

    pub(super) fn memory(&self) -> usize {
        self.flight.memory()
    }
}

fn kind_of(number: u64) -> NumericalFailure {
    let last = NumericalFailure::ALL.len() - 1;
    NumericalFailure::ALL[usize::try_from(number).unwrap_or(0).min(last)]
}

/// The smallest candidate so far, and powers of it: by these a particle neither undercuts it nor has
/// failed, without roots and divisions.
pub(super) struct BestCandidate {
    best: Candidate,
    /// Steps beyond this one (s) do not matter, with room for rounding.
    step: f64,
    /// Its square and its fourth power, infinite where they are too small to compare.
    step2: f64,
    step4: f64,
    /// Smoothing length (m) and signal speed (m/s) of a best candidate by sound: where all is at
    /// rest, all candidates are this one, and the smallest id has it.
    by_sound: Option<[f64; 2]>,
}

impl BestCandidate {
    fn new(best: Candidate, step_min: f64, by_sound: Option<[f64; 2]>) -> Self {
        let dt = match best {
            NO_CANDIDATE => f64::INFINITY,
            [bits, ..] => f64::from_bits(bits),
        };
        let step = dt.max(step_min) * (1.0 + 1e-9);
        let step2 = step * step;
        let step4 = step2 * step2;
        let compare = step == 0.0 || step4 >= f64::MIN_POSITIVE;
        let [step2, step4] =
            [step2, step4].map(|power| if compare { power } else { f64::INFINITY });
        Self {
            best,
            step,
            step2,
            step4,
            by_sound,
        }
    }

    /// True if a candidate by sound is the best one too.
    #[inline(always)]
    fn is_matched(&self, h: f64, signal: f64) -> bool {
        self.by_sound == Some([h, signal])
    }

    pub(super) fn candidate(&self) -> Candidate {
        self.best
    }

    /// The one with the smaller candidate.
    pub(super) fn min(self, other: Self) -> Self {
        if other.best < self.best { other } else { self }
    }
}

/// Fields that candidates follow from.
pub(super) struct CriteriaFields<'a> {
    pub id: &'a [u64],
    pub body: &'a [u32],
    pub mass: &'a [f64],
    pub density: &'a [f64],
    pub position: &'a [[f64; 3]],
    pub smoothing_length: &'a [f64],
    pub acceleration: &'a [[f64; 3]],
    /// Empty without self-gravity.
    pub gravity_acceleration: &'a [[f64; 3]],
    pub contact_stiffness: &'a [f64],
    pub sound_speed: &'a [f64],
    pub approach_speed: &'a [f64],
    /// Empty in cases without failure.
    pub damage: &'a [f64],
    pub correction_norm: &'a [f64],
    pub fit_norm: &'a [f64],
}

/// Borrows [`CriteriaFields`] of a store.
macro_rules! criteria_fields {
    ($particles:expr) => {
        $crate::step::candidate::CriteriaFields {
            id: &$particles.id,
            body: &$particles.body,
            mass: &$particles.mass,
            density: &$particles.density,
            position: &$particles.position,
            smoothing_length: &$particles.smoothing_length,
            acceleration: &$particles.acceleration,
            gravity_acceleration: &$particles.gravity_acceleration,
            contact_stiffness: &$particles.contact_stiffness,
            sound_speed: &$particles.sound_speed,
            approach_speed: &$particles.approach_speed,
            damage: &$particles.damage,
            correction_norm: &$particles.correction_norm,
            fit_norm: &$particles.fit_norm,
        }
    };
}
pub(super) use criteria_fields;

/// Inputs of the candidates of particles, beside their fields.
#[derive(Clone, Copy)]
pub(super) struct CriteriaInputs<'a> {
    sph: &'a Sph,
    limits: &'a Limits,
    options: TimeStepOptions,
    /// By body (m/s).
    cold_sound: &'a [f64],
    /// Acceleration (m/s²).
    gravity: [f64; 3],
}

/// The criteria that candidates follow from, in the formulation `F`.
pub(super) struct Criteria<'a, F> {
    pub fields: CriteriaFields<'a>,
    signals: Signals<'a>,
    options: TimeStepOptions,
    contact: bool,
    cold_sound: &'a [f64],
    gravity: [f64; 3],
    limits: &'a Limits,
    formulation: PhantomData<F>,
}

impl<'a, F: SignalSpeed> Criteria<'a, F> {
    pub(super) fn new(fields: CriteriaFields<'a>, inputs: CriteriaInputs<'a>) -> Self {
        let CriteriaInputs {
            sph,
            limits,
            options,
            cold_sound,
            gravity,
        } = inputs;
        let speeds = [fields.sound_speed, fields.approach_speed];
        Self {
            signals: sph.signals(speeds, [fields.correction_norm, fields.fit_norm]),
            contact: !fields.contact_stiffness.is_empty(),
            fields,
            options,
            cold_sound,
            gravity,
            limits,
            formulation: PhantomData,
        }
    }

    /// Numerical failure of a particle, if any.
    pub(super) fn failure(&self, i: usize, moved: &Moved) -> Option<NumericalFailure> {
        let [dt, kind, _] = self.candidate(i, moved);
        (dt == ERROR).then(|| kind_of(kind))
    }

    /// No candidate yet.
    pub(super) fn best(&self) -> BestCandidate {
        BestCandidate::new(NO_CANDIDATE, self.limits.step_min, None)
    }

    /// Takes the candidate of a particle.
    #[inline(always)]
    pub(super) fn ask(&self, i: usize, moved: &Moved, best: &mut BestCandidate) {
        if !self.is_beyond(i, moved, best) {
            let candidate = self.candidate(i, moved);
            if candidate < best.best {
                let by_sound = candidate[1] == Reason::Sound as u64 && candidate[0] != ERROR;
                let by_sound = by_sound.then(|| [self.fields.smoothing_length[i], self.signal(i)]);
                *best = BestCandidate::new(candidate, self.limits.step_min, by_sound);
            }
        }
    }

    /// True if a particle is sound and asks for more than the smallest step so far: the criteria of
    /// [`Self::candidate`], multiplied out. NaN is beyond nothing.
    #[inline(always)]
    fn is_beyond(&self, i: usize, moved: &Moved, best: &BestCandidate) -> bool {
        let (fields, factors) = (&self.fields, &self.options);
        let (h, signal) = (fields.smoothing_length[i], self.signal(i));
        let by_sound = (signal >= 0.0 && factors.courant * h > best.step * signal)
            || (best.is_matched(h, signal) && fields.id[i] > best.best[2]);
        let reach = factors.force * factors.force * h;
        let a = self.acceleration(i, &moved.contact);
        let by_force = reach * reach > best.step4 * square(&a);
        let by_contact = !self.contact || {
            let inertia = 4.0 * factors.contact * factors.contact * fields.mass[i];
            // Stress points have neither.
            inertia >= best.step2 * fields.contact_stiffness[i]
        };
        let inside = self.limits.surely_holds(fields.density[i], moved);
        let near = fields.position[i].iter().all(|x| x.abs() < FARTHEST);
        by_sound & by_force & by_contact & inside & near
    }

    /// Speed of the signals (m/s) that particle `i` sends. Sound of failed matter without neighbours counts as that of its
    /// material at rest, since nothing carries it: its acceleration is zero to the bit. Hot spray would keep all others waiting.
    #[inline(always)]
    fn signal(&self, i: usize) -> f64 {
        let fields = &self.fields;
        let has_failed = fields.damage.get(i).is_some_and(|&damage| damage >= FAILED);
        let fastest = if has_failed && fields.acceleration[i] == [0.0; 3] {
            self.cold_sound[fields.body[i] as usize]
        } else {
            f64::INFINITY
        };
        self.signals.of::<F>(i, fastest)
    }

    #[inline(always)]
    fn acceleration(&self, i: usize, contact: &[f64; 3]) -> [f64; 3] {
        let a = &self.fields.acceleration[i];
        let other = std::array::from_fn(|k| a[k] + self.gravity[k] + contact[k]);
        let own = self.fields.gravity_acceleration.get(i);
        own.map_or(other, |own| std::array::from_fn(|k| other[k] + own[k]))
    }

    /// Sound and viscosity (Monaghan 1989) `C h / max(c + 0.6 (α c + β |μ|), |μ|)`, acceleration
    /// `C_f √(h/|a|)`, contact `2 f √(m/k)`; none by particles of rigid bodies. A correction that
    /// enlarges gradients more than those of plain surfaces do raises frequencies as much.
    #[cold]
    #[inline(never)]
    fn candidate(&self, i: usize, moved: &Moved) -> Candidate {
        let (fields, factors) = (&self.fields, &self.options);
        let h = fields.smoothing_length[i];
        let sound = factors.courant * h / self.signal(i);
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
            return [ERROR, NumericalFailure::NotFinite as u64, id];
        }
        if let Some(kind) = self.limits.check(fields.body[i], fields.density[i], moved) {
            return [ERROR, kind as u64, id];
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
            return [ERROR, NumericalFailure::Step as u64, id];
        }
        [dt.to_bits(), reason as u64, id]
    }
}
