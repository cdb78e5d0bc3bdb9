//! Sums of particles that are taken out of a run.

use serde::{Deserialize, Serialize};

/// Why particles are taken out of a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Leave {
    /// Their state was out of range.
    Failed,
    /// They had left the box of interest.
    Departed,
}

/// Sums that particles of one body took with them that were taken out.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Removed {
    /// Number of them.
    pub particles: u64,
    /// `Σ m` (kg).
    pub mass: f64,
    /// `Σ m v` (kg m/s).
    pub momentum: [f64; 3],
    /// `Σ ½ m v²` (J).
    pub kinetic_energy: f64,
    /// `Σ m e` (J).
    pub internal_energy: f64,
    /// `−Σ m g·x` (J).
    pub gravity_energy: f64,
    /// `Σ x × m v` (kg m²/s).
    #[serde(default)]
    pub angular_momentum: [f64; 3],
    /// `Σ m t` with the time of removal (kg s): how long gravity has pulled.
    pub mass_time: f64,
    /// When the first and the last of them were taken out (s); none in states of programs that did
    /// not keep it.
    #[serde(default)]
    pub times: Option<[f64; 2]>,
}

impl Removed {
    /// All energy of the particles (J); that of contact is booked for the whole model.
    #[must_use]
    pub fn energy(&self) -> f64 {
        self.kinetic_energy + self.internal_energy + self.gravity_energy
    }
}
