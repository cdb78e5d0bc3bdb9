//! Why a run may stop early: signals, a file, the clock, a time the user named.

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use signal_hook::consts::{SIGTERM, SIGUSR1, SIGUSR2};

/// Wishes of a rank, as bits of a vote.
const SIGNAL: u64 = 1;
const FILE: u64 = 2;
const CLOCK: u64 = 4;

/// Seconds between two looks at the file system.
const LOOK_EVERY: Duration = Duration::from_secs(1);

/// Watches for reasons to stop.
pub struct Watch {
    signalled: Arc<AtomicBool>,
    file: Option<std::path::PathBuf>,
    start: Instant,
    limit: Option<Duration>,
    looked: Instant,
    seen: bool,
}

impl Watch {
    /// Watches SIGTERM, SIGUSR1 and SIGUSR2 on every rank, and the file `stop` in the run folder
    /// where `folder` is given (rank 0), and the clock.
    pub fn new(folder: Option<&Path>, limit: Option<Duration>) -> Self {
        let signalled = Arc::new(AtomicBool::new(false));
        for signal in [SIGTERM, SIGUSR1, SIGUSR2] {
            // Without the handler a signal ends the process as it would have anyway.
            let _ = signal_hook::flag::register(signal, Arc::clone(&signalled));
        }
        Self {
            signalled,
            file: folder.map(|folder| folder.join("stop")),
            start: Instant::now(),
            limit,
            looked: Instant::now(),
            seen: false,
        }
    }

    /// Starts the clock of `--walltime` earlier, at the program's start.
    pub fn since(mut self, start: Instant) -> Self {
        self.start = start;
        self
    }

    /// This rank's wishes now.
    pub fn wishes(&mut self) -> u64 {
        if let Some(file) = &self.file
            && self.looked.elapsed() >= LOOK_EVERY
        {
            self.looked = Instant::now();
            self.seen = file.exists();
        }
        let mut wishes = 0;
        if self.signalled.load(Ordering::Relaxed) {
            wishes |= SIGNAL;
        }
        if self.seen {
            wishes |= FILE;
        }
        if self
            .limit
            .is_some_and(|limit| self.start.elapsed() >= limit)
        {
            wishes |= CLOCK;
        }
        wishes
    }
}

/// Why all ranks stop, in words; `None` if nobody wishes to.
pub fn reason(wishes: u64) -> Option<&'static str> {
    if wishes & SIGNAL != 0 {
        Some("a signal asked to stop")
    } else if wishes & FILE != 0 {
        Some("the file `stop` asked to stop")
    } else if wishes & CLOCK != 0 {
        Some("the wall time is used up")
    } else {
        None
    }
}

/// Parses a duration such as `90`, `90s`, `15min`, `2h` or `1:30:00`.
pub fn parse_walltime(text: &str) -> Result<Duration, String> {
    let wrong = || format!("`{text}` is no wall time; write 90s, 15min, 2h or 1:30:00");
    let seconds = if text.contains(':') {
        let mut total = 0.0;
        for part in text.split(':') {
            total = total * 60.0 + part.parse::<f64>().map_err(|_| wrong())?;
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
    fn wall_times() {
        for (text, seconds) in [("90", 90), ("90s", 90), ("15min", 900), ("1:30:00", 5400)] {
            assert_eq!(parse_walltime(text), Ok(Duration::from_secs(seconds)));
        }
        assert!(parse_walltime("soon").is_err());
        assert!(parse_walltime("-3s").is_err());
    }
}
