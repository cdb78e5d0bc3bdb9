//! `whipple bench`: that it measures what it says. No test looks at how fast anything is.

use std::path::Path;
use std::process::Command;

use crate::program::{WHIPPLE, command, end, json, ranks};
use serde_json::Value;

fn bench(mut command: Command, file: &Path, options: &[&str]) -> (String, Value) {
    command.arg("bench").args(["--repeat", "1", "--steps", "3"]);
    let ended = end(command.args(options).arg("--json").arg(file)).with_code(0);
    (ended.stdout, json(file))
}

/// Case, ranks and threads of each row.
fn configurations(report: &Value) -> Vec<(&str, u64, u64)> {
    let number = |row: &Value, key: &str| row[key].as_u64().unwrap();
    let rows = report["rows"].as_array().unwrap().iter();
    rows.map(|row| {
        (
            row["case"].as_str().unwrap(),
            number(row, "ranks"),
            number(row, "threads"),
        )
    })
    .collect()
}

#[test]
#[ignore = "slow"]
fn small_cases_are_measured_on_threads_and_ranks() {
    let folder = tempfile::tempdir().unwrap();
    let (said, report) = bench(
        command(WHIPPLE),
        &folder.path().join("bench.json"),
        &["--quick"],
    );

    // Configurations with more cores than there are have no meaning, and are skipped.
    let wide = std::thread::available_parallelism().unwrap().get() >= 2;
    let each = if wide {
        &[(1, 1), (1, 2), (2, 1)][..]
    } else {
        &[(1, 1)]
    };
    let cases = ["block-10k", "quarter-3k"].into_iter();
    let expected: Vec<_> = cases
        .flat_map(|case| {
            each.iter()
                .map(move |&(ranks, threads)| (case, ranks, threads))
        })
        .collect();
    assert_eq!(configurations(&report), expected, "{said}");
    assert_eq!(report["skipped"].as_array().unwrap().len(), 3 - each.len());
    assert_eq!(report["version"], env!("CARGO_PKG_VERSION"));
    assert_ne!(report["machine"]["instructions"], "");

    for row in report["rows"].as_array().unwrap() {
        for figure in [
            "million_updates_per_second_per_core",
            "efficiency",
            "bytes_per_particle",
        ] {
            assert!(row[figure].as_f64().unwrap() > 0.0, "{figure} of {row:#}");
        }
        let phases = row["nanoseconds_by_phase"].as_object().unwrap();
        for phase in [
            "neighbours",
            "velocity_gradient_and_material",
            "momentum_and_energy",
        ] {
            assert!(phases[phase].as_f64().unwrap() > 0.0, "{phase} of {row:#}");
        }
        let sent = row["messages_per_rank_and_step"].as_f64().unwrap() > 0.0;
        assert_eq!(sent, row["ranks"] != 1, "{row:#}");
        // One row of the table, and one column of the phases.
        let name = row["case"].as_str().unwrap();
        assert!(
            said.lines().filter(|line| line.starts_with(name)).count() > each.len(),
            "{said}"
        );
    }
    assert_that_neighbours_do_not_depend_on_ranks(&report);
}

/// The configurations of a case step through the same states.
#[track_caller]
fn assert_that_neighbours_do_not_depend_on_ranks(report: &Value) {
    let rows = report["rows"].as_array().unwrap();
    for row in rows {
        let first = rows
            .iter()
            .find(|first| first["case"] == row["case"])
            .unwrap();
        assert_eq!(row["neighbours"], first["neighbours"], "{row:#}");
        assert_eq!(row["particles"], first["particles"], "{row:#}");
        assert!(
            (40.0..90.0).contains(&row["neighbours"].as_f64().unwrap()),
            "{row:#}"
        );
    }
}

#[test]
fn a_launch_of_its_own_measures_itself() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("bench.json");
    let options = ["--case", "quarter-3k", "--threads", "2"];
    let (_, report) = bench(ranks(3), &file, &options);
    assert_eq!(configurations(&report), [("quarter-3k", 3, 2)]);
    assert!(report["rows"][0]["efficiency"].is_null());

    let (_, report) = bench(
        command(WHIPPLE),
        &file,
        &["--case", "block-10k", "--threads", "1"],
    );
    assert_eq!(configurations(&report), [("block-10k", 1, 1)]);
}

#[test]
#[ignore = "slow"]
fn messages_are_measured_between_ranks() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("messages.json");
    let measure = |mut command: Command, code| {
        command.args(["bench", "--messages", "--json"]).arg(&file);
        end(&mut command).with_code(code)
    };
    let ended = measure(ranks(2), 0);
    let told = json(&file);
    for key in ["latency", "bandwidth", "agreement_time"] {
        assert!(told[key].as_f64().unwrap() > 0.0, "{told}");
    }
    assert_eq!(told["between_nodes"], false);
    // The lines of a machine file.
    let lines: toml::Table = ended.stdout.parse().unwrap();
    let keys: Vec<&String> = lines.keys().collect();
    assert_eq!(keys, ["node_latency", "node_bandwidth", "agreement_time"]);
    let ended = measure(command(WHIPPLE), 1);
    assert!(ended.stderr.contains("pairs of ranks"), "{}", ended.stderr);
}

#[test]
fn mistakes_are_said() {
    let mistake = |options: &[&str], expected: &str| {
        let ended = end(command(WHIPPLE).arg("bench").args(options)).with_code(2);
        assert!(ended.stderr.contains(expected), "{}", ended.stderr);
    };
    mistake(&["--case", "block-2k"], "invalid value 'block-2k'");
    mistake(&["--repeat", "0"], "0 is not in 1..");
    mistake(
        &["--quick", "--json", "/no/such/folder/file"],
        "cannot write /no/such/folder/file",
    );
}

#[test]
fn without_mpirun_there_are_rows_of_one_rank() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("bench.json");
    let mut alone = command(WHIPPLE);
    alone.env("PATH", folder.path());
    let (_, report) = bench(alone, &file, &["--case", "block-10k"]);
    assert!(
        configurations(&report)
            .iter()
            .all(|&(_, ranks, _)| ranks == 1)
    );
    let skipped = report["skipped"].to_string();
    assert!(
        skipped.contains("mpirun does not start") || skipped.contains("cores"),
        "{skipped}"
    );
}
