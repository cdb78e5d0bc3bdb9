//! The figures: kept, joined, printed and written.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use serde::{Deserialize, Serialize};

use super::cases::BenchCase;
use super::machine::Machine;
use engine::step::Phase;
use files::output::{OutputError, VERSION, commit, write_json};
use files::run::say::say;

/// Figures of one case on one configuration of ranks and threads.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Row {
    /// Name of the case.
    pub case: String,
    /// Particles of all ranks.
    pub particles: u64,
    /// Mean number of particles and images of the own group within 2h.
    pub neighbours: f64,
    /// Mean length of the list that a particle's cluster walks.
    pub list_length: f64,
    /// Ranks.
    pub ranks: usize,
    /// Threads of each rank.
    pub threads: usize,
    /// Timed steps of each repetition.
    pub steps: u64,
    /// Median of the repetitions.
    pub million_updates_per_second_per_core: f64,
    /// Each repetition's million updates a second for each core.
    pub repetitions: Vec<f64>,
    /// Speed of a core over that of a core by itself: the median of the ratios within repetitions.
    pub efficiency: Option<f64>,
    /// Bytes in particle arrays, lists and buffers, as the program counts them.
    pub bytes_per_particle: f64,
    /// Bytes at the peak of the processes beyond what they had before there were particles.
    pub peak_bytes_per_particle: Option<f64>,
    /// Messages that a rank sends in a step, the mean of all.
    pub messages_per_rank_and_step: f64,
    /// Bytes that a rank sends in a step, the mean of all.
    pub bytes_sent_per_rank_and_step: f64,
    /// Core time by phase over particle updates (ns).
    pub nanoseconds_by_phase: BTreeMap<String, f64>,
    /// Counted bytes over particles, by purpose.
    pub bytes_by_part: BTreeMap<String, f64>,
}

impl Row {
    /// One row of several repetitions of the same.
    ///
    /// # Panics
    /// If there are none.
    pub fn median(repetitions: &[Self]) -> Self {
        let all = |figure: &dyn Fn(&Self) -> f64| repetitions.iter().map(figure).collect();
        let rates: Vec<f64> = all(&|row| row.million_updates_per_second_per_core);
        let peaks = repetitions
            .iter()
            .filter_map(|row| row.peak_bytes_per_particle);
        let mut row = Self {
            million_updates_per_second_per_core: median(&rates),
            repetitions: rates,
            peak_bytes_per_particle: peaks.max_by(f64::total_cmp),
            ..repetitions[0].clone()
        };
        for (phase, figure) in &mut row.nanoseconds_by_phase {
            *figure = median(&all(&|row| row.nanoseconds_by_phase[phase]));
        }
        row
    }

    /// Sets the efficiency against the row of one core, whose repetitions took turns with these.
    pub fn compare(&mut self, one: &Self) {
        let pairs = self.repetitions.iter().zip(&one.repetitions);
        self.efficiency = Some(median(
            &pairs.map(|(many, one)| many / one).collect::<Vec<_>>(),
        ));
    }

    fn is(&self, ranks: usize, threads: usize) -> bool {
        (self.ranks, self.threads) == (ranks, threads)
    }

    fn configuration(&self) -> String {
        format!("{} x {}", self.ranks, self.threads)
    }
}

/// The middle of some figures, or the mean of the two in the middle.
pub(super) fn median(figures: &[f64]) -> f64 {
    let mut sorted = figures.to_vec();
    sorted.sort_by(f64::total_cmp);
    let n = sorted.len();
    0.5 * (sorted[(n - 1) / 2] + sorted[n / 2])
}

/// All figures, with program and machine.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Report {
    /// Version of the program.
    pub version: String,
    /// Commit of the program.
    pub commit: String,
    /// The machine.
    pub machine: Machine,
    /// Repetitions of each measurement.
    pub repeat: u32,
    /// Configurations that could not be measured, with reasons.
    pub skipped: Vec<String>,
    /// The figures.
    pub rows: Vec<Row>,
}

impl Report {
    /// A report without figures yet.
    pub fn new(repeat: u32) -> Self {
        Self {
            version: VERSION.to_owned(),
            commit: commit().to_owned(),
            machine: Machine::here(),
            repeat,
            skipped: Vec::new(),
            rows: Vec::new(),
        }
    }

    /// Prints the rows of a case, after the heading if they are the first.
    pub fn print_case(&self, case: &BenchCase) {
        if self.rows.first().is_some_and(|row| row.case == case.name) {
            self.print_heading();
        }
        for row in self.rows.iter().filter(|row| row.case == case.name) {
            let or_dash = |figure: Option<f64>, digits: usize| {
                figure.map_or("-".to_owned(), |figure| format!("{figure:.digits$}"))
            };
            say(&format!(
                "{:<12} {:>9} {:>10.1} {:>6.1} {:>9} {:>9.3} {:>10} {:>10.0} {:>6} {:>10.1} {:>10.1}",
                row.case,
                row.particles,
                row.neighbours,
                row.list_length,
                row.configuration(),
                row.million_updates_per_second_per_core,
                or_dash(row.efficiency, 3),
                row.bytes_per_particle,
                or_dash(row.peak_bytes_per_particle, 0),
                row.messages_per_rank_and_step,
                row.bytes_sent_per_rank_and_step * 1e-3,
            ));
        }
    }

    fn print_heading(&self) {
        let machine = &self.machine;
        say(&format!(
            "whipple {} ({}) on {}, {}; medians of {}",
            self.version, self.commit, machine.processor, machine.instructions, self.repeat
        ));
        say(&format!(
            "{:<12} {:>9} {:>10} {:>6} {:>9} {:>9} {:>10} {:>10} {:>6} {:>10} {:>10}",
            "", "", "", "", "ranks x", "M updates", "", "bytes/", "at", "messages", "kB"
        ));
        say(&format!(
            "{:<12} {:>9} {:>10} {:>6} {:>9} {:>9} {:>10} {:>10} {:>6} {:>10} {:>10}",
            "case",
            "particles",
            "neighbours",
            "list",
            "threads",
            "/s/core",
            "efficiency",
            "particle",
            "peak",
            "/rank/step",
            "/rank/step"
        ));
    }

    /// Prints the core time by phase and the memory by purpose: a line for each, a column for each
    /// configuration.
    pub fn print_breakdown(&self) {
        let mut case = "";
        for row in &self.rows {
            if row.case != case {
                case = &row.case;
                let rows: Vec<&Row> = self.rows.iter().filter(|row| row.case == case).collect();
                let what = format!("{case}: core time, ns a particle and step");
                let phases = Phase::ALL.iter().map(|(_, name)| *name);
                print_breakdown(&what, &rows, phases, |row| &row.nanoseconds_by_phase);
                let names = rows.iter().flat_map(|row| row.bytes_by_part.keys());
                let names: BTreeSet<&str> = names.map(String::as_str).collect();
                let what = format!("{case}: memory, bytes a particle");
                print_breakdown(&what, &rows, names, |row| &row.bytes_by_part);
            }
        }
    }

    /// Prints the speed of a core beside another thread or rank over that of one alone: a line for each
    /// case.
    pub fn print_efficiencies(&self) {
        say("\nefficiency: speed of a core over that of a core by itself");
        say(&format!(
            "  {:<14}{:>14}{:>14}",
            "", "two threads", "two ranks"
        ));
        let alone = self.rows.iter().filter(|row| row.is(1, 1));
        for case in alone.map(|row| &row.case) {
            let figure = |ranks: usize, threads: usize| {
                let mut rows = self.rows.iter().filter(|row| row.case == *case);
                let row = rows.find(|row| row.is(ranks, threads));
                let efficiency = row.and_then(|row| row.efficiency);
                efficiency.map_or("-".to_owned(), |figure| format!("{figure:.3}"))
            };
            say(&format!(
                "  {case:<14}{:>14}{:>14}",
                figure(1, 2),
                figure(2, 1)
            ));
        }
        for reason in &self.skipped {
            say(&format!("  {reason}"));
        }
    }

    /// Writes all figures to a file, if there is one.
    ///
    /// # Errors
    /// [`OutputError::Io`].
    pub fn write(&self, path: Option<&Path>) -> Result<(), OutputError> {
        path.map_or(Ok(()), |path| write_json(path, self))
    }
}

/// Figures of some rows, a line for each name, and their sums.
fn print_breakdown<'a>(
    what: &str,
    rows: &[&Row],
    names: impl IntoIterator<Item = &'a str>,
    figures_of: fn(&Row) -> &BTreeMap<String, f64>,
) {
    let line = |name: &str, figure: &dyn Fn(&Row) -> String| {
        let name = format!("  {:<30}", name.replace('_', " "));
        let figures = rows.iter().map(|row| figure(row));
        say(&figures.fold(name, |line, figure| format!("{line}{figure:>9}")));
    };
    say(&format!("\n{what}"));
    line("ranks x threads", &Row::configuration);
    for name in names {
        let figure = |row: &Row| figures_of(row).get(name).copied().unwrap_or(0.0);
        if rows.iter().any(|row| figure(row) >= 0.05) {
            line(name, &|row| format!("{:.1}", figure(row)));
        }
    }
    line("all", &|row| {
        format!("{:.1}", figures_of(row).values().sum::<f64>())
    });
}
