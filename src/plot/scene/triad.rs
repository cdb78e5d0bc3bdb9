//! The directions of the model's axes in a view.

use super::camera::Camera;
use crate::arrow;
use crate::canvas::{Align, Canvas};
use crate::picture::layout::pixels;
use crate::style::Style;
use model::Axis;

/// Length of an axis that lies in the picture (units of layout).
const LENGTH: f64 = 30.0;

/// Axes that look shorter than this share point at the viewer or away.
const ALONG_SIGHT: f64 = 0.15;

/// Draws the three axes about a place (pixels).
pub fn draw(canvas: &mut Canvas, style: Style, at: (f32, f32), camera: &Camera) {
    let mut axes = Axis::ALL;
    // Those that point away first.
    let towards = |axis: &Axis| camera.towards[axis.index()];
    axes.sort_by(|a, b| towards(a).total_cmp(&towards(b)));
    for axis in axes {
        let (right, up) = (camera.right[axis.index()], camera.up[axis.index()]);
        if right.hypot(up) < ALONG_SIGHT {
            continue;
        }
        let long = |share: f64, length: f64| pixels(share * length) * style.unit;
        arrow::draw(canvas, style, at, (long(right, LENGTH), -long(up, LENGTH)));
        let beyond = (LENGTH + 12.0 / right.hypot(up)).min(2.0 * LENGTH);
        let name = (
            at.0 + long(right, beyond),
            at.1 - long(up, beyond) + 0.3 * style.small(),
        );
        canvas.text(axis.name(), name, style.small(), Align::Middle);
    }
}
