//! Lines for the user. Each goes out in one call, so that those of two ranks do not mix; and that
//! nobody listens any more (a closed pipe) is no reason to end a run.
//!
//! Titles, names and units come from files that anybody may have made. A terminal obeys what is in
//! them, so whatever could command it is shown as `\u{1b}` and the like.

use std::io::Write;

/// A line of output, or several.
pub fn say(text: &str) {
    let mut stdout = std::io::stdout().lock();
    let _ = stdout.write_all(format!("{}\n", shown(text, true)).as_bytes());
    let _ = stdout.flush();
}

/// A complaint or a warning, which may have several lines.
pub fn complain(text: &str) {
    let text = format!("{}\n", shown(text.trim_end(), true));
    let _ = std::io::stderr().write_all(text.as_bytes());
}

/// A text that may not begin a line of its own, such as a title.
pub fn one_line(text: &str) -> String {
    shown(text, false)
}

/// A text without control characters, and without those that turn the direction of writing.
fn shown(text: &str, lines: bool) -> String {
    let mut shown = String::with_capacity(text.len());
    for c in text.chars() {
        let obeyed = c.is_control() && !(lines && c == '\n');
        let turning = matches!(c, '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
        if obeyed || turning {
            shown.extend(c.escape_unicode());
        } else {
            shown.push(c);
        }
    }
    shown
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_terminal_gets_no_commands() {
        let title = "a\u{1b}]0;x\u{7}\u{9b}2J\r\u{202e}b °\nc";
        let expected = "a\\u{1b}]0;x\\u{7}\\u{9b}2J\\u{d}\\u{202e}b °";
        assert_eq!(shown(title, true), format!("{expected}\nc"));
        assert_eq!(one_line(title), format!("{expected}\\u{{a}}c"));
    }
}
