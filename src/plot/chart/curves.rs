//! A chart: curves and dots over two axes, linear or logarithmic.

use crate::PlotError;
use crate::axes::Axes;
use crate::canvas::{Canvas, Frame, INK, Rgb};
use crate::header::{Entry, Header, Mark};
use crate::style::{Style, WIDTH, whole};
use crate::ticks::{Ticks, nice_step};
use crate::units::Readable;

/// An axis of a chart.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Quantity {
    /// Its name: `"pressure"`.
    pub label: String,
    /// Its SI unit, in which the values are; empty for none.
    pub unit: String,
    /// Values at both ends; all of them, with some room, if absent.
    pub span: Option<[f64; 2]>,
    /// Powers of ten at even distances; values that are not positive are left out.
    pub logarithmic: bool,
    /// `true` if an axis without a span begins or ends at zero if its values are on one side.
    pub from_zero: bool,
    /// `true` if an axis without a span keeps some room beyond its values.
    pub room: bool,
}

/// A curve of a chart.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Curve {
    /// Name in the legend; none if empty.
    pub name: String,
    /// Its name in a table of the chart, if not that of the legend.
    pub in_tables: String,
    /// Colour.
    pub colour: Rgb,
    /// The way it is drawn.
    pub mark: Mark,
    /// Points (x, y) in the axes' SI units, in order; one that is not finite interrupts a line.
    pub points: Vec<[f64; 2]>,
}

/// The name of a curve, its colour and its points.
pub(super) type Line = (String, Rgb, Vec<[f64; 2]>);

/// A chart.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Chart {
    /// First line.
    pub title: String,
    /// Second line; none if empty.
    pub subtitle: String,
    /// To the right.
    pub x: Quantity,
    /// Upwards.
    pub y: Quantity,
    /// Curves; later ones are drawn over earlier ones.
    pub curves: Vec<Curve>,
}

/// An axis as it is drawn.
pub(super) struct Ruler {
    /// Ends, in readable units or powers of ten of them.
    pub span: [f64; 2],
    pub unit: Readable,
    pub ticks: Ticks,
    logarithmic: bool,
}

impl Chart {
    /// Draws the chart in a width in pixels.
    ///
    /// # Errors
    /// [`PlotError::Size`] if no such picture can be held.
    pub fn draw(&self, width: Option<u32>) -> Result<Canvas, PlotError> {
        let width = width.unwrap_or(WIDTH);
        let style = Style::new(width, WIDTH);
        let header = self.header();
        let [x, y] = [(&self.x, 0, 9.0), (&self.y, 1, 8.0)].map(|(axis, k, marks)| {
            let values = self.curves.iter().flat_map(|c| &c.points);
            Ruler::new(axis, values.map(|point| point[k]), marks)
        });

        let top = header.draw(None, style, width as f32) + style.gap();
        let left = style.margin() + style.beside(&y.ticks);
        let frame = Frame {
            left: left.round(),
            top: top.round(),
            width: (width as f32 - left - 2.0 * style.margin()).round(),
            height: (560.0 * style.unit).round(),
        };
        let total = whole(frame.bottom() + style.below() + 0.5 * style.margin());
        let mut canvas = Canvas::new(width, total)?;
        let axes = Axes {
            frame,
            x: x.span,
            y: y.span,
        };
        axes.draw_grid(&mut canvas, style, &x.ticks, &y.ticks);
        canvas.within(&frame, |canvas| {
            for curve in &self.curves {
                let points = curve.points.iter().map(|&[a, b]| {
                    let (a, b) = (x.position(a), y.position(b));
                    (a + b).is_finite().then(|| axes.at(a, b))
                });
                draw_curve(canvas, style, &frame, curve, points);
            }
        });
        header.draw(Some(&mut canvas), style, width as f32);
        let labels = [(&self.x, &x), (&self.y, &y)].map(|(axis, r)| r.unit.label(&axis.label));
        axes.draw_x(&mut canvas, style, &x.ticks, Some(&labels[0]));
        axes.draw_y(&mut canvas, style, &y.ticks, Some(&labels[1]));
        Ok(canvas)
    }

    fn header(&self) -> Header<'_> {
        let named = self.curves.iter().filter(|curve| !curve.name.is_empty());
        let entry = |curve: &'_ Curve| Entry {
            name: curve.name.clone(),
            colour: curve.colour,
            mark: curve.mark,
        };
        Header {
            title: &self.title,
            subtitle: &self.subtitle,
            legend: named.map(entry).collect(),
        }
    }
}

fn draw_curve(
    canvas: &mut Canvas,
    style: Style,
    frame: &Frame,
    curve: &Curve,
    points: impl Iterator<Item = Option<(f32, f32)>>,
) {
    match curve.mark {
        Mark::Dots => {
            let room = frame.width / curve.points.len().max(1) as f32;
            let radius = (0.8 * room).clamp(1.8 * style.unit, 4.0 * style.unit);
            for at in points.flatten() {
                canvas.disc(at, radius, curve.colour, frame);
            }
        }
        Mark::Rings => {
            let rim = (2.0 * style.unit, INK);
            for at in points.flatten() {
                canvas.bead(at, 6.5 * style.unit, curve.colour, rim, frame);
            }
        }
        Mark::Line | Mark::Thin => {
            let width = if curve.mark == Mark::Thin { 1.7 } else { 3.0 };
            let points: Vec<_> = points.collect();
            for stretch in points.split(Option::is_none) {
                let stretch: Vec<_> = stretch.iter().copied().flatten().collect();
                canvas.line(&thinned(&stretch), width * style.unit, curve.colour);
            }
        }
    }
}

impl Ruler {
    pub fn new(axis: &Quantity, values: impl Iterator<Item = f64>, marks: f64) -> Self {
        let known = |v: &f64| v.is_finite() && (*v > 0.0 || !axis.logarithmic);
        let all = values
            .filter(known)
            .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], v| {
                [low.min(v), high.max(v)]
            });
        let ends = axis.span.unwrap_or(all);
        let unit = if ends[0] <= ends[1] {
            Readable::new(&axis.unit, ends[0].abs().max(ends[1].abs()))
        } else {
            Readable::new(&axis.unit, 0.0)
        };
        let ends = ends.map(|v| v / unit.size);
        if axis.logarithmic {
            return Self::decades(axis, ends, unit);
        }
        let span = match axis.span {
            Some(_) => ends,
            None => roomy(axis, ends),
        };
        let ticks = Ticks::new(span, nice_step((span[1] - span[0]) / marks));
        Self {
            span,
            unit,
            ticks,
            logarithmic: false,
        }
    }

    /// An axis of powers of ten; with marks between them if there are few.
    fn decades(axis: &Quantity, ends: [f64; 2], unit: Readable) -> Self {
        let mut span = match ends {
            [low, high] if low > 0.0 && high >= low => ends.map(f64::log10),
            _ => [0.0, 1.0],
        };
        if axis.span.is_none() {
            let room = (0.06 * (span[1] - span[0])).max(0.05);
            span = [span[0] - room, span[1] + room];
        }
        Self {
            span,
            unit,
            ticks: Ticks::powers(span),
            logarithmic: true,
        }
    }

    /// The position of an SI value on the axis.
    pub fn position(&self, value: f64) -> f64 {
        let value = value / self.unit.size;
        if self.logarithmic {
            value.log10()
        } else {
            value
        }
    }
}

/// The ends of an axis about all values.
fn roomy(axis: &Quantity, [low, high]: [f64; 2]) -> [f64; 2] {
    if low > high {
        return [0.0, 1.0];
    }
    let (mut low, mut high) = (low, high);
    if axis.from_zero {
        (low, high) = (low.min(0.0), high.max(0.0));
    }
    // A field that is constant but for round-off.
    let size = low.abs().max(high.abs());
    if high - low <= 1e-9 * size || size == 0.0 {
        let half = if size == 0.0 { 0.5 } else { 0.05 * size };
        return [low - half, high + half];
    }
    let room = if axis.room { 0.04 * (high - low) } else { 0.0 };
    let keeps = |end: f64| axis.from_zero && end == 0.0;
    [
        if keeps(low) { low } else { low - room },
        if keeps(high) { high } else { high + room },
    ]
}

/// Points of a curve that are seen to be others: a long run has far more rows than a picture has
/// pixels. Of those that follow each other in half a column of pixels the first, the lowest, the
/// highest and the last, and of these no two within a quarter of a pixel.
fn thinned(points: &[(f32, f32)]) -> Vec<(f32, f32)> {
    let mut kept: Vec<(f32, f32)> = Vec::new();
    let column = |at: &(f32, f32)| (2.0 * at.0).floor();
    for run in points.chunk_by(|a, b| column(a) == column(b)) {
        let by_height = |k: &usize, l: &usize| run[*k].1.total_cmp(&run[*l].1);
        let mut ends = [0; 4];
        ends[1] = (0..run.len()).min_by(by_height).unwrap_or_default();
        ends[2] = (0..run.len()).max_by(by_height).unwrap_or_default();
        ends[3] = run.len() - 1;
        ends.sort_unstable();
        for (x, y) in ends.map(|k| run[k]) {
            let far = |&(a, b): &(f32, f32)| (x - a).abs().max((y - b).abs()) >= 0.25;
            if kept.last().is_none_or(far) {
                kept.push((x, y));
            }
        }
    }
    if kept.last() != points.last() {
        kept.extend(points.last());
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thinning_keeps_both_ends() {
        let line: Vec<_> = (0..1000).map(|k| (k as f32 * 0.01, 0.0)).collect();
        let kept = thinned(&line);
        assert!(kept.len() < 50);
        assert_eq!((kept[0].0, kept[kept.len() - 1].0), (0.0, 9.99));
    }

    #[test]
    fn thinning_keeps_peaks_of_noise() {
        let height = |k: usize| if k == 7_777 { 99.0 } else { (k % 7) as f32 };
        let noise: Vec<_> = (0..100_000).map(|k| (k as f32 * 1e-3, height(k))).collect();
        let kept = thinned(&noise);
        assert!(kept.len() < 1000, "{}", kept.len());
        assert!(kept.iter().any(|at| at.1 == 99.0));
    }

    #[test]
    fn axes_hold_all_values_and_some_room() {
        let axis = Quantity {
            unit: "Pa".to_owned(),
            room: true,
            ..Quantity::default()
        };
        let ruler = Ruler::new(&axis, [1e9, f64::NAN, 3e9].into_iter(), 8.0);
        assert_eq!(ruler.unit.name, "GPa");
        assert!(ruler.span[0] < 1.0 && ruler.span[1] > 3.0 && ruler.span[0] > 0.5);
        let zero = Quantity {
            from_zero: true,
            ..axis
        };
        assert_eq!(Ruler::new(&zero, [1e9, 3e9].into_iter(), 8.0).span[0], 0.0);
        for values in [vec![], vec![2.0, 2.0], vec![0.0]] {
            let span = Ruler::new(&zero, values.into_iter(), 8.0).span;
            assert!(span[0] < span[1]);
        }
    }

    #[test]
    fn logarithmic_axes_leave_out_what_is_not_positive() {
        let axis = Quantity {
            logarithmic: true,
            ..Quantity::default()
        };
        let ruler = Ruler::new(&axis, [0.0, -1.0, 0.02, 5.0].into_iter(), 8.0);
        assert!(ruler.span[0] < 0.02_f64.log10() && ruler.span[0] > -2.0);
        assert!(!ruler.position(0.0).is_finite() && (ruler.position(1.0)).abs() < 1e-15);
        assert!(
            ruler.ticks.labels.contains(&"0.1".to_owned()),
            "{:?}",
            ruler.ticks
        );
    }
}
