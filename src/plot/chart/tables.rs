//! Columns of tables against each other: series of runs, measured points, convergence.

use std::path::{Path, PathBuf};

use super::curves::{Chart, Curve, Quantity};
use super::series::{self, Series, series};
use super::table::{Table, wrong};
use crate::PlotError;
use crate::colour;
use crate::header::Mark;
use crate::units;
use results::Opener;

/// The columns of both axes.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Columns {
    /// Column to the right.
    pub x: String,
    /// Columns upwards, at least one.
    pub y: Vec<String>,
}

impl Columns {
    /// Reads `X:Y` or `X:Y,Y2`.
    ///
    /// # Errors
    /// [`PlotError::Quantity`] if the text is no such thing.
    pub fn parse(text: &str) -> Result<Self, PlotError> {
        let wrong =
            || PlotError::quantity(text, "columns X:Y or X:Y,Y2, as in time:kinetic_energy");
        let (x, y) = text.split_once(':').ok_or_else(wrong)?;
        let y: Vec<String> = y.split(',').map(|name| name.trim().to_owned()).collect();
        if x.trim().is_empty()
            || y.iter().any(String::is_empty)
            || y.iter().any(|n| n.contains(':'))
        {
            return Err(wrong());
        }
        Ok(Self {
            x: x.trim().to_owned(),
            y,
        })
    }

    /// Returns true if a table can be read and has all of them.
    #[must_use]
    pub fn are_in(&self, path: &Path) -> bool {
        Table::read(path).is_ok_and(|table| {
            let mut names = [&self.x].into_iter().chain(&self.y);
            names.all(|name| series::unit(&table, name).is_ok())
        })
    }
}

/// Points that are drawn as such: a table, and its columns if they have other names.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Points {
    /// The table.
    pub path: PathBuf,
    /// Its columns; those of the curves if absent.
    pub columns: Option<Columns>,
}

impl Points {
    /// Reads `FILE` or `FILE:X:Y`.
    ///
    /// # Errors
    /// [`PlotError::Quantity`] if the columns cannot be read.
    pub fn parse(text: &str) -> Result<Self, PlotError> {
        let (path, columns) = match text.split_once(':') {
            Some((path, columns)) => (path, Some(Columns::parse(columns)?)),
            None => (text, None),
        };
        Ok(Self {
            path: PathBuf::from(path),
            columns,
        })
    }
}

/// Tables, and what to draw of them.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Tables {
    /// Title of the chart.
    pub title: String,
    /// Names and paths of the tables whose columns are curves.
    pub tables: Vec<(String, PathBuf)>,
    /// The columns of both axes.
    pub columns: Columns,
    /// The pair of bodies whose rows are drawn; all pairs if absent.
    pub pair: Option<[String; 2]>,
    /// The gauges whose rows are drawn; all if absent.
    pub gauges: Vec<String>,
    /// The label of the upward axis, if not that of its columns.
    pub label: Option<String>,
    /// Measured points.
    pub points: Vec<Points>,
    /// `LOW:HIGH` of the axes, right and up; all values if absent.
    pub spans: [Option<String>; 2],
    /// `true` for axes, right and up, that are logarithmic; then the rows of a table, which may be
    /// few, are marked.
    pub logarithmic: [bool; 2],
    /// `true` if rows are dots, in no order, in place of curves.
    pub dots: bool,
}

impl Tables {
    /// Draws curves through the rows of each table, one for each series of it, and rings for
    /// measured points.
    ///
    /// # Errors
    /// [`PlotError::Table`] if a table or a column cannot be read, or has no such pair.
    pub fn chart(&self, opener: &dyn Opener) -> Result<Chart, PlotError> {
        let mut chart = Chart {
            title: self.title.clone(),
            ..Chart::default()
        };
        let mut of_pairs = false;
        for (k, (name, path)) in self.tables.iter().enumerate() {
            let failed = |reason: String| wrong(path, reason);
            let table = Table::read_of(opener, path, &self.gauges)?;
            of_pairs |= self.pair.is_none() && series::has_pairs(&table);
            let drawn: Vec<&str> = self.drawn().collect();
            let all = series(&table, &drawn, self.pair.as_ref()).map_err(failed)?;
            if k == 0 {
                self.name_axes(&mut chart, &table, path)?;
            }
            if let (Some(_), [pair]) = (&self.pair, &all[..]) {
                chart.subtitle.clone_from(&pair.name);
            }
            for series in all {
                for y in &self.columns.y {
                    let points = points(&table, &series, [&self.columns.x, y]).map_err(failed)?;
                    chart.curves.push(Curve {
                        name: self.name(name, &series, y),
                        colour: colour::body(chart.curves.len()),
                        mark: if self.dots { Mark::Dots } else { Mark::Line },
                        points,
                        ..Curve::default()
                    });
                }
            }
        }
        keep_what_is_seen(&mut chart.curves, if of_pairs { 1 } else { MANY });
        let curves = chart.curves.len();
        if self.logarithmic.contains(&true) {
            let marked = |curve: &Curve| Curve {
                mark: Mark::Rings,
                name: String::new(),
                ..curve.clone()
            };
            let marks: Vec<Curve> = chart.curves.iter().map(marked).collect();
            chart.curves.extend(marks);
        }
        for (k, measured) in self.points.iter().enumerate() {
            let columns = measured.columns.as_ref().unwrap_or(&self.columns);
            let stem = measured.path.file_stem().unwrap_or_default();
            let table = Table::read(&measured.path)?;
            let all = Series {
                name: String::new(),
                rows: (0..table.len()).collect(),
            };
            let points_of = points(&table, &all, [&columns.x, &columns.y[0]]);
            chart.curves.push(Curve {
                name: words(&stem.to_string_lossy()),
                colour: colour::body(curves + k),
                mark: Mark::Rings,
                points: points_of.map_err(|reason| wrong(&measured.path, reason))?,
                ..Curve::default()
            });
        }
        Ok(chart)
    }

    /// Names of the columns that are drawn.
    fn drawn(&self) -> impl Iterator<Item = &str> {
        [&self.columns.x]
            .into_iter()
            .chain(&self.columns.y)
            .map(String::as_str)
    }

    /// The name of a curve: the parts that distinguish it from the others.
    fn name(&self, table: &str, series: &Series, y: &str) -> String {
        let mut parts = Vec::new();
        if self.tables.len() > 1 {
            parts.push(table.to_owned());
        }
        if self.pair.is_none() && !series.name.is_empty() {
            parts.push(series.name.clone());
        }
        if self.columns.y.len() > 1 || (parts.is_empty() && !self.points.is_empty()) {
            parts.push(words(y));
        }
        parts.join(": ")
    }

    /// The axes, by the columns of the first table.
    fn name_axes(&self, chart: &mut Chart, table: &Table, path: &Path) -> Result<(), PlotError> {
        let axis = |name: &str, k: usize| -> Result<Quantity, PlotError> {
            let unit = series::unit(table, name).map_err(|reason| wrong(path, reason))?;
            let span = self.spans[k].as_deref();
            Ok(Quantity {
                label: words(name),
                logarithmic: self.logarithmic[k],
                from_zero: !self.logarithmic[k],
                room: true,
                span: span
                    .map(|text| units::parse_span(text, None, &unit))
                    .transpose()?,
                unit,
            })
        };
        (chart.x, chart.y) = (axis(&self.columns.x, 0)?, axis(&self.columns.y[0], 1)?);
        let names: Vec<String> = self.columns.y.iter().map(|y| words(y)).collect();
        chart.y.label = self.label.clone().unwrap_or(names.join(", "));
        Ok(())
    }
}

/// The two of `place_x`, `place_y` and `place_z` in which the places of a table differ most, as
/// [`Columns`] are typed: those along a witness plane.
///
/// # Errors
/// [`PlotError::Table`] if the table cannot be read or has no such columns.
pub fn widest(path: &Path) -> Result<String, PlotError> {
    let table = Table::read(path)?;
    let mut widths = Vec::new();
    for name in ["place_x", "place_y", "place_z"] {
        let all = table.column(name).map_err(|reason| wrong(path, reason))?;
        let most = |sign: f64| {
            all.iter()
                .map(|x| sign * x)
                .fold(f64::NEG_INFINITY, f64::max)
        };
        widths.push((most(1.0) + most(-1.0), name));
    }
    let narrowest = (0..3)
        .rev()
        .min_by(|&a, &b| widths[a].0.total_cmp(&widths[b].0));
    let mut names = (0..3)
        .filter(|k| Some(*k) != narrowest)
        .map(|k| widths[k].1);
    let [x, y] = [names.next(), names.next()].map(Option::unwrap_or_default);
    Ok(format!("{x}:{y}"))
}

/// Two columns of a series.
fn points(table: &Table, series: &Series, [x, y]: [&str; 2]) -> Result<Vec<[f64; 2]>, String> {
    let (xs, ys) = (series::numbers(table, x)?, series::numbers(table, y)?);
    Ok(series.rows.iter().map(|&row| [xs[row], ys[row]]).collect())
}

/// Curves without a number are left out, as of gauges that do not read the column. Of more than `most` curves
/// those that are zero throughout are left out too, as pairs of bodies that never meet; the others keep
/// their colours in order.
fn keep_what_is_seen(curves: &mut Vec<Curve>, most: usize) {
    let none = |curve: &Curve| curve.points.iter().all(|point| point[1].is_nan());
    if !curves.iter().all(none) {
        curves.retain(|curve| !none(curve));
    }
    let flat = |curve: &Curve| curve.points.iter().all(|point| point[1] == 0.0);
    if curves.len() > most && !curves.iter().all(flat) {
        curves.retain(|curve| !flat(curve));
        for (k, curve) in curves.iter_mut().enumerate() {
            curve.colour = colour::body(k);
        }
    }
}

/// As many curves as have colours of their own.
const MANY: usize = 7;

/// A column's name as people write it: `plate.hole_diameter` is the hole diameter of a measure.
fn words(name: &str) -> String {
    name.replace(['_', '.'], " ")
}

#[cfg(test)]
mod tests {
    use super::*;
    use model::Case;
    use results::{OutputError, ReadError, Sheet, SnapshotReader};

    #[test]
    fn crossings_are_drawn_along_their_plane() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("crossings.csv");
        std::fs::write(&path, "place_x,place_y,place_z\n1,0.5,3\n2,0.5,7\n").unwrap();
        assert_eq!(widest(&path).unwrap(), "place_x:place_z");
    }

    /// An [`Opener`] of nothing.
    #[derive(Debug)]
    struct Nothing;

    impl Opener for Nothing {
        fn snapshot(&self, _: &Path) -> Result<Box<dyn SnapshotReader>, ReadError> {
            unreachable!("no snapshot is drawn")
        }

        fn gauges(&self, _: &Path, _: Option<&[String]>) -> Result<Option<Sheet>, OutputError> {
            Ok(None)
        }

        fn case(&self, _: &Path) -> Result<Case, String> {
            Err(String::new())
        }
    }

    #[test]
    fn pairs_that_never_meet_are_left_out() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("contacts.csv");
        let text = "time,body_a,body_b,force\n0,ball,plate,0\n0,ball,wall,0\n0,plate,wall,0\n\
                    1,ball,plate,7\n1,ball,wall,0\n1,plate,wall,0\n";
        std::fs::write(&path, text).unwrap();
        let tables = Tables {
            tables: vec![(String::new(), path)],
            columns: Columns::parse("time:force").unwrap(),
            ..Tables::default()
        };
        let chart = tables.chart(&Nothing).unwrap();
        let names: Vec<&str> = chart.curves.iter().map(|curve| &curve.name[..]).collect();
        assert_eq!(names, ["ball – plate"]);
    }

    #[test]
    fn columns_of_measures_are_in_words() {
        assert_eq!(words("plate.hole_diameter"), "plate hole diameter");
    }

    #[test]
    fn columns_and_points_are_read() {
        let columns = Columns::parse("time:kinetic_energy, internal_energy").unwrap();
        assert_eq!(columns.y, ["kinetic_energy", "internal_energy"]);
        for wrong in ["time", "time:", ":b", "a:b,", "a:b:c"] {
            let message = Columns::parse(wrong).unwrap_err().to_string();
            assert!(message.contains("X:Y"), "{message}");
        }
        let points = Points::parse("a/b.csv:T:Z").unwrap();
        assert_eq!(points.path, Path::new("a/b.csv"));
        assert_eq!(points.columns.unwrap().y, ["Z"]);
        assert_eq!(Points::parse("b.csv").unwrap().columns, None);
    }
}
