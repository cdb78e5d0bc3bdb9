//! Numerical failure limits: who left them.
//!
//! The check is part of the choice of a step, for which the last kick of a step takes of each
//! particle. What is NaN can be neither booked nor kept from its neighbours, so it always ends the
//! run; what is out of range but finite may be removed.

use super::instability;
use comm::Comm;
use model::readable::{short, shown};
use model::{Case, NumericalLimits};
use numerics::vector::square;

/// Numerical failure of a particle, the worst first.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NumericalFailure {
    /// A number is none.
    NotFinite,
    /// The density left its range.
    Density,
    /// The specific energy left its range.
    Energy,
    /// The speed left its range.
    Speed,
    /// It asks for a time step below the floor.
    Step,
    /// It is the fastest of a model whose kinetic energy has come from nowhere.
    Gain,
}

impl NumericalFailure {
    /// Failures that a particle may report, in the order of candidates.
    pub const ALL: [Self; 5] = [
        Self::NotFinite,
        Self::Density,
        Self::Energy,
        Self::Speed,
        Self::Step,
    ];

    /// True if taking particles out is no cure: what is NaN has reached its neighbours, and
    /// energy that comes from nowhere is everybody's.
    #[must_use]
    pub fn is_of_all(self) -> bool {
        matches!(self, Self::NotFinite | Self::Gain)
    }

    /// The failure in words, with the key of its limit.
    #[must_use]
    pub fn describe(self, limits: &NumericalLimits) -> String {
        match self {
            Self::NotFinite => "has a non-finite or absurd state".to_owned(),
            Self::Density => format!(
                "has a density outside of {} to {} of that at the start \
                 (numerical_limits.density_min, density_max)",
                short(limits.density_min),
                short(limits.density_max)
            ),
            Self::Energy => format!(
                "has a specific energy beyond {} (numerical_limits.energy_max)",
                shown(limits.energy_max, "J/kg")
            ),
            Self::Speed => format!(
                "is faster than {} (numerical_limits.speed_max)",
                shown(limits.speed_max, "m/s")
            ),
            Self::Step => format!(
                "asks for a time step below {} (numerical_limits.step_min)",
                shown(limits.step_min, "s")
            ),
            Self::Gain => format!(
                "is the fastest where the kinetic energy of all is beyond {} times the energy that \
                 there was or has been put in: the sums are not stable, more viscosity (sph.alpha) or \
                 shorter steps (time_step) may help (numerical_limits.gain_max)",
                short(limits.gain_max)
            ),
        }
    }
}

/// State of a particle that a kick has at hand: velocity (m/s), specific energy (J/kg),
/// acceleration by contact (m/s²).
pub(crate) struct Moved {
    pub velocity: [f64; 3],
    pub energy: f64,
    pub contact: [f64; 3],
}

/// The ranges of a case, by body where they depend on it.
pub(crate) struct Limits {
    speed2_max: f64,
    energy_max: f64,
    pub step_min: f64,
    /// Energy at the start that no sum shows (J).
    pub hidden_energy: f64,
    /// Smallest and largest density of each body (kg/m³).
    density: Vec<[f64; 2]>,
    /// Densities that are in range for all bodies (kg/m³).
    common_density: [f64; 2],
}

impl Limits {
    /// Of a case. Collective.
    pub(crate) fn new(case: &Case, comm: &Comm) -> Self {
        let limits = &case.numerical_limits;
        let range = |body| {
            let first = case.initial_density(body);
            [limits.density_min * first, limits.density_max * first]
        };
        let density: Vec<[f64; 2]> = case.bodies.iter().map(range).collect();
        let common = |[low, high]: [f64; 2], of: &[f64; 2]| [low.max(of[0]), high.min(of[1])];
        Self {
            speed2_max: limits.speed_max * limits.speed_max,
            energy_max: limits.energy_max,
            step_min: limits.step_min,
            hidden_energy: instability::hidden_energy(case, comm),
            common_density: density.iter().fold([f64::MIN, f64::MAX], common),
            density,
        }
    }

    /// True if a particle's numbers are numbers and in range whatever its body is. Where it says
    /// no, [`Self::check`] knows.
    #[inline(always)]
    pub(crate) fn surely_holds(&self, rho: f64, moved: &Moved) -> bool {
        let [lower, upper] = self.common_density;
        let heat = moved.energy.abs();
        let speed2 = square(&moved.velocity);
        let dense = (lower..=upper).contains(&rho);
        dense & (heat <= self.energy_max.min(f64::MAX)) & (speed2 <= self.speed2_max.min(f64::MAX))
    }

    /// Failure of a particle without NaN, by a value out of range.
    pub(crate) fn check(&self, body: u32, rho: f64, moved: &Moved) -> Option<NumericalFailure> {
        let [lower, upper] = self.density[body as usize];
        if rho < lower || rho > upper {
            Some(NumericalFailure::Density)
        } else if moved.energy.abs() > self.energy_max {
            Some(NumericalFailure::Energy)
        } else if square(&moved.velocity) > self.speed2_max {
            Some(NumericalFailure::Speed)
        } else {
            None
        }
    }
}
