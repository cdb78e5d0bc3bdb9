//! Relaxation: sites push each other apart until they stand evenly.
//!
//! Lengths are in finest spacings. What sites feel of each other is the slope of a Wendland function
//! of their distance over the mean of their spacings, under which they find an even order without
//! pairs or layers, with a spring against those that are far too near. Of two sites of unequal
//! spacings s the coarser one pushes more, by their ratio: where s grows evenly and the number
//! density is 1/s³, the sum of `f(r/s̄) s_j/s_i` over all directions is zero to the first order in
//! the slope of s, so that sites stay as dense as they are laid.

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

/// What is relaxed: places, and the spacing of each, in finest spacings.
pub(super) struct Sites {
    pub places: Vec<[f64; 3]>,
    pub sizes: Vec<f64>,
    /// The largest spacing of each level, whose sites are at least half as large.
    pub largest: Vec<f64>,
}

impl Sites {
    /// The level of a spacing: level n begins at 2^n.
    fn level(&self, size: f64) -> usize {
        let mut level = 0;
        let mut coarser = 2.0;
        while level + 1 < self.largest.len() && size >= coarser {
            level += 1;
            coarser *= 2.0;
        }
        level
    }
}

/// Sites of a level by cubes of one reach, whose faces do not hang on which sites there are.
struct Grid {
    edge: f64,
    first: [i64; 3],
    counts: [usize; 3],
    starts: Vec<u32>,
    order: Vec<u32>,
}

impl Grid {
    #[allow(clippy::cast_sign_loss, clippy::cast_possible_truncation)]
    fn new(sites: &Sites, level: usize) -> Self {
        let edge = REACH * sites.largest[level];
        let members = (0..).zip(&sites.sizes);
        let members = members.filter(|&(_, &size)| sites.level(size) == level);
        let members: Vec<u32> = members.map(|(i, _)| i).collect();
        let place = |i: u32| &sites.places[i as usize];
        let mut grid = Self {
            edge,
            first: [i64::MAX; 3],
            counts: [0; 3],
            starts: Vec::new(),
            order: vec![0; members.len()],
        };
        let mut last = [i64::MIN; 3];
        for &i in &members {
            let at = grid.cube(place(i));
            for a in 0..3 {
                grid.first[a] = grid.first[a].min(at[a]);
                last[a] = last[a].max(at[a]);
            }
        }
        if members.is_empty() {
            (grid.first, last) = ([0; 3], [-1; 3]);
        }
        grid.counts = [0, 1, 2].map(|a| (last[a] - grid.first[a] + 1) as usize);
        grid.starts = vec![0; grid.counts.iter().product::<usize>() + 1];
        let numbers: Vec<usize> = members
            .iter()
            .map(|&i| grid.number(grid.cube(place(i))).unwrap_or(0))
            .collect();
        for &n in &numbers {
            grid.starts[n + 1] += 1;
        }
        for n in 1..grid.starts.len() {
            grid.starts[n] += grid.starts[n - 1];
        }
        let mut next = grid.starts.clone();
        for (&i, &n) in members.iter().zip(&numbers) {
            grid.order[next[n] as usize] = i;
            next[n] += 1;
        }
        grid
    }

    #[allow(clippy::cast_possible_truncation)] // clamped far below 2^31 cubes
    fn cube(&self, x: &[f64; 3]) -> [i64; 3] {
        x.map(|c| (c / self.edge).floor() as i64)
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

    /// Adds what a site feels from the others of the level, of which the largest are as near as
    /// `reach`: their order is that of cubes and of sites, the same whichever others there are
    /// farther away.
    fn add_force(&self, sites: &Sites, i: usize, reach: f64, force: &mut [f64; 3]) {
        let (here, size) = (sites.places[i], sites.sizes[i]);
        let (low, high) = (
            self.cube(&here.map(|c| c - reach)),
            self.cube(&here.map(|c| c + reach)),
        );
        for k in low[2]..=high[2] {
            for j in low[1]..=high[1] {
                for l in low[0]..=high[0] {
                    let Some(n) = self.number([l, j, k]) else {
                        continue;
                    };
                    let members = self.starts[n] as usize..self.starts[n + 1] as usize;
                    for &other in &self.order[members] {
                        let other = other as usize;
                        let there = sites.places[other];
                        let way: [f64; 3] = std::array::from_fn(|a| here[a] - there[a]);
                        let square = way[0] * way[0] + way[1] * way[1] + way[2] * way[2];
                        let mean = 0.5 * (size + sites.sizes[other]);
                        let within = REACH * mean;
                        if square < within * within && other != i {
                            let push = push(square.sqrt() / mean);
                            let push = push * sites.sizes[other] / (size * mean);
                            for a in 0..3 {
                                force[a] += push * way[a];
                            }
                        }
                    }
                }
            }
        }
    }
}

/// What a site feels from the others.
fn force(grids: &[Grid], sites: &Sites, i: usize) -> [f64; 3] {
    let size = sites.sizes[i];
    let own = sites.level(size);
    let mut force = [0.0; 3];
    // What is within reach is less than twice as large, and more than half as large.
    let levels = own.saturating_sub(1)..(own + 2).min(grids.len());
    for level in levels {
        let reach = 0.5 * REACH * (size + sites.largest[level]);
        grids[level].add_force(sites, i, reach, &mut force);
    }
    force
}

/// One step of those sites that move, whose spacings are given to the functions, too; `outside`
/// gives what a site feels besides the others, `hold` keeps it where it may be, with the velocity
/// (spacings) that it keeps.
pub(super) fn step(
    sites: &mut Sites,
    velocity: &mut [[f64; 3]],
    moving: &[u32],
    outside: impl Fn(&[f64; 3], f64) -> [f64; 3] + Sync,
    hold: impl Fn(&mut [f64; 3], &mut [f64; 3], f64) + Sync,
) {
    let grids: Vec<Grid> = (0..sites.largest.len())
        .map(|level| Grid::new(sites, level))
        .collect();
    let before: &Sites = sites;
    // Each site by itself, so the same bits in any order.
    let moved = moving.par_iter().zip(velocity.par_iter()).map(|(&i, v)| {
        let i = i as usize;
        let (mut place, size) = (before.places[i], before.sizes[i]);
        let (others, other) = (force(&grids, before, i), outside(&place, size));
        let mut v: [f64; 3] =
            std::array::from_fn(|a| KEPT * v[a] + MOBILITY * (others[a] + other[a]));
        let length = (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt();
        if length > LONGEST {
            v = v.map(|c| c * (LONGEST / length));
        }
        for a in 0..3 {
            place[a] += v[a] * size;
        }
        hold(&mut place, &mut v, size);
        (place, v)
    });
    let moved: Vec<([f64; 3], [f64; 3])> = moved.collect();
    for ((&i, velocity), (place, v)) in moving.iter().zip(velocity).zip(moved) {
        sites.places[i as usize] = place;
        *velocity = v;
    }
}
