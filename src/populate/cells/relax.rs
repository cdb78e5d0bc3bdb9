//! Relaxation: sites push each other apart until they stand evenly.
//!
//! Lengths are in spacings. What sites of a number density of one feel is the slope of a Wendland
//! function, under which they find an even order without pairs or layers, with a spring against
//! those that are far too near.

use rayon::prelude::*;

/// How far sites feel each other.
pub(super) const REACH: f64 = 2.2;
/// Nearer ones are driven apart by a spring, of the stiffness `SPRING`.
const TOO_NEAR: f64 = 0.8;
const SPRING: f64 = 10.0;
/// What of its motion a site keeps, and how far the unit of force moves it.
const KEPT: f64 = 0.7;
const MOBILITY: f64 = 0.05;
/// Longest way of a step.
const LONGEST: f64 = 0.25;

/// What two sites at a distance feel from each other, over that distance: minus the slope of
/// `(1 − u)⁴ (1 + 4u)` with u = r/reach (Wendland 1995), and the spring.
fn push(r: f64) -> f64 {
    let u = r / REACH;
    let rest = 1.0 - u;
    let even = 20.0 * rest * rest * rest / (REACH * REACH);
    let spring = SPRING * (TOO_NEAR - r).max(0.0) / r.max(1e-9);
    even + spring
}

/// What a site feels from all that would stand behind a flat face, by its depth.
#[derive(Debug, Clone)]
pub(super) struct Wall {
    forces: Vec<f64>,
}

impl Wall {
    const ROWS: usize = 256;

    /// The pushes of a half-space sum to the integral of the function over its face.
    #[allow(clippy::cast_precision_loss)] // a few hundred
    pub fn new(dimension: usize) -> Self {
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

/// Sites by cubes of one reach, whose faces do not hang on which sites there are.
struct Grid {
    first: [i64; 3],
    counts: [usize; 3],
    starts: Vec<u32>,
    order: Vec<u32>,
}

#[allow(clippy::cast_possible_truncation)] // clamped far below 2^31 cubes
fn cube(x: &[f64; 3]) -> [i64; 3] {
    x.map(|c| (c / REACH).floor() as i64)
}

impl Grid {
    #[allow(clippy::cast_sign_loss, clippy::cast_possible_truncation)]
    fn new(x: &[[f64; 3]]) -> Self {
        let mut first = [i64::MAX; 3];
        let mut last = [i64::MIN; 3];
        for place in x {
            let at = cube(place);
            for a in 0..3 {
                first[a] = first[a].min(at[a]);
                last[a] = last[a].max(at[a]);
            }
        }
        let counts = [0, 1, 2].map(|a| (last[a] - first[a] + 1).max(0) as usize);
        let mut grid = Self {
            first,
            counts,
            starts: vec![0; counts.iter().product::<usize>() + 1],
            order: vec![0; x.len()],
        };
        let numbers: Vec<usize> = x
            .iter()
            .map(|place| grid.number(cube(place)).unwrap_or(0))
            .collect();
        for &n in &numbers {
            grid.starts[n + 1] += 1;
        }
        for n in 1..grid.starts.len() {
            grid.starts[n] += grid.starts[n - 1];
        }
        let mut next = grid.starts.clone();
        for (i, &n) in numbers.iter().enumerate() {
            grid.order[next[n] as usize] = i as u32;
            next[n] += 1;
        }
        grid
    }

    #[allow(clippy::cast_sign_loss, clippy::cast_possible_truncation)]
    fn number(&self, at: [i64; 3]) -> Option<usize> {
        let mut number = 0;
        for a in [2, 1, 0] {
            let along = at[a] - self.first[a];
            if along < 0 || along as usize >= self.counts[a] {
                return None;
            }
            number = number * self.counts[a] + along as usize;
        }
        Some(number)
    }

    /// What a site feels from the others: their order is that of cubes and of sites, the same
    /// whichever others there are farther away.
    fn force(&self, x: &[[f64; 3]], i: usize) -> [f64; 3] {
        let (here, at) = (x[i], cube(&x[i]));
        let mut force = [0.0; 3];
        for k in -1..=1 {
            for j in -1..=1 {
                for l in -1..=1 {
                    let Some(n) = self.number([at[0] + l, at[1] + j, at[2] + k]) else {
                        continue;
                    };
                    let sites = self.starts[n] as usize..self.starts[n + 1] as usize;
                    for &other in &self.order[sites] {
                        let other = other as usize;
                        let there = x[other];
                        let way: [f64; 3] = std::array::from_fn(|a| here[a] - there[a]);
                        let square = way[0] * way[0] + way[1] * way[1] + way[2] * way[2];
                        if square < REACH * REACH && other != i {
                            let push = push(square.sqrt());
                            for a in 0..3 {
                                force[a] += push * way[a];
                            }
                        }
                    }
                }
            }
        }
        force
    }
}

/// One step of those sites that move; `outside` gives what a site feels besides the others, `hold`
/// keeps it where it may be, with the velocity that it keeps.
pub(super) fn step(
    x: &mut [[f64; 3]],
    velocity: &mut [[f64; 3]],
    moving: &[u32],
    outside: impl Fn(&[f64; 3]) -> [f64; 3] + Sync,
    hold: impl Fn(&mut [f64; 3], &mut [f64; 3]) + Sync,
) {
    let grid = Grid::new(x);
    let places: &[[f64; 3]] = x;
    // Each site by itself, so the same bits in any order.
    let moved = moving.par_iter().zip(velocity.par_iter()).map(|(&i, v)| {
        let mut place = places[i as usize];
        let (sites, other) = (grid.force(places, i as usize), outside(&place));
        let mut v: [f64; 3] =
            std::array::from_fn(|a| KEPT * v[a] + MOBILITY * (sites[a] + other[a]));
        let length = (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt();
        if length > LONGEST {
            v = v.map(|c| c * (LONGEST / length));
        }
        for a in 0..3 {
            place[a] += v[a];
        }
        hold(&mut place, &mut v);
        (place, v)
    });
    let moved: Vec<([f64; 3], [f64; 3])> = moved.collect();
    for ((&i, velocity), (place, v)) in moving.iter().zip(velocity).zip(moved) {
        x[i as usize] = place;
        *velocity = v;
    }
}
