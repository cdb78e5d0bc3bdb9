//! The clock of a virtual rank, which is its thread.

use std::cell::{Cell, RefCell};
use std::collections::BTreeMap;
use std::panic::Location;
use std::time::{Duration, Instant};

use super::Computing;

thread_local! {
    static CLOCK: Cell<Option<Clock>> = const { Cell::new(None) };
    static CALLS: RefCell<BTreeMap<Call, CallTraffic>> = const { RefCell::new(BTreeMap::new()) };
}

/// A place in the source that calls this crate.
pub type Call = &'static Location<'static>;

/// Traffic of a virtual rank by one call in the source so far.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct CallTraffic {
    /// Messages to peers, and collective calls.
    pub messages: u64,
    /// Bytes sent to peers, or that the rank gave to collective calls.
    pub sent: u64,
    /// Bytes received from peers by the same call there, or that the rank was given by collective calls.
    pub received: u64,
}

/// Counts traffic of a call.
pub fn count(call: Call, traffic: CallTraffic) {
    CALLS.with_borrow_mut(|calls| {
        let all = calls.entry(call).or_default();
        all.messages += traffic.messages;
        all.sent += traffic.sent;
        all.received += traffic.received;
    });
}

/// The traffic of this thread's rank so far, by call.
pub fn calls() -> BTreeMap<Call, CallTraffic> {
    CALLS.with_borrow(Clone::clone)
}

/// Time and messages of a virtual rank so far.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct VirtualTime {
    /// Seconds since the start: [`Self::computing`] and [`Self::waiting`].
    pub now: f64,
    /// Seconds that the rank has computed.
    pub computing: f64,
    /// Seconds that it has waited for messages and for others, while nothing was left to compute:
    /// communication that no computing hides.
    pub waiting: f64,
    /// Messages sent to peers, those with sizes among them.
    pub messages: u64,
    /// Bytes sent to peers.
    pub bytes: u64,
    /// Collective calls.
    pub collectives: u64,
}

/// The clock of this thread.
#[derive(Debug, Clone, Copy)]
pub struct Clock {
    computing: Computing,
    time: VirtualTime,
    /// Time at which the last of the own messages has left (s).
    sent: f64,
    /// Start of the thread, and its processor time when it computed last.
    began: Instant,
    processor: Duration,
}

impl Clock {
    /// Starts the clock of this thread.
    pub fn start(computing: Computing) {
        CLOCK.set(Some(Self {
            computing,
            time: VirtualTime::default(),
            sent: 0.0,
            began: Instant::now(),
            processor: processor_time(),
        }));
    }

    /// Adds the time that this thread has computed, lets a call of this module read and set the clock,
    /// and leaves out the processor time of that call. Returns the result of the call.
    ///
    /// # Panics
    /// If the thread has no clock.
    pub fn with<T>(call: impl FnOnce(&mut Self) -> T) -> T {
        let mut clock = Self::read().expect("a virtual rank stays on its thread");
        let result = call(&mut clock);
        clock.processor = processor_time();
        CLOCK.set(Some(clock));
        result
    }

    /// The clock of this thread up to now.
    fn read() -> Option<Self> {
        let mut clock = CLOCK.get()?;
        if clock.computing == Computing::Measured {
            let processor = processor_time();
            clock.compute(processor.saturating_sub(clock.processor).as_secs_f64());
            clock.processor = processor;
        }
        Some(clock)
    }

    /// Advances by seconds of computing.
    pub fn compute(&mut self, seconds: f64) {
        self.time.computing += seconds;
        self.time.now += seconds;
    }

    /// Time and messages so far.
    pub fn time(&self) -> VirtualTime {
        self.time
    }

    /// Advances to a time (s) if that is later: the rank waits.
    pub fn wait(&mut self, until: f64) {
        if until > self.time.now {
            self.time.waiting += until - self.time.now;
            self.time.now = until;
        }
    }

    /// Counts a collective call.
    pub fn count_collective(&mut self) {
        self.time.collectives += 1;
    }

    /// Sends `messages` of `bytes` together, after what was sent before. Returns the time (s) at which all
    /// have left.
    pub fn send(&mut self, messages: u64, bytes: u64, bandwidth: f64) -> f64 {
        self.time.messages += messages;
        self.time.bytes += bytes;
        #[allow(clippy::cast_precision_loss, reason = "a time")]
        let takes = bytes as f64 / bandwidth;
        self.sent = self.sent.max(self.time.now) + takes;
        self.sent
    }
}

/// Time that this thread, if it is a virtual rank, has waited for others or for a core. Where computing
/// time is reported it is all time.
pub fn waited() -> Option<Duration> {
    let clock = Clock::read()?;
    let all = clock.began.elapsed();
    Some(match clock.computing {
        Computing::Reported => all,
        Computing::Measured => {
            let computing = Duration::try_from_secs_f64(clock.time.computing);
            all.saturating_sub(computing.unwrap_or(Duration::MAX))
        }
    })
}

/// Processor time of this thread since it began.
fn processor_time() -> Duration {
    let mut time = libc::timespec {
        tv_sec: 0,
        tv_nsec: 0,
    };
    // SAFETY: the call writes to `time` alone.
    unsafe { libc::clock_gettime(libc::CLOCK_THREAD_CPUTIME_ID, &raw mut time) };
    let seconds = u64::try_from(time.tv_sec).unwrap_or(0);
    Duration::new(seconds, u32::try_from(time.tv_nsec).unwrap_or(0))
}
