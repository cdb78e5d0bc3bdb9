//! Sums, extremes and measures of a run.

use crate::contact::ContactTable;
use crate::diagnose::{KeptTotals, RunState, StepSums, Totals, angular_momentum_scale};
use crate::loads::Loads;
use crate::measure::{self, Matter, Measures};
use comm::Comm;
use model::Case;
use particles::neighbours::Lists;
use particles::{Active, Mirrors, ParticleStore};

/// Sums of a step, sums over all particles, and measures, with what each keeps from step to step.
pub(super) struct Accounts {
    pub sums: StepSums,
    pub measures: Measures,
    kept_totals: KeptTotals,
}

/// Inputs of the sums over all particles.
#[derive(Clone, Copy)]
pub(super) struct TotalsInputs<'a> {
    pub case: &'a Case,
    pub active: Active<'a>,
    pub loads: &'a Loads,
}

/// Inputs of the measures at the start of a case.
pub(super) struct MeasureInputs<'a> {
    pub case: &'a Case,
    pub particles: &'a mut ParticleStore,
    pub lists: &'a Lists,
    pub mirrors: &'a Mirrors,
}

impl Accounts {
    pub fn new(case: &Case, table: &ContactTable) -> Self {
        Self {
            sums: StepSums::new(table),
            measures: Measures::new(case),
            kept_totals: KeptTotals::default(),
        }
    }

    /// Bytes allocated.
    pub fn memory(&self) -> usize {
        self.sums.memory() + self.kept_totals.memory() + self.measures.memory()
    }

    /// Sums over all particles, with the energies of contact and self-gravity in the state. Collective.
    pub fn totals(&mut self, comm: &Comm, inputs: TotalsInputs, state: &RunState) -> Totals {
        let TotalsInputs {
            case,
            active,
            loads,
        } = inputs;
        let kept = &mut self.kept_totals;
        let energies = [state.contact_energy, state.self_gravity_energy];
        let mut totals = Totals::of(active, kept, loads, energies, comm);
        if case.may_fail() {
            totals.add_failure(active, kept, loads, comm);
        }
        totals.add_yielded(active.particles, loads, comm);
        if case.axisymmetric {
            // Rings have none.
            totals.momentum[0] = 0.0;
            totals.angular_momentum = [0.0; 3];
        }
        totals
    }

    /// Brings sums over all particles into the state, with the errors that follow from them, and the
    /// extremes since the last row. Collective.
    pub fn diagnose(&mut self, comm: &Comm, state: &mut RunState, inputs: TotalsInputs) {
        self.sums.join_extremes(comm, state);
        let totals = self.totals(comm, inputs, state);
        let turning = angular_momentum_scale(inputs.active.particles, inputs.loads, comm);
        state.book_totals(totals, turning, inputs.loads.gravity);
        if inputs.case.axisymmetric {
            // What acts towards the axis or from it is no impulse.
            state.worst.momentum_deviation[0] = 0.0;
            state.worst.momentum_error[0] = 0.0;
        }
    }

    /// Chooses the particles that carry gauges, and marks particles by the zones and the sides of witness planes that
    /// they are on, at the start of a case. Collective.
    pub fn begin_measures(&mut self, comm: &Comm, state: &mut RunState, inputs: MeasureInputs) {
        let MeasureInputs {
            case,
            particles,
            lists,
            mirrors,
        } = inputs;
        let gauges = &self.measures.gauges;
        state.gauge_carriers = gauges.choose(case, particles, lists, comm);
        gauges.mark(particles, &state.gauge_carriers);
        measure::mark_zones(case, particles);
        let matter = Matter::of(case, mirrors, particles);
        state.remembered = measure::remember(&matter, comm);
        self.measures.witnesses.begin(particles);
    }
}
