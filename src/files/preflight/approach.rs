//! Times at which bodies meet, from their initial velocities.

use rayon::prelude::*;

use model::{Body, Case, Vec3};
use numerics::meetings::{Meetings, MovingBox};
use populate::{self, Searched, Searches, Wanted};

/// Bodies closer than this many spacings touch.
const TOUCH: f64 = 0.1;
/// Most steps of a body towards another; each goes as far as no contact is possible.
const MOST_STEPS: usize = 200;

/// Pairs of bodies that are followed for each body at most, as if there were so many bodies at least.
const MOST_OF_EACH: usize = 16;
const FEW: usize = 1000;

/// Smallest and largest coordinates (m) of a body's particles.
pub(super) type Ends = ([f64; 3], [f64; 3]);

/// Two bodies, of which one at least is not driven.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Approach {
    /// Their indices.
    pub bodies: [usize; 2],
    /// Initial gap between them, beyond that of touching bodies, in mean spacings.
    pub gap: f64,
    /// Their relative speed (m/s).
    pub speed: f64,
    /// Time of touch (s); infinite if never.
    pub time: f64,
}

/// The pairs of bodies that may meet with velocities that are constant until then, in the order of their indices.
/// Of very many, those that may by the end of the run, or by a part of it.
#[must_use]
pub fn approaches(case: &Case) -> Vec<Approach> {
    let straight = (0..case.bodies.len()).filter(|&body| flies_straight(case, body));
    let (indices, boxes): (Vec<usize>, Vec<MovingBox>) = straight
        .filter_map(|index| {
            let body = &case.bodies[index];
            let moving = MovingBox {
                extent: populate::surroundings(body, case.dimension)?,
                velocity: body.velocity.into(),
            };
            Some((index, moving))
        })
        .unzip();
    let most = MOST_OF_EACH * indices.len().max(FEW);
    let end = case.run.end_time;
    let untils = [f64::INFINITY, end, end / 16.0, end / 256.0];
    let meetings = Meetings::new(&boxes);
    let pairs = untils
        .iter()
        .find_map(|&until| Some((meetings.pairs(until, most)?, until)));
    let (pairs, until) = pairs.unwrap_or_else(|| {
        let pairs = meetings.pairs(0.0, usize::MAX);
        (pairs.unwrap_or_default(), 0.0)
    });
    let ends: Vec<Option<Ends>> = indices
        .iter()
        .map(|&index| populate::bounds(&case.bodies[index], case.dimension))
        .collect();
    let searches = Searches::new(case);
    let of_pair = |places: [usize; 2]| {
        let bodies = places.map(|place| indices[place]);
        let boxes = [ends[places[0]]?, ends[places[1]]?];
        may_meet(case, boxes, bodies, until).then_some(())?;
        approach(&searches, boxes, bodies)
    };
    pairs.into_par_iter().filter_map(of_pair).collect()
}

/// False of two bodies whose shapes keep them from touching each other until a time (s), by the boxes of their particles.
fn may_meet(case: &Case, boxes: [Ends; 2], bodies: [usize; 2], until: f64) -> bool {
    if until.is_infinite() {
        return true;
    }
    let [first, second] = bodies.map(|body| &case.bodies[body]);
    let way = (first.velocity - second.velocity).norm() * until;
    let directions = [(first, second, &boxes[0]), (second, first, &boxes[1])];
    directions
        .into_iter()
        .all(|(body, target, (lower, upper))| {
            let lattice = &body.lattice;
            let widest = 0.5 * lattice.coarsest();
            let least = target.shape.least_distance(lower, upper, case.dimension) - widest;
            least <= way + TOUCH * lattice.spacing
        })
}

/// Returns true if a body has one velocity, which nothing but other bodies changes.
pub fn flies_straight(case: &Case, body: usize) -> bool {
    let driven = case.loads.velocities.iter().any(|load| load.body == body);
    let motion = case.bodies[body].driven();
    let table = motion.is_some_and(|motion| motion.times.len() > 1);
    let falls = motion.is_none() && case.loads.moves_all();
    let spreads = case.bodies[body].speed_spread() > 0.0;
    !(driven || table || falls || spreads)
}

fn approach(searches: &Searches, boxes: [Ends; 2], bodies: [usize; 2]) -> Option<Approach> {
    let case = searches.case;
    let [first, second] = bodies.map(|body| &case.bodies[body]);
    if first.driven().is_some() && second.driven().is_some() {
        return None;
    }
    let velocity = first.velocity - second.velocity;
    let spacing = 0.5 * (first.lattice.spacing + second.lattice.spacing);
    // Shapes reach a little beyond their particles.
    let until = last_meeting(boxes, velocity, 4.0 * spacing);
    if until < 0.0 {
        return None;
    }
    let mut approach = Approach {
        bodies,
        gap: f64::INFINITY,
        speed: velocity.norm(),
        time: f64::INFINITY,
    };
    let ways = [(first, second, velocity), (second, first, -velocity)];
    for ((body, target, velocity), index) in ways.into_iter().zip(bodies) {
        let sites = Sites {
            body,
            search: searches.of(index),
            dimension: case.dimension,
        };
        let (gap, time) = towards(&sites, target, velocity, until);
        approach.gap = approach.gap.min(gap / spacing);
        approach.time = approach.time.min(time);
    }
    Some(approach)
}

/// The smallest distance (m) of the particles of a body from touching another, and the first time (s)
/// at which one touches, moving at `velocity` (m/s); infinite if later than `until` (s).
fn towards(sites: &Sites, target: &Body, velocity: Vec3, until: f64) -> (f64, f64) {
    let near = TOUCH * sites.body.lattice.spacing;
    let start = sites.nearest(target, Vec3::zeros());
    let (mut time, mut left) = (0.0, start);
    for _ in 0..MOST_STEPS {
        if left <= near {
            return (start, time);
        }
        time += left / velocity.norm();
        if !(time <= until && time.is_finite()) {
            break;
        }
        left = sites.nearest(target, velocity * time);
    }
    (start, f64::INFINITY)
}

/// Where the particles of a body begin.
struct Sites<'a> {
    body: &'a Body,
    search: &'a Searched,
    dimension: usize,
}

impl Sites<'_> {
    /// Their smallest distance (m), all moved by `way` (m), from touching `target`.
    fn nearest(&self, target: &Body, way: Vec3) -> f64 {
        let (shape, dimension, lattice) = (&target.shape, self.dimension, &self.body.lattice);
        let moved = |x: &[f64; 3]| Vec3::from(*x) + way;
        let widest = 0.5 * (lattice.coarsest() - lattice.spacing);
        let found = self.search.smallest(
            Wanted {
                most: 1,
                limit: f64::INFINITY,
                any: false,
            },
            |lower, upper| {
                let [lower, upper] = [lower, upper].map(|corner| moved(corner).into());
                shape.least_distance(&lower, &upper, dimension) - widest
            },
            |x| shape.distance(&moved(x), dimension) - lattice.wider(x),
        );
        let nearest = found
            .first()
            .map_or(f64::INFINITY, |(distance, _)| *distance);
        nearest - 0.5 * lattice.spacing
    }
}

/// The last time (s) at which two boxes, of which the first one moves at `velocity` (m/s), are no
/// farther apart than `near` (m) along any axis; negative if there is none.
fn last_meeting(boxes: [Ends; 2], velocity: Vec3, near: f64) -> f64 {
    let [(lower, upper), (other_lower, other_upper)] = boxes;
    let mut window = [0.0, f64::INFINITY];
    for a in 0..3 {
        let room = [
            other_lower[a] - upper[a] - near,
            other_upper[a] - lower[a] + near,
        ];
        if velocity[a] == 0.0 {
            if room[0] > 0.0 || room[1] < 0.0 {
                return f64::NEG_INFINITY;
            }
            continue;
        }
        let times = room.map(|room| room / velocity[a]);
        window[0] = f64::max(window[0], times[0].min(times[1]));
        window[1] = f64::min(window[1], times[0].max(times[1]));
    }
    if window[0] <= window[1] {
        window[1]
    } else {
        f64::NEG_INFINITY
    }
}
