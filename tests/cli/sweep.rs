//! Sweeps: tables that a kill does not change, limits, convergence, and what is refused.

use std::path::Path;
use std::process::Command;
use std::time::Duration;

use crate::program::{WHIPPLE, command, end, quarter_impact, start};

/// Small and short.
const SMALL: [&str; 6] = [
    "--set",
    "spacing=0.1mm",
    "--set",
    "run.end_time=0.05us",
    "--set",
    "output.checkpoint_every_steps=5",
];

fn sweep(out: &Path, more: &[&str]) -> Command {
    let mut command = command(WHIPPLE);
    command.args(["sweep", &quarter_impact()]).args(SMALL);
    command.arg("--out").arg(out).args(more);
    command
}

fn text(path: &Path) -> String {
    std::fs::read_to_string(path).unwrap()
}

/// Twelve points, killed three times on the way: the same table as of a sweep in peace, and no run that
/// had ended begins again.
#[test]
#[ignore = "slow"]
fn a_killed_sweep_goes_on_and_has_the_same_table() {
    let place = tempfile::tempdir().unwrap();
    let at = |name: &str| place.path().join(name);
    let more = [
        "--vary",
        "body.sphere.velocity=3..9/4 km/s",
        "--vary",
        "contact.mode=overlap,potential,none",
        "--answers",
        "history.kinetic_energy,summary.steps",
        "--jobs",
        "2",
        "--threads",
        "1",
    ];
    let ended = end(&mut sweep(&at("peace"), &more)).with_code(0);
    assert!(ended.stdout.contains("12 points finished"), "{ended:#?}");
    let table = text(&at("peace").join("sweep.csv"));
    assert_eq!(table.lines().count(), 14, "{table}");
    assert!(
        table.starts_with("# units: m/s,-,-,-,J,-\nvelocity,mode,run,state,"),
        "{table}"
    );
    assert!(at("peace").join("sweep.png").is_file());

    let killed = at("killed");
    let finished = || {
        let table = std::fs::read_to_string(killed.join("sweep.csv")).unwrap_or_default();
        table.matches(",finished,").count()
    };
    for enough in [1, 4, 7] {
        let running = start(&mut sweep(&killed, &more));
        running.until("points", || (finished() >= enough).then_some(()));
        std::thread::sleep(Duration::from_millis(30));
        // SAFETY: a signal to a process that this test has started and not waited for.
        unsafe { libc::kill(running.id().cast_signed(), libc::SIGKILL) };
        assert_eq!(running.end().code, None);
    }
    let before = finished();
    let ended = end(command(WHIPPLE).arg("sweep").arg(&killed)).with_code(0);
    assert!(
        before >= 7 && ended.stdout.matches(": runs").count() <= 12 - before,
        "{ended:#?}"
    );
    assert_eq!(text(&killed.join("sweep.csv")), table);

    // With nothing left to do it runs nothing.
    let ended = end(&mut sweep(&killed, &more)).with_code(0);
    assert!(!ended.stdout.contains(": runs"), "{ended:#?}");
    // Another case would mix with its runs.
    let other = [&more[..], &["--set", "sph.alpha=0.5"]].concat();
    let ended = end(&mut sweep(&killed, &other)).with_code(2);
    assert!(ended.stderr.contains("another case"), "{ended:#?}");
}

#[test]
fn a_bisection_finds_a_limit_for_each_combination() {
    let place = tempfile::tempdir().unwrap();
    let out = place.path().join("out");
    // The first kinetic energy grows with the square of the speed: what is left after a few steps, too.
    let more = [
        "--vary",
        "sph.alpha=1, 2",
        "--vary",
        "body.sphere.velocity=2..6 km/s",
        "--bisect",
        "history.kinetic_energy>2 J",
        "--within",
        "0.25",
        "--set",
        "run.end_time=0.01us",
    ];
    let ended = end(&mut sweep(&out, &more)).with_code(0);
    assert!(ended.stdout.contains("the condition holds"), "{ended:#?}");
    let limits = text(&out.join("limits.csv"));
    assert!(
        limits.starts_with(
            "# units: -,m/s,m/s,m/s,-\nalpha,velocity_limit,velocity_without,velocity_with,state\n"
        ),
        "{limits}"
    );
    assert_eq!(
        limits.matches(",3500.0,3000.0,4000.0,found").count(),
        2,
        "{limits}"
    );
    assert!(out.join("limits.png").is_file());
}

#[test]
fn spacings_converge() {
    let place = tempfile::tempdir().unwrap();
    let out = place.path().join("out");
    let mut command = command(WHIPPLE);
    command.args([
        "converge",
        &quarter_impact(),
        "--spacings",
        "0.12, 0.1, 0.08 mm",
    ]);
    command.args([
        "--set",
        "run.end_time=0.02us",
        "--answers",
        "history.kinetic_energy",
    ]);
    let ended = end(command.arg("--out").arg(&out)).with_code(0);
    let line = |part: &str| ended.stdout.lines().find(|line| line.contains(part));
    assert!(line("answer").unwrap().contains("order"), "{ended:#?}");
    assert!(line("history.kinetic_energy").is_some(), "{ended:#?}");
    let table = text(&out.join("converge.csv"));
    let names = "\nanswer,unit,0.00012,0.0001,8e-5,order,limit,uncertainty,basis,remarks\n";
    assert!(table.contains(names), "{table}");
}

/// A body with a spacing of its own gets finer with the case.
#[test]
fn spacings_of_bodies_converge_too() {
    let place = tempfile::tempdir().unwrap();
    let out = place.path().join("out");
    let mut command = command(WHIPPLE);
    command.args(["converge", &quarter_impact(), "--spacings", "0.2, 0.1 mm"]);
    let graded = "body.plate.spacing={ inner = \"0.05 mm\", outer = \"0.1 mm\", at = [0, 0, 0] }";
    command.args(["--set", "run.end_time=0.005us", "--set", "spacing=0.1mm"]);
    command.args(["--set", "body.plate.lattice=glass"]);
    command.args(["--set", graded, "--answers", "history.kinetic_energy"]);
    end(command.arg("--out").arg(&out)).with_code(0);
    let table = text(&out.join("converge.csv"));
    let row = table.lines().last().unwrap();
    assert!(row.contains(",assumed,"), "{table}");
    for (name, inner) in [("0.2mm", "0.0001 m"), ("0.1mm", "5e-5 m")] {
        let runs = std::fs::read_dir(out.join("points")).unwrap();
        let mut runs = runs.map(|entry| entry.unwrap().path());
        let run = runs.find(|run| run.is_dir() && run.to_string_lossy().contains(name));
        let case = text(&run.unwrap().join("case.toml"));
        assert!(case.contains(inner), "{case}");
    }
}

#[test]
fn mistakes_are_said_before_anything_runs() {
    let place = tempfile::tempdir().unwrap();
    let out = place.path().join("out");
    for (more, part) in [
        (&[][..], "nothing varies"),
        (&["--vary", "spacing"], "no `=`"),
        (&["--vary", "spacing=1..x"], "no number"),
        (&["--vary", "spacing=0.1 mm, 0.2 parsec"], "parsec"),
        (&["--vary", "body.sphere.speed=1, 2"], "speed"),
        (&["--vary", "body.plate.velocity=3 km/s"], "velocity"),
        (
            &["--vary", "sph.alpha=1,2", "--bisect", "a>1"],
            "needs a range",
        ),
        (
            &["--vary", "sph.alpha=1..2", "--bisect", "what"],
            "no condition",
        ),
        (&["--vary", "sph.alpha=1..2", "--within", "2"], "--within"),
        (&["--vary", "sph.alpha=1..2", "--point", "9"], "no point 9"),
    ] {
        let ended = end(&mut sweep(&out, more));
        assert_eq!(ended.code, Some(2), "{more:?}: {ended:#?}");
        assert!(ended.stderr.contains(part), "{more:?}: {ended:#?}");
        assert!(!out.join("points").exists());
    }
}

/// What a scheduler's array does: each task a point, and then the table.
#[test]
fn an_array_runs_points_one_by_one() {
    let place = tempfile::tempdir().unwrap();
    let out = place.path().join("out");
    let more = [
        "--vary",
        "sph.alpha=1,2",
        "--answers",
        "summary.steps",
        "--slurm",
    ];
    end(&mut sweep(&out, &more)).with_code(0);
    let script = text(&out.join("sweep.sbatch"));
    assert!(script.contains("--array=1-2\n"), "{script}");
    for task in ["2", "1"] {
        let mut bash = command("bash");
        bash.arg(out.join("sweep.sbatch"))
            .env("SLURM_ARRAY_TASK_ID", task);
        end(&mut bash).with_code(0);
    }
    let ended = end(command(WHIPPLE).arg("sweep").arg(&out)).with_code(0);
    assert!(!ended.stdout.contains(": runs"), "{ended:#?}");
    assert_eq!(
        text(&out.join("sweep.csv")).matches(",finished,").count(),
        2
    );
}

/// What a stranger may have put into a folder of a sweep.
#[test]
fn damaged_folders_are_refused() {
    let place = tempfile::tempdir().unwrap();
    let out = place.path();
    for content in ["", "{", "[]", "{\"case\": 1}", "\u{0}"] {
        std::fs::write(out.join("sweep.json"), content).unwrap();
        let ended = end(command(WHIPPLE).arg("sweep").arg(out));
        assert_eq!(ended.code, Some(1), "{content}: {ended:#?}");
        assert!(ended.stderr.starts_with("error: "), "{ended:#?}");
    }
}

/// Seeds and a constant are scattered: means and bands over them for each speed, what each does, and a chart.
#[test]
fn scattered_keys_have_bands() {
    let place = tempfile::tempdir().unwrap();
    let out = place.path().join("sweep");
    let more = [
        "--vary",
        "body.sphere.velocity=5, 7 km/s",
        "--scatter",
        "seed=1, 2",
        "--scatter",
        "sph.alpha=0.8, 1.2",
        "--set",
        "body.plate.lattice=glass",
        "--set",
        "body.sphere.lattice=glass",
        "--answers",
        "history.kinetic_energy",
        "--jobs",
        "2",
        "--threads",
        "1",
    ];
    let ended = end(&mut sweep(&out, &more)).with_code(0);
    assert!(ended.stdout.contains("8 points finished"), "{ended:#?}");
    let rows = |name: &str| -> Vec<Vec<String>> {
        let text = text(&out.join(name));
        let lines = text.lines().skip(1);
        lines
            .map(|line| line.split(',').map(str::to_owned).collect())
            .collect()
    };
    let (points, bands, effects) = (rows("sweep.csv"), rows("bands.csv"), rows("effects.csv"));
    assert_eq!(points.len(), 9);
    let of_speed: Vec<f64> = (points.iter().skip(1))
        .filter(|row| row[0] == "5000.0")
        .map(|row| row[5].parse().unwrap())
        .collect();
    assert!(of_speed[0] != of_speed[1], "seeds fill differently");
    let mean = of_speed.iter().sum::<f64>() / 4.0;
    assert_eq!(bands.len(), 3);
    assert_eq!(
        bands[1][..4],
        ["5000.0", "history.kinetic_energy", "J", "4"]
    );
    assert!((bands[1][4].parse::<f64>().unwrap() / mean - 1.0).abs() < 1e-12);
    assert_eq!(effects.len(), 5);
    assert_eq!(effects[1][3], "seed");
    assert!(out.join("bands.png").is_file() && out.join("effects.png").is_file());
    end(command(WHIPPLE).arg("report").arg(&out)).with_code(0);
    let page = text(&out.join("report.html"));
    let pictures = page.matches("data:image/svg+xml").count();
    assert_eq!(pictures, 2, "bands and effects");
    for part in [
        "<h2>Bands</h2>",
        "<h2>What matters</h2>",
        "seed=1, 2",
        "data:image/svg+xml",
    ] {
        assert!(page.contains(part), "{part}");
    }
}

/// What the library states for a constant is scattered; where it states nothing, the message names the key.
#[test]
fn stated_ranges_are_scattered() {
    let place = tempfile::tempdir().unwrap();
    let out = place.path().join("sweep");
    let key = "material.aluminium.failure.spall.pressure";
    let scatter = format!("{key}=stated");
    let more = ["--scatter", &scatter, "--answers", "summary.steps"];
    let refused = end(&mut sweep(&out, &more)).with_code(2);
    let told = "the library states no range of `failure.spall.pressure` for aluminium-2024;";
    assert!(
        refused.stderr.contains(&scatter) && refused.stderr.contains(told),
        "{refused:#?}"
    );
    let other = ["--scatter", "material.steel.density=stated"];
    let refused = end(&mut sweep(&out, &other)).with_code(2);
    assert!(
        refused.stderr.contains("no `material.steel.library`"),
        "{refused:#?}"
    );
    assert!(!out.exists());

    let ductile = [
        "--set",
        "material.aluminium.library=aluminium-2024-ductile",
        "--slurm",
    ];
    end(&mut sweep(&out, &[&more[..], &ductile].concat())).with_code(0);
    let kept = text(&out.join("sweep.json"));
    assert!(
        kept.contains(&format!("{key}=-1.7 GPa, -1.4 GPa, -1.1 GPa")),
        "{kept}"
    );
    assert!(text(&out.join("sweep.sbatch")).contains("--array=1-3\n"));
}
