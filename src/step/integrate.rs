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

use rayon::iter::repeat_n;
use rayon::prelude::*;

use super::loads::{Drive, Free, Goal, LoadStep};
use super::search::GRAIN;
use super::simulation::Simulation;
use crate::diagnose::exact_sum::ExactSum;
use crate::model::SmoothingLength;

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

fn dot(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
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
        self.book_contact_work(dt, 0.25 * dt);
        self.book_loads(dt, true);
        self.book_plane_force(dt);
        self.store.resize_halo(0);
        self.half_kick(dt, Goal::Middle);
        self.drift_with_neighbours(dt);
        self.drift_stress_points(dt);
        self.fold_at_planes();
    }

    /// One of the two half kicks of the particles, with all that acts on them beside stress.
    fn half_kick(&mut self, dt: f64, goal: Goal) {
        let contact = std::mem::take(&mut self.store.contact_acceleration);
        let owned = self.store.owned();
        let gravity = self.loads.gravity;
        if self.loads.drives() {
            let bits = std::mem::take(&mut self.store.load);
            let loads = std::mem::take(&mut self.loads);
            let outside = (0..owned).into_par_iter().map(|i| {
                let contact = contact.get(i).copied().unwrap_or_default();
                (add(&contact, &gravity), loads.of(bits[i]))
            });
            self.half_kick_by(dt, goal, outside);
            (self.store.load, self.loads) = (bits, loads);
        } else if self.contact.is_active() {
            let outside = contact.par_iter().map(|c| (add(c, &gravity), Free));
            self.half_kick_by(dt, goal, outside);
        } else {
            self.half_kick_by(dt, goal, repeat_n((gravity, Free), owned));
        }
        self.store.contact_acceleration = contact;
    }

    /// [`Self::half_kick`], given the accelerations by contact and gravity (m/s²) and loads.
    fn half_kick_by<D: Drive>(
        &mut self,
        dt: f64,
        goal: Goal,
        outside: impl IndexedParallelIterator<Item = ([f64; 3], D)>,
    ) {
        match goal {
            Goal::Middle => self.kick_and_drift_by(dt, outside),
            Goal::End => self.kick_by(dt, outside),
        }
    }

    /// [`Self::kick_and_drift`] of the particles.
    fn kick_and_drift_by<D: Drive>(
        &mut self,
        dt: f64,
        outside: impl IndexedParallelIterator<Item = ([f64; 3], D)>,
    ) {
        let rule = SmoothingRule::new(self.case.sph.smoothing_length, self.case.dimension);
        let (table, reference_h) = (&self.contact, &self.reference_h);
        let half = 0.5 * dt;
        let per_half = LoadStep::per_half(dt);
        let store = &mut self.store;
        (
            &mut store.velocity,
            &mut store.specific_energy,
            &mut store.position,
            &mut store.predicted_velocity,
            &mut store.predicted_density,
            &mut store.smoothing_length,
            outside,
            (
                &store.acceleration,
                &store.d_specific_energy_dt,
                &store.velocity_gradient,
                &store.density,
                &store.body,
            ),
        )
            .into_par_iter()
            .with_min_len(GRAIN)
            .for_each(
                |(v, e, x, v_p, rho_p, h, (o, drive), (a, de, l, &rho, &body))| {
                    let mut total = add(a, &o);
                    drive.steer(Goal::Middle, v, per_half, &mut total);
                    *e += half * (de - 0.25 * dt * dot(a, &total));
                    *v = add_scaled(v, half, &total);
                    drive.set(Goal::Middle, v);
                    for k in 0..3 {
                        x[k] += dt * v[k];
                    }
                    *v_p = add_scaled(v, half, &total);
                    drive.set(Goal::End, v_p);
                    let strain = half * (l[0] + l[4] + l[8]);
                    *rho_p = rho * ((1.0 - strain) / (1.0 + strain));
                    let reference = 1.0 / table.inverse_density(body as usize);
                    *h = rule.length(reference_h[body as usize], reference / *rho_p);
                },
            );
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

    /// Second half kick of a step `dt` (s); zero at the start of a case.
    pub(super) fn kick(&mut self, dt: f64) {
        self.half_kick(dt, Goal::End);
        self.book_contact_work(dt, -0.25 * dt);
        self.book_loads(dt, false);
    }

    /// [`Self::kick`] of the particles.
    fn kick_by<D: Drive>(
        &mut self,
        dt: f64,
        outside: impl IndexedParallelIterator<Item = ([f64; 3], D)>,
    ) {
        let half = 0.5 * dt;
        let per_half = LoadStep::per_half(dt);
        let owned = self.store.owned();
        let store = &mut self.store;
        (
            &mut store.velocity,
            &mut store.specific_energy,
            &mut store.d_specific_energy_dt,
            &store.acceleration,
            outside,
            &store.predicted_velocity[..owned],
        )
            .into_par_iter()
            .with_min_len(GRAIN)
            .for_each(|(v, e, de, a, (o, drive), v_p)| {
                let mut total = add(a, &o);
                drive.steer(Goal::End, v, per_half, &mut total);
                *v = add_scaled(v, half, &total);
                drive.set(Goal::End, v);
                let late = [v[0] - v_p[0], v[1] - v_p[1], v[2] - v_p[2]];
                *de -= dot(a, &late);
                *e += half * (*de + 0.25 * dt * dot(a, &total));
            });
    }

    /// Books the work of contact in a half kick of a step `dt`, in which the mean velocity is
    /// the velocity of a whole step plus `shift` (s) times the acceleration.
    fn book_contact_work(&mut self, dt: f64, shift: f64) {
        if !self.contact.is_active() {
            return;
        }
        let (store, loads, gravity) = (&self.store, &self.loads, self.loads.gravity);
        let work = (store.contact_acceleration.par_chunks(GRAIN).enumerate())
            // same bits in any order: exact sums are integers
            .fold(ExactSum::default, |mut work, (chunk, accelerations)| {
                for (k, c) in accelerations.iter().enumerate() {
                    if *c == [0.0; 3] {
                        continue;
                    }
                    let i = chunk * GRAIN + k;
                    let total = add(&store.acceleration[i], &add(c, &gravity));
                    let mut mean = add_scaled(&store.velocity[i], shift, &total);
                    if let Some(&bits) = store.load.get(i) {
                        loads.correct_mean(bits, &store.velocity[i], &mut mean);
                    }
                    work.add(0.5 * dt * store.mass[i] * dot(c, &mean));
                }
                work
            })
            // same bits in any order, as above
            .reduce(ExactSum::default, |mut all, part| {
                all.merge(&part);
                all
            });
        self.sums.contact_work.merge(&work);
    }
}
