//! The particles and snapshots of a viewer: the same ones of the same run.

/// The particles that are kept of many: those whose ids, well mixed, are among the smallest.
#[derive(Debug, Clone, Copy)]
pub struct Chosen {
    /// Largest mixed id that is kept.
    limit: u64,
}

impl Chosen {
    /// At most so many, all but surely, of a total.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a share of all whole numbers, at most one"
    )]
    pub fn new(most: usize, total: usize) -> Self {
        if total <= most {
            return Self { limit: u64::MAX };
        }
        // Their number scatters by its root.
        let wanted = most as f64 - 4.0 * (most as f64).sqrt();
        let share = wanted.max(0.5 * most as f64) / total as f64;
        Self {
            limit: (share * u64::MAX as f64) as u64,
        }
    }

    /// `true` if the particle of an id is kept.
    pub fn keeps(self, id: u64) -> bool {
        mixed(id) <= self.limit
    }
}

/// An id as if drawn by lot (Steele, Lea & Flood 2014, `SplitMix64`), so that no lattice shows in what is
/// kept.
fn mixed(id: u64) -> u64 {
    let mut z = id.wrapping_add(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// `wanted` of `count` in even steps, the first and the last among them.
pub fn spread(count: usize, wanted: usize) -> Vec<usize> {
    if wanted >= count {
        return (0..count).collect();
    }
    if wanted == 1 {
        return vec![count - 1];
    }
    (0..wanted)
        .map(|k| k * (count - 1) / (wanted - 1))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_more_are_kept_than_asked_for_and_not_far_fewer() {
        let kept = |most, total: usize| {
            let chosen = Chosen::new(most, total);
            (0..total as u64).filter(|&id| chosen.keeps(id)).count()
        };
        assert_eq!(kept(1000, 1000), 1000);
        for most in [1000, 5000, 50_000] {
            let number = kept(most, 100_000);
            assert!(
                number <= most && 5 * number >= 4 * most,
                "{number} of {most}"
            );
        }
    }

    #[test]
    fn snapshots_are_spread_from_the_first_to_the_last() {
        assert_eq!(spread(11, 4), [0, 3, 6, 10]);
        assert_eq!(spread(3, 9), [0, 1, 2]);
        assert_eq!(spread(5, 1), [4]);
    }
}
