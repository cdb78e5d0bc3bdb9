//! Space in blocks of cells, of which only those exist that particles reach.

#![expect(
    clippy::cast_precision_loss,
    reason = "numbers of cells along a block are small"
)]

use std::collections::BTreeMap;

use super::Triangle;
use super::cubes::{self, Cube};
use super::level::{Ball, CELLS, Coordinates, NODES, add, levels, node};
use plot::Fill;

/// Largest number of a block along an axis, so that nodes are distinct.
const FARTHEST: f64 = 1e9;
/// Most blocks that one particle may reach: those of a ball of some four hundred cells.
const MOST_BLOCKS: f64 = 2e4;
/// Most blocks that particles may reach on average, beside so many that may always be.
const MOST_SHARES: usize = 64;
const FREE_SHARES: usize = 1 << 20;

const TOO_SMALL: &str = "its particles are too far apart, or too large, for cells so small: give \
                         larger ones with --cell";

/// The blocks of a model.
#[derive(Debug)]
pub struct Blocks {
    /// Edge of a cell (m).
    pitch: f64,
    /// Place of each block, and where its balls begin in `balls`; in order of places.
    starts: Vec<([i32; 3], usize)>,
    /// Numbers of balls, block by block, and in each in their own order.
    balls: Vec<u32>,
}

impl Blocks {
    /// Sorts balls into blocks of cells with an edge of `pitch` (m).
    ///
    /// # Errors
    /// A message, if the cells are too small for the extent of the balls.
    pub fn new(balls: &[Ball], pitch: f64) -> Result<Self, String> {
        let mut spans = Vec::with_capacity(balls.len());
        for ball in balls {
            spans.push(span(ball, pitch).ok_or(TOO_SMALL)?);
        }
        let mut counts = BTreeMap::new();
        for span in &spans {
            visit_blocks(span, |key| *counts.entry(key).or_insert(0) += 1);
        }
        let total: usize = counts.values().sum();
        if total > MOST_SHARES * balls.len() + FREE_SHARES {
            return Err(TOO_SMALL.to_owned());
        }
        let mut end = 0;
        let mut starts = Vec::with_capacity(counts.len());
        for (key, count) in &mut counts {
            starts.push((*key, end));
            end += std::mem::replace(count, end);
        }
        let mut sorted = vec![0; end];
        for (number, span) in (0..).zip(&spans) {
            visit_blocks(span, |key| {
                if let Some(next) = counts.get_mut(&key) {
                    sorted[*next] = number;
                    *next += 1;
                }
            });
        }
        Ok(Self {
            pitch,
            starts,
            balls: sorted,
        })
    }

    /// The number of blocks.
    pub fn count(&self) -> usize {
        self.starts.len()
    }

    /// The surfaces in a block, with the bodies that they are of.
    pub fn triangles(&self, all: &[Ball], block: usize) -> Vec<(u32, Triangle)> {
        let (key, first) = self.starts[block];
        let end = self
            .starts
            .get(block + 1)
            .map_or(self.balls.len(), |next| next.1);
        let coordinates = self.coordinates(key);
        let mut fills: BTreeMap<u32, Vec<Fill>> = BTreeMap::new();
        for &number in &self.balls[first..end] {
            let ball = &all[number as usize];
            let nodes = || vec![Fill::default(); NODES * NODES * NODES];
            add(
                ball,
                &coordinates,
                fills.entry(ball.body).or_insert_with(nodes),
            );
        }
        let (bodies, fills): (Vec<u32>, Vec<Vec<Fill>>) = fills.into_iter().unzip();
        let mut triangles = Vec::new();
        for (body, level) in bodies.into_iter().zip(levels(&fills)) {
            cut(&coordinates, &level, |triangle| {
                triangles.push((body, triangle));
            });
        }
        triangles
    }

    /// Coordinates of the nodes of a block: the same bits in all blocks that share one.
    fn coordinates(&self, key: [i32; 3]) -> Coordinates {
        key.map(|block| {
            let node = |n: usize| f64::from(block) * CELLS as f64 + n as f64;
            std::array::from_fn(|n| node(n) * self.pitch)
        })
    }
}

/// Cuts all cells of a block.
fn cut(coordinates: &Coordinates, level: &[f64], mut emit: impl FnMut(Triangle)) {
    let [x, y, z] = coordinates;
    for k in 0..CELLS {
        for j in 0..CELLS {
            for i in 0..CELLS {
                let mut corners = [0.0; 8];
                for (c, corner) in corners.iter_mut().enumerate() {
                    *corner = level[node(i + (c & 1), j + (c >> 1 & 1), k + (c >> 2))];
                }
                let cube = Cube {
                    low: [x[i], y[j], z[k]],
                    high: [x[i + 1], y[j + 1], z[k + 1]],
                    corners,
                };
                cubes::cut(&cube, &mut emit);
            }
        }
    }
}

/// The first and the last block along each axis that a ball reaches.
type Span = [[i32; 2]; 3];

fn span(ball: &Ball, pitch: f64) -> Option<Span> {
    let edge = pitch * CELLS as f64;
    let mut span = [[0; 2]; 3];
    let mut count = 1.0;
    for (axis, span) in span.iter_mut().enumerate() {
        let (x, reach) = (ball.centre[axis], ball.shape.reach(axis));
        // A cell more on both sides, so that each node in reach is inside whatever is rounded.
        let ends = [x - reach - pitch, x + reach + pitch].map(|x| (x / edge).floor());
        if !ends.iter().all(|end| end.abs() < FARTHEST) {
            return None;
        }
        count *= ends[1] - ends[0] + 1.0;
        #[expect(clippy::cast_possible_truncation, reason = "whole and in range")]
        let ends = ends.map(|end| end as i32);
        *span = ends;
    }
    (count <= MOST_BLOCKS).then_some(span)
}

fn visit_blocks(span: &Span, mut emit: impl FnMut([i32; 3])) {
    let [x, y, z] = span.map(|[first, last]| first..=last);
    for i in x {
        for j in y.clone() {
            for k in z.clone() {
                emit([i, j, k]);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use plot::Shape;

    fn lattice(body: u32, first: usize) -> impl Iterator<Item = Ball> {
        (0..8 * 8 * 6).map(move |n| Ball {
            centre: [n % 8, n / 8 % 8, first + n / 64].map(|k| 1e-3 * k as f64),
            shape: Shape::ball(1e-3),
            body,
        })
    }

    fn all(balls: &[Ball], pitch: f64) -> Vec<(u32, Triangle)> {
        let blocks = Blocks::new(balls, pitch).unwrap();
        let triangles = (0..blocks.count()).flat_map(|block| blocks.triangles(balls, block));
        triangles.collect()
    }

    /// Each side of a triangle belongs to one other, which goes the other way along it.
    #[test]
    fn surfaces_are_closed() {
        let mut balls: Vec<Ball> = lattice(0, 0).chain(lattice(1, 6)).collect();
        let mut state = 1_u32;
        let mut random = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            f64::from(state >> 8) / f64::from(1_u32 << 24)
        };
        for body in [0, 1, 2].into_iter().cycle().take(60) {
            balls.push(Ball {
                centre: [random(), random(), random()].map(|x| 0.012 * x - 0.002),
                shape: Shape::ball(1e-3 * (0.6 + 0.8 * random())),
                body,
            });
        }
        let mut sides: BTreeMap<_, [u32; 2]> = BTreeMap::new();
        for (body, triangle) in all(&balls, 5e-4) {
            let corners = triangle.map(|corner| corner.map(f64::to_bits));
            for k in 0..3 {
                let (from, to) = (corners[k], corners[(k + 1) % 3]);
                assert_ne!(from, to);
                let side = sides.entry((body, from.min(to), from.max(to)));
                side.or_default()[usize::from(from < to)] += 1;
            }
        }
        assert!(sides.len() > 10_000, "{}", sides.len());
        assert!(sides.values().all(|count| *count == [1, 1]));
    }

    /// As in pictures: half a spacing outside, or a little more; and bodies in touch share a face.
    #[test]
    fn faces_stand_where_pictures_draw_them() {
        let balls: Vec<Ball> = lattice(0, 0).chain(lattice(1, 6)).collect();
        for (body, triangle) in all(&balls, 5e-4) {
            let inner = |corner: &[f64; 3]| corner[..2].iter().all(|x| (2e-3..5e-3).contains(x));
            for corner in triangle.iter().filter(|corner| inner(corner)) {
                let height = 1e3 * corner[2];
                let outer = if body == 0 { -height } else { height - 11.0 };
                let shared = (height - 5.5).abs() < 6e-3;
                assert!(shared || (0.49..0.56).contains(&outer), "{body}: {height}");
            }
        }
    }

    #[test]
    fn cells_too_small_are_refused() {
        let balls: Vec<Ball> = lattice(0, 0).collect();
        assert!(Blocks::new(&balls, 1e-6).unwrap_err().contains("--cell"));
        assert!(Blocks::new(&balls, 1e-15).unwrap_err().contains("--cell"));
    }
}
