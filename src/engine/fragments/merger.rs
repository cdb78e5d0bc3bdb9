//! Labels that are one over all ranks: merged pair by pair of ranks up a tree.
//!
//! Messages hold labels that cross faces between ranks, never particles. Each rank of the tree
//! hands on one row for each label, whatever the number of links.

use comm::{Comm, Exchange};

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
    /// Its marks here; once merged, of the smallest label all.
    pub marks: u64,
    /// Its particles here; once merged, of the smallest label all.
    pub count: u64,
}

/// Rows of all ranks. Buffers are kept from one merge to the next.
#[derive(Default)]
pub struct Merger {
    /// This rank's rows before [`Self::merge`], those of all after it, by label.
    pub rows: Vec<Row>,
    forest: Forest,
    bytes: Vec<u8>,
    exchange: Exchange,
}

/// Memory in which rows are joined.
#[derive(Debug, Default)]
struct Forest {
    labels: Vec<u64>,
    parents: Vec<u32>,
    merged: Vec<Row>,
}

impl Merger {
    /// Merges the rows of all ranks: each label has one row, which names the smallest label of the
    /// same thing. Collective.
    pub fn merge(&mut self, comm: &Comm) {
        self.forest.reduce(&mut self.rows);
        up_tree(
            comm,
            &mut self.exchange,
            &mut self.bytes,
            |bytes, incoming| {
                if incoming {
                    self.rows.extend(rows_of(bytes));
                    self.forest.reduce(&mut self.rows);
                } else {
                    bytes.clear();
                    bytes.extend_from_slice(bytemuck::cast_slice(&self.rows));
                }
            },
        );
        self.bytes.clear();
        self.bytes
            .extend_from_slice(bytemuck::cast_slice(&self.rows));
        comm.broadcast(&mut self.bytes);
        self.rows.clear();
        self.rows.extend(rows_of(&self.bytes));
    }

    /// The row of the smallest label of what a label belongs to, after [`Self::merge`].
    #[must_use]
    pub fn of(&self, label: u64) -> Option<&Row> {
        let row = |label: u64| {
            let at = self
                .rows
                .binary_search_by_key(&label, |row| row.label)
                .ok()?;
            self.rows.get(at)
        };
        row(row(label)?.other)
    }

    /// Brings the words of all ranks to the first, in the order of ranks; nothing is left on
    /// others. Collective.
    pub fn gather(&mut self, comm: &Comm, words: &mut Vec<u64>) {
        up_tree(
            comm,
            &mut self.exchange,
            &mut self.bytes,
            |bytes, incoming| {
                if incoming {
                    words.extend(
                        bytes
                            .chunks_exact(8)
                            .map(bytemuck::pod_read_unaligned::<u64>),
                    );
                } else {
                    bytes.clear();
                    bytes.extend_from_slice(bytemuck::cast_slice(words));
                    words.clear();
                }
            },
        );
    }

    /// Bytes allocated.
    #[must_use]
    pub fn memory(&self) -> usize {
        size_of::<Row>() * self.rows.capacity()
            + 8 * self.forest.labels.capacity()
            + 4 * self.forest.parents.capacity()
            + size_of::<Row>() * self.forest.merged.capacity()
            + self.bytes.capacity()
            + self.exchange.memory()
    }
}

/// Walks a binary tree of the ranks from its leaves to rank 0. `step` takes what has come in from a
/// rank below (`true`), or gives what goes to the one above. Collective.
fn up_tree(
    comm: &Comm,
    exchange: &mut Exchange,
    bytes: &mut Vec<u8>,
    mut step: impl FnMut(&mut Vec<u8>, bool),
) {
    let (rank, size) = (comm.rank(), comm.size());
    let mut width = 1;
    while width < size {
        let place = rank % (2 * width);
        if place == width {
            exchange.set_peers(std::iter::once(rank - width));
            step(bytes, false);
            exchange.outgoing(0).extend_from_slice(bytes);
            exchange.post_sizes(comm);
            exchange.post(comm);
            exchange.wait();
            return;
        }
        if place == 0 && rank + width < size {
            exchange.set_peers(std::iter::once(rank + width));
            exchange.post_sizes(comm);
            exchange.post(comm);
            exchange.wait();
            bytes.clear();
            bytes.extend_from_slice(exchange.incoming(0));
            step(bytes, true);
        }
        width *= 2;
    }
}

fn rows_of(bytes: &[u8]) -> impl Iterator<Item = Row> {
    let rows = bytes.chunks_exact(size_of::<Row>());
    rows.map(bytemuck::pod_read_unaligned::<Row>)
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
    use super::*;

    #[test]
    fn a_chain_through_ranks_is_one() {
        let row = |label, other, marks, count| Row {
            label,
            other,
            marks,
            count,
        };
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
        assert_eq!(merger.of(9), Some(&row(3, 3, 5, 10)));
        assert_eq!(merger.of(8), Some(&row(8, 8, 2, 2)));
        assert_eq!(merger.of(1), None);
        // Merged again with itself, but for counts, nothing changes.
        let before: Vec<_> = merger.rows.iter().map(|r| (r.label, r.other)).collect();
        merger.merge(&Comm::solo());
        let after: Vec<_> = merger.rows.iter().map(|r| (r.label, r.other)).collect();
        assert_eq!(before, after);
    }
}
