//! Random inputs, surfaces, files of particles, checkpoints and snapshots: whatever is wrong is told, nothing panics, hangs or
//! takes more memory than it should.
//!
//! What a message says, but for its names and numbers, tells how far a reader came; what reaches a
//! new message is changed further. `make test` makes a short run of this, `make fuzz` one of ten
//! minutes each, which keeps the shortest of its new texts and files in `tests/fuzz/`, and `make
//! fuzz-memory` lets valgrind watch the reading of files. What panics is kept there too and tried
//! first from then on.

mod changes;
mod files;
mod guard;
mod meshes;
mod particles;
#[path = "../common/project.rs"]
mod project;
#[path = "../common/random.rs"]
mod random;
mod texts;
mod told;

use std::collections::BTreeSet;
use std::path::PathBuf;
use std::time::{Duration, Instant};

use random::Random;

/// How long to go on.
pub struct Budget {
    executions: usize,
    until: Option<Instant>,
}

impl Budget {
    /// The seconds in `WHIPPLE_FUZZ_SECONDS`, or so many executions.
    #[must_use]
    pub fn new(executions: usize) -> Self {
        let seconds = std::env::var("WHIPPLE_FUZZ_SECONDS").ok();
        let seconds = seconds.and_then(|text| text.parse().ok());
        let until = seconds.map(|seconds| Instant::now() + Duration::from_secs(seconds));
        Self { executions, until }
    }

    /// True if new texts are kept.
    #[must_use]
    pub fn keeps(&self) -> bool {
        self.until.is_some()
    }

    /// True if to go on after so many.
    #[must_use]
    pub fn allows(&self, done: usize) -> bool {
        match self.until {
            Some(until) => Instant::now() < until,
            None => done < self.executions,
        }
    }
}

/// Random numbers; other ones each time when there is time to spend.
#[must_use]
pub fn random(budget: &Budget) -> Random {
    let clock = std::time::SystemTime::now().duration_since(std::time::UNIX_EPOCH);
    Random::new(match clock {
        Ok(now) if budget.keeps() => now.as_secs(),
        _ => 1,
    })
}

/// Where texts are kept.
#[must_use]
pub fn folder() -> PathBuf {
    crate::project::root().join("tests/fuzz")
}

/// Messages met so far, without what is in quotes, numbers and places.
#[derive(Default)]
pub struct Met(BTreeSet<String>);

impl Met {
    /// True if a message is a new one.
    pub fn is_new(&mut self, message: &str) -> bool {
        let title = message.lines().next().unwrap_or_default();
        // With half a quotation of the text in it nobody knows what are its own words.
        if ['`', '"']
            .iter()
            .any(|&quote| title.matches(quote).count() % 2 == 1)
        {
            return false;
        }
        let plain = title.split(['`', '"']).step_by(2).collect::<String>();
        let plain = plain.chars().filter(char::is_ascii_alphabetic);
        // The begin of a message: what is quoted may have quotes of its own.
        self.0.insert(plain.take(30).collect())
    }

    /// How many there are.
    #[must_use]
    pub fn count(&self) -> usize {
        self.0.len()
    }
}
