//! From the cells of a section to the pixels of a panel.

use std::cell::OnceCell;
use std::ops::Range;

use rayon::prelude::*;

use super::cells::{Cell, Sample, Tiles};
use super::view::View;
use crate::canvas::{Frame, PAPER, Rgb};
use crate::frame::whole;

/// Samples along either axis of a pixel at an edge: an odd number, so that one is in the middle.
const FINE: usize = 3;

/// Rows of pixels that one task draws.
const BAND: usize = 16;

/// Colour of the line about a body.
const OUTLINE: Rgb = [60, 60, 60];

/// The pixels of a panel.
#[derive(Debug)]
pub struct Raster {
    /// Colours row by row from the top.
    pub pixels: Vec<Rgb>,
    /// Numbers of the bodies that are seen, in ascending order.
    pub seen: Vec<usize>,
}

/// Fine samples of some rows of pixels, each taken when it is first wanted: pixels at edges share most of theirs.
struct FineSamples {
    /// Fine rows above.
    first: usize,
    columns: usize,
    taken: Vec<OnceCell<Option<Sample>>>,
}

/// A panel while it is drawn.
struct Panel<'a, C> {
    tiles: Tiles<'a>,
    view: View,
    /// Pixels in a row, and rows of pixels.
    size: [usize; 2],
    /// Reach of an outline beyond a body (samples).
    line: usize,
    colour: C,
}

impl Raster {
    /// Draws cells, which are in the order of their bodies, in the colours that `colour` gives,
    /// with outlines that reach beyond bodies by `line` (pixels).
    pub fn new(
        cells: &[Cell],
        view: View,
        frame: &Frame,
        line: f32,
        colour: impl Fn(&Sample) -> Rgb + Sync,
    ) -> Self {
        let [columns, rows] = frame.pixels();
        let panel = Panel {
            tiles: Tiles::new(cells, view, view.width() / columns as f64),
            view,
            size: [columns, rows],
            line: whole(line * FINE as f32),
            colour,
        };
        let bands: Vec<(Vec<Rgb>, Vec<usize>)> = (0..rows.div_ceil(BAND))
            .into_par_iter()
            .map(|band| panel.band(band * BAND..rows.min((band + 1) * BAND)))
            .collect();
        let mut raster = Self {
            pixels: Vec::with_capacity(columns * rows),
            seen: Vec::new(),
        };
        for (pixels, seen) in bands {
            raster.pixels.extend(pixels);
            raster.seen.extend(seen);
        }
        raster.seen.sort_unstable();
        raster.seen.dedup();
        raster
    }
}

impl<C: Fn(&Sample) -> Rgb> Panel<'_, C> {
    /// The pixels of some rows, and the bodies in them. One sample does for a pixel far from edges.
    fn band(&self, rows: Range<usize>) -> (Vec<Rgb>, Vec<usize>) {
        let [columns, height] = self.size;
        // A sample of the line about a pixel may lie in the one beside that of its middle.
        let margin = (self.line + FINE / 2).div_ceil(FINE);
        let first = rows.start.saturating_sub(margin);
        let end = height.min(rows.end + margin);
        let middles: Vec<Option<Sample>> = (first..end)
            .flat_map(|y| (0..columns).map(move |x| (x, y)))
            .map(|(x, y)| self.sample(FINE * x + FINE / 2, FINE * y + FINE / 2))
            .collect();
        let mut seen: Vec<usize> = middles.iter().flatten().map(|s| s.body).collect();
        seen.sort_unstable();
        seen.dedup();
        let middle = |x: usize, y: usize| middles[(y - first) * columns + x];
        let even = |x: usize, y: usize| {
            let own = middle(x, y).map(|s| s.body);
            let xs = x.saturating_sub(margin)..columns.min(x + margin + 1);
            let mut ys = y.saturating_sub(margin).max(first)..end.min(y + margin + 1);
            ys.all(|y| xs.clone().all(|x| middle(x, y).map(|s| s.body) == own))
        };
        let mut pixels = Vec::with_capacity(rows.len() * columns);
        let fine = FineSamples {
            first: FINE * first,
            columns: FINE * columns,
            taken: vec![OnceCell::new(); FINE * FINE * (end - first) * columns],
        };
        for y in rows {
            for x in 0..columns {
                pixels.push(if even(x, y) {
                    self.colour(middle(x, y))
                } else {
                    self.edge(x, y, &fine)
                });
            }
        }
        (pixels, seen)
    }

    /// A pixel near the edge of a body, with what is there of the line about it.
    fn edge(&self, x: usize, y: usize, fine: &FineSamples) -> Rgb {
        let wide = FINE + 2 * self.line;
        let shifted = |k: usize, pixel: usize, count: usize| {
            (FINE * pixel + k)
                .saturating_sub(self.line)
                .min(FINE * count - 1)
        };
        let samples: Vec<Option<Sample>> = (0..wide * wide)
            .map(|k| {
                let column = shifted(k % wide, x, self.size[0]);
                let row = shifted(k / wide, y, self.size[1]);
                let taken = &fine.taken[(row - fine.first) * fine.columns + column];
                *taken.get_or_init(|| self.sample(column, row))
            })
            .collect();
        let mut sum = [0; 3];
        for k in 0..FINE * FINE {
            let middle = (self.line + k / FINE) * wide + self.line + k % FINE;
            let body = samples[middle].map(|s| s.body);
            let along = [middle - self.line, middle + self.line];
            let across = [middle - self.line * wide, middle + self.line * wide];
            let mut beside = along.into_iter().chain(across).filter_map(|k| samples[k]);
            let fine = if beside.any(|other| Some(other.body) != body) {
                OUTLINE
            } else {
                self.colour(samples[middle])
            };
            for (sum, part) in sum.iter_mut().zip(fine) {
                *sum += usize::from(part);
            }
        }
        sum.map(mean)
    }

    fn colour(&self, sample: Option<Sample>) -> Rgb {
        sample.map_or(PAPER, |sample| (self.colour)(&sample))
    }

    /// The sample at a fine sample, counted from the upper left corner.
    fn sample(&self, x: usize, y: usize) -> Option<Sample> {
        let share = |k: usize, count: usize| (k as f64 + 0.5) / (FINE * count) as f64;
        self.tiles.sample([
            self.view.x[0] + self.view.width() * share(x, self.size[0]),
            self.view.y[1] - self.view.height() * share(y, self.size[1]),
        ])
    }
}

/// The mean of the samples of a pixel from their sum.
fn mean(sum: usize) -> u8 {
    let count = FINE * FINE;
    u8::try_from((sum + count / 2) / count).unwrap_or(u8::MAX)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::snapshots::shape::Shape;

    const FRAME: Frame = Frame {
        left: 0.0,
        top: 0.0,
        width: 120.0,
        height: 120.0,
    };
    const VIEW: View = View {
        x: [0.0, 12.0],
        y: [0.0, 12.0],
    };

    fn square(origin: [f64; 2], body: usize) -> impl Iterator<Item = Cell> {
        (0..16).map(move |k| Cell {
            at: [
                origin[0] + f64::from(k % 4) + 0.5,
                origin[1] + f64::from(k / 4) + 0.5,
            ],
            depth: 0.0,
            shape: Shape::ball(1.0),
            body,
            value: None,
        })
    }

    fn draw(cells: &[Cell]) -> Raster {
        Raster::new(cells, VIEW, &FRAME, 1.0, |sample| {
            [200, 0, u8::try_from(sample.body).unwrap()]
        })
    }

    fn count(raster: &Raster, wanted: Rgb) -> usize {
        raster.pixels.iter().filter(|&&p| p == wanted).count()
    }

    #[test]
    fn a_block_has_its_area_and_an_outline() {
        let cells: Vec<Cell> = square([4.0, 4.0], 3).collect();
        let raster = draw(&cells);
        assert_eq!(raster.seen, [3]);
        let area = count(&raster, [200, 0, 3]);
        // Forty pixels wide, rounded corners, edges of up to half a pixel.
        assert!((1480..1720).contains(&area), "{area}");
        // From the paper through the line into the block.
        let row = &raster.pixels[60 * 120..61 * 120];
        let dark = row.iter().filter(|p| p[0] < 150).count();
        assert_eq!(dark, 2, "one pixel on either side");
        assert_eq!((row[20], row[60]), (PAPER, [200, 0, 3]));
    }

    #[test]
    fn bodies_in_touch_are_parted_by_a_line_alone() {
        let cells: Vec<Cell> = square([2.0, 4.0], 0).chain(square([6.0, 4.0], 1)).collect();
        let raster = draw(&cells);
        assert_eq!(raster.seen, [0, 1]);
        let row = &raster.pixels[60 * 120 + 22..60 * 120 + 98];
        assert!(row.iter().all(|p| p[1] < 100), "no paper between them");
        assert!(row.iter().filter(|p| p[0] < 150).count() <= 2);
    }

    #[test]
    fn bands_fit_together() {
        let cells: Vec<Cell> = square([1.0, 1.3], 0).collect();
        let raster = draw(&cells);
        for row in 70..100 {
            assert_eq!(raster.pixels[row * 120 + 30], [200, 0, 0], "row {row}");
        }
    }
}
