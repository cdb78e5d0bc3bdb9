//! A frame with marks and labels, and the line of text sizes that all pictures share.

use super::canvas::{Align, Canvas, Frame, INK, Rgb};
use super::font;
use super::ticks::Ticks;

/// Colour of grid lines.
const GRID: Rgb = [226, 226, 226];

/// Lengths of a picture in pixels, all in proportion to its width.
#[derive(Debug, Clone, Copy)]
pub struct Style {
    /// Pixels of one unit of layout; 1 at the default width.
    pub unit: f32,
}

impl Style {
    /// Lengths for a picture of a width that looks as designed at the nominal one; text in small
    /// pictures stays large enough to be read.
    pub fn new(width: u32, nominal: u32) -> Self {
        Self {
            unit: (width as f32 / nominal as f32).max(0.6),
        }
    }

    pub fn title(self) -> f32 {
        26.0 * self.unit
    }

    pub fn text(self) -> f32 {
        20.0 * self.unit
    }

    pub fn small(self) -> f32 {
        18.0 * self.unit
    }

    /// Length of a mark.
    pub fn tick(self) -> f32 {
        7.0 * self.unit
    }

    /// Space between things that belong together.
    pub fn gap(self) -> f32 {
        8.0 * self.unit
    }

    /// Space between panels: half a number on either side, and some.
    pub fn between(self) -> f32 {
        40.0 * self.unit
    }

    /// Blank border of the picture.
    pub fn margin(self) -> f32 {
        22.0 * self.unit
    }

    /// Width of axis lines.
    pub fn line(self) -> f32 {
        (1.5 * self.unit).max(1.0)
    }

    /// Height of what hangs below a frame: marks, numbers, label.
    pub fn below(self) -> f32 {
        self.tick() + self.small() + self.text() + 3.0 * self.gap()
    }

    /// Width of what stands left of a frame with these numbers: label, numbers, marks.
    pub fn beside(self, ticks: &Ticks) -> f32 {
        self.tick() + self.widest(ticks) + self.text() + 3.0 * self.gap()
    }

    /// Width of the widest number of an axis.
    pub fn widest(self, ticks: &Ticks) -> f32 {
        let widths = ticks.labels.iter().map(|l| font::width(l, self.small()));
        widths.fold(0.0, f32::max)
    }
}

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

/// Where a number lies in a span, 0 to 1.
#[expect(clippy::cast_possible_truncation, reason = "a pixel needs no more")]
fn share(value: f64, span: [f64; 2]) -> f32 {
    ((value - span[0]) / (span[1] - span[0])) as f32
}

/// How a thing of the legend looks in the picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mark {
    /// A line.
    Line,
    /// A thin line, for what is exact.
    Thin,
    /// A disc for each point.
    Dots,
    /// A disc with a dark rim for each point, for what was measured.
    Rings,
}

/// A line of the legend.
#[derive(Debug, Clone, PartialEq)]
pub struct Entry {
    pub name: String,
    pub colour: Rgb,
    pub mark: Mark,
}

/// Title, subtitle and legend at the head of a picture.
pub struct Header<'a> {
    pub title: &'a str,
    pub subtitle: &'a str,
    pub legend: Vec<Entry>,
}

impl Header<'_> {
    /// Draws the header, or only measures it without a canvas; returns its height (pixels).
    pub fn draw(&self, canvas: Option<&mut Canvas>, style: Style, width: f32) -> f32 {
        let room = width - 2.0 * style.margin();
        let mut pen = Pen {
            canvas,
            y: style.margin(),
        };
        pen.row(self.title, style.title(), style, room);
        pen.row(self.subtitle, style.text(), style, room);
        if !self.legend.is_empty() {
            self.draw_legend(&mut pen, style, room);
        }
        pen.y + style.gap()
    }

    /// Names with a mark of their colour, in as many rows as they need.
    fn draw_legend(&self, pen: &mut Pen, style: Style, room: f32) {
        let disc = 0.4 * style.text();
        let mut x = 0.0;
        pen.y += 1.4 * style.text();
        for entry in &self.legend {
            let lead = 2.0 * disc + style.gap() + entry.mark.excess(style);
            let name = shorten(&entry.name, style.text(), room - lead);
            let width = lead + font::width(&name, style.text());
            if x > 0.0 && x + width > room {
                x = 0.0;
                pen.y += 1.5 * style.text();
            }
            if let Some(canvas) = pen.canvas.as_deref_mut() {
                let left = style.margin() + x;
                let centre = (left + disc, pen.y - 0.36 * style.text());
                entry.draw_mark(canvas, style, centre, disc);
                canvas.text(&name, (left + lead, pen.y), style.text(), Align::Start);
            }
            x += width + 3.0 * style.gap();
        }
        pen.y += style.gap();
    }
}

impl Mark {
    /// By how much its sign in the legend is longer than a disc.
    fn excess(self, style: Style) -> f32 {
        match self {
            Self::Dots | Self::Rings => 0.0,
            Self::Line | Self::Thin => 16.0 * style.unit,
        }
    }
}

impl Entry {
    /// The sign before the name; `centre` is that of a disc of radius `disc` in its place.
    fn draw_mark(&self, canvas: &mut Canvas, style: Style, centre: (f32, f32), disc: f32) {
        let page = Frame {
            left: 0.0,
            top: 0.0,
            width: f32::MAX,
            height: f32::MAX,
        };
        match self.mark {
            Mark::Dots => canvas.disc(centre, disc, self.colour, &page),
            Mark::Rings => {
                canvas.disc(centre, disc, INK, &page);
                canvas.disc(centre, disc - 2.0 * style.unit, self.colour, &page);
            }
            Mark::Line | Mark::Thin => {
                let (x, y) = (centre.0 - disc, centre.1);
                let end = x + 2.0 * disc + self.mark.excess(style);
                let width = if self.mark == Mark::Thin { 1.7 } else { 4.0 };
                canvas.line(&[(x, y), (end, y)], width * style.unit, self.colour);
            }
        }
    }
}

/// Where the header has got to.
struct Pen<'a> {
    canvas: Option<&'a mut Canvas>,
    y: f32,
}

impl Pen<'_> {
    /// One line of text, made smaller or cut off if it is too long; nothing if it is empty.
    fn row(&mut self, text: &str, size: f32, style: Style, room: f32) {
        if text.is_empty() {
            return;
        }
        let size = size * (room / font::width(text, size)).clamp(0.8, 1.0);
        let text = shorten(text, size, room);
        self.y += size;
        if let Some(canvas) = self.canvas.as_deref_mut() {
            canvas.text(&text, (style.margin(), self.y), size, Align::Start);
        }
        self.y += 0.5 * size;
    }
}

/// A text cut off so that it fits a width.
fn shorten(text: &str, size: f32, room: f32) -> String {
    if font::width(text, size) <= room {
        return text.to_owned();
    }
    let mut short = text.to_owned();
    while short.pop().is_some() {
        let candidate = format!("{}…", short.trim_end());
        if font::width(&candidate, size) <= room {
            return candidate;
        }
    }
    String::new()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_titles_end_in_dots() {
        let short = shorten("Aluminium sphere on a plate", 20.0, 150.0);
        assert!(short.ends_with('…') && short.starts_with("Alu"));
        assert!(font::width(&short, 20.0) <= 150.0);
        assert_eq!(shorten("plate", 20.0, 150.0), "plate");
    }
}
