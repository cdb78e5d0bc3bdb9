//! Lines, arrows and a scale over a panel.

use super::panel::Panel;
use crate::arrow;
use crate::canvas::{Align, Canvas, Frame, INK, PAPER, Rgb};
use crate::font;
use crate::picture::layout::pixels;
use crate::style::Style;
use model::readable::shown;
use model::{Case, Region, SymmetryPlane};
use numerics::vector::norm;

/// Colour of symmetry planes.
pub const SYMMETRY: Rgb = [0, 130, 130];
/// Colour of rigid surfaces.
pub const SURFACE: Rgb = [110, 60, 20];
/// Colour of the box of interest.
pub const KEEP: Rgb = [200, 0, 0];

/// Speeds below this share of the fastest have no arrow.
const SLOW: f64 = 1e-3;
/// The fastest body's arrow over the smaller side of its panel.
const LONGEST: f32 = 0.3;

/// Lengths of dashes and of the gaps behind them (units of layout), and with dots between them.
const DASHES: &[f32] = &[7.0, 5.0];
const DASHES_AND_DOTS: &[f32] = &[14.0, 5.0, 2.0, 5.0];

/// A line across the frame where a coordinate of one axis has a value (m), if it is in the view.
fn across(canvas: &mut Canvas, style: Style, panel: &Panel, axis: usize, value: f64, colour: Rgb) {
    let [right, up] = panel.axes();
    let (frame, view) = (&panel.frame, &panel.view);
    let within = |span: [f64; 2]| span[0] <= value && value <= span[1];
    let mut point = [0.0; 3];
    point[axis] = value;
    let (x, y) = panel.at(&point);
    let ends = if axis == right && within(view.x) {
        [(x, frame.top), (x, frame.bottom())]
    } else if axis == up && within(view.y) {
        [(frame.left, y), (frame.right(), y)]
    } else {
        return;
    };
    let lengths = if colour == SYMMETRY {
        DASHES_AND_DOTS
    } else {
        DASHES
    };
    let lengths: Vec<f32> = lengths.iter().map(|length| length * style.unit).collect();
    canvas.dashes(&ends, 2.0 * style.unit, colour, &lengths);
}

/// The planes of symmetry that are seen from their side.
pub fn symmetry(canvas: &mut Canvas, style: Style, panel: &Panel, planes: &[SymmetryPlane]) {
    for plane in planes {
        across(
            canvas,
            style,
            panel,
            plane.axis.index(),
            plane.position,
            SYMMETRY,
        );
    }
}

/// The sides of the box of interest.
pub fn keep(canvas: &mut Canvas, style: Style, panel: &Panel, keep: Option<&Region>) {
    for axis in panel.axes() {
        for side in keep
            .iter()
            .flat_map(|keep| [keep.above[axis], keep.below[axis]])
        {
            across(canvas, style, panel, axis, side, KEEP);
        }
    }
}

/// The number of a body, its middle (m) and its velocity (m/s).
pub type Flight = (usize, [f64; 3], [f64; 3]);

/// The velocities of bodies that are seen to move.
pub fn velocities(case: &Case) -> Vec<Flight> {
    let bodies = case.bodies.iter().enumerate().filter_map(|(index, body)| {
        let (lower, upper) = super::extent::of_body(body, case)?;
        let middle: [f64; 3] = std::array::from_fn(|a| 0.5 * (lower[a] + upper[a]));
        let velocity = match body.driven() {
            Some(motion) => std::array::from_fn(|a| motion.velocity(a, 0.0)),
            None => body.velocity.into(),
        };
        Some((index, middle, velocity))
    });
    let all: Vec<Flight> = bodies.collect();
    let fastest = all.iter().fold(0.0, |most: f64, (.., v)| most.max(norm(v)));
    let moves = |(.., v): &Flight| norm(v) > SLOW * fastest;
    all.into_iter().filter(moves).collect()
}

/// An arrow for each velocity, as long as it is fast, with its speed if `named`; towards the viewer a
/// dot in a ring, away a cross.
pub fn arrows(canvas: &mut Canvas, style: Style, panel: &Panel, all: &[Flight], named: bool) {
    let fastest = all.iter().fold(0.0, |most: f64, (.., v)| most.max(norm(v)));
    let longest = LONGEST * panel.frame.width.min(panel.frame.height);
    let [right, up] = panel.axes();
    let normal = panel.plane.axis.index();
    for (_, point, v) in all {
        let at = panel.at(point);
        let share = |a: usize| pixels(v[a] / fastest) * longest;
        let (dx, dy) = (share(right), -share(up));
        if dx.hypot(dy) < 0.05 * longest {
            along_sight(canvas, style, at, v[normal] * panel.towards() > 0.0);
        } else {
            // Short ones are still seen.
            let least = (16.0 * style.unit / dx.hypot(dy)).max(1.0);
            arrow::draw(canvas, style, at, (dx * least, dy * least));
        }
        if named {
            // Not over its arrow.
            let leftwards = dx > dy.abs();
            let text = shown(norm(v), "m/s");
            label(canvas, style, at, &text, leftwards, &panel.frame);
        }
    }
}

/// A dot in a ring for what comes, a cross in one for what goes.
fn along_sight(canvas: &mut Canvas, style: Style, at: (f32, f32), comes: bool) {
    let page = Frame::PAGE;
    let radius = 9.0 * style.unit;
    canvas.disc(at, radius + 2.0 * style.unit, PAPER, &page);
    canvas.bead(at, radius, PAPER, (2.5 * style.unit, INK), &page);
    if comes {
        canvas.disc(at, 2.5 * style.unit, INK, &page);
        return;
    }
    let arm = 0.7 * (radius - 2.5 * style.unit);
    for sign in [-1.0, 1.0] {
        let ends = [
            (at.0 - arm, at.1 - sign * arm),
            (at.0 + arm, at.1 + sign * arm),
        ];
        canvas.line(&ends, 2.0 * style.unit, INK);
    }
}

/// A text on paper beside a point: on the left if it is wanted there, within a frame if it fits.
fn label(
    canvas: &mut Canvas,
    style: Style,
    at: (f32, f32),
    text: &str,
    leftwards: bool,
    frame: &Frame,
) {
    let size = style.small();
    let (width, gap) = (font::width(text, size), style.gap());
    let sides = [at.0 - width - 2.0 * gap, at.0 + 2.0 * gap];
    let fits = |left: &f32| *left > frame.left && *left + width < frame.right();
    let [wanted, other] = if leftwards {
        sides
    } else {
        [sides[1], sides[0]]
    };
    let left = [wanted, other].into_iter().find(fits);
    let left = left.unwrap_or(frame.right() + gap);
    let paper = Frame {
        left: left - 0.4 * gap,
        top: at.1 - 0.55 * size,
        width: width + 0.8 * gap,
        height: 1.1 * size,
    };
    canvas.fill(&paper, PAPER);
    let at = (left, at.1 + 0.36 * size);
    canvas.text(text, at, size, Align::Start);
}
