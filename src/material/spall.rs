//! Spall as a lower bound of the pressure.

/// Pressure cut-off: tension never exceeds it, and the material heals when compressed again.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spall {
    /// Lowest pressure (Pa), negative.
    pub pressure: f64,
}
