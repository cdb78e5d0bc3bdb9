//! The units of the constants: centimetres, grams, kilometres in a second, kilopounds (force) in a
//! square inch, degrees up to which an angle counts.

use super::shield::{Shield, Shot};

/// A centimetre (m).
pub const CM: f64 = 1e-2;
/// A kilometre in a second (m/s).
pub const KM_S: f64 = 1e3;
/// A gram in a cubic centimetre (kg/m³).
pub const G_CM3: f64 = 1e3;
/// A gram in a square centimetre (kg/m²).
pub const G_CM2: f64 = 10.0;
/// A kilopound in a square inch (Pa).
pub const KSI: f64 = 6.894_757_293_168_361e6;
/// Angle from the normal beyond which shields are struck as at it (rad): 65°.
const STEEPEST: f64 = 65.0 * std::f64::consts::PI / 180.0;

/// A shield in these units.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sizes {
    /// t_b (cm).
    pub(super) bumper: f64,
    /// t_w (cm).
    pub(super) wall: f64,
    /// S (cm).
    pub(super) gap: f64,
    /// σ (ksi).
    pub(super) yield_strength: f64,
    /// ρ_b (g/cm³).
    pub(super) bumper_density: f64,
    /// ρ_w (g/cm³).
    pub(super) wall_density: f64,
    /// Of the stuffing (g/cm²).
    pub(super) stuffing: f64,
}

/// A shot in these units.
#[derive(Debug, Clone, Copy)]
pub(super) struct Flight {
    /// V (km/s).
    pub(super) speed: f64,
    /// cos θ, of 65° for more.
    pub(super) cosine: f64,
    /// ρ_p (g/cm³).
    pub(super) density: f64,
}

impl Sizes {
    pub(super) fn of(shield: &Shield) -> Self {
        Self {
            bumper: shield.bumper / CM,
            wall: shield.wall / CM,
            gap: shield.gap / CM,
            yield_strength: shield.yield_strength / KSI,
            bumper_density: shield.bumper_density / G_CM3,
            wall_density: shield.wall_density / G_CM3,
            stuffing: shield.stuffing / G_CM2,
        }
    }
}

impl Flight {
    pub(super) fn of(shot: &Shot) -> Self {
        Self {
            speed: shot.speed / KM_S,
            cosine: libm::cos(shot.angle.min(STEEPEST)),
            density: shot.density / G_CM3,
        }
    }

    /// The same at another speed (km/s).
    pub(super) fn at(self, speed: f64) -> Self {
        Self { speed, ..self }
    }

    /// V cos θ (km/s).
    pub(super) fn normal_speed(self) -> f64 {
        self.speed * self.cosine
    }
}

/// x^(a/b).
pub(super) fn root(x: f64, a: f64, b: f64) -> f64 {
    libm::pow(x, a / b)
}
