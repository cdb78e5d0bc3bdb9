//! What virtual ranks share: messages under way, and where they meet.

use std::collections::BTreeMap;
use std::panic::resume_unwind;
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};

/// What messages between two ranks are told apart by.
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
    /// How many.
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

/// A message, and when it is there (s).
pub struct Letter {
    /// What it says.
    pub bytes: Vec<u8>,
    /// The time.
    pub arrival: f64,
}

/// What a rank ends with that another one's trouble ends.
pub struct Abandoned;

/// All ranks.
pub struct World {
    state: Mutex<State>,
    /// For each rank, that what it waits for has come.
    calls: Vec<Condvar>,
}

struct State {
    ranks: Vec<Mailbox>,
    meetings: BTreeMap<Group, Meeting>,
    /// Ranks that neither wait nor have ended.
    running: usize,
    /// Whether a rank met trouble, which ends all.
    is_over: bool,
}

/// What one rank has to do with others.
#[derive(Default)]
struct Mailbox {
    /// Messages that nobody has received yet.
    letters: BTreeMap<Ticket, Letter>,
    /// How many messages were sent here, and how many are expected or received.
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
    /// When the last one came, and what the call costs (s).
    latest: f64,
    cost: f64,
    /// Of the last call that all have come to: its words, and its end (s). All read it before any
    /// of them can end the next.
    done: (Arc<Vec<u64>>, f64),
}

impl World {
    /// So many ranks, all of them running.
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
    pub fn send(&self, group: Group, (from, to, tag): (usize, usize, Tag), letter: Letter) {
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
    pub fn expect(&self, group: Group, (me, from, tag): (usize, usize, Tag)) -> Ticket {
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

    /// Adds this rank's words to those of the others of a group that have come, at a time and with a
    /// cost (s); waits for all of them. Gives the words and the end (s).
    pub fn meet(
        &self,
        group: Group,
        me: usize,
        (now, cost): (f64, f64),
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

    /// Takes leave of a rank that has nothing more to do.
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

    /// Waits until somebody [calls](Self::call).
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

    /// Tells a rank that what it waits for has come.
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

/// Leaves if the trouble of some rank has ended all, without a word of its own.
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
