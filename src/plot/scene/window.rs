//! The part of the picture's plane that is drawn, in samples from its middle.

use super::cut::Slope;
use crate::picture::view::View;

/// The samples of a panel. Places are counted in samples from its middle, to the right, down and
/// towards the viewer, so that what is symmetric stays so to the last bit.
#[derive(Debug, Clone)]
pub struct Window {
    /// Samples in a row.
    pub columns: usize,
    /// Rows of samples.
    pub rows: usize,
    /// The point in its middle (m).
    middle: [f64; 3],
    /// Samples per metre.
    scale: f64,
    /// Wedges of planes, each as a level towards the viewer and how it changes to the right and down.
    wedges: Vec<Vec<Level>>,
    /// Steepest slope of them.
    steepest: f32,
}

/// A plane over the window.
#[derive(Debug, Clone, Copy)]
struct Level {
    at_middle: f32,
    along: [f32; 2],
    normal: [f32; 3],
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "samples need no more digits"
)]
impl Window {
    /// A panel of columns and rows that shows a part of the plane; `depth` (m) is about what is
    /// drawn, and slopes are cuts.
    pub fn new(
        [columns, rows]: [usize; 2],
        view: &View,
        depth: f64,
        slopes: &[Vec<Slope>],
    ) -> Self {
        let middle = [
            0.5 * (view.x[0] + view.x[1]),
            0.5 * (view.y[0] + view.y[1]),
            depth,
        ];
        let scale = columns as f64 / view.width();
        let level = |slope: &Slope| {
            let [a, b] = slope.along;
            let at_middle = slope.at_middle + a * middle[0] + b * middle[1] - middle[2];
            Level {
                at_middle: (at_middle * scale) as f32,
                along: [a as f32, -b as f32],
                normal: slope.normal.map(|n| n as f32),
            }
        };
        let wedges: Vec<Vec<Level>> = slopes
            .iter()
            .map(|wedge| wedge.iter().map(level).collect())
            .collect();
        let steepness = |level: &Level| level.along[0].hypot(level.along[1]);
        let steepest = wedges.iter().flatten().map(steepness).fold(0.0, f32::max);
        Self {
            columns,
            rows,
            middle,
            scale,
            wedges,
            steepest,
        }
    }

    /// A projected place (m) in samples.
    pub fn to_samples(&self, [right, up, towards]: [f64; 3]) -> [f32; 3] {
        [
            ((right - self.middle[0]) * self.scale) as f32,
            ((self.middle[1] - up) * self.scale) as f32,
            ((towards - self.middle[2]) * self.scale) as f32,
        ]
    }

    /// A length (m) in samples.
    pub fn length(&self, length: f64) -> f32 {
        (length * self.scale) as f32
    }

    /// The middle of a sample.
    pub fn sample(&self, column: usize, row: usize) -> [f32; 2] {
        let from_middle = |k: usize, count: usize| k as f32 + 0.5 - 0.5 * count as f32;
        [
            from_middle(column, self.columns),
            from_middle(row, self.rows),
        ]
    }

    /// The distance to the viewer at a point beyond which all is cut away.
    pub fn limit(&self, [x, y]: [f32; 2]) -> f32 {
        let level = |level: &Level| level.at_middle + level.along[0] * x + level.along[1] * y;
        let wedge = |wedge: &Vec<Level>| wedge.iter().map(level).fold(f32::NEG_INFINITY, f32::max);
        self.wedges.iter().map(wedge).fold(f32::INFINITY, f32::min)
    }

    /// By how much the limit changes over a distance at most.
    pub fn change(&self, distance: f32) -> f32 {
        self.steepest * distance
    }

    /// The normal of the plane that limits a place: to the right, up, towards the viewer.
    pub fn limiting(&self, [x, y]: [f32; 2]) -> [f32; 3] {
        let level = |level: &&Level| level.at_middle + level.along[0] * x + level.along[1] * y;
        let highest = |wedge: &'_ Vec<Level>| {
            let planes = wedge.iter();
            let highest = planes.max_by(|a, b| level(a).total_cmp(&level(b)));
            highest.copied()
        };
        let planes = self.wedges.iter().filter_map(highest);
        let lowest = planes.min_by(|a, b| level(&a).total_cmp(&level(&b)));
        lowest.map_or([0.0, 0.0, 1.0], |level| level.normal)
    }
}
