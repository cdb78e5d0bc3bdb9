//! Titles of pictures of the snapshots of some runs.

use crate::snapshots::source::Source;
use crate::units;

/// Title, times and names of pictures.
#[derive(Debug, Clone)]
pub struct Titles {
    /// Title of the first case.
    pub title: String,
    /// Names of the runs that the snapshots belong to, if there are several.
    pub names: Option<Vec<String>>,
    /// Times of the snapshots, with unit.
    times: Vec<String>,
}

impl Titles {
    /// Of the snapshots of some runs, with their times (s).
    pub fn new(title: String, sources: &[Source], times: &[f64]) -> Self {
        let names = sources
            .iter()
            .flat_map(|s| vec![s.name.clone(); s.snapshots.len()]);
        Self {
            title,
            names: (sources.len() > 1).then(|| names.collect()),
            times: units::times(times),
        }
    }

    /// Number of the snapshots.
    pub fn count(&self) -> usize {
        self.times.len()
    }

    /// The text below the title of a picture of one snapshot; `caption` describes the picture.
    pub fn subtitle(&self, index: usize, caption: &str) -> String {
        let time = &self.times[index];
        match caption {
            "" => format!("t = {time}"),
            caption => format!("t = {time},  {caption}"),
        }
    }

    /// The headings of the panels of a picture of all snapshots.
    pub fn headings(&self) -> Vec<String> {
        let heading = |(k, time): (usize, &String)| match &self.names {
            Some(names) => format!("{}, t = {time}", names[k]),
            None => format!("t = {time}"),
        };
        self.times.iter().enumerate().map(heading).collect()
    }
}
