//! Speed of each rank in counted work, by the clock.

use comm::Comm;

/// Share of the work that each rank is to have.
///
/// Counted work alone leaves ranks waiting where their cores differ in speed or the count is off
/// in places: with 4 % between two cores, two ranks lose 2 %. Shares follow what was measured
/// between balances; they decide who computes a particle, never what comes out.
#[derive(Debug, Clone, Default)]
pub struct RankSpeeds {
    /// Of the whole, by rank; empty before the first measurement, when all are equal.
    shares: Vec<f64>,
    /// Sum of the shares up to and with each rank's.
    sums: Vec<f64>,
    /// At the last call.
    busy: Option<f64>,
    scratch: Vec<u64>,
}

/// Seconds below which the clock says little: shares stay as they are.
const SHORTEST: f64 = 0.05;

/// Part of the way of shares to what was measured: a short delay of a rank is not chased.
const FOLLOWED: f64 = 0.25;

/// Factor that a share may be from the even one.
const WIDEST: f64 = 2.0;

impl RankSpeeds {
    /// Takes what this rank has done: the `work` counted since the last call, and
    /// `busy`, the seconds since its start that it spent neither waiting nor sending. What was
    /// before the first call, with its cold memory, does not count. Collective: all ranks hear of
    /// all, since each cuts all faces.
    pub fn measure(&mut self, comm: &Comm, work: u64, busy: f64) {
        let Some(before) = self.busy.replace(busy) else {
            return;
        };
        let seconds = busy - before;
        #[allow(clippy::cast_precision_loss, reason = "a measure of speed")]
        let speed = work as f64 / seconds.max(f64::MIN_POSITIVE);
        comm.all_gather_u64(&[speed.to_bits(), seconds.to_bits()], &mut self.scratch);
        let gathered = &self.scratch;
        let measured = |k: usize| f64::from_bits(gathered[k]);
        let ranks = comm.size();
        if (0..ranks).any(|r| measured(2 * r) <= 0.0 || measured(2 * r + 1) < SHORTEST) {
            return;
        }
        let mut total = 0.0;
        for r in 0..ranks {
            total += measured(2 * r);
        }
        #[allow(clippy::cast_precision_loss, reason = "few ranks")]
        let even = 1.0 / ranks as f64;
        self.shares.resize(ranks, even);
        for (r, share) in self.shares.iter_mut().enumerate() {
            let wanted = (measured(2 * r) / total).clamp(even / WIDEST, even * WIDEST);
            *share += FOLLOWED * (wanted - *share);
        }
        self.sums.clear();
        let mut sum = 0.0;
        self.sums.extend(self.shares.iter().map(|share| {
            sum += share;
            sum
        }));
    }

    /// The work for which a rank of mean speed takes as long as one of `ranks` for `work`.
    #[must_use]
    #[allow(
        clippy::cast_precision_loss,
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a measure of load"
    )]
    pub(super) fn load(&self, work: u64, rank: usize, ranks: usize) -> u64 {
        match self.shares.get(rank) {
            Some(share) if self.shares.len() == ranks => {
                (work as f64 / (share * ranks as f64)) as u64
            }
            _ => work,
        }
    }

    /// The part of all work that ranks below `rank` are to have, of `ranks`.
    #[allow(clippy::cast_precision_loss, reason = "few ranks")]
    pub(super) fn below(&self, rank: usize, ranks: usize) -> f64 {
        if self.sums.len() != ranks {
            return rank as f64 / ranks as f64;
        }
        let before = rank.checked_sub(1).map_or(0.0, |last| self.sums[last]);
        before / self.sums[ranks - 1]
    }

    /// Bytes allocated.
    #[must_use]
    pub fn memory(&self) -> usize {
        8 * (self.shares.capacity() + self.sums.capacity() + self.scratch.capacity())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_are_equal_until_something_was_measured() {
        let rank_speeds = RankSpeeds::default();
        assert!(rank_speeds.below(0, 4).abs() < 1e-15);
        assert!((rank_speeds.below(1, 4) - 0.25).abs() < 1e-15);
        assert!((rank_speeds.below(3, 4) - 0.75).abs() < 1e-15);
    }

    #[test]
    fn a_rank_by_itself_has_all() {
        let mut rank_speeds = RankSpeeds::default();
        rank_speeds.measure(&Comm::solo(), 1000, 1.0);
        rank_speeds.measure(&Comm::solo(), 1000, 2.0);
        assert!((rank_speeds.below(1, 1) - 1.0).abs() < 1e-15);
    }
}
