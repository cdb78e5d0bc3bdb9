//! Debris: what flies beyond a plane, where and how fast.

use super::Whole;
use super::figure::{Distribution, Figure, Findings};
use super::flight::{ANGLE, AXIAL, HEIGHT, NUMBERS, RADIUS, SPEED, Scale, View};
use super::matter::Matter;
use super::outline::outline;
use super::remains::Remains;
use comm::Comm;
use model::{Debris, Slab};
use numerics::vector::square;

/// Bins between the extremes of which percentiles are read.
const BINS: usize = 4096;

/// Bins of mass by speed.
const SPEEDS: usize = 25;

/// Bins of mass by angle, of five degrees each.
const ANGLES: usize = 36;

/// Sums over all debris, images with it (SI).
struct Sums {
    mass: f64,
    count: f64,
    momentum: f64,
    radial: f64,
    kinetic: f64,
}

impl Sums {
    /// Finds the axis of the view, and the sums. Collective.
    fn find(view: &mut View, comm: &Comm) -> Self {
        let matter = view.matter;
        let whole = Whole::new(&matter.mirrors);
        let [part, x, y, z] = matter.sums::<4>(comm, |i, sums| {
            if view.is_debris[i] {
                let (m, [x, y, z]) = (matter.mass[i], matter.position[i]);
                sums.add(&[m, m * x, m * y, m * z]);
            }
        });
        let middle = whole.mean_position([x, y, z].map(|c| c / part));
        let [u, w, _] = view.frame.turned(&middle);
        view.axis = [u, w];
        let view = &*view;
        let sums = matter.sums::<4>(comm, |i, sums| {
            if view.is_debris[i] {
                let m = matter.mass[i];
                for flight in view.flights(i) {
                    let kinetic = 0.5 * m * square(&[flight.speed, 0.0, 0.0]);
                    sums.add(&[1.0, m * flight.axial, m * flight.radial, kinetic]);
                }
            }
        });
        let [count, momentum, radial, kinetic] = sums.map(|sum| view.alike() * sum);
        Self {
            mass: whole.sum(part),
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

/// The measures of debris; `of` is the plate or target that it left, with the momentum
/// (kg m/s) of what struck its face where this debris leaves that face. Collective.
pub fn debris(
    debris: &Debris,
    of: Option<(&Slab, &Remains)>,
    impulse: Option<f64>,
    matter: &Matter,
    comm: &Comm,
) -> Findings {
    let mut view = View::new(debris, of, matter);
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
    let ranges = view.ranges(comm);
    let [[lowest, highest], [_, farthest]] = [ranges[HEIGHT], ranges[RADIUS]];
    let [heights, radii, velocities, angles, by_speed, by_angle] =
        view.spreads(comm, scales(&ranges), sums.mass);
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
    let distributions = vec![
        by_speed.distribution("mass_by_speed", "m/s"),
        by_angle.distribution("mass_by_angle", "deg"),
    ];
    (figures, distributions)
}

/// Scales of mass by numbers between such limits.
fn scales(ranges: &[[f64; 2]; NUMBERS]) -> [Scale; 6] {
    let between = |number: usize| Scale {
        number,
        range: widened(ranges[number]),
        bins: BINS,
    };
    let by_speed = Scale {
        number: SPEED,
        range: widened([0.0, ranges[SPEED][1]]),
        bins: SPEEDS,
    };
    let by_angle = Scale {
        number: ANGLE,
        range: [0.0, 180.0],
        bins: ANGLES,
    };
    let all = [HEIGHT, RADIUS, AXIAL, ANGLE].map(between);
    let [heights, radii, velocities, angles] = all;
    [heights, radii, velocities, angles, by_speed, by_angle]
}

/// Limits that are not the same.
fn widened([low, high]: [f64; 2]) -> [f64; 2] {
    let least = 1e-9 * low.abs().max(high.abs()).max(f64::MIN_POSITIVE);
    [low, high.max(low + least)]
}
