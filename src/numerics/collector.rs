//! Lists that all threads make together, in the order that one alone would give.

use rayon::prelude::*;

/// Appends what each of many elements has to say to a list. Counts are kept from one list to the next.
#[derive(Debug, Clone, Default)]
pub struct Collector {
    /// For each task how many entries there are up to its last one.
    ends: Vec<usize>,
}

impl Collector {
    /// Appends to `list` what `of` gives for each of the elements `0..n`, in their order; a task looks at
    /// `share` of them. It is asked twice and answers alike.
    pub fn extend<T, I>(
        &mut self,
        list: &mut Vec<T>,
        (n, share): (usize, usize),
        of: impl Fn(usize) -> I + Sync,
    ) where
        T: bytemuck::Zeroable + Copy + Send + Sync,
        I: IntoIterator<Item = T>,
    {
        let elements = |task: usize| task * share..n.min((task + 1) * share);
        self.ends.resize(n.div_ceil(share), 0);
        self.ends
            .par_iter_mut()
            .enumerate()
            .for_each(|(task, end)| {
                *end = elements(task).map(|i| of(i).into_iter().count()).sum();
            });
        let mut all = 0;
        for end in &mut self.ends {
            all += *end;
            *end = all;
        }
        let first = list.len();
        list.par_extend(rayon::iter::repeat_n(T::zeroed(), all).with_min_len(GRAIN));
        let write = |task: usize, entries: &mut [T]| {
            let given = elements(task).flat_map(&of);
            for (entry, given) in entries.iter_mut().zip(given) {
                *entry = given;
            }
        };
        halve((&self.ends, 0), (&mut list[first..], 0), &write);
    }

    /// For each task how many entries it and those before it gave the last time.
    #[must_use]
    pub fn ends(&self) -> &[usize] {
        &self.ends
    }

    /// Bytes allocated.
    #[must_use]
    pub fn memory(&self) -> usize {
        size_of::<usize>() * self.ends.capacity()
    }
}

/// Entries that a task clears at least.
const GRAIN: usize = 4096;

/// Calls `write` with each task, from the first on, and its entries, halving the tasks among threads. The
/// entries begin at place `start` of all.
fn halve<T: Send>(
    (ends, first): (&[usize], usize),
    (entries, start): (&mut [T], usize),
    write: &(impl Fn(usize, &mut [T]) + Sync),
) {
    if entries.is_empty() {
        return;
    }
    if ends.len() == 1 {
        return write(first, entries);
    }
    let middle = ends.len() / 2;
    let (lower, upper) = ends.split_at(middle);
    let (left, right) = entries.split_at_mut(lower[middle - 1] - start);
    rayon::join(
        || halve((lower, first), (left, start), write),
        || halve((upper, first + middle), (right, lower[middle - 1]), write),
    );
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn threads_list_what_one_would() {
        let of = |i: usize| (0..(i * i) % 3).map(move |k| i * 10 + k);
        let mut collector = Collector::default();
        for (n, share) in [(0, 9), (1, 9), (9, 9), (10, 9), (1007, 100), (5, 1)] {
            let mut list = vec![7];
            collector.extend(&mut list, (n, share), of);
            let wanted: Vec<usize> = [7].into_iter().chain((0..n).flat_map(of)).collect();
            assert_eq!(list, wanted);
        }
        let mut list = Vec::new();
        collector.extend(&mut list, (30, 7), |_| None::<u8>);
        assert!(list.is_empty());
    }
}
