//! All figures of the summary.

use crate::report::html::{Html, table_of_texts};
use crate::report::run_files::{Run, figure_in_words};

/// Tells them all.
pub fn render(run: &Run) -> Result<Html, String> {
    let summary = run.summary.as_ref().map_err(Clone::clone)?;
    let row =
        |(key, value): (&String, &serde_json::Value)| vec![key.clone(), figure_in_words(value)];
    let all = table_of_texts(&["key of summary.json", "value"], summary.iter().map(row));
    let title = Html::of("summary", "All figures of summary.json");
    Ok(Html::element("details", &[], title.then(all)))
}
