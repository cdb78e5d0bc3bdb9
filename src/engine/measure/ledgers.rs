//! The sums and ledgers of a run as tables and the summary report them: of the whole model.

use super::Whole;
use crate::contact::PairExtremes;
use crate::diagnose::{LoadState, PairState, Passed, Removed, RunState, Totals, Worst};
use crate::loads::RigidState;

/// A state with all sums and ledgers that are reported brought to the whole model; what a step reads stays that of what is
/// computed.
///
/// Relative errors, extremes of pairs of particles and the crossings of planes are of what is computed.
#[must_use]
pub fn whole_state(state: &RunState, whole: Whole) -> RunState {
    let count = |part: i64| i64::from(whole.copies()) * part;
    let worst = &state.worst;
    // To round-off the impulse from outside.
    let gained = state.gained_momentum();
    RunState {
        initial: totals(&state.initial, whole),
        totals: totals(&state.totals, whole),
        contact_energy: whole.sum(state.contact_energy),
        contact_work: whole.sum(state.contact_work),
        self_gravity_energy: whole.sum(state.self_gravity_energy),
        tree_force: whole.momentum(state.tree_force),
        tree_impulse: whole.momentum(state.tree_impulse),
        plane_force: whole.momentum(state.plane_force),
        plane_impulse: whole.momentum(state.plane_impulse),
        angular_impulse: whole.angular_momentum(state.angular_impulse, gained),
        pairs: state.pairs.iter().map(|part| pair(part, whole)).collect(),
        loads: state.loads.iter().map(|part| load(part, whole)).collect(),
        rigid: state.rigid.iter().map(|part| rigid(part, whole)).collect(),
        capped_reliefs: count(state.capped_reliefs),
        interpenetrated: count(state.interpenetrated),
        uncorrected: count(state.uncorrected),
        removed: state.removed.iter().map(|part| gone(part, whole)).collect(),
        removed_contact_energy: whole.sum(state.removed_contact_energy),
        departed: state
            .departed
            .iter()
            .map(|part| gone(part, whole))
            .collect(),
        departed_contact_energy: whole.sum(state.departed_contact_energy),
        removed_self_gravity_energy: whole.sum(state.removed_self_gravity_energy),
        departed_self_gravity_energy: whole.sum(state.departed_self_gravity_energy),
        passed: (state.passed.iter())
            .map(|part| passed(part, whole))
            .collect(),
        worst: Worst {
            interpenetrated: count(worst.interpenetrated),
            uncorrected: count(worst.uncorrected),
            ..*worst
        },
        ..state.clone()
    }
}

fn totals(part: &Totals, whole: Whole) -> Totals {
    Totals {
        kinetic_energy: whole.sum(part.kinetic_energy),
        internal_energy: whole.sum(part.internal_energy),
        contact_energy: whole.sum(part.contact_energy),
        gravity_energy: whole.sum(part.gravity_energy),
        self_gravity_energy: whole.sum(part.self_gravity_energy),
        mass: whole.sum(part.mass),
        momentum: whole.momentum(part.momentum),
        momentum_scale: whole.sum(part.momentum_scale),
        angular_momentum: whole.angular_momentum(part.angular_momentum, part.momentum),
        failed_mass: whole.sum(part.failed_mass),
        failure_energy: whole.sum(part.failure_energy),
        yielded_mass: whole.sum(part.yielded_mass),
    }
}

fn pair(part: &PairState, whole: Whole) -> PairState {
    PairState {
        bodies: part.bodies,
        force: whole.momentum(part.force),
        impulse: whole.momentum(part.impulse),
        energy: whole.sum(part.energy),
        heat_power: whole.sum(part.heat_power),
        heat: whole.sum(part.heat),
        touching: i64::from(whole.copies()) * part.touching,
        extremes: PairExtremes {
            peak_force: whole.sum(part.extremes.peak_along),
            ..part.extremes
        },
    }
}

fn load(part: &LoadState, whole: Whole) -> LoadState {
    LoadState {
        force: whole.momentum(part.force),
        impulse: whole.momentum(part.impulse),
        work: whole.sum(part.work),
        heat_power: whole.sum(part.heat_power),
        heat: whole.sum(part.heat),
        ..*part
    }
}

fn rigid(part: &RigidState, whole: Whole) -> RigidState {
    RigidState {
        mass: whole.sum(part.mass),
        force: whole.momentum(part.force),
        torque: whole.angular_momentum(part.torque, [0.0; 3]),
        ..*part
    }
}

fn gone(part: &Removed, whole: Whole) -> Removed {
    Removed {
        particles: whole.count(part.particles),
        mass: whole.sum(part.mass),
        momentum: whole.momentum(part.momentum),
        kinetic_energy: whole.sum(part.kinetic_energy),
        internal_energy: whole.sum(part.internal_energy),
        gravity_energy: whole.sum(part.gravity_energy),
        angular_momentum: whole.angular_momentum(part.angular_momentum, part.momentum),
        mass_time: whole.sum(part.mass_time),
        times: part.times,
    }
}

fn passed(part: &Passed, whole: Whole) -> Passed {
    Passed {
        particles: whole.count(part.particles),
        mass: whole.sum(part.mass),
        momentum: whole.momentum(part.momentum),
        kinetic_energy: whole.sum(part.kinetic_energy),
        internal_energy: whole.sum(part.internal_energy),
    }
}
