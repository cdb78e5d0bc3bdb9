//! The page of a run: its sections in the order in which people ask.

use std::path::PathBuf;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use sha2::{Digest, Sha256};

use super::html::{Html, missing, or_reason};
use super::run_files::{Run, with_unit};
use super::sections::{
    case, contacts, energies, environment, figures, fragments, load, measures, pictures, steps,
    verdict,
};
use super::viewer;
use files::output::h5::read::SnapshotFile;
use files::output::{RunFolder, VERSION};
use results::SnapshotReader as _;

const STYLE: &str = include_str!("page.css");

/// Bytes that a page has at most, as long as nobody asks for more frames.
const ROOM: usize = 24_000_000;

/// Options of a page.
#[derive(Debug, Clone)]
pub struct PageOptions {
    /// Most particles of a frame of the viewer, at most 300,000 of which are taken.
    pub particles: usize,
    /// Snapshots that the viewer shows; as many as keep the page below 25 MB if absent.
    pub frames: Option<usize>,
    /// The output of `whipple fragments` for the last snapshot, or its error: for runs without
    /// tables of fragments.
    pub fragments: Result<String, String>,
}

/// A section: how links name it, its title, and what it holds or why that is missing.
pub type Section = (&'static str, &'static str, Result<Html, String>);

/// The page of a run.
#[must_use]
pub fn render(folder: &RunFolder, options: &PageOptions) -> String {
    let run = Run::read(folder);
    let (snapshots, damaged) = snapshots(&run);
    let none = || Err("the run has no snapshots".to_owned());
    let drawn = if snapshots.is_empty() {
        none()
    } else {
        pictures::render(&run, &snapshots)
    };
    let warned = |section: Result<Html, String>| {
        let warnings = damaged.iter().map(|reason| missing(reason)).collect();
        section.map(|section| section.then(warnings))
    };
    let mut sections: Vec<Section> = vec![
        ("verdict", "Verdict", Ok(verdict::render(&run))),
        ("pictures", "Pictures", warned(drawn)),
        ("case", "Case", case::render(&run)),
        ("energies", "Energies", energies::render(&run)),
        ("steps", "Time line", steps::render(&run)),
        ("contacts", "Contact ledger", contacts::render(&run)),
        ("measures", "Measures", Ok(measures::render(&run))),
        (
            "fragments",
            "Fragments",
            fragments::render(&run, &options.fragments),
        ),
        ("load", "Load", Ok(load::render(&run))),
        ("environment", "Environment", environment::render(&run)),
        ("figures", "Figures", figures::render(&run)),
    ];
    let size = |section: &Section| section.2.as_ref().map_or(0, Html::len);
    let room = ROOM.saturating_sub(sections.iter().map(size).sum());
    let seen = if snapshots.is_empty() {
        none()
    } else {
        viewer::render(&run, &snapshots, options.particles, options.frames, room)
    };
    sections.insert(2, ("viewer", "Viewer", seen));
    whole(run.title(), &state(&run), sections)
}

/// The run's name and status, in a line.
fn state(run: &Run) -> String {
    match &run.status {
        Ok(status) => format!(
            "Run {}, {} at {} after {} steps",
            run.name,
            status.state.name(),
            with_unit(status.time, "s"),
            status.step
        ),
        Err(reason) => format!("Run {}; {reason}", run.name),
    }
}

/// The snapshots of a run (time in s, path) in the order of time, and what is said of those that cannot be read.
pub fn snapshots(run: &Run) -> (Vec<(f64, PathBuf)>, Vec<String>) {
    let (mut readable, mut damaged) = (Vec::new(), Vec::new());
    match run.folder.snapshot_files() {
        Err(error) => damaged.push(run.without_path(&error)),
        Ok(paths) => {
            for path in paths {
                match SnapshotFile::open(&path).and_then(|file| file.time()) {
                    Ok(time) => readable.push((time, path)),
                    Err(error) => damaged.push(run.without_path(&error)),
                }
            }
        }
    }
    readable.sort_by(|a, b| a.0.total_cmp(&b.0).then_with(|| a.1.cmp(&b.1)));
    (readable, damaged)
}

/// A whole page of sections.
pub fn whole(title: &str, state: &str, sections: Vec<Section>) -> String {
    let link = |(id, title, _): &Section| {
        Html::element("a", &[("href", &format!("#{id}"))], Html::text(title))
    };
    let links = sections.iter().map(link).collect();
    let header = Html::of("h1", title)
        .then(Html::of("p", state))
        .then(Html::element("nav", &[("aria-label", "Sections")], links));
    let section = |(id, title, content): Section| {
        let inside = Html::of("h2", title).then(or_reason(content));
        Html::element("section", &[("id", id)], inside)
    };
    let sections = sections.into_iter().map(section).collect();
    let footer = format!(
        "Made by whipple {VERSION}. This page holds all that it shows and asks no network."
    );
    let body = Html::element("header", &[], header)
        .then(Html::element("main", &[], sections))
        .then(Html::element("footer", &[], Html::text(&footer)));
    let policy = policy();
    let head = Html::own("<meta charset=\"utf-8\">").into_markup();
    let title = Html::of("title", title).into_markup();
    let body = body.into_markup();
    format!(
        "<!doctype html>\n<html lang=\"en\">\n<head>\n{head}\n\
         <meta http-equiv=\"Content-Security-Policy\" content=\"{policy}\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <meta name=\"color-scheme\" content=\"light dark\">\n{title}\n<style>\n{STYLE}</style>\n</head>\n\
         <body>\n{body}\n<script>{}</script>\n</body>\n</html>\n",
        viewer::SCRIPT
    )
}

/// Permissions of the browser: our script and no other, pictures of the page itself, and no
/// network.
fn policy() -> String {
    let digest = STANDARD.encode(Sha256::digest(viewer::SCRIPT));
    format!(
        "default-src 'none'; script-src 'sha256-{digest}'; style-src 'unsafe-inline'; img-src data:; \
         base-uri 'none'; form-action 'none'"
    )
}
