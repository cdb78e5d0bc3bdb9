//! A sheet of panels to scale: head, headings, a colour bar beside them.

use super::bar::ColourBar;
use super::layout::Layout;
use crate::PlotError;
use crate::axes::Axes;
use crate::canvas::{Align, Canvas};
use crate::colour;
use crate::header::{Entry, Header, Mark};
use crate::style::{Style, whole};

/// The meaning of colours.
#[derive(Debug, Clone)]
pub enum Colours {
    /// Bodies, by their names.
    Bodies(Vec<String>),
    /// A field.
    Bar(ColourBar),
}

/// The surroundings of the panels of a picture.
#[derive(Debug)]
pub struct Sheet<'a> {
    /// Title of the case.
    pub title: &'a str,
    /// The quantity, the section and the time.
    pub subtitle: &'a str,
    /// Names above the panels; used if there are several.
    pub headings: &'a [String],
    /// The meaning of colours.
    pub colours: &'a Colours,
    /// Width of the picture (pixels).
    pub width: u32,
}

impl Sheet<'_> {
    /// Lengths of a picture of some panels.
    pub fn style(&self, panels: usize) -> Style {
        Style::of(self.width, panels)
    }

    /// `true` if there is a colour bar.
    pub fn has_bar(&self) -> bool {
        matches!(self.colours, Colours::Bar(_))
    }

    /// Draws the picture: head, panels by `panel`, which is given a panel's number, and the bar.
    /// The layout is that from the top of the picture; `seen` are the numbers of the bodies in it.
    ///
    /// # Errors
    /// [`PlotError::Size`] if no such picture can be held.
    pub fn draw(
        &self,
        layout: Layout,
        seen: &[usize],
        mut panel: impl FnMut(&mut Canvas, &Layout, usize),
    ) -> Result<Canvas, PlotError> {
        let (style, count) = (layout.style, layout.frames.len());
        let header = Header {
            title: self.title,
            subtitle: self.subtitle,
            legend: self.legend(seen),
        };
        let layout = layout.below(header.draw(None, style, self.width as f32));
        let mut canvas = Canvas::new(self.width, whole(layout.height))?;
        header.draw(Some(&mut canvas), style, self.width as f32);
        for k in 0..count {
            panel(&mut canvas, &layout, k);
            if let Some(heading) = self.headings.get(k) {
                let frame = layout.frames[k];
                let middle = frame.left + 0.5 * frame.width;
                let at = (middle, frame.top - 0.5 * style.text());
                canvas.text(heading, at, style.text(), Align::Middle);
            }
        }
        if let Colours::Bar(bar) = self.colours {
            let (last_of_row, last) = (layout.frames[layout.columns - 1], layout.frames[count - 1]);
            let left = last_of_row.right() + 2.5 * style.gap();
            bar.draw(&mut canvas, style, left, last_of_row.top, last.bottom());
        }
        Ok(canvas)
    }

    fn legend(&self, seen: &[usize]) -> Vec<Entry> {
        match self.colours {
            Colours::Bodies(names) => {
                let entry = |&body: &usize| Entry {
                    name: names[body].clone(),
                    colour: colour::body(body),
                    mark: Mark::Dots,
                };
                seen.iter().map(entry).collect()
            }
            Colours::Bar(_) => Vec::new(),
        }
    }
}

/// Axes of a panel, which lie to the right and upwards: numbers and labels only where no other
/// panel follows.
pub fn draw_axes(canvas: &mut Canvas, layout: &Layout, k: usize, names: [&str; 2]) {
    let (style, view, frame) = (layout.style, &layout.view, layout.frames[k]);
    let [x, y] = view.in_unit(&layout.unit);
    let axes = Axes { frame, x, y };
    let [right, up] = names.map(|name| layout.unit.label(name));
    let lowest = k + layout.columns >= layout.frames.len();
    let first = k.is_multiple_of(layout.columns);
    axes.draw_x(
        canvas,
        style,
        &layout.x_ticks,
        lowest.then_some(right.as_str()),
    );
    axes.draw_y(canvas, style, &layout.y_ticks, first.then_some(up.as_str()));
}
