//! Ranks that are near each other, by their slabs.

use super::needs::ROUNDING;
use super::nested::{Decomposition, NestedSlabs, Slab};
use numerics::vector::dot;
use populate::Brick;

impl NestedSlabs {
    /// Tells the ranks, ascending, that may own anything within a range (m) of the region of a rank that
    /// may, this one left out. The two of a pair hear of each other or neither does.
    pub(super) fn near(&self, rank: usize, range: f64, mut emit: impl FnMut(usize)) {
        let region = self.region(rank);
        if !region.is_empty() {
            let within = Within { region, range };
            self.descend((self.whole(), Brick::OPEN), &within, &mut |other| {
                if other != rank {
                    emit(other);
                }
            });
        }
    }

    /// Tells the ranks of a slab, and of a part of space, that are within a range.
    fn descend(&self, (slab, brick): (Slab, Brick), within: &Within, emit: &mut impl FnMut(usize)) {
        if brick.is_empty() || !within.reaches(&brick) {
            return;
        }
        if !slab.is_cut() {
            emit(slab.ranks().start);
            return;
        }
        let (axis, cut) = (self.axis_of(slab), slab.cut());
        let [lower, upper] = within.ends(axis);
        for part in cut.part_at(lower, self.faces())..cut.parts() {
            let mut brick = brick;
            cut.narrow(&mut brick, axis, part, self.faces());
            if brick.lower[axis] > upper {
                break;
            }
            self.descend((cut.part(part), brick), within, emit);
        }
    }
}

/// Surroundings of a region within a range (m).
struct Within {
    region: Brick,
    range: f64,
}

/// Slabs that are looked at lie within the range and so much more of it: whoever is within it by rounding
/// alone is among them.
pub(super) const MARGIN: f64 = 1.001;

impl Within {
    /// True if it reaches a box; that box's own region reaches this one if so.
    fn reaches(&self, brick: &Brick) -> bool {
        let gap = |a: usize| {
            let before = brick.lower[a] - self.region.upper[a];
            let beyond = self.region.lower[a] - brick.upper[a];
            before.max(beyond).max(0.0)
        };
        let gaps = [gap(0), gap(1), gap(2)];
        let range = ROUNDING * self.range;
        dot(&gaps, &gaps) < range * range
    }

    /// Its ends along an axis (m), or somewhat beyond.
    fn ends(&self, axis: usize) -> [f64; 2] {
        let range = MARGIN * self.range;
        [
            self.region.lower[axis] - range,
            self.region.upper[axis] + range,
        ]
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(400))]

        /// A look at all regions finds the same ranks, and two are near each other or neither is.
        #[test]
        fn all_that_is_near_is_told(
            faces in prop::collection::vec(-6_i8..=6, 0..50),
            levels in 1_usize..=3,
            first in 0_usize..3,
            range in 0_u8..6,
        ) {
            let axes = [first, (first + 1) % 3, (first + 2) % 3];
            let faces = faces.iter().map(|&face| 0.7 * f64::from(face)).collect();
            let slabs = NestedSlabs::of_any(axes, levels, faces);
            let range = 0.7 * f64::from(range);
            let all = 0..slabs.ranks();
            for rank in all.clone() {
                let region = slabs.region(rank);
                let within = Within { region, range };
                let is_near = |other: &usize| {
                    let there = slabs.region(*other);
                    *other != rank && !region.is_empty() && !there.is_empty() && within.reaches(&there)
                };
                let mut found = Vec::new();
                slabs.near(rank, range, |other| found.push(other));
                prop_assert_eq!(&found, &all.clone().filter(is_near).collect::<Vec<_>>());
                for other in found {
                    let mut is_told = false;
                    slabs.near(other, range, |back| is_told |= back == rank);
                    prop_assert!(is_told);
                }
            }
        }
    }
}
