//! Reasons to stop a run early: signals, a file, the clock, a time given by the user.

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM, SIGUSR1, SIGUSR2, SIGXCPU};
use signal_hook::flag::{register, register_conditional_shutdown};

use super::exit::EXIT_INTERRUPTED;
use crate::input;
use model::ClockInterval;

/// Requests of a rank, as bits of a vote.
const SIGNAL: u64 = 1;
const FILE: u64 = 2;
const CLOCK: u64 = 4;
/// Not to stop, but to write a checkpoint.
const CHECKPOINT: u64 = 8;

/// Assumed time of a checkpoint (s) before anything has been written, as after a restart.
const FIRST_COST: f64 = 1.0;

/// Time between two checks of the file system.
const LOOK_EVERY: Duration = Duration::from_secs(1);

/// A flag that a signal to stop this process sets.
#[derive(Debug, Clone)]
pub struct Signals(Arc<AtomicBool>);

impl Signals {
    /// Watches the signals that ask a process to end from now on; a second SIGINT ends it. What is ignored, as SIGHUP
    /// under `nohup`, stays so.
    pub fn watch() -> Self {
        let [asked, interrupted] = [(); 2].map(|()| Arc::new(AtomicBool::new(false)));
        // Without a handler a signal ends the process, as it would have anyway.
        let _ = register_conditional_shutdown(SIGINT, EXIT_INTERRUPTED, Arc::clone(&interrupted));
        let _ = register(SIGINT, interrupted);
        let ignored = ignored();
        for signal in [SIGTERM, SIGUSR1, SIGUSR2, SIGINT, SIGHUP, SIGXCPU] {
            if ignored >> (signal - 1) & 1 == 0 {
                let _ = register(signal, Arc::clone(&asked));
            }
        }
        Self(asked)
    }
}

/// The signals that this process ignores, as bits; none where the system does not tell.
fn ignored() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mut lines = status.lines();
    let bits = lines.find_map(|line| line.strip_prefix("SigIgn:"));
    bits.map_or(0, |bits| u64::from_str_radix(bits.trim(), 16).unwrap_or(0))
}

/// Watches for reasons to stop.
pub struct Watch {
    signals: Signals,
    file: Option<PathBuf>,
    start: Instant,
    limit: Option<Duration>,
    looked: Instant,
    seen: bool,
    /// Interval of checkpoints (of rank 0 alone), the end of the last one, and the predicted time of the
    /// next one (s).
    every: Option<ClockInterval>,
    last: Instant,
    cost: f64,
    /// Predicted time of a stop.
    reserve: Duration,
}

impl Watch {
    /// Watches for signals, for the file `stop` where one is named (rank 0), and the clock since
    /// `start`.
    pub fn new(
        signals: Signals,
        file: Option<PathBuf>,
        start: Instant,
        limit: Option<Duration>,
    ) -> Self {
        Self {
            signals,
            file,
            start,
            limit,
            looked: Instant::now(),
            seen: false,
            every: None,
            last: Instant::now(),
            cost: FIRST_COST,
            reserve: Duration::ZERO,
        }
    }

    /// Requests checkpoints at an interval of the clock.
    pub fn ask_every(&mut self, every: Option<ClockInterval>) {
        self.every = every;
    }

    /// Notes the time that a checkpoint took. The next one is assumed to take half as much again, and the
    /// snapshot after it half of that: this is reserved of the wall time. Returns the time to the next one if that follows from it.
    pub fn wrote_checkpoint(&mut self, took: Duration) -> Option<Duration> {
        self.last = Instant::now();
        self.cost = took.as_secs_f64();
        self.keep(took.mul_f64(2.25));
        let follows = matches!(self.every, Some(ClockInterval::Auto { .. }));
        self.interval().filter(|_| follows)
    }

    /// Time between the end of a checkpoint and the next one.
    fn interval(&self) -> Option<Duration> {
        let seconds = self.every?.seconds(self.cost);
        Duration::try_from_secs_f64(seconds).ok()
    }

    /// Notes the time that a snapshot took: a checkpoint is about twice as large.
    pub fn wrote_snapshot(&mut self, took: Duration) {
        if self.reserve.is_zero() {
            self.cost = 2.0 * took.as_secs_f64();
        }
        self.keep(took.mul_f64(4.5));
    }

    fn keep(&mut self, time: Duration) {
        self.reserve = self.reserve.max(time);
    }

    /// This rank's requests now.
    pub fn requests(&mut self) -> u64 {
        if let Some(file) = &self.file
            && self.looked.elapsed() >= LOOK_EVERY
        {
            self.looked = Instant::now();
            self.seen = file.exists();
        }
        let mut requests = 0;
        if self.signals.0.load(Ordering::Relaxed) {
            requests |= SIGNAL;
        }
        if self.seen {
            requests |= FILE;
        }
        if self
            .limit
            .is_some_and(|limit| self.start.elapsed() + self.reserve >= limit)
        {
            requests |= CLOCK;
        }
        if (self.interval()).is_some_and(|every| self.last.elapsed() >= every) {
            requests |= CHECKPOINT;
        }
        requests
    }
}

/// Returns true if the clock requests a checkpoint.
pub fn wants_checkpoint(requests: u64) -> bool {
    requests & CHECKPOINT != 0
}

/// The reason why all ranks stop, in words; `None` if there is no request.
pub fn reason(requests: u64) -> Option<&'static str> {
    if requests & SIGNAL != 0 {
        Some("a signal asked to stop")
    } else if requests & FILE != 0 {
        Some("the file `stop` asked to stop")
    } else if requests & CLOCK != 0 {
        Some("the wall time is used up")
    } else {
        None
    }
}

/// Parses a time of the simulation such as `0.1us` (s).
///
/// # Errors
/// A message on a text of another form.
pub fn parse_until(text: &str) -> Result<f64, String> {
    match input::time(text)? {
        time if time >= 0.0 => Ok(time),
        _ => Err("a run begins at time 0; give a later time, as in 0.1us".to_owned()),
    }
}

/// Parses a duration such as `90`, `90s`, `15min`, `2h` or `1:30:00`.
pub fn parse_walltime(text: &str) -> Result<Duration, String> {
    let wrong = || format!("`{text}` is no wall time; write 90s, 15min, 2h or 1:30:00");
    let seconds = if text.contains(':') {
        let mut total = 0.0;
        for field in text.split(':') {
            total = total * 60.0 + field.parse::<f64>().map_err(|_| wrong())?;
        }
        total
    } else {
        let digits = text.trim_end_matches(|c: char| c.is_alphabetic());
        let unit = match &text[digits.len()..] {
            "" | "s" => 1.0,
            "min" | "m" => 60.0,
            "h" => 3600.0,
            _ => return Err(wrong()),
        };
        digits.trim().parse::<f64>().map_err(|_| wrong())? * unit
    };
    Duration::try_from_secs_f64(seconds).map_err(|_| wrong())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_wall_time_leaves_room_for_the_next_checkpoint() {
        let limit = Some(Duration::from_secs(100));
        let signals = Signals(Arc::new(AtomicBool::new(false)));
        let mut watch = Watch::new(signals, None, Instant::now(), limit);
        watch.wrote_checkpoint(Duration::from_secs(40));
        assert_eq!(watch.requests(), 0);
        watch.wrote_snapshot(Duration::from_secs(40));
        assert_eq!(watch.requests(), CLOCK);
        assert!(!wants_checkpoint(watch.requests()));
        watch.ask_every(Some(ClockInterval::Fixed(0.0)));
        assert!(wants_checkpoint(watch.requests()));
    }

    #[test]
    fn the_time_between_checkpoints_follows_from_what_one_takes() {
        let signals = Signals(Arc::new(AtomicBool::new(false)));
        let mut watch = Watch::new(signals, None, Instant::now(), None);
        let seconds = |watch: &Watch| watch.interval().map(|time| time.as_secs());
        assert_eq!(seconds(&watch), None);
        watch.ask_every(Some(ClockInterval::Auto { failures: 20_000.0 }));
        assert_eq!(seconds(&watch), Some(200));
        // A checkpoint is some twice as large as a snapshot.
        watch.wrote_snapshot(Duration::from_secs(2));
        assert_eq!(seconds(&watch), Some(400));
        let next = watch.wrote_checkpoint(Duration::from_secs(1));
        assert_eq!(next, Some(Duration::from_secs(200)));
        watch.wrote_snapshot(Duration::from_secs(20));
        assert_eq!(seconds(&watch), Some(200));
        watch.ask_every(Some(ClockInterval::Fixed(7.0)));
        assert_eq!(watch.wrote_checkpoint(Duration::from_secs(1)), None);
        assert_eq!(seconds(&watch), Some(7));
    }

    #[test]
    fn wall_times() {
        for (text, seconds) in [("90", 90), ("90s", 90), ("15min", 900), ("1:30:00", 5400)] {
            assert_eq!(parse_walltime(text), Ok(Duration::from_secs(seconds)));
        }
        assert!(parse_walltime("soon").is_err());
        assert!(parse_walltime("-3s").is_err());
    }
}
