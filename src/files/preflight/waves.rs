//! Particles that waves have reached by a time. Particles at rest cost next to nothing, see the theory page "Smoothed
//! particle hydrodynamics".

use std::collections::BTreeMap;

use rayon::prelude::*;

use super::approach::{Approach, Ends, flies_straight};
use material::Rest;
use model::{Body, Case, Heat, SphForm, Vec3};
use populate::{self, Brick, Site};

/// Distance of not negligible values ahead of sound, in spacings, measured in the quarter impact.
const AHEAD: f64 = 16.0;

/// Distance beyond that, in spacings, of particles at rest that are not inactive, measured on targets.
const AWAKE: f64 = 34.0;

/// Work of a particle at rest over that of another.
pub const RESTING: f64 = 0.21;

/// Work of an inactive particle over that of a moving one.
const SLEEPING: f64 = 0.01;

/// Times of a run at which its particles are examined.
pub const TIMES: usize = 8;

/// Positions examined in a body at most.
const SAMPLES: usize = 20_000;

/// Distances of positions from strikes at most that a share of the work is found from.
const MOST_LOOKS: usize = 4_000_000;

/// Prediction of the particles of a case that wait for a wave.
#[derive(Debug, Clone)]
pub struct Waves {
    /// By body, its rest; `None` if it moves from the start.
    still: Vec<Option<Still>>,
    /// Bodies that strike any of them.
    strikes: Vec<Strike>,
}

/// A body at rest.
#[derive(Debug, Clone, Copy)]
struct Still {
    /// Speed of sound (m/s).
    speed: f64,
    /// Distance of the wave ahead of sound (m).
    ahead: f64,
    /// Distance from the wave up to which particles are active (m).
    awake: f64,
}

/// The times of a run at which a particle waits, a bit for each.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Waiting {
    rests: u8,
    sleeps: u8,
}

impl Waiting {
    /// Work at one of the times over that of a moving particle.
    #[must_use]
    pub fn work(self, time: usize) -> f64 {
        let is_so = |bits: u8| bits >> time & 1 == 1;
        match (is_so(self.sleeps), is_so(self.rests)) {
            (true, _) => SLEEPING,
            (false, true) => RESTING,
            (false, false) => 1.0,
        }
    }
}

/// A body that strikes others.
#[derive(Debug, Clone, Copy)]
struct Strike {
    /// Time at which it touches another (s).
    time: f64,
    /// Its bounds then.
    ends: Ends,
    /// Its velocity (m/s).
    velocity: [f64; 3],
}

impl Waves {
    /// Of a case with these approaches; `None` if nothing rests, or for an unknown time.
    #[must_use]
    pub fn new(case: &Case, approaches: &[Approach]) -> Option<Self> {
        let still = waiting(case)?;
        // Bodies that turn or follow a table meet others at an unknown time: at once is on the safe side.
        let unforeseen = (0..case.bodies.len())
            .filter(|&body| still[body].is_none() && !flies_straight(case, body));
        // Waves of the first strike of a body are ahead of those of the later ones.
        let mut first: BTreeMap<usize, f64> = unforeseen.map(|body| (body, 0.0)).collect();
        for pair in approaches {
            let waits = pair.bodies.iter().any(|&body| still[body].is_some());
            if waits && pair.time.is_finite() {
                let moves = |body: &usize| case.bodies[*body].velocity.norm() > 0.0;
                for body in pair.bodies.into_iter().filter(moves) {
                    let time = first.entry(body).or_insert(f64::INFINITY);
                    *time = time.min(pair.time);
                }
            }
        }
        let strikes = first.into_iter();
        let strikes = strikes.filter_map(|(body, time)| strike(case, body, time));
        Some(Self {
            still,
            strikes: strikes.collect(),
        })
    }

    /// Distance (m) of waves from a position (m) in a body at a time (s), negative where they have been. They go from any
    /// body to any other as they do within one.
    fn distance(&self, still: &Still, position: &[f64; 3], time: f64) -> f64 {
        let strikes = self.strikes.iter().filter(|strike| time >= strike.time);
        let left = strikes.map(|strike| {
            let since = time - strike.time;
            strike.distance(position, since) - still.speed * since - still.ahead
        });
        left.fold(f64::INFINITY, f64::min)
    }

    /// The times (s) at which a particle of a body at a position (m) waits.
    #[must_use]
    pub fn waiting(&self, body: usize, position: &[f64; 3], times: &[f64; TIMES]) -> Waiting {
        let mut waiting = Waiting::default();
        if let Some(still) = self.still.get(body).and_then(Option::as_ref) {
            for (k, &time) in times.iter().enumerate() {
                let distance = self.distance(still, position, time);
                waiting.rests |= u8::from(distance > 0.0) << k;
                waiting.sleeps |= u8::from(distance > still.awake) << k;
            }
        }
        waiting
    }

    /// Times of a run (s) from one on, in the middle of even intervals.
    #[must_use]
    pub fn times(case: &Case, from: f64) -> [f64; TIMES] {
        let each = (case.run.end_time - from).max(0.0) / as_number(TIMES as u64);
        std::array::from_fn(|k| from + each * (as_number(k as u64) + 0.5))
    }

    /// Work of a step from a time (s) on over that if nothing rested.
    #[must_use]
    pub fn share_of_work(&self, case: &Case, from: f64) -> f64 {
        let (mut work, mut all) = (0.0, 0.0);
        let times = Self::times(case, from);
        let bodies = case.bodies.len();
        let looks = bodies * self.strikes.len().max(1);
        // Of very many bodies some stand for all.
        let stride = looks.div_ceil(MOST_LOOKS);
        let samples = (MOST_LOOKS * stride / looks.max(1)).clamp(1, SAMPLES);
        let bodies: Vec<usize> = (0..bodies).step_by(stride.max(1)).collect();
        let of_body = |&b: &usize| {
            let (body, dimension, planes) = (&case.bodies[b], case.dimension, &case.symmetry);
            let count = populate::count(body, dimension, planes, None);
            let mut waiting = Vec::new();
            let look = |site: Site| waiting.push(self.waiting(b, &site.position, &times));
            if count <= samples as u64 {
                // Nearly where they begin is near enough.
                populate::emit_unfitted((body, dimension, planes), Brick::OPEN, look);
            } else {
                let (sites, _) = populate::sample(body, dimension, planes, samples as u64);
                sites.for_each(look);
            }
            let count = as_number(count);
            (count, count * mean_work(&waiting))
        };
        let each: Vec<(f64, f64)> = bodies.par_iter().map(of_body).collect();
        for (count, moving) in each {
            work += moving;
            all += count;
        }
        if all > 0.0 { work / all } else { 1.0 }
    }
}

/// Mean work of particles that wait at some of the times over that if all moved.
#[must_use]
pub fn mean_work(all: &[Waiting]) -> f64 {
    let count = |bits: fn(&Waiting) -> u8| -> u64 {
        let times = |waiting: &Waiting| u64::from(bits(waiting).count_ones());
        all.iter().map(times).sum()
    };
    let (rest, sleep) = (
        count(|waiting| waiting.rests),
        count(|waiting| waiting.sleeps),
    );
    let saved = as_number(rest) * (1.0 - RESTING) + as_number(sleep) * (RESTING - SLEEPING);
    1.0 - saved / as_number((all.len() * TIMES).max(1) as u64)
}

impl Strike {
    /// Distance (m) of a position (m) from the path of the body, some time (s) after it has touched another.
    fn distance(&self, position: &[f64; 3], since: f64) -> f64 {
        let (lower, upper) = self.ends;
        let apart = |a: usize| {
            let way = self.velocity[a] * since;
            let beyond = position[a] - (upper[a] + way.max(0.0));
            let before = lower[a] + way.min(0.0) - position[a];
            beyond.max(before).max(0.0)
        };
        Vec3::from(std::array::from_fn(apart)).norm()
    }
}

/// Returns true if particles of a case rest at first, whatever strikes them.
pub(super) fn can_rest(case: &Case) -> bool {
    waiting(case).is_some()
}

/// By body, its rest; `None` if nothing rests, or for an unknown time.
fn waiting(case: &Case) -> Option<Vec<Option<Still>>> {
    let known = matches!(case.sph.form, SphForm::Conventional | SphForm::Corrected)
        && !case.loads.moves_all()
        && case.loads.velocities.is_empty()
        && case.loads.pressures.is_empty();
    known.then_some(())?;
    let still: Vec<_> = case.bodies.iter().map(|body| still(case, body)).collect();
    still.iter().any(Option::is_some).then_some(still)
}

/// The rest of a body, if it is at rest.
fn still(case: &Case, body: &Body) -> Option<Still> {
    let rest = Rest::of(&case.materials[body.material])?;
    // Sums of the total form pass over nothing.
    let is_still = body.rigid.is_none()
        && !body.total
        && body.velocity.norm() == 0.0
        && body.speed_spread() == 0.0
        && body.initial.heat == Heat::Reference
        && body.initial.plastic_strain.constant() == Some(0.0);
    is_still.then_some(Still {
        speed: rest.sound_speed,
        ahead: AHEAD * body.lattice.spacing,
        awake: if case.loads.surfaces.is_empty() {
            AWAKE * body.lattice.spacing
        } else {
            f64::INFINITY
        },
    })
}

/// A body that touches another at a time (s).
fn strike(case: &Case, body: usize, time: f64) -> Option<Strike> {
    let body = &case.bodies[body];
    let (lower, upper) = populate::bounds(body, case.dimension)?;
    let velocity: [f64; 3] = body.velocity.into();
    let then = |position: [f64; 3]| std::array::from_fn(|a| position[a] + velocity[a] * time);
    Some(Strike {
        time,
        ends: (then(lower), then(upper)),
        velocity,
    })
}

#[allow(clippy::cast_precision_loss, reason = "far fewer than 2^52")]
fn as_number(count: u64) -> f64 {
    count as f64
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::input;
    use crate::preflight::approaches;

    fn quarter(set: &[&str]) -> Case {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../inputs/quarter-impact");
        let set: Vec<String> = set.iter().map(|&set| set.to_owned()).collect();
        input::load(&path, &set).unwrap()
    }

    fn waves(case: &Case) -> Option<Waves> {
        Waves::new(case, &approaches(case))
    }

    #[test]
    fn waves_go_out_from_where_bodies_meet() {
        let case = quarter(&[]);
        let waves = waves(&case).unwrap();
        let (plate, sphere) = (0, 1);
        let (near, far) = ([0.1e-3, 0.0, 0.05e-3], [1.4e-3, 0.0, 0.05e-3]);
        let work = |body: usize, position: &[f64; 3], time: f64| {
            waves.waiting(body, position, &[time; TIMES]).work(3)
        };
        let is = |work: f64, wanted: f64| (work - wanted).abs() < 1e-12;
        assert!(is(work(sphere, &[0.0, 0.0, 0.5e-3], 0.0), 1.0));
        assert!(is(work(plate, &near, 0.01e-6), 1.0));
        // 1.1 mm from the sphere's side, of which 16 spacings are ahead of sound at 6.5 km/s.
        assert!(is(work(plate, &far, 0.10e-6), RESTING));
        assert!(is(work(plate, &far, 0.13e-6), 1.0));
        // Another 34 spacings and more.
        assert!(is(work(plate, &[2.5e-3, 0.0, 0.05e-3], 0.02e-6), SLEEPING));
        let share = waves.share_of_work(&case, 0.0);
        assert!((0.7..0.85).contains(&share), "{share}");
        assert!((waves.share_of_work(&case, 0.19e-6) - 1.0).abs() < 1e-12);
    }

    #[test]
    fn what_turns_is_awaited_from_the_start() {
        let share = |set: &[&str]| {
            let case = quarter(set);
            waves(&case).unwrap().share_of_work(&case, 0.0)
        };
        let straight = share(&["symmetry=[]"]);
        let turns = r#"body.sphere.angular_velocity=[0, "1000 rad/s", 0]"#;
        let turning = share(&["symmetry=[]", turns]);
        assert!((turning - straight).abs() < 0.01, "{turning} {straight}");
    }

    #[test]
    fn nothing_rests_where_all_falls_or_flies() {
        assert!(waves(&quarter(&["gravity=[0, 0, \"-9.81 m/s^2\"]"])).is_none());
        let flies = r#"body.plate.velocity=[0, 0, "1 m/s"]"#;
        assert!(waves(&quarter(&[flies])).is_none());
    }
}
