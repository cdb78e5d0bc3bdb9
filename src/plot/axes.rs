//! A frame with marks and labels.

use super::canvas::{Align, Canvas, Frame, INK, Rgb};
use super::style::Style;
use super::ticks::Ticks;

/// Colour of grid lines.
const GRID: Rgb = [226, 226, 226];

/// A frame with a linear map from numbers to pixels.
#[derive(Debug, Clone, Copy)]
pub struct Axes {
    pub frame: Frame,
    /// Numbers at the left and right edges.
    pub x: [f64; 2],
    /// Numbers at the lower and upper edges.
    pub y: [f64; 2],
}

impl Axes {
    /// The pixel of a point.
    pub fn at(&self, x: f64, y: f64) -> (f32, f32) {
        (
            self.frame.left + self.frame.width * share(x, self.x),
            self.frame.bottom() - self.frame.height * share(y, self.y),
        )
    }

    /// Border, marks, numbers and label of the lower axis; numbers and label only if `label` is
    /// given.
    pub fn draw_x(&self, canvas: &mut Canvas, style: Style, ticks: &Ticks, label: Option<&str>) {
        let bottom = self.frame.bottom();
        let baseline = bottom + style.tick() + style.gap() + 0.75 * style.small();
        for (&value, number) in ticks.values.iter().zip(&ticks.labels) {
            let (x, _) = self.at(value, self.y[0]);
            canvas.line(
                &[(x, bottom), (x, bottom + style.tick())],
                style.line(),
                INK,
            );
            if label.is_some() {
                canvas.text(number, (x, baseline), style.small(), Align::Middle);
            }
        }
        if let Some(label) = label {
            let middle = self.frame.left + 0.5 * self.frame.width;
            let baseline = baseline + style.gap() + style.text();
            canvas.text(label, (middle, baseline), style.text(), Align::Middle);
        }
        canvas.border(&self.frame, style.line(), INK);
    }

    /// Pale lines across the frame at the marks of both axes.
    pub fn draw_grid(&self, canvas: &mut Canvas, style: Style, x_ticks: &Ticks, y_ticks: &Ticks) {
        for &value in &x_ticks.values {
            let ends = [self.at(value, self.y[0]), self.at(value, self.y[1])];
            canvas.line(&ends, style.line(), GRID);
        }
        for &value in &y_ticks.values {
            let ends = [self.at(self.x[0], value), self.at(self.x[1], value)];
            canvas.line(&ends, style.line(), GRID);
        }
    }

    /// Marks, numbers and label of the left axis; numbers and label only if `label` is given.
    pub fn draw_y(&self, canvas: &mut Canvas, style: Style, ticks: &Ticks, label: Option<&str>) {
        let left = self.frame.left;
        let end = left - style.tick() - 0.5 * style.gap();
        for (&value, number) in ticks.values.iter().zip(&ticks.labels) {
            let (_, y) = self.at(self.x[0], value);
            canvas.line(&[(left - style.tick(), y), (left, y)], style.line(), INK);
            if label.is_some() {
                let baseline = y + 0.36 * style.small();
                canvas.text(number, (end, baseline), style.small(), Align::End);
            }
        }
        if let Some(label) = label {
            let middle = self.frame.top + 0.5 * self.frame.height;
            let x = end - style.widest(ticks) - 1.5 * style.gap();
            canvas.text_upwards(label, (x, middle), style.text(), Align::Middle);
        }
    }
}

/// The position of a number in a span, 0 to 1.
#[expect(clippy::cast_possible_truncation, reason = "a pixel needs no more")]
fn share(value: f64, span: [f64; 2]) -> f32 {
    ((value - span[0]) / (span[1] - span[0])) as f32
}
