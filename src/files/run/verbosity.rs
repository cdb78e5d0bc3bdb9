//! Verbosity and format of a process's messages.

use std::fmt::Write as _;
use std::sync::atomic::{AtomicU8, Ordering};
use std::time::{Duration, SystemTime, UNIX_EPOCH};

use serde_json::{Map, Value, json};

use model::readable::is_printable;

/// Format of a run's messages.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, clap::ValueEnum)]
pub enum LogFormat {
    /// Lines of text.
    #[default]
    Text,
    /// A JSON object a line.
    Json,
}

/// Verbosity and format of all messages of a process.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Verbosity {
    /// Warnings and errors alone.
    pub quiet: bool,
    /// As JSON objects.
    pub json: bool,
}

/// The verbosity of this process, as bits.
static VERBOSITY: AtomicU8 = AtomicU8::new(0);

impl Verbosity {
    /// Sets the verbosity of this process.
    pub fn begin(self) {
        let bits = u8::from(self.quiet) + 2 * u8::from(self.json);
        VERBOSITY.store(bits, Ordering::Relaxed);
    }

    /// The verbosity of this process.
    pub fn now() -> Self {
        let bits = VERBOSITY.load(Ordering::Relaxed);
        Self {
            quiet: bits & 1 != 0,
            json: bits & 2 != 0,
        }
    }
}

/// A line as a JSON object: `time` (UTC), `level`, `message` and `fields`.
#[must_use]
pub fn event(level: &str, message: &str, fields: &Map<String, Value>) -> String {
    let since = SystemTime::now().duration_since(UNIX_EPOCH);
    let time = moment(since.unwrap_or_default());
    let event = json!({ "time": time, "level": level, "message": message, "fields": fields });
    plain(&event.to_string())
}

/// A JSON document of several lines.
#[must_use]
pub fn document(value: &Value) -> String {
    plain(&format!("{value:#}"))
}

/// JSON without characters that control a terminal.
fn plain(json: &str) -> String {
    let mut text = String::with_capacity(json.len());
    for c in json.chars() {
        // Other unprintable characters are in strings alone, where they can be escaped.
        if is_printable(c) || c == '\n' {
            text.push(c);
        } else {
            for unit in c.encode_utf16(&mut [0; 2]) {
                let _ = write!(text, "\\u{unit:04x}");
            }
        }
    }
    text
}

/// A time since 1970 as `2026-11-26T08:30:00.123Z`.
///
/// The day by the algorithm of H. Hinnant, "chrono-compatible low-level date algorithms",
/// `civil_from_days`: years begin in March, so that leap days end them.
fn moment(since: Duration) -> String {
    let seconds = since.as_secs();
    let (days, second) = (seconds / 86_400 + 719_468, seconds % 86_400);
    let (era, day_of_era) = (days / 146_097, days % 146_097);
    let year_of_era =
        (day_of_era - day_of_era / 1460 + day_of_era / 36_524 - day_of_era / 146_096) / 365;
    let day_of_year = day_of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
    let shifted = (5 * day_of_year + 2) / 153;
    let day = day_of_year - (153 * shifted + 2) / 5 + 1;
    let month = if shifted < 10 {
        shifted + 3
    } else {
        shifted - 9
    };
    let year = year_of_era + 400 * era + u64::from(month <= 2);
    let [hour, minute, second] = [second / 3600, second / 60 % 60, second % 60];
    let milli = since.subsec_millis();
    format!("{year:04}-{month:02}-{day:02}T{hour:02}:{minute:02}:{second:02}.{milli:03}Z")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn moments_are_those_of_the_calendar() {
        for (seconds, expected) in [
            (0, "1970-01-01T00:00:00.000Z"),
            (951_782_399, "2000-02-28T23:59:59.000Z"),
            (951_782_400, "2000-02-29T00:00:00.000Z"),
            (1_767_225_599, "2025-12-31T23:59:59.000Z"),
            (1_767_225_600, "2026-01-01T00:00:00.000Z"),
            (4_107_542_400, "2100-03-01T00:00:00.000Z"),
        ] {
            assert_eq!(moment(Duration::from_secs(seconds)), expected);
        }
        assert!(moment(Duration::from_millis(1500)).ends_with("01.500Z"));
    }

    #[test]
    fn words_of_strangers_stay_in_their_strings() {
        let hostile = "a\u{1b}[2J\"b\u{202e}\nc";
        let line = event("info", hostile, &Map::new());
        assert!(line.chars().all(is_printable), "{line}");
        let read: Value = serde_json::from_str(&line).unwrap();
        assert_eq!(read["message"], hostile);
        let text = document(&json!({ "a": [hostile] }));
        assert_eq!(
            serde_json::from_str::<Value>(&text).unwrap()["a"][0],
            hostile
        );
    }
}
