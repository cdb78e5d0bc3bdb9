//! Noh's implosion: cold gas that runs towards a plane, an axis or a point at one speed.
//!
//! Behind a shock that moves out at `s = (γ − 1)/2 |v|` the gas is at rest with
//! `ρ = ρ₀ ((γ + 1)/(γ − 1))^d`, `e = v²/2`, `p = (γ − 1) ρ e`; ahead of it
//! `ρ = ρ₀ (1 + |v| t/r)^{d−1}`, without pressure. Source: Noh (1987), *Errors for calculations of
//! strong shocks using an artificial viscosity and an artificial heat flux*, J. Comput. Phys. 72,
//! 78, section 4.

use exact::Sample;

/// The implosion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Noh {
    /// Dimension d: 1 plane, 2 cylinder, 3 sphere.
    pub dimension: u8,
    /// Ratio of specific heats γ > 1.
    pub gamma: f64,
    /// Density at the start ρ₀ (kg/m³).
    pub density: f64,
    /// Speed towards the centre |v| (m/s).
    pub speed: f64,
}

impl Noh {
    /// Speed of the shock (m/s).
    #[must_use]
    pub fn shock_speed(&self) -> f64 {
        0.5 * (self.gamma - 1.0) * self.speed
    }

    /// The state at a distance from the centre (m) and a time (s); the velocity is outwards.
    #[must_use]
    pub fn at(&self, radius: f64, time: f64) -> Sample {
        let v = self.speed;
        if radius < self.shock_speed() * time {
            let ratio = (self.gamma + 1.0) / (self.gamma - 1.0);
            let density = self.density * ratio.powi(i32::from(self.dimension));
            let specific_energy = 0.5 * v * v;
            Sample {
                position: radius,
                velocity: 0.0,
                density,
                pressure: (self.gamma - 1.0) * density * specific_energy,
                deviatoric_stress: 0.0,
                specific_energy,
            }
        } else {
            let converged = 1.0 + v * time / radius;
            Sample {
                position: radius,
                velocity: -v,
                density: self.density * converged.powi(i32::from(self.dimension) - 1),
                pressure: 0.0,
                deviatoric_stress: 0.0,
                specific_energy: 0.0,
            }
        }
    }

    /// The states from the centre to a radius (m), with both sides of the shock.
    #[must_use]
    pub fn profile(&self, time: f64, radius: f64) -> Vec<Sample> {
        const AHEAD: u32 = 200;
        let shock = self.shock_speed() * time;
        let mut line = Vec::new();
        if shock > 0.0 {
            let inside = self.at(0.0, time);
            line.extend([inside, inside.at(shock.min(radius))]);
        }
        if shock < radius {
            let from = if shock > 0.0 { shock } else { 1e-6 * radius };
            let step = (radius - from) / f64::from(AHEAD);
            line.extend((0..=AHEAD).map(|k| self.at(from + f64::from(k) * step, time)));
        }
        line
    }
}
