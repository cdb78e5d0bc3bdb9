//! The summary of a run.

use std::collections::BTreeMap;

use serde_json::json;

use super::load::load;
use super::output_time::Seconds;
use crate::output::{VERSION, commit, h5};
use crate::preflight::{Across, across, approaches};
use comm::{self, Comm};
use engine::step::{Removed, RunState, Simulation, failed_mass, measurements};
use model::{Case, SphForm};

/// Times of a run.
#[derive(Debug, Clone, Copy)]
pub struct Clock {
    /// Seconds since the start of the program.
    pub wall: f64,
    /// Seconds from the start of MPI to the first step.
    pub set_up: f64,
    /// Seconds of output.
    pub output: Seconds,
}

/// `summary.json`: results of the run, and the speed of this process (with the mean seconds of all ranks by
/// phase). Collective.
#[allow(clippy::cast_precision_loss, reason = "for people")]
pub fn summary(comm: &Comm, simulation: &Simulation, clock: &Clock) -> serde_json::Value {
    let load = load(comm, simulation);
    let whole = measurements::images(simulation);
    let state = &measurements::whole(simulation);
    let worst = &state.worst;
    let phases = mean_seconds(comm, simulation.timers.report());
    let mut counts = [simulation.memory() as u64, simulation.frozen() as u64];
    comm.sum_u64(&mut counts);
    let memory = counts[0];
    let frozen = whole.count(counts[1]);
    let threads = rayon::current_num_threads();
    let rate = rate(load.updates, &phases, comm.size() * threads);
    let contact = simulation.contact();
    let failed = failed_by_body(comm, simulation);
    let departed = departed_by_body(&simulation.case, state);
    let normalised = simulation.case.sph.form != SphForm::Conventional;
    // Steps since the start of the process, if no particle was removed.
    let steps = load.updates as f64 / (load.particles[0] as f64).max(1.0);
    let each = |sent: u64| sent as f64 / (steps.max(1.0) * comm.size() as f64);
    let mut summary = json!({
        "title": simulation.case.title,
        "version": VERSION,
        "commit": commit(),
        "mpi": comm::library(),
        "hdf5": h5::library(),
        "ranks": comm.size(),
        "decomposition": (comm.size() > 1).then(|| decomposition(simulation)),
        "threads": threads,
        "instructions": numerics::dispatch::instructions().name(),
        "particles": load.particles[0],
        "removed_particles": taken_out(&state.removed) - frozen,
        "frozen_particles": frozen,
        "removed_energy": state.removed_energy(),
        "departed_energy": departed.is_some().then(|| state.departed_energy()),
        "departed": departed,
        "steps": state.step,
        "time": state.time,
        "wall_seconds": clock.wall,
        "set_up_seconds": clock.set_up,
        "million_updates_per_second_per_core": rate,
        "bytes_per_particle": memory as f64 / (load.particles[0] as f64).max(1.0),
        "messages_per_rank_and_step": each(load.messages),
        "bytes_sent_per_rank_and_step": each(load.bytes),
        "seconds_by_phase": object(phases),
        "output_share": clock.output.share(clock.wall),
        "output_seconds": object(clock.output.by_name()),
        "energy_error_max": worst.energy_error,
        "contact_defect": worst.contact_defect,
        "momentum_error": object(["x", "y", "z"].into_iter().zip(worst.momentum_error)),
        "angular_momentum_error": object(["x", "y", "z"].into_iter().zip(worst.angular_momentum_error)),
        "interpenetrated_particles": contact.has_pairs().then_some(worst.interpenetrated),
        "closest_foreign_pair": worst.closest,
        "closest_foreign_particles": nearest(simulation),
        "largest_foreign_fraction": contact.measures_fractions().then_some(worst.foreign_fraction),
        "plane_crossings": (!simulation.case.symmetry.is_empty()).then_some(state.plane_crossings),
        "capped_reliefs": state.capped_reliefs,
        "uncorrected_gradients": normalised.then_some(worst.uncorrected),
        "failure_energy": failed.is_some().then_some(state.totals.failure_energy),
        "failed_mass": failed,
        "absorbing_zones": absorbing_zones(&simulation.case, state),
        "contact_limited_steps": worst.contact_limited_steps,
    });
    summary["self_gravity"] = json!(self_gravity(&simulation.case, state));
    summary["computed_share"] = json!(1.0 / f64::from(whole.copies()));
    summary["particles_across"] = json!(particles_across(comm, &simulation.case));
    summary["left_total_form"] = json!(left_total_form(simulation));
    summary
}

/// Particles across each body that deforms, at the start, and the least that its figures need; on rank 0.
fn particles_across<'a>(
    comm: &Comm,
    case: &'a Case,
) -> Option<BTreeMap<&'a str, serde_json::Value>> {
    comm.is_root().then(|| {
        let bodies = across(case, &approaches(case)).into_iter();
        let row = |across: Across| {
            let figures = json!({ "particles": across.particles, "least": across.least });
            (case.bodies[across.body].name.as_str(), figures)
        };
        bodies.map(row).collect()
    })
}

/// Bodies that have left the total form, with the time (s) and the reason, if any had it.
fn left_total_form(simulation: &Simulation) -> Option<serde_json::Value> {
    let bodies = &simulation.case.bodies;
    let torn = simulation.state.torn.iter();
    let left = torn.map(
        |torn| json!({ "body": bodies[torn.body].name, "time": torn.time, "reason": torn.tear }),
    );
    let any = bodies.iter().any(|body| body.total);
    any.then(|| left.collect())
}

/// Number of removed particles.
fn taken_out(removed: &[Removed]) -> u64 {
    removed.iter().map(|removed| removed.particles).sum()
}

/// Axes of the slabs by level, and the number of their changes.
fn decomposition(simulation: &Simulation) -> serde_json::Value {
    let axes = simulation.axes_of_slabs();
    let names: Vec<&str> = axes.iter().map(|axis| axis.name()).collect();
    json!({
        "levels": names.len(),
        "axes": names,
        "changes": simulation.changes_of_slabs(),
    })
}

/// Million updates of particles in a second of stepping, by core.
#[allow(clippy::cast_precision_loss, reason = "for people")]
fn rate(updates: u64, phases: &[(&str, f64)], cores: usize) -> f64 {
    let stepping: f64 = phases.iter().map(|(_, seconds)| seconds).sum();
    updates as f64 * 1e-6 / stepping.max(f64::MIN_POSITIVE) / cores as f64
}

/// Energy absorbed (J) and mass yielded (kg) in absorbing zones, if there are any.
fn absorbing_zones(case: &Case, state: &RunState) -> Option<serde_json::Value> {
    let zones = &state.loads[case.absorber_ledgers()];
    let taken = -zones.iter().map(|zone| zone.work).sum::<f64>();
    let yielded = state.totals.yielded_mass;
    (!zones.is_empty()).then(|| json!({ "absorbed_energy": taken, "yielded_mass": yielded }))
}

/// Potential energy of self-gravity (J), and the momentum that the error of its tree has added (N s), if there is any.
fn self_gravity(case: &Case, state: &RunState) -> Option<serde_json::Value> {
    let energy = state.self_gravity_energy;
    (case.loads.self_gravity)
        .map(|_| json!({ "energy": energy, "tree_impulse": state.tree_impulse }))
}

/// The nearest two particles of two bodies so far, and those bodies.
fn nearest(simulation: &Simulation) -> Option<serde_json::Value> {
    simulation.state.worst.nearest.map(|pair| {
        let names = pair.bodies.map(|b| &simulation.case.bodies[b].name);
        json!({ "bodies": names, "ids": pair.particles })
    })
}

/// Sums over the particles that have left the box of interest, by body, if there is one.
fn departed_by_body<'a>(
    case: &'a Case,
    state: &RunState,
) -> Option<BTreeMap<&'a str, serde_json::Value>> {
    let departed = &state.departed;
    let names = case.bodies.iter().map(|body| body.name.as_str());
    let row = |gone: &Removed| {
        let [first, last] = gone.times.map_or([None; 2], |times| times.map(Some));
        json!({
            "particles": gone.particles,
            "mass": gone.mass,
            "momentum": gone.momentum,
            "kinetic_energy": gone.kinetic_energy,
            "internal_energy": gone.internal_energy,
            "first_time": first,
            "last_time": last,
        })
    };
    (!departed.is_empty()).then(|| names.zip(departed.iter().map(row)).collect())
}

/// Failed mass (kg) by body, if any material may fail. Collective.
fn failed_by_body<'a>(comm: &Comm, simulation: &'a Simulation) -> Option<BTreeMap<&'a str, f64>> {
    let bodies = &simulation.case.bodies;
    simulation.case.may_fail().then(|| {
        let whole = measurements::images(simulation);
        let masses = failed_mass(&simulation.particles, bodies.len(), comm);
        let names = bodies.iter().map(|body| body.name.as_str());
        names
            .zip(masses.into_iter().map(|mass| whole.sum(mass)))
            .collect()
    })
}

/// Means over ranks of named seconds.
#[allow(
    clippy::cast_precision_loss,
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "nanoseconds of a run, which are positive, fit well"
)]
fn mean_seconds(
    comm: &Comm,
    seconds: impl Iterator<Item = (&'static str, f64)>,
) -> Vec<(&'static str, f64)> {
    let (names, mut nanoseconds): (Vec<_>, Vec<u64>) = seconds
        .map(|(name, seconds)| (name, (seconds * 1e9) as u64))
        .unzip();
    comm.sum_u64(&mut nanoseconds);
    let mean = |&sum: &u64| sum as f64 * 1e-9 / comm.size() as f64;
    names
        .into_iter()
        .zip(nanoseconds.iter().map(mean))
        .collect()
}

fn object(
    entries: impl IntoIterator<Item = (&'static str, f64)>,
) -> serde_json::Map<String, serde_json::Value> {
    entries
        .into_iter()
        .map(|(name, value)| (name.to_owned(), json!(value)))
        .collect()
}
