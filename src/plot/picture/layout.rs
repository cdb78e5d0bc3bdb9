//! The layout of a section's picture.

use super::bar::ColourBar;
use super::view::View;
use crate::canvas::Frame;
use crate::style::Style;
use crate::ticks::{Ticks, nice_step};
use crate::units::Readable;

/// The layout of a picture (pixels).
#[derive(Debug)]
pub struct Layout {
    pub style: Style,
    /// Height of the picture.
    pub height: f32,
    /// Panels in a row.
    pub columns: usize,
    /// The part of the plane in each panel: at least the requested one.
    pub view: View,
    /// Unit of both axes.
    pub unit: Readable,
    pub x_ticks: Ticks,
    pub y_ticks: Ticks,
    /// One for each panel, row by row.
    pub frames: Vec<Frame>,
}

impl Layout {
    /// Lays out `count` panels with axes, of equal scale, in a width, from the top of the picture.
    pub fn new(style: Style, width: u32, count: usize, view: View, has_bar: bool) -> Self {
        Self::arranged(style, width, count, view, has_bar, true)
    }

    /// The same without axes.
    pub fn bare(style: Style, width: u32, count: usize, view: View, has_bar: bool) -> Self {
        Self::arranged(style, width, count, view, has_bar, false)
    }

    fn arranged(
        style: Style,
        width: u32,
        count: usize,
        view: View,
        has_bar: bool,
        has_axes: bool,
    ) -> Self {
        let view = view.drawn();
        let unit = Readable::axes(view.reach());
        let bar = if has_bar { ColourBar::room(style) } else { 0.0 };
        // The numbers beside the panels are known once the scale is.
        let guess = if has_axes { 100.0 * style.unit } else { 0.0 };
        let room = width as f32 - guess - bar - 2.0 * style.margin();
        let (columns, scale) = arrange(count, &view, style, room);
        let step = shared_step(&view, &unit, scale, style);
        let [x_ticks, y_ticks] = view.in_unit(&unit).map(|span| Ticks::new(span, step));

        let panel = [view.width(), view.height()].map(|length| pixels(length * scale).round());
        let heading = if count > 1 { 1.6 * style.text() } else { 0.0 };
        let pitch = [
            panel[0] + style.between(),
            panel[1] + style.between() + heading,
        ];
        let [beside, beneath] = if has_axes {
            [style.beside(&y_ticks), style.below()]
        } else {
            [0.0, style.beneath()]
        };
        let used = beside + columns as f32 * pitch[0] - style.between() + bar;
        let left = beside + (0.5 * (width as f32 - used)).max(style.margin());
        let frame = |k: usize| Frame {
            left: (left + (k % columns) as f32 * pitch[0]).round(),
            top: (heading + (k / columns) as f32 * pitch[1]).round(),
            width: panel[0],
            height: panel[1],
        };
        let frames: Vec<Frame> = (0..count).map(frame).collect();
        let bottom = frames.last().map_or(0.0, Frame::bottom);
        Self {
            style,
            height: bottom + beneath + 0.5 * style.margin(),
            columns,
            view,
            unit,
            x_ticks,
            y_ticks,
            frames,
        }
    }

    /// The same below a header of a height.
    pub fn below(mut self, top: f32) -> Self {
        let top = top.round();
        for frame in &mut self.frames {
            frame.top += top;
        }
        self.height += top;
        self
    }
}

/// Columns of panels, and the scale (pixels per metre) that fits them into a width.
fn arrange(count: usize, view: &View, style: Style, room: f32) -> (usize, f64) {
    let unit = f64::from(style.unit);
    let fit = |columns: usize| {
        let gaps = f64::from(style.between()) * (columns - 1) as f64;
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

/// One step for both axes, in the axes' unit, wide enough for the numbers of both.
fn shared_step(view: &View, unit: &Readable, scale: f64, style: Style) -> f64 {
    let pixels_per_unit = scale * unit.size;
    let mut step = nice_step(66.0 * f64::from(style.unit) / pixels_per_unit);
    // Numbers of many digits need more room.
    for _ in 0..8 {
        let ticks = Ticks::new(view.in_unit(unit)[0], step);
        if f64::from(style.widest(&ticks)) * 1.4 <= step * pixels_per_unit {
            break;
        }
        step = nice_step(1.1 * step);
    }
    step
}

/// A length in pixels as the canvas takes it.
#[expect(clippy::cast_possible_truncation, reason = "pixels need no more")]
pub fn pixels(length: f64) -> f32 {
    length as f32
}

#[cfg(test)]
mod tests {
    use super::*;

    fn layout(count: usize, width: f64, height: f64, pixels: u32) -> Layout {
        let view = View {
            x: [-0.5 * width, 0.5 * width],
            y: [0.0, height],
        };
        let style = Style::new(pixels, if count > 1 { 1800 } else { 1200 });
        Layout::new(style, pixels, count, view, true)
    }

    #[test]
    fn both_axes_have_one_scale_and_all_fits() {
        for (width, height) in [(3e-3, 2e-3), (1.0, 0.0), (6e-3, 65e-3), (0.6, 0.3)] {
            for (count, pixels) in [(1, 400), (1, 1200), (3, 1800), (7, 1800), (20, 900)] {
                let layout = layout(count, width, height, pixels);
                let frame = layout.frames[0];
                let aspect = f64::from(frame.width / frame.height);
                let wanted = layout.view.width() / layout.view.height();
                // Frames are whole pixels.
                let bound = 1.0 / f64::from(frame.height.min(frame.width));
                assert!((aspect / wanted - 1.0).abs() < bound, "{width} × {height}");
                let right = layout.frames.iter().map(Frame::right).fold(0.0, f32::max);
                let end = right + ColourBar::room(layout.style);
                assert!(end <= pixels as f32, "{count}: {end} of {pixels}");
                assert_eq!(layout.frames.len(), count);
            }
        }
    }

    #[test]
    fn three_panels_stand_side_by_side() {
        assert_eq!(layout(3, 3e-3, 2e-3, 1800).columns, 3);
        assert_eq!(layout(3, 10e-3, 2e-3, 1800).columns, 1);
    }

    #[test]
    fn numbers_of_an_axis_stay_apart() {
        for width in [3e-3, 0.123, 700.0, 2e-7] {
            let layout = layout(1, width, width, 600);
            let scale = f64::from(layout.frames[0].width) * layout.unit.size / width;
            let step = (layout.x_ticks.values[1] - layout.x_ticks.values[0]) * scale;
            let widest = f64::from(layout.style.widest(&layout.x_ticks));
            assert!(widest * 1.1 < step, "{width}: {widest} {step}");
        }
    }
}
