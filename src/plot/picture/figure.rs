//! A picture of one or several sections: panels to scale, axes, legend or colour bar.

use super::cells::Sample;
use super::layout::{Layout, pixels};
use super::raster::Raster;
use super::section::{self, DrawnAs, Section};
use super::sheet::{Colours, Sheet, draw_axes};
use super::view::View;
use crate::PlotError;
use crate::axes::Axes;
use crate::canvas::{Canvas, Frame, Rgb};
use crate::colour;
use crate::style::whole;

/// A picture of sections that share view and colours.
#[derive(Debug)]
pub struct Figure<'a> {
    /// Title of the case.
    pub title: &'a str,
    /// The quantity, the section and the time.
    pub subtitle: &'a str,
    /// One for each panel.
    pub sections: &'a [Section],
    /// Numbers of the bodies that the legend lists; if absent those that are seen.
    pub seen: Option<&'a [usize]>,
    /// Names above the panels; used if there are several.
    pub headings: &'a [String],
    /// Names of the axes to the right and upwards.
    pub axes: [&'static str; 2],
    /// The way particles are drawn.
    pub drawn_as: DrawnAs,
    /// The meaning of colours.
    pub colours: &'a Colours,
    /// The part of the plane that is drawn.
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
        let (sheet, layout) = (self.sheet(), self.layout());
        // Too large a picture is refused before it is drawn.
        Canvas::fits(self.width, whole(layout.height))?;
        let rasters = self.rasters(&layout);
        let seen = self.seen(&layout, &rasters);
        sheet.draw(layout, &seen, |canvas, layout, k| {
            match rasters.get(k) {
                Some(raster) => canvas.image(&layout.frames[k], &raster.pixels),
                None => self.draw_particles(canvas, layout, k, &self.sections[k]),
            }
            draw_axes(canvas, layout, k, self.axes);
        })
    }

    /// The layout of its parts, from the top of the picture.
    pub fn layout(&self) -> Layout {
        let (sheet, count) = (self.sheet(), self.sections.len());
        let (style, has_bar) = (sheet.style(count), sheet.has_bar());
        Layout::new(style, self.width, count, self.view, has_bar)
    }

    /// The surroundings of its panels.
    fn sheet(&self) -> Sheet<'_> {
        Sheet {
            title: self.title,
            subtitle: self.subtitle,
            headings: self.headings,
            colours: self.colours,
            width: self.width,
        }
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
        if let Some(seen) = self.seen {
            return seen.to_vec();
        }
        let mut seen: Vec<usize> = match self.drawn_as {
            DrawnAs::Cut => rasters.iter().flat_map(|r| &r.seen).copied().collect(),
            DrawnAs::Particles => section::bodies(self.sections, &layout.view),
        };
        seen.sort_unstable();
        seen.dedup();
        seen
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
            let radius = pixels(cell.radii()[0] * scale);
            let at = metres.at(cell.at[0], cell.at[1]);
            let sample = Sample {
                body: cell.body,
                value: cell.value,
            };
            draw_particle(canvas, at, radius, self.colour(&sample), &frame);
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
