//! Speeds of many bodies against each other.

use std::collections::HashMap;

use super::{Case, Vec3};

/// Part of a speed by which bounds of it may be wrong by rounding.
const ROUNDING: f64 = 1e-12;

/// The velocities that the bodies of a case have as far as it says, see [`Case::closing_speed`]. One that many bodies
/// have is kept of two of them.
#[derive(Debug, Clone)]
pub struct ClosingSpeeds {
    /// The farthest from the middle of all first.
    known: Vec<Known>,
    middle: Vec3,
}

/// A velocity of a body.
#[derive(Debug, Clone, Copy)]
struct Known {
    body: usize,
    /// m/s
    velocity: Vec3,
    /// By how much velocities within the body differ from that (m/s).
    spread: f64,
    /// Its speed against the middle of all, with the spread (m/s).
    beyond: f64,
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
                    beyond: 0.0,
                });
            }
        }
        let lower = known
            .iter()
            .fold(Vec3::repeat(f64::INFINITY), |least, one| {
                least.inf(&one.velocity)
            });
        let upper = known
            .iter()
            .fold(Vec3::repeat(f64::NEG_INFINITY), |most, one| {
                most.sup(&one.velocity)
            });
        let middle = 0.5 * (lower + upper);
        for one in &mut known {
            one.beyond = (one.velocity - middle).norm() + one.spread;
        }
        known.sort_by(|a, b| b.beyond.total_cmp(&a.beyond));
        Self { known, middle }
    }

    /// The largest of two bodies (m/s); zero of a single one.
    #[must_use]
    pub fn largest(&self) -> f64 {
        self.known.iter().fold(0.0, |largest, one| {
            self.beyond(one, |one, other| one.body != other.body, largest)
        })
    }

    /// True if a body at a velocity (m/s) with a spread (m/s) is faster against another than a speed (m/s).
    pub(super) fn exceed(&self, body: usize, velocities: &[Vec3], spread: f64, speed: f64) -> bool {
        velocities.iter().any(|&velocity| {
            let one = Known {
                body,
                velocity,
                spread,
                beyond: (velocity - self.middle).norm() + spread,
            };
            self.beyond(&one, |one, other| one.body != other.body, speed) > speed
        })
    }

    /// The largest speed (m/s) of one against some of the others, or `least` if that is larger.
    fn beyond(&self, one: &Known, counts: impl Fn(&Known, &Known) -> bool, least: f64) -> f64 {
        let mut largest = least;
        for other in &self.known {
            // None of those that follow is faster.
            if (one.beyond + other.beyond) * (1.0 + ROUNDING) <= largest {
                break;
            }
            if counts(one, other) {
                let speed = (one.velocity - other.velocity).norm() + (one.spread + other.spread);
                largest = largest.max(speed);
            }
        }
        largest
    }
}
