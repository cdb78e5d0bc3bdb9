//! Choice of rows for a walk over the table of fields.

use super::columns::{HaloPhase, Life, Output, Owner};
use super::fields::FieldInfo;

/// Choice of the rows of the table that a walk takes: a value of a column, a set of which a row
/// has any, or a question to the row ([`FieldInfo::leaves`]).
pub trait Select: Copy {
    /// True if the walk takes this row.
    fn takes(self, field: &FieldInfo) -> bool;
}

impl Select for Life {
    fn takes(self, field: &FieldInfo) -> bool {
        field.life == self
    }
}

impl Select for Output {
    fn takes(self, field: &FieldInfo) -> bool {
        field.output == self
    }
}

impl Select for HaloPhase {
    fn takes(self, field: &FieldInfo) -> bool {
        field.halo.intersects(self)
    }
}

impl Select for Owner {
    fn takes(self, field: &FieldInfo) -> bool {
        field.owner.intersects(self)
    }
}

impl<Q: Fn(&FieldInfo) -> bool + Copy> Select for Q {
    fn takes(self, field: &FieldInfo) -> bool {
        self(field)
    }
}

impl FieldInfo {
    /// True if steps write it, not only snapshots.
    #[must_use]
    pub fn is_of_steps(&self) -> bool {
        self.halo != HaloPhase::SHOWN
    }
}
