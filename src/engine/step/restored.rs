//! Checks of a saved state before a step relies on it: a file may come from anybody.

use super::error::SetupError;
use crate::diagnose::{PairState, RunState};
use crate::loads::{Loads, RigidState};
use crate::measure::Measures;
use comm::Comm;
use model::Case;
use particles::{FieldInfo, Life, ParticleStore};

/// Largest count: beyond it one more may be lost in a sum, or run over.
const MOST: u64 = 1 << 53;

/// A possible fault of a saved state, and whether it is there.
type Check<'a> = (&'static str, &'a dyn Fn() -> bool);

/// A case as it begins.
pub(super) struct Beginning<'a> {
    pub case: &'a Case,
    pub state: &'a RunState,
    pub loads: &'a Loads,
    pub measures: &'a Measures,
}

/// Refuses a saved state, or any rank's share of its particles, that is none of this case.
/// Collective.
pub(super) fn require_own(
    comm: &Comm,
    beginning: &Beginning,
    state: &RunState,
    particles: &ParticleStore,
) -> Result<(), SetupError> {
    let (own, bodies) = (beginning.state, beginning.case.bodies.len());
    let checks: [Check; 10] = [
        ("it has other pairs of bodies or loads", &|| {
            !are_pairs(beginning.case, &state.pairs) || state.loads.len() != own.loads.len()
        }),
        ("it has particles removed from other bodies", &|| {
            let ledgers = [&state.removed, &state.departed];
            ledgers
                .iter()
                .any(|by_body| ![0, bodies].contains(&by_body.len()))
        }),
        ("it has other gauges or witness planes", &|| {
            let carried = beginning.measures.gauges.count_chosen();
            [state.gauge_carriers.len(), state.passed.len()] != [carried, own.passed.len()]
        }),
        ("it has other bodies of the total form", &|| {
            let torn = state.torn.iter().any(|torn| torn.body >= bodies);
            torn || ![0, bodies].contains(&state.total.len())
        }),
        ("it has other rigid bodies", &|| {
            let bodies =
                |of: &RunState| of.rigid.iter().map(|rigid| rigid.body).collect::<Vec<_>>();
            bodies(state) != bodies(own) || !state.rigid.iter().all(RigidState::is_sound)
        }),
        ("its times are none", &|| {
            !(state.dt > 0.0 && state.last_dt >= 0.0 && state.time >= 0.0)
        }),
        ("its counts are none", &|| {
            counts(state).any(|count| count > MOST)
        }),
        ("it has particles of another body", &|| {
            // In a restart, not in every step.
            particles.body.iter().any(|&body| body as usize >= bodies)
        }),
        ("it has particles under another load", &|| {
            let (loads, known) = (beginning.loads, &beginning.case.loads.pressures);
            let mut pressed = particles.pressed.iter();
            particles.load.iter().any(|&bits| !loads.knows(bits))
                || pressed.any(|&bits| u64::from(bits) >> known.len() != 0)
        }),
        ("it has numbers that are not finite", &|| {
            particles
                .held(Life::State)
                .any(|f| !is_finite(particles, f))
        }),
    ];
    let wrong = checks.iter().position(|(_, wrong)| wrong());
    let mut first = [wrong.unwrap_or(checks.len()) as u64];
    comm.min_u64(&mut first);
    let first = usize::try_from(first[0]).ok();
    match first.and_then(|first| checks.get(first)) {
        Some((what, _)) => Err(SetupError::Foreign(what)),
        None => Ok(()),
    }
}

/// True if these are ledgers of different pairs of bodies that have contact, in order.
fn are_pairs(case: &Case, pairs: &[PairState]) -> bool {
    let all = case.bodies.len();
    let is_one = |pair: &PairState| {
        let [a, b] = pair.bodies;
        let touches = || {
            if a == b {
                case.self_contact.is_some()
            } else {
                case.contact_between(a, b).class().is_some()
            }
        };
        a <= b && b < all && touches()
    };
    pairs.iter().all(is_one) && pairs.is_sorted_by(|one, next| one.bodies < next.bodies)
}

/// All counts of a state, negative ones as very large.
fn counts(state: &RunState) -> impl Iterator<Item = u64> {
    let worst = &state.worst;
    let now = [
        state.plane_crossings,
        state.capped_reliefs,
        state.interpenetrated,
        state.uncorrected,
        worst.interpenetrated,
        worst.uncorrected,
    ];
    let touching = state.pairs.iter().map(|pair| pair.touching);
    let signed = now.into_iter().chain(touching);
    let removed = state.removed.iter().chain(&state.departed);
    let passed = state.passed.iter().map(|passed| passed.particles);
    let removed = removed.map(|removed| removed.particles).chain(passed);
    [state.step, worst.contact_limited_steps]
        .into_iter()
        .chain(signed.map(|count| u64::try_from(count).unwrap_or(u64::MAX)))
        .chain(removed)
}

fn is_finite(particles: &ParticleStore, field: &FieldInfo) -> bool {
    if !field.kind.is_real() {
        return true;
    }
    let values: &[f64] = bytemuck::cast_slice(particles.bytes(field.id));
    values.iter().all(|value| value.is_finite())
}
