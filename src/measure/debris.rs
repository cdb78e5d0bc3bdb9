//! Debris: what flies beyond a plane, where and how fast.

use super::figure::{Distribution, Figure, Findings};
use super::frame::Frame;
use super::mask::Mask;
use super::matter::{Matter, raise};
use super::remains::{Belongs, Remains};
use crate::comm::Comm;
use crate::model::{Debris, Slab};
use crate::numerics::vector::{dot, norm, square};

/// Bins between the extremes of which percentiles are read.
const BINS: usize = 4096;

/// All mass, in whole numbers.
const UNIT: f64 = (1_u64 << 44) as f64;

/// Bins of mass by speed.
const SPEEDS: usize = 25;

/// Bins of mass by angle, of five degrees each.
const ANGLES: usize = 36;

/// Most cells of the outline along the flight.
const CELLS: f64 = 192.0;

/// Particles that make a cell of the outline.
const LEAST: f64 = 2.0;

/// How a particle's image flies.
#[derive(Clone, Copy)]
struct Flight {
    /// Height (m) above the plane.
    height: f64,
    /// Place (m) across the flight, from the middle of all.
    across: [f64; 2],
    /// Distance (m) from the axis through the middle of all.
    radius: f64,
    /// Velocity along the flight (m/s).
    axial: f64,
    /// Velocity away from the axis (m/s).
    radial: f64,
    /// Speed (m/s).
    speed: f64,
    /// Angle of the velocity to the direction (°).
    angle: f64,
}

/// What is debris, and how it is looked at.
struct View<'a> {
    debris: &'a Debris,
    /// The plate or target that it left, and what remains of that.
    of: Option<(&'a Slab, &'a Remains)>,
    matter: &'a Matter<'a>,
    frame: Frame,
    /// The axis through the middle of all, across the flight.
    axis: [f64; 2],
}

impl View<'_> {
    /// Whether a particle is debris.
    fn is_debris(&self, i: usize) -> bool {
        let (x, body) = (&self.matter.position[i], self.matter.body_of(i));
        let beyond =
            dot(&self.debris.direction, x) > dot(&self.debris.direction, &self.debris.point);
        let leaves = dot(&self.debris.direction, &self.matter.velocity[i]) > 0.0;
        if !beyond || !leaves || !self.debris.bodies.contains(&body) {
            return false;
        }
        match self.of {
            Some((slab, remains)) if slab.body == body => remains.holds(x) == Belongs::No,
            _ => true,
        }
    }

    /// How the images of a particle fly.
    fn flights(&self, i: usize) -> impl Iterator<Item = Flight> {
        let base = dot(&self.debris.direction, &self.debris.point);
        self.matter.images(i).map(move |(x, v)| {
            let (place, way) = (self.frame.turned(&x), self.frame.turned(&v));
            let across = [place[0] - self.axis[0], place[1] - self.axis[1]];
            let radius = libm::hypot(across[0], across[1]);
            let sideways = across[0] * way[0] + across[1] * way[1];
            let radial = if radius > 0.0 { sideways / radius } else { 0.0 };
            let lateral = libm::hypot(way[0], way[1]);
            Flight {
                height: place[2] - base,
                across,
                radius,
                axial: way[2],
                radial,
                speed: norm(&v),
                angle: libm::atan2(lateral, way[2]).to_degrees(),
            }
        })
    }

    /// The greatest of something among all debris, and the greatest of its opposite.
    fn range(&self, comm: &Comm, of: impl Fn(&Flight) -> f64 + Sync) -> [f64; 2] {
        let [most, least] = self.matter.largest::<2>(comm, |i, most| {
            if self.is_debris(i) {
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
    fn spread(
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
            if !self.is_debris(i) {
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
struct Spread {
    low: f64,
    width: f64,
    counts: Vec<i64>,
    mass: f64,
}

impl Spread {
    /// Below which a part of all mass lies.
    fn percentile(&self, part: f64) -> f64 {
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
    fn distribution(&self, name: &'static str, along: &'static str) -> Distribution {
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

/// Length and width (m) of the outline, and its cell.
struct Outline {
    length: f64,
    width: f64,
    cell: f64,
}

/// The largest part of the debris, seen from the side, that has the areal mass of the outline.
fn outline(view: &View, comm: &Comm, heights: [f64; 2], radius: f64, mass_of_one: f64) -> Outline {
    let debris = view.debris;
    let length = heights[1] - heights[0];
    let least = (LEAST * mass_of_one / debris.outline).sqrt();
    let cell = debris.spacing.max(length / CELLS).max(least);
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "positive, and cut"
    )]
    let count = |size: f64| (size / cell).ceil().clamp(1.0, 4.0 * CELLS) as usize;
    let (rows, half) = (count(length), count(radius));
    let across = 2 * half;
    // Whole numbers of 2⁻³⁰ of what makes the outline.
    let full = debris.outline * cell * cell;
    let scale = f64::from(1 << 30);
    let counts = view.matter.counts(comm, rows * across, |i, counts| {
        if !view.is_debris(i) {
            return;
        }
        #[expect(clippy::cast_possible_truncation, reason = "some particles in a cell")]
        let share = (view.matter.mass[i] / full * scale).round() as i64;
        for flight in view.flights(i) {
            let at = [
                (flight.height - heights[0]) / cell,
                flight.across[0] / cell + f64::from(u32::try_from(half).unwrap_or(u32::MAX)),
            ];
            #[expect(clippy::cast_precision_loss, reason = "small")]
            let inside =
                at[0] >= 0.0 && at[0] < rows as f64 && at[1] >= 0.0 && at[1] < across as f64;
            if inside {
                #[expect(
                    clippy::cast_possible_truncation,
                    clippy::cast_sign_loss,
                    reason = "inside"
                )]
                let [row, column] = at.map(|at| at as usize);
                counts[row * across + column] += share;
            }
        }
    });
    #[expect(clippy::cast_precision_loss, reason = "rounded once")]
    let cells = counts.iter().map(|&count| count as f64 >= scale).collect();
    let part = Mask::new([rows, across], cells).largest_part();
    let (mut lower, mut upper) = ([usize::MAX; 2], [0; 2]);
    for found in part.cells() {
        for (a, at) in [found / across, found % across].into_iter().enumerate() {
            lower[a] = lower[a].min(at);
            upper[a] = upper[a].max(at + 1);
        }
    }
    #[expect(clippy::cast_precision_loss, reason = "small")]
    let [length, width] = std::array::from_fn(|a| upper[a].saturating_sub(lower[a]) as f64 * cell);
    Outline {
        length,
        width,
        cell,
    }
}

/// Sums over all debris, images with it (SI).
struct Sums {
    mass: f64,
    count: f64,
    momentum: f64,
    radial: f64,
    kinetic: f64,
}

impl Sums {
    /// Finds the axis of the view, and the sums.
    fn find(view: &mut View, comm: &Comm) -> Self {
        let frame = view.frame;
        let [mass, u, w] = view.matter.sums::<3>(comm, |i, sums| {
            if view.is_debris(i) {
                let m = view.matter.mass[i];
                for (x, _) in view.matter.images(i) {
                    let place = frame.turned(&x);
                    sums[0].add(m);
                    sums[1].add(m * place[0]);
                    sums[2].add(m * place[1]);
                }
            }
        });
        view.axis = [u / mass, w / mass];
        let view = &*view;
        let [count, momentum, radial, kinetic] = view.matter.sums::<4>(comm, |i, sums| {
            if view.is_debris(i) {
                let m = view.matter.mass[i];
                for flight in view.flights(i) {
                    sums[0].add(1.0);
                    sums[1].add(m * flight.axial);
                    sums[2].add(m * flight.radial);
                    sums[3].add(0.5 * m * square(&[flight.speed, 0.0, 0.0]));
                }
            }
        });
        Self {
            mass,
            count,
            momentum,
            radial,
            kinetic,
        }
    }
}

/// Names of the figures where there is no debris.
const NONE: [(&str, &str); 16] = [
    ("front", "m"),
    ("front_99", "m"),
    ("middle_50", "m"),
    ("rear_1", "m"),
    ("radius_50", "m"),
    ("radius_90", "m"),
    ("radius_99", "m"),
    ("axial_velocity", "m/s"),
    ("axial_velocity_99", "m/s"),
    ("axial_velocity_50", "m/s"),
    ("axial_velocity_1", "m/s"),
    ("angle_50", "deg"),
    ("angle_90", "deg"),
    ("outline_length", "m"),
    ("outline_width", "m"),
    ("outline_ratio", ""),
];

/// What there is to tell of debris; `of` is the plate or target that it left, with the momentum
/// (kg m/s) of what struck its face where this debris leaves that face. Collective.
pub fn debris(
    debris: &Debris,
    of: Option<(&Slab, &Remains)>,
    impulse: Option<f64>,
    matter: &Matter,
    comm: &Comm,
) -> Findings {
    let mut view = View {
        debris,
        of,
        matter,
        frame: Frame::new(&debris.direction),
        axis: [0.0; 2],
    };
    let sums = Sums::find(&mut view, comm);
    let number = Figure::number;
    let mut figures = vec![
        number("mass", sums.mass, "kg"),
        number("axial_momentum", sums.momentum, "kg m/s"),
        number("radial_momentum", sums.radial, "kg m/s"),
        number("kinetic_energy", sums.kinetic, "J"),
    ];
    if let Some(impulse) = impulse.filter(|impulse| *impulse > 0.0) {
        let beta = 1.0 + sums.momentum / impulse;
        figures.push(number("momentum_enhancement", beta, ""));
    }
    if sums.mass == 0.0 {
        figures.extend(NONE.map(|(name, unit)| number(name, f64::NAN, unit)));
        return Findings {
            figures,
            distributions: Vec::new(),
        };
    }
    let (cloud, distributions) = cloud(&view, &sums, comm);
    figures.extend(cloud);
    Findings {
        figures,
        distributions,
    }
}

/// Extents, velocities and outline of debris that there is.
fn cloud(view: &View, sums: &Sums, comm: &Comm) -> (Vec<Figure>, Vec<Distribution>) {
    let number = Figure::number;
    let spread = |of: fn(&Flight) -> f64| {
        let range = view.range(comm, of);
        (
            view.spread(comm, widened(range), BINS, sums.mass, of),
            range,
        )
    };
    let (heights, [lowest, highest]) = spread(|flight| flight.height);
    let (radii, [_, farthest]) = spread(|flight| flight.radius);
    let (velocities, _) = spread(|flight| flight.axial);
    let (angles, _) = spread(|flight| flight.angle);
    let seen = outline(
        view,
        comm,
        [lowest, highest],
        farthest,
        sums.mass / sums.count,
    );
    let spacing = view.debris.spacing;
    let length = |name, value: f64, bin: f64| number(name, value, "m").within(spacing.max(bin));
    let speed =
        |name, part| number(name, velocities.percentile(part), "m/s").within(velocities.width);
    let angle = |name, part| number(name, angles.percentile(part), "deg").within(angles.width);
    let size = |name, value: f64| number(name, value, "m").within(seen.cell);
    let ratio = seen.length / seen.width;
    let doubt = ratio * (seen.cell / seen.length + seen.cell / seen.width);
    let figures = vec![
        length("front", highest, 0.0),
        length("front_99", heights.percentile(0.99), heights.width),
        length("middle_50", heights.percentile(0.5), heights.width),
        length("rear_1", heights.percentile(0.01), heights.width),
        length("radius_50", radii.percentile(0.5), radii.width),
        length("radius_90", radii.percentile(0.9), radii.width),
        length("radius_99", radii.percentile(0.99), radii.width),
        number("axial_velocity", sums.momentum / sums.mass, "m/s"),
        speed("axial_velocity_99", 0.99),
        speed("axial_velocity_50", 0.5),
        speed("axial_velocity_1", 0.01),
        angle("angle_50", 0.5),
        angle("angle_90", 0.9),
        size("outline_length", seen.length),
        size("outline_width", seen.width),
        number("outline_ratio", ratio, "").within(doubt),
    ];
    let [_, fastest] = view.range(comm, |flight| flight.speed);
    let speeds = view.spread(comm, widened([0.0, fastest]), SPEEDS, sums.mass, |flight| {
        flight.speed
    });
    let by_angle = view.spread(comm, [0.0, 180.0], ANGLES, sums.mass, |flight| flight.angle);
    let distributions = vec![
        speeds.distribution("mass_by_speed", "m/s"),
        by_angle.distribution("mass_by_angle", "deg"),
    ];
    (figures, distributions)
}

/// Limits that are not the same.
fn widened([low, high]: [f64; 2]) -> [f64; 2] {
    let least = 1e-9 * low.abs().max(high.abs()).max(f64::MIN_POSITIVE);
    [low, high.max(low + least)]
}
