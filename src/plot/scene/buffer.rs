//! The nearest ball to the viewer at each sample of a panel.
//!
//! A sample holds one number: the distance from the viewer in its upper half, the index of the ball
//! in the lower. The least of these numbers is the same in any order, so that all threads may draw
//! anywhere. Balls come in portions; after each, samples that a new ball has taken are
//! [resolved](Buffer::resolve), and their balls are forgotten.

use std::sync::atomic::{AtomicU64, Ordering};

use rayon::prelude::*;

use super::window::Window;

/// Smallest radius of a ball (samples): none falls between samples.
const LEAST: f32 = 0.75;

/// Balls that one task draws.
const PORTION: usize = 4096;

/// No ball.
pub const NOBODY: u16 = u16::MAX;

/// A particle on its way into a picture, in samples of a [`Window`].
#[derive(Debug, Clone, Copy)]
pub struct Ball {
    /// Its middle: to the right, down, towards the viewer.
    pub at: [f32; 3],
    pub radius: f32,
    /// The drawn number.
    pub value: f32,
    /// Number of its body in the picture.
    pub body: u16,
}

/// The visible surface at a sample.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Seen {
    /// Distance towards the viewer (samples).
    pub depth: f32,
    /// The drawn number.
    pub value: f32,
    /// The normal of its surface: to the right and up, in 1/[`ONE`].
    normal: [i16; 2],
    /// Number of its body; [`NOBODY`] where there is nothing.
    pub body: u16,
}

/// A normal of length one in integers.
const ONE: f32 = 32_000.0;

impl Seen {
    /// Nothing.
    pub const NOTHING: Self = Self {
        depth: f32::NEG_INFINITY,
        value: 0.0,
        normal: [0; 2],
        body: NOBODY,
    };

    /// The normal: to the right, up, towards the viewer.
    pub fn normal(&self) -> [f32; 3] {
        let [x, y] = self.normal.map(|n| f32::from(n) / ONE);
        [x, y, (1.0 - x * x - y * y).max(0.0).sqrt()]
    }
}

/// The samples of a panel.
pub struct Buffer {
    nearest: Vec<AtomicU64>,
    /// The visible surface, row by row.
    pub seen: Vec<Seen>,
}

impl Buffer {
    /// With nothing in it.
    pub fn new(window: &Window) -> Self {
        let count = window.columns * window.rows;
        let blank = |_| AtomicU64::new(u64::MAX);
        Self {
            nearest: (0..count).into_par_iter().map(blank).collect(),
            seen: vec![Seen::NOTHING; count],
        }
    }

    /// Draws balls, no more than 2³¹.
    pub fn draw(&mut self, balls: &[Ball], window: &Window) {
        if balls.is_empty() {
            return;
        }
        let nearest = &self.nearest;
        balls
            .par_chunks(PORTION)
            .enumerate()
            .for_each(|(portion, part)| {
                for (index, ball) in (portion * PORTION..).zip(part) {
                    mark(nearest, window, ball, index);
                }
            });
        self.resolve(balls, window);
    }

    /// Takes down what is seen of the balls just drawn.
    fn resolve(&mut self, balls: &[Ball], window: &Window) {
        let columns = window.columns;
        let rows = self.seen.par_chunks_mut(columns);
        rows.zip(self.nearest.par_chunks(columns))
            .enumerate()
            .for_each(|(row, (seen, nearest))| {
                for (column, (seen, nearest)) in seen.iter_mut().zip(nearest).enumerate() {
                    let (depth, index) = parts(nearest.load(Ordering::Relaxed));
                    if let Some(index) = index {
                        let at = window.sample(column, row);
                        *seen = look(&balls[index], at, depth, window);
                        nearest.store(number(depth, None), Ordering::Relaxed);
                    }
                }
            });
    }
}

/// Marks the samples where a ball is the nearest so far.
fn mark(nearest: &[AtomicU64], window: &Window, ball: &Ball, index: usize) {
    let [x, y, depth] = ball.at;
    let radius = ball.radius.max(LEAST);
    let limit = window.limit([x, y]);
    let change = window.change(radius);
    if depth - radius >= limit + change {
        return;
    }
    let is_cut = depth + radius > limit - change;
    let columns = span(x, radius, window.columns);
    for row in span(y, radius, window.rows) {
        let line = &nearest[row * window.columns..(row + 1) * window.columns];
        for column in columns.clone() {
            let at = window.sample(column, row);
            let Some(height) = height(radius, at[0] - x, at[1] - y) else {
                continue;
            };
            let mut top = depth + height;
            if is_cut {
                let limit = window.limit(at);
                if depth - height >= limit {
                    continue;
                }
                top = top.min(limit);
            }
            let number = number(top, Some(index));
            if number < line[column].load(Ordering::Relaxed) {
                line[column].fetch_min(number, Ordering::Relaxed);
            }
        }
    }
}

/// The height of the surface of a ball over its middle towards the viewer, at a point beside it.
fn height(radius: f32, dx: f32, dy: f32) -> Option<f32> {
    let rest = radius * radius - (dx * dx + dy * dy);
    (rest > 0.0).then(|| rest.sqrt())
}

/// The visible surface of a ball at a sample where its surface, or the plane that cuts it, is at a
/// depth.
fn look(ball: &Ball, at: [f32; 2], depth: f32, window: &Window) -> Seen {
    let radius = ball.radius.max(LEAST);
    let (dx, dy) = (at[0] - ball.at[0], at[1] - ball.at[1]);
    // The same to the last bit as where it was drawn: what is higher has been cut.
    let height = height(radius, dx, dy).unwrap_or(0.0);
    let [right, up] = if ball.at[2] + height > depth {
        let [right, up, _] = window.limiting(at);
        [right, up]
    } else {
        [dx / radius, -dy / radius]
    };
    #[expect(
        clippy::cast_possible_truncation,
        reason = "a component of a unit vector"
    )]
    let whole = |component: f32| (component * ONE) as i16;
    Seen {
        depth,
        value: ball.value,
        normal: [whole(right), whole(up)],
        body: ball.body,
    }
}

/// The samples along an axis whose middles a ball may cover.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "clamped to the window"
)]
fn span(at: f32, radius: f32, count: usize) -> std::ops::Range<usize> {
    let middle = at + 0.5 * count as f32 - 0.5;
    // Whatever rounding does, a sample on either side of a ball is looked at.
    let radius = radius + 0.01;
    let first = (middle - radius).ceil().clamp(0.0, count as f32) as usize;
    let end = ((middle + radius).floor() + 1.0).clamp(0.0, count as f32) as usize;
    first..end.max(first)
}

/// Depth and ball as a number, the less the nearer; of balls at the same depth the first, and
/// before them resolved ones.
fn number(depth: f32, index: Option<usize>) -> u64 {
    let bits = (-depth).to_bits();
    let ordered = if bits >> 31 == 0 {
        bits | (1 << 31)
    } else {
        !bits
    };
    let index = index.map_or(0, |index| index as u64 + 1);
    (u64::from(ordered) << 32) | index
}

/// Depth and ball of a number; no ball for a sample that is resolved or empty.
#[expect(clippy::cast_possible_truncation, reason = "halves of a number")]
fn parts(number: u64) -> (f32, Option<usize>) {
    if number == u64::MAX {
        return (f32::NEG_INFINITY, None);
    }
    let ordered = (number >> 32) as u32;
    let bits = if ordered >> 31 == 0 {
        !ordered
    } else {
        ordered & !(1 << 31)
    };
    let index = (number as u32 as usize).checked_sub(1);
    (-f32::from_bits(bits), index)
}

#[cfg(test)]
mod tests {
    use super::super::cut::Slope;
    use super::*;
    use crate::picture::view::View;

    #[test]
    fn numbers_are_in_the_order_of_distance() {
        let depths = [1e9, 3.5, 1e-3, 0.0, -1e-3, -7.0, -1e9];
        for pair in depths.windows(2) {
            assert!(number(pair[0], Some(7)) < number(pair[1], None));
        }
        for depth in depths {
            assert_eq!(parts(number(depth, Some(12))), (depth, Some(12)));
            assert_eq!(parts(number(depth, None)), (depth, None));
            assert!(number(depth, None) < number(depth, Some(0)));
        }
        assert_eq!(parts(u64::MAX).1, None);
    }

    /// A ball in the middle of a panel of 40 × 40 samples that shows 40 m, cut or whole.
    fn ball(slopes: &[Vec<Slope>]) -> (Window, Buffer) {
        let view = View {
            x: [-20.0, 20.0],
            y: [-20.0, 20.0],
        };
        let window = Window::new([40, 40], &view, 0.0, slopes);
        let mut buffer = Buffer::new(&window);
        let ball = Ball {
            at: [0.0; 3],
            radius: 12.3,
            value: 1.0,
            body: 3,
        };
        buffer.draw(&[ball], &window);
        (window, buffer)
    }

    #[test]
    fn a_ball_is_round_and_a_plane_cuts_it_flat() {
        let (window, buffer) = ball(&[]);
        for (k, seen) in buffer.seen.iter().enumerate() {
            let [x, y] = window.sample(k % 40, k / 40);
            assert_eq!(seen.body == 3, x.hypot(y) < 12.3);
            if seen.body == 3 {
                let normal = seen.normal();
                for (part, selection) in normal.into_iter().zip([x, -y, seen.depth]) {
                    // Steep sides lose digits of what points at the viewer.
                    assert!(
                        (part - selection / 12.3).abs() < 0.02,
                        "{x} {y}: {normal:?}"
                    );
                }
            }
        }
        let facing = Slope {
            at_middle: 2.0,
            along: [0.0; 2],
            normal: [0.0, 0.0, 1.0],
        };
        let (_, buffer) = ball(&[vec![facing]]);
        let highest = buffer.seen.iter().map(|s| s.depth).fold(-1e9, f32::max);
        assert_eq!(highest, 2.0);
        assert_eq!(buffer.seen[20 * 40 + 20].normal(), [0.0, 0.0, 1.0]);
    }
}
