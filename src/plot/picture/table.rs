//! A section as a table: a grid of its points, or its particles.

use std::io::{self, Write};
use std::ops::Range;

use rayon::prelude::*;

use super::cells::{Cell, Sample, Tiles};
use super::figure::Figure;
use super::pictures::Pictures;
use super::section::{DrawnAs, Section};
use super::view::View;
use crate::snapshots::field::Drawn;
use model::Axis;
use results::{Sheet, table_line};

/// Rows of a grid that are found at once.
const BAND: usize = 64;

/// A place (m), and what is there.
type Row = ([f64; 2], Sample);

impl Pictures {
    /// Writes the table of some snapshots, by their indices among the paths, as a picture of a
    /// width in pixels draws them: for a cut a row for each pixel in a body, at its middle; for a
    /// slice one for each particle. Time, run, position, body and field, in SI units.
    ///
    /// # Errors
    /// Those of the system.
    pub fn write_table(
        &self,
        chosen: Range<usize>,
        width: Option<u32>,
        out: &mut impl Write,
    ) -> io::Result<()> {
        out.write_all(&self.head().text())?;
        let figure = self.figure_of(chosen.clone(), width);
        for (k, section) in chosen.zip(figure.sections) {
            let mut before = vec![format!("{:?}", section.time)];
            if let Some(names) = &self.titles.names {
                before.push(names[k].clone());
            }
            let mut before = table_line(before);
            before.pop();
            let mut write = |rows: &[Row]| -> io::Result<()> {
                for ([x, y], sample) in rows {
                    out.write_all(&before)?;
                    write!(out, ",{x:?},{y:?},")?;
                    let mut body = table_line([&self.bodies[sample.body]]);
                    body.pop();
                    out.write_all(&body)?;
                    match sample.value {
                        Some(value) if self.has_field() => writeln!(out, ",{value:?}")?,
                        _ if self.has_field() => writeln!(out, ",")?,
                        _ => writeln!(out)?,
                    }
                }
                Ok(())
            };
            match self.cut.drawn_as {
                DrawnAs::Cut => grid(&figure, section, &mut write)?,
                DrawnAs::Particles => write(&particles(section, &figure.view))?,
            }
        }
        Ok(())
    }

    fn has_field(&self) -> bool {
        matches!(self.cut.drawn, Drawn::Field(_))
    }

    /// The table without rows.
    fn head(&self) -> Sheet {
        let [right, up] = self.cut.plane.picture_axes().map(Axis::name);
        let mut columns = vec![("time", "s"), (right, "m"), (up, "m"), ("body", "")];
        if self.titles.names.is_some() {
            columns.insert(1, ("run", ""));
        }
        let field = match &self.cut.drawn {
            Drawn::Field(field) => Some((field.label.replace(' ', "_"), field.unit.clone())),
            Drawn::Body => None,
        };
        let columns = columns
            .into_iter()
            .map(|(a, b)| (a.to_owned(), b.to_owned()));
        let (names, units) = columns.chain(field).unzip();
        Sheet {
            computed_share: None,
            names,
            units,
            rows: Vec::new(),
        }
    }
}

/// The samples at the middles of the pixels of a panel, some rows of them at a time, from the top.
fn grid(
    figure: &Figure,
    section: &Section,
    write: &mut impl FnMut(&[Row]) -> io::Result<()>,
) -> io::Result<()> {
    let layout = figure.layout();
    let view = layout.view;
    let frame = layout.frames[0];
    let [columns, rows] = frame.pixels();
    let tiles = Tiles::new(&section.cells, view, view.width() / columns as f64);
    let share = |k: usize, count: usize| (k as f64 + 0.5) / count as f64;
    let of_row = |row: usize| -> Vec<Row> {
        let y = view.y[1] - view.height() * share(row, rows);
        let middles = (0..columns).map(|k| [view.x[0] + view.width() * share(k, columns), y]);
        middles
            .filter_map(|at| Some((at, tiles.sample(at)?)))
            .collect()
    };
    for first in (0..rows).step_by(BAND) {
        let band = first..rows.min(first + BAND);
        let rows_of: Vec<Vec<Row>> = band.into_par_iter().map(of_row).collect();
        write(&rows_of.concat())?;
    }
    Ok(())
}

/// The particles that a view shows, the nearest to the plane last.
fn particles(section: &Section, view: &View) -> Vec<Row> {
    let seen = section.cells.iter();
    let seen = seen.filter(|cell| view.shows(cell.at, cell.radii()));
    let row = |cell: &Cell| {
        let (body, value) = (cell.body, cell.value);
        (cell.at, Sample { body, value })
    };
    seen.map(row).collect()
}
