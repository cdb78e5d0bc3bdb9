//! Charts of `distributions.csv`: profiles, and mass by speed and by angle.

use std::path::{Path, PathBuf};

use super::curves::{Chart, Curve, Quantity};
use super::table::{Table, wrong};
use crate::PlotError;
use crate::colour;
use crate::header::Mark;
use crate::snapshots::source::{Wanted, choose};

/// A row: time (s), measure, distribution, and a bin from one place to another with its value.
struct Bin<'a> {
    time: f64,
    measure: &'a str,
    distribution: &'a str,
    units: [&'a str; 2],
    step: [f64; 3],
}

/// One chart for each distribution of some tables, with its name: a curve of steps for each measure
/// at each time that is wanted. `time_text` writes a time.
///
/// # Errors
/// [`PlotError::Table`] if a table or a column is missing or a number cannot be read,
/// [`PlotError::Index`] if there is no such time.
pub fn distributions(
    tables: &[(String, PathBuf)],
    wanted: &Wanted,
    title: &str,
    time_text: impl Fn(f64) -> String,
) -> Result<Vec<(String, Chart)>, PlotError> {
    let mut charts: Vec<(String, Chart)> = Vec::new();
    for (name, path) in tables {
        let table = Table::read(path)?;
        let bins = bins(&table).map_err(|reason| wrong(path, reason))?;
        for time in times(&bins, wanted, path)? {
            for bin in bins
                .iter()
                .filter(|bin| bin.time.to_bits() == time.to_bits())
            {
                let mut parts = vec![bin.measure.to_owned(), time_text(time)];
                if tables.len() > 1 {
                    parts.insert(0, name.clone());
                }
                add(&mut charts, bin, &parts.join(", "), title);
            }
        }
    }
    Ok(charts)
}

/// Adds a bin to the curve of its name.
fn add(charts: &mut Vec<(String, Chart)>, bin: &Bin, name: &str, title: &str) {
    let known = charts
        .iter()
        .position(|(known, _)| known == bin.distribution);
    let at = known.unwrap_or_else(|| {
        charts.push((bin.distribution.to_owned(), empty(bin, title)));
        charts.len() - 1
    });
    let curves = &mut charts[at].1.curves;
    if curves.last().is_none_or(|curve| curve.name != name) {
        curves.push(Curve {
            name: name.to_owned(),
            colour: colour::body(curves.len()),
            mark: Mark::Line,
            points: Vec::new(),
            ..Curve::default()
        });
    }
    let [from, to, value] = bin.step;
    if let Some(curve) = curves.last_mut() {
        curve.points.extend([[from, value], [to, value]]);
    }
}

/// A chart without curves for a distribution.
fn empty(bin: &Bin, title: &str) -> Chart {
    let words = bin.distribution.replace('_', " ");
    // The quantity, and its coordinate.
    let (what, along) = match words.split_once(" by ") {
        Some((what, along)) => (what.to_owned(), along.to_owned()),
        None => match words.split_once(" from ") {
            Some((what, origin)) => (what.to_owned(), format!("distance from {origin}")),
            None => (words.clone(), "distance".to_owned()),
        },
    };
    let axis = |label: String, unit: &str| Quantity {
        label,
        unit: unit.to_owned(),
        from_zero: true,
        ..Quantity::default()
    };
    Chart {
        title: title.to_owned(),
        subtitle: words,
        x: axis(along, bin.units[0]),
        y: Quantity {
            room: true,
            ..axis(what, bin.units[1])
        },
        curves: Vec::new(),
    }
}

/// The times of a table that are wanted.
fn times(bins: &[Bin], wanted: &Wanted, path: &Path) -> Result<Vec<f64>, PlotError> {
    let mut all: Vec<(f64, f64)> = bins.iter().map(|bin| (bin.time, bin.time)).collect();
    all.dedup();
    if all.is_empty() {
        return Err(wrong(path, "it has no rows yet".to_owned()));
    }
    choose(&all, wanted)
}

/// The rows of a table.
fn bins(table: &Table) -> Result<Vec<Bin<'_>>, String> {
    let texts = |name| table.texts(name);
    let numbers = |name| table.column(name);
    let (measures, distributions) = (texts("measure")?, texts("distribution")?);
    let (along, units) = (texts("unit_along")?, texts("unit")?);
    let (times, values) = (numbers("time")?, numbers("value")?);
    let (from, to) = (numbers("from")?, numbers("to")?);
    let bin = |k: usize| Bin {
        time: times[k],
        measure: measures[k],
        distribution: distributions[k],
        units: [along[k], units[k]],
        step: [from[k], to[k], values[k]],
    };
    Ok((0..table.len()).map(bin).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_distribution_has_a_chart_of_steps() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("distributions.csv");
        let text = "time,measure,distribution,from,to,unit_along,value,unit\n\
            0.0,cloud,mass_by_speed,0,5,m/s,1,kg\n\
            1.0,cloud,mass_by_speed,0,5,m/s,2,kg\n1.0,cloud,mass_by_speed,5,9,m/s,3,kg\n\
            1.0,bar,diameter_from_foot,0,1,m,4,m\n";
        std::fs::write(&path, text).unwrap();
        let tables = [("run".to_owned(), path)];
        let draw = |wanted| distributions(&tables, &wanted, "title", |time| time.to_string());
        let last = draw(Wanted::Last).unwrap();
        let [(speed, by_speed), (_, profile)] = &last[..] else {
            panic!("{last:?}");
        };
        assert_eq!(speed, "mass_by_speed");
        assert_eq!(
            (&by_speed.x.label[..], &by_speed.x.unit[..]),
            ("speed", "m/s")
        );
        assert_eq!(
            (&by_speed.y.label[..], &by_speed.y.unit[..]),
            ("mass", "kg")
        );
        assert_eq!(
            by_speed.curves[0].points,
            [[0.0, 2.0], [5.0, 2.0], [5.0, 3.0], [9.0, 3.0]]
        );
        assert_eq!(profile.x.label, "distance from foot");
        let all = draw(Wanted::All).unwrap();
        let names: Vec<&str> = all[0]
            .1
            .curves
            .iter()
            .map(|curve| &curve.name[..])
            .collect();
        assert_eq!(names, ["cloud, 0", "cloud, 1"]);
    }
}
