//! Clusters that rest among what rests: nobody needs their lists.

use super::cluster::Cluster;
use super::facts::{ACTIVE, HALO, MOVING};
use super::foreign::GroupRanges;
use super::near::INFLATION;
use super::sequence::Sequence;
use numerics::lanes::{LANES, Lanes};

/// Marks of images that keep others around them from resting.
const NOT_RESTING: u64 = u64::from_le_bytes([HALO | MOVING | ACTIVE; LANES]);

/// Looks around clusters of a group.
pub(super) struct Watch<'a> {
    pub(super) sequence: &'a Sequence,
    pub(super) group: usize,
    /// Largest distance (m) of neighbours of the own group.
    pub(super) far: f64,
    /// The longest range (m) of contact between two groups, if there is any contact.
    pub(super) ranges: Option<&'a GroupRanges>,
    /// The groups that may be near any of the clusters.
    pub(super) groups: &'a [usize],
    /// Place at which the last box began to read columns, by the last bits of their indices.
    pub(super) hints: [usize; 64],
}

impl Watch<'_> {
    /// True if all clusters of a run rest among what rests, far from other groups. May say no where they do. What moves
    /// counts as far as it reaches a neighbour, which it strains before the sums of forces; and so does contact, whose stress
    /// is shown around a neighbour.
    #[inline(always)]
    pub(super) fn rests<V: Lanes>(&mut self, run: &[Cluster]) -> bool {
        let (mut lower, mut upper) = (run[0].lower, run[0].upper);
        for cluster in run {
            let rests = |&i: &u32| self.sequence.rests(i as usize);
            if !cluster.valid().iter().all(rests) {
                return false;
            }
            for a in 0..3 {
                lower[a] = lower[a].min(cluster.lower[a]);
                upper[a] = upper[a].max(cluster.upper[a]);
            }
        }
        let bounds = (&lower, &upper);
        let reach = |other: usize| 2.0 * self.far + self.range(other);
        let is_far = |other: usize| {
            self.range(other) == 0.0
                || other == self.group
                || self.is_far::<V>(other, bounds, reach(other))
        };
        self.groups.iter().all(|&other| is_far(other))
            && self.rests_near::<V>(bounds, reach(self.group))
    }

    /// Range of contact with a group (m).
    fn range(&self, other: usize) -> f64 {
        let range = self.ranges.map(|ranges| ranges.between(self.group, other));
        range.unwrap_or_default() * INFLATION
    }

    /// True if all images of the own group near a box (m), by no more than `far` (m) along each axis, rest and belong
    /// to this rank.
    #[inline(always)]
    fn rests_near<V: Lanes>(&mut self, (lower, upper): (&[f64; 3], &[f64; 3]), far: f64) -> bool {
        let (sequence, group) = (self.sequence, self.group);
        let along = sequence.along(group);
        let (from, to) = (lower[along] - far, upper[along] + far);
        let mut marks = 0;
        for ([a, b], column) in sequence.columns_near(group, lower, upper, far) {
            let hint = &mut self.hints[(a & 7) << 3 | b & 7];
            *hint = sequence.seek::<V>(group, &column, from, *hint);
            for eight in sequence.eights(*hint..column.end) {
                if marks != 0 || eight.coordinates[along][0] > to {
                    break;
                }
                // Also of those behind the end, to be on the safe side.
                marks |= u64::from_le_bytes(*eight.special) & NOT_RESTING;
            }
            if marks != 0 {
                return false;
            }
        }
        true
    }

    /// True if no image of a group is near a box (m), by no more than `far` (m) along each axis.
    #[inline(always)]
    fn is_far<V: Lanes>(
        &self,
        group: usize,
        (lower, upper): (&[f64; 3], &[f64; 3]),
        far: f64,
    ) -> bool {
        let sequence = self.sequence;
        let along = sequence.along(group);
        for (_, column) in sequence.columns_near(group, lower, upper, far) {
            let first = sequence.seek::<V>(group, &column, lower[along] - far, column.start);
            let is_far =
                first == column.end || sequence.coordinates(along, first)[0] > upper[along] + far;
            if !is_far {
                return false;
            }
        }
        true
    }
}
