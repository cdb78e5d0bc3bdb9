//! How debris flies: each particle against the plane and the axis, and mass by any of it.

use rayon::prelude::*;

use super::figure::Distribution;
use super::frame::Frame;
use super::matter::{Matter, raise};
use super::remains::{Belongs, Remains};
use crate::comm::Comm;
use crate::model::{Debris, Slab};
use crate::numerics::vector::{dot, norm};

/// All mass, in whole numbers.
const UNIT: f64 = 17_592_186_044_416.0;

/// How a particle's image flies.
#[derive(Clone, Copy)]
pub struct Flight {
    /// Height (m) above the plane.
    pub height: f64,
    /// Place (m) across the flight, from the middle of all.
    pub across: [f64; 2],
    /// Distance (m) from the axis through the middle of all.
    pub radius: f64,
    /// Velocity along the flight (m/s).
    pub axial: f64,
    /// Velocity away from the axis (m/s).
    pub radial: f64,
    /// Speed (m/s).
    pub speed: f64,
    /// Velocity across the flight (m/s).
    pub lateral: f64,
}

impl Flight {
    /// Angle of the velocity to the direction (°).
    #[must_use]
    pub fn angle(&self) -> f64 {
        libm::atan2(self.lateral, self.axial).to_degrees()
    }
}

/// What is debris, and how it is looked at.
pub struct View<'a> {
    pub debris: &'a Debris,
    pub matter: &'a Matter<'a>,
    pub frame: Frame,
    /// The axis through the middle of all, across the flight.
    pub axis: [f64; 2],
    /// Which particles are debris.
    pub is_debris: Vec<bool>,
}

/// Which particles are debris.
pub fn is_debris(debris: &Debris, of: Option<(&Slab, &Remains)>, matter: &Matter) -> Vec<bool> {
    let base = dot(&debris.direction, &debris.point);
    let is = |i: usize| {
        let body = matter.body_of(i);
        let beyond = dot(&debris.direction, &matter.position[i]) > base;
        let leaves = dot(&debris.direction, &matter.velocity[i]) > 0.0;
        beyond
            && leaves
            && debris.bodies.contains(&body)
            && of.is_none_or(|(slab, remains)| slab.body != body || remains.holds(i) == Belongs::No)
    };
    (0..matter.len()).into_par_iter().map(is).collect()
}

impl View<'_> {
    /// How the images of a particle fly.
    pub fn flights(&self, i: usize) -> impl Iterator<Item = Flight> {
        let base = dot(&self.debris.direction, &self.debris.point);
        self.matter.images(i).map(move |(x, v)| {
            let (place, way) = (self.frame.turned(&x), self.frame.turned(&v));
            let across = [place[0] - self.axis[0], place[1] - self.axis[1]];
            let radius = (across[0] * across[0] + across[1] * across[1]).sqrt();
            let sideways = across[0] * way[0] + across[1] * way[1];
            let radial = if radius > 0.0 { sideways / radius } else { 0.0 };
            let lateral = (way[0] * way[0] + way[1] * way[1]).sqrt();
            Flight {
                height: place[2] - base,
                across,
                radius,
                axial: way[2],
                radial,
                speed: norm(&v),
                lateral,
            }
        })
    }

    /// The greatest of something among all debris, and the greatest of its opposite.
    pub fn range(&self, comm: &Comm, of: impl Fn(&Flight) -> f64 + Sync) -> [f64; 2] {
        let [most, least] = self.matter.largest::<2>(comm, |i, most| {
            if self.is_debris[i] {
                for flight in self.flights(i) {
                    let value = of(&flight);
                    raise(&mut most[0], value);
                    raise(&mut most[1], -value);
                }
            }
        });
        [0.0 - least, most]
    }

    /// Mass by something between two limits, in parts of all mass (kg) that add up to [`UNIT`].
    pub fn spread(
        &self,
        comm: &Comm,
        [low, high]: [f64; 2],
        bins: usize,
        mass: f64,
        of: impl Fn(&Flight) -> f64 + Sync,
    ) -> Spread {
        #[expect(clippy::cast_precision_loss, reason = "small")]
        let width = (high - low) / bins as f64;
        let counts = self.matter.counts(comm, bins, |i, counts| {
            if !self.is_debris[i] {
                return;
            }
            #[expect(clippy::cast_possible_truncation, reason = "a part of the unit")]
            let share = (self.matter.mass[i] / mass * UNIT).round() as i64;
            for flight in self.flights(i) {
                #[expect(
                    clippy::cast_possible_truncation,
                    clippy::cast_sign_loss,
                    reason = "no less than zero and cut at the last bin"
                )]
                let bin = ((of(&flight) - low) / width).max(0.0) as usize;
                counts[bin.min(bins - 1)] += share;
            }
        });
        Spread {
            low,
            width,
            counts,
            mass,
        }
    }
}

/// Mass by bins.
pub struct Spread {
    low: f64,
    pub width: f64,
    counts: Vec<i64>,
    mass: f64,
}

impl Spread {
    /// Below which a part of all mass lies.
    pub fn percentile(&self, part: f64) -> f64 {
        let total: i64 = self.counts.iter().sum();
        #[expect(clippy::cast_precision_loss, reason = "rounded once")]
        let wanted = part * total as f64;
        let mut below = 0.0;
        for (k, &count) in (0_u32..).zip(&self.counts) {
            #[expect(clippy::cast_precision_loss, reason = "rounded once")]
            let count = count as f64;
            if count > 0.0 && below + count >= wanted {
                let inside = (wanted - below) / count;
                return self.low + (f64::from(k) + inside) * self.width;
            }
            below += count;
        }
        f64::NAN
    }

    /// As a distribution of mass.
    pub fn distribution(&self, name: &'static str, along: &'static str) -> Distribution {
        let bin = |(k, &count): (u32, &i64)| {
            let from = self.low + f64::from(k) * self.width;
            #[expect(clippy::cast_precision_loss, reason = "rounded once")]
            let mass = count as f64 / UNIT * self.mass;
            [from, from + self.width, mass]
        };
        Distribution {
            name,
            along,
            unit: "kg",
            bins: (0_u32..).zip(&self.counts).map(bin).collect(),
        }
    }
}
