//! Shares of several ranks in one gauge.
//!
//! Most gauges read particles of one rank, whose sums all ranks receive as they are. Where several
//! have particles near a gauge, their terms are put in canonical order and added as one rank would.

use super::gauge_reader::{Matter, Means, Reader, Scratch};
use super::near::{LaneSum, One};
use comm::Comm;

/// Memory to join readings over ranks.
#[derive(Debug, Default)]
pub struct Shares {
    words: Vec<u64>,
    scratch: Scratch,
    terms: Vec<f64>,
    counts: Vec<u64>,
    all: Vec<u64>,
}

/// Words that a term is ordered by: image mirror mask and group, column, place along it, id.
const KEY: usize = 4;

impl Shares {
    /// Bytes allocated.
    pub fn memory(&self) -> usize {
        let words = [&self.words, &self.counts, &self.all].map(Vec::capacity);
        8 * (words.iter().sum::<usize>() + self.terms.capacity()) + self.scratch.near.memory()
    }

    /// Makes the sums of all readers that are due those of all ranks. Collective.
    pub fn join(&mut self, readers: &mut [Reader], matter: &Matter, means: &Means, comm: &Comm) {
        if comm.size() == 1 {
            return;
        }
        self.words.clear();
        for reader in readers.iter().filter(|reader| reader.due) {
            self.words.push(u64::from(reader.met));
            // What is added to nothing stays as it is.
            let bits = |sum: &f64| if reader.met { sum.to_bits() } else { 0 };
            self.words.extend(reader.sums.iter().map(bits));
        }
        comm.sum_u64(&mut self.words);
        let mut words = &self.words[..];
        let mut shared = Vec::new();
        for (k, reader) in readers.iter_mut().enumerate().filter(|(_, r)| r.due) {
            let (known, rest) = words.split_at(1 + reader.sums.len());
            words = rest;
            if known[0] > 1 {
                shared.push(k);
                continue;
            }
            for (sum, &bits) in reader.sums.iter_mut().zip(&known[1..]) {
                *sum = f64::from_bits(bits);
            }
        }
        if !shared.is_empty() {
            self.join_terms(readers, &shared, (matter, means), comm);
        }
    }

    /// Sums of those readers to which several ranks have something to give.
    fn join_terms(
        &mut self,
        readers: &mut [Reader],
        shared: &[usize],
        (matter, means): (&Matter, &Means),
        comm: &Comm,
    ) {
        // This rank's rows of words, one for each term, gauge after gauge.
        self.words.clear();
        self.counts.clear();
        for &k in shared {
            readers[k].find(matter, means, &mut self.scratch);
            let near = &self.scratch.near;
            self.counts.push(near.len() as u64);
            for one in near.iter() {
                self.words.extend(key(matter, &one));
                readers[k].terms(matter, &one, &mut self.terms);
                self.words
                    .extend(self.terms.iter().map(|term| term.to_bits()));
            }
        }
        let own = std::mem::take(&mut self.words);
        comm.all_gather_u64(&self.counts, &mut self.all);
        // Room for the rows of all ranks, by gauge and rank.
        let mut rows: Vec<usize> = Vec::new();
        let mut from = &own[..];
        for (at, &k) in shared.iter().enumerate() {
            let width = KEY + readers[k].sums.len();
            let mut total = 0;
            for (rank, counts) in self.all.chunks_exact(shared.len()).enumerate() {
                let length = usize::try_from(counts[at]).unwrap_or(usize::MAX) * width;
                if rank == comm.rank() {
                    let (mine, rest) = from.split_at(length);
                    self.words.extend(mine);
                    from = rest;
                } else {
                    self.words.resize(self.words.len() + length, 0);
                }
                total += length;
            }
            rows.push(total);
        }
        comm.sum_u64(&mut self.words);
        let mut words = &self.words[..];
        for (&k, &length) in shared.iter().zip(&rows) {
            let (known, rest) = words.split_at(length);
            add_in_order(known, &mut readers[k].sums);
            words = rest;
        }
    }
}

/// Key of the canonical order: first the planes that an image is behind.
fn key(matter: &Matter, one: &One) -> [u64; KEY] {
    let [group, index] = one.listed;
    let [column, along] = matter.lists.sequence().rank_in_order(group, index);
    let first = u64::from(one.mirror_mask.bits()) << 32 | group as u64;
    [first, column, along, matter.particles.id[one.i]]
}

/// Adds rows of a key and terms in the order of keys.
fn add_in_order(words: &[u64], sums: &mut [f64]) {
    let mut rows: Vec<&[u64]> = words.chunks_exact(KEY + sums.len()).collect();
    rows.sort_unstable_by_key(|row| &row[..KEY]);
    for (c, sum) in sums.iter_mut().enumerate() {
        let mut lanes = LaneSum::default();
        for (k, row) in rows.iter().enumerate() {
            lanes.add(k, f64::from_bits(row[KEY + c]));
        }
        *sum = lanes.total();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn terms_are_added_in_the_order_of_their_keys() {
        let row = |key: [u64; KEY], term: f64| [&key[..], &[term.to_bits()]].concat();
        let rows = [
            row([0, 2, 1, 9], 1.0),
            row([0, 1, 7, 3], 1e16),
            row([1, 0, 0, 0], 1.0),
            row([0, 2, 1, 4], -1e16),
        ];
        let mut sums = [f64::NAN];
        add_in_order(&rows.concat(), &mut sums);
        assert_eq!(sums[0].to_bits(), 2.0_f64.to_bits());
        let [a, b, c, d] = rows;
        add_in_order(&[d, c, b, a].concat(), &mut sums);
        assert_eq!(sums[0].to_bits(), 2.0_f64.to_bits());
    }
}
