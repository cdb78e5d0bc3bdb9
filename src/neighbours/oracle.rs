//! Brute-force neighbours: slow and obvious, beside the fast search.

use super::motion::MotionRecord;
use super::sequence::Sequence;

/// Places of all images of the receiver's group with `r < h_i + h_j`, in canonical order.
///
/// # Panics
/// If `receiver` is no place of the sequence.
#[must_use]
pub fn own_neighbours(sequence: &Sequence, sources: &[MotionRecord], receiver: u32) -> Vec<u32> {
    let here = &sources[receiver as usize];
    let length = |place: usize| sequence.smoothing_lengths()[place];
    let group = (0..sequence.groups())
        .find(|&g| sequence.group(g).contains(&(receiver as usize)))
        .expect("every image has a group");
    sequence
        .group(group)
        .filter(|&place| {
            let there = &sources[place];
            let r2: f64 = (0..3)
                .map(|a| (here.position[a] - there.position[a]).powi(2))
                .sum();
            r2 < (length(receiver as usize) + length(place)).powi(2)
        })
        .map(|place| u32::try_from(place).expect("images fit u32"))
        .collect()
}
