//! Lines for the user. Each goes out in one call, so that those of two ranks do not mix; and that
//! nobody listens any more (a closed pipe) is no reason to end a run. Names, paths and words of the
//! command line may hold control characters, which never reach the terminal as such.

use std::io::Write;

use crate::model::readable::{printable, shown};

/// A line of output.
pub fn say(line: &str) {
    let mut stdout = std::io::stdout().lock();
    let _ = stdout.write_all(format!("{}\n", printable(line)).as_bytes());
    let _ = stdout.flush();
}

/// A diagnostic or a warning, which may have several lines.
pub fn warn(text: &str) {
    let _ = std::io::stderr().write_all(format!("{}\n", printable(text.trim_end())).as_bytes());
}

/// A time (s), for people.
#[must_use]
pub fn seconds(time: f64) -> String {
    shown(time, "s")
}

/// A number of things.
#[must_use]
pub fn counted(number: u64, thing: &str) -> String {
    let plural = if number == 1 { "" } else { "s" };
    format!("{number} {thing}{plural}")
}
