//! Rigid surfaces: a penalty on particles that are nearer to one than half a spacing.
//!
//! A particle may be wherever it keeps its reach `R = ½Δp` from the surface. The way back there is
//! the shortest displacement `u` that keeps all of `n_k·u ≥ R − g_k`, over the indices of the
//! surface with gap `g_k` and normal `n_k` that it is too near to, and its energy is `½ κ M V
//! (|u|/Δp)²`: a function of its place whose gradient is the force `κ M V/Δp² u`. On a face, along
//! an edge and at a corner that stands out there is one such place, in a corner of two or three
//! walls one on each; a shallow valley counts once.

use model::{Foot, RigidSurface};
use numerics::vector::dot;

/// Indices of a surface that a particle may be too near to at the same time.
const MOST: usize = 4;
/// Searches for such places.
const TRIES: usize = 8;
/// Tolerance of the reach.
const CLOSE: f64 = 1e-9;

/// The way of a particle back to where it keeps its reach.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Escape {
    /// The nearest index of the surface.
    pub foot: Foot,
    /// The way (m); zero for a particle that keeps its reach.
    pub way: [f64; 3],
    /// Square of the depth that energy counts (m²): that of the way, except in a slot too narrow
    /// for the particle, where it is the sum over both walls.
    pub depth2: f64,
    /// Stiffness over that of a single wall.
    pub walls: f64,
}

/// `n·u ≥ b`.
#[derive(Debug, Clone, Copy, Default)]
struct Wall {
    normal: [f64; 3],
    depth: f64,
}

/// The way of a particle at `x` (m, in the frame of the surface) that is to keep `reach` (m);
/// `None` if the surface is farther than `limit` (m).
#[must_use]
pub fn escape(surface: &RigidSurface, x: &[f64; 3], reach: f64, limit: f64) -> Option<Escape> {
    let foot = surface.foot(x, limit)?;
    let mut way = [0.0; 3];
    let depth = reach - foot.gap;
    if depth <= 0.0 {
        return Some(Escape {
            foot,
            way,
            depth2: 0.0,
            walls: 1.0,
        });
    }
    way = foot.normal.map(|n| n * depth);
    let one = Escape {
        foot,
        way,
        depth2: depth * depth,
        walls: 1.0,
    };
    if surface.one_foot() {
        return Some(one);
    }
    let mut walls = [Wall::default(); MOST];
    walls[0] = Wall {
        normal: foot.normal,
        depth,
    };
    let mut count = 1;
    for _ in 1..TRIES {
        let y = [x[0] + way[0], x[1] + way[1], x[2] + way[2]];
        let Some(next) = surface.foot(&y, limit) else {
            break;
        };
        let lack = reach - next.gap;
        if lack <= CLOSE * reach || count == MOST {
            break;
        }
        walls[count] = Wall {
            normal: next.normal,
            depth: lack + dot(&next.normal, &way),
        };
        count += 1;
        match shortest(&walls[..count], CLOSE * reach) {
            Some((found, kept)) => {
                way = found;
                count = keep(&mut walls, count, kept);
            }
            None => return Some(squeezed(foot, &walls[..count])),
        }
    }
    Some(Escape {
        way,
        depth2: dot(&way, &way),
        ..one
    })
}

/// Keeps the walls of a set of bits; returns how many.
fn keep(walls: &mut [Wall; MOST], count: usize, kept: usize) -> usize {
    let mut left = 0;
    for k in 0..count {
        if kept >> k & 1 == 1 {
            walls[left] = walls[k];
            left += 1;
        }
    }
    left
}

/// No place keeps the reach from all walls: each pushes for itself.
fn squeezed(foot: Foot, walls: &[Wall]) -> Escape {
    let mut escape = Escape {
        foot,
        way: [0.0; 3],
        depth2: 0.0,
        walls: 0.0,
    };
    for wall in walls.iter().filter(|wall| wall.depth > 0.0) {
        for a in 0..3 {
            escape.way[a] += wall.normal[a] * wall.depth;
        }
        escape.depth2 += wall.depth * wall.depth;
        escape.walls += 1.0;
    }
    escape
}

/// The shortest vector that all walls allow (to `close`, m), and the set of those that it rests on:
/// `u = Σ λ_k n_k` with `n_k·u = b_k` and `λ_k ≥ 0` on these.
fn shortest(walls: &[Wall], close: f64) -> Option<([f64; 3], usize)> {
    let sets = 1..1_usize << walls.len();
    let allowed = |u: &[f64; 3]| walls.iter().all(|w| dot(&w.normal, u) >= w.depth - close);
    let mut found = None;
    // The last wall is one that the way so far does not keep.
    for set in sets.filter(|set| set.count_ones() <= 3) {
        let Some(u) = rest_on(walls, set) else {
            continue;
        };
        if allowed(&u) && found.is_none_or(|(best, _)| dot(&u, &u) < dot(&best, &best)) {
            found = Some((u, set));
        }
    }
    found
}

/// The shortest vector that touches all walls of a set, if it pushes off each of them.
fn rest_on(walls: &[Wall], set: usize) -> Option<[f64; 3]> {
    let mut rows = [[0.0; 4]; 3];
    let mut normals = [[0.0; 3]; 3];
    let mut n = 0;
    for (k, wall) in walls.iter().enumerate() {
        if set >> k & 1 == 1 {
            normals[n] = wall.normal;
            rows[n][3] = wall.depth;
            n += 1;
        }
    }
    for i in 0..n {
        for j in 0..n {
            rows[i][j] = dot(&normals[i], &normals[j]);
        }
    }
    // Gauss–Jordan; the diagonal stays positive unless normals depend on each other.
    for i in 0..n {
        let pivot = rows[i][i];
        if pivot < 1e-9 {
            return None;
        }
        rows[i] = rows[i].map(|x| x / pivot);
        for j in (0..n).filter(|&j| j != i) {
            let factor = rows[j][i];
            for k in 0..4 {
                rows[j][k] -= factor * rows[i][k];
            }
        }
    }
    let mut u = [0.0; 3];
    for i in 0..n {
        if rows[i][3] < 0.0 {
            return None;
        }
        for a in 0..3 {
            u[a] += rows[i][3] * normals[i][a];
        }
    }
    Some(u)
}

#[cfg(test)]
mod tests {
    use super::*;
    use model::{Mesh, Motion, Resistance, SurfaceShape};

    const R: f64 = 0.5;

    /// At rest, for all bodies.
    fn surface(shape: SurfaceShape, inside: bool) -> RigidSurface {
        RigidSurface {
            name: String::new(),
            shape,
            inside,
            stiffness: 2.0,
            resistance: Resistance::default(),
            bodies: Vec::new(),
            motion: Motion::default(),
            spin: None,
        }
    }

    /// The solid over an outline in x and y (counter-clockwise), from z = −9 to 9.
    fn prism(outline: &[[f64; 2]], ends: &[[usize; 3]]) -> RigidSurface {
        let at = |k: usize, z: f64| [outline[k][0], outline[k][1], z];
        let n = outline.len();
        let mut soup = Vec::new();
        for k in 0..n {
            let l = (k + 1) % n;
            soup.push([at(k, -9.0), at(l, -9.0), at(l, 9.0)]);
            soup.push([at(k, -9.0), at(l, 9.0), at(k, 9.0)]);
        }
        for &[a, b, c] in ends {
            soup.push([at(a, 9.0), at(b, 9.0), at(c, 9.0)]);
            soup.push([at(a, -9.0), at(c, -9.0), at(b, -9.0)]);
        }
        let mesh = Mesh::new(&soup).expect("a closed prism");
        surface(SurfaceShape::Mesh(mesh.into()), false)
    }

    /// A block from below with a valley along z at the origin, whose left floor is level and whose
    /// right one rises by `angle`.
    fn valley(angle: f64) -> RigidSurface {
        let (s, c) = (libm::sin(angle), libm::cos(angle));
        let outline = [
            [-9.0, -9.0],
            [9.0 * c + 3.0, -9.0],
            [9.0 * c + 3.0, 9.0 * s],
            [9.0 * c, 9.0 * s],
            [0.0, 0.0],
            [-9.0, 0.0],
        ];
        prism(&outline, &[[0, 1, 4], [1, 2, 4], [2, 3, 4], [0, 4, 5]])
    }

    fn at(surface: &RigidSurface, x: [f64; 3]) -> Escape {
        escape(surface, &x, R, 4.0).expect("near")
    }

    fn near(escape: &Escape, way: [f64; 3]) {
        for a in 0..3 {
            assert!(
                (escape.way[a] - way[a]).abs() < 1e-12,
                "{escape:?}, way {way:?}"
            );
        }
        let square = dot(&way, &way);
        assert!((escape.depth2 - square).abs() < 1e-12, "{escape:?}");
    }

    /// Against the outer corner of a box there is one contact, along the line from it, whatever
    /// number of triangles meets there.
    #[test]
    fn one_contact_on_what_stands_out() {
        let cube = prism(
            &[[-2.0, -2.0], [2.0, -2.0], [2.0, 2.0], [-2.0, 2.0]],
            &[[0, 1, 2], [0, 2, 3]],
        );
        assert!(cube.one_foot());
        near(&at(&cube, [2.18, 2.24, 0.0]), [0.12, 0.16, 0.0]);
        near(&at(&cube, [2.3, 0.0, 0.0]), [0.2, 0.0, 0.0]);
        near(&at(&cube, [1.9, 0.3, 0.0]), [0.6, 0.0, 0.0]);
        let far = at(&cube, [2.6, 0.0, 0.0]);
        assert_eq!((far.way, far.depth2), ([0.0; 3], 0.0));
        assert!(escape(&cube, &[9.0, 0.0, 0.0], R, 4.0).is_none());
        // The same where the surface has valleys elsewhere: the ridge over two valleys.
        let ridge = prism(
            &[
                [-6.0, -9.0],
                [6.0, -9.0],
                [6.0, 0.0],
                [2.0, 0.0],
                [0.0, 2.0],
                [-2.0, 0.0],
                [-6.0, 0.0],
            ],
            &[[0, 5, 6], [0, 3, 5], [0, 1, 3], [1, 2, 3], [3, 4, 5]],
        );
        assert!(!ridge.one_foot());
        near(&at(&ridge, [0.0, 2.3, 0.0]), [0.0, 0.2, 0.0]);
    }

    /// In a right angle both walls push, each for its own depth; in a box's corner three do.
    #[test]
    fn two_walls_in_a_corner() {
        let corner = valley(std::f64::consts::FRAC_PI_2);
        near(&at(&corner, [-0.3, 0.1, 0.0]), [-0.2, 0.4, 0.0]);
        near(&at(&corner, [-0.1, 0.3, 0.0]), [-0.4, 0.2, 0.0]);
        near(&at(&corner, [-0.7, 0.3, 0.0]), [0.0, 0.2, 0.0]);
        let can = surface(
            SurfaceShape::Cylinder {
                centre: [0.0; 3],
                axis: [0.0, 0.0, 1.0],
                radius: 3.0,
                half_length: 2.0,
            },
            true,
        );
        near(&at(&can, [2.9, 0.0, 1.7]), [-0.4, 0.0, -0.2]);
        // Beyond the rim as well.
        near(&at(&can, [3.3, 0.0, 2.4]), [-0.8, 0.0, -0.9]);
        let room = surface(
            match prism(
                &[[0.0, 0.0], [5.0, 0.0], [5.0, 5.0], [0.0, 5.0]],
                &[[0, 1, 2], [0, 2, 3]],
            )
            .shape
            {
                SurfaceShape::Mesh(mesh) => SurfaceShape::Mesh(mesh),
                _ => unreachable!(),
            },
            true,
        );
        near(&at(&room, [0.1, 0.2, -8.7]), [0.4, 0.3, 0.2]);
    }

    /// A slot narrower than a spacing pushes from both sides, balanced in its middle.
    #[test]
    fn a_slot_too_narrow() {
        let slot = prism(
            &[
                [-3.0, -3.0],
                [3.0, -3.0],
                [3.0, 0.0],
                [0.4, 0.0],
                [0.4, -2.0],
                [-0.4, -2.0],
                [-0.4, 0.0],
                [-3.0, 0.0],
            ],
            &[
                [0, 6, 7],
                [0, 5, 6],
                [0, 4, 5],
                [0, 1, 4],
                [1, 3, 4],
                [1, 2, 3],
            ],
        );
        let middle = at(&slot, [0.05, -1.0, 0.0]);
        assert!((middle.way[0] + 0.1).abs() < 1e-12, "{middle:?}");
        assert!((middle.depth2 - (0.15 * 0.15 + 0.05 * 0.05)).abs() < 1e-12);
        assert_eq!(middle.walls, 2.0);
    }

    /// The energy ½u² is continuous and its gradient is −u, over flat, shallow and steep valleys.
    #[test]
    fn the_force_is_the_gradient_of_the_energy() {
        for angle in [0.01, 0.05, 0.4, 1.0, std::f64::consts::FRAC_PI_2] {
            let valley = valley(angle);
            let energy = |x: [f64; 3]| 0.5 * at(&valley, x).depth2;
            for n in 0..600 {
                let n = f64::from(n);
                let x = [
                    -0.2 + 0.8 * libm::sin(1.3 * n),
                    0.25 + 0.2 * libm::sin(2.1 * n),
                    libm::sin(n),
                ];
                let step = 1e-6;
                let way = at(&valley, x).way;
                for a in 0..3 {
                    let mut ends = [x, x];
                    ends[0][a] -= step;
                    ends[1][a] += step;
                    let slope = (energy(ends[1]) - energy(ends[0])) / (2.0 * step);
                    assert!(
                        (slope + way[a]).abs() < 4e-6,
                        "{angle} {x:?}: {slope} {way:?}"
                    );
                }
            }
        }
    }
}
