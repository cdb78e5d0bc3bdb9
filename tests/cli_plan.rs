//! `whipple plan`: its table, its files, what it refuses.

mod cli_support;

use std::fs;
use std::path::Path;
use std::process::Command;

use cli_support::{WHIPPLE, command, end, quarter_impact};
use tiny_skia::Pixmap;
use whipple::plan::{CONSTANTS, Machine};

const COARSE: [&str; 2] = ["--set", "spacing=0.05mm"];

fn plan(path: &str, more: &[&str]) -> Command {
    let mut plan = command(WHIPPLE);
    plan.args(["plan", path]).args(more);
    plan
}

/// The cells of the lines of the table that are of so many ranks.
fn rows(said: &str, ranks: &str) -> Vec<Vec<String>> {
    let cells = said
        .lines()
        .map(|line| line.split_whitespace().map(str::to_owned));
    let cells = cells.map(Iterator::collect::<Vec<String>>);
    cells
        .filter(|row| {
            row.len() > 10 && row[0] == ranks && row[1].trim_start_matches('*').len() == 1
        })
        .collect()
}

#[test]
fn levels_are_compared_for_each_number_of_ranks() {
    let folder = tempfile::tempdir().unwrap();
    let [csv, chart] = ["plan.csv", "plan.png"].map(|name| folder.path().join(name));
    let files = [
        "--csv",
        csv.to_str().unwrap(),
        "--chart",
        chart.to_str().unwrap(),
    ];
    let more = [&COARSE[..], &["--ranks", "1,8,64", "--doubled"], &files].concat();
    let said = end(&mut plan(&quarter_impact(), &more)).with_code(0).stdout;
    assert_eq!(rows(&said, "1").len(), 1, "{said}");
    for ranks in ["8", "64"] {
        let rows = rows(&said, ranks);
        let levels: Vec<&str> = rows
            .iter()
            .map(|row| row[1].trim_start_matches('*'))
            .collect();
        assert_eq!(levels, ["1", "2", "3"], "{said}");
        // Those of the case itself.
        assert_eq!(
            rows.iter().filter(|row| row[1].starts_with('*')).count(),
            1,
            "{said}"
        );
    }
    for constant in &CONSTANTS {
        assert!(said.contains(&format!("2 x {} ", constant.key)), "{said}");
    }
    let table = fs::read_to_string(csv).unwrap();
    // Names, units, and seven rows.
    assert_eq!(table.lines().count(), 9, "{table}");
    assert_eq!(Pixmap::load_png(chart).unwrap().width(), 1200);
}

/// A run, a snapshot and a checkpoint are planned from the particles that they hold.
#[test]
fn later_states_are_planned_too() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("run");
    let mut run = command(WHIPPLE);
    run.args(["run", &quarter_impact(), "--out", out.to_str().unwrap()]);
    run.args(COARSE).args(["--set", "run.max_steps=3"]);
    end(&mut run).with_code(0);
    let start = end(&mut plan(&quarter_impact(), &COARSE))
        .with_code(0)
        .stdout;
    let count = start.split(" particles").next().unwrap();
    let count = count.split_whitespace().last().unwrap();
    let last = |folder: &str| -> String {
        let entries = fs::read_dir(out.join(folder)).unwrap();
        let paths = entries.map(|entry| entry.unwrap().path());
        let named = paths.filter(|path| path.to_string_lossy().contains("step-00000003"));
        named.last().unwrap().to_string_lossy().into_owned()
    };
    let places = [
        out.to_string_lossy().into_owned(),
        last("snapshots"),
        last("checkpoints"),
    ];
    for place in places {
        let said = end(&mut plan(&place, &["--ranks", "4"]))
            .with_code(0)
            .stdout;
        assert!(said.contains(&format!("{count} particles at ")), "{said}");
        assert_eq!(rows(&said, "4").len(), 3, "{said}");
    }
}

fn refusal(path: &str, more: &[&str]) -> String {
    end(&mut plan(path, more)).with_code(2).stderr
}

#[test]
fn what_is_no_machine_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("machine.toml");
    let path = file.to_str().unwrap();
    let ranks = [&COARSE[..], &["--ranks", "2", "--machine", path]].concat();
    for (bytes, what) in [
        (&b"latency = -1.0"[..], "latency is -1"),
        (b"bandwidth = nan", "bandwidth is NaN"),
        (b"overlap = 2.0", "overlap is 2"),
        (b"cores_per_node = 0.5", "cores_per_node is 0.5"),
        (b"latency = \"fast\"", "latency"),
        (b"speed = 1.0", "speed"),
        (b"latency = ", "latency"),
        (b"\xff\xfe", "no text"),
    ] {
        fs::write(&file, bytes).unwrap();
        let said = refusal(&quarter_impact(), &ranks);
        assert!(said.contains(what) && said.contains(path), "{said}");
    }
    fs::remove_file(&file).unwrap();
    assert!(refusal(&quarter_impact(), &ranks).contains(path));
    assert!(refusal("/no/such/case", &[]).contains("/no/such/case"));
    assert!(refusal(Path::new(WHIPPLE).to_str().unwrap(), &[]).contains("error"));
    assert!(refusal(&quarter_impact(), &["--chart", "plan.svg"]).contains("svg"));
}

#[test]
fn a_machine_is_read_as_it_was_written() {
    let machine = Machine {
        name: "ours \"here\"".to_owned(),
        latency: 1.25e-6,
        ..Machine::default()
    };
    assert_eq!(Machine::parse(&machine.text()).unwrap(), machine);
    assert_eq!(Machine::parse("").unwrap(), Machine::default());
    for constant in &CONSTANTS {
        let mut doubled = machine.doubled(constant);
        let now = *constant.of(&mut doubled);
        let mut before = machine.clone();
        assert_eq!(now.to_bits(), (2.0 * *constant.of(&mut before)).to_bits());
    }
}

/// What a run will take is told before it: time and disk.
#[test]
fn a_check_tells_time_and_disk() {
    let mut check = command(WHIPPLE);
    check
        .args(["check", &quarter_impact(), "--ranks", "8"])
        .args(COARSE);
    let said = end(&mut check).with_code(0).stdout;
    assert!(said.contains(" on 8 ranks of one core of "), "{said}");
    assert!(said.contains(" on the disk at the end"), "{said}");
}
