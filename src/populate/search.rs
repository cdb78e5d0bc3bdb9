//! Rows of a lattice by parts, of which a search leaves those that cannot hold what it wants.

use super::lattice::Stack;
use super::parts::Parts;
use super::row::Cut;

/// Rows of a lattice, by the indices of their sites.
pub(super) struct Rows<'a> {
    pub stack: &'a Stack,
    pub cuts: &'a [Cut],
}

impl Parts for Rows<'_> {
    fn all(&self) -> [u64; 3] {
        self.stack.counts
    }

    /// Across the longest side; of rings, first one by one.
    #[allow(clippy::cast_precision_loss)] // indices stay far below 2^52
    fn longest(&self, first: [u64; 3], end: [u64; 3]) -> usize {
        let length = |a: &usize| {
            let sites = (end[*a] - first[*a] - 1) as f64;
            let first = if self.stack.has_rings() && *a == 1 {
                1e9
            } else {
                1.0
            };
            sites * self.stack.pitch[*a] * first
        };
        let longest = (0..3).max_by(|a, b| length(a).total_cmp(&length(b)));
        longest.unwrap_or(0)
    }

    fn around(&self, first: [u64; 3], end: [u64; 3]) -> Option<([f64; 3], [f64; 3])> {
        // Inner rings have fewer sites than rows of the lattice have places.
        if first[0] >= self.stack.sites(end[1] - 1) {
            return None;
        }
        let (lower, upper) = self.stack.block(first, end);
        let is_cut = self.cuts.iter().any(|cut| cut.drops(&lower, &upper));
        (!is_cut && self.stack.may_hold(&lower, &upper)).then_some((lower, upper))
    }

    fn emit(&self, at: [u64; 3], mut emit: impl FnMut([f64; 3])) {
        let [i, j, k] = at;
        let position = self.stack.position(i, j, k);
        if self.stack.holds(at) && self.cuts.iter().all(|cut| cut.keeps(&position)) {
            emit(position);
        }
    }
}
