//! Flight of debris: each particle against the plane and the axis, and mass by any of it.

use rayon::prelude::*;

use super::figure::Distribution;
use super::frame::Frame;
use super::matter::{Matter, raise};
use super::remains::{Belongs, Remains};
use comm::Comm;
use model::{Debris, Slab};
use numerics::vector::{dot, norm};
use particles::{MirrorMask, Mirrors};

/// All mass, in whole numbers.
const UNIT: f64 = 17_592_186_044_416.0;

/// Flight of a particle's image.
#[derive(Clone, Copy)]
pub struct Flight {
    /// Height (m) above the plane.
    pub height: f64,
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

/// Length of [`Flight::numbers`].
pub const NUMBERS: usize = 5;

/// Place of the height in them, of the others likewise.
pub const HEIGHT: usize = 0;
pub const RADIUS: usize = 1;
pub const AXIAL: usize = 2;
pub const ANGLE: usize = 3;
pub const SPEED: usize = 4;

impl Flight {
    /// Height and radius (m), velocity along the flight (m/s), its angle to the direction (°), and speed (m/s).
    #[must_use]
    fn numbers(&self) -> [f64; NUMBERS] {
        let angle = libm::atan2(self.lateral, self.axial).to_degrees();
        [self.height, self.radius, self.axial, angle, self.speed]
    }
}

/// Debris, and the view of it.
pub struct View<'a> {
    pub debris: &'a Debris,
    pub matter: &'a Matter<'a>,
    pub frame: Frame,
    /// The axis through the middle of all, across the flight.
    pub axis: [f64; 2],
    /// Flags of the particles that are debris.
    pub is_debris: Vec<bool>,
    /// Mirror masks of the particle itself and of its images behind symmetry planes that the flight does
    /// not run along.
    mirror_masks: Vec<MirrorMask>,
    /// Number of images that fly as each of them does, itself with them.
    alike: u32,
}

/// Scale of debris by one of the numbers of [`Flight::numbers`].
#[derive(Clone, Copy)]
pub struct Scale {
    pub number: usize,
    pub range: [f64; 2],
    pub bins: usize,
}

impl Scale {
    fn width(&self) -> f64 {
        #[expect(clippy::cast_precision_loss, reason = "small")]
        let bins = self.bins as f64;
        (self.range[1] - self.range[0]) / bins
    }
}

/// Flags of the particles that are debris.
fn is_debris(debris: &Debris, of: Option<(&Slab, &Remains)>, matter: &Matter) -> Vec<bool> {
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

impl<'a> View<'a> {
    /// Of debris that has left a plate or a target.
    pub fn new(debris: &'a Debris, of: Option<(&Slab, &Remains)>, matter: &'a Matter<'a>) -> Self {
        let along = |a: &usize| debris.direction[*a] == 0.0;
        let planes = (0..3).filter(along);
        let planes = planes.fold(MirrorMask::OWN, MirrorMask::with);
        let images = || matter.mirrors.masks();
        let alike = images()
            .filter(|mirror_mask| mirror_mask.is_within(planes))
            .count();
        Self {
            debris,
            matter,
            frame: Frame::new(&debris.direction),
            axis: [0.0; 2],
            is_debris: is_debris(debris, of, matter),
            mirror_masks: images()
                .filter(|mirror_mask| mirror_mask.is_disjoint(planes))
                .collect(),
            alike: u32::try_from(alike).unwrap_or(1),
        }
    }

    /// Number of images that each of the flights of a particle speaks for.
    #[must_use]
    pub fn alike(&self) -> f64 {
        f64::from(self.alike)
    }

    /// Flight of a particle, and those of its images that fly otherwise.
    pub fn flights(&self, i: usize) -> impl Iterator<Item = Flight> {
        let base = dot(&self.debris.direction, &self.debris.point);
        let (x, v) = (&self.matter.position[i], &self.matter.velocity[i]);
        let mirrors = &self.matter.mirrors;
        self.mirror_masks.iter().map(move |&mirror_mask| {
            let place = self.frame.turned(&mirrors.reflect_position(x, mirror_mask));
            let way = self.frame.turned(&Mirrors::reflect_vector(v, mirror_mask));
            let across = [place[0] - self.axis[0], place[1] - self.axis[1]];
            let radius = (across[0] * across[0] + across[1] * across[1]).sqrt();
            let sideways = across[0] * way[0] + across[1] * way[1];
            let radial = if radius > 0.0 { sideways / radius } else { 0.0 };
            let lateral = (way[0] * way[0] + way[1] * way[1]).sqrt();
            Flight {
                height: place[2] - base,
                radius,
                axial: way[2],
                radial,
                speed: norm(v),
                lateral,
            }
        })
    }

    /// Least and greatest of the numbers of all debris. Collective.
    pub fn ranges(&self, comm: &Comm) -> [[f64; 2]; NUMBERS] {
        let found = self.matter.largest::<{ 2 * NUMBERS }>(comm, |i, most| {
            if self.is_debris[i] {
                for flight in self.flights(i) {
                    for (most, value) in most.chunks_exact_mut(2).zip(flight.numbers()) {
                        raise(&mut most[0], -value);
                        raise(&mut most[1], value);
                    }
                }
            }
        });
        std::array::from_fn(|k| [0.0 - found[2 * k], found[2 * k + 1]])
    }

    /// Mass by each of some scales, in parts of all mass (kg) that add up to [`UNIT`]. Collective.
    pub fn spreads<const N: usize>(
        &self,
        comm: &Comm,
        scales: [Scale; N],
        mass: f64,
    ) -> [Spread; N] {
        let total = scales.iter().map(|scale| scale.bins).sum();
        let counts = self.matter.counts(comm, total, |i, counts| {
            if !self.is_debris[i] {
                return;
            }
            #[expect(clippy::cast_possible_truncation, reason = "a part of the unit")]
            let share = (self.matter.mass[i] / mass * UNIT).round() as i64;
            let share = share * i64::from(self.alike);
            for flight in self.flights(i) {
                let numbers = flight.numbers();
                let mut rest = &mut *counts;
                for scale in &scales {
                    let (own, others) = rest.split_at_mut(scale.bins);
                    let at = (numbers[scale.number] - scale.range[0]) / scale.width();
                    #[expect(
                        clippy::cast_possible_truncation,
                        clippy::cast_sign_loss,
                        reason = "no less than zero and cut at the last bin"
                    )]
                    let bin = at.max(0.0) as usize;
                    own[bin.min(scale.bins - 1)] += share;
                    rest = others;
                }
            }
        });
        let mut rest = &counts[..];
        scales.map(|scale| {
            let (own, others) = rest.split_at(scale.bins);
            rest = others;
            Spread {
                low: scale.range[0],
                width: scale.width(),
                counts: own.to_vec(),
                mass,
            }
        })
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
