//! Facts of a step that the sums need.

/// A step as the sums know it.
#[derive(Debug, Clone, Copy)]
pub struct Step {
    /// Its length (s); zero at the start of a case.
    pub dt: f64,
    /// That of the step before (s).
    pub last_dt: f64,
    /// When it ends (s).
    pub time: f64,
    /// Gravity (m/s²).
    pub gravity: [f64; 3],
}

/// Clusters of receivers that a sweep takes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Side {
    /// Those without halo particles among their neighbours, which need not wait for messages.
    Inner,
    /// Those with some.
    Outer,
}

impl Side {
    /// True if a cluster with or without halo particles among its neighbours is of this side.
    #[inline(always)]
    #[must_use]
    pub fn takes(self, halo: bool) -> bool {
        halo == (self == Self::Outer)
    }
}
