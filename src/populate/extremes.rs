//! The outermost sites of a body, from a few of its layers.

use super::lattice::Stack;
use super::row::{Cut, Row, layers, rows_of_layer};

/// Smallest and largest coordinates (m) of the sites that the cuts leave, if any are left.
///
/// Layers of one kind have the same sites but for those that the shape cuts off, which are more the
/// farther a layer lies from the centre: the nearest one has all the sites of the others, seen
/// along z. Only a hole may hide some of them, and if it hides an outermost one all layers count.
pub(super) fn extremes(stack: &Stack, cuts: &[Cut]) -> Option<([f64; 3], [f64; 3])> {
    let layers = layers(stack, cuts);
    let holds = |k: &u64| rows_of_layer(stack, cuts, *k).next().is_some();
    let lowest = layers.clone().find(holds)?;
    let highest = layers.clone().rev().find(holds)?;
    let kinds = (0..stack.layer_kinds()).filter_map(|kind| {
        let of_kind = layers.clone().filter(|k| k % stack.layer_kinds() == kind);
        let distance = |k: &u64| stack.offset(0, 0, *k)[2].abs();
        of_kind.min_by(|a, b| distance(a).total_cmp(&distance(b)))
    });
    let nearest: Vec<u64> = kinds.collect();
    let [mut x, mut y] = across(stack, cuts, nearest.iter().copied());
    if stack.inside.hole_squared > 0.0 && !stack.has_layers_alike() {
        let mut solid = *stack;
        solid.inside.hole_squared = -1.0;
        if across(&solid, cuts, nearest.into_iter()) != [x, y] {
            [x, y] = across(stack, cuts, layers);
        }
    }
    let z = [lowest, highest].map(|k| stack.position(0, 0, k)[2]);
    Some(([x[0], y[0], z[0]], [x[1], y[1], z[1]]))
}

/// Smallest and largest x and y (m) of some layers.
fn across(stack: &Stack, cuts: &[Cut], layers: impl Iterator<Item = u64>) -> [[f64; 2]; 2] {
    let mut bounds = [[f64::INFINITY, f64::NEG_INFINITY]; 2];
    for Row { j, k, first, end } in layers.flat_map(|k| rows_of_layer(stack, cuts, k)) {
        // Coordinates are monotone along a row, so its ends suffice.
        for i in [first, end - 1] {
            let p = stack.position(i, j, k);
            for (ends, x) in bounds.iter_mut().zip(p) {
                *ends = [ends[0].min(x), ends[1].max(x)];
            }
        }
    }
    bounds
}
