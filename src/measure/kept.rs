//! What measures keep from step to step.

use super::gauges::Gauges;
use super::witness::Witnesses;
use crate::model::Case;

/// Gauges and witness planes: what is kept from step to step.
#[derive(Debug)]
pub struct Measures {
    /// Gauges.
    pub gauges: Gauges,
    /// Witness planes.
    pub witnesses: Witnesses,
}

impl Measures {
    /// Those of a case.
    #[must_use]
    pub fn new(case: &Case) -> Self {
        Self {
            gauges: Gauges::new(case),
            witnesses: Witnesses::new(case),
        }
    }

    /// Bytes allocated.
    #[must_use]
    pub fn memory(&self) -> usize {
        self.gauges.memory() + self.witnesses.memory()
    }
}
