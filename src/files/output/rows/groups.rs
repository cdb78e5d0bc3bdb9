//! Ranks in groups, through which rows go.

use std::ops::Range;

use numerics::counter::split_mix;

/// All ranks in groups that follow each other: ⌊√P⌋ of them, as even as whole numbers allow.
///
/// Each rank has a gate in each group: the one rank there that receives its rows for the group.
/// Ranks of one group have different gates. Those of different groups are shifted against each
/// other as if by chance: in a model whose ids run along another axis than its slabs, ranks a
/// group apart have rows for the same group, and without a shift all of them the same gate.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Groups {
    ranks: usize,
    count: usize,
}

impl Groups {
    /// Groups of `ranks`. Up to three are one group.
    pub fn of(ranks: usize) -> Self {
        Self {
            ranks,
            count: ranks.isqrt(),
        }
    }

    /// Number of groups.
    pub fn count(self) -> usize {
        self.count
    }

    /// The ranks of a group.
    pub fn members(self, group: usize) -> Range<usize> {
        let start = |group| group * self.ranks / self.count;
        start(group)..start(group + 1)
    }

    /// The group of a rank.
    pub fn group(self, rank: usize) -> usize {
        ((rank + 1) * self.count - 1) / self.ranks
    }

    /// The gates of a rank, by group. It is its own in its group.
    pub fn gates(self, rank: usize) -> impl Iterator<Item = usize> {
        let own = self.group(rank);
        let index = rank - self.members(own).start;
        (0..self.count).map(move |group| {
            let members = self.members(group);
            members.start + (index + shift(own, group, members.len())) % members.len()
        })
    }

    /// The ranks that a rank is a gate of, ascending, itself among them.
    pub fn guests(self, rank: usize) -> impl Iterator<Item = usize> {
        let own = self.group(rank);
        let members = self.members(own);
        let index = rank - members.start;
        (0..self.count).flat_map(move |group| {
            let shift = shift(group, own, members.len());
            let first = (index + members.len() - shift) % members.len();
            let others = self.members(group);
            (others.start + first..others.end).step_by(members.len())
        })
    }
}

/// Shift of the gates of ranks of a group in another of `ranks` ranks; none in their own.
fn shift(from: usize, to: usize, ranks: usize) -> usize {
    if from == to {
        return 0;
    }
    let word = split_mix(&mut ((from as u64) << 32 | to as u64));
    usize::try_from(word % ranks as u64).unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn groups_are_even_and_hold_all_ranks() {
        for ranks in (1..400).chain([1000, 9973, 10_000]) {
            let groups = Groups::of(ranks);
            let mut next = 0;
            for group in 0..groups.count() {
                let members = groups.members(group);
                assert_eq!(members.start, next);
                assert!(
                    [ranks / groups.count(), ranks.div_ceil(groups.count())]
                        .contains(&members.len())
                );
                assert!(members.clone().all(|rank| groups.group(rank) == group));
                next = members.end;
            }
            assert_eq!(next, ranks);
        }
    }

    /// Gates and guests know each other; no rank has many of either, and both transfers together take no
    /// more than 2√P messages.
    #[test]
    fn gates_are_known_to_both_sides_and_have_even_loads() {
        for ranks in (1..130).chain([300, 9973]) {
            let groups = Groups::of(ranks);
            let mut expected = vec![Vec::new(); ranks];
            for rank in 0..ranks {
                let gates: Vec<usize> = groups.gates(rank).collect();
                assert_eq!(gates.len(), groups.count());
                assert_eq!(gates[groups.group(rank)], rank);
                assert!(
                    (0..)
                        .zip(&gates)
                        .all(|(group, &gate)| groups.group(gate) == group)
                );
                for &gate in &gates {
                    expected[gate].push(rank);
                }
            }
            for (rank, expected) in expected.iter().enumerate() {
                let guests: Vec<usize> = groups.guests(rank).collect();
                assert_eq!(&guests, expected);
                assert!(
                    guests.len() <= groups.count() + 7,
                    "{ranks}: {}",
                    guests.len()
                );
                let within = groups.members(groups.group(rank)).len() - 1;
                let messages = groups.count() - 1 + within;
                assert!(messages * messages <= 4 * ranks);
            }
        }
    }
}
