//! Measurements of a simulation between two of its steps.

use super::accounts::TotalsInputs;
use super::simulation::Simulation;
use crate::diagnose::RunState;
use crate::measure::{self, BodyFigures, Crossing, Findings, GaugeRow, Matter, Whole};
use comm::Comm;
use model::Cadence;

/// Brings sums over all particles into the state, with the errors that follow from them, and the
/// extremes since the last row. Collective.
pub fn diagnose(simulation: &mut Simulation, comm: &Comm) {
    let Simulation {
        case,
        particles,
        state,
        search,
        loads,
        accounts,
        ..
    } = simulation;
    let inputs = TotalsInputs {
        case,
        active: search.active(particles),
        loads,
    };
    accounts.diagnose(comm, state, inputs);
}

/// Joins the extremes of all ranks into the state: before rows and checkpoints. Collective.
pub fn join_extremes(simulation: &mut Simulation, comm: &Comm) {
    let Simulation {
        state, accounts, ..
    } = simulation;
    accounts.sums.join_extremes(comm, state);
}

/// Figures of each body now, right after a step. Collective.
#[must_use]
pub fn bodies(simulation: &mut Simulation, comm: &Comm) -> Vec<BodyFigures> {
    let Simulation {
        case,
        particles,
        search,
        space,
        accounts,
        ..
    } = simulation;
    let whole = Whole::new(space.halo.mirrors());
    let kept = &mut accounts.measures.bodies;
    measure::bodies(case, search.active(particles), kept, whole, comm)
}

/// Findings of the measures of the case now, in their order, right after a step. Collective.
pub fn findings(simulation: &mut Simulation, comm: &Comm) -> Vec<Findings> {
    let Simulation {
        case,
        particles,
        state,
        space,
        ..
    } = simulation;
    let matter = Matter::of(case, space.halo.mirrors(), particles);
    let (time, remembered) = (state.time, &mut state.remembered);
    measure::findings(time, remembered, Some(particles), &matter, comm)
}

/// Readings of the gauges that are due, right after a step. Collective.
pub fn read_gauges(
    simulation: &mut Simulation,
    comm: &Comm,
    is_due: impl Fn(Cadence) -> bool,
) -> Vec<GaugeRow> {
    let Simulation {
        case,
        particles,
        state,
        search,
        accounts,
        ..
    } = simulation;
    let there = (&*particles, &search.lists);
    let gauges = &mut accounts.measures.gauges;
    gauges.read(case, there, &state.gauge_carriers, is_due, comm)
}

/// Joins crossings of witness planes on all ranks since the last time into the state, and returns
/// them: before rows and checkpoints. Collective.
pub fn join_crossings(simulation: &mut Simulation, comm: &Comm) -> Vec<Crossing> {
    let ledgers = &mut simulation.state.passed;
    simulation.accounts.measures.witnesses.join(ledgers, comm)
}

/// The state with the sums and ledgers of the whole model, images behind symmetry planes with them.
#[must_use]
pub fn whole(simulation: &Simulation) -> RunState {
    measure::whole_state(&simulation.state, images(simulation))
}

/// What symmetry planes leave out of a simulation.
#[must_use]
pub fn images(simulation: &Simulation) -> Whole<'_> {
    Whole::new(simulation.halo().mirrors())
}
