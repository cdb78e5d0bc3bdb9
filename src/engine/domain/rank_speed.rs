//! Speed of a rank in counted work, by the clock.

use comm::Comm;

/// Share of the work that this rank is to have.
///
/// Counted work alone leaves ranks waiting where their cores differ in speed or the count is off
/// in places: with 4 % between two cores, two ranks lose 2 %. Shares follow what was measured
/// between balances; they decide who computes a particle, never what comes out.
#[derive(Debug, Clone)]
pub struct RankSpeeds {
    /// Over the even one.
    share: f64,
    /// At the last call.
    busy: Option<f64>,
}

/// Whole number of an even share.
const EVEN: f64 = (1 << 20) as f64;

impl Default for RankSpeeds {
    fn default() -> Self {
        Self {
            share: 1.0,
            busy: None,
        }
    }
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
    /// before the first call, with its cold memory, does not count. A rank that had too little to do keeps its share.
    /// Collective.
    pub fn measure(&mut self, comm: &Comm, work: u64, busy: f64) {
        let Some(before) = self.busy.replace(busy) else {
            return;
        };
        let seconds = busy - before;
        let is_measured = work > 0 && seconds >= SHORTEST;
        #[allow(clippy::cast_precision_loss, reason = "a measure of speed")]
        let speed = if is_measured {
            work as f64 / seconds
        } else {
            0.0
        };
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a measure of speed"
        )]
        let mut sums = [speed as u64, u64::from(is_measured)];
        comm.sum_u64(&mut sums);
        if is_measured {
            #[allow(clippy::cast_precision_loss, reason = "a measure of speed")]
            let mean = sums[0] as f64 / sums[1] as f64;
            let wanted = (speed / mean.max(1.0)).clamp(1.0 / WIDEST, WIDEST);
            self.share += FOLLOWED * (wanted - self.share);
        }
    }

    /// The work for which a rank of mean speed takes as long as this one for `work`.
    #[must_use]
    #[allow(
        clippy::cast_precision_loss,
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a measure of load"
    )]
    pub(super) fn load(&self, work: u64) -> u64 {
        (work as f64 / self.share) as u64
    }

    /// The share as a whole number: even ones have [`EVEN`].
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "shares are from a half to two"
    )]
    pub(super) fn share(&self) -> u64 {
        (self.share * EVEN) as u64
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use comm::{Machine, virtual_ranks};

    #[test]
    fn all_are_equal_until_something_was_measured() {
        let rank_speeds = RankSpeeds::default();
        assert_eq!((rank_speeds.share(), rank_speeds.load(7)), (1 << 20, 7));
    }

    /// Of four ranks one is twice as fast; one has no work, which keeps no other from learning.
    #[test]
    fn who_has_nothing_to_do_keeps_its_share() {
        let shares = virtual_ranks(4, Machine::IDEAL, |comm| {
            let mut rank_speeds = RankSpeeds::default();
            let work = [2000, 1000, 0, 1000][comm.rank()];
            for k in 0..30 {
                rank_speeds.measure(comm, work, f64::from(k));
            }
            rank_speeds.share
        });
        for (share, expected) in shares.into_iter().zip([1.5, 0.75, 1.0, 0.75]) {
            assert!((share - expected).abs() < 1e-3, "{share} {expected}");
        }
    }
}
