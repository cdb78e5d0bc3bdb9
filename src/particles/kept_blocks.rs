//! Sums over blocks of inactive particles, kept from one use to the next.

use std::ops::Range;

use rayon::prelude::*;

use super::{Inactive, PART};

/// Particles of a block.
const BLOCK: usize = 32 * PART;

/// A value of each block of the store whose particles are all inactive. Kept as long as they are.
#[derive(Debug)]
pub struct KeptBlocks<T> {
    blocks: Vec<Option<Box<Kept<T>>>>,
}

#[derive(Debug)]
struct Kept<T> {
    value: T,
    /// See [`Inactive::since`].
    since: u64,
}

/// A block of the store.
#[derive(Debug)]
pub struct Block<'a, T> {
    kept: &'a mut Option<Box<Kept<T>>>,
    places: Range<usize>,
    since: Option<u64>,
}

impl<T> Default for KeptBlocks<T> {
    fn default() -> Self {
        Self { blocks: Vec::new() }
    }
}

impl<T: Send> KeptBlocks<T> {
    /// The blocks of so many owned particles.
    pub fn each<'a>(
        &'a mut self,
        owned: usize,
        inactive: &'a Inactive,
    ) -> impl ParallelIterator<Item = Block<'a, T>> {
        self.blocks.resize_with(owned.div_ceil(BLOCK), || None);
        let blocks = self.blocks.par_iter_mut().enumerate();
        blocks.map(move |(k, kept)| {
            let places = k * BLOCK..((k + 1) * BLOCK).min(owned);
            let since = inactive.since(&places);
            Block {
                kept,
                places,
                since,
            }
        })
    }

    /// Bytes allocated.
    #[must_use]
    pub fn memory(&self) -> usize {
        let kept = self.blocks.iter().flatten().count();
        size_of::<Kept<T>>() * kept + size_of::<usize>() * self.blocks.capacity()
    }
}

impl<T> Block<'_, T> {
    /// Its particles.
    #[must_use]
    pub fn places(&self) -> Range<usize> {
        self.places.clone()
    }

    /// Its value, if all of it is inactive and the value is worth keeping: that of `of`, which is called once.
    pub fn kept(&mut self, of: impl FnOnce(Range<usize>) -> Option<T>) -> Option<&T> {
        let Some(since) = self.since else {
            *self.kept = None;
            return None;
        };
        if self.kept.as_ref().is_none_or(|kept| kept.since != since) {
            let value = of(self.places.clone());
            *self.kept = value.map(|value| Box::new(Kept { value, since }));
        }
        self.kept.as_deref().map(|kept| &kept.value)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Places that were asked for.
    fn asked(kept: &mut KeptBlocks<usize>, owned: usize, inactive: &Inactive) -> Vec<usize> {
        let blocks = kept.each(owned, inactive);
        let first = blocks.filter_map(|mut block| {
            let mut is_asked = false;
            let first = block.places().start;
            let value = block.kept(|places| {
                is_asked = true;
                Some(places.start)
            });
            assert!(value.is_none_or(|&value| value == first));
            is_asked.then_some(first)
        });
        let mut all: Vec<usize> = first.collect();
        all.sort_unstable();
        all
    }

    #[test]
    fn blocks_are_asked_once_as_long_as_all_of_them_is_inactive() {
        let (mut kept, mut inactive) = (KeptBlocks::default(), Inactive::default());
        let owned = 4 * BLOCK + 5;
        assert!(asked(&mut kept, owned, &inactive).is_empty());
        inactive.set(owned, |part, _| part >= 32);
        assert_eq!(
            asked(&mut kept, owned, &inactive),
            [BLOCK, 2 * BLOCK, 3 * BLOCK]
        );
        inactive.set(owned, |part, _| part >= 33);
        assert!(asked(&mut kept, owned, &inactive).is_empty());
        inactive.set(owned, |part, _| part >= 32);
        // One part of a block becomes active and inactive again before anybody asks.
        inactive.set(owned, |part, _| part >= 32 && part != 70);
        inactive.set(owned, |part, _| part >= 32);
        assert_eq!(asked(&mut kept, owned, &inactive), [BLOCK, 2 * BLOCK]);
        assert!(asked(&mut kept, owned, &inactive).is_empty());
        assert!(kept.memory() >= 3 * size_of::<Kept<usize>>());
        inactive.clear();
        assert!(asked(&mut kept, owned, &inactive).is_empty());
        inactive.set(owned, |_, _| true);
        assert_eq!(asked(&mut kept, owned, &inactive).len(), 4);
        assert!(asked(&mut kept, owned - BLOCK, &inactive).is_empty());
    }
}
