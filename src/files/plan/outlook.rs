//! Prediction of a run: its steps, and the particles that wait for a wave.

use rayon::prelude::*;

use super::particles::Particles;
use crate::preflight::{self, Approach, TIMES, Waiting, Waves, approaches, mean_work};
use model::Case;

/// Work of a particle where smoothing lengths differ from body to body, and where they differ within one, over that where all
/// are equal: each pair has a length of its own, and lists extend to the largest range. Measured on the quarter impact with a
/// sphere of other particles, and with a graded plate whose particles differ by a factor of two.
const UNEQUAL: [f64; 2] = [1.1, 1.5];

/// Work of self-gravity on a particle, and on each of its images, over that of all else, among 4,600 particles and among
/// 37,000 (`inputs/protoplanets`).
const ATTRACTED: f64 = 1.5;

/// Prediction of a run from a time on.
#[derive(Debug, Clone, PartialEq)]
pub struct Outlook {
    /// Steps to its end, if they can be predicted.
    pub steps: Option<f64>,
    /// Work of these steps over that if all particles moved.
    pub share_of_work: f64,
    /// Bodies that meet, by their initial velocities.
    pub approaches: Vec<Approach>,
    /// By particle, the times at which it waits; `None` if none does.
    waiting: Option<Vec<Waiting>>,
}

impl Outlook {
    /// Of the initial particles, or of those at a time (s).
    #[must_use]
    pub fn new(case: &Case, particles: &Particles, time: Option<f64>) -> Self {
        let (from, approaches) = (time.unwrap_or(0.0), approaches(case));
        let times = Waves::times(case, from);
        let waiting = Waves::new(case, &approaches).map(|waves| {
            let all = particles.body.par_iter().zip(&particles.positions);
            all.map(|(&body, position)| waves.waiting(body as usize, position, &times))
                .collect::<Vec<_>>()
        });
        Self {
            steps: expected_steps(case, &approaches, from),
            share_of_work: waiting.as_deref().map_or(1.0, mean_work),
            waiting,
            approaches,
        }
    }

    /// Work of the particles at each of the times, in per cent of that of a moving one; `None` if none rests.
    pub(super) fn works(&self) -> Option<impl Iterator<Item = Vec<u32>>> {
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a per cent"
        )]
        let per_cent = |work: f64| (100.0 * work) as u32;
        let waiting = self.waiting.as_ref()?;
        Some((0..TIMES).map(move |k| {
            let works = waiting.par_iter().map(|waiting| waiting.work(k));
            works.map(per_cent).collect()
        }))
    }
}

/// Predicted steps of a case with these approaches from a time (s) on.
#[must_use]
#[allow(clippy::cast_precision_loss, reason = "for people")]
pub fn expected_steps(case: &Case, approaches: &[Approach], time: f64) -> Option<f64> {
    let by_time = preflight::expected_steps(case, approaches, time)?;
    let most = case.run.max_steps.map_or(f64::INFINITY, |most| most as f64);
    Some(by_time.min(most).round())
}

/// Work of a particle of a case over that of one among equal particles that do not attract each other.
#[must_use]
pub fn work_of_unequal(case: &Case) -> f64 {
    let bodies = || case.bodies.iter().filter(|body| body.rigid.is_none());
    let mut lengths = bodies().map(|body| body.smoothing_length);
    let first = lengths.next();
    let images = f64::from(1_u32 << case.symmetry.len());
    let attracted = case.loads.self_gravity.map_or(0.0, |_| ATTRACTED * images);
    let unequal = if bodies().any(|body| body.lattice.sizes.is_some()) {
        UNEQUAL[1]
    } else if lengths.any(|length| Some(length) != first) {
        UNEQUAL[0]
    } else {
        1.0
    };
    unequal * (1.0 + attracted)
}

/// Work of all steps of a case with these approaches over that if all particles moved, from a sample of positions.
#[must_use]
pub fn share_of_work(case: &Case, approaches: &[Approach]) -> f64 {
    Waves::new(case, approaches).map_or(1.0, |waves| waves.share_of_work(case, 0.0))
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::input;

    #[test]
    fn unequal_particles_take_more_work() {
        let work = |name: &str, set: &[&str]| {
            let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../inputs");
            let set: Vec<String> = set.iter().map(|&set| set.to_owned()).collect();
            work_of_unequal(&input::load(&path.join(name), &set).unwrap())
        };
        let finer = "body.sphere.spacing=0.01mm";
        let works = [
            work("quarter-impact", &[]),
            work("quarter-impact", &[finer]),
            work("crater", &[]),
        ];
        assert!(works.is_sorted_by(|a, b| a < b), "{works:?}");
        assert_eq!(works[0].to_bits(), 1.0f64.to_bits());
    }
}
