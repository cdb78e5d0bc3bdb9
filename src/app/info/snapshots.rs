//! What snapshots a run has.

use crate::output::{OutputError, RunFolder, series};
use crate::run::say::seconds;

/// A line for the usual snapshots and for those of each schedule: its name, and what there is.
pub(super) fn entries(folder: &RunFolder) -> Result<Vec<(String, String)>, OutputError> {
    let mut lines = vec![("snapshots".to_owned(), count_and_span(folder, None)?)];
    for schedule in folder.schedules()? {
        let found = count_and_span(folder, Some(&schedule))?;
        lines.push((format!("snapshots of {schedule}"), found));
    }
    Ok(lines)
}

/// How many snapshots the index of a schedule names, or that of the usual ones, and their times.
fn count_and_span(folder: &RunFolder, schedule: Option<&str>) -> Result<String, OutputError> {
    let snapshots = series::read(&folder.series_of(schedule))?;
    let span = match (snapshots.first(), snapshots.last()) {
        (Some(first), Some(last)) => {
            format!(", {} to {}", seconds(first.time), seconds(last.time))
        }
        _ => String::new(),
    };
    Ok(format!("{}{span}", snapshots.len()))
}
