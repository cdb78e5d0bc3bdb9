//! Curves of tables: energies, columns, forces between bodies, fronts.

use std::path::{Path, PathBuf};

use files::output::RunFolder;
use files::run::say::warn;
use model::readable::with_unit;
use plot::{
    By, Columns, Direction, History, PlotError, Points, Tables, choose, cumulative, distributions,
    front, parse_pair, snapshots, tables_of_run, title, widest,
};

use super::out::{named, save_text, target, write_chart};
use super::{PlotArgs, named_sources, wanted};
use files::FileOpener;

/// `true` if columns of a table are drawn.
pub fn is_table(args: &PlotArgs) -> bool {
    args.xy.is_some()
        || args.pair.is_some()
        || !args.gauges.is_empty()
        || is(args, GAUGE_RECORDS)
        || args.source.extension().is_some_and(|e| e == "csv")
}

/// The value of `--xy`, or the default for a table that is known, or with `--pair`.
///
/// # Errors
/// [`PlotError::Options`] for an unknown table.
pub fn columns(args: &PlotArgs) -> Result<String, PlotError> {
    let columns = match (&args.xy, &args.pair) {
        (Some(columns), _) => columns,
        (None, Some(_)) => "time:force_x,force_y,force_z",
        (None, None) if !args.gauges.is_empty() => PRESSURE,
        (None, None) if is(args, CROSSINGS) => return widest(&args.source),
        (None, None) => {
            let known = DEFAULT_COLUMNS.iter().find(|(table, _)| is(args, table));
            let (_, columns) = known.ok_or(PlotError::Options(
                "of a table say which columns to draw, as in --xy time:force_x",
            ))?;
            columns
        }
    };
    Ok(columns.to_owned())
}

/// `true` if this table of a run is drawn.
fn is(args: &PlotArgs, table: &str) -> bool {
    args.source.file_name().is_some_and(|name| name == table)
}

/// The default columns of tables of a run.
const DEFAULT_COLUMNS: [(&str, &str); 5] = [
    (CONTACTS, "time:force"),
    ("bodies.csv", "time:kinetic_energy"),
    (GAUGES, PRESSURE),
    (GAUGE_RECORDS, PRESSURE),
    ("witness.csv", "time:mass"),
];

/// The default columns of gauges.
const PRESSURE: &str = "time:pressure";

/// The table of a run with the readings of its gauges, and the folder with those of many.
const GAUGES: &str = "gauges.csv";
const GAUGE_RECORDS: &str = "gauges";

/// The table of a run with the particles that have passed witness planes.
const CROSSINGS: &str = "crossings.csv";

/// The table of a run with a row for each pair of bodies.
const CONTACTS: &str = "contacts.csv";

/// The table of a run with profiles, and mass by speed and by angle.
const DISTRIBUTIONS: &str = "distributions.csv";

/// The table of a run that its energies are in.
const HISTORY: &str = "history.csv";

/// The tables of a run in which columns are looked for, in this order.
const TABLES: [&str; 12] = [
    HISTORY,
    "bodies.csv",
    CONTACTS,
    "measures.csv",
    GAUGES,
    "witness.csv",
    "fragments.csv",
    "loads.csv",
    "rigid.csv",
    "performance.csv",
    "removed.csv",
    "departed.csv",
];

pub fn draw_history(args: &PlotArgs, history: History) -> Result<(), PlotError> {
    let tables = named_sources(args)
        .into_iter()
        .map(|(name, source)| (name, table(source, history.table())));
    let tables: Vec<_> = tables.collect();
    for (_, path) in &tables {
        warn_of_part(path);
    }
    let chart = history.chart(&tables, &title_of(&args.source))?;
    let stem = match history {
        History::Energies => "history".to_owned(),
        other => format!("history-{}", other.name()),
    };
    write_chart(&chart, args.width, &target(args, &stem))
}

/// Draws the fragments of each run by mass and by size.
pub fn draw_fragments(args: &PlotArgs) -> Result<(), PlotError> {
    let mut tables = Vec::new();
    for (name, source) in named_sources(args) {
        if !source.is_dir() {
            tables.push((name, source.clone()));
            continue;
        }
        let folder = RunFolder::at(source);
        let all = tables_of_run(&folder.fragments(), |step| folder.fragment_table(step))?;
        for path in choose(&all, &wanted(args)?)? {
            let time = all.iter().find(|(_, other)| *other == path);
            let time = time.map_or(String::new(), |(time, _)| with_unit(*time, "s"));
            let label = if args.with.is_empty() {
                time
            } else {
                format!("{name}, {time}")
            };
            tables.push((label, path));
        }
    }
    for by in By::ALL {
        let chart = cumulative(&tables, by, &title_of(&args.source))?;
        let path = beside(args, &format!("fragments-{}", by.name()), by.name());
        write_chart(&chart, args.width, &path)?;
    }
    Ok(())
}

/// `true` if the source is the table of distributions, and none of its columns are named.
pub fn is_distributions(args: &PlotArgs) -> bool {
    is(args, DISTRIBUTIONS) && args.xy.is_none()
}

/// Draws each distribution of the runs.
pub fn draw_distributions(args: &PlotArgs) -> Result<(), PlotError> {
    let tables = named_sources(args)
        .into_iter()
        .map(|(name, source)| (name, table(source, DISTRIBUTIONS)));
    let tables: Vec<_> = tables.collect();
    let charts = distributions(&tables, &wanted(args)?, &title_of(&args.source), |time| {
        with_unit(time, "s")
    })?;
    for (distribution, chart) in charts {
        let stem = distribution.replace('_', "-");
        write_chart(&chart, args.width, &beside(args, &stem, &stem))?;
    }
    Ok(())
}

/// The path of one of several pictures: one name cannot serve several.
fn beside(args: &PlotArgs, picture: &str, suffix: &str) -> PathBuf {
    match &args.out {
        Some(out) if named(args).is_some() => {
            let [stem, ending] = [out.file_stem(), out.extension()]
                .map(|part| part.unwrap_or_default().to_string_lossy());
            out.with_file_name(format!("{stem}-{suffix}.{ending}"))
        }
        _ => target(args, picture),
    }
}

/// Writes the table of each run beside the picture, or into the run's pictures.
pub fn draw_front(args: &PlotArgs, body: &str) -> Result<(), PlotError> {
    let direction = Direction::parse(&args.along)?;
    let stem = format!("front-{body}-{}", direction.name().replace('_', "-"));
    let mut tables = Vec::new();
    for (name, source) in named_sources(args) {
        let snapshots_of: Vec<_> = snapshots(&FileOpener, source)?
            .into_iter()
            .map(|snapshots_of| snapshots_of.1)
            .collect();
        let path = source.join(format!("pictures/{stem}.csv"));
        let text = front(&FileOpener, &snapshots_of, body, direction)?;
        save_text(&path, text.as_bytes())?;
        tables.push((name, path));
    }
    let mut chart = tables_of(
        args,
        tables,
        Columns {
            x: "time".to_owned(),
            y: vec![format!("front_{}", direction.name())],
        },
    )?;
    chart.label = Some(format!("front of {body} along {}", direction.sign()));
    for points in &mut chart.points {
        // Measured fronts need not know which way they are compared with.
        points.columns.get_or_insert_with(|| Columns {
            x: "time".to_owned(),
            y: vec!["front".to_owned()],
        });
    }
    // The table of the front has its name.
    let drawn = if args.csv { "-drawn" } else { "" };
    draw(args, &chart, &format!("{stem}{drawn}"))
}

pub fn draw_tables(args: &PlotArgs, columns: &str) -> Result<(), PlotError> {
    let typed = columns;
    let columns = Columns::parse(typed)?;
    let tables = named_sources(args).into_iter().map(|(name, source)| {
        let of_run = match (&args.pair, &args.gauges[..]) {
            (Some(_), _) => CONTACTS,
            (None, []) => table_with(source, &columns),
            _ if source.join(GAUGE_RECORDS).is_dir() => GAUGE_RECORDS,
            _ => GAUGES,
        };
        (name, table(source, of_run))
    });
    let mut picture = format!("xy-{}", typed.replace([':', ','], "-"));
    if let Some(pair) = &args.pair {
        picture = format!("{picture}-{}", pair.replace(',', "-"));
    } else if !args.gauges.is_empty() {
        picture = format!("gauges-{picture}");
    }
    let chart = tables_of(args, tables.collect(), columns)?;
    draw(args, &chart, &picture)
}

/// The table of a run that has some columns: its history, else the first by name that has them all.
fn table_with(run: &Path, columns: &Columns) -> &'static str {
    let has = |table: &&&str| columns.are_in(&run.join(table));
    TABLES.iter().find(has).copied().unwrap_or(HISTORY)
}

fn tables_of(
    args: &PlotArgs,
    tables: Vec<(String, PathBuf)>,
    columns: Columns,
) -> Result<Tables, PlotError> {
    let log = args.log.as_deref().unwrap_or_default();
    let points = args.points.iter().map(|text| Points::parse(text));
    let pair = |text: &String| {
        parse_pair(text).ok_or(PlotError::Options(
            "a pair is the names of two bodies, as in --pair plate,sphere",
        ))
    };
    Ok(Tables {
        title: title_of(&args.source),
        tables,
        columns,
        pair: args.pair.as_ref().map(pair).transpose()?,
        gauges: args.gauges.clone(),
        label: None,
        points: points.collect::<Result<_, _>>()?,
        spans: [args.view.clone(), args.range.clone()],
        logarithmic: ['x', 'y'].map(|axis| log.contains(axis)),
        dots: is(args, CROSSINGS),
    })
}

fn draw(args: &PlotArgs, tables: &Tables, picture: &str) -> Result<(), PlotError> {
    for (_, path) in &tables.tables {
        warn_of_part(path);
    }
    write_chart(
        &tables.chart(&FileOpener)?,
        args.width,
        &target(args, picture),
    )
}

/// Warns of a table of an earlier version that is of what was computed alone.
fn warn_of_part(path: &Path) {
    let folder = RunFolder::at(path.parent().unwrap_or(path));
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    if let Some(note) = folder.note_of_part(&name) {
        warn(&format!("warning: {note}"));
    }
}

/// A table of a run, or a table itself.
fn table(source: &Path, of_run: &str) -> PathBuf {
    if source.is_dir() && !source.ends_with(GAUGE_RECORDS) {
        source.join(of_run)
    } else {
        source.to_owned()
    }
}

/// The title of a run as its snapshots know it, also for a table in its folder; without any
/// snapshot a place goes by its path.
fn title_of(source: &Path) -> String {
    let folder = if source.is_dir() {
        Some(source)
    } else {
        source.parent()
    };
    let known = folder.and_then(|folder| snapshots(&FileOpener, folder).ok());
    let known = known.and_then(|found| title(&FileOpener, &found[0].1).ok());
    known.unwrap_or_else(|| source.display().to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_are_found_in_all_tables_of_a_run() {
        let run = tempfile::tempdir().unwrap();
        let write = |name: &str, text: &str| std::fs::write(run.path().join(name), text).unwrap();
        write("history.csv", "time,kinetic_energy\n0,1\n");
        write(
            "bodies.csv",
            "time,body,kinetic_energy,velocity_x,velocity_y,velocity_z\n0,a,1,1,2,2\n",
        );
        write("gauges.csv", "time,gauge,pressure\n0,g,1\n");
        for (columns, table) in [
            ("time:kinetic_energy", "history.csv"),
            ("time:velocity", "bodies.csv"),
            ("time:kinetic_energy,velocity_z", "bodies.csv"),
            ("time:pressure", "gauges.csv"),
            ("time:nothing", "history.csv"),
        ] {
            let found = table_with(run.path(), &Columns::parse(columns).unwrap());
            assert_eq!(found, table, "{columns}");
        }
    }
}
