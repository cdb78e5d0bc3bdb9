//! Bridges: particles whose neighbours hang together by nothing else.

use particles::connected::Place;

/// Neighbours beyond which matter is far too dense for a bridge.
const MOST: usize = 64;

/// True if the neighbours of a particle fall apart without it: they are not all linked with each
/// other through links among themselves.
pub fn is_bridge(neighbours: impl ExactSizeIterator<Item = Place> + Clone) -> bool {
    let count = neighbours.len();
    if !(2..=MOST).contains(&count) {
        return false;
    }
    let mut near = [None; MOST];
    for (slot, place) in near.iter_mut().zip(neighbours) {
        *slot = Some(place);
    }
    let linked = |a: usize, b: usize| match (&near[a], &near[b]) {
        (Some(a), Some(b)) => a.is_linked(b),
        _ => false,
    };
    // Those that the first one has not been found to hang together with.
    let mut left = (u64::MAX >> (MOST - count)) & !1;
    let mut front = 1_u64;
    while front != 0 && left != 0 {
        let k = front.trailing_zeros() as usize;
        front &= front - 1;
        let mut among = left;
        while among != 0 {
            let other = among.trailing_zeros() as usize;
            among &= among - 1;
            if linked(k, other) {
                left &= !(1 << other);
                front |= 1 << other;
            }
        }
    }
    left != 0
}
