//! The constants of this machine for a plan, from short runs on it.

use std::fs::File;
use std::io::Write as _;
use std::path::Path;
use std::time::Instant;

use super::cases::{BenchCase, CASES};
use super::driver::{Configuration, Scratch, bench_on, launch, obstacle, program, read};
use super::machine::{self, cores};
use super::messages::Messages;
use super::report::Report;
use files::plan::{CONSTANTS, Layout, Machine, Outlook, Particles, Sharing, computing, step_time};

/// The impact that measures the time of a particle, and a plate and its half, which has as many images
/// behind a plane as particles.
const IMPACT: &str = "quarter-50k";
const PLATES: [&str; 2] = ["plate", "half-plate"];

/// Repetitions of each run, of which the median counts.
const REPEAT: u32 = 3;
/// Bytes that are written to measure the disk.
const WRITTEN: usize = 1 << 28;

/// Measures this machine; `folder` is on the disk that is measured. Messages between nodes are those of
/// an ordinary cluster.
///
/// # Errors
/// A message of the failed measurement.
pub fn calibrate(folder: &Path) -> Result<Machine, String> {
    let scratch = Scratch::create()?;
    let time = |name: &str, configuration| core_time(&scratch, name, configuration);
    let mut machine = Machine {
        name: machine::Machine::here().processor,
        cores_per_node: as_number(cores()),
        crowding: 0.0,
        thread_loss: 0.0,
        disk_bandwidth: disk(folder)?,
        ..Machine::default()
    };
    let [whole, half] = PLATES;
    // Both halves of the plate have the same neighbours.
    let (whole, half) = (time(whole, (1, 1))?, time(half, (1, 1))?);
    machine.image_time = ((half - whole) / images_of(PLATES[1])?).max(0.0);
    let one = time(IMPACT, (1, 1))?;
    machine.particle_time = (one - images_of(IMPACT)? * machine.image_time).max(0.0);
    let all = cores();
    let can_launch = all > 1 && obstacle((all, 1)).is_none();
    if can_launch {
        let between = messages(&scratch)?;
        machine.node_latency = between.latency;
        machine.node_bandwidth = between.bandwidth;
        machine.agreement_time = between.agreement_time;
        let many = time(IMPACT, (all, 1))?;
        machine.crowding = crowding(&machine, many)?;
    }
    if all > 1 {
        let threads = time(IMPACT, (1, all))? / one / (1.0 + machine.crowding);
        machine.thread_loss = ((threads - 1.0) / as_number(all - 1)).max(0.0);
    }
    for constant in &CONSTANTS {
        let value = constant.of(&mut machine);
        *value = rounded(*value);
    }
    Ok(machine)
}

/// Rounds to four digits: no run measures more.
fn rounded(value: f64) -> f64 {
    format!("{value:.3e}").parse().unwrap_or(value)
}

/// Core time of a particle and step (s) of a case.
fn core_time(scratch: &Scratch, name: &str, configuration: Configuration) -> Result<f64, String> {
    let figures = scratch.0.join("figures.json");
    let mut command = program(configuration, bench(name))?;
    command.arg(format!("--repeat={REPEAT}")).arg("--json");
    launch(command.arg(&figures))?;
    let report: Report = read(&figures)?;
    let row = report.rows.first().ok_or("it tells nothing")?;
    Ok(1e-6 / row.million_updates_per_second_per_core)
}

/// Times of messages between ranks on all cores, one fewer if they are odd.
fn messages(scratch: &Scratch) -> Result<Messages, String> {
    let figures = scratch.0.join("messages.json");
    let mut command = bench_on(cores() / 2 * 2)?;
    command.arg("--messages").arg("--json");
    launch(command.arg(&figures))?;
    read(&figures)
}

fn bench(name: &str) -> &'static BenchCase {
    let mut cases = CASES.iter();
    cases.find(|case| case.name == name).expect("a fixed case")
}

/// The layout of a case on `ranks` ranks of one node, and its number of particles.
fn layout(name: &str, ranks: usize) -> Result<(Layout, usize), String> {
    let case = bench(name).read().map_err(|error| error.to_string())?;
    let particles = Particles::at_start(&case);
    let outlook = Outlook::new(&case, &particles, None);
    let layout = Layout::new(&case, &particles, None, &outlook, ranks, None, ranks);
    let layout = layout.ok_or("it has no particles")?;
    Ok((layout, particles.positions.len()))
}

/// Images over particles of a case on one rank.
fn images_of(name: &str) -> Result<f64, String> {
    let (layout, particles) = layout(name, 1)?;
    #[allow(clippy::cast_precision_loss, reason = "few particles")]
    let images = layout.loads[0].tally.images as f64;
    Ok(images / as_number(particles))
}

/// Fraction by which cores are slower than the model of an empty machine predicts, where each has a rank
/// and the core time of a particle and step (s) is `measured`.
fn crowding(machine: &Machine, measured: f64) -> Result<f64, String> {
    let ranks = cores();
    let (layout, particles) = layout(IMPACT, ranks)?;
    let sharing = Sharing {
        threads: 1,
        ranks_per_node: ranks,
    };
    let predicted = step_time(&layout.loads, machine, sharing).all;
    let loads = layout.loads.iter();
    let computing = loads
        .map(|load| computing(load, machine))
        .fold(0.0, f64::max);
    let step = measured * as_number(particles) / as_number(ranks);
    Ok(((step - predicted) / computing).max(0.0))
}

/// Bytes that are written in a second, to the disk itself.
fn disk(folder: &Path) -> Result<f64, String> {
    let path = folder.join(format!(".whipple-calibration-{}", std::process::id()));
    let begun = Instant::now();
    let written = write(&path);
    let seconds = begun.elapsed().as_secs_f64();
    let _ = std::fs::remove_file(&path);
    written.map_err(|error| format!("cannot write {}: {error}", path.display()))?;
    Ok(as_number(WRITTEN) / seconds)
}

fn write(path: &Path) -> std::io::Result<()> {
    let mut file = File::create(path)?;
    let block = vec![1; 1 << 22];
    for _ in 0..WRITTEN / block.len() {
        file.write_all(&block)?;
    }
    file.sync_all()
}

#[allow(clippy::cast_precision_loss, reason = "far below 2^52")]
fn as_number(count: usize) -> f64 {
    count as f64
}
