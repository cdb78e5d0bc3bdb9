//! Forces between sites: eight neighbouring receivers meet all others around them, one in each
//! lane.
//!
//! Each lane adds up by itself, in the order of cubes whose faces do not depend on which sites
//! there are, and sites out of reach add exactly nothing. So a force has the same bits whichever
//! other sites there are farther away, and whichever meet them in the other lanes.

use crate::in_pool;
use numerics::dispatch::{Vectorised, instructions};
use numerics::lanes::{F64x8, LANES, Lanes};

/// Reach of forces.
pub(super) const REACH: f64 = 2.2;
/// Nearer ones are driven apart by a spring, of the stiffness `SPRING`.
const TOO_NEAR: f64 = 0.8;
const SPRING: f64 = 10.0;

/// Cubes are cut along x into so many parts.
const PARTS: f64 = 4.0;
/// Receivers of a group are no farther apart along x than so many parts.
const LONGEST_GROUP: i64 = 6;
/// Groups that a thread takes at a time.
const TOGETHER: usize = 128;
/// Beyond this share of the reach there is certainly no force.
const BEYOND: f64 = 1.0 + 1e-9;

/// The sites to be relaxed: positions, and the spacing of each, in finest spacings.
pub(super) struct Sites {
    pub positions: Vec<[f64; 3]>,
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

    /// The forces on some of them from all others, in their order.
    pub fn forces(&self, of: &[u32]) -> Vec<[f64; 3]> {
        const NONE: u32 = u32::MAX;
        let mut wanted = vec![NONE; self.positions.len()];
        for (at, &i) in (0..).zip(of) {
            wanted[i as usize] = at;
        }
        let levels = 0..self.largest.len();
        let grids: Vec<Grid> = levels.clone().map(|level| Grid::new(self, level)).collect();
        let mut forces = vec![[0.0; 3]; of.len()];
        for level in levels {
            let grid = &grids[level];
            let is_wanted = |&n: &u32| wanted[grid.order[n as usize] as usize] != NONE;
            let receivers: Vec<u32> = grid.numbers().filter(is_wanted).collect();
            let groups = grid.groups(&receivers);
            // Neighbours in reach are less than twice as large, and more than half as large.
            let around = level.saturating_sub(1)..(level + 2).min(grids.len());
            // Each site by itself, so the same bits in any order.
            let together: Vec<&[_]> = groups.chunks(TOGETHER).collect();
            let of_groups = in_pool(&together, |groups| {
                instructions().run(Meet {
                    own: grid,
                    grids: &grids[around.clone()],
                    groups,
                })
            });
            for (group, force) in groups.iter().zip(of_groups.iter().flatten()) {
                for (k, &n) in group.iter().enumerate() {
                    let at = wanted[grid.order[n as usize] as usize];
                    forces[at as usize] = [0, 1, 2].map(|a| force[a].0[k]);
                }
            }
        }
        forces
    }
}

/// Places and spacings of the sites of a level, sorted by cubes of one reach that are cut along x.
struct Grid {
    /// Edges of the parts of cubes.
    edges: [f64; 3],
    largest: f64,
    first: [i64; 3],
    counts: [usize; 3],
    starts: Vec<u32>,
    /// The number of each site.
    order: Vec<u32>,
    positions: Vec<[f64; 3]>,
    sizes: Vec<f64>,
}

impl Grid {
    #[allow(clippy::cast_sign_loss, clippy::cast_possible_truncation)]
    fn new(sites: &Sites, level: usize) -> Self {
        let members = (0..).zip(&sites.sizes);
        let members = members.filter(|&(_, &size)| sites.level(size) == level);
        let members: Vec<u32> = members.map(|(i, _)| i).collect();
        let largest = sites.largest[level];
        let edge = REACH * largest;
        let mut grid = Self {
            edges: [edge / PARTS, edge, edge],
            largest,
            first: [i64::MAX; 3],
            counts: [0; 3],
            starts: Vec::new(),
            order: vec![0; members.len()],
            positions: vec![[0.0; 3]; members.len()],
            sizes: vec![0.0; members.len()],
        };
        let mut last = [i64::MIN; 3];
        let mut parts = Vec::with_capacity(members.len());
        for &i in &members {
            let at = [0, 1, 2].map(|a| grid.part(a, sites.positions[i as usize][a]));
            for a in 0..3 {
                grid.first[a] = grid.first[a].min(at[a]);
                last[a] = last[a].max(at[a]);
            }
            parts.push(at);
        }
        if members.is_empty() {
            (grid.first, last) = ([0; 3], [-1; 3]);
        }
        grid.counts = [0, 1, 2].map(|a| (last[a] - grid.first[a] + 1) as usize);
        let number = |at: &[i64; 3]| {
            let [i, j, k] = [0, 1, 2].map(|a| (at[a] - grid.first[a]) as usize);
            i + grid.counts[0] * (j + grid.counts[1] * k)
        };
        // First the number in each part, then its end, at last its start.
        let mut starts = vec![0; grid.counts.iter().product::<usize>() + 1];
        for at in &parts {
            starts[number(at)] += 1;
        }
        let mut end = 0;
        for start in &mut starts {
            end += *start;
            *start = end;
        }
        for (&i, at) in members.iter().zip(&parts).rev() {
            let start = &mut starts[number(at)];
            *start -= 1;
            let n = *start as usize;
            grid.order[n] = i;
            grid.positions[n] = sites.positions[i as usize];
            grid.sizes[n] = sites.sizes[i as usize];
        }
        grid.starts = starts;
        grid
    }

    /// The part of cubes along an axis.
    #[inline(always)]
    #[allow(clippy::cast_possible_truncation)] // far fewer than 2^31
    fn part(&self, a: usize, c: f64) -> i64 {
        (c / self.edges[a]).floor() as i64
    }

    /// Numbers of all sites, in order.
    #[allow(clippy::cast_possible_truncation)] // sites are told by u32
    fn numbers(&self) -> std::ops::Range<u32> {
        0..self.order.len() as u32
    }

    /// Some sites in order by eights of neighbours.
    fn groups<'a>(&self, numbers: &'a [u32]) -> Vec<&'a [u32]> {
        let part = |&n: &u32| [0, 1, 2].map(|a| self.part(a, self.positions[n as usize][a]));
        let mut groups = Vec::with_capacity(numbers.len() / LANES);
        let mut first = 0;
        while first < numbers.len() {
            let [i, j, k] = part(&numbers[first]);
            let most = numbers.len().min(first + LANES);
            let apart = numbers[first + 1..most].iter().position(|n| {
                let other = part(n);
                [other[1], other[2]] != [j, k] || other[0] - i > LONGEST_GROUP
            });
            let end = apart.map_or(most, |n| first + 1 + n);
            groups.push(&numbers[first..end]);
            first = end;
        }
        groups
    }

    /// The first and last entries of rows along x that are as near to a box as `reach`.
    #[inline(always)]
    #[allow(clippy::cast_sign_loss, clippy::cast_possible_truncation)]
    fn rows_around(&self, [lower, upper]: [[f64; 3]; 2], reach: f64, rows: &mut Vec<[u32; 2]>) {
        rows.clear();
        let (mut low, mut end) = ([0; 3], [0; 3]);
        for a in 0..3 {
            let first = self.part(a, lower[a] - reach) - self.first[a];
            let last = self.part(a, upper[a] + reach) - self.first[a];
            low[a] = first.max(0) as usize;
            end[a] = ((last + 1).max(0) as usize).min(self.counts[a]);
        }
        if low[0] >= end[0] {
            return;
        }
        for k in low[2]..end[2] {
            for j in low[1]..end[1] {
                let row = self.counts[0] * (j + self.counts[1] * k);
                rows.push([self.starts[row + low[0]], self.starts[row + end[0]]]);
            }
        }
    }
}

/// Groups of receivers of a level that meet what is around them.
struct Meet<'a> {
    own: &'a Grid,
    grids: &'a [Grid],
    groups: &'a [&'a [u32]],
}

impl Vectorised for Meet<'_> {
    /// Components of the forces of each group, by lanes.
    type Output = Vec<[F64x8; 3]>;

    #[inline(always)]
    fn run<V: Lanes>(self) -> Self::Output {
        let mut rows = Vec::new();
        let mut forces = Vec::with_capacity(self.groups.len());
        for group in self.groups {
            let mut positions = [F64x8([0.0; LANES]); 3];
            let mut sizes = F64x8([0.0; LANES]);
            let (mut lower, mut upper) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
            let mut largest = 0.0_f64;
            for k in 0..LANES {
                // The last one replaces those that are missing.
                let n = group[k.min(group.len() - 1)] as usize;
                let position = &self.own.positions[n];
                for a in 0..3 {
                    positions[a].0[k] = position[a];
                    lower[a] = lower[a].min(position[a]);
                    upper[a] = upper[a].max(position[a]);
                }
                sizes.0[k] = self.own.sizes[n];
                largest = largest.max(self.own.sizes[n]);
            }
            let receivers = Receivers::<V>::new(&positions, &sizes);
            let mut sums = [V::splat(0.0); 3];
            for grid in self.grids {
                let reach = 0.5 * REACH * (largest + grid.largest);
                grid.rows_around([lower, upper], reach, &mut rows);
                for &[first, end] in &rows {
                    receivers.meet(grid, first as usize, end as usize, &mut sums);
                }
            }
            forces.push([sums[0].store(), sums[1].store(), sums[2].store()]);
        }
        forces
    }
}

/// Eight sites that feel others.
struct Receivers<V> {
    x: V,
    y: V,
    z: V,
    size: V,
    /// One over the spacing.
    inverse: V,
    /// The spacing, if all have the same.
    even: f64,
}

impl<V: Lanes> Receivers<V> {
    #[inline(always)]
    fn new(positions: &[F64x8; 3], sizes: &F64x8) -> Self {
        let mut even = sizes.0[0];
        for size in sizes.0 {
            if size != even {
                even = f64::NAN;
            }
        }
        let size = V::load(sizes);
        Self {
            x: V::load(&positions[0]),
            y: V::load(&positions[1]),
            z: V::load(&positions[2]),
            size,
            inverse: V::splat(1.0).div(size),
            even,
        }
    }

    /// Adds what the sites of a grid from some number on do, each to all lanes.
    #[inline(always)]
    fn meet(&self, grid: &Grid, first: usize, end: usize, sums: &mut [V; 3]) {
        let half = V::splat(0.5);
        let reach = V::splat(REACH * BEYOND);
        for (position, &size) in grid.positions[first..end]
            .iter()
            .zip(&grid.sizes[first..end])
        {
            let dx = self.x.sub(V::splat(position[0]));
            let dy = self.y.sub(V::splat(position[1]));
            let dz = self.z.sub(V::splat(position[2]));
            let square = dx.mul(dx).add(dy.mul(dy)).add(dz.mul(dz));
            let theirs = V::splat(size);
            let is_even = size == self.even;
            let mean = if is_even {
                self.size
            } else {
                half.mul(self.size.add(theirs))
            };
            let within = reach.mul(mean);
            if square.less_than(within.mul(within)) == 0 {
                continue;
            }
            let inverse = if is_even {
                self.inverse
            } else {
                V::splat(1.0).div(mean)
            };
            let push = push(square.sqrt().mul(inverse));
            let push = push.mul(theirs.mul(inverse).mul(self.inverse));
            sums[0] = sums[0].add(push.mul(dx));
            sums[1] = sums[1].add(push.mul(dy));
            sums[2] = sums[2].add(push.mul(dz));
        }
    }
}

/// The force of two sites at a distance, over that distance: minus the slope of `(1 − u)⁴ (1 + 4u)`
/// with u = r/reach (Wendland 1995), and the spring.
#[inline(always)]
fn push<V: Lanes>(r: V) -> V {
    let (zero, too_near) = (V::splat(0.0), V::splat(TOO_NEAR));
    let rest = V::splat(1.0).sub(r.mul(V::splat(1.0 / REACH))).max(zero);
    let even = V::splat(20.0 / (REACH * REACH)).mul(rest.mul(rest).mul(rest));
    if r.less_than(too_near) == 0 {
        return even;
    }
    let spring = V::splat(SPRING).mul(too_near.sub(r).max(zero));
    even.add(spring.div(r.max(V::splat(1e-9))))
}
