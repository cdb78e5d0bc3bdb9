//! The case and the particles that a plan is made of.

use std::path::Path;

use crate::results::{Results, only_part};
use comm::Comm;
use files::FileOpener;
use files::input;
use files::output::h5::Content;
use files::output::h5::read::SnapshotFile;
use files::output::{RunFolder, checkpoint};
use files::plan::{Outlook, Particles};
use model::Case;
use particles::ParticleStore;
use plot::snapshots;
use results::SnapshotReader as _;

/// The subject of the plan.
pub struct Source {
    /// The case.
    pub case: Case,
    /// Its particles.
    pub particles: Particles,
    /// Their time (s); absent for the start of a case.
    pub time: Option<f64>,
    /// Their predicted future.
    pub outlook: Outlook,
}

impl Source {
    fn new(case: Case, particles: Particles, time: Option<f64>) -> Self {
        let outlook = Outlook::new(&case, &particles, time);
        Self {
            case,
            particles,
            time,
            outlook,
        }
    }
}

/// Most particles that one process counts.
const MOST: u64 = 100_000_000;

/// Rows read at a time.
const CHUNK: usize = 1 << 20;

/// Reads a case, a run, a snapshot or a checkpoint.
///
/// # Errors
/// The whole message.
pub fn read(path: &Path, set: &[String]) -> Result<Source, String> {
    let is_case = path.join("case.toml").is_file() || path.extension().is_some_and(|e| e == "toml");
    if RunFolder::is_run(path) {
        let available = snapshots(&FileOpener, path).map_err(|error| format!("error: {error}"))?;
        let (_, last) = available.last().expect("there is one");
        return of_snapshot(last, set);
    }
    if is_case {
        let case = input::load(path, set).map_err(|error| error.to_string())?;
        return at_start(case);
    }
    match Results::open(path).map_err(|error| format!("error: {error}"))? {
        Results::Checkpoint(file) => {
            let folder = file.path().parent().unwrap_or(Path::new("."));
            of_checkpoint(folder, set)
        }
        Results::Run(_) | Results::Snapshot(_) => of_snapshot(path, set),
    }
}

fn at_start(case: Case) -> Result<Source, String> {
    let most = case.bodies.iter().fold(0_u64, |all, body| {
        all.saturating_add(populate::count(body, case.dimension, &case.symmetry, None))
    });
    if most > MOST {
        return Err(format!(
            "error: a plan counts {MOST} particles at most, and the case has {most}; plan it with a \
             coarser spacing on fewer ranks, with as many particles each"
        ));
    }
    let particles = Particles::at_start(&case);
    if particles.positions.is_empty() {
        return Err("error: the case has no particles".to_owned());
    }
    Ok(Source::new(case, particles, None))
}

fn of_checkpoint(folder: &Path, set: &[String]) -> Result<Source, String> {
    let mut store = ParticleStore::default();
    let restored = checkpoint::read(&Comm::solo(), folder, &mut store);
    let restored = restored.map_err(|error| format!("error: {error}"))?;
    let case = saved_case(folder, &restored.input, set)?;
    let rows = (0..store.position.len()).filter(|&i| store.frozen.get(i).is_none_or(|&f| f == 0));
    let rows = rows.map(|i| {
        let (body, mass, density) = (store.body[i] as usize, store.mass[i], store.density[i]);
        (store.position[i], body, mass, Err(density))
    });
    let particles = Particles::of(&case, rows).map_err(|what| wrong(folder, &what))?;
    Ok(Source::new(case, particles, Some(restored.time)))
}

fn of_snapshot(path: &Path, set: &[String]) -> Result<Source, String> {
    let with_prefix = |error: &dyn std::fmt::Display| format!("error: {error}");
    let text = Content::open(path).and_then(|file| file.text("/whipple/input"));
    let case = saved_case(path, &text.map_err(|error| with_prefix(&error))?, set)?;
    let file = SnapshotFile::open(path).map_err(|error| with_prefix(&error))?;
    if let Some(part) = file.portion().map_err(|error| with_prefix(&error))? {
        return Err(wrong(path, &only_part(&part)));
    }
    let names = file.names().map_err(|error| with_prefix(&error))?;
    let mut particles = Particles::default();
    for first in (0..file.particles()).step_by(CHUNK) {
        let rows = first..file.particles().min(first + CHUNK);
        let column = |name: &str, otherwise: f64| {
            if names.iter().any(|held| held == name) {
                file.scalar(name, 0, rows.clone())
                    .map_err(|error| with_prefix(&error))
            } else {
                Ok(vec![otherwise; rows.len()])
            }
        };
        let positions = file
            .points(rows.clone())
            .map_err(|error| with_prefix(&error))?;
        let [bodies, frozen] = [column("body", f64::NAN)?, column("frozen", 0.0)?];
        // Masses are stored only with sizes; smoothing lengths that are not stored are those of the
        // start.
        let [masses, lengths] = [column("mass", 0.0)?, column("smoothing_length", 0.0)?];
        let rows = (0..positions.len()).filter(|&i| frozen[i] == 0.0);
        let rows = rows.map(|i| (positions[i], index(bodies[i]), masses[i], Ok(lengths[i])));
        let chunk = Particles::of(&case, rows).map_err(|what| wrong(path, &what))?;
        particles.append(chunk);
    }
    let time = file.time().map_err(|error| with_prefix(&error))?;
    Ok(Source::new(case, particles, Some(time)))
}

/// A body's number; that of none if it is no whole number.
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "what does not fit is the number of no body"
)]
fn index(number: f64) -> usize {
    if number >= 0.0 && number.fract() == 0.0 {
        number as usize
    } else {
        usize::MAX
    }
}

fn saved_case(path: &Path, text: &str, set: &[String]) -> Result<Case, String> {
    let name = format!("{}: the saved input", path.display());
    input::parse(&name, text, set).map_err(|error| error.to_string())
}

fn wrong(path: &Path, what: &str) -> String {
    format!("error: {}: {what}", path.display())
}
