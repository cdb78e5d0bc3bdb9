//! Cells of space with particles that do not rest.

use rayon::prelude::*;

use crate::domain::Span;
use numerics::collector::Collector;
use particles::neighbours::{Chunk, Lists};

/// Cells of space with particles that do not rest, kept from step to step.
#[derive(Debug, Default)]
pub(super) struct MovingCells {
    /// Edge (m).
    width: f64,
    /// Ascending.
    cells: Vec<[i64; 3]>,
    /// Smallest and largest indices.
    bounds: [[i64; 3]; 2],
    collector: Collector,
}

impl MovingCells {
    /// Finds the cells of a width (m).
    pub fn find(&mut self, lists: &Lists, width: f64) {
        self.width = width;
        self.cells.clear();
        let chunks = lists.chunks();
        self.collector
            .extend(&mut self.cells, (chunks.len(), 1), |k| {
                cells_of(&chunks[k], lists, width)
            });
        self.cells.par_sort_unstable();
        self.cells.dedup();
        self.bounds = [[i64::MAX; 3], [i64::MIN; 3]];
        let [least, most] = &mut self.bounds;
        for cell in &self.cells {
            for a in 0..3 {
                least[a] = least[a].min(cell[a]);
                most[a] = most[a].max(cell[a]);
            }
        }
    }

    /// Bytes allocated.
    pub fn memory(&self) -> usize {
        size_of::<[i64; 3]>() * self.cells.capacity() + self.collector.memory()
    }

    /// True if any of them is within so many widths of particles.
    pub fn is_near(&self, span: &Span, widths: f64) -> bool {
        let [lower, upper] = span.bounds();
        let cell = |x: f64, way: f64| index(x + way * widths * self.width, self.width);
        let least: [i64; 3] = std::array::from_fn(|a| cell(lower[a], -1.0).max(self.bounds[0][a]));
        let most: [i64; 3] = std::array::from_fn(|a| cell(upper[a], 1.0).min(self.bounds[1][a]));
        (least[0]..=most[0]).any(|x| {
            (least[1]..=most[1]).any(|y| {
                let first = [x, y, least[2]];
                let at = self.cells.partition_point(|cell| *cell < first);
                let next = self.cells.get(at);
                next.is_some_and(|next| *next <= [x, y, most[2]])
            })
        })
    }
}

#[allow(clippy::cast_possible_truncation, reason = "far cells are one")]
fn index(x: f64, width: f64) -> i64 {
    (x / width).floor() as i64
}

/// The cells of clusters of a chunk that do not rest, or rest while their body flies.
fn cells_of(chunk: &Chunk, lists: &Lists, width: f64) -> impl Iterator<Item = [i64; 3]> {
    let moving = chunk
        .iter()
        .filter(|(cluster, _, among)| !among.resting || !lists.is_still(cluster.group));
    // Clusters of a column stand in the same few cells.
    let (mut recent, mut next) = ([[i64::MAX; 3]; 16], 0);
    let cells = moving.flat_map(move |(cluster, ..)| {
        let along = |a: usize| index(cluster.lower[a], width)..=index(cluster.upper[a], width);
        let (y, z) = (along(1), along(2));
        along(0).flat_map(move |x| {
            let z = z.clone();
            y.clone()
                .flat_map(move |y| z.clone().map(move |z| [x, y, z]))
        })
    });
    cells.filter(move |cell| {
        let is_new = !recent.contains(cell);
        if is_new {
            recent[next] = *cell;
            next = (next + 1) % recent.len();
        }
        is_new
    })
}
