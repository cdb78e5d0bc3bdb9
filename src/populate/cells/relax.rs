//! Relaxation: sites push each other apart until they are even.
//!
//! Lengths are in finest spacings. The force between sites is the slope of a Wendland function of
//! their distance over the mean of their spacings, under which they find an even order without
//! pairs or layers, with a spring against those that are far too near. Of two sites of unequal
//! spacings s the coarser one pushes more, by their ratio: where s grows evenly and the number
//! density is 1/s³, the sum of `f(r/s̄) s_j/s_i` over all directions is zero to the first order in
//! the slope of s, so that sites stay as dense as they are laid.

use std::sync::OnceLock;

use super::forces::{REACH, Sites};
use crate::in_pool;

/// The share of its motion that a site keeps, and its motion by the unit of force.
const KEPT: f64 = 0.7;
const MOBILITY: f64 = 0.05;
/// Longest way of a step.
const LONGEST: f64 = 0.25;

/// The force on a site from a half-space behind a flat face, by its depth.
#[derive(Debug, Clone)]
pub(super) struct Wall {
    forces: Vec<f64>,
}

impl Wall {
    const ROWS: usize = 256;

    /// In two or three dimensions.
    pub fn of(dimension: usize) -> &'static Self {
        static WALLS: [OnceLock<Wall>; 2] = [OnceLock::new(), OnceLock::new()];
        WALLS[dimension - 2].get_or_init(|| Self::new(dimension))
    }

    /// The pushes of a half-space sum to the integral of the function over its face.
    #[allow(clippy::cast_precision_loss)] // a few hundred
    fn new(dimension: usize) -> Self {
        let function = |r: f64| {
            let u = (r / REACH).min(1.0);
            {
                let square = (1.0 - u) * (1.0 - u);
                square * square * (1.0 + 4.0 * u)
            }
        };
        let step = REACH / Self::ROWS as f64;
        let over_face = |depth: f64| -> f64 {
            let rings = (0..Self::ROWS).map(|n| {
                let aside = (n as f64 + 0.5) * step;
                let part = if dimension == 3 {
                    std::f64::consts::TAU * aside
                } else {
                    2.0
                };
                part * step * function(libm::hypot(depth, aside))
            });
            rings.fold(0.0, |sum, ring| sum + ring)
        };
        let forces = (0..=Self::ROWS).map(|n| over_face(n as f64 * step));
        Self {
            forces: forces.collect(),
        }
    }

    /// At a depth.
    #[allow(
        clippy::cast_precision_loss,
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss
    )]
    pub fn force(&self, depth: f64) -> f64 {
        let at = (depth / REACH * Self::ROWS as f64).max(0.0);
        let row = at as usize;
        match self.forces.get(row..row + 2) {
            Some([a, b]) => a + (at - row as f64) * (b - a),
            _ => 0.0,
        }
    }
}

/// One step of those sites that move, whose spacings are given to the functions, too; `outside`
/// returns the other forces on a site, `hold` keeps it in its range, with the velocity (spacings)
/// that it keeps.
pub(super) fn step(
    sites: &mut Sites,
    velocity: &mut [[f64; 3]],
    moving: &[u32],
    outside: impl Fn(&[f64; 3], f64) -> [f64; 3] + Sync,
    hold: impl Fn(&mut [f64; 3], &mut [f64; 3], f64) + Sync,
) {
    let forces = sites.forces(moving);
    let before: &Sites = sites;
    // Each site by itself, so the same bits in any order.
    let states: Vec<(u32, [f64; 3], [f64; 3])> = (moving.iter().zip(&*velocity).zip(&forces))
        .map(|((&i, &v), &others)| (i, v, others))
        .collect();
    let moved = in_pool(&states, |(i, v, others)| {
        let i = *i as usize;
        let (mut position, size) = (before.positions[i], before.sizes[i]);
        let other = outside(&position, size);
        let mut v: [f64; 3] =
            std::array::from_fn(|a| KEPT * v[a] + MOBILITY * (others[a] + other[a]));
        let length = (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt();
        if length > LONGEST {
            v = v.map(|c| c * (LONGEST / length));
        }
        for a in 0..3 {
            position[a] += v[a] * size;
        }
        hold(&mut position, &mut v, size);
        (position, v)
    });
    for ((&i, velocity), (position, v)) in moving.iter().zip(velocity).zip(moved) {
        sites.positions[i as usize] = position;
        *velocity = v;
    }
}
