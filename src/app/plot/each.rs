//! Pictures of the chosen snapshots of any sort: each by itself, side by side, or as a movie.

use std::ops::Range;

use super::out::{named, save, target, write};
use super::{PlotArgs, movie, sources};
use plot::{Format, PlotError, Sequence, Source};

/// Draws what `make` makes of the chosen snapshots, or writes it as tables, into files called by `name`.
///
/// # Errors
/// [`PlotError`] if an input cannot be read, a request cannot be met or a picture not written.
pub fn draw<S: Sequence>(
    args: &PlotArgs,
    name: &str,
    make: impl FnOnce(&[Source]) -> Result<S, PlotError>,
) -> Result<(), PlotError> {
    if !args.panels && !args.with.is_empty() {
        return Err(PlotError::Options(
            "--with puts runs side by side: add --panels, or draw a --profile",
        ));
    }
    let sources = sources(args)?;
    let paths = &sources[0].snapshots;
    let one_file = args.panels || args.movie.is_wanted();
    if named(args).is_some() && paths.len() > 1 && !one_file {
        return Err(PlotError::Options(
            "several pictures cannot have one name: give --out a folder, or add --panels",
        ));
    }
    let sequence = make(&sources)?;
    if args.movie.is_wanted() {
        return movie::draw(args, &sequence, paths.len(), name);
    }
    let draw = |chosen: Range<usize>, stem: &str| {
        let path = target(args, stem);
        if Format::of(&path) == Some(Format::Csv) {
            return save(&path, |path| sequence.save_table(chosen, args.width, path));
        }
        let canvas = if args.panels {
            sequence.panels(args.width)
        } else {
            sequence.single(chosen.start, args.width)
        };
        write(&canvas?, &path)
    };
    if args.panels {
        let all = sources.iter().map(|source| source.snapshots.len()).sum();
        return draw(0..all, &format!("panels-{name}"));
    }
    for (k, path) in paths.iter().enumerate() {
        let stem = path.file_stem().unwrap_or_default().to_string_lossy();
        draw(k..k + 1, &format!("{stem}-{name}"))?;
    }
    Ok(())
}
