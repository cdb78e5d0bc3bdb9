//! `whipple fragments`: the fragments of a run's snapshots, by the code of the run itself.

mod catalogue;
mod debris;
mod loaded;

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use serde_json::{Value, json};

use super::output_format::{self, OutputFormat, wrote};
use super::results::ResultsError;
use super::which::Which;
use debris::{Debris, largest_pieces, main_body};
use engine::fragments::{Census, Fragment, Rule, Share, find_alone};
use files::FileOpener;
use files::input;
use files::output::fragments::FragmentTable;
use files::output::{OutputError, RunFolder, Sheet, write_atomically};
use files::run::exit::EXIT_INPUT;
use files::run::say::{counted, say, seconds, warn};
use loaded::Loaded;
use model::readable::{one_line, shown, shown_vector};
use model::{FragmentOptions, Include};
use plot::{PlotError, choose, snapshots};

/// Tell the fragments of a run: how many, how heavy, how large, how fast
///
/// A fragment is matter that hangs together by particles near each other; of a model with symmetry
/// planes the whole is told. Debris is what is of no body's largest piece: its fragments and what failed. The rule is that of
/// the case's `[fragments]` unless options change it.
#[derive(Debug, Clone, clap::Args)]
#[command(after_help = "Examples:
  whipple fragments runs/impact
  whipple fragments runs/impact --at 5us --csv fragments.csv
  whipple fragments runs/impact --include all --min-particles 20
  whipple fragments runs/impact --catalogue runs/impact/catalogue
  whipple plot runs/impact --fragments")]
pub struct FragmentsArgs {
    /// Run folder, or snapshot (.vtkhdf)
    #[arg(value_name = "FILE_OR_RUN")]
    pub path: PathBuf,

    /// The snapshot of a run.
    #[command(flatten)]
    pub which: Which,

    /// Largest distance of linked particles, over the mean of their sizes at the start [default:
    /// the case's, else 1.5]
    #[arg(long, value_name = "NUMBER")]
    pub link: Option<f64>,

    /// What belongs to fragments: what has not failed, or all matter [default: the case's, else
    /// intact]
    #[arg(long, value_name = "intact|all", value_parser = ["intact", "all"])]
    pub include: Option<String>,

    /// Let a single particle join what hangs together by nothing else
    #[arg(long)]
    pub bridges: bool,

    /// Keep bodies apart: no fragment is of two
    #[arg(long)]
    pub apart: bool,

    /// Least number of particles of a fragment; the rest is dust [default: the case's, else 8]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..))]
    pub min_particles: Option<u64>,

    /// Form of the output.
    #[command(flatten)]
    pub format: OutputFormat,

    /// Write the table of all fragments, as a run does into its folder `fragments`
    #[arg(long, value_name = "FILE")]
    pub csv: Option<PathBuf>,

    /// Write the same table as HDF5
    #[arg(long, value_name = "FILE")]
    pub hdf5: Option<PathBuf>,

    /// Write a catalogue of debris into a folder: catalogue.csv with velocity, spin, lengths, area to mass and more of each
    /// fragment, their closed surfaces as catalogue.vtk, ledger.csv, and catalogue.png beside NASA's breakup model
    #[arg(long, value_name = "DIR")]
    pub catalogue: Option<PathBuf>,
}

/// Why the fragments of a snapshot are unknown.
#[derive(Debug, thiserror::Error)]
pub enum FragmentsError {
    /// No snapshot is found.
    #[error(transparent)]
    Choice(#[from] PlotError),
    /// The path is nothing of ours.
    #[error(transparent)]
    Results(#[from] ResultsError),
    /// A file cannot be read or written.
    #[error(transparent)]
    Output(#[from] OutputError),
    /// The snapshot's description of itself is inconsistent or incomplete.
    #[error("{} cannot be taken: {reason}", path.display())]
    Snapshot {
        /// The file.
        path: PathBuf,
        /// The fault.
        reason: String,
    },
    /// An option of the command line is out of range.
    #[error("--link must be between 1 and 4")]
    Link,
}

/// Fragments that are listed on the terminal.
const LISTED: usize = 10;

/// Runs the command; returns the exit code.
#[must_use]
pub fn run(args: &FragmentsArgs) -> u8 {
    args.format.begin();
    match evaluate(args) {
        Ok(text) => {
            say(text.trim_end());
            0
        }
        Err(error) => {
            warn(&format!("error: {error}"));
            EXIT_INPUT
        }
    }
}

/// Tells the fragments, and writes the tables that are asked for.
///
/// # Errors
/// [`FragmentsError`] if there is no such snapshot, or if it cannot be read or a table not written.
pub fn evaluate(args: &FragmentsArgs) -> Result<String, FragmentsError> {
    if args.link.is_some_and(|link| !(1.0..=4.0).contains(&link)) {
        return Err(FragmentsError::Link);
    }
    let path = chosen(args)?;
    let loaded = Loaded::read(&path)?;
    if let Some(missing) = &loaded.missing {
        warn(&format!("warning: {missing}"));
    }
    let options = options(args, loaded.options);
    if let Some(doubt) = options.doubt(loaded.dimension) {
        warn(&format!("warning: {doubt}"));
    }
    let rule = Rule::new(&options, loaded.dimension);
    let included = loaded.included(options.include);
    let particles = loaded.particles(&included);
    let census = find_alone(&particles, &loaded.symmetry, &rule);
    let bodies: Vec<&str> = loaded.bodies.iter().map(String::as_str).collect();
    let table = FragmentTable::new(&census, &bodies, loaded.dimension);
    if let Some(path) = &args.csv {
        write_atomically(path, &table.text())?;
        wrote(path, "");
    }
    if let Some(path) = &args.hdf5 {
        table.write_hdf5(path)?;
        wrote(path, "");
    }
    let is_largest = largest_pieces(&census, loaded.bodies.len());
    let debris = debris::of_bodies(&loaded, (&census, &is_largest), &included);
    args.format.print(|| {
        let mut document = document(&loaded, &census, &options, &table);
        let debris = debris.iter().map(|debris| debris.document(&loaded.bodies));
        document["debris"] = debris.collect();
        document
    });
    let mut text = report(&loaded, &census, &options);
    list_pieces(&loaded, (&census, &is_largest), &mut text);
    list_debris(&loaded, &debris, &mut text);
    if let Some(folder) = &args.catalogue {
        text += &catalogue::write(folder, &path, (&loaded, &census), loaded.case.as_ref())?;
    }
    Ok(text)
}

/// The snapshot that is asked for.
fn chosen(args: &FragmentsArgs) -> Result<PathBuf, FragmentsError> {
    if !args.path.is_dir() {
        if args.which.any() {
            let choice = "--at and --snapshot choose among the snapshots of a run: give its folder";
            return Err(PlotError::Options(choice).into());
        }
        return Ok(args.path.clone());
    }
    let available = snapshots(&FileOpener, RunFolder::at(&args.path).path())?;
    Ok(choose(&available, &args.which.wanted()?)?.remove(0))
}

/// The rule of the case with what the command line changes of it.
fn options(args: &FragmentsArgs, of_case: Option<FragmentOptions>) -> FragmentOptions {
    let defaults = of_case.unwrap_or_default();
    FragmentOptions {
        link: args.link.unwrap_or(defaults.link),
        include: match args.include.as_deref() {
            Some("all") => Include::All,
            Some(_) => Include::Intact,
            None => defaults.include,
        },
        bridges: args.bridges || defaults.bridges,
        across_bodies: !args.apart && defaults.across_bodies,
        min_particles: args.min_particles.unwrap_or(defaults.min_particles),
        ..defaults
    }
}

fn report(loaded: &Loaded, census: &Census, options: &FragmentOptions) -> String {
    let per = ["kg/m^2", "kg/m", "kg"][loaded.dimension - 1];
    let mass = |value: f64| shown(value, per);
    let mut text = format!(
        "{} at {}: {} of {} particles or more, of {} in all\n",
        one_line(&loaded.title),
        seconds(loaded.time),
        counted(census.count(), "fragment"),
        options.min_particles,
        mass(census.total.mass),
    );
    let mut entry = |name: &str, value: String| {
        let _ = writeln!(text, "{name:<36} {value}");
    };
    let share = |share: &Share| {
        let part = 100.0 * share.mass / census.total.mass;
        let particles = counted(share.particles, "particle");
        format!("{} ({part:.2} %) in {particles}", mass(share.mass))
    };
    entry("in fragments", share(&census.in_fragments));
    entry("dust", share(&census.dust));
    if options.include == Include::Intact {
        entry("failed", share(&census.excluded));
    }
    text
}

/// Lists the largest piece of each body and the debris, the heaviest first.
fn list_pieces(loaded: &Loaded, (census, is_largest): (&Census, &[bool]), text: &mut String) {
    if census.fragments.is_empty() {
        return;
    }
    text.push_str("\n     label  copies  particles        mass    diameter  body and velocity\n");
    let mut left_out = false;
    for (wanted, heading) in [(true, "largest piece of each body"), (false, "debris")] {
        let all = census.fragments.iter().zip(is_largest);
        let mut those = all
            .filter(|(_, is_largest)| **is_largest == wanted)
            .peekable();
        if those.peek().is_some() {
            let _ = writeln!(text, "{heading}:");
        }
        for (fragment, _) in those.by_ref().take(LISTED) {
            list(fragment, loaded, text);
        }
        left_out |= those.next().is_some();
    }
    if left_out {
        text.push_str("all of them: --csv FILE\n");
    }
}

/// Lists the debris of each body.
fn list_debris(loaded: &Loaded, debris: &[Debris], text: &mut String) {
    let per = ["kg/m^2", "kg/m", "kg"][loaded.dimension - 1];
    if !debris.is_empty() {
        text.push_str("\ndebris in all, beside the largest piece of each body:\n");
    }
    for of_body in debris {
        let mass = |value: f64| shown(value, per);
        let _ = writeln!(
            text,
            "{:<16} {} ({:.1} % of it): {} in {}, {} failed; at {}",
            one_line(&loaded.bodies[of_body.body]),
            mass(of_body.mass),
            100.0 * of_body.share,
            mass(of_body.in_fragments),
            counted(of_body.fragments, "fragment"),
            mass(of_body.failed),
            shown_vector(&of_body.velocity[..loaded.dimension], "m/s"),
        );
    }
}

/// The whole report, in SI units, with the table of all fragments.
fn document(
    loaded: &Loaded,
    census: &Census,
    options: &FragmentOptions,
    table: &FragmentTable,
) -> Value {
    let share = |share: &Share| json!({ "mass": share.mass, "particles": share.particles });
    let sheet = Sheet::parse(&String::from_utf8_lossy(&table.text()));
    let mut document = output_format::table(&sheet.expect("a table that was made here"));
    document["title"] = loaded.title.as_str().into();
    document["time"] = loaded.time.into();
    document["units"]["time"] = "s".into();
    document["fragments"] = census.count().into();
    document["total_mass"] = census.total.mass.into();
    document["in_fragments"] = share(&census.in_fragments);
    document["dust"] = share(&census.dust);
    document["failed"] = share(&census.excluded);
    document["rule"] = json!({
        "link": options.link,
        "include": if options.include == Include::Intact { "intact" } else { "all" },
        "bridges": options.bridges,
        "across_bodies": options.across_bodies,
        "min_particles": options.min_particles,
    });
    document
}

fn list(fragment: &Fragment, loaded: &Loaded, text: &mut String) {
    let dimension = loaded.dimension;
    let per = ["kg/m^2", "kg/m", "kg"][dimension - 1];
    let _ = writeln!(
        text,
        "{:>10} {:>7} {:>10} {:>11} {:>11}  {} {}",
        fragment.label,
        fragment.copies,
        fragment.particles,
        shown(fragment.mass, per),
        shown(fragment.diameter(), "m"),
        one_line(&loaded.bodies[main_body(fragment)]),
        shown_vector(&fragment.velocity[..dimension], "m/s"),
    );
}

/// The rule of a case's text, if it can be read.
fn read_case(path: &Path, text: &str) -> Result<model::Case, String> {
    let name = path.display().to_string();
    input::parse(&name, text, &[]).map_err(|error| error.to_string())
}
