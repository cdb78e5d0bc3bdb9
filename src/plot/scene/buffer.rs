//! The nearest ball, or ellipsoid that it has been deformed to, to the viewer at each sample of a panel.
//!
//! A sample holds one number: the distance from the viewer in its upper half, the index of the ball
//! in the lower. The least of these numbers is the same in any order, so that all threads may draw
//! anywhere. Balls come in portions; after each, samples that a new ball has taken are
//! [resolved](Buffer::resolve), and their balls are forgotten.

use std::sync::atomic::{AtomicU64, Ordering};

use rayon::prelude::*;

use super::window::Window;
use crate::picture::layout::pixels;
use numerics::ellipsoid::Ellipsoid;

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
    pub outline: Outline,
    /// The drawn number.
    pub value: f32,
    /// Number of its body in the picture.
    pub body: u16,
}

/// What of a ball or ellipsoid the viewer sees: its surface over a place beside its middle is `b · d ± h √(1 − d · A d)` of the
/// distance d, to the right and down, towards the viewer.
#[derive(Debug, Clone, Copy)]
pub struct Outline {
    /// Components xx, xy, yy of A.
    inside: [f32; 3],
    /// b.
    slope: [f32; 2],
    /// h (samples).
    height: f32,
    /// How far it reaches to the right, down and towards the viewer (samples).
    reach: [f32; 3],
}

impl Outline {
    /// Of a shape along the picture's axes: to the right, upwards, towards the viewer; `scale` samples are a metre.
    pub fn new(shape: &Ellipsoid, scale: f32) -> Self {
        let square = f64::from(scale).powi(2);
        let part = |a: usize, b: usize| square * shape.component(a, b);
        let (xx, xy, yy) = (part(0, 0), -part(0, 1), part(1, 1));
        let thinnest = 0.5 * (xx + yy) - (0.5 * (xx - yy)).hypot(xy);
        // None falls between samples.
        let more = (f64::from(LEAST).powi(2) - thinnest).max(0.0);
        let (xx, yy, zz) = (xx + more, yy + more, part(2, 2) + more);
        let (xz, yz) = (part(0, 2), -part(1, 2));
        let area = xx * yy - xy * xy;
        let inside = [yy / area, -xy / area, xx / area];
        let slope = [
            inside[0] * xz + inside[1] * yz,
            inside[1] * xz + inside[2] * yz,
        ];
        let height = zz - slope[0] * xz - slope[1] * yz;
        Self {
            inside: inside.map(pixels),
            slope: slope.map(pixels),
            height: pixels(height.max(0.0).sqrt()),
            reach: [xx, yy, zz].map(|square| pixels(square.sqrt())),
        }
    }

    /// The middle of the surface over a place beside its middle, and its height over that, towards the viewer; none where
    /// the place is outside.
    fn over(&self, dx: f32, dy: f32) -> Option<[f32; 2]> {
        let [xx, xy, yy] = self.inside;
        let rest = 1.0 - (xx * dx * dx + 2.0 * xy * dx * dy + yy * dy * dy);
        let middle = self.slope[0] * dx + self.slope[1] * dy;
        (rest > 0.0).then(|| [middle, self.height * rest.sqrt()])
    }

    /// The unit normal of the surface over such a place: to the right and up.
    fn normal(&self, dx: f32, dy: f32) -> [f32; 2] {
        let [xx, xy, yy] = self.inside;
        let [_, rise] = self.over(dx, dy).unwrap_or_default();
        let square = self.height * self.height;
        let right = square * (xx * dx + xy * dy) - rise * self.slope[0];
        let down = square * (xy * dx + yy * dy) - rise * self.slope[1];
        let length = right.hypot(down).hypot(rise).max(f32::MIN_POSITIVE);
        [right / length, -down / length]
    }
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
    let [right, down, towards] = ball.outline.reach;
    let limit = window.limit([x, y]);
    let change = window.change(right.hypot(down));
    if depth - towards >= limit + change {
        return;
    }
    let is_cut = depth + towards > limit - change;
    let columns = span(x, right, window.columns);
    for row in span(y, down, window.rows) {
        let line = &nearest[row * window.columns..(row + 1) * window.columns];
        for column in columns.clone() {
            let at = window.sample(column, row);
            let Some([middle, height]) = ball.outline.over(at[0] - x, at[1] - y) else {
                continue;
            };
            let mut top = depth + middle + height;
            if is_cut {
                let limit = window.limit(at);
                if depth + middle - height >= limit {
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

/// The visible surface of a ball at a sample where its surface, or the plane that cuts it, is at a
/// depth.
fn look(ball: &Ball, at: [f32; 2], depth: f32, window: &Window) -> Seen {
    let (dx, dy) = (at[0] - ball.at[0], at[1] - ball.at[1]);
    // The same to the last bit as where it was drawn: what is higher has been cut.
    let [middle, height] = ball.outline.over(dx, dy).unwrap_or_default();
    let [right, up] = if ball.at[2] + middle + height > depth {
        let [right, up, _] = window.limiting(at);
        [right, up]
    } else {
        ball.outline.normal(dx, dy)
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

    /// A shape in the middle of a panel of 40 × 40 samples that shows 40 m, cut or whole.
    fn drawn(shape: &Ellipsoid, slopes: &[Vec<Slope>]) -> (Window, Buffer) {
        let view = View {
            x: [-20.0, 20.0],
            y: [-20.0, 20.0],
        };
        let window = Window::new([40, 40], &view, 0.0, slopes);
        let mut buffer = Buffer::new(&window);
        let ball = Ball {
            at: [0.0; 3],
            outline: Outline::new(shape, 1.0),
            value: 1.0,
            body: 3,
        };
        buffer.draw(&[ball], &window);
        (window, buffer)
    }

    #[test]
    fn a_ball_is_round_and_a_plane_cuts_it_flat() {
        let ball = Ellipsoid::ball(12.3);
        let (window, buffer) = drawn(&ball, &[]);
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
        let (_, buffer) = drawn(&ball, &[vec![facing]]);
        let highest = buffer.seen.iter().map(|s| s.depth).fold(-1e9, f32::max);
        assert_eq!(highest, 2.0);
        assert_eq!(buffer.seen[20 * 40 + 20].normal(), [0.0, 0.0, 1.0]);
    }

    /// Surface and normal are those of the ball, deformed.
    #[test]
    fn what_is_deformed_is_seen_as_the_image_of_a_ball() {
        let gradient = [1.3, 0.4, -0.2, 0.0, 0.7, 0.3, 0.5, 0.0, 1.0];
        let shape = Ellipsoid::image(10.0, &gradient).unwrap();
        let (window, buffer) = drawn(&shape, &[]);
        let metric = shape.metric();
        let mut count = 0;
        for (k, seen) in buffer.seen.iter().enumerate().filter(|(_, s)| s.body == 3) {
            let [x, y] = window.sample(k % 40, k / 40);
            let at = [x, -y, seen.depth].map(f64::from);
            assert!((numerics::ellipsoid::square(&metric, &at) - 1.0).abs() < 1e-4);
            let [xx, yy, zz, xy, xz, yz] = metric;
            let slope = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]
                .map(|row| row.iter().zip(at).map(|(m, x)| m * x).sum::<f64>());
            let length = slope.iter().map(|n| n * n).sum::<f64>().sqrt();
            for (part, slope) in seen.normal().into_iter().zip(slope) {
                assert!((f64::from(part) - slope / length).abs() < 0.03);
            }
            count += 1;
        }
        // The area of the outline: π √(xx yy − xy²) of its squares.
        let [xx, yy, xy] = [(0, 0), (1, 1), (0, 1)].map(|(a, b)| shape.component(a, b));
        let area = std::f64::consts::PI * (xx * yy - xy * xy).sqrt();
        assert!(
            (f64::from(count) / area - 1.0).abs() < 0.02,
            "{count} {area}"
        );
    }
}
