//! The case of a restart: the saved input, unless the user has edited the run's `case.toml`.

use std::fmt::Write as _;
use std::io::ErrorKind;

use super::launch::same_case;
use crate::input::{self, Difference};
use crate::output::{OutputError, RunFolder, from_root};
use comm::Comm;
use model::Case;

/// The case of a restart.
pub struct ResolvedCase {
    /// The case.
    pub case: Case,
    /// Set if `case.toml` differs or is missing.
    pub renew: bool,
    /// Warnings for the user.
    pub warnings: Vec<String>,
}

/// The case of the input `saved` in `source` with the overrides `set`. If the run continues in its own
/// `folder`, `case.toml` there must be the same, or be accepted. Collective.
///
/// # Errors
/// The whole message.
pub fn resolve(
    comm: &Comm,
    folder: Option<&RunFolder>,
    source: &str,
    saved: &str,
    set: &[String],
    accept: bool,
) -> Result<ResolvedCase, String> {
    let name = format!("{source}: the saved input");
    let parse = |name: &str, text: &str| {
        let read = input::parse(name, text, set);
        same_case(comm, read).map_err(|error| error.to_string())
    };
    let case = parse(&name, saved)?;
    let resolved = |case, renew| ResolvedCase {
        case,
        renew,
        warnings: Vec::new(),
    };
    let edited = match folder {
        Some(folder) => text_of(comm, folder).map_err(|error| format!("error: {error}"))?,
        None => None,
    };
    let (Some(folder), Some(edited)) = (folder, edited) else {
        return Ok(resolved(case, true));
    };
    if is_same(&case.resolved, &edited) {
        return Ok(resolved(case, false));
    }
    if is_same(saved, &edited) {
        return Ok(resolved(case, true));
    }
    let name = folder.case().display().to_string();
    let taken = parse(&name, &edited)?;
    let differences = input::differences(saved, &edited).unwrap_or_default();
    if !accept || !differences.iter().all(Difference::is_restartable) {
        let mut message = refusal(&name, source, &differences);
        if from_root(comm, || folder.forked()).is_ok_and(|forked| forked.is_some()) {
            message.push_str(
                "\n  help: this fork has no checkpoint of its own that can be read: fork again with --force",
            );
        }
        return Err(message);
    }
    let change = |found: &Difference| format!("{name} is taken: {}", describe(found, "before"));
    Ok(ResolvedCase {
        case: taken,
        renew: true,
        warnings: differences.iter().map(change).collect(),
    })
}

fn is_same(a: &str, b: &str) -> bool {
    a == b || input::differences(a, b).is_some_and(|found| found.is_empty())
}

/// The text of a run's `case.toml`, if there is one, read by rank 0 for all.
fn text_of(comm: &Comm, folder: &RunFolder) -> Result<Option<String>, OutputError> {
    let path = folder.case();
    from_root(comm, || match std::fs::read_to_string(&path) {
        Ok(text) => Ok(Some(text)),
        Err(error) if error.kind() == ErrorKind::NotFound => Ok(None),
        Err(error) => Err(OutputError::io("read", &path)(error)),
    })
}

fn refusal(name: &str, source: &str, differences: &[Difference]) -> String {
    let mut text = format!("error: {name} is not the input saved in {source}:\n");
    for found in differences {
        let _ = writeln!(text, "  {}", describe(found, "saved"));
    }
    let fixed = differences.iter().filter(|found| !found.is_restartable());
    let fixed: Vec<&str> = fixed.map(|found| found.key.as_str()).collect();
    if fixed.is_empty() {
        text.push_str(
            "  help: --accept-case goes on with case.toml; move the file away to go on with the \
             saved input",
        );
    } else {
        let _ = write!(
            text,
            "  help: a restart may change `run`, `output`, `domain`, `measure` and `numerical_limits`, not {}: run the \
             case anew, or put the saved value back",
            fixed.join(", ")
        );
    }
    text
}

fn describe(found: &Difference, other: &str) -> String {
    let [saved, edited] = &found.values;
    let word = |value: &Option<String>| value.clone().unwrap_or_else(|| "absent".to_owned());
    format!("{}: {} ({other}: {})", found.key, word(edited), word(saved))
}
