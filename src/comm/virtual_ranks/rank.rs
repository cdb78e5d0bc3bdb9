//! One virtual rank: its messages and collective calls, and their costs.
//!
//! Costs of collective calls are those of binary trees (Thakur, Rabenseifner & Gropp 2005,
//! doi:10.1177/1094342005051521).

use std::ops::Range;
use std::panic::Location;
use std::sync::Arc;

use super::clock::{CallTraffic, Clock, VirtualTime, count};
use super::world::{Group, Letter, Tag, Ticket, World};
use super::{Computing, Machine};

/// A rank on its own thread, in a group of ranks.
#[derive(Clone)]
pub struct Rank {
    /// In the group.
    number: usize,
    group: Group,
    machine: Machine,
    world: Arc<World>,
}

#[allow(clippy::cast_precision_loss, reason = "sizes and numbers, for a time")]
impl Rank {
    pub(super) fn new(number: usize, size: usize, machine: Machine, world: Arc<World>) -> Self {
        Self {
            number,
            group: Group { first: 0, size },
            machine,
            world,
        }
    }

    /// The same rank among some members of its group, itself one of them.
    pub fn among(&self, members: &Range<usize>) -> Self {
        Self {
            number: self.number - members.start,
            group: Group {
                first: self.group.first + members.start,
                size: members.len(),
            },
            ..self.clone()
        }
    }

    /// Its number.
    pub fn number(&self) -> usize {
        self.number
    }

    /// Number of ranks.
    pub fn size(&self) -> usize {
        self.group.size
    }

    /// Its time and messages so far.
    pub fn time() -> VirtualTime {
        Clock::with(|clock| clock.time())
    }

    /// Adds seconds of computing, where they are reported.
    pub fn compute(&self, seconds: f64) {
        if self.machine.computing == Computing::Reported {
            Clock::with(|clock| clock.compute(seconds));
        }
    }

    /// Sends bytes in `messages` messages; returns at once.
    #[track_caller]
    pub fn send(&self, to: usize, tag: Tag, bytes: &[u8], messages: u64) {
        let call = Location::caller();
        Clock::with(|clock| {
            let sent = bytes.len() as u64;
            let left = clock.send(messages, sent, self.machine.bandwidth);
            let traffic = CallTraffic {
                messages,
                sent,
                received: 0,
            };
            count(call, traffic);
            let letter = Letter {
                bytes: bytes.to_vec(),
                arrival: left + self.machine.latency,
                call,
            };
            self.world.send(self.group, self.number, to, tag, letter);
        });
    }

    /// Begins to receive the next message of a rank, of those that were not begun yet.
    pub fn expect(&self, from: usize, tag: Tag) -> Ticket {
        Clock::with(|_| self.world.expect(self.group, self.number, from, tag))
    }

    /// Waits for a message.
    pub fn receive(&self, ticket: Ticket) -> Vec<u8> {
        Clock::with(|clock| {
            let letter = self.world.receive(self.number, ticket);
            clock.wait(letter.arrival);
            let traffic = CallTraffic {
                received: letter.bytes.len() as u64,
                ..CallTraffic::default()
            };
            count(letter.call, traffic);
            letter.bytes
        })
    }

    /// Waits for all ranks.
    #[track_caller]
    pub fn barrier(&self) {
        self.meet(self.tree(1.0, 0.0), [0; 2], |_| {});
    }

    /// Combines words with those of all ranks, in any order: `combine` adds the second ones to the first.
    #[track_caller]
    pub fn reduce(&self, words: &mut [u64], combine: impl Fn(&mut [u64], &[u64])) {
        let bytes = size_of_val(words);
        let cost = self.tree(1.0, bytes as f64);
        let all = self.meet(cost, [bytes; 2], |all| {
            if all.is_empty() {
                all.extend_from_slice(words);
                return;
            }
            assert_eq!(all.len(), words.len(), "all ranks reduce as many words");
            combine(all, words);
        });
        words.copy_from_slice(&all);
    }

    /// Joins the words of all ranks in their order.
    #[track_caller]
    pub fn all_gather(&self, words: &[u64], joined: &mut [u64]) {
        let others = (self.size() - 1) * size_of_val(words);
        let cost = self.tree(1.0, 0.0) + others as f64 / self.machine.bandwidth;
        let bytes = [words, joined].map(size_of_val);
        let all = self.meet(cost, bytes, |all| {
            all.resize(joined.len(), 0);
            let first = self.number * words.len();
            all[first..first + words.len()].copy_from_slice(words);
        });
        joined.copy_from_slice(&all);
    }

    /// Sends all ranks the bytes of one, after their number.
    #[track_caller]
    pub fn broadcast(&self, from: usize, bytes: &mut Vec<u8>) {
        let is_sender = from == self.number;
        let cost = if is_sender {
            let number = self.tree(1.0, 8.0);
            let pieces = if bytes.is_empty() { 0.0 } else { 1.0 };
            number + self.tree(pieces, bytes.len() as f64)
        } else {
            0.0
        };
        let sent = if is_sender { bytes.len() } else { 0 };
        let all = self.meet(cost, [sent, 0], |all| {
            if is_sender {
                all.push(bytes.len() as u64);
                all.resize(1 + bytes.len().div_ceil(8), 0);
                bytemuck::cast_slice_mut(&mut all[1..])[..bytes.len()].copy_from_slice(bytes);
            }
        });
        if !is_sender {
            let length = usize::try_from(all[0]).expect("a length fits memory");
            bytes.clear();
            bytes.extend_from_slice(&bytemuck::cast_slice(&all[1..])[..length]);
            let traffic = CallTraffic {
                received: length as u64,
                ..CallTraffic::default()
            };
            count(Location::caller(), traffic);
        }
    }

    /// Meets all ranks, each of which adds to one list of words; returns it when all have. The clock
    /// advances to the last arrival plus the largest cost (s) that any of them gives. `bytes` are those that the rank
    /// gives and is given.
    #[track_caller]
    fn meet(&self, cost: f64, bytes: [usize; 2], add: impl FnOnce(&mut Vec<u64>)) -> Arc<Vec<u64>> {
        let [sent, received] = bytes.map(|bytes| bytes as u64);
        let traffic = CallTraffic {
            messages: 1,
            sent,
            received,
        };
        count(Location::caller(), traffic);
        Clock::with(|clock| {
            let now = clock.time().now;
            let (words, end) = self.world.meet(self.group, self.number, now, cost, add);
            clock.count_collective();
            clock.wait(end);
            words
        })
    }

    /// Seconds that messages and bytes take from rank to rank up or down a binary tree.
    fn tree(&self, messages: f64, bytes: f64) -> f64 {
        let levels = f64::from(self.size().next_power_of_two().trailing_zeros());
        levels * (messages * self.machine.latency + bytes / self.machine.bandwidth)
    }
}
