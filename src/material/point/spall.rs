//! Spall as a lower bound of the pressure.

use super::{Constants, LANES, Law, PointBatch};
use crate::material::at_least;

/// Pressure cut-off: tension never exceeds it, and the material heals when compressed again.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spall {
    /// Lowest pressure (Pa), negative.
    pub pressure: f64,
}

impl Law for Spall {
    const STATE: &'static [&'static str] = &[];

    fn constants(&self) -> Constants {
        vec![("pressure", self.pressure, "Pa")]
    }

    #[inline(always)]
    fn limit_tension(&self, point: &mut PointBatch) {
        for k in 0..LANES {
            point.pressure[k] = at_least(point.pressure[k], self.pressure);
        }
    }
}
