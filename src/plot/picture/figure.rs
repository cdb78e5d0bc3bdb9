//! A picture of one or several sections: panels to scale, axes, legend or colour bar.

use super::bar::ColourBar;
use super::cells::Sample;
use super::layout::{Layout, pixels};
use super::raster::Raster;
use super::section::{DrawnAs, Section};
use super::view::View;
use crate::plot::PlotError;
use crate::plot::axes::Axes;
use crate::plot::canvas::{Align, Canvas, Frame, Rgb};
use crate::plot::colour;
use crate::plot::header::{Entry, Header, Mark};
use crate::plot::style::{PANELS_WIDTH, Style, WIDTH, whole};

/// What colours mean.
#[derive(Debug, Clone)]
pub enum Colours {
    /// Bodies, by their names.
    Bodies(Vec<String>),
    /// A field.
    Bar(ColourBar),
}

/// A picture of sections that share view and colours.
#[derive(Debug)]
pub struct Figure<'a> {
    /// Title of the case.
    pub title: &'a str,
    /// What is shown, where and when.
    pub subtitle: String,
    /// One for each panel.
    pub sections: &'a [Section],
    /// Names above the panels; used if there are several.
    pub headings: Vec<String>,
    /// Names of the axes to the right and upwards.
    pub axes: [&'static str; 2],
    /// How particles are drawn.
    pub drawn_as: DrawnAs,
    /// What colours mean.
    pub colours: &'a Colours,
    /// What part of the plane is drawn.
    pub view: View,
    /// Width of the picture (pixels).
    pub width: u32,
}

impl Figure<'_> {
    /// Draws the picture.
    ///
    /// # Errors
    /// [`PlotError::Size`] if no such picture can be held.
    pub fn draw(&self) -> Result<Canvas, PlotError> {
        let count = self.sections.len();
        let layout = self.layout();
        let style = layout.style;
        // What is too large is refused before it is drawn.
        Canvas::fits(self.width, whole(layout.height))?;
        let rasters = self.rasters(&layout);
        let header = self.header(&self.seen(&layout, &rasters));
        let layout = layout.below(header.draw(None, style, self.width as f32));

        let mut canvas = Canvas::new(self.width, whole(layout.height))?;
        header.draw(Some(&mut canvas), style, self.width as f32);
        for (k, section) in self.sections.iter().enumerate() {
            match rasters.get(k) {
                Some(raster) => canvas.image(&layout.frames[k], &raster.pixels),
                None => self.draw_particles(&mut canvas, &layout, k, section),
            }
            self.draw_axes(&mut canvas, &layout, k);
        }
        if let Colours::Bar(bar) = self.colours {
            let (last_of_row, last) = (layout.frames[layout.columns - 1], layout.frames[count - 1]);
            let left = last_of_row.right() + 2.5 * style.gap();
            bar.draw(&mut canvas, style, left, last_of_row.top, last.bottom());
        }
        Ok(canvas)
    }

    /// Where its parts go, from the top of the picture.
    pub fn layout(&self) -> Layout {
        let count = self.sections.len();
        let style = Style::new(self.width, if count > 1 { PANELS_WIDTH } else { WIDTH });
        let has_bar = matches!(self.colours, Colours::Bar(_));
        Layout::new(style, self.width, count, self.view, has_bar)
    }

    /// The panels of cuts; none of particles.
    fn rasters(&self, layout: &Layout) -> Vec<Raster> {
        let panels = self.sections.iter().zip(&layout.frames);
        let raster = |(section, frame): (&Section, &Frame)| {
            let line = 0.8 * layout.style.unit;
            Raster::new(&section.cells, layout.view, frame, line, |sample| {
                self.colour(sample)
            })
        };
        match self.drawn_as {
            DrawnAs::Cut => panels.map(raster).collect(),
            DrawnAs::Particles => Vec::new(),
        }
    }

    /// Numbers of the bodies that are in the picture.
    fn seen(&self, layout: &Layout, rasters: &[Raster]) -> Vec<usize> {
        let mut seen: Vec<usize> = match self.drawn_as {
            DrawnAs::Cut => rasters.iter().flat_map(|r| &r.seen).copied().collect(),
            DrawnAs::Particles => {
                let cells = self.sections.iter().flat_map(|s| &s.cells);
                let shown = cells.filter(|c| layout.view.shows(c.at, 0.5 * c.size));
                shown.map(|cell| cell.body).collect()
            }
        };
        seen.sort_unstable();
        seen.dedup();
        seen
    }

    fn header(&self, seen: &[usize]) -> Header<'_> {
        let legend = match self.colours {
            Colours::Bodies(names) => {
                let entry = |&body: &usize| Entry {
                    name: names[body].clone(),
                    colour: colour::body(body),
                    mark: Mark::Dots,
                };
                seen.iter().map(entry).collect()
            }
            Colours::Bar(_) => Vec::new(),
        };
        Header {
            title: self.title,
            subtitle: &self.subtitle,
            legend,
        }
    }

    fn draw_particles(&self, canvas: &mut Canvas, layout: &Layout, k: usize, section: &Section) {
        let (view, frame) = (&layout.view, layout.frames[k]);
        let metres = Axes {
            frame,
            x: view.x,
            y: view.y,
        };
        let scale = f64::from(frame.width) / view.width();
        for cell in &section.cells {
            let radius = pixels(0.5 * cell.size * scale);
            let at = metres.at(cell.at[0], cell.at[1]);
            let sample = Sample {
                body: cell.body,
                value: cell.value,
            };
            draw_particle(canvas, at, radius, self.colour(&sample), &frame);
        }
    }

    fn draw_axes(&self, canvas: &mut Canvas, layout: &Layout, k: usize) {
        let (style, view, frame) = (layout.style, &layout.view, layout.frames[k]);
        let [x, y] = view.in_unit(&layout.unit);
        let axes = Axes { frame, x, y };
        let [right, up] = self.axes.map(|name| layout.unit.label(name));
        // Numbers and labels only where no other panel follows.
        let lowest = k + layout.columns >= self.sections.len();
        let first = k.is_multiple_of(layout.columns);
        axes.draw_x(
            canvas,
            style,
            &layout.x_ticks,
            lowest.then_some(right.as_str()),
        );
        axes.draw_y(canvas, style, &layout.y_ticks, first.then_some(up.as_str()));
        if let Some(heading) = self.headings.get(k) {
            let middle = frame.left + 0.5 * frame.width;
            let at = (middle, frame.top - 0.5 * style.text());
            canvas.text(heading, at, style.text(), Align::Middle);
        }
    }

    fn colour(&self, sample: &Sample) -> Rgb {
        match self.colours {
            Colours::Bodies(_) => colour::body(sample.body),
            Colours::Bar(bar) => sample.value.map_or(colour::RIGID, |v| bar.scale.colour(v)),
        }
    }
}

/// A disc; large ones get a darker rim, so that particles stay apart where they overlap.
fn draw_particle(canvas: &mut Canvas, at: (f32, f32), radius: f32, colour: Rgb, clip: &Frame) {
    let rim = (0.12 * radius).min(1.5);
    if rim < 0.35 {
        canvas.disc(at, radius, colour, clip);
    } else {
        let rim = (rim, colour.map(|c| c / 4 * 3));
        canvas.bead(at, radius, colour, rim, clip);
    }
}
