//! Lists of neighbours for single receivers.

use crate::empty;

/// Receivers with their foreign neighbours.
#[derive(Debug, Clone, Default)]
pub struct PairList {
    /// Index of each receiver in the sequence and the end of its neighbours.
    receivers: Vec<(u32, u32)>,
    pub(super) sources: Vec<u32>,
}

impl PairList {
    /// Receivers that have neighbours, with those, in canonical order.
    pub fn iter(&self) -> impl Iterator<Item = (u32, &[u32])> {
        let mut start = 0;
        self.receivers.iter().map(move |&(receiver, end)| {
            let neighbours = &self.sources[start..end as usize];
            start = end as usize;
            (receiver, neighbours)
        })
    }

    /// True if no receiver has a neighbour.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.receivers.is_empty()
    }

    pub(super) fn clear(&mut self) {
        empty(&mut self.receivers);
        empty(&mut self.sources);
    }

    /// Adds a receiver, if it has neighbours.
    pub(super) fn add(&mut self, receiver: u32, neighbours: impl Iterator<Item = u32>) {
        self.sources.extend(neighbours);
        self.close(receiver);
    }

    pub(super) fn memory(&self) -> usize {
        8 * self.receivers.capacity() + 4 * self.sources.capacity()
    }

    /// Gives a receiver the neighbours pushed since the last, if there are any.
    pub(super) fn close(&mut self, receiver: u32) {
        let end = self.sources.len();
        let start = self.receivers.last().map_or(0, |&(_, end)| end as usize);
        if end > start {
            #[allow(clippy::cast_possible_truncation, reason = "one task's pairs fit u32")]
            self.receivers.push((receiver, end as u32));
        }
    }
}
