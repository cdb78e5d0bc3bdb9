//! `whipple info`: what is in a run, a snapshot or a checkpoint.

mod measures;
mod snapshots;
mod summary;
mod text;

use std::path::{Path, PathBuf};

use serde_json::json;

use super::output_format::OutputFormat;
use super::results::{
    GRID, POINT_DATA, Results, ResultsError, component_names, running, status_and_presence,
};
use files::output::checkpoint::{self, FIELDS};
use files::output::h5::read::PORTION;
use files::output::h5::{Array, Content, Element, RowType};
use files::output::{Block, OutputError, RunFolder, Sheet, read_regular, read_small};
use files::preflight::memory::in_words;
use files::run::exit::EXIT_INPUT;
use files::run::say::{say, seconds, warn};
use text::Text;

/// Tell what is in a run folder, a snapshot or a checkpoint
///
/// Of a file: the case, the time, the particles of each body, and each field with its unit and
/// range. Of a run: where it stands, what it has written, what it last measured, and its figures.
#[derive(Debug, Clone, clap::Args)]
#[command(after_help = "Examples:
  whipple info runs/impact
  whipple info runs/impact/snapshots/step-00000100.vtkhdf
  whipple info runs/impact/checkpoints/step-00000100")]
pub struct InfoArgs {
    /// Run folder, snapshot (.vtkhdf) or checkpoint
    #[arg(value_name = "FILE_OR_RUN")]
    pub path: PathBuf,

    /// Form of the output.
    #[command(flatten)]
    pub format: OutputFormat,
}

/// Rows read at a time.
const CHUNK: usize = 1 << 18;

/// Runs the command; returns the exit code.
#[must_use]
pub fn run(args: &InfoArgs) -> u8 {
    args.format.begin();
    match look(&args.path) {
        Ok(text) => {
            say(text.lines.trim_end());
            args.format.print(|| text.values.into());
            0
        }
        Err(error) => {
            warn(&format!("error: {error}"));
            EXIT_INPUT
        }
    }
}

/// The text that the command prints.
///
/// # Errors
/// [`ResultsError`] if the path cannot be read.
pub fn describe(path: &Path) -> Result<String, ResultsError> {
    look(path).map(|text| text.lines)
}

fn look(path: &Path) -> Result<Text, ResultsError> {
    let mut text = Text::default();
    match Results::open(path)? {
        Results::Run(folder) => run_folder(&folder, &mut text)?,
        Results::Snapshot(file) => snapshot(&file, &mut text)?,
        Results::Checkpoint(file) => checkpoint_state(&file, &mut text)?,
    }
    Ok(text)
}

fn snapshot(file: &Content, text: &mut Text) -> Result<(), ResultsError> {
    let group = "/whipple";
    let time = file.all::<f64>("/VTKHDF/FieldData/TimeValue")?;
    let names: Vec<String> =
        serde_json::from_str(&file.note(group, "bodies")?).map_err(|error| {
            let what = format!("the names of its bodies cannot be read ({error})");
            OutputError::damaged(file.path(), what)
        })?;
    text.both("snapshot", file.path().display().to_string());
    text.both("title", file.note(group, "title")?);
    text.both("step", file.number::<u64>(group, "step")?);
    let time = time.first().copied().unwrap_or(f64::NAN);
    text.entry("time", seconds(time));
    text.value("time_s", time);
    if let Some(schedule) = file.note_if_any(group, "schedule")? {
        text.both("schedule", schedule);
    }
    if let Some(part) = file.note_if_any(group, PORTION)? {
        text.entry("part of the model", &part);
        text.value("part", part);
    }
    let [version, commit] = [file.note(group, "version")?, file.note(group, "commit")?];
    text.entry("version", format!("{version} ({commit})"));
    text.value("version", version);
    text.value("commit", commit);
    let ranks: u64 = file.number("/run", "ranks")?;
    let threads: u64 = file.number("/run", "threads")?;
    text.entry("ranks x threads", format!("{ranks} x {threads}"));
    text.value("ranks", ranks);
    text.value("threads", threads);
    let partitions = file.partitions(GRID)?;
    if partitions > 1 {
        text.entry("partitions", partitions);
    }
    text.value("partitions", partitions);
    bodies(file, POINT_DATA, &names, text)?;
    heading(text);
    field(file, "/VTKHDF/Points", true, text)?;
    for array in file.arrays(POINT_DATA)? {
        field(file, &format!("{POINT_DATA}/{}", array.name), true, text)?;
    }
    Ok(())
}

fn checkpoint_state(file: &Content, text: &mut Text) -> Result<(), ResultsError> {
    let input: toml::Table = file.text("/input")?.parse().unwrap_or_default();
    let list = input.get("body").and_then(toml::Value::as_array);
    let names: Vec<String> = list
        .into_iter()
        .flatten()
        .filter_map(|body| body.get("name")?.as_str().map(String::from))
        .collect();
    text.both("checkpoint", file.path().display().to_string());
    if let Some(title) = input.get("title").and_then(toml::Value::as_str) {
        text.both("title", title);
    }
    text.both("step", file.number::<u64>("/", "step")?);
    let time: f64 = file.number("/", "time")?;
    text.entry("time", seconds(time));
    text.value("time_s", time);
    let folder = file.path().parent().unwrap_or(Path::new("."));
    match checkpoint::manifest(folder) {
        Ok(manifest) => {
            let (version, commit) = (&manifest.version, &manifest.commit);
            text.entry(
                "version",
                format!("{version} ({commit}), format {}", manifest.format),
            );
            text.value("version", version.as_str());
            text.value("commit", commit.as_str());
            text.both("ranks", manifest.ranks);
            #[allow(clippy::cast_precision_loss, reason = "for people")]
            text.entry("size", in_words(manifest.size as f64));
            text.value("size_bytes", manifest.size);
        }
        Err(error) => text.both("not restartable", error.to_string()),
    }
    bodies(file, FIELDS, &names, text)?;
    heading(text);
    for array in file.arrays(FIELDS)? {
        field(file, &format!("{FIELDS}/{}", array.name), false, text)?;
    }
    Ok(())
}

/// Particles, in all and by body.
fn bodies(
    file: &Content,
    group: &str,
    names: &[String],
    text: &mut Text,
) -> Result<(), ResultsError> {
    let path = format!("{group}/body");
    let array = file.array(&path)?;
    if array.row != RowType::single(Element::U32) {
        let what = format!("{path} does not tell a body of each particle");
        return Err(OutputError::damaged(file.path(), what).into());
    }
    let (mut counts, mut others) = (vec![0_u64; names.len()], 0_u64);
    for_chunks(file, &path, &array, |bytes| {
        for body in bytemuck::pod_collect_to_vec::<u8, u32>(bytes) {
            match counts.get_mut(body as usize) {
                Some(count) => *count += 1,
                None => others += 1,
            }
        }
    })?;
    text.both("particles", array.rows);
    for (body, (count, name)) in counts.into_iter().zip(names).enumerate() {
        text.entry(&format!("  body {body}"), format!("{count:<10} {name}"));
        text.one_of("bodies", json!({ "body": name, "particles": count }));
    }
    if others > 0 {
        text.entry("  of other bodies", others);
    }
    Ok(())
}

fn heading(text: &mut Text) {
    text.line("");
    text.line(&format!(
        "{:<28} {:<8} {:>13} {:>13}",
        "field", "unit", "min", "max"
    ));
}

/// A field's unit, and the range of each component.
fn field(file: &Content, path: &str, vtk: bool, text: &mut Text) -> Result<(), ResultsError> {
    let array = file.array(path)?;
    let components = array.row.components;
    let mut ranges = vec![[f64::INFINITY, f64::NEG_INFINITY]; components];
    let mut odd = 0_u64;
    for_chunks(file, path, &array, |bytes| {
        for (k, value) in array.row.element.reals(bytes).into_iter().enumerate() {
            let [low, high] = &mut ranges[k % components];
            if value.is_finite() {
                (*low, *high) = (low.min(value), high.max(value));
            } else {
                odd += 1;
            }
        }
    })?;
    let names = component_names(components, vtk);
    for ([low, high], component) in ranges.into_iter().zip(names) {
        let name = format!("{} {component}", array.name);
        let unit = if array.unit.is_empty() {
            "-"
        } else {
            &array.unit
        };
        let range = match array.row.element {
            _ if low > high => format!("{0:>13} {0:>13}", "-"),
            Element::F64 => format!("{low:>13.5e} {high:>13.5e}"),
            _ => format!("{low:>13} {high:>13}"),
        };
        text.line(&format!("{name:<28} {unit:<8} {range}"));
        let ends = [low, high].map(|end| (low <= high).then_some(end));
        text.one_of(
            "fields",
            json!({ "field": name.trim_end(), "unit": array.unit, "min": ends[0], "max": ends[1] }),
        );
    }
    if odd > 0 {
        text.line(&format!("  {odd} of its values are not finite"));
    }
    Ok(())
}

fn for_chunks(
    file: &Content,
    path: &str,
    array: &Array,
    mut see: impl FnMut(&[u8]),
) -> Result<(), OutputError> {
    let mut bytes = Vec::new();
    let mut first = 0;
    while first < array.rows {
        let left = usize::try_from(array.rows - first).unwrap_or(CHUNK);
        let count = CHUNK.min(left);
        bytes.resize(count * array.row.bytes(), 0);
        let block = Block {
            total: array.rows,
            first,
            count,
        };
        file.rows(path, array.row, block, &mut bytes)?;
        see(&bytes);
        first += count as u64;
    }
    Ok(())
}

/// The last row of the run's fragments, if there is one.
fn fragments(folder: &RunFolder) -> Option<String> {
    let text = String::from_utf8(read_regular(&folder.fragments()).ok()?).ok()?;
    let sheet = Sheet::parse(&text).ok()?;
    let (_, row) = sheet.rows.last()?;
    let cell = |name: &str| row.get(sheet.names.iter().position(|n| n == name)?);
    let number = |name: &str| cell(name)?.parse::<f64>().ok();
    let (largest, total) = (number("largest_mass")?, number("total_mass")?);
    let (count, time) = (cell("fragments")?, seconds(number("time")?));
    let share = 100.0 * largest / total;
    Some(format!(
        "{count} at {time}, the heaviest with {share:.3} % of the mass"
    ))
}

fn run_folder(folder: &RunFolder, text: &mut Text) -> Result<(), ResultsError> {
    let (status, presence) = status_and_presence(folder, |_| true)?;
    text.both("run", folder.path().display().to_string());
    let input = read_small(&folder.case()).unwrap_or_default();
    let input: toml::Table = toml::from_slice(&input).unwrap_or_default();
    if let Some(title) = input.get("title").and_then(toml::Value::as_str) {
        text.both("title", title);
    }
    text.value("status", status.state.name());
    text.value("reason", status.reason.clone());
    let reason = status
        .reason
        .map_or_else(String::new, |r| format!(" ({r})"));
    let state = match presence {
        Some(presence) => running(&presence),
        None => format!("{}{reason}", status.state.name()),
    };
    text.both("state", state);
    text.both("step", status.step);
    text.entry("time", seconds(status.time));
    text.value("time_s", status.time);
    snapshots::report(folder, text)?;
    if let Some(line) = fragments(folder) {
        text.entry("fragments", line);
    }
    let checkpoints = checkpoint::list(&folder.checkpoints())?;
    let newest = checkpoints.last().map_or_else(String::new, |(step, _)| {
        format!(", the newest of step {step}")
    });
    text.entry("checkpoints", format!("{}{newest}", checkpoints.len()));
    let steps: Vec<u64> = checkpoints.iter().map(|(step, _)| *step).collect();
    text.value("checkpoint_steps", steps);
    for path in checkpoint::list_damaged(&folder.checkpoints())? {
        text.entry("passed over as damaged", path.display());
    }
    if let Some(path) = folder.set_aside_folder() {
        let what = "until the next checkpoint: what came after the one restarted from";
        text.entry("set aside", format!("{} ({what})", path.display()));
    }
    for (name, note) in folder.notes_of_part() {
        text.both(&format!("note on {name}"), note);
    }
    let figures = measures::last_figures(folder);
    if !figures.is_empty() {
        text.line("");
    }
    for (name, figure) in figures {
        text.entry(&name, figure);
    }
    text.value("last", measures::last_rows(folder));
    summary::summary(&folder.summary(), text)
}
