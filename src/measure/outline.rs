//! The outline of debris, seen from the side.

use super::flight::View;
use super::mask::Mask;
use crate::comm::Comm;

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

/// The largest part of the debris, seen from the side, that has the areal mass of the outline.
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
    let cell = debris.spacing.max(length / CELLS).max(least);
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "positive, and cut"
    )]
    let count = |size: f64| (size / cell).ceil().clamp(1.0, 4.0 * CELLS) as usize;
    let (rows, half) = (count(length), count(radius));
    let across = 2 * half;
    // Whole numbers of 2⁻³⁰ of what makes the outline.
    let full = debris.outline * cell * cell;
    let scale = f64::from(1 << 30);
    let counts = view.matter.counts(comm, rows * across, |i, counts| {
        if !view.is_debris[i] {
            return;
        }
        #[expect(clippy::cast_possible_truncation, reason = "some particles in a cell")]
        let share = (view.matter.mass[i] / full * scale).round() as i64;
        for flight in view.flights(i) {
            let at = [
                (flight.height - heights[0]) / cell,
                flight.across[0] / cell + f64::from(u32::try_from(half).unwrap_or(u32::MAX)),
            ];
            #[expect(clippy::cast_precision_loss, reason = "small")]
            let inside =
                at[0] >= 0.0 && at[0] < rows as f64 && at[1] >= 0.0 && at[1] < across as f64;
            if inside {
                #[expect(
                    clippy::cast_possible_truncation,
                    clippy::cast_sign_loss,
                    reason = "inside"
                )]
                let [row, column] = at.map(|at| at as usize);
                counts[row * across + column] += share;
            }
        }
    });
    #[expect(clippy::cast_precision_loss, reason = "rounded once")]
    let cells = counts.iter().map(|&count| count as f64 >= scale).collect();
    let part = Mask::new([rows, across], cells).largest_part();
    let (mut lower, mut upper) = ([usize::MAX; 2], [0; 2]);
    for found in part.cells() {
        for (a, at) in [found / across, found % across].into_iter().enumerate() {
            lower[a] = lower[a].min(at);
            upper[a] = upper[a].max(at + 1);
        }
    }
    #[expect(clippy::cast_precision_loss, reason = "small")]
    let [length, width] = std::array::from_fn(|a| upper[a].saturating_sub(lower[a]) as f64 * cell);
    Outline {
        length,
        width,
        cell,
    }
}
