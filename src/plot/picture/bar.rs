//! The colour bar beside a picture.

use crate::axes::Axes;
use crate::canvas::{Align, Canvas, Frame, INK};
use crate::colour::Scale;
use crate::font;
use crate::style::Style;
use crate::ticks::{Ticks, nice_step};
use crate::units::Readable;

/// Stretches of a bar between which its colours are those of the map.
const STOPS: usize = 64;

/// The colour bar of a field.
#[derive(Debug, Clone)]
pub struct ColourBar {
    /// Range and map.
    pub scale: Scale,
    /// Unit of the numbers.
    pub unit: Readable,
    /// The label of the numbers, with unit.
    pub label: String,
}

impl ColourBar {
    /// Of a quantity with its SI unit; `lost` says whether some values are no numbers.
    pub fn new(scale: Scale, quantity: &str, unit: &str, lost: bool) -> Self {
        let unit = Readable::new(unit, scale.high.abs().max(scale.low.abs()));
        let mut label = unit.label(quantity);
        if lost {
            label += "; pink: not finite";
        }
        Self { scale, unit, label }
    }

    /// Room that a bar needs beside the panels, with numbers of typical length.
    pub fn room(style: Style) -> f32 {
        150.0 * style.unit
    }

    /// Values at the ends, in the bar's unit.
    fn span(&self) -> [f64; 2] {
        [self.scale.low, self.scale.high].map(|v| v / self.unit.size)
    }

    /// Draws the bar with its left side at `left`, as high as the panels.
    pub fn draw(&self, canvas: &mut Canvas, style: Style, left: f32, top: f32, bottom: f32) {
        let frame = Frame {
            left,
            top,
            width: 24.0 * style.unit,
            height: bottom - top,
        };
        let body = self.draw_colours(canvas, style, &frame);
        let span = self.span();
        let marks = f64::from(body.height / (48.0 * style.unit)).clamp(2.0, 12.0);
        let ticks = Ticks::new(span, nice_step((span[1] - span[0]) / marks));
        let axes = Axes {
            frame: body,
            x: [0.0, 1.0],
            y: span,
        };
        let edge = body.right();
        let start = edge + style.tick() + 0.5 * style.gap();
        for (&value, number) in ticks.values.iter().zip(&ticks.labels) {
            let (_, y) = axes.at(0.0, value);
            canvas.line(&[(edge, y), (edge + style.tick(), y)], style.line(), INK);
            let at = (start, y + 0.36 * style.small());
            canvas.text(number, at, style.small(), Align::Start);
        }
        let length = font::width(&self.label, style.text());
        let size = style.text() * (frame.height / length).clamp(0.5, 1.0);
        let x = start + style.widest(&ticks) + 1.2 * style.gap() + 0.75 * size;
        let middle = frame.top + 0.5 * frame.height;
        canvas.text_upwards(&self.label, (x, middle), size, Align::Middle);
    }

    /// The colours, with a triangle where values lie beyond an end; returns the part between.
    fn draw_colours(&self, canvas: &mut Canvas, style: Style, frame: &Frame) -> Frame {
        let scale = &self.scale;
        let tip = 16.0 * style.unit;
        let top = frame.top + if scale.above { tip } else { 0.0 };
        let bottom = frame.bottom() - if scale.below { tip } else { 0.0 };
        let (left, right) = (frame.left, frame.right());
        let middle = 0.5 * (left + right);
        let body = Frame {
            top,
            height: bottom - top,
            ..*frame
        };
        let colour = |k: usize| {
            let share = 1.0 - k as f64 / STOPS as f64;
            scale.colour(scale.low + share * (scale.high - scale.low))
        };
        canvas.gradient(&body, &(0..=STOPS).map(colour).collect::<Vec<_>>());
        let mut outline = vec![(left, bottom), (left, top)];
        if scale.above {
            let tip = (middle, frame.top);
            canvas.polygon(&[(left, top), tip, (right, top)], scale.colour(scale.high));
            outline.push(tip);
        }
        outline.extend([(right, top), (right, bottom)]);
        if scale.below {
            let tip = (middle, frame.bottom());
            canvas.polygon(
                &[(left, bottom), tip, (right, bottom)],
                scale.colour(scale.low),
            );
            outline.push(tip);
        }
        outline.extend([(left, bottom), (left, top)]);
        canvas.line(&outline, style.line(), INK);
        body
    }
}
