//! The Riemann problem of an ideal gas, exact.
//!
//! Two uniform states, apart until t = 0; what follows depends on x/t alone: a shock or a
//! rarefaction on either side of a star region of one pressure and velocity, with a contact in
//! it. Formulas, in the notation of the code: Toro (2009), *Riemann Solvers and Numerical Methods
//! for Fluid Dynamics*, 3rd ed., chapter 4: pressure function eqs. 4.5–4.7, its root found here by
//! bisection, star densities 4.50, 4.53, 4.57, 4.60, sampling 4.56 and 4.63. Gas without pressure
//! is allowed: it is met by a shock or stays as it is.

use super::{Sample, bisect};

/// A uniform state of gas.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gas {
    /// Density ρ > 0 (kg/m³).
    pub density: f64,
    /// Velocity u (m/s).
    pub velocity: f64,
    /// Pressure p ≥ 0 (Pa).
    pub pressure: f64,
}

/// The solution between two states.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Riemann {
    /// Ratio of specific heats γ > 1.
    pub gamma: f64,
    /// States at the start, left and right.
    pub sides: [Gas; 2],
    /// Pressure between the waves (Pa).
    pub star_pressure: f64,
    /// Velocity between the waves (m/s).
    pub star_velocity: f64,
    /// Densities between the waves, left and right of the contact (kg/m³).
    pub star_densities: [f64; 2],
}

/// Velocities of the ends of a wave (m/s), the outer one first; equal for a shock.
type Wave = [f64; 2];

impl Riemann {
    /// Solves the problem for a ratio of specific heats; `None` if the gases part so fast that
    /// a vacuum opens between them.
    #[must_use]
    pub fn new(gamma: f64, left: Gas, right: Gas) -> Option<Self> {
        let closing = left.velocity - right.velocity;
        let change = |p: f64| velocity_change(gamma, &left, p) + velocity_change(gamma, &right, p);
        if change(0.0) >= closing {
            return None;
        }
        let mut high = left.pressure.max(right.pressure).max(f64::MIN_POSITIVE);
        while change(high) < closing {
            high *= 2.0;
        }
        let p = bisect(0.0, high, |p| change(p) - closing);
        let difference = velocity_change(gamma, &right, p) - velocity_change(gamma, &left, p);
        Some(Self {
            gamma,
            sides: [left, right],
            star_pressure: p,
            star_velocity: 0.5 * (left.velocity + right.velocity + difference),
            star_densities: [&left, &right].map(|side| star_density(gamma, side, p)),
        })
    }

    /// The state where `x/t` is `speed` (m/s).
    #[must_use]
    pub fn at(&self, speed: f64) -> Gas {
        let k = usize::from(speed > self.star_velocity);
        let (side, sign) = (&self.sides[k], [-1.0, 1.0][k]);
        let [outer, inner] = self.waves()[k];
        if sign * speed >= sign * outer {
            return *side;
        }
        if sign * speed <= sign * inner {
            return self.star(k);
        }
        // Inside a rarefaction the speed of sound is linear in x/t.
        let g = self.gamma;
        let c = sound_speed(g, side);
        let inside = 2.0 * c + sign * (g - 1.0) * (speed - side.velocity);
        let ratio = inside / ((g + 1.0) * c);
        let density = side.density * libm::pow(ratio, 2.0 / (g - 1.0));
        Gas {
            density,
            velocity: speed - sign * ratio * c,
            pressure: side.pressure * libm::pow(ratio, 2.0 * g / (g - 1.0)),
        }
    }

    /// The states between `from` and `to` (m) at time `t` (s), for a diaphragm at `origin` (m).
    #[must_use]
    pub fn profile(&self, origin: f64, t: f64, [from, to]: [f64; 2]) -> Vec<Sample> {
        let edges = if t > 0.0 {
            self.edges()
        } else {
            self.sides.map(|side| (0.0, side)).to_vec()
        };
        let inside = edges
            .into_iter()
            .map(|(speed, gas)| (origin + speed * t, gas));
        let inside = inside.filter(|&(x, _)| x > from && x < to);
        // Without any time yet the speed is infinite: the states of the sides.
        let ends = [from, to].map(|x| (x, self.at((x - origin) / t.max(0.0))));
        let all = [ends[0]].into_iter().chain(inside).chain([ends[1]]);
        all.map(|(x, gas)| self.sample(x, &gas)).collect()
    }

    /// Both sides of each jump and kink, and points within rarefactions: speeds x/t (m/s), rising,
    /// and states.
    fn edges(&self) -> Vec<(f64, Gas)> {
        const IN_FAN: u32 = 100;
        let mut edges = Vec::new();
        for (k, [outer, inner]) in self.waves().into_iter().enumerate() {
            let fan = if outer == inner { 0..0 } else { 1..IN_FAN };
            let share = |i: u32| f64::from(i) / f64::from(IN_FAN);
            let mut wave = vec![(outer, self.sides[k])];
            wave.extend(fan.map(|i| {
                let speed = outer + (inner - outer) * share(i);
                (speed, self.at(speed))
            }));
            wave.extend([(inner, self.star(k)), (self.star_velocity, self.star(k))]);
            if k == 1 {
                wave.reverse();
            }
            edges.extend(wave);
        }
        edges
    }

    /// The state between the waves, left (0) or right (1) of the contact.
    fn star(&self, side: usize) -> Gas {
        Gas {
            density: self.star_densities[side],
            velocity: self.star_velocity,
            pressure: self.star_pressure,
        }
    }

    fn sample(&self, position: f64, gas: &Gas) -> Sample {
        Sample {
            position,
            velocity: gas.velocity,
            density: gas.density,
            pressure: gas.pressure,
            deviatoric_stress: 0.0,
            specific_energy: gas.pressure / ((self.gamma - 1.0) * gas.density),
        }
    }

    /// Velocities of both waves, left and right.
    #[must_use]
    pub fn waves(&self) -> [Wave; 2] {
        let wave = |k: usize, sign: f64| {
            let (side, p, g) = (&self.sides[k], self.star_pressure, self.gamma);
            if p > side.pressure {
                // ρ (S − u) is the mass flux through the shock.
                let [a, b] = shock_constants(g, side);
                let speed = side.velocity + sign * ((p + b) / a).sqrt() / side.density;
                [speed; 2]
            } else {
                [side, &self.star(k)].map(|gas| gas.velocity + sign * sound_speed(g, gas))
            }
        };
        [wave(0, -1.0), wave(1, 1.0)]
    }
}

fn sound_speed(gamma: f64, gas: &Gas) -> f64 {
    (gamma * gas.pressure / gas.density).sqrt()
}

/// A and B of Toro's eq. 4.8.
fn shock_constants(gamma: f64, side: &Gas) -> [f64; 2] {
    let a = 2.0 / ((gamma + 1.0) * side.density);
    [a, (gamma - 1.0) / (gamma + 1.0) * side.pressure]
}

/// Change of velocity of a side (m/s) by a wave to pressure `p` (Pa), Toro's eqs. 4.6
/// and 4.7.
fn velocity_change(gamma: f64, side: &Gas, p: f64) -> f64 {
    if p > side.pressure {
        let [a, b] = shock_constants(gamma, side);
        (p - side.pressure) * (a / (p + b)).sqrt()
    } else if side.pressure > 0.0 {
        let power = (gamma - 1.0) / (2.0 * gamma);
        let ratio = libm::pow(p / side.pressure, power);
        2.0 * sound_speed(gamma, side) / (gamma - 1.0) * (ratio - 1.0)
    } else {
        0.0
    }
}

fn star_density(gamma: f64, side: &Gas, p: f64) -> f64 {
    if p > side.pressure {
        let ratio = (gamma - 1.0) / (gamma + 1.0);
        side.density * (p + ratio * side.pressure) / (ratio * p + side.pressure)
    } else if side.pressure > 0.0 {
        side.density * libm::pow(p / side.pressure, 1.0 / gamma)
    } else {
        side.density
    }
}
