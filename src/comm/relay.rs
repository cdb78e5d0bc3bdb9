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
    /// All, or all but some √P, each its share of the keys.
    Owners,
    /// The same, with one owner for all keys of an upper half.
    OwnersByUpperHalf,
    /// Rank 0.
    Root,
}

/// Ranks in rows as even as whole numbers allow. All rows have the first `width` columns; ranks of the column
/// after them, which some rows have, receive no records.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Rows {
    count: usize,
    width: usize,
    /// The first rows, so many, have one rank more.
    longer: usize,
}

impl Rows {
    fn of(ranks: usize) -> Self {
        let count = ranks.isqrt();
        Self {
            count,
            width: ranks / count,
            longer: ranks % count,
        }
    }

    /// The rank at a row and a column.
    fn rank(self, [row, column]: [usize; 2]) -> usize {
        row * self.width + row.min(self.longer) + column
    }

    /// Row and column of a rank.
    fn place(self, rank: usize) -> [usize; 2] {
        let begun = self.longer * (self.width + 1);
        if rank < begun {
            return [rank / (self.width + 1), rank % (self.width + 1)];
        }
        let rest = rank - begun;
        [self.longer + rest / self.width, rest % self.width]
    }

    /// The columns of a row.
    fn columns(self, row: usize) -> usize {
        self.width + usize::from(row < self.longer)
    }

    /// Row and column to which records of a key go.
    fn receiver(self, receivers: Receivers, key: u64) -> [usize; 2] {
        let key = match receivers {
            Receivers::Owners => key,
            Receivers::OwnersByUpperHalf => key >> 32,
            Receivers::Root => return [0, 0],
        };
        // By the upper bits of a product with 2⁶⁴ over the golden ratio, which spreads keys that follow each other
        // (Knuth, The Art of Computer Programming 3, 6.4).
        let hash = key.wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 32;
        let share = (hash * (self.count * self.width) as u64) >> 32;
        let share = usize::try_from(share).unwrap_or(0);
        [share / self.width, share % self.width]
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
        self.exchange.post_sizes(comm);
        self.exchange.post(comm);
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
        let (rows, receivers) = (Rows::of(comm.size()), self.receivers);
        let [row, column] = rows.place(comm.rank());
        let [across, along] = &mut self.ways;
        std::mem::swap(&mut across.gone, records);
        across.mine = column;
        let all = (0..rows.columns(row)).map(|column| rows.rank([row, column]));
        let to = |key| rows.receiver(receivers, key)[1];
        across.go(comm, all, to, &join);
        std::mem::swap(&mut along.gone, &mut across.come);
        along.mine = row;
        let all = (0..rows.count).map(|row| rows.rank([row, column]));
        let all = all.filter(|_| column < rows.width);
        let to = |key| rows.receiver(receivers, key)[0];
        along.go(comm, all, to, &join);
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
        along.come_back(comm, |key| rows.receiver(receivers, key)[0]);
        std::mem::swap(&mut along.gone, &mut across.come);
        across.come_back(comm, |key| rows.receiver(receivers, key)[1]);
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
                let [row, column] = rows.place(rank);
                assert!(row < rows.count && column < rows.columns(row));
                assert_eq!(rows.rank([row, column]), rank);
            }
            assert!(rows.count + rows.width <= 2 * ranks.isqrt() + 2);
            let receivers = rows.count * rows.width;
            assert!(receivers + rows.count > ranks);
            let mut counts = vec![0; receivers];
            for key in 0..100 * receivers as u64 {
                let [row, column] = rows.receiver(Receivers::Owners, key);
                counts[row * rows.width + column] += 1;
            }
            assert!(
                counts.iter().all(|count| (90..=110).contains(count)),
                "{ranks}"
            );
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
