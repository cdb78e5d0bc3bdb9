//! `whipple check`: is a case sound, and what will it cost?

mod document;
mod explain;

use std::path::{Path, PathBuf};

use super::output_format::OutputFormat;
use super::plan::duration;
use super::plot::out;
use comm::Comm;
use document::document;
use files::input::{self, InputError};
use files::output::{snapshot, unit_of_model};
use files::plan::{self, Files, Machine};
use files::preflight::{self, Approach, memory};
use files::run::exit::EXIT_INPUT;
use files::run::say::{counted, say, warn};
use model::readable::{short, shown};
use model::{Body, Case, FibrePattern, Fibres, MeasureKind, Quantity, cube};
use plot::{self, PlotError};

/// Check a case without running it: particles by body, memory, expected steps
///
/// Exits with 0 if the case can run and with 2 if anything is wrong; things that are allowed but
/// look like mistakes are warnings.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:
  whipple check inputs/quarter-impact
  whipple check inputs/quarter-impact --picture model.png
  whipple check inputs/quarter-impact/case.toml --set spacing=0.01mm
  whipple check inputs/quarter-impact --explain")]
pub struct CheckArgs {
    /// Case file (TOML), or a folder with a case.toml
    #[arg(value_name = "CASE")]
    case: PathBuf,

    /// Change a value of the case, as in spacing=0.015mm; may be given many times
    #[arg(short, long, value_name = "KEY=VALUE")]
    set: Vec<String>,

    /// Ranks that the run will have, for the memory that each takes
    #[arg(short = 'n', long, value_name = "N", default_value_t = 1)]
    #[arg(value_parser = clap::value_parser!(u32).range(1..=100_000))]
    ranks: u32,

    /// Print each key of the case with its value and where that comes from, as a case that can be run
    #[arg(short, long, conflicts_with_all = ["json", "picture", "ranks"])]
    explain: bool,

    #[command(flatten)]
    format: OutputFormat,

    /// Draw the particles as they will begin into this SVG or PNG file: a section, and what is seen of them
    /// along the axes
    #[arg(short, long, value_name = "FILE")]
    picture: Option<PathBuf>,

    /// Plane of the picture's section, as in y=0.1mm; with the axis alone its plane of symmetry or the middle
    /// [default: one that cuts most bodies, along the motion]
    #[arg(
        long,
        value_name = "AXIS=POSITION",
        requires = "picture",
        allow_hyphen_values = true
    )]
    section: Option<String>,
}

/// Runs the command; returns the exit code.
pub fn run(args: &CheckArgs) -> u8 {
    args.format.begin();
    if args.explain {
        return print_result(explain::explain(&args.case, &args.set));
    }
    let case = match input::load(&args.case, &args.set) {
        Ok(case) => case,
        Err(error) => {
            warn(&error.to_string());
            return EXIT_INPUT;
        }
    };
    if let Err(error) = snapshot::quantities(&case.output.fields) {
        warn(&format!("error: {error}"));
        return EXIT_INPUT;
    }
    let approaches = preflight::approaches(&case);
    let mut warnings = preflight::warnings(&case, &approaches);
    warnings.extend(preflight::advice(&case, &approaches));
    for warning in preflight::shortened(&warnings) {
        warn(&format!("warning: {warning}"));
    }
    let ranks = args.ranks as usize;
    if !args.format.is_json() {
        print_report(&case, &approaches, ranks);
        say(&verdict(warnings.len()));
    }
    let drawn = args
        .picture
        .as_ref()
        .map_or(Ok(()), |path| draw(&case, path, args.section.as_deref()));
    match drawn {
        Ok(()) => {
            args.format
                .print(|| document(&case, &approaches, ranks, &warnings));
            0
        }
        Err(error) => {
            warn(&format!("error: {error}"));
            EXIT_INPUT
        }
    }
}

/// Prints what a case is; gives the exit code.
fn print_result(text: Result<String, InputError>) -> u8 {
    match text {
        Ok(text) => {
            say(text.trim_end());
            0
        }
        Err(error) => {
            warn(&error.to_string());
            EXIT_INPUT
        }
    }
}

fn draw(case: &Case, path: &Path, section: Option<&str>) -> Result<(), PlotError> {
    out::check_picture(path)?;
    out::write(&plot::preview(case, section, None)?, path)
}

/// The mass of so many particles of a body (SI); none of a driven one.
#[allow(clippy::cast_precision_loss, reason = "for people")]
fn mass_of(case: &Case, body: &Body, count: u64) -> Option<f64> {
    // Bodies with equal particles have been counted.
    let shares = || match body.lattice.grading {
        _ if case.axisymmetric => populate::rings(case, body),
        None => count as f64,
        Some(_) => populate::shares(body, case.dimension, &case.symmetry),
    };
    (body.driven().is_none()).then(|| case.particle_mass(body) * shares())
}

/// That mass, and by how much each has more than Δp^d to bear that; nothing of a driven body.
fn mass(case: &Case, body: &Body, count: u64) -> String {
    let Some(mass) = mass_of(case, body, count) else {
        return String::new();
    };
    let each = body.lattice.particle_volume(case.dimension);
    let text = shown(mass, unit_of_model("kg", case.extent()));
    let cell = cube(body.lattice.spacing, case.dimension);
    let more = 100.0 * (each / cell - 1.0);
    if more == 0.0 {
        format!(", {text}")
    } else {
        let word = if more > 0.0 { "more" } else { "less" };
        format!(", {text} (each {:.2} % {word} than its cell)", more.abs())
    }
}

/// Areal mass (kg/m²), thickness (m) and particles across a body of yarns or walls.
fn layer(case: &Case, body: &Body) -> Option<[f64; 3]> {
    let fibres = body.initial.fibres.as_ref();
    let members = case.materials[body.material].has_members();
    let straight = |fibres: &&Fibres| members && fibres.pattern == FibrePattern::Straight;
    let normal = fibres.filter(straight)?.normal;
    let thickness = body.thickness_along(&normal, case.dimension);
    let layers = thickness / body.lattice.spacing;
    Some([case.initial_density(body) * thickness, thickness, layers])
}

/// Prints the composition of a body; returns its number of particles.
fn print_body(case: &Case, body: &Body) -> u64 {
    let count = populate::count(body, case.dimension, &case.symmetry, None);
    let range = |length: f64| {
        let sizes = body.lattice.sizes.unwrap_or([1.0; 2]);
        let [least, most] = sizes.map(|size| case.length_unit.text(size * length));
        if least == most {
            least
        } else {
            format!("{least} to {most}")
        }
    };
    say(&format!(
        "  {:<16} {count:>10} particles of {}, spacing {}, h {}{}{}",
        body.name,
        case.materials[body.material].name,
        range(body.lattice.spacing),
        range(body.smoothing_length),
        mass(case, body, count),
        if body.total { ", total form" } else { "" },
    ));
    if let Some((cloud, _)) = body.cloud() {
        let names: Vec<&str> = cloud.quantities().map(Quantity::name).collect();
        let with = if names.is_empty() {
            String::new()
        } else {
            format!(" with {}", names.join(", "))
        };
        say(&format!("  {:<16} from {}{with}", "", cloud.file.path));
        if let Some((lower, upper)) = populate::bounds(body, case.dimension) {
            let [lower, upper] =
                [lower, upper].map(|x| case.length_unit.vector(&x[..case.dimension]));
            say(&format!("  {:<16} spans {lower} to {upper}", ""));
        }
    }
    if let Some([areal, thickness, layers]) = layer(case, body) {
        say(&format!(
            "  {:<16} a layer of {}, {} thick, {layers:.1} particles across",
            "",
            shown(areal, "kg/m^2"),
            case.length_unit.text(thickness),
        ));
    }
    if let Some(beginning) = preflight::beginning(case, body) {
        say(&format!("  {:<16} begins with {beginning}", ""));
    }
    count
}

#[allow(clippy::cast_precision_loss, reason = "for people")]
fn print_report(case: &Case, approaches: &[Approach], ranks: usize) {
    let kind = match case.dimension {
        2 if case.axisymmetric => "axisymmetric".to_owned(),
        dimension => format!("{dimension}-D"),
    };
    say(&format!("{} ({kind})", case.title));
    let counts = case.bodies.iter().map(|body| print_body(case, body));
    let total: u64 = counts.sum();
    let memory = memory::in_words(memory::of_rank(case, &Comm::solo(), ranks));
    let plural = if ranks == 1 { "" } else { "s" };
    say(&format!(
        "  {:<16} {total:>10} particles, about {memory} a rank on {ranks} rank{plural}",
        "all"
    ));
    for (pair, [a, b]) in meetings(case, approaches) {
        say(&format!(
            "  {a} and {b} meet at {}, from {:.1} spacings apart",
            shown(pair.time, "s"),
            pair.gap
        ));
    }
    print_measures(case);
    let steps = plan::expected_steps(case, approaches, 0.0);
    if let Some(steps) = steps {
        let end = shown(case.run.end_time, "s");
        let more = if case.bodies.iter().any(|body| body.total) {
            ", some times as many where the total form squeezes particles"
        } else {
            ""
        };
        say(&format!("  about {} steps to {end}{more}", short(steps)));
    }
    let machine = machine(case, approaches);
    if let Ok(files) = Files::new(case, approaches, total as f64, steps.unwrap_or(0.0)) {
        print_costs(case, &files, steps, ranks, &machine);
    }
}

/// What a case with so many warnings is.
fn verdict(warnings: usize) -> String {
    match warnings {
        0 => "sound".to_owned(),
        some => format!("can run, with {}", counted(some as u64, "warning")),
    }
}

/// Bodies that are going to meet, with their names.
fn meetings<'a>(
    case: &'a Case,
    approaches: &'a [Approach],
) -> impl Iterator<Item = (&'a Approach, [&'a str; 2])> {
    let pairs = approaches.iter();
    let meeting = pairs.filter(|pair| pair.time.is_finite() && pair.time > 0.0);
    meeting.map(|pair| {
        let names = pair.bodies.map(|body| case.bodies[body].name.as_str());
        (pair, names)
    })
}

/// An ordinary machine, which is spared what rests and takes longer for what is unequal.
fn machine(case: &Case, approaches: &[Approach]) -> Machine {
    Machine::default()
        .at_work(plan::work_of_unequal(case))
        .at_rest(plan::share_of_work(case, approaches))
}

/// Seconds of so many steps with their files on a machine.
fn wall_time(case: &Case, ranks: usize, machine: &Machine, steps: f64, files: &Files) -> f64 {
    let stepping = steps * plan::rough_step(case, ranks, machine);
    stepping + files.written() / machine.disk_bandwidth
}

/// Prints the time that the run takes on an ordinary machine, and its disk space.
fn print_costs(case: &Case, files: &Files, steps: Option<f64>, ranks: usize, machine: &Machine) {
    if let Some(steps) = steps {
        let wall = duration(wall_time(case, ranks, machine, steps, files));
        let plural = if ranks == 1 { "" } else { "s" };
        let name = &machine.name;
        say(&format!(
            "  about {wall} on {ranks} rank{plural} of one core of {name} (`whipple plan` tells more)"
        ));
    }
    let disk = memory::in_words(files.disk());
    say(&format!("  about {disk} on the disk at the end"));
}

/// Prints the measures of the run.
fn print_measures(case: &Case) {
    let options = &case.measure;
    let names = options.measures.iter().map(|measure| {
        let (name, word) = (&measure.name, measure.kind.word());
        // Debris is called after what it has left, and bodies may be called what they are.
        match &measure.kind {
            MeasureKind::Debris(_) => name.clone(),
            _ if name == word => name.clone(),
            _ => format!("{name} ({word})"),
        }
    });
    let mut all: Vec<String> = names.collect();
    let many = [
        (options.gauges.len(), "gauge"),
        (options.witnesses.len(), "witness plane"),
    ];
    for (count, word) in many.into_iter().filter(|(count, _)| *count > 0) {
        all.push(counted(count as u64, word));
    }
    if !all.is_empty() {
        say(&format!("  measures: {}", all.join(", ")));
    }
}
