//! Arrows over pictures.

use super::canvas::{Canvas, INK, PAPER};
use super::style::Style;

/// An arrow from a place over a length (pixels).
pub fn draw(canvas: &mut Canvas, style: Style, at: (f32, f32), (dx, dy): (f32, f32)) {
    let length = dx.hypot(dy);
    let (ex, ey) = (dx / length, dy / length);
    let (line, head) = (3.0 * style.unit, 13.0 * style.unit);
    let tip = (at.0 + dx, at.1 + dy);
    // Paper around it keeps it apart from what is below.
    for (more, colour) in [(2.0 * style.unit, PAPER), (0.0, INK)] {
        let head = head + more;
        let end = (tip.0 + ex * more, tip.1 + ey * more);
        let neck = (end.0 - ex * head, end.1 - ey * head);
        let side = 0.42 * head;
        canvas.line(&[at, neck], line + 2.0 * more, colour);
        canvas.polygon(
            &[
                end,
                (neck.0 - ey * side, neck.1 + ex * side),
                (neck.0 + ey * side, neck.1 - ex * side),
            ],
            colour,
        );
    }
}
