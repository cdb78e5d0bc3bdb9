//! Columns of tables against each other: series of runs, measured points, convergence.

use std::path::{Path, PathBuf};

use super::axes::Mark;
use super::chart::{Chart, Curve, Quantity};
use super::colour;
use super::table::{Table, wrong};
use super::{PlotError, units};

/// What is drawn against what.
#[derive(Debug, Clone, PartialEq, Eq)]
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
        let wrong = || PlotError::Quantity {
            text: text.to_owned(),
            expected: "columns X:Y or X:Y,Y2, as in time:kinetic_energy".to_owned(),
        };
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
#[derive(Debug, Clone, PartialEq)]
pub struct Tables {
    /// Title of the chart.
    pub title: String,
    /// Names and places of the tables whose columns are curves.
    pub tables: Vec<(String, PathBuf)>,
    /// What is drawn against what.
    pub columns: Columns,
    /// Measured points.
    pub points: Vec<Points>,
    /// `LOW:HIGH` of the axes, right and up; all values if absent.
    pub spans: [Option<String>; 2],
    /// Whether the axes, right and up, are logarithmic; then the rows of a table, which may be
    /// few, are marked.
    pub logarithmic: [bool; 2],
}

impl Tables {
    /// Draws curves through the rows of each table and rings for measured points.
    ///
    /// # Errors
    /// [`PlotError::Table`] if a table or a column cannot be read.
    pub fn chart(&self) -> Result<Chart, PlotError> {
        let mut chart = Chart {
            title: self.title.clone(),
            ..Chart::default()
        };
        let several = [self.tables.len() > 1, self.columns.y.len() > 1];
        for (name, path) in &self.tables {
            for y in &self.columns.y {
                let name = match several {
                    [false, false] if self.points.is_empty() => String::new(),
                    [false, _] => words(y),
                    [true, false] => name.clone(),
                    [true, true] => format!("{name}: {}", words(y)),
                };
                let colour = colour::body(chart.curves.len());
                let points = self.read(&mut chart, path, &self.columns.x, y)?;
                chart.curves.push(Curve {
                    name,
                    colour,
                    mark: Mark::Line,
                    points,
                });
            }
        }
        if self.logarithmic.contains(&true) {
            let marked = |curve: &Curve| Curve {
                mark: Mark::Rings,
                name: String::new(),
                ..curve.clone()
            };
            let marks: Vec<Curve> = chart.curves.iter().map(marked).collect();
            chart.curves.extend(marks);
        }
        for (k, points) in self.points.iter().enumerate() {
            let columns = points.columns.as_ref().unwrap_or(&self.columns);
            let stem = points.path.file_stem().unwrap_or_default();
            let places = self.read(&mut chart, &points.path, &columns.x, &columns.y[0])?;
            chart.curves.push(Curve {
                name: words(&stem.to_string_lossy()),
                colour: colour::body(self.tables.len() * self.columns.y.len() + k),
                mark: Mark::Rings,
                points: places,
            });
        }
        Ok(chart)
    }

    /// Reads two columns; the first table read gives the axes.
    fn read(
        &self,
        chart: &mut Chart,
        path: &Path,
        x: &str,
        y: &str,
    ) -> Result<Vec<[f64; 2]>, PlotError> {
        let table = Table::read(path)?;
        let failed = |reason: String| wrong(path, reason);
        let [xs, ys] = [
            table.column(x).map_err(failed)?,
            table.column(y).map_err(failed)?,
        ];
        if chart.curves.is_empty() {
            let axis = |name: &str, k: usize| -> Result<Quantity, PlotError> {
                let unit = table.unit(name).map_err(failed)?;
                let span = self.spans[k].as_deref();
                Ok(Quantity {
                    label: words(name),
                    unit: unit.to_owned(),
                    logarithmic: self.logarithmic[k],
                    from_zero: !self.logarithmic[k],
                    room: true,
                    span: span
                        .map(|text| units::parse_span(text, None, unit))
                        .transpose()?,
                })
            };
            (chart.x, chart.y) = (axis(x, 0)?, axis(y, 1)?);
            if let [_, _, ..] = self.columns.y[..] {
                chart.y.label = self
                    .columns
                    .y
                    .iter()
                    .map(|y| words(y))
                    .collect::<Vec<_>>()
                    .join(", ");
            }
        }
        Ok(xs.into_iter().zip(ys).map(|(x, y)| [x, y]).collect())
    }
}

/// A column's name as people write it.
fn words(name: &str) -> String {
    name.replace('_', " ")
}

#[cfg(test)]
mod tests {
    use super::*;

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
