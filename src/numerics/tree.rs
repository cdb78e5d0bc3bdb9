//! A tree over points, by which a search passes over most of them.

use crate::extent::around;

/// Points of a node that is not divided.
const LEAF: usize = 4;

/// Points divided at medians, and what is known of those of each node.
#[derive(Debug, Clone)]
pub struct Tree<T> {
    /// The points by their indices, those of a node side by side.
    order: Vec<usize>,
    nodes: Vec<Node<T>>,
}

#[derive(Debug, Clone)]
struct Node<T> {
    all: T,
    first: usize,
    end: usize,
    /// The nodes that it is divided into.
    children: Option<[usize; 2]>,
}

impl<T> Tree<T> {
    /// Of some points, with what `of` tells of those of some indices.
    #[must_use]
    pub fn new(points: &[[f64; 3]], of: impl Fn(&[usize]) -> T) -> Self {
        let mut order: Vec<usize> = (0..points.len()).collect();
        let mut nodes = Vec::new();
        divide(points, &mut order, 0, (&of, &mut nodes));
        Self { order, nodes }
    }

    /// Goes to all nodes that may hold what is sought, by `enters`, and gives the points of those that are not divided to
    /// `find`; both look at the `state` of the search.
    pub fn search<S>(
        &self,
        state: &mut S,
        enters: impl Fn(&S, &T) -> bool,
        mut find: impl FnMut(&mut S, &[usize]),
    ) {
        // A node's two halves wait for each other: no deeper than halving goes.
        let mut left = [0; 2 * usize::BITS as usize];
        let mut waiting = usize::from(!self.nodes.is_empty());
        while waiting > 0 {
            waiting -= 1;
            let node = &self.nodes[left[waiting]];
            if !enters(state, &node.all) {
                continue;
            }
            if let Some(children) = node.children {
                left[waiting..waiting + 2].copy_from_slice(&children);
                waiting += 2;
            } else {
                find(state, &self.order[node.first..node.end]);
            }
        }
    }
}

/// Divides points at the median along the axis on which they differ most. Adds the node and those below it; returns its
/// place, or none without points.
fn divide<T>(
    points: &[[f64; 3]],
    order: &mut [usize],
    first: usize,
    (of, nodes): (&impl Fn(&[usize]) -> T, &mut Vec<Node<T>>),
) -> Option<usize> {
    if order.is_empty() {
        return None;
    }
    let place = nodes.len();
    nodes.push(Node {
        all: of(order),
        first,
        end: first + order.len(),
        children: None,
    });
    if order.len() > LEAF {
        let (lower, upper) = around(order.iter().map(|&k| (points[k], points[k])));
        let length = |axis: &usize| upper[*axis] - lower[*axis];
        let axis = (0..3).max_by(|a, b| length(a).total_cmp(&length(b)));
        let axis = axis.unwrap_or(0);
        let half = order.len() / 2;
        order.select_nth_unstable_by(half, |&a, &b| {
            let by_place = points[a][axis].total_cmp(&points[b][axis]);
            by_place.then(a.cmp(&b))
        });
        let (below, above) = order.split_at_mut(half);
        let below = divide(points, below, first, (of, nodes));
        let above = divide(points, above, first + half, (of, nodes));
        nodes[place].children = below.zip(above).map(|(below, above)| [below, above]);
    }
    Some(place)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A search for the points above a plane finds those, and looks at few others.
    #[test]
    fn a_search_finds_what_is_there_and_passes_over_the_rest() {
        for count in [0, 1, 4, 5, 1000_u32] {
            let spread = |k: u32, factor: u32| f64::from(k.wrapping_mul(factor) % 997);
            let points: Vec<[f64; 3]> = (0..count)
                .map(|k| [7919, 104_729, 1_299_709].map(|factor| spread(k, factor)))
                .collect();
            let tree = Tree::new(&points, |all| {
                all.iter().fold(0.0, |most, &k| points[k][0].max(most))
            });
            let mut state = (Vec::new(), 0);
            let enters = |_: &(Vec<usize>, usize), most: &f64| *most > 900.0;
            tree.search(&mut state, enters, |(found, seen), all| {
                found.extend(all.iter().filter(|&&k| points[k][0] > 900.0));
                *seen += all.len();
            });
            let (mut found, seen) = state;
            found.sort_unstable();
            let all = 0..points.len();
            let expected: Vec<usize> = all.filter(|&k| points[k][0] > 900.0).collect();
            assert_eq!(found, expected);
            assert!(seen <= 4 * expected.len(), "{seen} {}", expected.len());
        }
    }
}
