//! Coulomb friction and damping at a point: a spring that sticks up to a limit, and a dashpot
//! (theory page "Contact").
//!
//! The spring is that of Cundall & Strack (1979), "A discrete numerical model for granular
//! assemblies", with a static and a kinetic limit: what is beyond the limit slips. With the slip
//! `ξ` at two steps, the way `Δ` between them and what slips of it, `s = ξ_n + Δ − ξ_{n+1}`, the
//! power `½ k (ξ_n + ξ_{n+1})·s/Δt` becomes heat, so that work, energy of the spring and heat
//! balance exactly in each step.

use numerics::vector::dot;

/// Coefficients of one particle; of springs and dashpots also over volume, of a pair of bodies or
/// of a body on a rigid surface.
#[derive(Debug, Clone, Copy, Default)]
pub struct Law {
    /// Coefficient of friction while it sticks.
    pub static_friction: f64,
    /// Coefficient of friction while it slides.
    pub kinetic_friction: f64,
    /// Of the spring (N/m).
    pub stiffness: f64,
    /// Of the dashpot (N s/m).
    pub dashpot: f64,
}

/// Friction slip, which is state from step to step.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Slip {
    /// Elastic tangential displacement (m).
    pub displacement: [f64; 3],
    /// Tangential velocity (m/s).
    pub rate: [f64; 3],
    /// True if the kinetic limit holds, until the velocity turns against the slip.
    pub sliding: bool,
}

/// Effects of friction and damping.
#[derive(Debug, Clone, Copy, Default)]
pub struct Friction {
    /// Force on the particle (N).
    pub force: [f64; 3],
    /// The slip after the step.
    pub slip: Slip,
    /// Heat (W).
    pub power: f64,
    /// Energy of the spring (J).
    pub energy: f64,
}

/// The part of `v` that is normal to the unit vector `n`.
fn tangential(v: &[f64; 3], n: &[f64; 3]) -> [f64; 3] {
    let along = dot(v, n);
    std::array::from_fn(|a| v[a] - along * n[a])
}

/// `v` turned into the plane normal to `n`, as long as before.
fn turned(v: &[f64; 3], n: &[f64; 3]) -> [f64; 3] {
    let flat = tangential(v, n);
    let (was, is) = (dot(v, v), dot(&flat, &flat));
    if is <= 0.0 {
        return [0.0; 3];
    }
    let longer = (was / is).sqrt();
    flat.map(|x| x * longer)
}

impl Law {
    /// True if there is any friction or damping.
    #[inline]
    #[must_use]
    pub fn is_any(&self) -> bool {
        self.static_friction > 0.0 || self.dashpot > 0.0
    }

    /// That of a volume, of one over volume.
    #[must_use]
    pub fn of_volume(mut self, volume: f64) -> Self {
        self.stiffness *= volume;
        self.dashpot *= volume;
        self
    }

    /// Adds `weight` times another.
    pub fn add(&mut self, weight: f64, other: &Self) {
        self.static_friction += weight * other.static_friction;
        self.kinetic_friction += weight * other.kinetic_friction;
        self.stiffness += weight * other.stiffness;
        self.dashpot += weight * other.dashpot;
    }

    /// All coefficients over `weights`.
    #[must_use]
    pub fn over(&self, weights: f64) -> Self {
        Self {
            static_friction: self.static_friction / weights,
            kinetic_friction: self.kinetic_friction / weights,
            stiffness: self.stiffness / weights,
            dashpot: self.dashpot / weights,
        }
    }

    /// A step of `dt` (s; zero at the start of a case) under the contact force `pressing` (N) on a
    /// face of the unit normal `normal`, which points into the particle, at the velocity `velocity`
    /// (m/s) against what it lies on.
    ///
    /// The dashpot acts along `pressing` and never by more than that, so that contact does not
    /// pull; friction rests on both together.
    #[must_use]
    pub fn step(
        &self,
        before: &Slip,
        pressing: &[f64; 3],
        normal: &[f64; 3],
        velocity: &[f64; 3],
        dt: f64,
    ) -> Friction {
        let size = dot(pressing, pressing).sqrt();
        let per_size = if size > 0.0 { 1.0 / size } else { 0.0 };
        let approach = -dot(velocity, pressing) * per_size;
        let push = (self.dashpot * approach).clamp(-size, size);
        let load = dot(pressing, normal).max(0.0) * (1.0 + push * per_size);
        let rate = tangential(velocity, normal);
        let held = turned(&before.displacement, normal);
        let last = turned(&before.rate, normal);
        let wanted: [f64; 3] = std::array::from_fn(|a| held[a] + 0.5 * dt * (last[a] + rate[a]));
        let size = dot(&wanted, &wanted).sqrt();
        let turns_back = dot(&wanted, &rate) <= 0.0;
        let breaks = self.stiffness * size > self.static_friction * load;
        let sliding = breaks || (before.sliding && !turns_back);
        let friction = if sliding {
            self.kinetic_friction
        } else {
            self.static_friction
        };
        let (limit, pull) = (friction * load, self.stiffness * size);
        let kept = if pull > limit { limit / pull } else { 1.0 };
        let slip = wanted.map(|x| x * kept);
        let per_second = if dt > 0.0 { 1.0 / dt } else { 0.0 };
        let lost: f64 = (0..3)
            .map(|a| (held[a] + slip[a]) * (wanted[a] - slip[a]))
            .sum();
        let mut resisting = Friction {
            force: slip.map(|x| -self.stiffness * x),
            slip: Slip {
                displacement: slip,
                rate,
                sliding,
            },
            power: 0.5 * self.stiffness * lost * per_second,
            energy: 0.5 * self.stiffness * dot(&slip, &slip),
        };
        let left = if sliding { 0.0 } else { limit - kept * pull };
        let speed = dot(&rate, &rate).sqrt();
        let drag = (self.dashpot * speed).min(left);
        let per_speed = if speed > 0.0 { drag / speed } else { 0.0 };
        for a in 0..3 {
            resisting.force[a] += push * per_size * pressing[a] - per_speed * rate[a];
        }
        resisting.power += drag * speed + push * approach;
        resisting
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LAW: Law = Law {
        static_friction: 0.4,
        kinetic_friction: 0.3,
        stiffness: 1e6,
        dashpot: 0.0,
    };

    /// A point that is dragged along a path: work on it, energy of the spring and heat balance;
    /// it sticks up to the static limit and slides at the kinetic one.
    #[test]
    fn work_becomes_energy_of_the_spring_and_heat() {
        let (load, dt, normal) = ([0.0, 0.0, 10.0], 1e-3, [0.0, 0.0, 1.0]);
        let mut slip = Slip::default();
        let (mut work, mut heat, mut most) = (0.0, 0.0, 0.0_f64);
        let mut last = Friction::default();
        for step in 0..400 {
            let angle = 0.02 * f64::from(step);
            let velocity = [4e-4 * angle.cos(), 3e-4 * angle.sin(), 1.0];
            let friction = LAW.step(&slip, &load, &normal, &velocity, dt);
            for a in 0..2 {
                let way = 0.5 * dt * (slip.rate[a] + friction.slip.rate[a]);
                work += 0.5 * (last.force[a] + friction.force[a]) * way;
            }
            heat += friction.power * dt;
            most = most.max(dot(&friction.force, &friction.force).sqrt());
            assert!(friction.force[2] == 0.0 && friction.power >= 0.0);
            (slip, last) = (friction.slip, friction);
        }
        assert!(heat > 0.0 && (work + last.energy + heat).abs() < 1e-12 * heat);
        // Half a newton in a step.
        assert!((3.5..=4.0).contains(&most), "{most}");
        assert!(slip.sliding);
        assert!((dot(&last.force, &last.force).sqrt() - 3.0).abs() < 1e-12);
        // It stops, is pushed back, and sticks again.
        let back = LAW.step(&slip, &load, &normal, &last.force.map(|f| 1e-5 * f), dt);
        assert!(!back.slip.sliding && back.power == 0.0);
        // The load goes: what the spring held becomes heat.
        let free = LAW.step(&back.slip, &[0.0; 3], &normal, &[0.0; 3], dt);
        assert!(free.force == [0.0; 3] && free.power > 0.0);
    }

    /// The dashpot takes energy out and never pulls bodies together.
    #[test]
    fn damping_never_pulls() {
        let law = Law {
            dashpot: 100.0,
            ..LAW
        };
        for speed in [-1.0, -0.05, 0.02, 0.3] {
            let friction = law.step(
                &Slip::default(),
                &[4.0, 0.0, 0.0],
                &[1.0, 0.0, 0.0],
                &[speed, 0.0, 0.0],
                1e-3,
            );
            assert!((friction.force[0] + (100.0 * speed).clamp(-4.0, 4.0)).abs() < 1e-14);
            assert!((friction.power + friction.force[0] * speed).abs() < 1e-14);
        }
        let friction = law.step(
            &Slip::default(),
            &[10.0, 0.0, 0.0],
            &[1.0, 0.0, 0.0],
            &[0.0, 0.01, 0.0],
            0.0,
        );
        assert_eq!(friction.force, [0.0, -1.0, 0.0]);
    }
}
