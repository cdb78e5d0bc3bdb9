//! Kick–drift–kick with an energy equation that is compatible to round-off.
//!
//! From step n to n+1:
//! `v½ = v_n + ½Δt a_n`, `x_{n+1} = x_n + Δt v½`, predicted `v^p = v½ + ½Δt a_n` (and ρ^p, e^p
//! likewise); the pair sums at `x_{n+1}` with `v^p` give `a_{n+1}` and the power
//! `E = −½ Σ m_j v^p_ij · F_ij`; then `v_{n+1} = v½ + ½Δt a_{n+1}`.
//!
//! In a half kick kinetic energy changes by `½Δt m a · v̄` with `v̄` the mean velocity of that half
//! kick. Pairwise antisymmetry makes `Σ m E = −Σ m a^sph · v^p` exactly, so each particle's
//! energy rate is `E − a^sph · (v̄ − v^p)`: kinetic plus internal energy at whole steps is then
//! constant to round-off for the SPH forces, without stored pair forces and without another sweep.

use rayon::prelude::*;

use super::candidate::{BestCandidate, Candidate, Criteria, CriteriaInputs, criteria_fields};
use crate::diagnose::Moved;
use crate::domain::Span;
use crate::loads::{Acting, Free, Loads, Prescribe, VelocityStage};
use crate::sph::{SignalSpeed, Smoothing, thinned};
use numerics::exact_sum::ExactSum;
use numerics::vector::dot;
use particles::{ActiveMut, GRAIN, Inactive};

fn add(a: &[f64; 3], b: &[f64; 3]) -> [f64; 3] {
    std::array::from_fn(|k| a[k] + b[k])
}

fn add_scaled(v: &[f64; 3], factor: f64, a: &[f64; 3]) -> [f64; 3] {
    std::array::from_fn(|k| v[k] + factor * a[k])
}

/// A half kick.
#[derive(Debug, Clone, Copy)]
struct Kick<'a> {
    /// The whole step (s).
    dt: f64,
    gravity: [f64; 3],
    /// Of each particle (m/s²); empty without self-gravity.
    self_gravity: &'a [[f64; 3]],
}

impl Kick<'_> {
    /// Acceleration (m/s²) of particle `i` by stress, contact and gravity.
    #[inline(always)]
    fn total(&self, i: usize, stress: &[f64; 3], contact: &[f64; 3]) -> [f64; 3] {
        let outside = add(contact, &self.gravity);
        add(
            stress,
            &self
                .self_gravity
                .get(i)
                .map_or(outside, |own| add(&outside, own)),
        )
    }
}

/// Calls `$work` with a function of a particle and its place (m): its acceleration by contact (m/s²) and its loads, which
/// have a type of their own where there are none.
macro_rules! with_outside {
    ($loads:expr, $particles:expr, $name:ident => $work:expr) => {{
        let (contact, bits) = (&$particles.contact_acceleration, &$particles.load);
        if $loads.drive() {
            let acting = Acting {
                contact,
                load: bits,
                body: &$particles.body,
                absorption: &$particles.absorption,
                pressed: &$particles.pressed,
                face: &$particles.face,
            };
            let $name = |i: usize, x: &[f64; 3]| acting.on(i, x, $loads);
            $work
        } else if $loads.has_motions() {
            let $name = |i: usize, x: &[f64; 3]| {
                let contact = contact.get(i).copied().unwrap_or_default();
                (contact, $loads.at(bits[i], x))
            };
            $work
        } else if !contact.is_empty() {
            let $name = |i: usize, _: &[f64; 3]| (contact[i], Free);
            $work
        } else {
            let $name = |_: usize, _: &[f64; 3]| ([0.0; 3], Free);
            $work
        }
    }};
}

/// Fields that the first half kick and the drift write.
struct Drifting<'a> {
    velocity: &'a mut [[f64; 3]],
    specific_energy: &'a mut [f64],
    position: &'a mut [[f64; 3]],
    predicted_velocity: &'a mut [[f64; 3]],
    predicted_density: &'a mut [f64],
    smoothing_length: &'a mut [f64],
}

/// Fields that they read.
struct Rates<'a> {
    mass: &'a [f64],
    density: &'a [f64],
    body: &'a [u32],
    acceleration: &'a [[f64; 3]],
    heating: &'a [f64],
    velocity_gradient: &'a [[f64; 9]],
}

/// First half kick and drift of a step `dt` (s), and the predictions for its end, of active particles. Returns
/// the work of contact (J).
pub(super) fn kick_and_drift(
    active: ActiveMut,
    loads: &Loads,
    smoothing: &Smoothing,
    dt: f64,
) -> ExactSum {
    let ActiveMut {
        particles,
        inactive,
    } = active;
    let kick = Kick {
        dt,
        gravity: loads.gravity,
        self_gravity: &particles.gravity_acceleration,
    };
    let drifting = Drifting {
        velocity: &mut particles.velocity,
        specific_energy: &mut particles.specific_energy,
        position: &mut particles.position,
        predicted_velocity: &mut particles.predicted_velocity,
        predicted_density: &mut particles.predicted_density,
        smoothing_length: &mut particles.smoothing_length,
    };
    let rates = Rates {
        mass: &particles.mass,
        density: &particles.density,
        body: &particles.body,
        acceleration: &particles.acceleration,
        heating: &particles.d_specific_energy_dt,
        velocity_gradient: &particles.velocity_gradient,
    };
    with_outside!(loads, particles, outside => {
        drifting.advance(kick, &rates, inactive, smoothing, outside)
    })
}

impl Drifting<'_> {
    fn advance<D: Prescribe>(
        self,
        kick: Kick<'_>,
        rates: &Rates,
        inactive: &Inactive,
        smoothing: &Smoothing,
        outside: impl Fn(usize, &[f64; 3]) -> ([f64; 3], D) + Sync,
    ) -> ExactSum {
        let dt = kick.dt;
        let half = 0.5 * dt;
        let per_half = Loads::per_half(dt);
        (
            self.velocity.par_chunks_mut(GRAIN),
            self.specific_energy.par_chunks_mut(GRAIN),
            self.position.par_chunks_mut(GRAIN),
            self.predicted_velocity.par_chunks_mut(GRAIN),
            self.predicted_density.par_chunks_mut(GRAIN),
            self.smoothing_length.par_chunks_mut(GRAIN),
        )
            .into_par_iter()
            .enumerate()
            // same bits in any order: exact sums are integers
            .fold(
                ExactSum::default,
                |mut work, (chunk, (v, e, x, v_p, rho_p, h))| {
                    inactive.each_active(chunk * GRAIN, v.len(), |k| {
                        let i = chunk * GRAIN + k;
                        let (contact, prescribed) = outside(i, &x[k]);
                        let a = &rates.acceleration[i];
                        let mut total = kick.total(i, a, &contact);
                        let mut mean = add_scaled(&v[k], 0.25 * dt, &total);
                        prescribed.accelerate(VelocityStage::Middle, &v[k], per_half, &mut total);
                        e[k] += half * (rates.heating[i] - 0.25 * dt * dot(a, &total));
                        let whole = v[k];
                        v[k] = add_scaled(&v[k], half, &total);
                        prescribed.set(VelocityStage::Middle, &mut v[k]);
                        if contact != [0.0; 3] {
                            prescribed.correct_mean(&whole, &v[k], &mut mean);
                            work.add(half * rates.mass[i] * dot(&contact, &mean));
                        }
                        x[k] = add_scaled(&x[k], dt, &v[k]);
                        v_p[k] = add_scaled(&v[k], half, &total);
                        prescribed.set(VelocityStage::End, &mut v_p[k]);
                        let l = &rates.velocity_gradient[i];
                        let strain = half * (l[0] + l[4] + l[8]);
                        rho_p[k] = rates.density[i] * thinned(strain);
                        h[k] = smoothing.length(rates.body[i] as usize, rates.mass[i], rho_p[k]);
                    });
                    work
                },
            )
            // same bits in any order, as above
            .reduce(ExactSum::default, merged)
    }
}

/// Results of the second half kick.
pub(super) struct Kicked {
    /// Work of contact (J).
    pub work: ExactSum,
    /// This rank's candidate for the next step, taken while each particle is at hand.
    pub candidate: Candidate,
    /// Extent of the places and velocities of particles.
    pub span: Span,
}

/// Second half kick of a step `dt` (s), zero at the start of a case, of active particles, with their candidates for
/// the next step in the formulation `F`.
pub(super) fn kick<F: SignalSpeed>(
    active: ActiveMut,
    loads: &Loads,
    criteria: CriteriaInputs,
    dt: f64,
) -> Kicked {
    let ActiveMut {
        particles,
        inactive,
    } = active;
    let kick = Kick {
        dt,
        gravity: loads.gravity,
        self_gravity: &particles.gravity_acceleration,
    };
    let criteria = Criteria::<F>::new(criteria_fields!(particles), criteria);
    let predicted_velocity = &particles.predicted_velocity;
    let kicking = Kicking {
        velocity: &mut particles.velocity,
        specific_energy: &mut particles.specific_energy,
        heating: &mut particles.d_specific_energy_dt,
    };
    with_outside!(loads, particles, outside => {
        kicking.finish(kick, &criteria, inactive, predicted_velocity, outside)
    })
}

/// Fields that the second half kick writes.
struct Kicking<'a> {
    velocity: &'a mut [[f64; 3]],
    specific_energy: &'a mut [f64],
    heating: &'a mut [f64],
}

impl Kicking<'_> {
    fn finish<D: Prescribe, F: SignalSpeed>(
        self,
        kick: Kick<'_>,
        criteria: &Criteria<F>,
        inactive: &Inactive,
        predicted_velocity: &[[f64; 3]],
        outside: impl Fn(usize, &[f64; 3]) -> ([f64; 3], D) + Sync,
    ) -> Kicked {
        let dt = kick.dt;
        let half = 0.5 * dt;
        let per_half = Loads::per_half(dt);
        let fields = &criteria.fields;
        let none = || (ExactSum::default(), criteria.best(), Span::NONE);
        let (work, best, span) = (
            self.velocity.par_chunks_mut(GRAIN),
            self.specific_energy.par_chunks_mut(GRAIN),
            self.heating.par_chunks_mut(GRAIN),
        )
            .into_par_iter()
            .enumerate()
            // same bits in any order: exact sums are integers, and smallest numbers are one
            .fold(
                none,
                |(mut work, mut best, mut span), (chunk, (v, e, de))| {
                    inactive.each_active(chunk * GRAIN, v.len(), |k| {
                        let i = chunk * GRAIN + k;
                        let (contact, prescribed) = outside(i, &fields.position[i]);
                        let a = &fields.acceleration[i];
                        let forces = kick.total(i, a, &contact);
                        let mut total = forces;
                        prescribed.accelerate(VelocityStage::End, &v[k], per_half, &mut total);
                        let middle = v[k];
                        v[k] = add_scaled(&v[k], half, &total);
                        prescribed.set(VelocityStage::End, &mut v[k]);
                        span.add(&fields.position[i], &v[k]);
                        if contact != [0.0; 3] {
                            let mut mean = add_scaled(&v[k], -0.25 * dt, &forces);
                            prescribed.correct_mean(&v[k], &middle, &mut mean);
                            work.add(half * fields.mass[i] * dot(&contact, &mean));
                        }
                        let v_p = &predicted_velocity[i];
                        let late = add_scaled(&v[k], -1.0, v_p);
                        de[k] -= dot(a, &late);
                        e[k] += half * (de[k] + 0.25 * dt * dot(a, &total));
                        if !prescribed.is_rigid() {
                            let moved = Moved {
                                velocity: v[k],
                                energy: e[k],
                                contact: add(&contact, &prescribed.push()),
                            };
                            criteria.ask(i, &moved, &mut best);
                        }
                    });
                    (work, best, span)
                },
            )
            // same bits in any order, as above
            .reduce(none, |(work, best, mut span), (other, others, beyond)| {
                span.join(&beyond);
                (merged(work, other), BestCandidate::min(best, others), span)
            });
        Kicked {
            work,
            candidate: best.candidate(),
            span,
        }
    }
}

#[allow(clippy::needless_pass_by_value, reason = "the form of a reduction")]
fn merged(mut all: ExactSum, part: ExactSum) -> ExactSum {
    all.merge(&part);
    all
}
