//! Smallest words, which all threads of all ranks look for.

use std::sync::atomic::{AtomicU64, Ordering::Relaxed};

use comm::Comm;

/// So many words, each the smallest that is told of it. Buffers are kept from one search to the next.
#[derive(Debug, Default)]
pub(super) struct Least {
    /// As threads find them.
    found: Vec<AtomicU64>,
    /// Those of all ranks.
    words: Vec<u64>,
}

impl Least {
    /// Begins to look for so many words.
    pub(super) fn begin(&mut self, count: usize) {
        self.found.clear();
        self.found.resize_with(count, || AtomicU64::new(u64::MAX));
    }

    /// Tells words, from a place on; any thread may.
    pub(super) fn lower(&self, place: usize, words: impl IntoIterator<Item = u64>) {
        for (found, word) in self.found[place..].iter().zip(words) {
            found.fetch_min(word, Relaxed);
        }
    }

    /// What this rank was told: the words, the largest there is where nobody told any.
    pub(super) fn here(&mut self) -> &[u64] {
        self.words.clear();
        let found = self.found.iter_mut().map(|word| *word.get_mut());
        self.words.extend(found);
        &self.words
    }

    /// Joins what all ranks were told. Collective.
    pub(super) fn join(&mut self, comm: &Comm) {
        self.here();
        comm.min_u64(&mut self.words);
    }

    /// After [`Self::join`]: the words, the largest there is where nobody told any.
    pub(super) fn words(&self) -> &[u64] {
        &self.words
    }

    /// Bytes allocated.
    pub(super) fn memory(&self) -> usize {
        8 * (self.found.capacity() + self.words.capacity())
    }
}
