//! Memory of measures from row to row.

use serde::{Deserialize, Serialize};

/// Memory of a measure from the start and from its last row.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Remembered {
    /// Momentum (kg m/s) towards its face at the start of what strikes a plate or a target.
    pub impulse: Option<f64>,
    /// Time (s) and position (m) of a front.
    pub front: Option<[f64; 2]>,
}
