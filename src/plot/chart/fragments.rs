//! The number of fragments above a mass, or a size: from tables of all fragments.

use std::path::{Path, PathBuf};

use super::curves::{Chart, Curve, Quantity};
use super::table::{Table, wrong};
use crate::PlotError;
use crate::colour;
use crate::header::Mark;

/// The quantity that fragments are counted by.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum By {
    /// Mass.
    Mass,
    /// Diameter of the sphere of the volume of their ellipsoid.
    Size,
}

impl By {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Mass, Self::Size];

    /// For names of files.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Mass => "mass",
            Self::Size => "size",
        }
    }

    /// The columns of the values and of the numbers.
    fn columns(self) -> [&'static str; 2] {
        match self {
            Self::Mass => ["mass", "number_by_mass"],
            Self::Size => ["diameter", "number_by_size"],
        }
    }
}

/// Curves of the cumulative number of fragments, one for each table and its name in the legend.
///
/// # Errors
/// [`PlotError::Table`] if a table or a column is missing or a number cannot be read.
pub fn cumulative(tables: &[(String, PathBuf)], by: By, title: &str) -> Result<Chart, PlotError> {
    let mut unit = String::new();
    let mut curves = Vec::new();
    for (k, (name, path)) in tables.iter().enumerate() {
        let table = Table::read(path)?;
        let (points, of) = steps(&table, by).map_err(|reason| wrong(path, reason))?;
        unit = of;
        curves.push(Curve {
            name: name.clone(),
            colour: colour::body(k),
            mark: Mark::Line,
            points,
            ..Curve::default()
        });
    }
    if let [curve] = &mut curves[..] {
        curve.name.clear();
    }
    let axis = |label: &str, unit: &str| Quantity {
        label: label.to_owned(),
        unit: unit.to_owned(),
        logarithmic: true,
        ..Quantity::default()
    };
    let what = match by {
        By::Mass => ("mass", "number as heavy"),
        By::Size => ("diameter", "number as large"),
    };
    Ok(Chart {
        title: title.to_owned(),
        subtitle: format!("fragments by {}", by.name()),
        x: axis(what.0, &unit),
        y: axis(what.1, ""),
        curves,
    })
}

/// The steps of a curve, the largest value first, and the unit of the values.
fn steps(table: &Table, by: By) -> Result<(Vec<[f64; 2]>, String), String> {
    let [value, number] = by.columns();
    let unit = table.unit(value)?.to_owned();
    let mut rows: Vec<[f64; 2]> = table
        .column(value)?
        .into_iter()
        .zip(table.column(number)?)
        .map(|(value, number)| [value, number])
        .collect();
    rows.sort_by(|a, b| a[1].total_cmp(&b[1]));
    let mut points = Vec::with_capacity(2 * rows.len());
    let mut before = None;
    for [value, number] in rows {
        points.extend(before.map(|before| [value, before]));
        points.push([value, number]);
        before = Some(number);
    }
    Ok((points, unit))
}

/// The tables of all fragments of a run: times (s) and paths, given how a path follows from a step.
///
/// # Errors
/// [`PlotError::Table`] if the run's `fragments.csv` cannot be read.
pub fn tables_of_run(
    table: &Path,
    path_of: impl Fn(u64) -> PathBuf,
) -> Result<Vec<(f64, PathBuf)>, PlotError> {
    if !table.exists() {
        let reason = "the run tells no fragments; `whipple fragments RUN --csv FILE` makes a table of a snapshot";
        return Err(wrong(table, reason.to_owned()));
    }
    let rows = Table::read(table)?;
    let read = || -> Result<_, String> {
        let steps = rows.texts("step")?;
        let times = rows.column("time")?;
        let step = |text: &str| {
            let step = text.parse::<u64>();
            step.map_err(|_| format!("\"{text}\" is no step"))
        };
        let all = steps.into_iter().zip(times);
        all.map(|(text, time)| Ok((time, path_of(step(text)?))))
            .collect()
    };
    read().map_err(|reason| wrong(table, reason))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn curves_are_steps_from_the_largest_on() {
        let text = "# units: kg,-,m,-\nmass,number_by_mass,diameter,number_by_size\n\
            3.0,2,1.0,6\n2.0,3,5.0,1\n1.0,7,2.0,5\n";
        let table = Table::parse(text).unwrap();
        let (points, unit) = steps(&table, By::Mass).unwrap();
        assert_eq!(unit, "kg");
        assert_eq!(
            points,
            [[3.0, 2.0], [2.0, 2.0], [2.0, 3.0], [1.0, 3.0], [1.0, 7.0]]
        );
        let (points, _) = steps(&table, By::Size).unwrap();
        assert_eq!(points[..3], [[5.0, 1.0], [2.0, 1.0], [2.0, 5.0]]);
    }
}
