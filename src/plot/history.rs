//! Energies against time from a run's `history.csv`.

use std::path::Path;

use super::PlotError;
use super::axes::{Axes, Header, Style};
use super::canvas::{Canvas, Frame, Rgb};
use super::figure::{WIDTH, whole};
use super::ticks::{Ticks, nice_step};
use super::units::Readable;

/// Columns that are drawn, their names in the legend and their colours.
const CURVES: [(&str, &str, Rgb); 4] = [
    ("total_energy", "total", [40, 40, 40]),
    ("kinetic_energy", "kinetic", [0, 114, 178]),
    ("internal_energy", "internal", [213, 94, 0]),
    ("contact_energy", "contact", [0, 158, 115]),
];

/// Time and energies of a run, by column.
#[derive(Debug, Clone, PartialEq)]
pub struct History {
    /// Times (s).
    time: Vec<f64>,
    /// Energies (J), as many as times; one for each of [`CURVES`].
    energies: [Vec<f64>; 4],
}

impl History {
    /// Reads a `history.csv`: lines of `#` are comments, the first other line names the columns.
    ///
    /// # Errors
    /// [`PlotError::History`] if the file or a column is missing or a number cannot be read.
    pub fn read(path: &Path) -> Result<Self, PlotError> {
        let wrong = |reason: String| PlotError::History {
            path: path.to_owned(),
            reason,
        };
        let text = std::fs::read_to_string(path).map_err(|e| wrong(e.to_string()))?;
        Self::parse(&text).map_err(wrong)
    }

    fn parse(text: &str) -> Result<Self, String> {
        let mut lines = text
            .lines()
            .zip(1..)
            .filter(|(line, _)| !line.trim().is_empty() && !line.starts_with('#'));
        let (header, _) = lines.next().ok_or("it is empty")?;
        let names: Vec<&str> = header.split(',').map(str::trim).collect();
        let column = |name: &str| {
            let found = names.iter().position(|n| *n == name);
            found.ok_or_else(|| format!("it has no column {name}"))
        };
        let time_column = column("time")?;
        let mut columns = [0; 4];
        for (at, (name, ..)) in columns.iter_mut().zip(CURVES) {
            *at = column(name)?;
        }
        let mut history = Self {
            time: Vec::new(),
            energies: Default::default(),
        };
        for (line, number) in lines {
            let cells: Vec<&str> = line.split(',').map(str::trim).collect();
            let value = |column: usize| {
                let cell = cells
                    .get(column)
                    .ok_or_else(|| format!("line {number} is cut off"))?;
                let value = cell.parse::<f64>();
                value.map_err(|_| format!("line {number}: \"{cell}\" is no number"))
            };
            history.time.push(value(time_column)?);
            for (energies, &at) in history.energies.iter_mut().zip(&columns) {
                energies.push(value(at)?);
            }
        }
        if history.time.is_empty() {
            return Err("it has no rows yet".to_owned());
        }
        Ok(history)
    }

    /// Draws the energies against time, in a width in pixels.
    ///
    /// # Errors
    /// [`PlotError::Size`] if no such picture can be held.
    pub fn draw(&self, title: &str, width: Option<u32>) -> Result<Canvas, PlotError> {
        let width = width.unwrap_or(WIDTH);
        let style = Style::new(width, WIDTH);
        let header = Header {
            title,
            subtitle: "energies",
            legend: CURVES.map(|(_, name, colour)| (name, colour)).to_vec(),
        };
        let (x, time_unit) = readable(&self.time, "s");
        let all: Vec<f64> = self.energies.concat();
        let (mut y, unit) = readable(&all, "J");
        let border = 0.04 * (y[1] - y[0]);
        y[1] += border;
        y[0] -= if y[0] < 0.0 { border } else { 0.0 };

        let top = header.draw(None, style, width as f32) + style.gap();
        let height = 560.0 * style.unit;
        let y_ticks = Ticks::new(y, nice_step((y[1] - y[0]) / 8.0));
        let left = style.margin() + style.beside(&y_ticks);
        let frame = Frame {
            left: left.round(),
            top: top.round(),
            width: (width as f32 - left - 2.0 * style.margin()).round(),
            height: height.round(),
        };
        let x_ticks = Ticks::new(x, nice_step((x[1] - x[0]) / 8.0));
        let total = whole(frame.bottom() + style.below() + 0.5 * style.margin());
        let mut canvas = Canvas::new(width, total)?;
        header.draw(Some(&mut canvas), style, width as f32);

        let axes = Axes { frame, x, y };
        axes.draw_grid(&mut canvas, style, &x_ticks, &y_ticks);
        for (energies, (_, _, colour)) in self.energies.iter().zip(CURVES) {
            let points = self
                .time
                .iter()
                .zip(energies)
                .filter(|(t, e)| (**t + **e).is_finite());
            let points = points.map(|(t, e)| axes.at(t / time_unit.size, e / unit.size));
            canvas.line(&thinned(points), 3.0 * style.unit, colour);
        }
        axes.draw_x(&mut canvas, style, &x_ticks, Some(&time_unit.label("time")));
        axes.draw_y(&mut canvas, style, &y_ticks, Some(&unit.label("energy")));
        Ok(canvas)
    }
}

/// The span of values and zero in the unit that suits them, and this unit.
fn readable(values: &[f64], unit: &str) -> ([f64; 2], Readable) {
    let finite = values.iter().copied().filter(|v| v.is_finite());
    let [low, high] = finite.fold([0.0_f64, 0.0_f64], |[low, high], v| {
        [low.min(v), high.max(v)]
    });
    let unit = Readable::new(unit, high.max(-low));
    let span = [low / unit.size, high / unit.size];
    if span[0] < span[1] {
        (span, unit)
    } else {
        ([0.0, 1.0], unit)
    }
}

/// Points of a curve at least a quarter of a pixel apart: a long run has far more rows than a
/// picture has pixels.
fn thinned(points: impl Iterator<Item = (f32, f32)>) -> Vec<(f32, f32)> {
    let mut kept: Vec<(f32, f32)> = Vec::new();
    let mut last = None;
    for (x, y) in points {
        let far = |&(a, b): &(f32, f32)| (x - a).abs().max((y - b).abs()) >= 0.25;
        if kept.last().is_none_or(far) {
            kept.push((x, y));
        }
        last = Some((x, y));
    }
    kept.extend(last);
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    const HEAD: &str = "# time in s, energies in J\n\
        step, time, kinetic_energy, internal_energy, contact_energy, total_energy\n";

    #[test]
    fn reads_columns_by_name() {
        let history = History::parse(&format!("{HEAD}0,0.0,3,1,0,4\n\n5,1e-8,2,1.5,0.5,4\n"));
        let history = history.unwrap();
        assert_eq!(history.time, [0.0, 1e-8]);
        assert_eq!(history.energies[1], [3.0, 2.0]);
        assert_eq!(history.energies[3], [0.0, 0.5]);
    }

    #[test]
    fn complaints_name_the_line_or_the_column() {
        let message = |text: &str| History::parse(text).unwrap_err();
        assert!(message("time,kinetic_energy\n").contains("no column total_energy"));
        assert!(message(&format!("{HEAD}0,0,1,1,x,2\n")).contains("line 3: \"x\""));
        assert!(message(&format!("{HEAD}0,0,1\n")).contains("line 3 is cut off"));
        assert!(message(HEAD).contains("no rows"));
        assert!(message("").contains("empty"));
    }

    #[test]
    fn thinning_keeps_both_ends() {
        let kept = thinned((0..1000).map(|k| (k as f32 * 0.01, 0.0)));
        assert!(kept.len() < 50);
        assert_eq!((kept[0].0, kept[kept.len() - 1].0), (0.0, 9.99));
    }
}
