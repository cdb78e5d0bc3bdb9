//! A picture of one or several sections: panels to scale, axes, legend or colour bar.

use super::axes::{Axes, Header, Style};
use super::canvas::{Align, Canvas, Frame, INK, Rgb};
use super::colour::{self, Scale};
use super::section::Section;
use super::ticks::{Ticks, nice_step};
use super::units::Readable;
use super::{PlotError, font};

/// Default width of a picture of one panel (pixels), at which [`Style::unit`] is 1.
pub const WIDTH: u32 = 1200;

/// Default width of a picture of several panels (pixels).
pub const PANELS_WIDTH: u32 = 1800;

/// What colours mean.
#[derive(Debug, Clone)]
pub enum Colours {
    /// Bodies, by their names.
    Bodies(Vec<String>),
    /// A field, by a colour bar.
    Bar {
        /// Range and map.
        scale: Scale,
        /// Unit of the bar.
        unit: Readable,
        /// What stands beside it, with unit.
        label: String,
    },
}

/// A part of the section's plane (m).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct View {
    /// Left and right.
    pub x: [f64; 2],
    /// Bottom and top.
    pub y: [f64; 2],
}

impl View {
    /// All discs of some sections with a small border.
    pub fn around(sections: &[Section], spacings: &[f64]) -> Self {
        let none = [f64::INFINITY, f64::NEG_INFINITY];
        let mut reach = [none; 2];
        for disc in sections.iter().flat_map(|s| &s.discs) {
            let radius = 0.5 * spacings[disc.body];
            for (span, at) in reach.iter_mut().zip(disc.at) {
                *span = [span[0].min(at - radius), span[1].max(at + radius)];
            }
        }
        let [mut x, mut y] = reach;
        let border = 0.03 * (x[1] - x[0]).max(y[1] - y[0]);
        for span in [&mut x, &mut y] {
            *span = [span[0] - border, span[1] + border];
        }
        Self { x, y }
    }

    fn width(&self) -> f64 {
        self.x[1] - self.x[0]
    }

    fn height(&self) -> f64 {
        self.y[1] - self.y[0]
    }

    /// The view widened about its middle until neither side is a thin strip.
    fn at_least(self, narrowest: f64, flattest: f64) -> Self {
        let grow = |span: [f64; 2], least: f64| {
            let more = 0.5 * (least - (span[1] - span[0])).max(0.0);
            [span[0] - more, span[1] + more]
        };
        Self {
            x: grow(self.x, narrowest * self.height()),
            y: grow(self.y, flattest * self.width()),
        }
    }
}

/// A picture of sections that share view and colours.
#[derive(Debug)]
pub struct Figure<'a> {
    /// Title of the case.
    pub title: String,
    /// What is shown, where and when.
    pub subtitle: String,
    /// One for each panel.
    pub sections: &'a [Section],
    /// Names above the panels; used if there are several.
    pub headings: Vec<String>,
    /// Names of the axes to the right and upwards.
    pub axes: [&'static str; 2],
    /// Diameter of the discs of each body (m).
    pub spacings: &'a [f64],
    /// What colours mean.
    pub colours: &'a Colours,
    /// What part of the plane is drawn.
    pub view: View,
    /// Width of the picture (pixels).
    pub width: u32,
}

/// Where everything goes.
struct Layout {
    style: Style,
    height: u32,
    columns: usize,
    view: View,
    unit: Readable,
    x_ticks: Ticks,
    y_ticks: Ticks,
    frames: Vec<Frame>,
    bar: Option<Bar>,
}

/// Where the colour bar goes.
struct Bar {
    left: f32,
    ticks: Ticks,
}

impl Figure<'_> {
    /// Draws the picture.
    ///
    /// # Errors
    /// [`PlotError::Size`] if no such picture can be held.
    pub fn draw(&self) -> Result<Canvas, PlotError> {
        let layout = self.layout();
        let mut canvas = Canvas::new(self.width, layout.height)?;
        let style = layout.style;
        self.header()
            .draw(Some(&mut canvas), style, self.width as f32);
        for (k, section) in self.sections.iter().enumerate() {
            self.draw_panel(&mut canvas, &layout, k, section);
        }
        if let (Some(bar), Colours::Bar { scale, unit, label }) = (&layout.bar, self.colours) {
            let (first, last) = (&layout.frames[0], &layout.frames[layout.frames.len() - 1]);
            let frame = Frame {
                left: bar.left,
                top: first.top,
                width: 24.0 * style.unit,
                height: last.bottom() - first.top,
            };
            draw_bar(&mut canvas, style, frame, scale, unit, &bar.ticks, label);
        }
        Ok(canvas)
    }

    fn header(&self) -> Header<'_> {
        let legend = match self.colours {
            Colours::Bodies(names) => {
                let colours = (0..).map(colour::body);
                names.iter().map(String::as_str).zip(colours).collect()
            }
            Colours::Bar { .. } => Vec::new(),
        };
        Header {
            title: &self.title,
            subtitle: &self.subtitle,
            legend,
        }
    }

    fn layout(&self) -> Layout {
        let several = self.sections.len() > 1;
        let nominal = if several { PANELS_WIDTH } else { WIDTH };
        let style = Style {
            unit: self.width as f32 / nominal as f32,
        };
        let view = self.view.at_least(0.45, 0.2);
        let reach = view.x.into_iter().chain(view.y).fold(0.0, |a: f64, b| a.max(b.abs()));
        let unit = Readable::new("m", reach);

        // Room for the frames, with a first guess of the numbers beside them.
        let top = self.header().draw(None, style, self.width as f32);
        let bar_width = match self.colours {
            Colours::Bodies(_) => 0.0,
            Colours::Bar { .. } => 150.0 * style.unit,
        };
        let guess = 100.0 * style.unit;
        let room = self.width as f32 - guess - bar_width - 2.0 * style.margin();
        let (columns, scale) = self.arrange(&view, style, room);
        let step = shared_step(&view, &unit, scale, style);
        let inverse = 1.0 / unit.size;
        let x_ticks = Ticks::new(view.x.map(|v| v * inverse), step);
        let y_ticks = Ticks::new(view.y.map(|v| v * inverse), step);

        let (width, height) = (pixels(view.width() * scale), pixels(view.height() * scale));
        let gap = 3.5 * style.gap();
        let heading = if several { 1.6 * style.text() } else { 0.0 };
        let rows = self.sections.len().div_ceil(columns);
        let beside = style.beside(&y_ticks);
        let used = beside + columns as f32 * (width + gap) - gap + bar_width;
        let left = beside + (0.5 * (self.width as f32 - used)).max(style.margin());
        let frames = (0..self.sections.len()).map(|k| Frame {
            left: (left + (k % columns) as f32 * (width + gap)).round(),
            top: (top + heading + (k / columns) as f32 * (height + heading + gap)).round(),
            width: width.round(),
            height: height.round(),
        });
        let frames: Vec<Frame> = frames.collect();
        let bottom = frames[frames.len() - 1].bottom();
        let bar = match self.colours {
            Colours::Bodies(_) => None,
            Colours::Bar { scale, unit, .. } => {
                let length = bottom - frames[0].top;
                let span = [scale.low / unit.size, scale.high / unit.size];
                let marks = f64::from(length / (64.0 * style.unit)).max(2.0);
                let ticks = Ticks::new(span, nice_step((span[1] - span[0]) / marks));
                let left = frames[columns.min(frames.len()) - 1].right() + 2.5 * style.gap();
                Some(Bar { left, ticks })
            }
        };
        debug_assert!(rows * columns >= self.sections.len());
        Layout {
            style,
            height: whole(bottom + style.below() + 0.5 * style.margin()),
            columns,
            view,
            unit,
            x_ticks,
            y_ticks,
            frames,
            bar,
        }
    }

    /// Columns of panels, and the scale (pixels per metre) that fits them into a width.
    fn arrange(&self, view: &View, style: Style, room: f32) -> (usize, f64) {
        let unit = f64::from(style.unit);
        let count = self.sections.len();
        let fit = |columns: usize| {
            let gaps = 28.0 * unit * (columns - 1) as f64;
            let width = (f64::from(room) - gaps) / columns as f64;
            let highest = if count > 1 { 900.0 } else { 1000.0 } * unit;
            (width / view.width()).min(highest / view.height())
        };
        // As many side by side as stay wide and high enough to be seen.
        let legible = |columns: &usize| {
            let scale = fit(*columns);
            view.width() * scale >= 300.0 * unit && view.height() * scale >= 200.0 * unit
        };
        let most = (1..=count).rev().find(legible).unwrap_or(1);
        let columns = count.div_ceil(count.div_ceil(most));
        (columns, fit(columns))
    }

    fn draw_panel(&self, canvas: &mut Canvas, layout: &Layout, k: usize, section: &Section) {
        let style = layout.style;
        let frame = layout.frames[k];
        let metres = Axes {
            frame,
            x: layout.view.x,
            y: layout.view.y,
        };
        let scale = f64::from(frame.width) / layout.view.width();
        for disc in &section.discs {
            let radius = pixels(0.5 * self.spacings[disc.body] * scale);
            let at = metres.at(disc.at[0], disc.at[1]);
            draw_particle(canvas, at, radius, self.colour(disc.body, disc.value), &frame);
        }
        let inverse = 1.0 / layout.unit.size;
        let axes = Axes {
            frame,
            x: metres.x.map(|v| v * inverse),
            y: metres.y.map(|v| v * inverse),
        };
        let names = self.axes.map(|name| layout.unit.label(name));
        let lowest = k + layout.columns >= self.sections.len();
        let first = k % layout.columns == 0;
        axes.draw_x(canvas, style, &layout.x_ticks, lowest.then_some(names[0].as_str()));
        axes.draw_y(canvas, style, &layout.y_ticks, first.then_some(names[1].as_str()));
        if self.sections.len() > 1 {
            let middle = frame.left + 0.5 * frame.width;
            let baseline = frame.top - 0.5 * style.text();
            canvas.text(&self.headings[k], (middle, baseline), style.text(), Align::Middle);
        }
    }

    fn colour(&self, body: usize, value: f64) -> Rgb {
        match self.colours {
            Colours::Bodies(_) => colour::body(body),
            Colours::Bar { scale, .. } => scale.colour(value),
        }
    }
}

/// One step for both axes, in the axes' unit, wide enough for the numbers of both.
fn shared_step(view: &View, unit: &Readable, scale: f64, style: Style) -> f64 {
    let pixels_per_unit = scale * unit.size;
    let mut step = nice_step(66.0 * f64::from(style.unit) / pixels_per_unit);
    // Numbers of many digits need more room.
    for _ in 0..8 {
        let ticks = Ticks::new(view.x.map(|v| v / unit.size), step);
        if f64::from(style.widest(&ticks)) * 1.4 <= step * pixels_per_unit {
            break;
        }
        step = nice_step(1.1 * step);
    }
    step
}

/// A disc; large ones get a darker rim, so that particles stay apart where they overlap.
fn draw_particle(canvas: &mut Canvas, at: (f32, f32), radius: f32, colour: Rgb, clip: &Frame) {
    let rim = (0.12 * radius).min(1.5);
    if rim < 0.35 {
        canvas.disc(at, radius, colour, clip);
    } else {
        canvas.disc(at, radius, colour.map(|c| c / 4 * 3), clip);
        canvas.disc(at, radius - rim, colour, clip);
    }
}

/// The colour bar with numbers and label; triangles where values lie beyond its ends.
fn draw_bar(
    canvas: &mut Canvas,
    style: Style,
    frame: Frame,
    scale: &Scale,
    unit: &Readable,
    ticks: &Ticks,
    label: &str,
) {
    let tip = 16.0 * style.unit;
    let top = frame.top + if scale.above { tip } else { 0.0 };
    let bottom = frame.bottom() - if scale.below { tip } else { 0.0 };
    let body = Frame {
        top,
        height: bottom - top,
        ..frame
    };
    let rows = whole(body.height);
    for row in 0..rows {
        let y = body.top + row as f32;
        let share = 1.0 - (f64::from(row) + 0.5) / f64::from(rows);
        let strip = Frame {
            top: y,
            height: (bottom - y).min(1.0),
            ..body
        };
        canvas.fill(&strip, scale.colour(scale.low + share * (scale.high - scale.low)));
    }
    let middle = frame.left + 0.5 * frame.width;
    let mut outline = vec![(body.left, bottom), (body.left, top)];
    if scale.above {
        let corners = [(body.left, top), (middle, frame.top), (body.right(), top)];
        canvas.polygon(&corners, scale.colour(scale.high));
        outline.push((middle, frame.top));
    }
    outline.extend([(body.right(), top), (body.right(), bottom)]);
    if scale.below {
        let corners = [(body.left, bottom), (middle, frame.bottom()), (body.right(), bottom)];
        canvas.polygon(&corners, scale.colour(scale.low));
        outline.push((middle, frame.bottom()));
    }
    outline.push((body.left, bottom));
    canvas.line(&outline, style.line(), INK);

    let axes = Axes {
        frame: body,
        x: [0.0, 1.0],
        y: [scale.low / unit.size, scale.high / unit.size],
    };
    let edge = body.right();
    let number_left = edge + style.tick() + 0.5 * style.gap();
    for (&value, number) in ticks.values.iter().zip(&ticks.labels) {
        let (_, y) = axes.at(0.0, value);
        canvas.line(&[(edge, y), (edge + style.tick(), y)], style.line(), INK);
        let at = (number_left, y + 0.36 * style.small());
        canvas.text(number, at, style.small(), Align::Start);
    }
    let x = number_left + style.widest(ticks) + 1.2 * style.gap() + 0.75 * style.text();
    let size = style.text() * (frame.height / font::width(label, style.text())).clamp(0.5, 1.0);
    let y = frame.top + 0.5 * frame.height;
    canvas.text_upwards(label, (x, y), size, Align::Middle);
}

#[expect(clippy::cast_possible_truncation, reason = "pixels need no more")]
fn pixels(length: f64) -> f32 {
    length as f32
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a float cast saturates; the canvas refuses what it cannot hold"
)]
fn whole(length: f32) -> u32 {
    length.ceil() as u32
}
