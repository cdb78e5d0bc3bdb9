//! Mass per area from particles.
//!
//! A particle of size s is spread by the product of two quadratic B-splines over a square of 3 s a
//! side; one that has been deformed has a size along each of the picture's axes. On a lattice of spacing s along the picture's axes they add up to one at every point, so
//! that bodies of even thickness are even in the picture. A pixel takes the integral over its own
//! area, so that none of the mass within the frame is lost, however small particles are.
//!
//! Bands of rows are summed side by side, each in the order of the particles: the same bits on any
//! number of threads.

use std::ops::Range;

use rayon::prelude::*;

use crate::picture::view::View;

/// Rows of pixels that one task sums.
const BAND: usize = 16;

/// Reach of a particle, in its own sizes.
pub const REACH: f64 = 1.5;

/// A particle on its way into a radiograph.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spot {
    /// Position: to the right and upwards (m).
    pub at: [f64; 2],
    /// Its size s along both (m).
    pub size: [f64; 2],
    /// kg.
    pub mass: f64,
}

/// Masses of the pixels of a panel.
#[derive(Debug, Clone)]
pub struct Masses {
    view: View,
    columns: usize,
    rows: usize,
    /// kg, row by row from the top.
    pub pixels: Vec<f64>,
}

impl Masses {
    /// A panel of columns and rows with nothing in it.
    pub fn new([columns, rows]: [usize; 2], view: View) -> Self {
        Self {
            view,
            columns,
            rows,
            pixels: vec![0.0; columns * rows],
        }
    }

    /// Area of a pixel (m²).
    pub fn area(&self) -> f64 {
        self.view.width() * self.view.height() / (self.columns * self.rows) as f64
    }

    /// Mass per area of the pixels (kg/m²).
    pub fn areal(&self) -> Vec<f64> {
        let area = self.area();
        self.pixels.iter().map(|mass| mass / area).collect()
    }

    /// Adds particles.
    pub fn add(&mut self, spots: &[Spot]) {
        let (view, columns, rows) = (self.view, self.columns, self.rows);
        let pitch = [view.width() / columns as f64, view.height() / rows as f64];
        // In pixels from the upper left corner.
        let in_pixels = |spot: &Spot| {
            [
                (spot.at[0] - view.x[0]) / pitch[0],
                (view.y[1] - spot.at[1]) / pitch[1],
            ]
        };
        let reach = |spot: &Spot, k: usize| REACH * spot.size[k] / pitch[k];
        let touched = |spot: &Spot| {
            let [x, y] = in_pixels(spot);
            let own = pixels(y, reach(spot, 1), rows);
            if own.is_empty() || pixels(x, reach(spot, 0), columns).is_empty() {
                0..0
            } else {
                own.start / BAND..own.end.div_ceil(BAND)
            }
        };
        let touched: Vec<Range<usize>> = spots.par_iter().map(touched).collect();
        let mut bands: Vec<Vec<usize>> = vec![Vec::new(); rows.div_ceil(BAND)];
        for (index, own) in touched.into_iter().enumerate() {
            for band in &mut bands[own] {
                band.push(index);
            }
        }
        let parts = self.pixels.par_chunks_mut(columns * BAND);
        parts.enumerate().for_each(|(band, part)| {
            let first = band * BAND;
            let mut shares = Vec::new();
            for &index in &bands[band] {
                let spot = &spots[index];
                let [x, y] = in_pixels(spot);
                let [wide, high] = [0, 1].map(|k| spot.size[k] / pitch[k]);
                let across = pixels(x, reach(spot, 0), columns);
                shares.clear();
                shares.extend(across.clone().map(|k| share(k, x, wide)));
                let down = pixels(y, reach(spot, 1), rows);
                let down = down.start.max(first)..down.end.min(first + BAND);
                for row in down {
                    let mass = spot.mass * share(row, y, high);
                    let line = &mut part[(row - first) * columns..][across.clone()];
                    for (pixel, share) in line.iter_mut().zip(&shares) {
                        *pixel += mass * share;
                    }
                }
            }
        });
    }
}

/// The pixels that something within a reach (pixels) of a place may touch.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "clamped to the panel"
)]
fn pixels(at: f64, reach: f64, count: usize) -> Range<usize> {
    let first = (at - reach).floor().clamp(0.0, count as f64) as usize;
    let end = (at + reach).ceil().clamp(0.0, count as f64) as usize;
    first..end.max(first)
}

/// The share of a particle of a size at a place (pixels) that falls into a pixel.
fn share(pixel: usize, at: f64, size: f64) -> f64 {
    let from = (pixel as f64 - at) / size;
    below(from + 1.0 / size) - below(from)
}

/// The integral of the quadratic B-spline of unit pitch from below up to a place.
fn below(t: f64) -> f64 {
    if t <= -1.5 {
        0.0
    } else if t < -0.5 {
        (t + 1.5).powi(3) / 6.0
    } else if t <= 0.5 {
        0.5 + 0.75 * t - t * t * t / 3.0
    } else if t < 1.5 {
        1.0 - (1.5 - t).powi(3) / 6.0
    } else {
        1.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const VIEW: View = View {
        x: [0.0, 10.0],
        y: [0.0, 5.0],
    };

    #[test]
    fn no_mass_within_the_frame_is_lost() {
        for size in [1e-9, 0.01, 0.3, 1.1] {
            let mut masses = Masses::new([97, 48], VIEW);
            let spots: Vec<Spot> = (0..200)
                .map(|k| Spot {
                    at: [
                        2.0 + 0.029_73 * f64::from(k),
                        2.0 + 0.005 * f64::from(k % 7),
                    ],
                    size: [size; 2],
                    mass: 0.5,
                })
                .collect();
            masses.add(&spots);
            let sum: f64 = masses.pixels.iter().sum();
            assert!((sum - 100.0).abs() < 1e-9, "{size}: {sum}");
        }
    }

    #[test]
    fn a_lattice_is_even() {
        for shift in [0.0, 0.1, 0.37] {
            let mut masses = Masses::new([103, 51], VIEW);
            let mut spots = Vec::new();
            for i in -3..24 {
                for j in -3..14 {
                    spots.push(Spot {
                        at: [0.5 * f64::from(i) + shift, 0.5 * f64::from(j) + shift],
                        size: [0.5; 2],
                        mass: 0.25,
                    });
                }
            }
            masses.add(&spots);
            let area = masses.area();
            for mass in masses.pixels {
                assert!((mass / area - 1.0).abs() < 1e-12, "{}", mass / area);
            }
        }
    }
}
