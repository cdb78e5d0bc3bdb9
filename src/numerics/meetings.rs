//! Boxes in motion: those that come together, found without a look at all pairs.

use crate::extent::{Extent, around};
use crate::tree::Tree;

/// A box that keeps its velocity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MovingBox {
    /// Its corners at the start (m).
    pub extent: Extent,
    /// Its velocity (m/s).
    pub velocity: [f64; 3],
}

/// Boxes in motion, ready to be searched for those that come together.
#[derive(Debug, Clone)]
pub struct Meetings {
    /// Of each box.
    single: Vec<Motion>,
    tree: Tree<Motion>,
}

impl Meetings {
    /// Of some boxes.
    #[must_use]
    pub fn new(boxes: &[MovingBox]) -> Self {
        let middle = |one: &MovingBox| {
            let (lower, upper) = one.extent;
            std::array::from_fn(|a| 0.5 * (lower[a] + upper[a]))
        };
        let middles: Vec<[f64; 3]> = boxes.iter().map(middle).collect();
        Self {
            single: boxes
                .iter()
                .map(|one| Motion::of([one].into_iter()))
                .collect(),
            tree: Tree::new(&middles, |all| Motion::of(all.iter().map(|&b| &boxes[b]))),
        }
    }

    /// All pairs of boxes that have a point in common at some time from the start to `until` (s), each with its smaller
    /// index first, in order. `None` if there are more than `most`.
    #[must_use]
    pub fn pairs(&self, until: f64, most: usize) -> Option<Vec<[usize; 2]>> {
        let mut pairs = Vec::new();
        for (a, own) in self.single.iter().enumerate() {
            self.tree.search(
                &mut pairs,
                |pairs, all| pairs.len() <= most && own.meets(all, until),
                |pairs, all| {
                    let meets = |b: &&usize| **b > a && own.meets(&self.single[**b], until);
                    pairs.extend(all.iter().filter(meets).map(|&b| [a, b]));
                },
            );
        }
        pairs.sort_unstable();
        (pairs.len() <= most).then_some(pairs)
    }
}

/// The box about some boxes, whose faces move so that they stay in it.
#[derive(Debug, Clone, Copy)]
struct Motion {
    lower: [f64; 3],
    upper: [f64; 3],
    slowest: [f64; 3],
    fastest: [f64; 3],
}

impl Motion {
    fn of<'a>(boxes: impl Iterator<Item = &'a MovingBox> + Clone) -> Self {
        let (lower, upper) = around(boxes.clone().map(|one| one.extent));
        let (slowest, fastest) = around(boxes.map(|one| (one.velocity, one.velocity)));
        Self {
            lower,
            upper,
            slowest,
            fastest,
        }
    }

    /// True if the two have a point in common at some time from the start to `until` (s).
    fn meets(&self, other: &Self, until: f64) -> bool {
        let mut window = [0.0, until];
        for a in 0..3 {
            let rooms = [
                (
                    self.upper[a] - other.lower[a],
                    self.fastest[a] - other.slowest[a],
                ),
                (
                    other.upper[a] - self.lower[a],
                    other.fastest[a] - self.slowest[a],
                ),
            ];
            // The overlap along an axis, seen from either side, which grows or shrinks evenly.
            for (overlap, growth) in rooms {
                let time = -overlap / growth;
                if growth > 0.0 {
                    window[0] = f64::max(window[0], time);
                } else if growth < 0.0 {
                    window[1] = f64::min(window[1], time);
                } else if overlap < 0.0 {
                    return false;
                }
            }
        }
        window[0] <= window[1]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Boxes in a dense cloud, of which some rest.
    fn cloud(count: u32) -> Vec<MovingBox> {
        let spread = |k: u32, factor: u32, most: u32| f64::from(k.wrapping_mul(factor) % most);
        (0..count)
            .map(|k| {
                let lower = [7919, 104_729, 1_299_709].map(|factor| spread(k, factor, 997));
                let size = 60.0 + 4.0 * spread(k, 31, 40);
                let speed = if k % 3 == 0 { 0.0 } else { 1.0 };
                MovingBox {
                    extent: (lower, lower.map(|x| x + size)),
                    velocity: [101, 211, 307].map(|factor| speed * (spread(k, factor, 61) - 30.0)),
                }
            })
            .collect()
    }

    #[test]
    fn the_tree_finds_what_all_pairs_do() {
        let boxes = cloud(400);
        let known = Meetings::new(&boxes);
        for until in [0.0, 0.5, 10.0, f64::INFINITY] {
            let single = |b: usize| Motion::of([&boxes[b]].into_iter());
            let all = (0..boxes.len()).flat_map(|a| (a + 1..boxes.len()).map(move |b| [a, b]));
            let all: Vec<_> = all
                .filter(|&[a, b]| single(a).meets(&single(b), until))
                .collect();
            assert!(!all.is_empty());
            assert_eq!(known.pairs(until, all.len()).unwrap(), all, "{until}");
            assert_eq!(known.pairs(until, all.len() - 1), None);
        }
        assert_eq!(Meetings::new(&[]).pairs(1.0, 0), Some(Vec::new()));
    }

    #[test]
    fn faces_that_touch_meet_and_what_flies_past_does_not() {
        let unit = |x: f64, y: f64, velocity: [f64; 3]| MovingBox {
            extent: ([x, y, 0.0], [x + 1.0, y + 1.0, 1.0]),
            velocity,
        };
        let meet = |y: f64, velocity: [f64; 3], until: f64| {
            let boxes = [unit(0.0, 0.0, [0.0; 3]), unit(3.0, y, velocity)];
            !Meetings::new(&boxes).pairs(until, 1).unwrap().is_empty()
        };
        assert!(meet(0.0, [-1.0, 0.0, 0.0], 2.0));
        assert!(!meet(0.0, [-1.0, 0.0, 0.0], 1.9));
        assert!(!meet(0.0, [1.0, 0.0, 0.0], f64::INFINITY));
        assert!(!meet(-4.0, [-1.0, 4.0, 0.0], 0.5));
        assert!(meet(-4.0, [-1.0, 1.0, 0.0], f64::INFINITY));
        assert!(!meet(-4.0, [-1.0, 9.0, 0.0], f64::INFINITY));
    }
}
