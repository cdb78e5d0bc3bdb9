//! Lines for the user. Each goes out in one call, so that those of two ranks do not mix. A closed pipe
//! is no reason to end a run; any other loss of output makes the program fail at its end. Names, paths and words of the
//! command line may hold control characters, which never reach the terminal as such.

use std::io::{self, ErrorKind, Write};
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};

use serde_json::{Map, Value};

use super::exit::EXIT_FAILED;
use super::verbosity::{self, Verbosity};
use model::readable::{printable, shown};

/// Prints a line of output.
pub fn say(line: &str) {
    report(line, &Map::new());
}

/// Prints a line of output, in JSON with its values as fields.
pub fn report(line: &str, fields: &Map<String, Value>) {
    let Verbosity { quiet, json } = Verbosity::now();
    if quiet {
        return;
    }
    if json {
        out(&verbosity::event("info", line, fields));
    } else {
        out(&printable(line));
    }
}

/// Prints a line of the log, in JSON output only.
pub fn note(line: &str) {
    if Verbosity::now().json {
        say(line);
    }
}

/// Prints a JSON document, whatever the verbosity.
pub fn document(value: &Value) {
    out(&verbosity::document(value));
}

/// Prints a diagnostic or a warning, which may have several lines.
pub fn warn(text: &str) {
    let text = text.trim_end();
    if Verbosity::now().json {
        let found = ["error", "warning"].into_iter().find_map(|level| {
            let message = text.strip_prefix(level)?.strip_prefix(": ")?;
            Some((level, message))
        });
        let (level, message) = found.unwrap_or(("warning", text));
        out(&verbosity::event(level, message, &Map::new()));
        return;
    }
    let _ = std::io::stderr().write_all(format!("{}\n", printable(text)).as_bytes());
}

fn out(text: &str) {
    print(&format!("{text}\n"));
}

/// Prints a text as it is.
pub fn print(text: &str) {
    let mut stdout = io::stdout().lock();
    note_loss(
        stdout
            .write_all(text.as_bytes())
            .and_then(|()| stdout.flush()),
    );
}

/// True once output has been lost, other than to a closed pipe.
static LOST: AtomicBool = AtomicBool::new(false);

/// Notes output that has not been written, with a message the first time.
pub fn note_loss(written: io::Result<()>) {
    let Err(error) = written else { return };
    if error.kind() != ErrorKind::BrokenPipe && !LOST.swap(true, Relaxed) {
        let text = format!("error: cannot write to the standard output: {error}\n");
        let _ = io::stderr().write_all(text.as_bytes());
    }
}

/// The exit code of a program that would have this one: output that is lost is a failure.
#[must_use]
pub fn exit_code(code: u8) -> u8 {
    if code == 0 && LOST.load(Relaxed) {
        EXIT_FAILED
    } else {
        code
    }
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
