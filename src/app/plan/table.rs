//! Tables of a plan, for people and for programs.

use std::fmt::Write as _;

use serde_json::{Value, json};

use super::source::Source;
use crate::output_format;
use files::output::Sheet;
use files::plan::{Files, Machine, Row, Sharing};
use files::preflight::memory::in_words;

/// Columns of the printed table, with their widths.
const COLUMNS: [(&str, usize); 13] = [
    ("ranks", 7),
    ("levels", 7),
    ("owned", 10),
    ("largest", 10),
    ("halo", 10),
    ("/ box", 6),
    ("peers", 6),
    ("messages", 9),
    ("sent", 8),
    ("memory", 8),
    ("ms/step", 9),
    ("efficiency", 11),
    ("wall time", 11),
];

/// The head of the printed table.
pub fn head() -> String {
    let cells = COLUMNS
        .iter()
        .map(|&(name, width)| format!("{name:>width$}"));
    cells.collect()
}

/// A line of it: `is_own` for the levels that the case itself would take, and the steps of the run.
pub fn line(row: &Row, is_own: bool, steps: Option<f64>) -> String {
    let mark = if is_own { "*" } else { "" };
    let ratio = row.halo / row.halo_of_box;
    let cells = [
        row.ranks.to_string(),
        format!("{mark}{}", row.levels),
        format!("{:.0}", row.owned[0]),
        format!("{:.0}", row.owned[1]),
        format!("{:.0}", row.halo),
        if ratio.is_finite() {
            format!("{ratio:.2}")
        } else {
            String::new()
        },
        format!("{:.0}", row.peers),
        format!("{:.0}", row.messages),
        in_words(row.bytes).replace("bytes", "B"),
        in_words(row.memory),
        digits(1e3 * row.time.all),
        format!("{:.3}", row.efficiency),
        steps.map_or(String::new(), |steps| duration(steps * row.time.all)),
    ];
    let mut text = String::new();
    for (cell, (_, width)) in cells.iter().zip(COLUMNS) {
        let _ = write!(text, "{cell:>width$}");
    }
    text
}

/// The remark on a line whose ranks take more memory than their node has.
pub fn excess(row: &Row, machine: &Machine) -> String {
    let memory = row.memory_of_node();
    if memory <= machine.memory_per_node {
        return String::new();
    }
    format!("  a node has not the {} it takes", in_words(memory))
}

/// Three digits.
pub fn digits(value: f64) -> String {
    match value {
        v if v < 9.995 => format!("{v:.2}"),
        v if v < 99.95 => format!("{v:.1}"),
        v => format!("{v:.0}"),
    }
}

/// A time (s) for people.
pub fn duration(seconds: f64) -> String {
    match seconds {
        s if s < 9.95 => format!("{s:.1} s"),
        s if s < 99.5 => format!("{s:.0} s"),
        s if s < 99.5 * 60.0 => format!("{:.0} min", s / 60.0),
        s if s < 99.5 * 3600.0 => format!("{:.1} h", s / 3600.0),
        s => format!("{:.1} days", s / 86400.0),
    }
}

/// The whole report, in SI units.
pub fn document(source: &Source, machine: &Machine, rows: &[Row], files: &Files) -> Value {
    let steps = source.outlook.steps;
    let mut document = output_format::table(&sheet(rows, steps));
    document["title"] = source.case.title.as_str().into();
    document["dimension"] = source.case.dimension.into();
    document["particles"] = source.particles.positions.len().into();
    document["begins_at_s"] = source.time.into();
    document["steps"] = steps.into();
    document["machine"] = machine.name.as_str().into();
    document["files"] = json!({
        "snapshots": files.snapshots,
        "snapshot_bytes": files.snapshot,
        "checkpoints": files.checkpoints,
        "checkpoint_bytes": files.checkpoint,
        "kept_checkpoints": files.kept,
        "table_bytes": files.tables,
        "disk_bytes": files.disk(),
        "written_bytes": files.written(),
        "writing_s": files.written() / machine.disk_bandwidth,
    });
    document
}

/// All rows in SI units.
pub fn sheet(rows: &[Row], steps: Option<f64>) -> Sheet {
    let columns = [
        ("ranks", ""),
        ("levels", ""),
        ("threads", ""),
        ("ranks_per_node", ""),
        ("owned_mean", ""),
        ("owned_most", ""),
        ("halo_most", ""),
        ("halo_of_box", ""),
        ("peers_most", ""),
        ("messages_most", ""),
        ("bytes_most", ""),
        ("imbalance", ""),
        ("memory_most", "bytes"),
        ("computing", "s"),
        ("step_time", "s"),
        ("efficiency", ""),
        ("wall_time", "s"),
    ];
    let cells = |row: &Row| -> Vec<String> {
        let Sharing {
            threads,
            ranks_per_node,
        } = row.sharing;
        let counts = [row.ranks, row.levels, threads, ranks_per_node];
        let mut cells = counts.map(|count| count.to_string()).to_vec();
        let wall = steps.map_or(f64::NAN, |steps| steps * row.time.all);
        let numbers = [
            row.owned[0],
            row.owned[1],
            row.halo,
            row.halo_of_box,
            row.peers,
            row.messages,
            row.bytes,
            row.imbalance(),
            row.memory,
            row.time.computing,
            row.time.all,
            row.efficiency,
            wall,
        ];
        cells.extend(numbers.map(|number| format!("{number:?}")));
        cells
    };
    Sheet {
        computed_share: None,
        names: columns.map(|(name, _)| name.to_owned()).to_vec(),
        units: columns.map(|(_, unit)| unit.to_owned()).to_vec(),
        rows: rows.iter().map(cells).enumerate().collect(),
    }
}
