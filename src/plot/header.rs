//! The head of a picture: title, subtitle and legend.

use super::canvas::{Align, Canvas, Frame, INK, Rgb};
use super::font;
use super::style::Style;

/// The mark of an entry of the legend.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Mark {
    /// A line.
    #[default]
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
        match self.mark {
            Mark::Dots => canvas.disc(centre, disc, self.colour, &Frame::PAGE),
            Mark::Rings => {
                let rim = (2.0 * style.unit, INK);
                canvas.bead(centre, disc, self.colour, rim, &Frame::PAGE);
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

/// The current position in the header.
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
pub fn shorten(text: &str, size: f32, room: f32) -> String {
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
