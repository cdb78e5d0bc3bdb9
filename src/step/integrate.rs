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

use super::loads::{Drive, Free, Goal, LoadStep};
use super::search::GRAIN;
use super::simulation::Simulation;
use super::span::Span;
use super::vote::{ABSTAIN, Moved, Vote};
use crate::model::SmoothingLength;
use crate::numerics::exact_sum::ExactSum;
use crate::numerics::vector::dot;

/// Smoothing length of a particle from its predicted density (physics page, section 1).
#[derive(Debug, Clone, Copy)]
pub(super) struct SmoothingRule {
    rule: SmoothingLength,
    dimension: usize,
}

impl SmoothingRule {
    pub(super) fn new(rule: SmoothingLength, dimension: usize) -> Self {
        Self { rule, dimension }
    }

    /// `h` (m) from `h_0` (m) and `ρ_0/ρ`.
    #[inline]
    pub(super) fn length(&self, reference: f64, expansion: f64) -> f64 {
        match self.rule {
            SmoothingLength::Constant => reference,
            SmoothingLength::Variable { min, max } => {
                let ratio = match self.dimension {
                    1 => expansion,
                    2 => expansion.sqrt(),
                    _ => libm::cbrt(expansion),
                };
                reference * ratio.clamp(min, max)
            }
        }
    }
}

fn add(a: &[f64; 3], b: &[f64; 3]) -> [f64; 3] {
    std::array::from_fn(|k| a[k] + b[k])
}

fn add_scaled(v: &[f64; 3], factor: f64, a: &[f64; 3]) -> [f64; 3] {
    std::array::from_fn(|k| v[k] + factor * a[k])
}

impl Simulation {
    /// First half kick and drift of a step `dt` (s) that ends at time `end` (s), and the
    /// predictions for its end.
    pub(super) fn kick_and_drift(&mut self, dt: f64, end: f64) {
        self.loads.prepare(&self.case, self.state.time, end);
        self.book_loads(dt, true);
        self.book_plane_force(dt);
        self.store.resize_halo(0);
        self.half_kick(dt, Goal::Middle);
        self.drift_with_neighbours(dt);
        self.drift_stress_points(dt);
        self.fold_at_planes();
    }

    /// Second half kick of a step `dt` (s), zero at the start of a case. Gives this rank's vote on
    /// the next one, taken while each particle is at hand.
    #[must_use]
    pub(super) fn kick(&mut self, dt: f64) -> Vote {
        let (vote, span) = self.half_kick(dt, Goal::End);
        self.sums.span = span;
        self.book_loads(dt, false);
        vote
    }

    /// One of the two half kicks of the particles, with all that acts on them beside stress, and
    /// the work of contact in it. Only the second one votes, and looks where particles are.
    fn half_kick(&mut self, dt: f64, goal: Goal) -> (Vote, Span) {
        let contact = std::mem::take(&mut self.store.contact_acceleration);
        let bits = std::mem::take(&mut self.store.load);
        let loads = std::mem::take(&mut self.loads);
        let gravity = loads.gravity;
        let kick = Kick { dt, gravity };
        let (work, vote, span) = if loads.drives() {
            self.half_kick_by(kick, goal, |i| {
                (
                    contact.get(i).copied().unwrap_or_default(),
                    loads.of(bits[i]),
                )
            })
        } else if self.contact.is_active() {
            self.half_kick_by(kick, goal, |i| (contact[i], Free))
        } else {
            self.half_kick_by(kick, goal, |_| ([0.0; 3], Free))
        };
        self.sums.contact_work.merge(&work);
        (self.loads, self.store.load) = (loads, bits);
        self.store.contact_acceleration = contact;
        (vote, span)
    }

    /// [`Self::half_kick`], given the acceleration by contact (m/s²) and the loads of a particle.
    fn half_kick_by<D: Drive>(
        &mut self,
        kick: Kick,
        goal: Goal,
        outside: impl Fn(usize) -> ([f64; 3], D) + Sync,
    ) -> (ExactSum, Vote, Span) {
        match goal {
            Goal::Middle => (self.kick_and_drift_by(kick, outside), ABSTAIN, Span::NONE),
            Goal::End => self.kick_by(kick, outside),
        }
    }

    /// [`Self::kick_and_drift`] of the particles. Gives the work of contact (J).
    fn kick_and_drift_by<D: Drive>(
        &mut self,
        kick: Kick,
        outside: impl Fn(usize) -> ([f64; 3], D) + Sync,
    ) -> ExactSum {
        let rule = SmoothingRule::new(self.case.sph.smoothing_length, self.case.dimension);
        let (table, reference_h) = (&self.contact, &self.reference_h);
        let dt = kick.dt;
        let half = 0.5 * dt;
        let per_half = LoadStep::per_half(dt);
        let store = &mut self.store;
        (
            store.velocity.par_chunks_mut(GRAIN),
            store.specific_energy.par_chunks_mut(GRAIN),
            store.position.par_chunks_mut(GRAIN),
            store.predicted_velocity.par_chunks_mut(GRAIN),
            store.predicted_density.par_chunks_mut(GRAIN),
            store.smoothing_length.par_chunks_mut(GRAIN),
        )
            .into_par_iter()
            .enumerate()
            // same bits in any order: exact sums are integers
            .fold(
                ExactSum::default,
                |mut work, (chunk, (v, e, x, v_p, rho_p, h))| {
                    for k in 0..v.len() {
                        let i = chunk * GRAIN + k;
                        let (contact, drive) = outside(i);
                        let a = &store.acceleration[i];
                        let mut total = kick.total(a, &contact);
                        if contact != [0.0; 3] {
                            let mut mean = add_scaled(&v[k], 0.25 * dt, &total);
                            drive.correct_mean(&v[k], &mut mean);
                            work.add(half * store.mass[i] * dot(&contact, &mean));
                        }
                        drive.steer(Goal::Middle, &v[k], per_half, &mut total);
                        e[k] += half * (store.d_specific_energy_dt[i] - 0.25 * dt * dot(a, &total));
                        v[k] = add_scaled(&v[k], half, &total);
                        drive.set(Goal::Middle, &mut v[k]);
                        x[k] = add_scaled(&x[k], dt, &v[k]);
                        v_p[k] = add_scaled(&v[k], half, &total);
                        drive.set(Goal::End, &mut v_p[k]);
                        let l = &store.velocity_gradient[i];
                        let strain = half * (l[0] + l[4] + l[8]);
                        rho_p[k] = store.density[i] * ((1.0 - strain) / (1.0 + strain));
                        let body = store.body[i] as usize;
                        let reference = 1.0 / table.inverse_density(body);
                        h[k] = rule.length(reference_h[body], reference / rho_p[k]);
                    }
                    work
                },
            )
            // same bits in any order, as above
            .reduce(ExactSum::default, merged)
    }

    /// Particles that crossed a symmetry plane change places with their images.
    fn fold_at_planes(&mut self) {
        let mirrors = *self.halo.mirrors();
        if mirrors.is_empty() {
            return;
        }
        let positions = self.store.position.par_chunks(GRAIN);
        self.crossed.resize(positions.len(), Vec::new());
        (&mut self.crossed, positions)
            .into_par_iter()
            .enumerate()
            .for_each(|(chunk, (crossed, positions))| {
                let beyond = |(_, x): &(usize, &[f64; 3])| mirrors.beyond(x) != 0;
                let indices = positions.iter().enumerate().filter(beyond);
                crossed.clear();
                crossed.extend(indices.map(|(k, _)| chunk * GRAIN + k));
            });
        for &i in self.crossed.iter().flatten() {
            self.sums.crossings += 1;
            let before = self.store.velocity[i];
            mirrors.fold(&mut self.store, i);
            let after = self.store.velocity[i];
            if self
                .store
                .load
                .get(i)
                .is_some_and(|&bits| self.loads.is_rigid(bits))
            {
                continue;
            }
            let mass = self.store.mass[i];
            for a in 0..3 {
                self.sums.crossing_impulse[a].add(mass * (after[a] - before[a]));
            }
        }
    }

    /// [`Self::kick`] of the particles. Gives the work of contact (J), the smallest vote, and what the
    /// particles span.
    fn kick_by<D: Drive>(
        &mut self,
        kick: Kick,
        outside: impl Fn(usize) -> ([f64; 3], D) + Sync,
    ) -> (ExactSum, Vote, Span) {
        let dt = kick.dt;
        let half = 0.5 * dt;
        let per_half = LoadStep::per_half(dt);
        let mut velocity = std::mem::take(&mut self.store.velocity);
        let mut energy = std::mem::take(&mut self.store.specific_energy);
        let mut rate = std::mem::take(&mut self.store.d_specific_energy_dt);
        let (voter, store) = (self.voter(), &self.store);
        let none = || (ExactSum::default(), voter.ballot(), Span::NONE);
        let (work, ballot, span) = (
            velocity.par_chunks_mut(GRAIN),
            energy.par_chunks_mut(GRAIN),
            rate.par_chunks_mut(GRAIN),
        )
            .into_par_iter()
            .enumerate()
            // same bits in any order: exact sums are integers, and smallest numbers are one
            .fold(
                none,
                |(mut work, mut ballot, mut span), (chunk, (v, e, de))| {
                    for k in 0..v.len() {
                        let i = chunk * GRAIN + k;
                        let (contact, drive) = outside(i);
                        let a = &store.acceleration[i];
                        let forces = kick.total(a, &contact);
                        let mut total = forces;
                        drive.steer(Goal::End, &v[k], per_half, &mut total);
                        v[k] = add_scaled(&v[k], half, &total);
                        drive.set(Goal::End, &mut v[k]);
                        span.add(&store.position[i], &v[k]);
                        if contact != [0.0; 3] {
                            let mut mean = add_scaled(&v[k], -0.25 * dt, &forces);
                            drive.correct_mean(&v[k], &mut mean);
                            work.add(half * store.mass[i] * dot(&contact, &mean));
                        }
                        let v_p = &store.predicted_velocity[i];
                        let late = add_scaled(&v[k], -1.0, v_p);
                        de[k] -= dot(a, &late);
                        e[k] += half * (de[k] + 0.25 * dt * dot(a, &total));
                        if !drive.is_rigid() {
                            let moved = Moved {
                                velocity: v[k],
                                energy: e[k],
                                contact,
                            };
                            voter.ask(i, &moved, &mut ballot);
                        }
                    }
                    (work, ballot, span)
                },
            )
            // same bits in any order, as above
            .reduce(none, |(work, ballot, mut span), (other, others, beyond)| {
                span.join(&beyond);
                (merged(work, other), ballot.min(others), span)
            });
        self.store.velocity = velocity;
        self.store.specific_energy = energy;
        self.store.d_specific_energy_dt = rate;
        (work, ballot.vote(), span)
    }
}

/// A half kick.
#[derive(Debug, Clone, Copy)]
struct Kick {
    /// The whole step (s).
    dt: f64,
    gravity: [f64; 3],
}

impl Kick {
    /// Acceleration (m/s²) by stress, contact and gravity.
    #[inline(always)]
    fn total(&self, stress: &[f64; 3], contact: &[f64; 3]) -> [f64; 3] {
        add(stress, &add(contact, &self.gravity))
    }
}

#[allow(clippy::needless_pass_by_value, reason = "the form of a reduction")]
fn merged(mut all: ExactSum, part: ExactSum) -> ExactSum {
    all.merge(&part);
    all
}
