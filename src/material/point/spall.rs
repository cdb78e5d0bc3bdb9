//! Spall as a lower bound of the pressure.

use super::{LANES, Law, PointBatch};
use crate::material::at_least;

law! {
    /// Pressure cut-off: tension never exceeds it, and the material heals when compressed again.
    Spall {
        /// Lowest pressure (Pa), negative.
        pressure: "Pa",
    }
}

impl Law for Spall {
    const STATE: &'static [&'static str] = &[];

    #[inline(always)]
    fn limit_tension(&self, point: &mut PointBatch) {
        for k in 0..LANES {
            point.pressure[k] = at_least(point.pressure[k], self.pressure);
        }
    }
}
