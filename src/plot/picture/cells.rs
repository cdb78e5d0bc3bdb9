//! The bodies that particles fill, and their fields, at every point.
//!
//! Particles fill places as [their shapes](crate::snapshots::shape) say.
//!
//! Bodies are separate: the one with the largest sum fills the point, so that the line between two
//! bodies in touch is smooth, and a gap between them is not filled by both together.

use super::view::View;
use crate::snapshots::shape::{Fill, Shape};
use numerics::ellipsoid::square;

/// A particle near a plane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cell {
    /// Position along the picture's axes (m).
    pub at: [f64; 2],
    /// Distance from the plane along its normal (m).
    pub depth: f64,
    /// Its shape along the picture's axes and the normal.
    pub shape: Shape,
    /// Number of its body in the picture.
    pub body: usize,
    /// The drawn field in its own unit; none for rigid bodies.
    pub value: Option<f64>,
}

impl Cell {
    /// `true` if it counts for the plane: if that cuts the particle by itself, or is half-way
    /// between two layers, which may have come closer since their sizes were the distance.
    pub fn is_cut(&self) -> bool {
        self.depth.abs() <= 0.75 * self.shape.size(2)
    }

    /// Half its size along the picture's axes (m).
    pub fn radii(&self) -> [f64; 2] {
        [0, 1].map(|axis| 0.5 * self.shape.size(axis))
    }
}

/// The body and field at a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sample {
    /// Number of the body in the picture.
    pub body: usize,
    /// The field: the mean of the body's particles by weight.
    pub value: Option<f64>,
}

/// The cells of a part of a plane, in tiles: each is in all tiles that its weight reaches.
#[derive(Debug)]
pub struct Tiles<'a> {
    cells: &'a [Cell],
    /// Of each cell: what measures distances from it in units of its size.
    metrics: Vec<[f64; 6]>,
    view: View,
    /// Edge of a tile (m).
    pitch: f64,
    columns: usize,
    /// The first entry of each tile, and the end of the last.
    starts: Vec<u32>,
    /// Indices of cells, body by body within a tile.
    entries: Vec<u32>,
}

impl<'a> Tiles<'a> {
    /// Sorts cells, which are in the order of their bodies, into tiles of a view; none is smaller
    /// than `finest` (m).
    pub fn new(cells: &'a [Cell], view: View, finest: f64) -> Self {
        let sizes = cells.iter().map(|cell| cell.shape.size(0));
        let mean = sizes.sum::<f64>() / cells.len().max(1) as f64;
        let pitch = (1.5 * mean).max(finest);
        let mut tiles = Self {
            cells,
            metrics: cells
                .iter()
                .map(|cell| cell.shape.ellipsoid.metric())
                .collect(),
            view,
            pitch,
            columns: count(view.width() / pitch),
            starts: Vec::new(),
            entries: Vec::new(),
        };
        let rows = count(view.height() / pitch);
        let mut starts = vec![0_u32; tiles.columns * rows + 1];
        tiles.visit(rows, |_, tile| starts[tile + 1] += 1);
        for tile in 1..starts.len() {
            starts[tile] += starts[tile - 1];
        }
        let mut entries = vec![0; starts[starts.len() - 1] as usize];
        let mut next = starts.clone();
        tiles.visit(rows, |cell, tile| {
            entries[next[tile] as usize] = cell;
            next[tile] += 1;
        });
        (tiles.starts, tiles.entries) = (starts, entries);
        tiles
    }

    /// Calls `each` with every cell and every tile of `rows` rows that it reaches.
    fn visit(&self, rows: usize, mut each: impl FnMut(u32, usize)) {
        for (index, cell) in (0..).zip(self.cells) {
            let span = |axis: usize, low: f64, most: usize| {
                let (at, reach) = (cell.at[axis], cell.shape.reach(axis));
                let first = ((at - reach - low) / self.pitch).floor().max(0.0);
                let last = ((at + reach - low) / self.pitch)
                    .floor()
                    .min(most as f64 - 1.0);
                (first <= last).then(|| tile(first)..=tile(last))
            };
            let xs = span(0, self.view.x[0], self.columns);
            let ys = span(1, self.view.y[0], rows);
            let (Some(xs), Some(ys)) = (xs, ys) else {
                continue;
            };
            for row in ys {
                for column in xs.clone() {
                    each(index, row * self.columns + column);
                }
            }
        }
    }

    /// The sample at a point of the view, if a body fills it.
    pub fn sample(&self, at: [f64; 2]) -> Option<Sample> {
        let column = tile((at[0] - self.view.x[0]) / self.pitch).min(self.columns - 1);
        let row = tile((at[1] - self.view.y[0]) / self.pitch);
        let tile = (row * self.columns + column).min(self.starts.len() - 2);
        let mut entries = &self.entries[self.starts[tile] as usize..self.starts[tile + 1] as usize];
        let mut best = (1.0, None);
        while let Some(&first) = entries.first() {
            let body = self.cells[first as usize].body;
            let same = |&&k: &&u32| self.cells[k as usize].body == body;
            let (own, rest) = entries.split_at(entries.iter().take_while(same).count());
            let (sum, value) = self.fill(own, at);
            if sum >= best.0 {
                best = (sum, Some(Sample { body, value }));
            }
            entries = rest;
        }
        best.1
    }

    /// The sum of weights of some cells of one body at a place, and their mean field. It is no
    /// number where that of the nearest is none; others without a number have no part in it.
    fn fill(&self, entries: &[u32], at: [f64; 2]) -> (f64, Option<f64>) {
        let mut fill = Fill::default();
        let (mut sum, mut share) = (0.0, 0.0);
        let mut nearest = (f64::INFINITY, None);
        for &k in entries {
            let cell = &self.cells[k as usize];
            let from = [at[0] - cell.at[0], at[1] - cell.at[1], -cell.depth];
            let distance = square(&self.metrics[k as usize], &from);
            let w = fill.add(&cell.shape, distance);
            if distance < nearest.0 {
                nearest = (distance, cell.value);
            }
            if let Some(value) = cell.value.filter(|value| value.is_finite()) {
                sum += w * value;
                share += w;
            }
        }
        let value = nearest.1.map(|own| {
            if own.is_finite() && share > 0.0 {
                sum / share
            } else {
                own
            }
        });
        (fill.level(), value)
    }
}

/// A number of tiles that covers so many pitches.
fn count(pitches: f64) -> usize {
    tile(pitches.ceil()).clamp(1, 1 << 15)
}

/// A place among tiles.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a float cast saturates; bounds are the caller's"
)]
fn tile(pitches: f64) -> usize {
    pitches as usize
}

#[cfg(test)]
mod tests {
    use super::*;

    const VIEW: View = View {
        x: [-6.0, 6.0],
        y: [-6.0, 6.0],
    };

    fn cell(at: [f64; 2], depth: f64, body: usize) -> Cell {
        Cell {
            at,
            depth,
            shape: Shape::ball(1.0),
            body,
            value: Some(at[0]),
        }
    }

    /// A cubic lattice of 8 × 8 × 8 (or 8 × 8 in the plane itself) about the middle, `shift` from
    /// the plane.
    fn block(flat: bool, shift: f64) -> Vec<Cell> {
        let mut cells = Vec::new();
        let at = |k: i32| f64::from(k) - 3.5;
        for i in 0..8 {
            for j in 0..8 {
                for k in 0..if flat { 1 } else { 8 } {
                    let depth = if flat { 0.0 } else { at(k) + shift };
                    if depth.abs() < Shape::ball(1.0).reach(2) {
                        cells.push(cell([at(i), at(j)], depth, 0));
                    }
                }
            }
        }
        cells
    }

    /// The surface along a ray to the right.
    fn surface(tiles: &Tiles, y: f64) -> f64 {
        let inside = |x: &f64| tiles.sample([*x, y]).is_some();
        (0..6000)
            .map(|k| f64::from(k) * 1e-3)
            .rfind(inside)
            .unwrap()
    }

    /// Matter without order has no holes, and a gap as wide as a particle stays.
    #[test]
    fn glass_is_solid() {
        let mut random = 1_u32;
        let mut shift = || {
            random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            0.6 * (f64::from(random >> 16) / 65_536.0 - 0.5)
        };
        let mut cells = Vec::new();
        for k in 0..10 * 10 * 4 {
            let at = |n: i32, middle: f64| f64::from(n) - middle;
            let [x, y, z] = [at(k % 10, 4.5), at(k / 10 % 10, 4.5), at(k / 100, 1.5)];
            let apart = if x > 0.0 { 1.6 } else { 0.0 };
            let place = [x + apart + shift(), y + shift()];
            cells.push(cell(place, z + shift(), 0));
        }
        let holes = |cells: &[Cell]| {
            let tiles = Tiles::new(cells, VIEW, 0.01);
            let places = (0..2000).map(|k| {
                [
                    -3.5 + 0.05 * f64::from(k % 50),
                    -3.0 + 0.15 * f64::from(k / 50),
                ]
            });
            places.filter(|at| tiles.sample(*at).is_none()).count()
        };
        let gap = |cells: &[Cell]| {
            let tiles = Tiles::new(cells, VIEW, 0.01);
            (-60..60).all(|k| tiles.sample([0.8, 0.05 * f64::from(k)]).is_none())
        };
        assert!(holes(&cells) > 0, "balls leave holes");
        for cell in &mut cells {
            cell.shape = Shape::dense(1.0, 3);
        }
        assert_eq!(holes(&cells), 0);
        assert!(gap(&cells));
    }

    #[test]
    fn a_free_surface_is_half_a_spacing_outside() {
        for (flat, shift) in [(true, 0.0), (false, 0.0), (false, 0.25), (false, 0.5)] {
            let cells = block(flat, shift);
            let tiles = Tiles::new(&cells, VIEW, 0.01);
            for k in 0..20 {
                let x = surface(&tiles, f64::from(k) * 0.1 - 1.0);
                assert!((0.49..0.56).contains(&(x - 3.5)), "{flat} {shift}: {x}");
            }
        }
    }

    #[test]
    fn a_lone_particle_is_a_ball_of_its_size() {
        for size in [0.5, 1.0, 2.0] {
            let cells = [Cell {
                shape: Shape::ball(size),
                ..cell([0.0; 2], 0.0, 0)
            }];
            let tiles = Tiles::new(&cells, VIEW, 0.01);
            assert!(tiles.sample([0.499 * size, 0.0]).is_some());
            assert!(tiles.sample([0.0, 0.501 * size]).is_none());
        }
    }

    /// A block stretched to two and a half times its length, squeezed to two fifths of its thickness and sheared has
    /// neither gaps nor another surface than its own.
    #[test]
    fn what_is_stretched_and_sheared_has_no_gaps() {
        let gradient = [2.5, 0.6, 0.3, 0.0, 1.0, 0.5, 0.0, 0.0, 0.4];
        let image = |at: [f64; 3]| {
            [0, 1, 2].map(|a| (0..3).map(|b| gradient[3 * a + b] * at[b]).sum::<f64>())
        };
        let shape = Shape::image(1.0, &gradient, 3).unwrap();
        for shift in [0.0, 0.2, 0.5] {
            let mut cells = Vec::new();
            for k in 0..512 {
                let at = [k % 8, k / 8 % 8, k / 64].map(|k| f64::from(k) - 3.5);
                let [x, y, z] = image([at[0], at[1], at[2] + shift]);
                cells.push(Cell {
                    shape,
                    ..cell([x, y], z, 0)
                });
            }
            let wide = View {
                x: [-12.0, 12.0],
                y: [-6.0, 6.0],
            };
            let tiles = Tiles::new(&cells, wide, 0.01);
            for k in 0..=100 {
                for l in 0..=100 {
                    let [a, b] = [k, l].map(|k| f64::from(k) * 0.1 - 5.0);
                    let [x, y, _] = image([a, b, 0.0]);
                    let outside = a.abs().max(b.abs()) - 4.0;
                    let is_corner = a.abs().min(b.abs()) > 3.05;
                    if outside.abs() > 0.06 && !is_corner {
                        assert_eq!(tiles.sample([x, y]).is_some(), outside < 0.0, "{a} {b}");
                    }
                }
            }
        }
    }

    /// Disorder leaves holes between balls, but not in a body that has not torn; its surface stays.
    #[test]
    fn disorder_without_tears_is_solid() {
        let unit = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
        let whole = Shape::image(1.0, &unit, 3).unwrap();
        for (shape, solid) in [(whole, true), (Shape::ball(1.0), false)] {
            let mut seed = 1_u32;
            let mut cells = Vec::new();
            for k in 0..1000 {
                let [x, y, z] = [k % 10, k / 10 % 10, k / 100].map(|k: i32| {
                    seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                    f64::from(k) - 4.5 + 0.8 * (f64::from(seed >> 8) / f64::from(1 << 24) - 0.5)
                });
                cells.push(Cell {
                    shape,
                    ..cell([x, y], z, 0)
                });
            }
            let tiles = Tiles::new(&cells, VIEW, 0.01);
            let mut holes = 0;
            for k in 0..=200 {
                for l in 0..=200 {
                    let at = [k, l].map(|k| f64::from(k) * 0.06 - 6.0);
                    let outside = at[0].abs().max(at[1].abs()) - 5.0;
                    let is_filled = tiles.sample(at).is_some();
                    holes += usize::from(outside < -0.5 && !is_filled);
                    assert!(outside < 0.55 || !is_filled, "{at:?}");
                }
            }
            assert_eq!(holes == 0, solid, "{holes}");
        }
    }

    #[test]
    fn bodies_in_touch_have_no_gap_and_one_apart_has() {
        let below = block(true, 0.0);
        for (gap, filled) in [(0.9, true), (1.0, true), (1.3, false)] {
            let mut cells = below.clone();
            cells.extend(
                below
                    .iter()
                    .map(|c| cell([c.at[0] + 0.3, c.at[1] + 7.0 + gap], 0.0, 1)),
            );
            let tiles = Tiles::new(
                &cells,
                View {
                    x: [-6.0, 6.0],
                    y: [-6.0, 16.0],
                },
                0.01,
            );
            let middle = 3.5 + 0.5 * gap;
            for k in 0..100 {
                let x = f64::from(k) * 0.06 - 3.0;
                assert_eq!(tiles.sample([x, middle]).is_some(), filled, "{gap} at {x}");
                assert_eq!(tiles.sample([x, middle - 0.4]).unwrap().body, 0);
                assert_eq!(tiles.sample([x, middle + 0.4]).unwrap().body, 1);
            }
        }
    }

    #[test]
    fn a_field_is_smooth_within_a_body_and_ends_with_it() {
        let mut cells = block(true, 0.0);
        cells.extend(block(true, 0.0).iter().map(|c| Cell {
            value: Some(100.0),
            ..cell([c.at[0], c.at[1] + 8.0], 0.0, 1)
        }));
        let tiles = Tiles::new(&cells, VIEW, 0.01);
        let value = |x: f64, y: f64| tiles.sample([x, y]).unwrap().value.unwrap();
        let mut last = value(-3.0, 0.3);
        for k in 1..600 {
            let x = f64::from(k) * 0.01 - 3.0;
            let next = value(x, 0.3);
            assert!(
                (next - x).abs() < 0.15 && (next - last).abs() < 0.03,
                "{x}: {next}"
            );
            last = next;
        }
        assert!(value(0.0, 3.9) < 1.0 && value(0.0, 4.1) == 100.0);
    }

    #[test]
    fn what_is_no_number_stays_where_it_is() {
        let mut cells = block(true, 0.0);
        cells[20].value = Some(f64::NAN);
        let [x, y] = cells[20].at;
        let tiles = Tiles::new(&cells, VIEW, 0.01);
        let value = |x: f64| tiles.sample([x, y]).unwrap().value.unwrap();
        assert!(value(x + 0.45).is_nan() && value(x + 0.55).is_finite());
    }
}
