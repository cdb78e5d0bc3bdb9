//! Union–find that all threads work on at once.

use std::sync::atomic::{AtomicU32, AtomicU64, Ordering::Relaxed};

use rayon::prelude::*;

/// Elements that a task looks at.
pub const SHARE: usize = 4096;

/// Disjoint sets of the elements `0..n`, joined by any threads in any order: which elements are
/// together does not depend on it, and the root of a set is its smallest element.
#[derive(Debug, Default)]
pub struct Sets {
    parents: Vec<AtomicU32>,
    /// At roots, after [`Self::finish`]: smallest id, marks, and elements that count.
    labels: Vec<AtomicU64>,
    marks: Vec<AtomicU32>,
    counts: Vec<AtomicU32>,
}

/// Set that [`Sets::finish`] has found.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Set {
    /// Its smallest element.
    pub root: u32,
    /// Smallest id of its elements.
    pub label: u64,
    /// Marks of all its elements.
    pub marks: u32,
    /// Number of the first elements that it has.
    pub count: u32,
}

impl Sets {
    /// Bytes for each element.
    pub const BYTES: usize = 3 * size_of::<u32>() + size_of::<u64>();

    /// Takes all sets apart: `n` elements, each by itself and without marks.
    pub fn reset(&mut self, n: usize) {
        self.parents.resize_with(n, AtomicU32::default);
        self.labels.resize_with(n, AtomicU64::default);
        self.marks.resize_with(n, AtomicU32::default);
        self.counts.resize_with(n, AtomicU32::default);
        (
            &mut self.parents,
            &mut self.labels,
            &mut self.marks,
            &mut self.counts,
        )
            .into_par_iter()
            .enumerate()
            .with_min_len(SHARE)
            .for_each(|(i, (parent, label, marks, count))| {
                *parent.get_mut() = u32::try_from(i).unwrap_or(u32::MAX);
                *label.get_mut() = u64::MAX;
                (*marks.get_mut(), *count.get_mut()) = (0, 0);
            });
    }

    /// Number of elements.
    #[must_use]
    pub fn len(&self) -> usize {
        self.parents.len()
    }

    /// True if there are no elements.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.parents.is_empty()
    }

    /// The smallest element known of the set of `i`; all of it once nobody joins any more.
    #[inline]
    #[must_use]
    pub fn root(&self, mut i: u32) -> u32 {
        loop {
            let parent = self.parents[i as usize].load(Relaxed);
            if parent == i {
                return i;
            }
            let above = self.parents[parent as usize].load(Relaxed);
            if above != parent {
                // Parents only ever decrease, whoever writes last.
                self.parents[i as usize].fetch_min(above, Relaxed);
            }
            i = parent;
        }
    }

    /// Joins the sets of two elements.
    #[inline]
    pub fn join(&self, a: u32, b: u32) {
        let (mut a, mut b) = (self.root(a), self.root(b));
        while a != b {
            let (low, high) = (a.min(b), a.max(b));
            // A root that another thread has just joined is none any more.
            let root = &self.parents[high as usize];
            if root.compare_exchange(high, low, Relaxed, Relaxed).is_ok() {
                return;
            }
            (a, b) = (self.root(low), self.root(high));
        }
    }

    /// Adds marks to the set of an element.
    #[inline]
    pub fn mark(&self, i: u32, marks: u32) {
        if self.marks[i as usize].load(Relaxed) & marks != marks {
            self.marks[i as usize].fetch_or(marks, Relaxed);
        }
    }

    /// Finds what [`Self::set`] tells, from the ids of all elements; the first `counted` of them
    /// count.
    pub fn finish(&mut self, ids: &[u64], counted: usize) {
        let sets = &*self;
        let book = |run: &Set| {
            let root = run.root as usize;
            // A smallest number, bits and a whole number: the same in any order.
            sets.labels[root].fetch_min(run.label, Relaxed);
            sets.marks[root].fetch_or(run.marks, Relaxed);
            sets.counts[root].fetch_add(run.count, Relaxed);
        };
        let tasks = ids.par_chunks(SHARE).enumerate();
        tasks.for_each(|(task, ids)| {
            let mut run: Option<Set> = None;
            for (k, &id) in ids.iter().enumerate() {
                let i = task * SHARE + k;
                let one = Set {
                    root: sets.root(u32::try_from(i).unwrap_or(u32::MAX)),
                    label: id,
                    marks: sets.marks[i].load(Relaxed),
                    count: u32::from(i < counted),
                };
                match &mut run {
                    Some(run) if run.root == one.root => {
                        run.label = run.label.min(id);
                        run.marks |= one.marks;
                        run.count += one.count;
                    }
                    _ => run.replace(one).iter().for_each(book),
                }
            }
            run.iter().for_each(book);
        });
    }

    /// The set of an element, after [`Self::finish`].
    #[must_use]
    pub fn set(&self, i: u32) -> Set {
        let root = self.root(i);
        let at = root as usize;
        Set {
            root,
            label: self.labels[at].load(Relaxed),
            marks: self.marks[at].load(Relaxed),
            count: self.counts[at].load(Relaxed),
        }
    }

    /// Gives a set, by its root, the label and the marks that it has over all ranks.
    pub fn rename(&mut self, root: u32, label: u64, marks: u32) {
        *self.labels[root as usize].get_mut() = label;
        *self.marks[root as usize].get_mut() = marks;
    }

    /// Bytes allocated.
    #[must_use]
    pub fn memory(&self) -> usize {
        Self::BYTES * self.parents.capacity()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn top(slow: &[u32], mut i: u32) -> u32 {
        while slow[i as usize] != i {
            i = slow[i as usize];
        }
        i
    }

    /// Against sets that are relabelled one link at a time.
    #[test]
    fn threads_join_what_one_would() {
        const N: u32 = 20_000;
        let mut state = 7_u64;
        let mut draw = || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            u32::try_from(state >> 40).unwrap() % N
        };
        let links: Vec<[u32; 2]> = (0..12_000).map(|_| [draw(), draw()]).collect();
        let mut slow: Vec<u32> = (0..N).collect();
        for &[a, b] in &links {
            let (a, b) = (top(&slow, a), top(&slow, b));
            slow[a.max(b) as usize] = a.min(b);
        }
        let mut sets = Sets::default();
        for _ in 0..3 {
            sets.reset(N as usize);
            links.par_iter().for_each(|&[a, b]| {
                sets.join(a, b);
                sets.mark(a, 1 << (a % 3));
            });
            let ids: Vec<u64> = (0..N).map(|i| u64::from(N - i)).collect();
            sets.finish(&ids, 15_000);
            let mut counts = std::collections::BTreeMap::new();
            let mut least = std::collections::BTreeMap::new();
            let mut marks = std::collections::BTreeMap::new();
            for i in 0..N {
                let root = top(&slow, i);
                *counts.entry(root).or_insert(0) += u32::from(i < 15_000);
                let label = least.entry(root).or_insert(u64::MAX);
                *label = ids[i as usize].min(*label);
                marks.entry(root).or_insert(0);
            }
            for &[a, _] in &links {
                *marks.entry(top(&slow, a)).or_default() |= 1 << (a % 3);
            }
            for i in 0..N {
                let root = top(&slow, i);
                let wanted = Set {
                    root,
                    label: least[&root],
                    marks: marks[&root],
                    count: counts[&root],
                };
                assert_eq!(sets.set(i), wanted);
            }
        }
    }
}
