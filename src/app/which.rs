//! The snapshots of a run that a command is asked for.

use std::path::{Path, PathBuf};

use files::FileOpener;
use plot::{PlotError, Wanted, choose, parse_quantity, snapshots};

/// A snapshot of a run, by time or number.
#[derive(Debug, Clone, Default, clap::Args)]
#[group(skip)]
pub struct Which {
    /// Snapshot of the run nearest to a time, as in 5us [default: the last one]
    #[arg(long, visible_alias = "time", value_name = "TIME", group = "which")]
    pub at: Option<String>,

    /// Snapshot of the run by number, from 0
    #[arg(long, visible_alias = "index", value_name = "K", group = "which")]
    pub snapshot: Option<usize>,
}

impl Which {
    /// `true` if one is named.
    #[must_use]
    pub fn any(&self) -> bool {
        self.at.is_some() || self.snapshot.is_some()
    }

    /// As the choice among snapshots knows it.
    ///
    /// # Errors
    /// [`PlotError::Quantity`] if the time cannot be read.
    pub fn wanted(&self) -> Result<Wanted, PlotError> {
        let several = Several {
            time: self.at.iter().cloned().collect(),
            index: self.snapshot.into_iter().collect(),
            all: false,
        };
        several.wanted(Wanted::Last)
    }
}

/// Several snapshots of a run, by times, by numbers, or all of them.
#[derive(Debug, Clone, Default, clap::Args)]
#[group(skip)]
pub struct Several {
    /// Snapshots of the run nearest to these times, as in 0.1us
    #[arg(
        long,
        visible_alias = "at",
        value_name = "TIME",
        value_delimiter = ',',
        group = "which"
    )]
    pub time: Vec<String>,

    /// Snapshots of the run by number, from 0
    #[arg(long, value_name = "K", value_delimiter = ',', group = "which")]
    pub index: Vec<usize>,

    /// All snapshots of the run; pictures of them have one view and one range of colours
    #[arg(long, group = "which")]
    pub all: bool,
}

impl Several {
    /// `true` if any are named.
    #[must_use]
    pub fn any(&self) -> bool {
        self.all || !self.time.is_empty() || !self.index.is_empty()
    }

    /// As the choice among snapshots takes it; `default` if none are named.
    ///
    /// # Errors
    /// [`PlotError::Quantity`] if a time cannot be read.
    pub fn wanted(&self, default: Wanted) -> Result<Wanted, PlotError> {
        if self.all {
            Ok(Wanted::All)
        } else if !self.time.is_empty() {
            let times = self.time.iter().map(|text| parse_quantity(text, "s"));
            Ok(Wanted::Times(times.collect::<Result<_, _>>()?))
        } else if !self.index.is_empty() {
            Ok(Wanted::Indices(self.index.clone()))
        } else {
            Ok(default)
        }
    }

    /// The snapshots at a place: those chosen of a run, or the file itself. At least one.
    ///
    /// # Errors
    /// [`PlotError`] if there are none, or if a file is to be chosen from.
    pub fn at(&self, path: &Path, default: Wanted) -> Result<Vec<PathBuf>, PlotError> {
        if path.is_dir() {
            choose(&snapshots(&FileOpener, path)?, &self.wanted(default)?)
        } else if self.any() {
            Err(PlotError::Options(
                "--time, --index and --all choose among the snapshots of a run: give its folder",
            ))
        } else {
            Ok(vec![path.to_owned()])
        }
    }
}
