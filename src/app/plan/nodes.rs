//! Ranks and threads that fill the cores of so many nodes, compared.

use std::path::Path;

use super::job::{self, Job};
use super::source::Source;
use super::{PlanArgs, layout_of, print_files, row_of, table, write_sheet, write_text};
use files::plan::{Machine, Row, Sharing};
use files::preflight::memory::in_words;
use files::run::say::say;

/// Fewest particles of a rank that is not the only one of its node.
const FEWEST: usize = 1000;
/// Most ranks.
const MOST: usize = 100_000;

/// Width of the first column.
const WIDTH: usize = 25;

/// Compares layouts, and writes the job of the fastest.
pub fn plan(
    args: &PlanArgs,
    path: &Path,
    source: &Source,
    machine: &Machine,
) -> Result<(), String> {
    let run = args.job.as_ref().map(|_| job::run_of(path, source));
    let run = run.transpose()?;
    let rows = compare(args, source, machine)?;
    say("");
    let files = print_files(source, machine)?;
    let steps = source.outlook.steps;
    write_sheet(args, &rows, steps)?;
    if let (Some(file), Some(run)) = (&args.job, run) {
        let row = fastest(&rows, machine).ok_or_else(|| too_large(&rows, machine))?;
        let writing = files.written() / machine.disk_bandwidth;
        let wanted = steps.map(|steps| steps * row.time.all + writing);
        let job = Job::new(row, machine, wanted);
        write_text(file, &job.text(file, [path, &run], &args.set))?;
        say(&job.summary(file));
    }
    args.format
        .print(|| table::document(source, machine, &rows, &files));
    Ok(())
}

/// Prints the layouts for each number of nodes, a star on the fastest of each that fits.
fn compare(args: &PlanArgs, source: &Source, machine: &Machine) -> Result<Vec<Row>, String> {
    say("");
    let head = "nodes x ranks x threads";
    say(&format!("{head:>WIDTH$}{}", table::head()));
    let alone = layout_of(source, 1, Some(1), 1)?.loads[0];
    let mut all = Vec::new();
    for nodes in args.nodes.iter().map(|&nodes| nodes as usize) {
        let mut rows = Vec::new();
        for sharing in sharings(args, machine, nodes, source.particles.positions.len())? {
            let ranks = nodes * sharing.ranks_per_node;
            let layout = layout_of(source, ranks, None, sharing.ranks_per_node)?;
            rows.push(row_of(source, machine, &layout, sharing, &alone));
        }
        let fastest = fastest(&rows, machine).copied();
        for row in &rows {
            let star = if Some(*row) == fastest { "*" } else { "" };
            let layout = format!("{star}{}", layout(row));
            let line = table::line(row, false, source.outlook.steps);
            let excess = table::excess(row, machine);
            say(&format!("{layout:>WIDTH$}{line}{excess}"));
        }
        all.extend(rows);
    }
    Ok(all)
}

/// The ways in which ranks share that many nodes: all threads but one that divide their cores, or
/// the requested one.
fn sharings(
    args: &PlanArgs,
    machine: &Machine,
    nodes: usize,
    particles: usize,
) -> Result<Vec<Sharing>, String> {
    let cores = machine.ranks_per_node(1);
    let ranks = |sharing: &Sharing| nodes * sharing.ranks_per_node;
    let mut all = match (args.threads, args.ranks_per_node) {
        (None, None) => machine.sharings(),
        (None, Some(ranks)) => vec![Sharing {
            threads: (cores / ranks as usize).max(1),
            ranks_per_node: ranks as usize,
        }],
        (Some(_), _) => vec![args.sharing(machine)],
    };
    if all.len() > 1 {
        let many = |sharing: &Sharing| ranks(sharing) <= MOST.min(particles / FEWEST);
        all.retain(|sharing| sharing.ranks_per_node == 1 || many(sharing));
    }
    for sharing in &all {
        let Sharing {
            threads,
            ranks_per_node,
        } = *sharing;
        if threads * ranks_per_node > cores {
            return Err(format!(
                "error: {ranks_per_node} ranks of {threads} threads are more than the {cores} cores of a node"
            ));
        }
        if ranks(sharing) > MOST {
            return Err(format!(
                "error: {nodes} nodes of {ranks_per_node} ranks are {} ranks; a plan takes {MOST} at most",
                ranks(sharing)
            ));
        }
    }
    Ok(all)
}

/// Nodes, ranks of each, threads of each.
fn layout(row: &Row) -> String {
    let Sharing {
        threads,
        ranks_per_node,
    } = row.sharing;
    format!(
        "{} x {ranks_per_node} x {threads}",
        row.ranks / ranks_per_node
    )
}

/// The fastest that fits into the memory of its nodes; of equals the first.
fn fastest<'a>(rows: &'a [Row], machine: &Machine) -> Option<&'a Row> {
    let fit = rows
        .iter()
        .filter(|row| row.memory_of_node() <= machine.memory_per_node);
    fit.min_by(|a, b| a.time.all.total_cmp(&b.time.all))
}

/// That none of them fits.
fn too_large(rows: &[Row], machine: &Machine) -> String {
    let least = rows.iter().map(Row::memory_of_node);
    format!(
        "error: a node takes {} at least, and memory_per_node is {}; take more nodes or a coarser spacing",
        in_words(least.fold(f64::INFINITY, f64::min)),
        in_words(machine.memory_per_node)
    )
}
