//! One configuration of ranks and threads, one case, one repetition.

use std::collections::BTreeMap;
use std::path::Path;
use std::time::Instant;

use super::cases::BenchCase;
use super::memory::Resident;
use super::neighbours;
use super::report::Row;
use comm::Comm;
use engine::step::{Phase, Simulation, measurements};
use files::output::{ResultExtents, RowSchedule, Rows, checkpoint, from_root};
use particles::ParticleStore;

/// Steps before the timed ones, in which buffers grow, caches fill and, over one interval between
/// balances, ranks learn their speeds.
const WARM_UP: u64 = 30;
/// Steps from a prepared state to the next ordering of the store: the warm-up passes the ordering, and the
/// timed steps find memory as a long run does.
const BEFORE_ORDER: u64 = 2;

/// Steps to the state that a case begins from and writes it into a folder. Collective.
pub fn prepare(comm: &Comm, bench: &BenchCase, folder: &Path) -> Result<(), String> {
    let simulation = stepped(comm, bench)?;
    let state = &simulation.state;
    let meta = checkpoint::Meta {
        run: None,
        step: state.step,
        time: state.time,
        state: &serde_json::to_string(state).map_err(|e| e.to_string())?,
        input: &simulation.case.resolved,
        results: &ResultExtents::default(),
    };
    let mut rows = Rows::default();
    // Where this fails, the checkpoint tells of it on all ranks.
    let _ = std::fs::create_dir_all(folder);
    checkpoint::write(comm, folder, &simulation.particles, &meta, 1, &mut rows)
        .map(drop)
        .map_err(|e| e.to_string())
}

/// Times a case from the state in folder `from`, or from its start. Collective; the row is the same
/// on all ranks.
pub fn measure(
    comm: &Comm,
    bench: &BenchCase,
    steps: Option<u64>,
    from: Option<&Path>,
) -> Result<Row, String> {
    let steps = steps.unwrap_or(bench.steps);
    let resident = Resident::start();
    let mut simulation = match from {
        Some(folder) => resumed(comm, bench, folder)?,
        None => stepped(comm, bench)?,
    };
    // Every sum is made, also those of a block at rest, which are zero.
    simulation.search.lists.spare_quiescent = false;
    for _ in 0..WARM_UP {
        step(comm, &mut simulation)?;
    }
    let before = Counts::of(comm, &simulation);
    comm.barrier();
    let clock = Instant::now();
    for _ in 0..steps {
        step(comm, &mut simulation)?;
    }
    comm.barrier();
    let wall = clock.elapsed().as_secs_f64();
    let peak = resident.peak();
    let after = Counts::of(comm, &simulation);
    Ok(row(
        comm,
        bench,
        &simulation,
        steps,
        wall,
        peak,
        [before, after],
    ))
}

/// A step and the work of `whipple run` after it with all files off.
fn step(comm: &Comm, simulation: &mut Simulation) -> Result<(), String> {
    let before = simulation.state.time;
    simulation.advance(comm).map_err(|e| e.to_string())?;
    let (step, now) = (simulation.state.step, simulation.state.time);
    if RowSchedule::of(&simulation.case).sums_are_due(step, before, now) {
        measurements::diagnose(simulation, comm);
    }
    simulation.timers.lap(Phase::Output);
    Ok(())
}

fn stepped(comm: &Comm, bench: &BenchCase) -> Result<Simulation, String> {
    let case = bench.read().map_err(|e| e.to_string())?;
    let order_every = case.domain.balance_every;
    let mut simulation = Simulation::start(case, comm).map_err(|e| e.to_string())?;
    let in_order =
        |step: u64| order_every == 0 || (step + BEFORE_ORDER).is_multiple_of(order_every);
    while bench.begin > 0.0
        && (simulation.state.time < bench.begin || !in_order(simulation.state.step))
    {
        step(comm, &mut simulation)?;
    }
    Ok(simulation)
}

fn resumed(comm: &Comm, bench: &BenchCase, folder: &Path) -> Result<Simulation, String> {
    let case = bench.read().map_err(|e| e.to_string())?;
    let newest = from_root(comm, || {
        let last = checkpoint::list(folder)?.pop();
        Ok(last.map(|(_, path)| path.into_os_string()))
    });
    let newest = newest.map_err(|e| e.to_string())?;
    let newest = newest.ok_or_else(|| format!("{} has no state", folder.display()))?;
    let mut particles = ParticleStore::default();
    let saved = checkpoint::read(comm, Path::new(&newest), &mut particles);
    let saved = saved.map_err(|e| e.to_string())?;
    let state = serde_json::from_str(&saved.state).map_err(|e| e.to_string())?;
    Simulation::resume(case, comm, state, particles).map_err(|e| e.to_string())
}

/// Sums over all ranks so far.
struct Counts {
    updates: u64,
    messages: u64,
    bytes: u64,
    nanoseconds: Vec<u64>,
}

impl Counts {
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "short times"
    )]
    fn of(comm: &Comm, simulation: &Simulation) -> Self {
        let (messages, bytes) = simulation.traffic();
        let seconds = simulation.timers.report();
        let mut sums = vec![simulation.timers.updates, messages, bytes];
        sums.extend(seconds.map(|(_, seconds)| (seconds * 1e9) as u64));
        comm.sum_u64(&mut sums);
        Self {
            updates: sums[0],
            messages: sums[1],
            bytes: sums[2],
            nanoseconds: sums.split_off(3),
        }
    }
}

#[allow(clippy::cast_precision_loss, reason = "figures for people")]
fn row(
    comm: &Comm,
    bench: &BenchCase,
    simulation: &Simulation,
    steps: u64,
    wall: f64,
    peak: Option<u64>,
    [before, after]: [Counts; 2],
) -> Row {
    let threads = rayon::current_num_threads();
    let cores = (comm.size() * threads) as f64;
    let known = !comm.any(peak.is_none());
    let mut sums = [simulation.particles.owned() as u64, peak.unwrap_or(0)];
    comm.sum_u64(&mut sums);
    let particles = sums[0] as f64;
    let updates = (after.updates - before.updates) as f64;
    let each_step = |count: u64| count as f64 / (steps as f64 * comm.size() as f64);
    let phases = Phase::ALL
        .iter()
        .zip(after.nanoseconds.iter().zip(&before.nanoseconds));
    let nanoseconds_by_phase: BTreeMap<String, f64> = phases
        .map(|(&(_, name), (after, before))| {
            // Sums over ranks, each of which occupies its threads.
            (
                name.to_owned(),
                (after - before) as f64 * threads as f64 / updates,
            )
        })
        .collect();
    let memory = simulation.memory_by_part();
    let mut bytes = memory.map(|(_, bytes)| bytes as u64);
    comm.sum_u64(&mut bytes);
    let bytes_by_part: BTreeMap<String, f64> = memory
        .iter()
        .zip(bytes)
        .map(|((name, _), bytes)| ((*name).to_owned(), bytes as f64 / particles))
        .collect();
    let rate = updates * 1e-6 / wall / cores;
    Row {
        case: bench.name.to_owned(),
        particles: sums[0],
        neighbours: neighbours::true_mean(comm, simulation),
        list_length: neighbours::list_mean(comm, simulation),
        ranks: comm.size(),
        threads,
        steps,
        million_updates_per_second_per_core: rate,
        repetitions: vec![rate],
        efficiency: None,
        bytes_per_particle: bytes_by_part.values().sum(),
        peak_bytes_per_particle: known.then_some(sums[1] as f64 / particles),
        messages_per_rank_and_step: each_step(after.messages - before.messages),
        bytes_sent_per_rank_and_step: each_step(after.bytes - before.bytes),
        nanoseconds_by_phase,
        bytes_by_part,
    }
}
