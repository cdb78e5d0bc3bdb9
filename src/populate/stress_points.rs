//! Positions of the stress points of a body: half way between particles that are next to each other
//! along an axis of a cubic lattice.
//!
//! Each particle splits its volume evenly between the axes, and between the two points beside it
//! along each. If one of them is missing, at a surface, its share goes evenly to the points across,
//! those along other axes, so that a body carries stress along its surfaces with all of its
//! cross-section; without any across, as at the ends of a bar in one dimension, it bears no stress.

use super::lattice::Stack;
use super::{Brick, row};
use model::{Body, SymmetryPlane};

/// One stress point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StressSite {
    /// Position (m); components beyond the dimension are zero.
    pub position: [f64; 3],
    /// Number in the body, below [`stress_index_end`].
    pub index: u64,
    /// Its volume over that of a particle; of a point on a symmetry plane the half on this side.
    pub share: f64,
}

/// A particle is next to its image behind a symmetry plane if it is between these parts of a pitch
/// from it, along an axis of the lattice.
const NEXT: [f64; 2] = [0.25, 0.75];
/// Cosine of an angle that is none.
const ALONG: f64 = 1.0 - 1e-6;

/// The neighbour of a particle on one side along one axis.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Beside {
    Nothing,
    /// Another particle.
    Particle,
    /// Its own image behind the plane normal to a coordinate axis, at a position (m).
    Image(usize, f64),
}

/// The stress points of a body above all symmetry planes or on them and, if given, in a brick.
pub fn stress_sites(
    body: &Body,
    dimension: usize,
    symmetry: &[SymmetryPlane],
    brick: Option<Brick>,
) -> impl Iterator<Item = StressSite> + use<> {
    let grid = Grid {
        stack: Stack::new(body, dimension),
        dimension,
        planes: symmetry.to_vec(),
        rigid: body.rigid.is_some(),
    };
    // A point belongs to the particle below it, half a pitch away.
    let wide = brick.map(|brick| brick.widened(body.lattice.spacing));
    let within = move |site: &StressSite| brick.is_none_or(|brick| brick.holds(&site.position));
    row::rows(grid.stack, row::cuts(symmetry, wide))
        .flat_map(|row| row.range().map(move |i| [i, row.j, row.k]))
        .flat_map(move |site| {
            let sides = 2 * dimension;
            let sites: [Option<StressSite>; 6] = std::array::from_fn(|side| {
                let own = !grid.rigid && side < sides;
                own.then(|| grid.point(site, side)).flatten()
            });
            sites.into_iter().flatten()
        })
        .filter(within)
}

/// The number of [`stress_sites`].
#[must_use]
pub fn stress_count(
    body: &Body,
    dimension: usize,
    symmetry: &[SymmetryPlane],
    brick: Option<Brick>,
) -> u64 {
    stress_sites(body, dimension, symmetry, brick).count() as u64
}

/// One more than the largest [`StressSite::index`] that the body can have; saturates at `u64::MAX`.
#[must_use]
pub fn stress_index_end(body: &Body, dimension: usize) -> u64 {
    super::index_end(body, dimension).saturating_mul(6)
}

/// The lattice of a body with its symmetry planes.
struct Grid {
    stack: Stack,
    dimension: usize,
    planes: Vec<SymmetryPlane>,
    rigid: bool,
}

/// The axis of a side; even sides are those of larger indices.
fn axis(side: usize) -> usize {
    side / 2
}

impl Grid {
    /// The point on one side of a particle, if it is the particle's own: between it and the next
    /// one, or its image.
    fn point(&self, site: [u64; 3], side: usize) -> Option<StressSite> {
        let beside = self.beside(site, side);
        let here = self.position(site);
        let (position, share) = match beside {
            Beside::Particle if side.is_multiple_of(2) => {
                let other = self.next(site, side)?;
                let there = self.position(other);
                let share = self.share(site, side) + self.share(other, side + 1);
                (std::array::from_fn(|a| 0.5 * (here[a] + there[a])), share)
            }
            Beside::Image(normal, plane) => {
                let mut position = here;
                position[normal] = plane;
                (position, self.share(site, side))
            }
            _ => return None,
        };
        let [i, j, k] = site;
        Some(StressSite {
            position,
            index: self.stack.index(i, j, k) * 6 + side as u64,
            share,
        })
    }

    /// The share of its volume that a particle gives to the point on one side.
    fn share(&self, site: [u64; 3], side: usize) -> f64 {
        let sides = 2 * self.dimension;
        let part = 1.0 / f64::from([1_u8, 2, 4, 6][self.dimension]);
        let is = |s: usize| self.beside(site, s) != Beside::Nothing;
        let mut share = part;
        for missing in (0..sides).filter(|&s| !is(s) && axis(s) != axis(side)) {
            let across = (0..sides).filter(|&s| axis(s) != axis(missing) && is(s));
            let across = u8::try_from(across.count()).unwrap_or(1);
            share += part / f64::from(across);
        }
        share
    }

    fn beside(&self, site: [u64; 3], side: usize) -> Beside {
        if self.next(site, side).is_some() {
            return Beside::Particle;
        }
        let x = self.position(site);
        let pitch = self.stack.pitch[axis(side)];
        let along = self.stack.direction(axis(side));
        for plane in &self.planes {
            let normal = plane.axis.index();
            let down = if side.is_multiple_of(2) {
                -along[normal]
            } else {
                along[normal]
            };
            let gap = (x[normal] - plane.position) / pitch;
            if down > ALONG && (NEXT[0]..NEXT[1]).contains(&gap) {
                return Beside::Image(normal, plane.position);
            }
        }
        Beside::Nothing
    }

    /// The particle next to one, on one side, if there is one.
    fn next(&self, site: [u64; 3], side: usize) -> Option<[u64; 3]> {
        let mut next = site;
        let index = &mut next[axis(side)];
        *index = if side.is_multiple_of(2) {
            *index + 1
        } else {
            index.checked_sub(1)?
        };
        self.holds(next).then_some(next)
    }

    fn holds(&self, site: [u64; 3]) -> bool {
        let stack = &self.stack;
        if (0..3).any(|a| site[a] >= stack.counts[a]) {
            return false;
        }
        let x = self.position(site);
        let above = |plane: &SymmetryPlane| x[plane.axis.index()] > plane.position;
        stack.holds(site) && self.planes.iter().all(above)
    }

    fn position(&self, [i, j, k]: [u64; 3]) -> [f64; 3] {
        self.stack.position(i, j, k)
    }
}
