//! Names that users give: they stand in tables, paths, messages and on command lines.

use toml::Spanned;

use super::schema::CaseParams;
use super::source::Diagnostic;
use model::readable::is_printable;

/// Longest name and longest title, in characters.
const LONGEST_NAME: usize = 64;
const LONGEST_TITLE: usize = 200;
/// Characters that a name may have beside letters and digits.
const MARKS: &str = " -_.+()";

/// Complains unless a name is safe wherever it is written: letters and digits of any script and
/// [`MARKS`], with a letter or a digit at the beginning and no space at the end.
pub fn check(name: &Spanned<String>, of: &str) -> Result<(), Diagnostic> {
    let text = name.get_ref().as_str();
    let allowed = |c: char| c.is_alphanumeric() || MARKS.contains(c);
    let title = if let Some(c) = text.chars().find(|c| !allowed(*c)) {
        let shown = if is_printable(c) {
            c.to_string()
        } else {
            c.escape_unicode().to_string()
        };
        format!("the name of a {of} cannot hold `{shown}`")
    } else if !text.starts_with(char::is_alphanumeric) {
        format!("the name of a {of} must begin with a letter or a digit")
    } else if text.ends_with(' ') {
        format!("the name of a {of} cannot end with a space")
    } else if text.chars().count() > LONGEST_NAME {
        format!("the name of a {of} can have {LONGEST_NAME} characters at most")
    } else {
        return Ok(());
    };
    let marks = MARKS.trim_start();
    Err(Diagnostic::new(name.span(), title).help(format!(
        "a name has letters and digits of any script, spaces and `{marks}`; it stands in tables \
         and in the names of files"
    )))
}

/// The title: any one line that a terminal can show.
pub fn title(params: &CaseParams) -> Result<String, Diagnostic> {
    let text = params.title();
    check_title(&text, params.title.as_ref())?;
    Ok(text)
}

/// Complains unless a text can be the title, which is `typed`.
pub fn check_title(text: &str, typed: Option<&Spanned<String>>) -> Result<(), Diagnostic> {
    let at = || typed.map_or(0..0, Spanned::span);
    if let Some(c) = text.chars().find(|c| !is_printable(*c)) {
        let what = format!(
            "`title` must be one line without control characters, found `{}`",
            c.escape_unicode()
        );
        return Err(Diagnostic::new(at(), what));
    }
    if text.chars().count() > LONGEST_TITLE {
        let what = format!("`title` can have {LONGEST_TITLE} characters at most");
        return Err(Diagnostic::new(at(), what));
    }
    Ok(())
}
