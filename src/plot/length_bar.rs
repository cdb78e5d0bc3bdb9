//! The length bar of pictures without axes.

use super::canvas::{Align, Canvas, INK};
use super::picture::layout::pixels;
use super::style::Style;
use super::ticks::nice_step;
use model::readable::{Readable, short};

/// A bar of a round length with its number, with its left end at a place, not longer than `most`
/// (pixels); `scale` is pixels per metre.
pub fn draw(canvas: &mut Canvas, style: Style, at: (f32, f32), (scale, most): (f64, f32)) {
    let room = f64::from(most) / scale;
    // The largest round length that is not longer.
    let steps = (1..=40).map(|k| nice_step(room / 1.05_f64.powi(k)));
    let length = steps.filter(|&length| length <= room).fold(0.0, f64::max);
    let unit = Readable::new("m", length);
    let number = short(length / unit.size);
    let end = (at.0 + pixels(length * scale), at.1);
    let rise = 0.8 * style.tick();
    canvas.line(&[at, end], 3.0 * style.unit, INK);
    for (x, y) in [at, end] {
        canvas.line(&[(x, y - rise), (x, y + rise)], style.line(), INK);
    }
    let text = (end.0 + style.gap(), at.1 + 0.36 * style.small());
    canvas.text(
        &format!("{number} {}", unit.name),
        text,
        style.small(),
        Align::Start,
    );
}
