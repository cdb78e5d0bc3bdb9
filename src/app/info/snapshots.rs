//! What snapshots a run has.

use serde_json::json;

use super::text::Text;
use files::output::{OutputError, RunFolder, series};
use files::run::say::seconds;

/// Tells of the usual snapshots and of those of each schedule.
pub(super) fn tell(folder: &RunFolder, text: &mut Text) -> Result<(), OutputError> {
    tell_of(folder, None, text)?;
    for schedule in folder.schedules()? {
        tell_of(folder, Some(&schedule), text)?;
    }
    Ok(())
}

/// How many snapshots the index of a schedule names, or that of the usual ones, and their times.
fn tell_of(folder: &RunFolder, schedule: Option<&str>, text: &mut Text) -> Result<(), OutputError> {
    let snapshots = series::read(&folder.series_of(schedule))?;
    let span = match (snapshots.first(), snapshots.last()) {
        (Some(first), Some(last)) => {
            format!(", {} to {}", seconds(first.time), seconds(last.time))
        }
        _ => String::new(),
    };
    let name = schedule.map_or_else(
        || "snapshots".to_owned(),
        |schedule| format!("snapshots of {schedule}"),
    );
    text.entry(&name, format!("{}{span}", snapshots.len()));
    let times: Vec<f64> = snapshots.iter().map(|snapshot| snapshot.time).collect();
    text.one_of(
        "snapshots",
        json!({ "schedule": schedule, "times_s": times }),
    );
    Ok(())
}
