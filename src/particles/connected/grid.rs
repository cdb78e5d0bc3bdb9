//! Places by cubes: who is near whom, of particles of any sizes.
//!
//! Places of about one size, within a factor of two, stand in one grid, whose cubes are as wide as
//! the farthest of them can be linked. Each place looks among its own and among larger ones, so
//! that it meets few that are too far, however the sizes differ.

use rayon::prelude::*;

use crate::Image;
use numerics::ellipsoid::square;
use numerics::vector::{minus, norm};

/// Place of a particle or of an image of it.
#[derive(Debug, Clone, Copy)]
pub struct Place {
    /// Position (m).
    pub position: [f64; 3],
    /// Reach (m); the farthest one if that differs by direction.
    pub reach: f64,
    /// What measures distances in units of the reach, if that differs by direction.
    pub metric: Option<[f64; 6]>,
    /// The particle or image.
    pub image: Image,
}

/// Places of one class of sizes.
#[derive(Debug)]
pub struct Grid {
    /// Lowest coordinates (m).
    lowest: [f64; 3],
    per_width: f64,
    /// Cubes with places, and where the places of each begin.
    cubes: Vec<(u64, u32)>,
    /// Places by cube.
    pub places: Vec<Place>,
}

/// Bits of a cube's index along an axis.
const BITS: u32 = 20;
const LAST: u64 = (1 << BITS) - 1;
/// Classes of sizes at most; smaller places stand in the last one.
const CLASSES: usize = 16;

/// The grids of places, the largest class of sizes first.
#[must_use]
pub fn grids(places: Vec<Place>) -> Vec<Grid> {
    let largest = places.iter().map(|p| p.reach).fold(0.0, f64::max);
    let mut classes: Vec<Vec<Place>> = Vec::new();
    for place in places {
        let mut class = 0;
        let mut reach = largest;
        while place.reach < 0.5 * reach && class + 1 < CLASSES {
            reach *= 0.5;
            class += 1;
        }
        if classes.len() <= class {
            classes.resize_with(class + 1, Vec::new);
        }
        classes[class].push(place);
    }
    let grids = classes.into_iter().filter(|places| !places.is_empty());
    grids.map(|places| Grid::new(&places)).collect()
}

impl Grid {
    fn new(places: &[Place]) -> Self {
        let reach = places.iter().map(|p| p.reach).fold(0.0, f64::max);
        let least = |a: usize| {
            places
                .iter()
                .map(|p| p.position[a])
                .fold(f64::INFINITY, f64::min)
        };
        let mut grid = Self {
            lowest: [0, 1, 2].map(least),
            // A little wider, so that rounding never puts linked places two cubes apart.
            per_width: 1.0 / (2.0 * reach * (1.0 + 1e-9)),
            cubes: Vec::new(),
            places: Vec::new(),
        };
        let keys = places.par_iter().enumerate();
        #[expect(clippy::cast_possible_truncation, reason = "particles fit u32")]
        let keyed = |(k, place): (usize, &Place)| (key(grid.cube(&place.position)), k as u32);
        let mut keys: Vec<(u64, u32)> = keys.map(keyed).collect();
        keys.par_sort_unstable();
        grid.cubes.extend_from_slice(&keys);
        grid.cubes
            .iter_mut()
            .zip(0_u32..)
            .for_each(|(cube, k)| cube.1 = k);
        grid.cubes.dedup_by_key(|cube| cube.0);
        grid.places = keys.par_iter().map(|(_, k)| places[*k as usize]).collect();
        grid
    }

    /// Number of cubes that have places.
    #[must_use]
    pub fn cubes(&self) -> usize {
        self.cubes.len()
    }

    /// The places of a cube, by its number.
    #[must_use]
    pub fn members(&self, cube: usize) -> std::ops::Range<usize> {
        let end = self.cubes.get(cube + 1);
        let end = end.map_or(self.places.len(), |next| next.1 as usize);
        self.cubes[cube].1 as usize..end
    }

    /// The cube that a position stands in; what is far away stands in the outermost ones.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "saturates, and is limited"
    )]
    #[must_use]
    pub fn cube(&self, position: &[f64; 3]) -> [u64; 3] {
        let index = |a: usize| ((position[a] - self.lowest[a]) * self.per_width) as u64;
        [0, 1, 2].map(|a| index(a).min(LAST))
    }

    /// Calls `row` with the places of a cube and of those about it, in up to nine ranges.
    pub fn about(&self, [x, y, z]: [u64; 3], mut row: impl FnMut(std::ops::Range<usize>)) {
        for i in x.saturating_sub(1)..=(x + 1).min(LAST) {
            for j in y.saturating_sub(1)..=(y + 1).min(LAST) {
                let from = key([i, j, z.saturating_sub(1)]);
                let to = key([i, j, (z + 1).min(LAST)]);
                let first = self.cubes.partition_point(|cube| cube.0 < from);
                let near = self.cubes[first..].iter().take_while(|cube| cube.0 <= to);
                let near = near.count();
                if near > 0 {
                    let begin = self.members(first).start;
                    row(begin..self.members(first + near - 1).end);
                }
            }
        }
    }
}

/// Cubes that are neighbours along the last axis follow each other.
fn key([x, y, z]: [u64; 3]) -> u64 {
    (x << (2 * BITS)) | (y << BITS) | z
}

/// The square of the distance of two positions (m²).
#[inline]
#[must_use]
pub fn distance_squared(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    let r = [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
    r[0] * r[0] + r[1] * r[1] + r[2] * r[2]
}

impl Place {
    /// True if two places are linked.
    #[inline]
    #[must_use]
    pub fn is_linked(&self, other: &Self) -> bool {
        let range = self.reach + other.reach;
        let distance = distance_squared(&self.position, &other.position);
        let are_deformed = self.metric.is_some() || other.metric.is_some();
        distance < range * range && (!are_deformed || self.share(other) + other.share(self) > 1.0)
    }

    /// Reach towards another place, over the distance of that.
    fn share(&self, other: &Self) -> f64 {
        let apart = minus(&other.position, &self.position);
        match &self.metric {
            Some(metric) => 1.0 / square(metric, &apart).sqrt(),
            None => self.reach / norm(&apart),
        }
    }
}
