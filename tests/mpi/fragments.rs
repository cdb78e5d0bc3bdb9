//! Fragments of a run: the same bytes on any ranks and through a restart, and from its snapshots.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::Command;

use files::output::binary_table::BinaryTable;

use crate::program::WHIPPLE;

/// An impact that comes apart, in a quarter of a model.
const CASE: &[&str] = &[
    "inputs/quarter-impact",
    "--set",
    "spacing=0.06mm",
    "--set",
    "fragments={ every = \"0.05 us\", min_particles = 1 }",
    "--set",
    "output.snapshot_every=0.1us",
    "--set",
    "output.checkpoint_every=0.04us",
];

fn whipple(ranks: usize, arguments: &[&str]) -> (i32, String) {
    let script = "source jobs/env.sh; exec mpirun -n \"$0\" \"$@\"";
    let output = Command::new("bash")
        .current_dir(crate::project::root())
        .args(["-c", script, &ranks.to_string(), WHIPPLE])
        .args(arguments)
        .output()
        .expect("bash runs");
    let text = [output.stdout, output.stderr].concat();
    let text = String::from_utf8_lossy(&text).into_owned();
    (output.status.code().unwrap_or(-1), text)
}

fn alone(arguments: &[&str]) -> (i32, String) {
    let output = Command::new(WHIPPLE)
        .args(arguments)
        .output()
        .expect("it runs");
    let text = [output.stdout, output.stderr].concat();
    let text = String::from_utf8_lossy(&text).into_owned();
    (output.status.code().unwrap_or(-1), text)
}

/// All tables of fragments of a run, by name; those of HDF5 as text.
fn tables(run: &Path) -> BTreeMap<String, String> {
    let mut files: Vec<_> = fs::read_dir(run.join("fragments"))
        .expect("there are tables")
        .map(|entry| entry.unwrap().path())
        .collect();
    files.push(run.join("fragments.csv"));
    let read = |path: std::path::PathBuf| {
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        if path.extension().is_some_and(|ending| ending == "h5") {
            let table = BinaryTable::open(&path).unwrap();
            let sheet = table.sheet(0..table.rows(), None).unwrap();
            return (name, String::from_utf8(sheet.text()).unwrap());
        }
        (name, fs::read_to_string(path).unwrap())
    };
    files.into_iter().map(read).collect()
}

fn column(table: &str, name: &str) -> Vec<f64> {
    let mut lines = table.lines().filter(|line| !line.starts_with('#'));
    let at = lines
        .next()
        .unwrap()
        .split(',')
        .position(|n| n == name)
        .expect("a column");
    lines
        .map(|line| line.split(',').nth(at).unwrap().parse().unwrap())
        .collect()
}

#[test]
#[ignore = "slow"]
fn tables_are_the_same_on_any_ranks_through_a_restart_and_from_snapshots() {
    let place = tempfile::tempdir().unwrap();
    let at = |name: &str| place.path().join(name);
    let run = |ranks: usize, threads: &str, more: &[&str], name: &str| {
        let out = at(name);
        let mut arguments = vec!["run"];
        arguments.extend(CASE);
        arguments.extend(more);
        arguments.extend([
            "--threads",
            threads,
            "--poison",
            "--out",
            out.to_str().unwrap(),
        ]);
        let (code, text) = whipple(ranks, &arguments);
        assert_eq!(code, 0, "{text}");
        out
    };
    let one = run(1, "2", &[], "one");
    let wanted = tables(&one);
    assert!(wanted.len() >= 5, "{:?}", wanted.keys());
    for (ranks, axis) in [(2, "x"), (3, "z"), (5, "x")] {
        let other = run(
            ranks,
            "1",
            &["--set", &format!("domain.axis={axis}")],
            &format!("r{ranks}"),
        );
        assert!(tables(&other) == wanted, "{ranks} ranks along {axis}");
        let (code, text) = alone(&["compare", one.to_str().unwrap(), other.to_str().unwrap()]);
        assert_eq!(code, 0, "{text}");
    }
    let stopped = run(2, "1", &["--until", "0.12us"], "stopped");
    let path = stopped.to_str().unwrap();
    let (code, text) = whipple(3, &["restart", path, "--threads", "1", "--poison"]);
    assert_eq!(code, 0, "{text}");
    assert!(tables(&stopped) == wanted, "a restart");

    // The mass of the model, to round-off, and more than one fragment at the end.
    let history = &wanted["fragments.csv"];
    let parts = ["fragment_mass", "dust_mass", "failed_mass"].map(|name| column(history, name));
    for (k, total) in column(history, "total_mass").into_iter().enumerate() {
        let sum: f64 = parts.iter().map(|part| part[k]).sum();
        assert!((sum - total).abs() < 1e-13 * total, "{sum} of {total}");
    }

    // The same bytes from the snapshots.
    let mut compared = 0;
    for entry in fs::read_dir(one.join("snapshots")).unwrap() {
        let path = entry.unwrap().path();
        let stem = path.file_stem().unwrap().to_string_lossy().into_owned();
        let Some(table) = wanted.get(&format!("{stem}.csv")) else {
            continue;
        };
        let csv = at("after.csv");
        let (code, text) = alone(&[
            "fragments",
            path.to_str().unwrap(),
            "--csv",
            csv.to_str().unwrap(),
        ]);
        assert_eq!(code, 0, "{text}");
        assert!(fs::read_to_string(&csv).unwrap() == *table, "{stem}");
        assert!(wanted[&format!("{stem}.h5")] == *table, "{stem}");
        compared += 1;
    }
    assert!(compared >= 3);
    let folder = one.to_str().unwrap();
    let (code, text) = alone(&["fragments", folder, "--at", "0.1us", "--include", "all"]);
    assert!(code == 0 && text.contains("in fragments"), "{text}");
    let (code, text) = alone(&["plot", folder, "--fragments", "--all"]);
    assert!(code == 0 && text.contains("fragments-size.png"), "{text}");
}

/// What cannot be told is said in one line.
#[test]
fn wrong_files_and_options_are_refused() {
    let place = tempfile::tempdir().unwrap();
    let out = place.path().join("run");
    let out = out.to_str().unwrap();
    let mut arguments = vec!["run"];
    arguments.extend([
        "inputs/quarter-impact",
        "--set",
        "spacing=0.1mm",
        "--out",
        out,
    ]);
    arguments.extend([
        "--set",
        "run.max_steps=2",
        "--set",
        "output.fields=[\"fragment\"]",
    ]);
    let (code, text) = whipple(2, &arguments);
    assert_eq!(code, 0, "{text}");
    let refused = |arguments: &[&str], why: &str| {
        let (code, text) = alone(arguments);
        assert!(code == 2 && text.contains(why), "{code} {text}");
    };
    refused(&["fragments", out], "does not tell the mass");
    refused(
        &["fragments", out, "--link", "9"],
        "--link must be between 1 and 4",
    );
    refused(&["fragments", "nowhere"], "nowhere");
    refused(&["fragments", out, "--snapshot", "7"], "no snapshot 7");
    refused(&["plot", out, "--fragments"], "fragments.csv");
    let (code, text) = alone(&["info", out]);
    assert_eq!(code, 0, "{text}");
}
