//! Places at which tasks put entries that they sort into columns.

use rayon::prelude::*;

/// For each task, where its next entry of each column goes. Kept from step to step.
#[derive(Debug, Clone, Default)]
pub(super) struct Cursors {
    columns: usize,
    /// Those of one task after the other.
    places: Vec<u32>,
    /// Entries before each share of columns.
    before: Vec<u32>,
}

/// Columns that a task lays out.
const SHARE: usize = 2048;

impl Cursors {
    /// Nothing counted, in so many columns by so many tasks.
    pub(super) fn reset(&mut self, columns: usize, tasks: usize) {
        self.columns = columns;
        self.places.clear();
        self.places.resize(columns * tasks, 0);
    }

    /// Those of each task, by column: first its count of entries, after [`Self::lay_out`] where the first goes.
    pub(super) fn tasks(&mut self) -> impl IndexedParallelIterator<Item = &mut [u32]> {
        self.places.par_chunks_mut(self.columns)
    }

    /// Turns counts into places: column after column, and in each task after task. Sets `starts` to where
    /// each column begins and the last one ends.
    pub(super) fn lay_out(&mut self, starts: &mut Vec<u32>) {
        let (columns, places) = (self.columns, &mut self.places);
        starts.clear();
        starts.resize(columns + 1, 0);
        let next = &mut starts[1..];
        self.before.resize(columns.div_ceil(SHARE), 0);
        // Where columns begin, counted from the first of their share.
        let shares = next.par_chunks_mut(SHARE).zip(&mut self.before);
        shares.enumerate().for_each(|(share, (next, all))| {
            *all = 0;
            for (k, next) in next.iter_mut().enumerate() {
                let counts = places.iter().skip(share * SHARE + k).step_by(columns);
                (*next, *all) = (*all, *all + counts.sum::<u32>());
            }
        });
        let mut sum = 0;
        for before in &mut self.before {
            (*before, sum) = (sum, sum + *before);
        }
        let shares = next.par_chunks_mut(SHARE).zip(&self.before);
        shares.for_each(|(next, before)| next.iter_mut().for_each(|next| *next += before));
        // Behind the entries of a task come those of the next one, so that in the end these are the ends.
        for counts in places.chunks_exact_mut(columns) {
            let all = counts.par_iter_mut().zip(&mut *next).with_min_len(SHARE);
            all.for_each(|(count, next)| (*count, *next) = (*next, *next + *count));
        }
    }

    pub(super) fn memory(&self) -> usize {
        4 * (self.places.capacity() + self.before.capacity())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn threads_lay_out_what_one_would() {
        let mut cursors = Cursors::default();
        for (columns, tasks) in [
            (1, 3),
            (5, 2),
            (SHARE, 2),
            (SHARE + 1, 3),
            (3 * SHARE + 77, 4),
        ] {
            let count = |k: usize| u32::try_from(k * 7919 % 13).unwrap();
            cursors.reset(columns, tasks);
            let places = cursors.places.iter_mut().enumerate();
            places.for_each(|(k, place)| *place = count(k));
            let mut starts = Vec::new();
            cursors.lay_out(&mut starts);
            let mut next = 0;
            for column in 0..columns {
                assert_eq!(starts[column], next);
                for task in 0..tasks {
                    let k = task * columns + column;
                    assert_eq!(cursors.places[k], next);
                    next += count(k);
                }
            }
            assert_eq!(starts[columns], next);
        }
    }
}
