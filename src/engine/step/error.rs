//! Why a case cannot start or a step fails.

use thiserror::Error;

use crate::diagnose::NumericalFailure;
use comm::Comm;
use model::Case;
use model::readable::{shown, shown_vector};
use particles::ParticleStore;

/// Why a case cannot start; the same on all ranks.
#[derive(Debug, Clone, Error)]
pub enum SetupError {
    /// No particles at all.
    #[error("the case has no particles: check shapes, spacings and symmetry planes")]
    Empty,
    /// More than the program can number on one rank.
    #[error("a rank would hold {count} particles, more than {limit}: use more ranks")]
    TooMany {
        /// Particles of the fullest rank.
        count: u64,
        /// The limit.
        limit: u64,
    },
    /// The lattices need more identities than there are.
    #[error("the bodies' lattices have too many sites to number; use larger spacings")]
    TooManySites,
    /// A particle begins with values out of range.
    #[error("{0}")]
    Unsound(String),
    /// A restored state is not one of the case.
    #[error("the saved state is not one of this case: {0}")]
    Foreign(&'static str),
    /// The first evaluation failed.
    #[error(transparent)]
    Step(#[from] StepError),
}

/// Why a step failed; the same on all ranks.
#[derive(Debug, Clone, Error)]
pub enum StepError {
    /// A particle's state is NaN or out of range.
    #[error("step {step}: particle {id} {what} ({detail})")]
    Failure {
        /// Step in which it was found.
        step: u64,
        /// Identity of the particle.
        id: u64,
        /// Kind of the failure.
        kind: NumericalFailure,
        /// The same in words.
        what: String,
        /// The particle's state.
        detail: String,
    },
    /// Every particle was taken out.
    #[error("step {step}: no particle is left, {why}")]
    NothingLeft {
        /// Step in which the last one went.
        step: u64,
        /// Why that one was taken out.
        why: &'static str,
    },
}

/// Describes the particle `id`, wherever it is, as of a kind of failure; the same text on all ranks.
/// Collective.
pub(super) fn failure(
    comm: &Comm,
    case: &Case,
    particles: &ParticleStore,
    step: u64,
    kind: NumericalFailure,
    id: u64,
) -> StepError {
    let found = particles.id[..particles.owned()]
        .iter()
        .position(|&x| x == id);
    let describe = |i| describe(particles, case, i, comm.rank()).into_bytes();
    let mine = found.map_or_else(Vec::new, describe);
    let mut owner = [if mine.is_empty() {
        u64::MAX
    } else {
        comm.rank() as u64
    }];
    comm.min_u64(&mut owner);
    let mut text = mine;
    comm.broadcast_from(usize::try_from(owner[0]).unwrap_or(0), &mut text);
    StepError::Failure {
        step,
        id,
        kind,
        what: kind.describe(&case.numerical_limits),
        detail: String::from_utf8_lossy(&text).into_owned(),
    }
}

fn describe(particles: &ParticleStore, case: &Case, i: usize, rank: usize) -> String {
    format!(
        "body `{}`, rank {rank}, position {}, velocity {}, density {}, specific energy {}, \
         pressure {}, sound speed {}; nearest particles {}",
        case.bodies[particles.body[i] as usize].name,
        case.length_unit.vector(&particles.position[i]),
        shown_vector(&particles.velocity[i], "m/s"),
        shown(particles.density[i], "kg/m^3"),
        shown(particles.specific_energy[i], "J/kg"),
        shown(particles.pressure[i], "Pa"),
        shown(particles.sound_speed[i], "m/s"),
        nearest(particles, case, i),
    )
}

/// The particles nearest to particle `i` of those that this rank holds: id, body, distance.
fn nearest(particles: &ParticleStore, case: &Case, i: usize) -> String {
    let here = particles.position[i];
    let distance = |there: &[f64; 3]| {
        let square: f64 = (0..3)
            .map(|a| (here[a] - there[a]) * (here[a] - there[a]))
            .sum();
        square.sqrt()
    };
    let mut others: Vec<(f64, usize)> = particles
        .position
        .iter()
        .enumerate()
        .filter(|&(k, _)| k != i)
        .map(|(k, there)| (distance(there), k))
        .filter(|(r, _)| r.is_finite())
        .collect();
    others.sort_by(|a, b| {
        a.0.total_cmp(&b.0)
            .then(particles.id[a.1].cmp(&particles.id[b.1]))
    });
    let described: Vec<String> = others
        .iter()
        .take(3)
        .map(|&(r, k)| {
            let distance = case.length_unit.text(r);
            format!(
                "{} of body {} at {distance}",
                particles.id[k], particles.body[k]
            )
        })
        .collect();
    if described.is_empty() {
        "unknown".to_owned()
    } else {
        described.join(", ")
    }
}
