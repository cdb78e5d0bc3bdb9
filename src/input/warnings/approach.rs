//! When bodies meet, as far as their initial velocities tell.

use crate::model::{Body, Case, Vec3};
use crate::populate;

/// Bodies closer than this many spacings touch.
const TOUCH: f64 = 0.1;
/// Most points of a surface that are followed.
const MOST_POINTS: usize = 200_000;
/// Most steps of a point to the other surface; each goes as far as no surface can be.
const MOST_STEPS: usize = 200;

/// Two bodies, of which one at least deforms.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Approach {
    /// Their indices.
    pub bodies: [usize; 2],
    /// Room between them at the start, beyond that of bodies in touch, in mean spacings.
    pub gap: f64,
    /// Their relative speed (m/s).
    pub speed: f64,
    /// When they touch (s); infinite if never.
    pub time: f64,
}

/// All pairs of bodies whose velocities are constant until something is met.
pub fn approaches(case: &Case) -> Vec<Approach> {
    let mut found = Vec::new();
    for a in 0..case.bodies.len() {
        for b in a + 1..case.bodies.len() {
            found.extend(approach(case, a, b));
        }
    }
    found
}

/// Whether nothing but other bodies changes the velocity of a body.
pub fn flies_straight(case: &Case, body: usize) -> bool {
    let driven = case.loads.velocities.iter().any(|load| load.body == body);
    let motion = case.bodies[body].rigid.as_ref();
    let table = motion.is_some_and(|motion| motion.times.len() > 1);
    let falls = motion.is_none() && case.loads.gravity != [0.0; 3];
    !(driven || table || falls)
}

fn approach(case: &Case, a: usize, b: usize) -> Option<Approach> {
    let [first, second] = [&case.bodies[a], &case.bodies[b]];
    let both_rigid = first.rigid.is_some() && second.rigid.is_some();
    if both_rigid || !flies_straight(case, a) || !flies_straight(case, b) {
        return None;
    }
    let velocity = first.velocity - second.velocity;
    let there = from_points(case, first, second, velocity);
    let back = from_points(case, second, first, -velocity);
    let spacing = 0.5 * (first.lattice.spacing + second.lattice.spacing);
    Some(Approach {
        bodies: [a, b],
        gap: there.0.min(back.0) / spacing,
        speed: velocity.norm(),
        time: there.1.min(back.1),
    })
}

/// The smallest distance (m) of the outermost particles of `body` from where they touch `target`,
/// and the first time (s) at which one does, moving at `velocity` (m/s).
fn from_points(case: &Case, body: &Body, target: &Body, velocity: Vec3) -> (f64, f64) {
    let points = || populate::row_ends(body, case.dimension, &case.symmetry);
    let stride = points().count().div_ceil(MOST_POINTS).max(1);
    let spacing = body.lattice.spacing;
    let distance = |p: &Vec3| target.shape.distance(p, case.dimension) - 0.5 * spacing;
    let speed = velocity.norm();
    let (mut gap, mut time) = (f64::INFINITY, f64::INFINITY);
    for point in points().step_by(stride).map(Vec3::from) {
        let start = distance(&point);
        gap = gap.min(start);
        time = time.min(hit(
            &distance,
            point,
            start,
            velocity,
            TOUCH * spacing,
            time,
        ));
    }
    let resting = speed == 0.0 && gap > TOUCH * spacing;
    (gap, if resting { f64::INFINITY } else { time })
}

/// When a point at distance `start` comes closer than `near` (m); infinite if not before `until`.
fn hit(
    distance: impl Fn(&Vec3) -> f64,
    point: Vec3,
    start: f64,
    velocity: Vec3,
    near: f64,
    until: f64,
) -> f64 {
    let speed = velocity.norm();
    let (mut time, mut left) = (0.0, start);
    for _ in 0..MOST_STEPS {
        if left <= near {
            return time;
        }
        let next = time + left / speed;
        if !(next < until && next.is_finite()) {
            break;
        }
        time = next;
        left = distance(&(point + velocity * time));
    }
    f64::INFINITY
}
