//! Rigid surfaces in a panel: the line in which a section cuts one, hatched on the side that is kept
//! free, and the outline of what is seen of one along an axis.

use rayon::prelude::*;

use super::extent::Ends;
use super::panel::Panel;
use model::{RigidSurface, SurfaceShape};

/// Width of the hatch beside a line (pixels), and distance of its strokes.
const HATCH: f64 = 7.0;
const STROKES: usize = 6;

/// Steps along a ray at most.
const MOST_STEPS: usize = 200;

/// The part of a panel in which a surface may be seen.
struct Reach {
    axes: [usize; 2],
    lower: [f64; 3],
    upper: [f64; 3],
}

impl Reach {
    /// With some room (m) about it.
    fn of(surface: &RigidSurface, panel: &Panel, room: f64) -> Self {
        let (lower, upper) = surface.bounds();
        Self {
            axes: panel.axes(),
            lower: lower.map(|x| x - room),
            upper: upper.map(|x| x + room),
        }
    }

    fn has(&self, point: &[f64; 3]) -> bool {
        let within = |a: usize| self.lower[a] <= point[a] && point[a] <= self.upper[a];
        self.axes.into_iter().all(within)
    }
}

/// Distance (m) from the surface, whichever side.
fn distance(surface: &RigidSurface, point: &[f64; 3]) -> f64 {
    let foot = surface.foot(point, f64::INFINITY);
    foot.map_or(f64::INFINITY, |foot| foot.gap.abs())
}

/// Calls `work` for each row of pixels, in parallel, and gives those of their columns that it takes.
fn rows(panel: &Panel, work: impl Fn(usize, usize) -> bool + Sync) -> Vec<(usize, usize)> {
    let [columns, rows] = panel.frame.pixels();
    let of_row = |row: usize| {
        let columns = (0..columns).filter(|&column| work(column, row));
        columns.map(|column| (column, row)).collect::<Vec<_>>()
    };
    let samples: Vec<Vec<_>> = (0..rows).into_par_iter().map(of_row).collect();
    samples.concat()
}

/// The middle of a pixel.
fn middle(pixel: usize) -> f64 {
    pixel as f64 + 0.5
}

/// The pixels of the line in which a panel's plane cuts a surface, and of the hatch behind it. Pixels
/// are columns and rows of the frame.
pub fn cut(surface: &RigidSurface, panel: &Panel, line: f32) -> Vec<(usize, usize)> {
    let half = 0.5 * f64::from(line);
    let reach = Reach::of(surface, panel, HATCH / panel.scale());
    rows(panel, |column, row| {
        let point = panel.point(middle(column), middle(row), panel.plane.position);
        if !reach.has(&point) {
            return false;
        }
        let Some(foot) = surface.foot(&point, f64::INFINITY) else {
            return false;
        };
        // As it is seen in the plane, to which the surface may be inclined.
        let normal = foot.normal[panel.plane.axis.index()];
        let inclined = (1.0 - normal * normal).max(0.0).sqrt();
        if inclined < 0.02 {
            return false;
        }
        let gap = foot.gap * panel.scale() / inclined;
        let stroke = (column + row).is_multiple_of(STROKES);
        gap.abs() <= half || (stroke && (-HATCH..0.0).contains(&gap))
    })
}

/// `true` if a ray, which is `at` a point for each coordinate along it, comes as near to a surface
/// as `least` (m) between two coordinates (m): it goes as far as the surface is away, again and
/// again.
fn is_met(
    surface: &RigidSurface,
    at: impl Fn(f64) -> [f64; 3],
    [low, high]: [f64; 2],
    least: f64,
) -> bool {
    let mut along = low;
    for _ in 0..MOST_STEPS {
        let free = distance(surface, &at(along));
        if free < least {
            return true;
        }
        along += free;
        if along > high {
            break;
        }
    }
    false
}

/// The pixels of the outline of what is seen of a surface along a panel's axis, of one without an end
/// about the particles; of a plane those where it is seen from its side.
pub fn seen(surface: &RigidSurface, panel: &Panel, particles: &Ends) -> Vec<(usize, usize)> {
    if let SurfaceShape::Plane { normal, .. } = &surface.shape {
        let sideways = normal[panel.plane.axis.index()].abs() < 1e-6;
        return if sideways {
            cut(surface, panel, 2.0)
        } else {
            Vec::new()
        };
    }
    let pixel = 1.0 / panel.scale();
    let a = panel.plane.axis.index();
    let (lower, upper) = surface.bounds();
    let end = |own: f64, other: f64| if own.is_finite() { own } else { other };
    let low = end(lower[a] - pixel, particles.0[a]);
    let high = end(upper[a] + pixel, particles.1[a]);
    let reach = Reach::of(surface, panel, pixel);
    let hits = |column: usize, row: usize| {
        let at = |along: f64| panel.point(middle(column), middle(row), along);
        reach.has(&at(low)) && is_met(surface, at, [low, high], pixel)
    };
    let [columns, height] = panel.frame.pixels();
    let mut mask = vec![false; columns * height];
    for (column, row) in rows(panel, hits) {
        mask[row * columns + column] = true;
    }
    let is = |column: usize, row: usize| {
        column < columns && row < height && mask[row * columns + column]
    };
    let inside = |column: usize, row: usize| {
        let beside = [
            (column.wrapping_sub(1), row),
            (column + 1, row),
            (column, row.wrapping_sub(1)),
            (column, row + 1),
        ];
        beside.into_iter().all(|(column, row)| is(column, row))
    };
    // Two pixels wide.
    let edge = |column: usize, row: usize| is(column, row) && !inside(column, row);
    rows(panel, |column, row| {
        edge(column, row)
            || is(column, row)
                && [(column + 1, row), (column, row + 1)]
                    .into_iter()
                    .any(|(c, r)| edge(c, r))
    })
}
