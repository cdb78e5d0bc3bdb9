//! The impact of two elastic bars in uniaxial strain with the program's own laws: the first shocks
//! and the release fan behind them, in closed form.

use exact::bisect;
use exact::finite_strain::Medium;

/// The state behind a shock into a [`Medium`] at rest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shock {
    /// Velocity of the material behind the shock, relative to the medium ahead (m/s).
    pub particle_velocity: f64,
    /// Stretch λ = ρ₀/ρ.
    pub stretch: f64,
    /// Stress along the bar, tension positive (Pa).
    pub stress: f64,
    /// Speed of the shock in reference coordinates (m/s).
    pub speed: f64,
}

/// When a release fan passes a place (s).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fan {
    /// First characteristic: the shocked state ends.
    pub head: f64,
    /// Last characteristic: without stress from here on.
    pub tail: f64,
}

/// The impact of two media.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Impact {
    /// Stress at the interface, tension positive (Pa).
    pub stress: f64,
    /// Velocity of the interface (m/s).
    pub interface_velocity: f64,
    /// The shocks that run into the left and the right medium, away from the interface.
    pub shocks: [Shock; 2],
}

/// The shock into a [`Medium`] at rest, and its release.
pub trait Shocks {
    /// The shock that drives the medium to `particle_velocity` (m/s, > 0).
    fn shock(&self, particle_velocity: f64) -> Shock;

    /// Velocity that a free end gains when a shock is released there (m/s); it then moves at
    /// the particle velocity and this.
    fn release_velocity(&self, shock: &Shock) -> f64;

    /// When the fan that the free end of a bar of `length` (m, in reference coordinates) sends
    /// back passes the end where the shock began at t = 0: each characteristic straight, as it
    /// is in the shocked state. What the end itself sends into the fan bends those after the
    /// first, by less than the fan's own share of the way.
    fn release(&self, shock: &Shock, length: f64) -> Fan;
}

impl Shocks for Medium {
    fn shock(&self, particle_velocity: f64) -> Shock {
        let u = particle_velocity;
        let wanted = self.reference_density * u * u;
        // −σ (1 − λ) falls from infinity to 0 as λ goes from 0 to 1.
        let stretch = bisect(0.0, 1.0, |stretch| {
            wanted + self.stress(stretch) * (1.0 - stretch)
        });
        Shock {
            particle_velocity: u,
            stretch,
            stress: self.stress(stretch),
            speed: u / (1.0 - stretch),
        }
    }

    fn release_velocity(&self, shock: &Shock) -> f64 {
        -self.riemann_integral(shock.stretch)
    }

    fn release(&self, shock: &Shock, length: f64) -> Fan {
        let reaches_the_end = length / shock.speed;
        Fan {
            head: reaches_the_end + length / self.wave_speed(shock.stretch),
            tail: reaches_the_end + length / self.wave_speed(1.0),
        }
    }
}

/// The impact of two media with velocities (m/s), the left one the faster.
pub fn impact(media: [&Medium; 2], velocities: [f64; 2]) -> Impact {
    let closing = velocities[0] - velocities[1];
    // What the right medium takes of the closing velocity; −σ on its side rises with it.
    let right = bisect(0.0, closing, |u| {
        media[0].shock(closing - u).stress - media[1].shock(u).stress
    });
    let shocks = [media[0].shock(closing - right), media[1].shock(right)];
    Impact {
        stress: shocks[1].stress,
        interface_velocity: velocities[1] + right,
        shocks,
    }
}
