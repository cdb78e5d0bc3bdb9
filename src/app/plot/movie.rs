//! `whipple plot --movie`: one picture after the other in one file.

use std::path::{Path, PathBuf};

use super::PlotArgs;
use super::out::{MOVIES, save, target};
use plot::movie::{Format, write};
use plot::{PlotError, Sequence};

/// What belongs to movies.
#[derive(Debug, Clone, Default, clap::Args)]
#[command(next_help_heading = "Movies")]
pub struct MovieArgs {
    /// Draw all snapshots, or those asked for, one after the other as a movie: .apng (or .png) in all
    /// colours, .gif in 256 [default: RUN/pictures/movie-….apng, or what --out says]
    #[expect(
        clippy::option_option,
        reason = "an option that may have a value: clap's own type for it"
    )]
    #[arg(long, value_name = "APNG_OR_GIF", num_args = 0..=1, conflicts_with_all = [
        "csv", "format", "panels", "history", "fragments", "distributions", "profile", "xy", "pair", "gauges", "front",
    ])]
    pub movie: Option<Option<PathBuf>>,

    /// Pictures a second of the movie
    #[arg(long, value_name = "NUMBER", requires = "movie", default_value_t = 10.0, value_parser = rate)]
    pub fps: f64,
}

/// Reads pictures a second.
fn rate(text: &str) -> Result<f64, String> {
    let rate = text.parse().ok().filter(|rate| (0.1..=50.0).contains(rate));
    rate.ok_or_else(|| "give a number from 0.1 to 50".to_owned())
}

impl MovieArgs {
    /// `true` if a movie is asked for.
    pub fn is_wanted(&self) -> bool {
        self.movie.is_some()
    }

    /// The name of the movie, if it has one of its own.
    pub fn name(&self) -> Option<&Path> {
        self.movie.as_ref()?.as_deref()
    }
}

/// Refuses names that are none of a movie.
///
/// # Errors
/// [`PlotError::Options`] with what would be one.
pub fn check(args: &PlotArgs) -> Result<(), PlotError> {
    match (args.movie.name(), &args.out) {
        (Some(_), Some(_)) => Err(PlotError::Options(
            "--movie and --out both name the file: give one of them",
        )),
        (Some(name), None) if Format::of(name).is_none() => Err(PlotError::Options(MOVIES)),
        _ => Ok(()),
    }
}

/// Draws the movie of so many pictures, called `name` unless the user calls it otherwise.
///
/// # Errors
/// [`PlotError`] if a picture cannot be drawn or the movie not written.
pub fn draw(
    args: &PlotArgs,
    sequence: &impl Sequence,
    pictures: usize,
    name: &str,
) -> Result<(), PlotError> {
    let path = match args.movie.name() {
        Some(path) => path.to_owned(),
        None => target(args, &format!("movie-{name}")),
    };
    save(&path, |path| {
        write(path, pictures, args.movie.fps, |k| {
            sequence.single(k, args.width)
        })
    })
}
