//! Speeds of many bodies against each other.

use std::collections::HashMap;

use super::{Case, Vec3};
use numerics::extent::{Extent, around};
use numerics::tree::Tree;

/// Part of a speed by which bounds of it may be wrong by rounding.
const ROUNDING: f64 = 1e-12;

/// The velocities that the bodies of a case have as far as it says, see [`Case::impact_speed`]. One that many bodies
/// have is kept of two of them.
#[derive(Debug, Clone)]
pub struct ClosingSpeeds {
    known: Vec<Known>,
    tree: Tree<Range>,
}

/// A velocity of a body.
#[derive(Debug, Clone, Copy)]
struct Known {
    body: usize,
    /// m/s
    velocity: Vec3,
    /// By how much velocities within the body differ from that (m/s).
    spread: f64,
}

/// The range of some velocities (m/s), and the most of their spreads.
#[derive(Debug, Clone)]
struct Range {
    ends: Extent,
    spread: f64,
}

impl ClosingSpeeds {
    /// Of a case.
    #[must_use]
    pub fn new(case: &Case) -> Self {
        let mut seen: HashMap<[u64; 4], (usize, bool)> = HashMap::new();
        let mut known = Vec::new();
        for (body, of_body) in case.bodies.iter().enumerate() {
            let spread = of_body.speed_spread();
            for velocity in case.known_velocities(body) {
                let [x, y, z] = velocity.into();
                let (first, twice) = seen
                    .entry([x, y, z, spread].map(f64::to_bits))
                    .or_insert((usize::MAX, false));
                if *twice || *first == body {
                    continue;
                }
                *twice = *first != usize::MAX;
                *first = body;
                known.push(Known {
                    body,
                    velocity,
                    spread,
                });
            }
        }
        Self::of(known)
    }

    fn of(known: Vec<Known>) -> Self {
        let points: Vec<[f64; 3]> = known.iter().map(|one| one.velocity.into()).collect();
        let range = |all: &[usize]| Range {
            ends: around(all.iter().map(|&k| (points[k], points[k]))),
            spread: all.iter().fold(0.0, |most, &k| known[k].spread.max(most)),
        };
        let tree = Tree::new(&points, range);
        Self { known, tree }
    }

    /// The largest of two bodies (m/s); zero of a single one.
    #[must_use]
    pub fn largest(&self) -> f64 {
        let mut largest = 0.0;
        for one in &self.known {
            self.raise(one, &mut largest, f64::INFINITY);
        }
        largest
    }

    /// True if a body at a velocity (m/s) with a spread (m/s) is faster against another than a speed (m/s).
    pub(super) fn exceed(&self, body: usize, velocities: &[Vec3], spread: f64, speed: f64) -> bool {
        velocities.iter().any(|&velocity| {
            let mut largest = speed;
            let one = Known {
                body,
                velocity,
                spread,
            };
            self.raise(&one, &mut largest, speed);
            largest > speed
        })
    }

    /// Raises a speed (m/s) to the largest of one against other bodies, until it is above what is `enough`.
    fn raise(&self, one: &Known, largest: &mut f64, enough: f64) {
        self.tree.search(
            largest,
            |largest, all| {
                let (lower, upper) = all.ends;
                let farthest =
                    |a: usize| f64::max(one.velocity[a] - lower[a], upper[a] - one.velocity[a]);
                let farthest = Vec3::from(std::array::from_fn(farthest)).norm();
                let most = farthest + (one.spread + all.spread);
                *largest <= enough && most * (1.0 + ROUNDING) > *largest
            },
            |largest, all| {
                #[cfg(test)]
                LOOKS.set(LOOKS.get() + all.len());
                let others = all.iter().map(|&k| &self.known[k]);
                for other in others.filter(|other| other.body != one.body) {
                    let speed = (one.velocity - other.velocity).norm();
                    *largest = largest.max(speed + (one.spread + other.spread));
                }
            },
        );
    }
}

#[cfg(test)]
thread_local! {
    /// Velocities that were looked at.
    static LOOKS: std::cell::Cell<usize> = const { std::cell::Cell::new(0) };
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Velocities of one speed in all directions, of bodies that spread by less than it.
    fn all_around(count: u32) -> ClosingSpeeds {
        let known = (0..count).map(|k| {
            let [turn, height] = [7919, 104_729]
                .map(|factor: u32| f64::from(k.wrapping_mul(factor) % 99_991) / 99_991.0);
            let (z, angle) = (2.0 * height - 1.0, std::f64::consts::TAU * turn);
            let across = (1.0 - z * z).sqrt();
            Known {
                body: k as usize / 2,
                velocity: Vec3::new(across * libm::cos(angle), across * libm::sin(angle), z) * 50.0,
                spread: f64::from(k % 7),
            }
        });
        ClosingSpeeds::of(known.collect())
    }

    #[test]
    fn the_largest_is_that_of_all_pairs() {
        let speeds = all_around(300);
        let mut largest = 0.0;
        for a in &speeds.known {
            for b in speeds.known.iter().filter(|b| b.body != a.body) {
                let speed = (a.velocity - b.velocity).norm() + (a.spread + b.spread);
                largest = f64::max(largest, speed);
            }
        }
        assert_eq!(speeds.largest().to_bits(), f64::to_bits(largest));
        let one = &speeds.known[0];
        let exceed = |speed| speeds.exceed(one.body, &[one.velocity], one.spread, speed);
        assert!(exceed(99.0) && !exceed(largest));
    }

    #[test]
    fn many_velocities_are_not_compared_with_each_other() {
        let looks = |count| {
            let (speeds, before) = (all_around(count), LOOKS.get());
            let slow = 120.0;
            assert!(speeds.largest() < slow);
            for one in &speeds.known {
                assert!(!speeds.exceed(one.body, &[one.velocity], one.spread, slow));
            }
            LOOKS.get() - before
        };
        let [few, many] = [1000, 8000].map(looks);
        assert!(many < 16 * few, "{few} {many}");
    }
}
