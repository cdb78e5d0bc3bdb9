//! Ambient occlusion: surroundings of a sample keep light away.
//!
//! About each sample others are looked at within a disc. One that rises over the surface takes
//! light by the cosine of its direction from the normal, less the farther it is (after Bavoil &
//! Sainz, 2009, and `McGuire` et al., 2012). The samples of a pixel look at different points, which
//! are the same for each pixel, so that their mean is smooth, and each picture of a movie has the
//! same pattern.

use rayon::prelude::*;

use super::buffer::{NOBODY, Seen};
use super::window::Window;

/// Places that the samples of a pixel look at, about.
const PLACES: usize = 48;

/// Turn from one place to the next (radians): the golden angle, which fills a disc evenly.
const TURN: f32 = 2.399_963_2;

/// Cosine below which what rises over a surface is a part of it.
const FLAT: f32 = 0.12;

/// The share of the light that goes where all is taken.
const STRENGTH: f32 = 2.1;

/// The open share of each sample, 0 to 1, row by row, of what is within a radius (samples); a pixel is
/// a square of `fine` samples a side.
pub fn openness(seen: &[Seen], window: &Window, fine: usize, radius: f32) -> Vec<f32> {
    let depths: Vec<f32> = seen.par_iter().map(|seen| seen.depth).collect();
    let patterns = patterns(fine, radius);
    let columns = window.columns;
    let mut open = vec![1.0; seen.len()];
    open.par_chunks_mut(columns)
        .enumerate()
        .for_each(|(row, open)| {
            for (column, open) in open.iter_mut().enumerate() {
                let own = &seen[row * columns + column];
                if own.body == NOBODY {
                    continue;
                }
                let pattern = &patterns[fine * (row % fine) + column % fine];
                let near = Near {
                    depths: &depths,
                    columns,
                    rows: window.rows,
                    radius,
                };
                *open = near.open(own, [column, row], pattern);
            }
        });
    open
}

/// The depths about a sample.
struct Near<'a> {
    depths: &'a [f32],
    columns: usize,
    rows: usize,
    radius: f32,
}

impl Near<'_> {
    fn open(&self, own: &Seen, [column, row]: [usize; 2], pattern: &[[isize; 2]]) -> f32 {
        let normal = own.normal();
        let mut taken = 0.0;
        for &[dx, dy] in pattern {
            let (Some(x), Some(y)) = (column.checked_add_signed(dx), row.checked_add_signed(dy))
            else {
                continue;
            };
            if x >= self.columns || y >= self.rows {
                continue;
            }
            let rise = self.depths[y * self.columns + x] - own.depth;
            let (right, up) = (dx as f32, -dy as f32);
            let squared = right * right + up * up + rise * rise;
            let over = right * normal[0] + up * normal[1] + rise * normal[2];
            // Empty samples are infinitely far down.
            if over <= 0.0 {
                continue;
            }
            let cosine = over / squared.sqrt();
            let fade = 1.0 - squared / (self.radius * self.radius);
            if cosine > FLAT && fade > 0.0 {
                taken += (cosine - FLAT) * fade;
            }
        }
        (1.0 - STRENGTH * taken / pattern.len() as f32).max(0.0)
    }
}

/// Places about a sample, nearer ones denser; the patterns share the directions among them.
#[expect(
    clippy::cast_possible_truncation,
    reason = "a place is a whole number of samples"
)]
fn patterns(fine: usize, radius: f32) -> Vec<Vec<[isize; 2]>> {
    let count = fine * fine;
    let all = PLACES.next_multiple_of(count);
    let offset = |k: usize| {
        let share = (k as f32 + 0.5) / all as f32;
        let (reach, angle) = (1.0 + (radius - 1.0) * share.powf(1.5), TURN * k as f32);
        let whole = |length: f32| length.round() as isize;
        [whole(reach * angle.cos()), whole(reach * angle.sin())]
    };
    let pattern = |first: usize| (first..all).step_by(count).map(offset).collect();
    (0..count).map(pattern).collect()
}
