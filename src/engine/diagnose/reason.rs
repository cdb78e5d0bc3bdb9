//! Limits of time steps.

use serde::{Deserialize, Serialize};

/// Limit of a time step.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Reason {
    /// Sound and viscosity.
    #[default]
    Sound,
    /// Acceleration.
    Force,
    /// Stiffness of contact.
    Contact,
    /// The input's upper bound.
    Maximum,
    /// The end of the case.
    End,
    /// The speed at which bodies fly towards each other.
    Flight,
}

impl Reason {
    /// All reasons, in the order of ties.
    pub const ALL: [Self; 6] = [
        Self::Sound,
        Self::Force,
        Self::Contact,
        Self::Maximum,
        Self::End,
        Self::Flight,
    ];

    /// Name in histories.
    #[must_use]
    pub fn name(self) -> &'static str {
        ["sound", "force", "contact", "maximum", "end", "flight"][self as usize]
    }
}
