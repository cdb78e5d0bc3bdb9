//! The snapshots of a run.

use serde_json::json;

use super::text::Text;
use files::output::{OutputError, RunFolder, series};
use files::run::say::seconds;

/// Reports the default snapshots and those of each schedule.
pub(super) fn report(folder: &RunFolder, text: &mut Text) -> Result<(), OutputError> {
    report_schedule(folder, None, text)?;
    for schedule in folder.schedules()? {
        report_schedule(folder, Some(&schedule), text)?;
    }
    Ok(())
}

/// Reports the number and times of the snapshots of a schedule, or of the default ones.
fn report_schedule(
    folder: &RunFolder,
    schedule: Option<&str>,
    text: &mut Text,
) -> Result<(), OutputError> {
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
