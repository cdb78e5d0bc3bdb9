//! With what and on what the run was made.

use crate::report::html::{Html, list};
use crate::report::run_files::{Run, figure_in_words};

/// Figures of the summary that describe it, in this order, and their names.
const FIGURES: [(&str, &str); 12] = [
    ("version", "whipple"),
    ("commit", "commit"),
    ("mpi", "MPI"),
    ("hdf5", "HDF5"),
    ("instructions", "instruction set"),
    ("ranks", "ranks"),
    ("threads", "threads of a rank"),
    ("decomposition", "decomposition"),
    ("wall_seconds", "wall clock, s"),
    ("set_up_seconds", "of these set-up, s"),
    (
        "million_updates_per_second_per_core",
        "million updates per second and core",
    ),
    ("bytes_per_particle", "bytes of a particle"),
];

/// Tells the environment.
pub fn render(run: &Run) -> Result<Html, String> {
    run.summary.as_ref().map_err(Clone::clone)?;
    let known = FIGURES.iter();
    let entry = |(key, name): &(&'static str, &'static str)| {
        Some((*name, figure_in_words(run.figure(key)?)))
    };
    Ok(list(known.filter_map(entry)))
}
