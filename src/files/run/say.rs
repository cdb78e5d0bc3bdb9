//! Lines for the user. Each goes out in one call, so that those of two ranks do not mix; and that
//! nobody listens any more (a closed pipe) is no reason to end a run. Names, paths and words of the
//! command line may hold control characters, which never reach the terminal as such.

use std::io::Write;

use serde_json::{Map, Value};

use super::voice::{self, Voice};
use model::readable::{printable, shown};

/// A line of output.
pub fn say(line: &str) {
    tell(line, &Map::new());
}

/// A line of output, with what it tells as values for those who read JSON.
pub fn tell(line: &str, fields: &Map<String, Value>) {
    let Voice { quiet, json } = Voice::now();
    if quiet {
        return;
    }
    if json {
        out(&voice::event("info", line, fields));
    } else {
        out(&printable(line));
    }
}

/// A line of the log, which those alone hear who read JSON.
pub fn note(line: &str) {
    if Voice::now().json {
        say(line);
    }
}

/// A JSON document, in any voice.
pub fn document(value: &Value) {
    out(&voice::document(value));
}

/// A diagnostic or a warning, which may have several lines.
pub fn warn(text: &str) {
    let text = text.trim_end();
    if Voice::now().json {
        let found = ["error", "warning"].into_iter().find_map(|level| {
            let message = text.strip_prefix(level)?.strip_prefix(": ")?;
            Some((level, message))
        });
        let (level, message) = found.unwrap_or(("warning", text));
        out(&voice::event(level, message, &Map::new()));
        return;
    }
    let _ = std::io::stderr().write_all(format!("{}\n", printable(text)).as_bytes());
}

fn out(text: &str) {
    let mut stdout = std::io::stdout().lock();
    let _ = stdout.write_all(format!("{text}\n").as_bytes());
    let _ = stdout.flush();
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
