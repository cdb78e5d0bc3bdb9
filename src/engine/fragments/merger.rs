//! Labels that are one over all ranks, merged by their owners.
//!
//! Messages hold labels that cross faces between ranks, never particles. What a rank's own rows join is a group of labels.
//! At first each label is a class by itself. In each round every class becomes one with the first, in an order that looks
//! random, of all classes that any rank has in a group with it (Łącki, Mirrokni & Włodarczyk 2018, arXiv 1807.10727). So
//! the classes of a chain of all ranks become some half as many in a round, others fewer. In the end each group has one class.
//! The owner of a class hears of it from all ranks by a [`Relay`]: no rank holds more than its share of labels, however many
//! ranks have some of one.

use comm::{Comm, PlainRecord, Receivers, Relay};
use numerics::counter::split_mix;

/// Facts of a rank about a label that crosses a face: that it is one with another, and the marks
/// and particles that this rank adds to it.
#[derive(
    Debug, Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord, bytemuck::Pod, bytemuck::Zeroable,
)]
#[repr(C)]
pub struct Row {
    /// The label.
    pub label: u64,
    /// The same thing's label elsewhere; once merged, the smallest of all.
    pub other: u64,
    /// Its marks here; once merged, all.
    pub marks: u64,
    /// Its particles here; once merged, all.
    pub count: u64,
}

/// A class, and the one that it becomes.
#[derive(Debug, Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
struct Step {
    class: u64,
    next: u64,
}

/// Rows of all ranks. Buffers are kept from one merge to the next.
pub struct Merger {
    /// This rank's rows before [`Self::merge`]; after it one for each of its labels, in their order.
    pub rows: Vec<Row>,
    forest: Forest,
    /// This rank's groups, each by its smallest label here, and their classes.
    groups: Vec<(u64, u64)>,
    steps: Vec<Step>,
    of_steps: Relay<Step>,
    wholes: Vec<Row>,
    of_wholes: Relay<Row>,
}

/// Memory in which rows are joined.
#[derive(Debug, Default)]
struct Forest {
    labels: Vec<u64>,
    parents: Vec<u32>,
    merged: Vec<Row>,
}

impl PlainRecord for Row {
    fn key(&self) -> u64 {
        self.label
    }
}

impl PlainRecord for Step {
    fn key(&self) -> u64 {
        self.class
    }
}

impl Default for Merger {
    fn default() -> Self {
        Self {
            rows: Vec::new(),
            forest: Forest::default(),
            groups: Vec::new(),
            steps: Vec::new(),
            of_steps: Relay::new(Receivers::Owners),
            wholes: Vec::new(),
            of_wholes: Relay::new(Receivers::Owners),
        }
    }
}

impl Merger {
    /// Merges the rows of all ranks: each label of this rank has one row, which names the smallest label of the
    /// same thing, its marks and its count. Collective.
    pub fn merge(&mut self, comm: &Comm) {
        self.forest.reduce(&mut self.rows);
        self.groups.clear();
        self.groups
            .extend(self.rows.iter().map(|row| (row.other, row.label)));
        self.groups.sort_unstable();
        for round in 0.. {
            let groups = self.groups.chunk_by(|a, b| a.0 == b.0);
            let mut most = [groups.map(<[_]>::len).max().unwrap_or(0) as u64];
            comm.max_u64(&mut most);
            match most[0] {
                0 => return,
                1 => break,
                _ => self.join_classes(comm, round),
            }
        }
        self.sum(comm);
    }

    /// Makes each class of a group one with the first that it is together with anywhere. Collective.
    fn join_classes(&mut self, comm: &Comm, round: u64) {
        // Another order in each round: no chain stands in the order of all of them.
        let order = |class: u64| (split_mix(&mut (class ^ (round << 48))), class);
        self.steps.clear();
        for group in self.groups.chunk_by(|a, b| a.0 == b.0) {
            let classes = group.iter().map(|of| of.1);
            let next = classes.clone().min_by_key(|class| order(*class));
            let next = next.expect("a group has classes");
            self.steps.extend(classes.map(|class| Step { class, next }));
        }
        let steps = &mut self.steps;
        self.of_steps.send(comm, steps, |all, one| {
            all.next = std::cmp::min_by_key(all.next, one.next, |class| order(*class));
        });
        self.of_steps.come_back(comm, steps);
        for (_, class) in &mut self.groups {
            let at = steps.binary_search_by_key(class, |step| step.class);
            *class = steps[at.expect("a class has been asked for")].next;
        }
        self.groups.sort_unstable();
        self.groups.dedup();
    }

    /// Sums what ranks know of each class, of which each group has one, and tells all of them. Collective.
    fn sum(&mut self, comm: &Comm) {
        let rows = &mut self.rows;
        let class_of = |groups: &[(u64, u64)], group: u64| {
            let at = groups.binary_search_by_key(&group, |of| of.0);
            groups[at.expect("a group has a class")].1
        };
        self.wholes.clear();
        let roots = rows.iter().filter(|row| row.label == row.other);
        self.wholes.extend(roots.map(|root| Row {
            label: class_of(&self.groups, root.label),
            ..*root
        }));
        let wholes = &mut self.wholes;
        self.of_wholes.send(comm, wholes, |all, one| {
            all.other = all.other.min(one.other);
            all.marks |= one.marks;
            all.count += one.count;
        });
        self.of_wholes.come_back(comm, wholes);
        for row in rows {
            let class = class_of(&self.groups, row.other);
            let at = wholes.binary_search_by_key(&class, |whole| whole.label);
            *row = Row {
                label: row.label,
                ..wholes[at.expect("a class has been summed")]
            };
        }
    }

    /// The row of a label, after [`Self::merge`].
    #[must_use]
    pub fn of(&self, label: u64) -> Option<&Row> {
        let at = self.rows.binary_search_by_key(&label, |row| row.label);
        self.rows.get(at.ok()?)
    }

    /// Bytes allocated.
    #[must_use]
    pub fn memory(&self) -> usize {
        size_of::<Row>() * (self.rows.capacity() + self.wholes.capacity())
            + 8 * self.forest.labels.capacity()
            + 4 * self.forest.parents.capacity()
            + size_of::<Row>() * self.forest.merged.capacity()
            + size_of::<(u64, u64)>() * self.groups.capacity()
            + size_of::<Step>() * self.steps.capacity()
            + self.of_steps.memory()
            + self.of_wholes.memory()
    }
}

impl Forest {
    /// One row for each label, which names the smallest of the same thing; that one's has all marks
    /// and the whole count.
    fn reduce(&mut self, rows: &mut Vec<Row>) {
        let Self {
            labels,
            parents,
            merged,
        } = self;
        labels.clear();
        labels.extend(rows.iter().flat_map(|row| [row.label, row.other]));
        labels.sort_unstable();
        labels.dedup();
        parents.clear();
        parents.extend((0_u32..).take(labels.len()));
        let place = |label: u64| labels.binary_search(&label).unwrap_or_default();
        for row in rows.iter() {
            let ends = [row.label, row.other].map(|label| root(parents, place(label)));
            let (low, high) = (ends[0].min(ends[1]), ends[0].max(ends[1]));
            parents[high] = u32::try_from(low).unwrap_or(u32::MAX);
        }
        merged.clear();
        merged.extend((0..labels.len()).map(|k| Row {
            label: labels[k],
            other: labels[root(parents, k)],
            ..Row::default()
        }));
        for row in rows.iter() {
            let top = &mut merged[root(parents, place(row.label))];
            top.marks |= row.marks;
            top.count += row.count;
        }
        std::mem::swap(rows, merged);
    }
}

fn root(parents: &mut [u32], mut k: usize) -> usize {
    while parents[k] as usize != k {
        parents[k] = parents[parents[k] as usize];
        k = parents[k] as usize;
    }
    k
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::*;
    use comm::{Machine, virtual_ranks};

    fn row(label: u64, other: u64, marks: u64, count: u64) -> Row {
        Row {
            label,
            other,
            marks,
            count,
        }
    }

    #[test]
    fn a_chain_through_ranks_is_one() {
        let mut merger = Merger {
            rows: vec![
                row(9, 7, 0, 4),
                row(7, 7, 1, 5),
                row(7, 3, 0, 0),
                row(3, 3, 4, 1),
                row(8, 8, 2, 2),
            ],
            ..Merger::default()
        };
        merger.merge(&Comm::solo());
        assert_eq!(merger.rows.len(), 4);
        assert_eq!(merger.of(9), Some(&row(9, 3, 5, 10)));
        assert_eq!(merger.of(8), Some(&row(8, 8, 2, 2)));
        assert_eq!(merger.of(1), None);
        // Merged again with itself, but for counts, nothing changes.
        let before: Vec<_> = merger.rows.iter().map(|r| (r.label, r.other)).collect();
        merger.merge(&Comm::solo());
        let after: Vec<_> = merger.rows.iter().map(|r| (r.label, r.other)).collect();
        assert_eq!(before, after);
    }

    /// Merges what `rows` gives for each rank, and holds it to what one rank makes of all rows together.
    fn assert_merged(ranks: usize, rows: impl Fn(u64) -> Vec<Row> + Sync) {
        let mut alone = Merger {
            rows: (0..ranks as u64).flat_map(&rows).collect(),
            ..Merger::default()
        };
        alone.merge(&Comm::solo());
        let alone: BTreeMap<u64, Row> = alone.rows.iter().map(|row| (row.label, *row)).collect();
        let found = virtual_ranks(ranks, Machine::IDEAL, |comm| {
            let mut merger = Merger::default();
            for _ in 0..2 {
                merger.rows = rows(comm.rank() as u64);
                merger.merge(comm);
            }
            merger.rows
        });
        for row in found.iter().flatten() {
            assert_eq!(alone[&row.label], *row);
        }
        let found: BTreeMap<u64, Row> = found.iter().flatten().map(|r| (r.label, *r)).collect();
        assert_eq!(found, alone);
    }

    #[test]
    fn ranks_merge_what_one_rank_would() {
        for ranks in [1, 2, 3, 5, 8, 17, 40] {
            let size = ranks as u64;
            // Nothing; then chains through all ranks in the order of labels, against it and in none.
            assert_merged(ranks, |_| Vec::new());
            let jump = |rank: u64| (rank * 7 + 3) % 41;
            let chains: [&(dyn Fn(u64) -> u64 + Sync); 3] =
                [&|rank| rank, &|rank| 100 - rank, &jump];
            for label in chains {
                assert_merged(ranks, |rank| {
                    let own = row(label(rank), label(rank), 1 << (rank % 3), rank + 1);
                    let next = row(label(rank), label((rank + 1).min(size - 1)), 0, 0);
                    vec![own, next]
                });
            }
            // Random links among few labels and among many.
            for labels in [20, 400] {
                assert_merged(ranks, |rank| {
                    let mut state = rank ^ labels;
                    let mut draw = || split_mix(&mut state) % labels;
                    (0..5).map(|k| row(draw(), draw(), k, rank)).collect()
                });
            }
        }
    }
}
