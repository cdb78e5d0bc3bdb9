//! Spall as a lower bound of the pressure.

use super::{LANES, Lanes, at_least};

/// Pressure cut-off: tension never exceeds it, and the material heals when compressed again.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spall {
    /// Lowest pressure (Pa), negative.
    pub pressure: f64,
}

impl Spall {
    /// The pressures (Pa), none below the cut-off.
    #[inline(always)]
    pub(super) fn limit(self, pressure: &Lanes) -> Lanes {
        let mut limited = *pressure;
        for k in 0..LANES {
            limited[k] = at_least(pressure[k], self.pressure);
        }
        limited
    }
}
