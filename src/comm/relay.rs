//! Records from any ranks to others, joined on their way.
//!
//! Ranks stand in ⌊√P⌋ rows. A record goes within the row of its sender to the column of its receiver, then within
//! that column. Records of one key are joined at each stop: however many ranks have some of a key, none receives
//! more than about √P records of it. No rank sends more than 2√P messages.

use bytemuck::Pod;

use super::Comm;
use super::exchange::Exchange;

/// What a rank tells of a key.
pub trait Record: Clone {
    /// Records of one key become one, on the rank to which they go.
    fn key(&self) -> u64;

    /// Appends it to a message.
    fn write(&self, bytes: &mut Vec<u8>);

    /// Takes what [`Self::write`] wrote from the start of a message.
    fn read(bytes: &mut &[u8]) -> Self;
}

/// A record that is sent as it lies in memory.
pub trait PlainRecord: Pod {
    /// As [`Record::key`].
    fn key(&self) -> u64;
}

impl<T: PlainRecord> Record for T {
    fn key(&self) -> u64 {
        PlainRecord::key(self)
    }

    fn write(&self, bytes: &mut Vec<u8>) {
        bytes.extend_from_slice(bytemuck::bytes_of(self));
    }

    fn read(bytes: &mut &[u8]) -> Self {
        super::read_pod(bytes)
    }
}

/// The ranks that receive records.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Receivers {
    /// All, each its share of the keys.
    Owners,
    /// The same, with one owner for all keys of an upper half.
    OwnersByUpperHalf,
    /// The rank that the upper half of a key names.
    Named,
    /// Rank 0.
    Root,
}

/// Ranks in rows as even as whole numbers allow. All rows have the first `width` columns. Some have one rank more: that
/// of a row stands at the end of the column with the number of the row.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Rows {
    ranks: usize,
    count: usize,
    width: usize,
    /// The first rows, so many, have one rank more.
    longer: usize,
}

impl Rows {
    fn of(ranks: usize) -> Self {
        let count = ranks.isqrt();
        Self {
            ranks,
            count,
            width: ranks / count,
            longer: ranks % count,
        }
    }

    /// The rank at a row and a place in it.
    fn rank(self, [row, place]: [usize; 2]) -> usize {
        row * self.width + row.min(self.longer) + place
    }

    /// Row of a rank and its place in it.
    fn in_row(self, rank: usize) -> [usize; 2] {
        let begun = self.longer * (self.width + 1);
        if rank < begun {
            return [rank / (self.width + 1), rank % (self.width + 1)];
        }
        let rest = rank - begun;
        [self.longer + rest / self.width, rest % self.width]
    }

    /// Column of a rank and its place in it.
    fn in_column(self, rank: usize) -> [usize; 2] {
        match self.in_row(rank) {
            [row, place] if place < self.width => [place, row],
            [row, _] => [row, self.count],
        }
    }

    /// The ranks of a row.
    fn row(self, row: usize) -> impl Iterator<Item = usize> {
        let first = self.rank([row, 0]);
        first..first + self.width + usize::from(row < self.longer)
    }

    /// The ranks of a column.
    fn column(self, column: usize) -> impl Iterator<Item = usize> {
        let rows = (0..self.count).map(move |row| self.rank([row, column]));
        let last = (column < self.longer).then(|| self.rank([column, self.width]));
        rows.chain(last)
    }

    /// Column, and place in it, of the rank to which records of a key go.
    fn receiver(self, receivers: Receivers, key: u64) -> [usize; 2] {
        let key = match receivers {
            Receivers::Owners => key,
            Receivers::OwnersByUpperHalf => key >> 32,
            Receivers::Named => {
                return self.in_column(usize::try_from(key >> 32).expect("a rank"));
            }
            Receivers::Root => return [0, 0],
        };
        // By the upper bits of a product with 2⁶⁴ over the golden ratio, which spreads keys that follow each other
        // (Knuth, The Art of Computer Programming 3, 6.4).
        let hash = key.wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 32;
        let owner = (hash * self.ranks as u64) >> 32;
        self.in_column(usize::try_from(owner).unwrap_or(0))
    }
}

/// One of the two ways of records, among ranks of which each has a place.
struct Way<T> {
    exchange: Exchange,
    /// This rank's place.
    mine: usize,
    /// Records that go, in the order of their receivers' places and of keys.
    gone: Vec<T>,
    /// Records that have come, joined, in the order of keys.
    come: Vec<T>,
}

impl<T> Default for Way<T> {
    fn default() -> Self {
        Self {
            exchange: Exchange::default(),
            mine: 0,
            gone: Vec::new(),
            come: Vec::new(),
        }
    }
}

impl<T: Record> Way<T> {
    /// Sends what is to go `to` places, of which the `ranks` are these.
    #[track_caller]
    fn go(
        &mut self,
        comm: &Comm,
        ranks: impl Iterator<Item = usize>,
        to: impl Fn(u64) -> usize,
        join: impl Fn(&mut T, &T),
    ) {
        let place = |record: &T| (to(record.key()), record.key());
        self.gone.sort_unstable_by_key(place);
        join_equal(&mut self.gone, &join);
        let (me, mine) = (comm.rank(), self.mine);
        self.exchange.set_peers(ranks.filter(|&rank| rank != me));
        self.come.clear();
        for record in &self.gone {
            match to(record.key()) {
                place if place == mine => self.come.push(record.clone()),
                place => record.write(self.exchange.outgoing(place - usize::from(place > mine))),
            }
        }
        self.exchange.post_with_sizes(comm);
        self.exchange.wait();
        for peer in self.exchange.incoming_all() {
            let mut bytes = peer.incoming();
            while !bytes.is_empty() {
                self.come.push(T::read(&mut bytes));
            }
        }
        self.come.sort_unstable_by_key(T::key);
        join_equal(&mut self.come, &join);
    }

    /// Gives back each record that has come as it is now, so that what had gone is what it has become, in the order of
    /// keys.
    #[track_caller]
    fn come_back(&mut self, comm: &Comm, to: impl Fn(u64) -> usize)
    where
        T: Pod,
    {
        let (exchange, come, mine) = (&mut self.exchange, &self.come, self.mine);
        let now = |key: u64| {
            let at = come.binary_search_by_key(&key, T::key);
            come[at.expect("a record has come")]
        };
        for peer in exchange.outgoing_all() {
            peer.answer(|mut bytes, answers| {
                while !bytes.is_empty() {
                    now(T::read(&mut bytes).key()).write(answers);
                }
            });
        }
        let same = |a: &T, b: &T| to(a.key()) == to(b.key());
        let peer = |part: &[T]| Some(to(part[0].key())).filter(|&place| place != mine);
        let number = |place: usize| place - usize::from(place > mine);
        for part in self.gone.chunk_by(same) {
            if let Some(place) = peer(part) {
                exchange.expect(number(place), size_of_val(part));
            }
        }
        exchange.post(comm);
        exchange.wait();
        for part in self.gone.chunk_by_mut(same) {
            if let Some(place) = peer(part) {
                let mut bytes = exchange.incoming(number(place));
                part.fill_with(|| T::read(&mut bytes));
            } else {
                for record in part {
                    *record = now(record.key());
                }
            }
        }
        self.gone.sort_unstable_by_key(T::key);
    }

    fn memory(&self) -> usize {
        self.exchange.memory() + size_of::<T>() * (self.gone.capacity() + self.come.capacity())
    }
}

/// Joins records of one key, which follow each other.
fn join_equal<T: Record>(records: &mut Vec<T>, join: impl Fn(&mut T, &T)) {
    records.dedup_by(|next, kept| {
        let is_same = next.key() == kept.key();
        if is_same {
            join(kept, next);
        }
        is_same
    });
}

/// Takes records to their receivers, and what they have become back. Buffers are kept from one time to the next.
pub struct Relay<T> {
    receivers: Receivers,
    /// Within rows of ranks, then within columns.
    ways: [Way<T>; 2],
}

impl<T: Record> Relay<T> {
    /// To these receivers.
    #[must_use]
    pub fn new(receivers: Receivers) -> Self {
        Self {
            receivers,
            ways: Default::default(),
        }
    }

    /// Sends all ranks' `records`; what is left in them has no meaning. `join` joins the second of two records of one key
    /// with the first, in any order. Gives those that have come to this rank, by keys. Collective.
    #[track_caller]
    pub fn send(
        &mut self,
        comm: &Comm,
        records: &mut Vec<T>,
        join: impl Fn(&mut T, &T),
    ) -> &mut Vec<T> {
        let (rows, receivers, rank) = (Rows::of(comm.size()), self.receivers, comm.rank());
        let [across, along] = &mut self.ways;
        std::mem::swap(&mut across.gone, records);
        let row;
        [row, across.mine] = rows.in_row(rank);
        across.go(
            comm,
            rows.row(row),
            |key| rows.receiver(receivers, key)[0],
            &join,
        );
        std::mem::swap(&mut along.gone, &mut across.come);
        let column;
        [column, along.mine] = rows.in_column(rank);
        along.go(
            comm,
            rows.column(column),
            |key| rows.receiver(receivers, key)[1],
            &join,
        );
        &mut along.come
    }

    /// After [`Self::send`]: gives this rank one record of each key that it has sent, as it is now where it has come to, by
    /// keys. Collective.
    #[track_caller]
    pub fn come_back(&mut self, comm: &Comm, records: &mut Vec<T>)
    where
        T: Pod,
    {
        let (rows, receivers) = (Rows::of(comm.size()), self.receivers);
        let [across, along] = &mut self.ways;
        along.come_back(comm, |key| rows.receiver(receivers, key)[1]);
        std::mem::swap(&mut along.gone, &mut across.come);
        across.come_back(comm, |key| rows.receiver(receivers, key)[0]);
        std::mem::swap(&mut across.gone, records);
    }

    /// Bytes allocated.
    #[must_use]
    pub fn memory(&self) -> usize {
        self.ways.iter().map(Way::memory).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Machine, virtual_ranks};
    use super::*;

    #[derive(Debug, Clone, Copy, PartialEq, Eq, bytemuck::Pod, bytemuck::Zeroable)]
    #[repr(C)]
    struct Count {
        key: u64,
        count: u64,
    }

    impl PlainRecord for Count {
        fn key(&self) -> u64 {
            self.key
        }
    }

    fn add(all: &mut Count, one: &Count) {
        all.count += one.count;
    }

    #[test]
    fn all_ranks_have_a_place_and_keys_are_shared_evenly() {
        for ranks in (1..200).chain([1000, 9973, 10_000]) {
            let rows = Rows::of(ranks);
            for rank in 0..ranks {
                let [row, place] = rows.in_row(rank);
                assert_eq!(rows.row(row).nth(place), Some(rank));
                let [column, place] = rows.in_column(rank);
                // Each row has a rank in it, so that whoever sends finds one.
                assert!(column < rows.width && place <= rows.count);
                assert_eq!(rows.column(column).nth(place), Some(rank));
            }
            assert!(rows.count + rows.width <= 2 * ranks.isqrt() + 2);
            let mut counts = vec![0; ranks];
            for key in 0..100 * ranks as u64 {
                let [column, place] = rows.receiver(Receivers::Owners, key);
                counts[rows.column(column).nth(place).unwrap()] += 1;
            }
            assert!(
                counts.iter().all(|count| (90..=110).contains(count)),
                "{ranks}"
            );
        }
    }

    /// Each rank writes to some, at times to itself, in two rounds.
    #[test]
    fn records_come_to_whom_they_name() {
        for ranks in [1, 2, 3, 5, 7, 12, 30] {
            virtual_ranks(ranks, Machine::IDEAL, |comm| {
                let (me, ranks) = (comm.rank() as u64, ranks as u64);
                let writes = |from: u64, to: u64| (from * to + to).is_multiple_of(3);
                let mut relay = Relay::new(Receivers::Named);
                for round in 1..3 {
                    let to = (0..ranks).filter(|&to| writes(me, to));
                    let record = |from: u64, to: u64| Count {
                        key: to << 32 | from,
                        count: from * round,
                    };
                    let mut records: Vec<Count> = to.map(|to| record(me, to)).collect();
                    let come = relay.send(comm, &mut records, |_, _| unreachable!());
                    let wanted = (0..ranks).filter(|&from| writes(from, me));
                    assert!(wanted.map(|from| record(from, me)).eq(come.iter().copied()));
                }
            });
        }
    }

    /// A key of all ranks, one of every third, one of each alone.
    #[test]
    fn records_of_a_key_are_one_and_come_back() {
        for ranks in [1, 2, 3, 4, 5, 7, 12, 30] {
            for receivers in [Receivers::Owners, Receivers::Root] {
                let held = virtual_ranks(ranks, Machine::IDEAL, |comm| {
                    let rank = comm.rank() as u64;
                    let mut relay = Relay::new(receivers);
                    let mut held = 0;
                    for round in 1..3 {
                        let keys = [7, 1000 + rank / 3, 7, 5000 + rank];
                        let one = |key| Count { key, count: round };
                        let mut records: Vec<Count> = keys.map(one).to_vec();
                        let come = relay.send(comm, &mut records, add);
                        held = come.len();
                        assert!(come.is_sorted_by_key(|record| record.key));
                        relay.come_back(comm, &mut records);
                        let size = comm.size() as u64;
                        let of_third = (size - rank / 3 * 3).min(3);
                        let expected =
                            [(7, 2 * size), (1000 + rank / 3, of_third), (5000 + rank, 1)];
                        let expected = expected.map(|(key, times)| Count {
                            key,
                            count: times * round,
                        });
                        assert_eq!(records, expected);
                    }
                    held
                });
                assert_eq!(held.iter().sum::<usize>(), ranks + ranks.div_ceil(3) + 1);
                if receivers == Receivers::Root {
                    assert!(held[1..].iter().all(|&held| held == 0));
                }
            }
        }
    }
}
