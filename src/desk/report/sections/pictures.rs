//! Sections of the model: several times side by side, and the last one.

use std::path::PathBuf;

use crate::report::html::Html;
use crate::report::picture::image;
use crate::report::run_files::Run;
use files::FileOpener;
use plot::{Pictures, PlotError, Request, Sequence, Source, Wanted, choose};

/// Draws the sections of snapshots in the order of time: by body, and by pressure where it is known.
pub fn render(run: &Run, snapshots: &[(f64, PathBuf)]) -> Result<Html, String> {
    let without_path = |error: PlotError| run.without_path(&error);
    let three = choose(snapshots, &Wanted::Three).map_err(without_path)?;
    let last = choose(snapshots, &Wanted::Last).map_err(without_path)?;
    let mut page = Html::default();
    let panels = pictures(run, three, None, None);
    // All show one section.
    let section = panels.as_ref().ok().map(Pictures::section);
    let panels = panels.and_then(|pictures| pictures.panels(None));
    page.push(image(
        panels.map_err(without_path),
        "Sections at the first, a middle and the last snapshot, by body",
    ));
    for (field, alt) in [(None, "by body"), (Some("pressure"), "by pressure")] {
        let drawn = |section: Option<String>| {
            pictures(run, last.clone(), field, section)
                .and_then(|pictures| pictures.single(0, None))
        };
        let drawn = match drawn(section.clone()) {
            // Matter may have left the plane.
            Err(PlotError::Empty { .. }) => drawn(None),
            drawn => drawn,
        };
        let unknown = matches!(drawn, Err(PlotError::Field { .. }));
        if !unknown {
            page.push(image(
                drawn.map_err(without_path),
                &format!("Section of the last snapshot, {alt}"),
            ));
        }
    }
    Ok(page)
}

fn pictures(
    run: &Run,
    snapshots: Vec<PathBuf>,
    field: Option<&str>,
    section: Option<String>,
) -> Result<Pictures, PlotError> {
    let source = Source {
        name: run.name.clone(),
        snapshots,
    };
    let request = Request {
        field: field.map(str::to_owned),
        section,
        mirror: true,
        ..Request::default()
    };
    Pictures::new(&FileOpener, &[source], &request)
}
