//! The nearest particle to the viewer at each pixel of a panel.

use rayon::prelude::*;

use super::panel::Panel;
use crate::canvas::{PAPER, Rgb};
use crate::colour;

/// Discs of a smaller radius (pixels) are squares, which leave no gaps between them.
const SMALL: f64 = 2.5;

/// Squares are wider than a spacing by this, as rows of close-packed lattices are apart.
const WIDER: f64 = 1.12;

/// No particle.
const NOBODY: u16 = u16::MAX;

/// The nearest particle at a pixel.
#[derive(Debug, Clone, Copy)]
struct Hit {
    /// Distance (m) beyond a plane that all are behind; smaller is nearer.
    depth: f32,
    body: u16,
    /// Brightness, 255 for all.
    tone: u8,
    /// How far from here its body has no gap but where it ends (pixels), 255 for more.
    reach: u8,
}

impl Hit {
    /// Nothing.
    const NONE: Self = Self {
        depth: f32::INFINITY,
        body: NOBODY,
        tone: 255,
        reach: 0,
    };
}

/// The sides of a pixel, as rows and columns.
const SIDES: [[isize; 2]; 8] = [
    [0, 1],
    [1, 1],
    [1, 0],
    [1, -1],
    [0, -1],
    [-1, -1],
    [-1, 0],
    [-1, 1],
];

/// Widest gap between the particles of a body, which lie in glass, over their radius.
const GAP: f64 = 2.5;

/// Sides on which particles enclose a pixel: outlines, which are open on three, stay as they are.
const ENCLOSING: usize = 6;

/// The pixels of a panel.
#[derive(Debug, Clone)]
pub struct Image {
    panel: Panel,
    columns: usize,
    rows: usize,
    hits: Vec<Hit>,
    /// Half the height (pixels) that small particles have at least.
    rise: f64,
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "pixels are clamped to the panel, and depths need no more digits"
)]
impl Image {
    /// Of no particles yet, which are to be so high at least (pixels).
    pub fn new(panel: Panel, height: f64) -> Self {
        let [columns, rows] = panel.frame.pixels();
        Self {
            panel,
            columns,
            rows,
            hits: vec![Hit::NONE; columns * rows],
            rise: 0.5 * height,
        }
    }

    /// Pixels in a row.
    pub fn columns(&self) -> usize {
        self.columns
    }

    /// Adds a particle at a place (m) as a ball of a size (m).
    pub fn add(&mut self, point: &[f64; 3], size: f64, body: usize) {
        let [right, up] = self.panel.axes();
        let (view, scale) = (&self.panel.view, self.panel.scale());
        let x = (point[right] - view.x[0]) * scale;
        let y = (view.y[1] - point[up]) * scale;
        let depth = -self.panel.towards() * point[self.panel.plane.axis.index()];
        let radius = 0.5 * size * scale;
        let small = radius < SMALL;
        let reach = if small {
            (WIDER * radius).max(0.5)
        } else {
            radius
        };
        let pixels = |middle: f64, reach: f64, count: usize| {
            let first = (middle - reach - 0.5).ceil().max(0.0);
            let end = (middle + reach - 0.5).floor() + 1.0;
            first as usize..(end.max(0.0) as usize).min(count)
        };
        let body = u16::try_from(body).unwrap_or(NOBODY - 1);
        let rise = if small { reach.max(self.rise) } else { reach };
        let gap = (GAP * radius).ceil().min(255.0) as u8;
        for row in pixels(y, rise, self.rows) {
            for column in pixels(x, reach, self.columns) {
                let hit = if small {
                    Some((depth, 255))
                } else {
                    let (dx, dy) = (column as f64 + 0.5 - x, row as f64 + 0.5 - y);
                    ball(dx.hypot(dy) / radius, radius)
                        .map(|(height, tone)| (depth - height / scale, tone))
                };
                let Some((depth, tone)) = hit else { continue };
                let hit = Hit {
                    depth: depth as f32,
                    body,
                    tone,
                    reach: gap,
                };
                let old = &mut self.hits[row * self.columns + column];
                if (hit.depth, hit.body) < (old.depth, old.body) {
                    *old = hit;
                }
            }
        }
    }

    /// Returns true if discs of a size (m) are squares, which leave no gaps between them.
    pub fn is_small(panel: &Panel, size: f64) -> bool {
        0.5 * size * panel.scale() < SMALL
    }

    /// Fills the pixels of the panel's plane at which `body_at` finds a body, by their places along the picture's axes (m).
    pub fn fill(&mut self, body_at: impl Fn([f64; 2]) -> Option<usize> + Sync) {
        let panel = self.panel;
        let [right, up] = panel.axes();
        let along = panel.plane.position;
        let depth = (-panel.towards() * along) as f32;
        let rows = self.hits.par_chunks_mut(self.columns).enumerate();
        rows.for_each(|(row, hits)| {
            for (column, hit) in hits.iter_mut().enumerate() {
                let point = panel.point(column as f64 + 0.5, row as f64 + 0.5, along);
                if let Some(body) = body_at([point[right], point[up]]) {
                    *hit = Hit {
                        depth,
                        body: u16::try_from(body).unwrap_or(NOBODY - 1),
                        tone: 255,
                        reach: 0,
                    };
                }
            }
        });
    }

    /// Fills what is left between the particles of a body, which is solid: pixels around which it has particles on
    /// nearly all sides, no farther than across a gap.
    pub fn close(&mut self) {
        let farthest = self.hits.iter().map(|hit| hit.reach).max().unwrap_or(0);
        let (image, columns) = (&*self, self.columns);
        let closed = (0..self.hits.len()).into_par_iter().map(|at| {
            let around = SIDES.map(|side| image.beside(at / columns, at % columns, side, farthest));
            let of = |body: u16| around.iter().flatten().filter(move |hit| hit.body == body);
            let bodies = around.iter().flatten().map(|hit| hit.body);
            let body = bodies.max_by_key(|&body| of(body).count());
            let Some(body) = body.filter(|&body| of(body).count() >= ENCLOSING) else {
                return image.hits[at];
            };
            Hit {
                depth: of(body).fold(f32::NEG_INFINITY, |most, hit| most.max(hit.depth)),
                body,
                tone: of(body).map(|hit| hit.tone).min().unwrap_or(255),
                reach: 0,
            }
        });
        self.hits = closed.collect();
    }

    /// The first particle on a side of a pixel that is before what is seen there, of another body, and no farther than
    /// across a gap.
    fn beside(&self, row: usize, column: usize, side: [isize; 2], farthest: u8) -> Option<Hit> {
        let here = &self.hits[row * self.columns + column];
        (1..=isize::from(farthest)).find_map(|k| {
            let row = row
                .checked_add_signed(k * side[0])
                .filter(|&row| row < self.rows)?;
            let column = column.checked_add_signed(k * side[1]);
            let column = column.filter(|&column| column < self.columns)?;
            let other = self.hits[row * self.columns + column];
            let is_before = other.body != here.body && other.depth < here.depth;
            (is_before && k <= isize::from(other.reach)).then_some(other)
        })
    }

    /// Takes in what others have found.
    pub fn merge(&mut self, other: &Self) {
        for (hit, other) in self.hits.iter_mut().zip(&other.hits) {
            if (other.depth, other.body) < (hit.depth, hit.body) {
                *hit = *other;
            }
        }
    }

    /// Numbers of the bodies that are seen.
    pub fn bodies(&self) -> impl Iterator<Item = usize> {
        let seen = self.hits.iter().filter(|hit| hit.body != NOBODY);
        seen.map(|hit| usize::from(hit.body))
    }

    /// Colours of the pixels, row by row: far things are paler, with lines where bodies end and where
    /// one thing is before another by more than `step` (m).
    pub fn colours(&self, step: f64) -> Vec<Rgb> {
        let seen = || self.hits.iter().filter(|hit| hit.body != NOBODY);
        let nearest = seen().fold(f32::INFINITY, |a, hit| a.min(hit.depth));
        let farthest = seen().fold(f32::NEG_INFINITY, |a, hit| a.max(hit.depth));
        let depth = (farthest - nearest).max(f32::MIN_POSITIVE);
        let mut colours = Vec::with_capacity(self.hits.len());
        for row in 0..self.rows {
            for column in 0..self.columns {
                let hit = &self.hits[row * self.columns + column];
                if hit.body == NOBODY {
                    colours.push(PAPER);
                    continue;
                }
                let pale = 0.45 * (hit.depth - nearest) / depth
                    * f32::from(u8::from(step < f64::from(depth)));
                let tone = f32::from(hit.tone) / 255.0;
                let edge = if self.is_edge(row, column, step) {
                    0.45
                } else {
                    1.0
                };
                let shade =
                    |c: u8| ((f32::from(c) * (1.0 - pale) + 255.0 * pale) * tone * edge) as u8;
                colours.push(colour::body(usize::from(hit.body)).map(shade));
            }
        }
        colours
    }

    /// `true` if a body, or its near side, ends at a pixel.
    fn is_edge(&self, row: usize, column: usize, step: f64) -> bool {
        let own = &self.hits[row * self.columns + column];
        let beside = [
            (row.wrapping_sub(1), column),
            (row + 1, column),
            (row, column.wrapping_sub(1)),
            (row, column + 1),
        ];
        beside.into_iter().any(|(row, column)| {
            if row >= self.rows || column >= self.columns {
                return false;
            }
            let other = &self.hits[row * self.columns + column];
            f64::from(other.depth) > f64::from(own.depth) + step
                || (other.body != own.body && other.depth >= own.depth)
        })
    }
}

/// Height over its middle, and brightness, of a ball of a radius (pixels) at a distance from the
/// middle over the radius.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "brightness is a byte"
)]
fn ball(distance: f64, radius: f64) -> Option<(f64, u8)> {
    if distance > 1.0 {
        return None;
    }
    let height = (1.0 - distance * distance).sqrt();
    let rim = 1.0 - (1.2 / radius).min(0.15);
    let tone = if distance > rim {
        0.62
    } else {
        0.82 + 0.18 * height
    };
    Some((height * radius, (255.0 * tone) as u8))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::canvas::Frame;
    use crate::picture::view::View;
    use crate::snapshots::plane::Plane;
    use model::Axis;

    fn image(axis: Axis) -> Image {
        let panel = Panel {
            plane: Plane {
                axis,
                position: 0.0,
            },
            view: View {
                x: [0.0, 10.0],
                y: [0.0, 10.0],
            },
            frame: Frame {
                left: 0.0,
                top: 0.0,
                width: 100.0,
                height: 100.0,
            },
        };
        Image::new(panel, 0.0)
    }

    /// Squares of particles leave no gap, whatever their pitch in pixels.
    #[test]
    fn a_lattice_of_any_pitch_is_solid() {
        for count in [7_u32, 33, 150, 400] {
            let mut image = image(Axis::Z);
            let size = 10.0 / f64::from(count);
            for k in 0..count * count {
                let at = |n: u32| (f64::from(n) + 0.5) * size;
                image.add(&[at(k % count), at(k / count), 0.0], size, 3);
            }
            image.close();
            let seen = image.bodies().count();
            // The outline of discs has notches.
            let all = if size * 10.0 < 2.0 * SMALL { 1.0 } else { 0.93 };
            assert!(seen as f64 >= all * 1e4, "{count}: {seen}");
            assert!(image.bodies().all(|body| body == 3));
        }
    }

    /// Particles without order leave no holes, through which another body would be seen, and the outline stays theirs.
    #[test]
    fn a_body_of_coarse_particles_without_order_is_solid() {
        let mut image = image(Axis::Z);
        image.add(&[5.0, 5.0, -99.0], 30.0, 1);
        let size = 0.8;
        let shifted = |n: u32, salt: u32| {
            let word = (n + salt).wrapping_mul(2_654_435_761) >> 16;
            0.4 * (f64::from(word % 1000) / 1000.0 - 0.5) * size
        };
        for k in 0..64_u32 {
            let [x, y] = [k % 8, k / 8].map(|n| 2.0 + f64::from(n) * size);
            image.add(&[x + shifted(k, 1), y + shifted(k, 77), 0.0], size, 2);
        }
        image.close();
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "pixels of the image"
        )]
        let body = |x: f64, y: f64| {
            let [row, column] = [10.0 - y, x].map(|way| (10.0 * way) as usize);
            image.hits[row * 100 + column].body
        };
        let steps = || (0..100).map(|k| 0.1 * f64::from(k) + 0.05);
        for (x, y) in steps().flat_map(|x| steps().map(move |y| (x, y))) {
            let inside = |z: f64| (2.8..6.8).contains(&z);
            let outside = |z: f64| !(1.3..8.3).contains(&z);
            if inside(x) && inside(y) {
                assert_eq!(body(x, y), 2, "{x} {y}");
            } else if outside(x) || outside(y) {
                assert_eq!(body(x, y), 1, "{x} {y}");
            }
        }
    }

    /// The viewer looks down z, and along y from below.
    #[test]
    fn what_is_nearer_hides_what_is_behind() {
        for (axis, nearer) in [(Axis::X, 1), (Axis::Y, 0), (Axis::Z, 1)] {
            let mut image = image(axis);
            let mut point = [5.0; 3];
            for (body, along) in [(0, 2.0), (1, 8.0)] {
                point[axis.index()] = along;
                image.add(&point, 1.0, body);
            }
            let mut seen: Vec<usize> = image.bodies().collect();
            seen.dedup();
            assert_eq!(seen, [nearer], "{axis:?}");
        }
    }
}
