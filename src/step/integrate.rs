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

use super::search::GRAIN;
use super::simulation::Simulation;
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

fn add_scaled(v: &[f64; 3], factor: f64, a: &[f64; 3], b: &[f64; 3]) -> [f64; 3] {
    std::array::from_fn(|k| v[k] + factor * (a[k] + b[k]))
}

impl Simulation {
    /// First half kick and drift of a step `dt` (s), and the predictions for its end.
    pub(super) fn kick_and_drift(&mut self, dt: f64) {
        self.book_contact_work(dt, 0.25 * dt);
        self.book_plane_force(dt);
        let rule = SmoothingRule::new(self.case.sph.smoothing_length, self.case.dimension);
        let (contact, reference_h) = (&self.contact, &self.reference_h);
        let half = 0.5 * dt;
        self.store.resize_halo(0);
        let store = &mut self.store;
        (
            &mut store.velocity,
            &mut store.specific_energy,
            &mut store.position,
            &mut store.predicted_velocity,
            &mut store.predicted_density,
            &mut store.smoothing_length,
            (
                &store.acceleration,
                &store.contact_acceleration,
                &store.d_specific_energy_dt,
                &store.velocity_gradient,
                &store.density,
                &store.body,
            ),
        )
            .into_par_iter()
            .with_min_len(GRAIN)
            .for_each(|(v, e, x, v_p, rho_p, h, (a, c, de, l, &rho, &body))| {
                let total = [a[0] + c[0], a[1] + c[1], a[2] + c[2]];
                *e += half * (de - 0.25 * dt * dot(a, &total));
                *v = add_scaled(v, half, a, c);
                for k in 0..3 {
                    x[k] += dt * v[k];
                }
                *v_p = add_scaled(v, half, a, c);
                let strain = half * (l[0] + l[4] + l[8]);
                *rho_p = rho * ((1.0 - strain) / (1.0 + strain));
                let reference = 1.0 / contact.inverse_density(body as usize);
                *h = rule.length(reference_h[body as usize], reference / *rho_p);
            });
        self.fold_at_planes();
    }

    /// Particles that crossed a symmetry plane change places with their images.
    fn fold_at_planes(&mut self) {
        let mirrors = *self.halo.mirrors();
        if mirrors.is_empty() {
            return;
        }
        for i in 0..self.store.owned() {
            let before = self.store.velocity[i];
            if mirrors.fold(&mut self.store, i) != 0 {
                let after = self.store.velocity[i];
                let mass = self.store.mass[i];
                for a in 0..3 {
                    self.sums.crossing_impulse[a].add(mass * (after[a] - before[a]));
                }
            }
        }
    }

    /// Second half kick of a step `dt` (s); zero at the start of a case.
    pub(super) fn kick(&mut self, dt: f64) {
        let half = 0.5 * dt;
        let owned = self.store.owned();
        let store = &mut self.store;
        (
            &mut store.velocity,
            &mut store.specific_energy,
            &mut store.d_specific_energy_dt,
            &store.acceleration,
            &store.contact_acceleration,
            &store.predicted_velocity[..owned],
        )
            .into_par_iter()
            .with_min_len(GRAIN)
            .for_each(|(v, e, de, a, c, v_p)| {
                let total = [a[0] + c[0], a[1] + c[1], a[2] + c[2]];
                *v = add_scaled(v, half, a, c);
                let late = [v[0] - v_p[0], v[1] - v_p[1], v[2] - v_p[2]];
                *de -= dot(a, &late);
                *e += half * (*de + 0.25 * dt * dot(a, &total));
            });
        self.book_contact_work(dt, -0.25 * dt);
    }

    /// Books the work of contact in a half kick of a step `dt`, in which the mean velocity is
    /// the velocity of a whole step plus `shift` (s) times the acceleration.
    fn book_contact_work(&mut self, dt: f64, shift: f64) {
        if !self.contact.is_active() {
            return;
        }
        let store = &self.store;
        for i in 0..store.owned() {
            let c = &store.contact_acceleration[i];
            if *c != [0.0; 3] {
                let mean = add_scaled(&store.velocity[i], shift, &store.acceleration[i], c);
                self.sums
                    .contact_work
                    .add(0.5 * dt * store.mass[i] * dot(c, &mean));
            }
        }
    }
}
