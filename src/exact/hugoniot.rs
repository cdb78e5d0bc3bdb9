//! Plane impact of Mie–Grüneisen materials without strength: shock states, the match of pressure
//! and velocity at the interface.
//!
//! With shock speed U, particle velocity u and `η = u/U = 1 − ρ₀/ρ`, the Hugoniot of the material
//! `U = c₀ + [s₁ + s₂ η + s₃ η²] u` gives `u = c₀ η/K`, `U = c₀/K`, `K = 1 − s₁ η − s₂ η² − s₃ η³`.
//! Jump conditions (Rankine–Hugoniot) for a material at rest without pressure:
//! `p = ρ₀ U u`, `e = u²/2`. The pressure agrees with [`MieGruneisen::response`] at `(ρ, e)` as
//! long as that has not reached its bounds at strong compression.

use super::bisect;
use material::{Eos, Material, MieGruneisen};

/// A medium at rest at its reference density, without pressure or energy.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Medium {
    /// Reference density ρ₀ (kg/m³).
    pub reference_density: f64,
    /// Equation of state.
    pub eos: MieGruneisen,
}

/// The state behind a single shock into a [`Medium`] at rest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shock {
    /// Velocity of the material behind the shock, relative to the medium ahead (m/s).
    pub particle_velocity: f64,
    /// Speed of the shock relative to the medium ahead (m/s).
    pub shock_speed: f64,
    /// Pressure (Pa).
    pub pressure: f64,
    /// Density (kg/m³).
    pub density: f64,
    /// Specific internal energy (J/kg).
    pub specific_energy: f64,
}

/// The shock that drives a material, at rest in its reference state, to a particle velocity `u` (m/s). Strength and
/// failure are left out.
///
/// For equations of state other than Mie–Grüneisen, `η = u/U` is where the jump conditions
/// `p = p₀ + ρ₀ u²/η` and `e = e₀ + u²/2 + p₀ η/ρ₀` meet the equation of state. Pores crush in the shock; its elastic
/// precursor is left out.
#[must_use]
pub fn shock(material: &Material, u: f64) -> Shock {
    if let Some(medium) = Medium::of(material) {
        return medium.shock(u);
    }
    let rho0 = material.reference_density;
    let e0 = material.eos.reference_energy(rho0);
    let p0 = material.virgin(rho0, e0).pressure;
    let behind = |eta: f64| (rho0 / (1.0 - eta), e0 + 0.5 * u * u + p0 * eta / rho0);
    let eta = bisect(0.0, 1.0, |eta| {
        let (density, energy) = behind(eta);
        (material.loaded(density, energy).pressure - p0) * eta - rho0 * u * u
    });
    let (density, specific_energy) = behind(eta);
    let shock_speed = u / eta.max(f64::MIN_POSITIVE);
    Shock {
        particle_velocity: u,
        shock_speed,
        pressure: p0 + rho0 * shock_speed * u,
        density,
        specific_energy,
    }
}

/// The shocks in two materials that meet at `speed` (m/s, > 0): where both pressures agree.
#[must_use]
pub fn meeting([a, b]: [&Material; 2], speed: f64) -> [Shock; 2] {
    let u = bisect(0.0, speed, |u| {
        shock(a, u).pressure - shock(b, speed - u).pressure
    });
    [shock(a, u), shock(b, speed - u)]
}

/// The plane impact of a flyer on a target at rest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Impact {
    /// Pressure on both sides of the interface (Pa).
    pub pressure: f64,
    /// Velocity of the interface in the frame of the target (m/s).
    pub interface_velocity: f64,
    /// State of the flyer; its velocities are relative to the flyer and point away from the
    /// interface.
    pub flyer: Shock,
    /// State of the target.
    pub target: Shock,
}

impl Medium {
    /// The medium of a material, if its equation of state is Mie–Grüneisen, without pores. Strength and spall
    /// are left out.
    #[must_use]
    pub fn of(material: &Material) -> Option<Self> {
        match &material.eos {
            Eos::MieGruneisen(eos) if material.porosity.is_none() => Some(Self {
                reference_density: material.reference_density,
                eos: *eos,
            }),
            _ => None,
        }
    }

    /// The shock that drives the medium to `particle_velocity` (m/s, ≥ 0). A fit with `s₁ < 1`
    /// ends at `u = c₀/(1 − s₁)`, where the density becomes infinite.
    #[must_use]
    pub fn shock(&self, particle_velocity: f64) -> Shock {
        let u = particle_velocity;
        // c₀ η − u K(η) is −u at η = 0 and rises with η as K falls.
        let eta = bisect(0.0, 1.0, |eta| {
            self.eos.c0 * eta - u * self.denominator(eta)
        });
        let shock_speed = self.eos.c0 / self.denominator(eta);
        Shock {
            particle_velocity: u,
            shock_speed,
            pressure: self.reference_density * shock_speed * u,
            density: self.reference_density / (1.0 - eta),
            specific_energy: 0.5 * u * u,
        }
    }

    /// `K = 1 − s₁ η − s₂ η² − s₃ η³`.
    fn denominator(&self, eta: f64) -> f64 {
        1.0 - eta * (self.eos.s1 + eta * (self.eos.s2 + eta * self.eos.s3))
    }
}

/// The impact of a flyer at `speed` (m/s, > 0) on a target at rest.
#[must_use]
pub fn impact(flyer: &Medium, target: &Medium, speed: f64) -> Impact {
    let interface_velocity = bisect(0.0, speed, |u| {
        target.shock(u).pressure - flyer.shock(speed - u).pressure
    });
    let target = target.shock(interface_velocity);
    Impact {
        pressure: target.pressure,
        interface_velocity,
        flyer: flyer.shock(speed - interface_velocity),
        target,
    }
}
