//! The outline of debris, seen from the side.

use super::flight::View;
use super::mask::Mask;
use comm::Comm;
use numerics::vector::dot;

/// Most cells of the outline along the flight.
const CELLS: f64 = 192.0;

/// Particles that make a cell of the outline.
const LEAST: f64 = 2.0;

/// Length and width (m) of the outline, and its cell.
pub struct Outline {
    pub length: f64,
    pub width: f64,
    pub cell: f64,
}

/// Cells along the flight and across it, of a cloud that begins at a height (m).
struct Cells {
    begin: f64,
    edge: f64,
    rows: usize,
    /// Cells to one side of the axis.
    half: usize,
}

impl Cells {
    /// The cell of a height and a place across (m).
    fn at(&self, height: f64, across: f64) -> Option<usize> {
        #[expect(clippy::cast_precision_loss, reason = "counts are small")]
        let [rows, half] = [self.rows, self.half].map(|count| count as f64);
        let row = (height - self.begin) / self.edge;
        let column = across / self.edge + half;
        let inside = row >= 0.0 && row < rows && column >= 0.0 && column < 2.0 * half;
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "inside"
        )]
        let cell = || row as usize * 2 * self.half + column as usize;
        inside.then(cell)
    }
}

/// Extents of where the debris, seen from the side, has the areal mass of the outline: between two
/// heights and as far from the axis as a radius (m), of particles of a mean mass (kg).
pub fn outline(
    view: &View,
    comm: &Comm,
    heights: [f64; 2],
    radius: f64,
    mass_of_one: f64,
) -> Outline {
    let debris = view.debris;
    let length = heights[1] - heights[0];
    let least = (LEAST * mass_of_one / debris.outline).sqrt();
    let edge = debris.spacing.max(length / CELLS).max(least);
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "positive, and cut"
    )]
    let count = |size: f64| (size / edge).ceil().clamp(1.0, 4.0 * CELLS) as usize;
    let cells = Cells {
        begin: heights[0],
        edge,
        rows: count(length),
        half: count(radius),
    };
    let across = 2 * cells.half;
    let base = dot(&debris.direction, &debris.point);
    // Whole numbers of 2⁻³⁰ of what makes the outline.
    let full = debris.outline * edge * edge;
    let scale = f64::from(1 << 30);
    let counts = view.matter.counts(comm, cells.rows * across, |i, counts| {
        if view.is_debris[i] {
            #[expect(clippy::cast_possible_truncation, reason = "some particles in a cell")]
            let share = (view.matter.mass[i] / full * scale).round() as i64;
            for (x, _) in view.matter.images(i) {
                let [u, _, along] = view.frame.turned(&x);
                if let Some(cell) = cells.at(along - base, u - view.axis[0]) {
                    counts[cell] += share;
                }
            }
        }
    });
    #[expect(clippy::cast_precision_loss, reason = "rounded once")]
    let seen = counts.iter().map(|&count| count as f64 >= scale).collect();
    let seen = Mask::new([cells.rows, across], seen);
    let (mut lower, mut upper) = ([usize::MAX; 2], [0; 2]);
    for found in seen.cells() {
        for (a, at) in [found / across, found % across].into_iter().enumerate() {
            lower[a] = lower[a].min(at);
            upper[a] = upper[a].max(at + 1);
        }
    }
    #[expect(clippy::cast_precision_loss, reason = "small")]
    let [length, width] = std::array::from_fn(|a| upper[a].saturating_sub(lower[a]) as f64 * edge);
    Outline {
        length,
        width,
        cell: edge,
    }
}
