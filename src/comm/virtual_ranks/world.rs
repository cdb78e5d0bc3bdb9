//! State shared by virtual ranks: messages under way, and collective calls.

use std::collections::BTreeMap;
use std::panic::resume_unwind;
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};

use super::clock::Call;

/// Purpose of a message, which distinguishes messages between two ranks.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Tag {
    /// The size of another.
    Size,
    /// The bytes of an exchange.
    Data,
}

/// Ranks in a row, which number each other from zero.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Group {
    /// The first of them, as the world numbers it.
    pub first: usize,
    /// Number of ranks.
    pub size: usize,
}

/// A message that will come: sender, tag and its number among those of both in a group.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Ticket {
    /// The group.
    pub group: Group,
    /// The sender.
    pub from: usize,
    /// The tag.
    pub tag: Tag,
    /// The number.
    pub number: u64,
}

/// A message on its way.
pub struct Letter {
    /// The payload.
    pub bytes: Vec<u8>,
    /// Time of arrival (s).
    pub arrival: f64,
    /// The call that has sent it.
    pub call: Call,
}

/// Panic payload of a rank that ends because another one failed.
pub struct Abandoned;

/// All ranks.
pub struct World {
    state: Mutex<State>,
    /// For each rank, notified when its message or meeting is there.
    calls: Vec<Condvar>,
}

struct State {
    ranks: Vec<Mailbox>,
    meetings: BTreeMap<Group, Meeting>,
    /// Ranks that neither wait nor have ended.
    running: usize,
    /// Set when a rank has failed, which ends all.
    is_over: bool,
}

/// Messages to one rank.
#[derive(Default)]
struct Mailbox {
    /// Messages not received yet.
    letters: BTreeMap<Ticket, Letter>,
    /// Numbers of messages that were sent here, and of those expected or received.
    sent: BTreeMap<(Group, usize, Tag), u64>,
    expected: BTreeMap<(Group, usize, Tag), u64>,
    waits: Option<Awaited>,
}

#[derive(PartialEq)]
enum Awaited {
    Letter(Ticket),
    Meeting,
}

/// A collective call.
#[derive(Default)]
struct Meeting {
    arrived: usize,
    words: Vec<u64>,
    /// Time of the last arrival, and cost of the call (s).
    latest: f64,
    cost: f64,
    /// Words and end (s) of the last completed call. All read it before any of them can end the next.
    done: (Arc<Vec<u64>>, f64),
}

impl World {
    /// A number of ranks, all of them running.
    pub fn new(ranks: usize) -> Self {
        Self {
            state: Mutex::new(State {
                ranks: (0..ranks).map(|_| Mailbox::default()).collect(),
                meetings: BTreeMap::new(),
                running: ranks,
                is_over: false,
            }),
            calls: (0..ranks).map(|_| Condvar::new()).collect(),
        }
    }

    /// Puts a message into the mailbox of its receiver.
    pub fn send(&self, group: Group, from: usize, to: usize, tag: Tag, letter: Letter) {
        let to = group.first + to;
        let mut state = self.enter();
        let mailbox = &mut state.ranks[to];
        let ticket = next(&mut mailbox.sent, (group, from, tag));
        mailbox.letters.insert(ticket, letter);
        if mailbox.waits == Some(Awaited::Letter(ticket)) {
            self.call(&mut state, to);
        }
    }

    /// Numbers the next message that `me` is to receive from a rank.
    pub fn expect(&self, group: Group, me: usize, from: usize, tag: Tag) -> Ticket {
        let mut state = self.enter();
        let mailbox = &mut state.ranks[group.first + me];
        next(&mut mailbox.expected, (group, from, tag))
    }

    /// Waits for a message.
    pub fn receive(&self, me: usize, ticket: Ticket) -> Letter {
        let me = ticket.group.first + me;
        let mut state = self.enter();
        loop {
            if let Some(letter) = state.ranks[me].letters.remove(&ticket) {
                return letter;
            }
            state = self.wait(state, me, Awaited::Letter(ticket));
        }
    }

    /// Adds this rank's words to those of the ranks of a group that have arrived, at a time and with a
    /// cost (s); waits for all of them. Returns the words and the end (s).
    pub fn meet(
        &self,
        group: Group,
        me: usize,
        now: f64,
        cost: f64,
        add: impl FnOnce(&mut Vec<u64>),
    ) -> (Arc<Vec<u64>>, f64) {
        let me = group.first + me;
        let mut state = self.enter();
        let meeting = state.meetings.entry(group).or_default();
        add(&mut meeting.words);
        meeting.latest = meeting.latest.max(now);
        meeting.cost = meeting.cost.max(cost);
        meeting.arrived += 1;
        if meeting.arrived < group.size {
            state = self.wait(state, me, Awaited::Meeting);
        } else {
            let met = std::mem::take(meeting);
            meeting.done = (Arc::new(met.words), met.latest + met.cost);
            let all = group.first..group.first + group.size;
            for other in all.filter(|&other| other != me) {
                self.call(&mut state, other);
            }
        }
        state.meetings[&group].done.clone()
    }

    /// Ends a rank that has nothing more to do.
    pub fn end(&self) {
        self.stop_one(&mut self.enter());
    }

    /// Ends all ranks where they wait next.
    pub fn give_up(&self) {
        self.give_up_in(&mut self.state());
    }

    fn give_up_in(&self, state: &mut State) {
        state.is_over = true;
        self.calls.iter().for_each(Condvar::notify_one);
    }

    /// Waits for a [call](Self::call).
    fn wait<'a>(
        &'a self,
        mut state: MutexGuard<'a, State>,
        me: usize,
        awaited: Awaited,
    ) -> MutexGuard<'a, State> {
        state.ranks[me].waits = Some(awaited);
        self.stop_one(&mut state);
        let is_idle = |state: &mut State| state.ranks[me].waits.is_some() && !state.is_over;
        let state = self.calls[me]
            .wait_while(state, is_idle)
            .unwrap_or_else(PoisonError::into_inner);
        going_on(state)
    }

    /// One rank less is running.
    fn stop_one(&self, state: &mut State) {
        state.running -= 1;
        let waits = |mailbox: &Mailbox| mailbox.waits.is_some();
        if state.running == 0 && state.ranks.iter().any(waits) {
            self.give_up_in(state);
            panic!("no rank is running, and some wait for others");
        }
    }

    /// Wakes a rank whose message or meeting is there.
    fn call(&self, state: &mut State, rank: usize) {
        state.ranks[rank].waits = None;
        state.running += 1;
        self.calls[rank].notify_one();
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn enter(&self) -> MutexGuard<'_, State> {
        going_on(self.state())
    }
}

/// Unwinds silently if the failure of some rank has ended all.
fn going_on(state: MutexGuard<'_, State>) -> MutexGuard<'_, State> {
    if state.is_over {
        drop(state);
        resume_unwind(Box::new(Abandoned));
    }
    state
}

fn next(counts: &mut BTreeMap<(Group, usize, Tag), u64>, of: (Group, usize, Tag)) -> Ticket {
    let count = counts.entry(of).or_default();
    *count += 1;
    let (group, from, tag) = of;
    Ticket {
        group,
        from,
        tag,
        number: *count,
    }
}
