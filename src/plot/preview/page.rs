//! The page: a section with axes above three views along the axes, or of a flat model one picture.

use super::extent::{self, Ends, best_plane, plane_of};
use super::image::Image;
use super::marks::{self, KEEP, SURFACE, SYMMETRY};
use super::panel::Panel;
use super::{sites, surfaces};
use crate::PlotError;
use crate::axes::Axes;
use crate::canvas::{Align, Canvas, Frame};
use crate::colour;
use crate::header::{Entry, Header, Mark};
use crate::length_bar;
use crate::picture::layout::pixels;
use crate::picture::view::View;
use crate::snapshots::plane::Plane;
use crate::snapshots::slice::position_text;
use crate::style::{Style, WIDTH, whole};
use crate::ticks::{Ticks, nice_step};
use crate::units::Readable;
use model::{Axis, Case};
use populate;

/// Greatest heights of the section and of the views (units of layout).
const SECTION: f32 = 620.0;
const VIEWS: f32 = 330.0;

/// Smaller steps in depth from pixel to pixel (pixels) are those of a surface that is seen sideways.
const STEEP: f64 = 15.0;

/// Everything that is drawn.
struct Page<'a> {
    case: &'a Case,
    style: Style,
    /// Around all particles (m).
    model: Ends,
    section: Panel,
    views: Vec<Panel>,
    /// Unit, step and marks of the section's axes.
    unit: Readable,
    ticks: [Ticks; 2],
    height: f32,
}

/// Draws the particles that a case begins with, with a section at `AXIS=POSITION` or at the best plane,
/// in a width in pixels.
///
/// # Errors
/// [`PlotError::Section`], [`PlotError::Quantity`] if the plane cannot be read, [`PlotError::Options`] if
/// there are no particles, [`PlotError::Size`] if no such picture can be held.
pub fn preview(
    case: &Case,
    section: Option<&str>,
    width: Option<u32>,
) -> Result<Canvas, PlotError> {
    let Some([model, visible]) = extent::extents(case) else {
        return Err(PlotError::Options("the case has no particles to draw"));
    };
    let plane = match section {
        Some(_) if case.dimension < 3 => {
            return Err(PlotError::Options(
                "a flat model is drawn as a whole: leave --section out",
            ));
        }
        Some(text) => plane_of(Plane::read(text)?, case, &model),
        None => best_plane(case, &model),
    };
    let width = width.unwrap_or(WIDTH);
    let style = Style::new(width, WIDTH);
    let count = |body| populate::count(body, case.dimension, &case.symmetry, None);
    let counts: Vec<u64> = case.bodies.iter().map(count).collect();
    let particles: u64 = counts.iter().sum();
    let subtitle = subtitle(case, plane, particles);
    let header = Header {
        title: &case.title,
        subtitle: &subtitle,
        legend: legend(case),
    };
    let top = header.draw(None, style, width as f32);
    let page = Page::new(case, style, [model, visible], plane, width as f32, top);
    let mut canvas = Canvas::new(width, whole(page.height))?;
    header.draw(Some(&mut canvas), style, width as f32);
    page.draw(&mut canvas, particles as f64)?;
    Ok(canvas)
}

/// The number of particles, and the position of the section.
fn subtitle(case: &Case, plane: Plane, particles: u64) -> String {
    let finest = case.bodies.iter().map(|body| body.lattice.spacing);
    let finest = finest.fold(f64::INFINITY, f64::min);
    let section = match case.dimension {
        3 => format!(
            ",  section {}",
            position_text(plane.axis.name(), plane.position, finest)
        ),
        _ => String::new(),
    };
    format!("{particles} particles as they begin{section}")
}

fn legend(case: &Case) -> Vec<Entry> {
    let body = |(index, body): (usize, &'_ model::Body)| Entry {
        name: body.name.clone(),
        colour: colour::body(index),
        mark: Mark::Dots,
    };
    let mut legend: Vec<Entry> = case.bodies.iter().enumerate().map(body).collect();
    let lines = [
        (!case.symmetry.is_empty(), "symmetry plane", SYMMETRY),
        (!case.loads.surfaces.is_empty(), "rigid surface", SURFACE),
        (case.domain.keep.is_some(), "box of interest", KEEP),
    ];
    let lines = lines.into_iter().filter(|(is, ..)| *is);
    legend.extend(lines.map(|(_, name, colour)| Entry {
        name: name.to_owned(),
        colour,
        mark: Mark::Line,
    }));
    legend
}

impl<'a> Page<'a> {
    fn new(
        case: &'a Case,
        style: Style,
        [model, visible]: [Ends; 2],
        plane: Plane,
        width: f32,
        top: f32,
    ) -> Self {
        let view = Panel::view_of(plane.axis, &visible);
        let unit = Readable::axes(view.reach());
        // The numbers beside the section are known once the scale is.
        let room = width - 130.0 * style.unit - 2.0 * style.margin();
        let fit = |width: f32, height: f32, size: [f64; 2]| {
            (f64::from(width) / size[0]).min(f64::from(height) / size[1])
        };
        let size = [view.width(), view.height()];
        let scale = fit(room, SECTION * style.unit, size);
        let step = nice_step(66.0 * f64::from(style.unit) / (scale * unit.size));
        let ticks = view.in_unit(&unit).map(|span| Ticks::new(span, step));
        let beside = style.margin() + style.beside(&ticks[1]);
        let at = |left: f32, top: f32, size: [f64; 2], scale: f64| Frame {
            left: left.round(),
            top: top.round(),
            width: pixels(size[0] * scale).round().max(2.0),
            height: pixels(size[1] * scale).round().max(2.0),
        };
        let free = (width - beside - style.margin() - pixels(size[0] * scale)).max(0.0);
        let section = Panel {
            plane,
            view,
            frame: at(beside + 0.5 * free, top, size, scale),
        };
        let mut page = Self {
            case,
            style,
            model,
            section,
            views: Vec::new(),
            unit,
            ticks,
            height: section.frame.bottom() + style.below() + 0.5 * style.margin(),
        };
        if case.dimension == 3 {
            page.lay_views(&visible, width);
        }
        page
    }

    /// Three views of one scale side by side below the section.
    fn lay_views(&mut self, visible: &Ends, width: f32) {
        let style = self.style;
        let axes = [Axis::Y, Axis::X, Axis::Z];
        let views = axes.map(|axis| Panel::view_of(axis, visible));
        let across: f64 = views.iter().map(View::width).sum();
        let highest = views.iter().map(View::height).fold(0.0, f64::max);
        let room = width - 2.0 * style.margin() - 2.0 * style.between();
        let scale = (f64::from(room) / across).min(f64::from(VIEWS * style.unit) / highest);
        let used = pixels(across * scale) + 2.0 * style.between();
        let mut left = 0.5 * (width - used);
        let top = self.height + 1.6 * style.text();
        let bottom = top + pixels(highest * scale);
        for (axis, view) in axes.into_iter().zip(views) {
            let size = [view.width(), view.height()].map(|length| pixels(length * scale));
            let frame = Frame {
                left: left.round(),
                top: (bottom - size[1]).round(),
                width: size[0].round().max(2.0),
                height: size[1].round().max(2.0),
            };
            let plane = Plane {
                axis,
                position: 0.0,
            };
            self.views.push(Panel { plane, view, frame });
            left += size[0] + style.between();
        }
        self.height = bottom + 2.0 * style.text() + style.margin();
    }

    fn draw(&self, canvas: &mut Canvas, particles: f64) -> Result<(), PlotError> {
        let case = self.case;
        let velocities = marks::velocities(case);
        let section = sites::section(case, &self.section, particles);
        let mut images = Vec::new();
        if case.dimension == 3 {
            self.require_some(&section)?;
            images = sites::views(case, &self.views, particles);
        }
        let line = 2.5 * self.style.unit;
        let cuts = case.loads.surfaces.iter();
        let cuts = cuts.flat_map(|surface| surfaces::cut(surface, &self.section, line));
        let cuts: Vec<_> = cuts.collect();
        let mut bodies: Vec<usize> = section.bodies().collect();
        bodies.sort_unstable();
        bodies.dedup();
        let moving = velocities.iter().filter(|(body, ..)| bodies.contains(body));
        let moving: Vec<_> = moving.copied().collect();
        self.draw_panel(canvas, &self.section, &section, &cuts);
        marks::arrows(canvas, self.style, &self.section, &moving, true);
        self.draw_axes(canvas);
        for (panel, image) in self.views.iter().zip(&images) {
            let seen = case.loads.surfaces.iter();
            let seen = seen.flat_map(|surface| surfaces::seen(surface, panel, &self.model));
            self.draw_panel(canvas, panel, image, &seen.collect::<Vec<_>>());
            marks::arrows(canvas, self.style, panel, &velocities, false);
            self.name_view(canvas, panel);
        }
        Ok(())
    }

    /// Refuses a section without particles.
    fn require_some(&self, section: &Image) -> Result<(), PlotError> {
        if section.bodies().next().is_some() {
            return Ok(());
        }
        let axis = self.section.plane.axis;
        let length = |x: f64| self.case.length_unit.text(x);
        Err(PlotError::Empty {
            axis: axis.name(),
            position: length(self.section.plane.position),
            lowest: length(self.model.0[axis.index()]),
            highest: length(self.model.1[axis.index()]),
        })
    }

    /// Particles, surfaces and planes of a panel.
    fn draw_panel(
        &self,
        canvas: &mut Canvas,
        panel: &Panel,
        image: &Image,
        dots: &[(usize, usize)],
    ) {
        let spacings = self.case.bodies.iter().map(|body| body.lattice.coarsest());
        let coarsest = spacings.fold(0.0, f64::max);
        // Smooth surfaces have no lines, however steep they are seen.
        let step = (2.5 * coarsest).max(STEEP / panel.scale());
        let mut colours = image.colours(step);
        for &(column, row) in dots {
            colours[row * image.columns() + column] = SURFACE;
        }
        canvas.image(&panel.frame, &colours);
        marks::symmetry(canvas, self.style, panel, &self.case.symmetry);
        marks::keep(canvas, self.style, panel, self.case.domain.keep.as_ref());
    }

    /// The section's axes.
    fn draw_axes(&self, canvas: &mut Canvas) {
        let [x, y] = self.section.view.in_unit(&self.unit);
        let axes = Axes {
            frame: self.section.frame,
            x,
            y,
        };
        let [right, up] = self.section.plane.picture_axes().map(Axis::name);
        let [right, up] = [right, up].map(|name| self.unit.label(name));
        axes.draw_x(canvas, self.style, &self.ticks[0], Some(&right));
        // In one dimension there is nothing upwards.
        let up = (self.case.dimension > 1).then_some(up.as_str());
        axes.draw_y(canvas, self.style, &self.ticks[1], up);
    }

    /// From where a view is, its border, and below the first one its scale.
    fn name_view(&self, canvas: &mut Canvas, panel: &Panel) {
        let (style, frame) = (self.style, panel.frame);
        canvas.border(&frame, style.line(), crate::canvas::INK);
        let side = if panel.towards() > 0.0 { "+" } else { "−" };
        let name = format!("from {side}{}", panel.plane.axis.name());
        let middle = frame.left + 0.5 * frame.width;
        canvas.text(
            &name,
            (middle, frame.top - 0.5 * style.text()),
            style.text(),
            Align::Middle,
        );
        if panel.plane.axis == Axis::Y {
            let at = (frame.left, frame.bottom() + 1.3 * style.text());
            length_bar::draw(canvas, style, at, (panel.scale(), 0.5 * frame.width));
        }
    }
}
