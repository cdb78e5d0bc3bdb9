//! A tree over boxes in motion, which finds those that come together without a look at all pairs.

use crate::extent::{Extent, around};

/// Boxes of a node that is not divided.
const LEAF: usize = 4;

/// A box that keeps its velocity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MovingBox {
    /// Its corners at the start (m).
    pub extent: Extent,
    /// Its velocity (m/s).
    pub velocity: [f64; 3],
}

/// All pairs of boxes that have a point in common at some time from the start to `until` (s), each with its smaller
/// index first, in order. `None` if there are more than `most`.
#[must_use]
pub fn meetings(boxes: &[MovingBox], until: f64, most: usize) -> Option<Vec<[usize; 2]>> {
    let mut order: Vec<usize> = (0..boxes.len()).collect();
    let mut nodes = Vec::new();
    divide(boxes, &mut order, 0, &mut nodes);
    let mut pairs = Vec::new();
    let mut left = Vec::new();
    for (a, moving) in boxes.iter().enumerate() {
        let own = Motion::of(std::slice::from_ref(moving).iter());
        left.extend((!nodes.is_empty()).then_some(0));
        while let Some(node) = left.pop() {
            let node: &Node = &nodes[node];
            if !own.meets(&node.motion, until) {
                continue;
            }
            if let Some(children) = node.children {
                left.extend(children);
                continue;
            }
            let after = order[node.first..node.end].iter().filter(|b| **b > a);
            let meets = |b: &&usize| own.meets(&Motion::of([&boxes[**b]].into_iter()), until);
            pairs.extend(after.filter(meets).map(|&b| [a, b]));
            if pairs.len() > most {
                return None;
            }
        }
    }
    pairs.sort_unstable();
    Some(pairs)
}

/// Boxes by their places in an order.
struct Node {
    motion: Motion,
    first: usize,
    end: usize,
    /// The nodes that it is divided into.
    children: Option<[usize; 2]>,
}

/// Divides boxes at the median of their middles along the axis on which these differ most. Adds the node and those
/// below it; returns its place.
fn divide(
    boxes: &[MovingBox],
    order: &mut [usize],
    first: usize,
    nodes: &mut Vec<Node>,
) -> Option<usize> {
    if order.is_empty() {
        return None;
    }
    let place = nodes.len();
    nodes.push(Node {
        motion: Motion::of(order.iter().map(|&b| &boxes[b])),
        first,
        end: first + order.len(),
        children: None,
    });
    if order.len() > LEAF {
        let middle = |b: usize, axis: usize| {
            let (lower, upper) = boxes[b].extent;
            0.5 * (lower[axis] + upper[axis])
        };
        let middles = order.iter().map(|&b| {
            let at = std::array::from_fn(|axis| middle(b, axis));
            (at, at)
        });
        let (lower, upper) = around(middles);
        let length = |axis: &usize| upper[*axis] - lower[*axis];
        let axis = (0..3).max_by(|a, b| length(a).total_cmp(&length(b)));
        let axis = axis.unwrap_or(0);
        let half = order.len() / 2;
        order.select_nth_unstable_by(half, |&a, &b| {
            middle(a, axis).total_cmp(&middle(b, axis)).then(a.cmp(&b))
        });
        let (below, above) = order.split_at_mut(half);
        let below = divide(boxes, below, first, nodes);
        let above = divide(boxes, above, first + half, nodes);
        nodes[place].children = below.zip(above).map(|(below, above)| [below, above]);
    }
    Some(place)
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
        for until in [0.0, 0.5, 10.0, f64::INFINITY] {
            let single = |b: usize| Motion::of([&boxes[b]].into_iter());
            let all = (0..boxes.len()).flat_map(|a| (a + 1..boxes.len()).map(move |b| [a, b]));
            let all: Vec<_> = all
                .filter(|&[a, b]| single(a).meets(&single(b), until))
                .collect();
            assert!(!all.is_empty());
            assert_eq!(meetings(&boxes, until, all.len()).unwrap(), all, "{until}");
            assert_eq!(meetings(&boxes, until, all.len() - 1), None);
        }
        assert_eq!(meetings(&[], 1.0, 0), Some(Vec::new()));
    }

    #[test]
    fn faces_that_touch_meet_and_what_flies_past_does_not() {
        let unit = |x: f64, y: f64, velocity: [f64; 3]| MovingBox {
            extent: ([x, y, 0.0], [x + 1.0, y + 1.0, 1.0]),
            velocity,
        };
        let meet = |y: f64, velocity: [f64; 3], until: f64| {
            let boxes = [unit(0.0, 0.0, [0.0; 3]), unit(3.0, y, velocity)];
            !meetings(&boxes, until, 1).unwrap().is_empty()
        };
        assert!(meet(0.0, [-1.0, 0.0, 0.0], 2.0));
        assert!(!meet(0.0, [-1.0, 0.0, 0.0], 1.9));
        assert!(!meet(0.0, [1.0, 0.0, 0.0], f64::INFINITY));
        assert!(!meet(-4.0, [-1.0, 4.0, 0.0], 0.5));
        assert!(meet(-4.0, [-1.0, 1.0, 0.0], f64::INFINITY));
        assert!(!meet(-4.0, [-1.0, 9.0, 0.0], f64::INFINITY));
    }
}
