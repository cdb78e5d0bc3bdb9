//! Which snapshot of a run a command is asked for.

use crate::plot::{PlotError, Wanted, parse_quantity};

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
    /// Whether one is named.
    #[must_use]
    pub fn any(&self) -> bool {
        self.at.is_some() || self.snapshot.is_some()
    }

    /// As the choice among snapshots knows it.
    ///
    /// # Errors
    /// [`PlotError::Quantity`] if the time cannot be read.
    pub fn wanted(&self) -> Result<Wanted, PlotError> {
        Ok(match (&self.at, self.snapshot) {
            (Some(time), _) => Wanted::Times(vec![parse_quantity(time, "s")?]),
            (None, Some(index)) => Wanted::Indices(vec![index]),
            (None, None) => Wanted::Last,
        })
    }
}
