//! What is measured between steps.

use super::simulation::Simulation;
use crate::diagnose::Passed;
use crate::measure::{
    self, BodyFigures, Crossing, Findings, GaugeRow, Gauges, Matter, Whole, whole_passed,
};
use comm::Comm;
use model::Cadence;

impl Simulation {
    /// What there is of each body now, right after a step. Collective.
    #[must_use]
    pub fn measure_bodies(&mut self, comm: &Comm) -> Vec<BodyFigures> {
        let whole = Whole::new(self.halo.mirrors());
        let kept = (&mut self.measures.bodies, &self.dormant.asleep);
        measure::bodies(&self.case, &self.particles, kept, whole, comm)
    }

    /// From what is computed to the whole.
    fn whole(&self) -> Whole<'_> {
        Whole::new(self.halo.mirrors())
    }

    /// What the measures of the case find now, in their order, right after a step. Collective.
    pub fn measure(&mut self, comm: &Comm) -> Vec<Findings> {
        let mirrors = self.halo.mirrors();
        let matter = Matter::of(&self.case, mirrors, &self.particles);
        let remembered = &mut self.state.remembered;
        measure::findings(
            self.state.time,
            remembered,
            Some(&self.particles),
            &matter,
            comm,
        )
    }

    /// The gauges of the case.
    #[must_use]
    pub fn gauges(&self) -> &Gauges {
        &self.measures.gauges
    }

    /// What the gauges read whose turn it is, right after a step. Collective.
    pub fn read_gauges(&mut self, comm: &Comm, is_due: impl Fn(Cadence) -> bool) -> Vec<GaugeRow> {
        let carriers = &self.state.gauge_carriers;
        let there = (&self.particles, &self.lists);
        let gauges = &mut self.measures.gauges;
        gauges.read(&self.case, there, carriers, is_due, comm)
    }

    /// Tells gauges which particles carry them, and particles on which sides of witness planes they are, at
    /// the start of a case. Collective.
    pub(super) fn begin_measures(&mut self, comm: &Comm) {
        let there = (&self.particles, &self.lists);
        let gauges = &self.measures.gauges;
        self.state.gauge_carriers = gauges.choose(&self.case, there.0, there.1, comm);
        gauges.mark(&mut self.particles, &self.state.gauge_carriers);
        measure::mark_zones(&self.case, &mut self.particles);
        let mirrors = self.halo.mirrors();
        let matter = Matter::of(&self.case, mirrors, &self.particles);
        self.state.remembered = measure::remember(&matter, comm);
        if self.measures.witnesses.any() {
            self.measures.witnesses.begin(&mut self.particles);
        }
    }

    /// Notes who has passed a witness plane in the step just done.
    pub(super) fn watch_witnesses(&mut self) {
        if self.measures.witnesses.any() {
            let step = (self.state.step, self.state.time, self.state.last_dt);
            self.measures.witnesses.watch(&mut self.particles, step);
        }
    }

    /// Joins what has passed the witness planes since the last time on all ranks into the state, and
    /// gives it: before rows and checkpoints. Collective.
    pub fn join_crossings(&mut self, comm: &Comm) -> Vec<Crossing> {
        let ledgers = &mut self.state.passed;
        self.measures.witnesses.join(ledgers, comm)
    }

    /// What has passed the witness planes so far, images behind symmetry planes with it: by plane,
    /// body and direction, along the normal first.
    #[must_use]
    pub fn passed(&self) -> Vec<Passed> {
        let whole = self.whole();
        let all = self.state.passed.iter();
        all.map(|part| whole_passed(part, &whole)).collect()
    }
}
