//! Lines for the user. Each goes out in one call, so that those of two ranks do not mix; and that
//! nobody listens any more (a closed pipe) is no reason to end a run.

use std::io::Write;

/// A line of output.
pub fn say(line: &str) {
    let mut stdout = std::io::stdout().lock();
    let _ = stdout.write_all(format!("{line}\n").as_bytes());
    let _ = stdout.flush();
}

/// A complaint or a warning, which may have several lines.
pub fn complain(text: &str) {
    let _ = std::io::stderr().write_all(format!("{}\n", text.trim_end()).as_bytes());
}
