//! The box of interest in whole runs: the same bits on any ranks and through a restart, what is told of
//! what leaves it, and a box that a restart adds.

use std::path::Path;
use std::process::Command;

use crate::program::{WHIPPLE, assert_same, coarse_run, command, end, json, ranks};

const KEEP: &str = r#"domain.keep={ above = { z = "-0.3 mm" }, below = { y = "1.6 mm" } }"#;

fn keeping(number: usize, folder: &Path) -> Command {
    let mut command = coarse_run(number, folder);
    command.args(["--set", KEEP, "--poison", "--threads", "1"]);
    command
}

fn text(path: &Path) -> String {
    std::fs::read_to_string(path).unwrap()
}

/// The numbers of a column of a table.
fn column(table: &str, name: &str) -> Vec<f64> {
    let mut lines = table.lines().filter(|line| !line.starts_with('#'));
    let names = lines.next().unwrap();
    let at = names.split(',').position(|n| n == name).unwrap();
    let value = |line: &str| line.split(',').nth(at).unwrap().parse().unwrap();
    lines.map(value).collect()
}

#[test]
#[ignore = "slow"]
fn what_leaves_is_booked_with_the_same_bits_on_any_ranks_and_through_a_restart() {
    let place = tempfile::tempdir().unwrap();
    let at = |name: &str| place.path().join(name);
    let one = at("1");
    end(&mut keeping(1, &one)).with_code(0);
    for (number, axis) in [(2, "z"), (3, "x"), (5, "z")] {
        let other = at(&number.to_string());
        let axis = format!("domain.axis={axis}");
        end(keeping(number, &other).args(["--set", &axis])).with_code(0);
        assert_same(&one, &other);
    }
    let stopped = at("stopped");
    end(keeping(3, &stopped).args(["--until", "0.11us"])).with_code(0);
    let gone =
        |run: &Path| json(&run.join("summary.json"))["departed"]["plate"]["particles"].as_u64();
    assert!(0 < gone(&stopped).unwrap() && gone(&stopped) < gone(&one));
    end(ranks(2).arg("restart").arg(&stopped).arg("--poison")).with_code(0);
    assert_same(&one, &stopped);
    for run in [&one, &stopped] {
        let log = text(&run.join("log.txt"));
        for body in ["plate", "sphere"] {
            let told = log
                .matches(&format!("`{body}` begins to leave the box"))
                .count();
            assert_eq!(told, 1, "{body}: {log}");
        }
    }
    assert_booked(&one);
}

/// What tables, summary and snapshots say of a run with two bodies that leave its box.
fn assert_booked(run: &Path) {
    let summary = json(&run.join("summary.json"));
    let figure = |name: &str| summary[name].as_f64().unwrap();
    let of_body = |body: &str, what: &str| summary["departed"][body][what].as_f64().unwrap();
    let bodies = ["plate", "sphere"];
    let departed: f64 = bodies.map(|body| of_body(body, "particles")).iter().sum();
    // What leaves is of the whole model.
    let computed = departed * figure("computed_share");
    assert_eq!(figure("particles") + computed, 3056.0, "{summary:#}");
    assert!(bodies.iter().all(|body| {
        let [first, last] = ["first_time", "last_time"].map(|time| of_body(body, time));
        0.0 < first && first <= last && last <= 0.2e-6
    }));
    assert_eq!(summary["removed_particles"], 0);
    // Beside the defect of contact nothing is lost.
    let [error, defect] = [figure("energy_error_max"), figure("contact_defect")];
    assert!(error < 1.001 * defect && defect < 5e-3, "{summary:#}");
    for axis in ["x", "y", "z"] {
        for of in ["momentum_error", "angular_momentum_error"] {
            let error = summary[of][axis].as_f64().unwrap();
            assert!(error < 1e-12, "{of} {axis}: {error}");
        }
    }
    let history = text(&run.join("history.csv"));
    let [total, gone] = ["total_energy", "departed_energy"].map(|name| column(&history, name));
    let (first, last) = (
        total[0] + gone[0],
        total[total.len() - 1] + gone[gone.len() - 1],
    );
    assert!(gone[gone.len() - 1] > 0.3 * first);
    assert!((last / first - 1.0).abs() < 1.001 * defect);
    let mass = column(&history, "departed_mass");
    let booked = bodies.map(|body| of_body(body, "mass")).iter().sum::<f64>();
    assert!((mass[mass.len() - 1] / booked - 1.0).abs() < 1e-14);
    let table = text(&run.join("departed.csv"));
    assert!(
        table.lines().last().unwrap().contains(",sphere,"),
        "{table}"
    );
    let told = end(command(WHIPPLE).arg("info").arg(run))
        .with_code(0)
        .stdout;
    assert!(
        told.contains("departed energy") && told.contains("  plate "),
        "{told}"
    );
}

/// A run whose debris is of no use any more goes on without it.
#[test]
fn a_restart_may_add_a_box() {
    let place = tempfile::tempdir().unwrap();
    let run = place.path().join("run");
    end(coarse_run(1, &run).args(["--until", "0.1us"])).with_code(0);
    assert!(!run.join("departed.csv").exists());
    let before = text(&run.join("history.csv"));
    end(ranks(1).arg("restart").arg(&run).args(["--set", KEEP])).with_code(0);
    let history = text(&run.join("history.csv"));
    let (time, mass) = (column(&history, "time"), column(&history, "departed_mass"));
    let rows = column(&before, "time").len();
    assert!(mass[..rows].iter().all(|&mass| mass == 0.0) && mass[mass.len() - 1] > 0.0);
    assert_eq!(column(&before, "time"), time[..rows]);
    assert!(run.join("departed.csv").exists());
    // Once there is such a column it stays, with or without the box.
    let without = [
        "--set",
        "run.end_time=0.21us",
        "--set",
        r#"domain.keep.above={ z = "-1 m" }"#,
    ];
    end(ranks(1).arg("restart").arg(&run).args(without)).with_code(0);
    assert!(column(&text(&run.join("history.csv")), "time").len() > time.len());
}
