//! Parts of runs that are computed again: the same bits, more output, the step of a condition, the first difference.

use std::path::Path;

use crate::program::{WHIPPLE, coarse_run, command, end, ranks, status};

fn names(folder: &Path) -> usize {
    std::fs::read_dir(folder).unwrap().count()
}

/// Any ranks compute a part of a run with its bits, and more snapshots and fields.
#[test]
fn a_part_is_the_same_on_any_ranks() {
    let place = tempfile::tempdir().unwrap();
    let run = place.path().join("run");
    end(&mut coarse_run(2, &run)).with_code(0);
    for (number, out) in [(1, "one"), (3, "three")] {
        let out = place.path().join(out);
        let mut again = ranks(number);
        again.arg("replay").arg(&run).arg("--out").arg(&out);
        again.args([
            "--from",
            "0.1us",
            "--to",
            "0.12us",
            "--snapshot-every",
            "2ns",
        ]);
        again.args(["--field", "von_mises_stress", "--rows-every", "1"]);
        let ended = end(&mut again).with_code(0);
        assert!(ended.stdout.contains("to the last bit"), "{ended:#?}");
        assert!(names(&out.join("snapshots")) > 5, "{ended:#?}");
        assert!(status(&out).1 < status(&run).1);
    }
    let one = std::fs::read(place.path().join("one/history.csv")).unwrap();
    let three = std::fs::read(place.path().join("three/history.csv")).unwrap();
    assert_eq!(one, three);

    // From its start, where no checkpoint is old enough; of a run that is not this one.
    let history = run.join("history.csv");
    let text = std::fs::read_to_string(&history).unwrap();
    let line = text.lines().nth(5).unwrap();
    let mut cells: Vec<String> = line.split(',').map(str::to_owned).collect();
    cells[4] = format!("{}1", cells[4]);
    std::fs::write(&history, text.replace(line, &cells.join(","))).unwrap();
    let mut again = ranks(1);
    again
        .arg("replay")
        .arg(&run)
        .args(["--to", "20ns", "--out"]);
    let ended = end(again.arg(place.path().join("first"))).with_code(1);
    assert!(
        ended.stdout.contains("kinetic_energy: 1 rows differ"),
        "{ended:#?}"
    );
    assert!(
        ended.stdout.contains("this is not the run in"),
        "{ended:#?}"
    );
}

/// The first step at which a condition holds is that of a run with rows at each step.
#[test]
fn the_first_step_of_a_condition_is_found() {
    let place = tempfile::tempdir().unwrap();
    let [run, each, out] = ["run", "each", "out"].map(|name| place.path().join(name));
    let rows = |every: &str| format!("output.history_every={every}");
    // Checkpoints within the part hold extremes over the run's rows.
    let often = [
        "output.checkpoint_every_steps=5",
        "output.checkpoints_kept=100",
    ];
    let often = often.iter().flat_map(|set| ["--set", *set]);
    end(coarse_run(1, &run).args(["--set", &rows("20")]).args(often)).with_code(0);
    end(coarse_run(2, &each).args(["--set", &rows("1")])).with_code(0);
    let text = std::fs::read_to_string(each.join("history.csv")).unwrap();
    let cells = |line: &str, k: usize| line.split(',').nth(k).unwrap().parse::<f64>().unwrap();
    let all: Vec<&str> = text.lines().skip(3).collect();
    let limit = 0.5 * (cells(all[33], 4) + cells(all[34], 4));
    let below = |line: &&str| cells(line, 4) < limit;
    let expected = all.iter().position(below).unwrap();
    assert!(all[expected].starts_with(&format!("{expected},")));

    let mut when = ranks(2);
    when.args(["when", &format!("history.kinetic_energy<{limit} J")]);
    let ended = end(when.arg(&run).arg("--out").arg(&out)).with_code(0);
    let told = format!("holds from step {expected} on");
    assert!(ended.stdout.contains(&told), "{told}: {ended:#?}");
    let folder = out.join("step");
    assert_eq!(usize::try_from(status(&folder).1), Ok(expected));
    assert!(folder.join("picture.png").is_file());

    let mut never = command(WHIPPLE);
    never.args(["when", "history.kinetic_energy<0 J"]).arg(&run);
    let ended = end(&mut never).with_code(1);
    assert!(ended.stdout.contains("holds at no row"), "{ended:#?}");
    let mut unknown = command(WHIPPLE);
    unknown.args(["when", "history.nothing<0 J"]).arg(&run);
    let ended = end(&mut unknown).with_code(2);
    assert!(
        ended.stderr.contains("no answer `history.nothing`"),
        "{ended:#?}"
    );
}

/// Two runs with another spall limit part where the first particle fails, and the keys are told.
#[test]
fn the_first_difference_is_found() {
    let place = tempfile::tempdir().unwrap();
    let [a, b, out] = ["a", "b", "out"].map(|name| place.path().join(name));
    end(&mut coarse_run(1, &a)).with_code(0);
    let key = "material.aluminium.failure.spall.pressure";
    end(coarse_run(2, &b).args(["--set", &format!("{key}=-1.25 GPa")])).with_code(0);
    let mut diff = ranks(2);
    let ended = end(diff.arg("diff").arg(&a).arg(&b).arg("--out").arg(&out)).with_code(1);
    let lines: Vec<&str> = ended.stdout.lines().collect();
    assert!(
        lines
            .iter()
            .any(|line| line.starts_with(&format!("key {key}: "))),
        "{ended:#?}"
    );
    let first = lines
        .iter()
        .find(|line| line.contains(" particles differ"))
        .unwrap();
    // Both fail in that step, first.
    assert!(
        first.starts_with("damage: 2 particles differ; first id "),
        "{ended:#?}"
    );
    assert!(
        ended.stdout.contains("the first step that differs is "),
        "{ended:#?}"
    );

    // Rows of other steps tell nothing.
    let rows = place.path().join("rows");
    end(coarse_run(1, &rows).args(["--set", "output.history_every=7"])).with_code(0);
    let mut other = command(WHIPPLE);
    let ended = end(other.arg("diff").arg(&a).arg(&rows)).with_code(0);
    assert!(
        ended.stdout.contains("no row of the histories"),
        "{ended:#?}"
    );

    let ended = end(command(WHIPPLE).arg("diff").arg(&a).arg(&a)).with_code(0);
    assert!(
        ended.stdout.contains("no row of the histories"),
        "{ended:#?}"
    );
}

/// Keys that move particles cannot change.
#[test]
fn what_moves_particles_is_refused() {
    let place = tempfile::tempdir().unwrap();
    let mut again = command(WHIPPLE);
    again
        .arg("replay")
        .arg(place.path())
        .args(["--set", "sph.alpha=3"]);
    let ended = end(&mut again).with_code(2);
    assert!(
        ended
            .stderr
            .contains("`output`, `measure`, `gauge` and `fragments` alone"),
        "{ended:#?}"
    );
    let ended = end(command(WHIPPLE).arg("replay").arg(place.path())).with_code(2);
    assert!(ended.stderr.contains("neither a run"), "{ended:#?}");
}

/// What one particle bore, met and lost, with the bits of any ranks, and a gauge that the run did not have.
#[test]
fn the_history_of_a_particle_is_told() {
    let place = tempfile::tempdir().unwrap();
    let run = place.path().join("run");
    end(&mut coarse_run(2, &run)).with_code(0);
    let particle = {
        let text = std::fs::read_to_string(run.join("summary.json")).unwrap();
        let summary: serde_json::Value = serde_json::from_str(&text).unwrap();
        summary["closest_foreign_particles"]["ids"][0]
            .as_u64()
            .unwrap()
    };
    let tables = [1, 3].map(|number| {
        let out = place.path().join(number.to_string());
        let mut again = ranks(number);
        again.arg("replay").arg(&run).arg("--out").arg(&out);
        again.args(["--to", "40ns", "--gauge", "0, 0, -0.1 mm", "--why"]);
        let ended = end(again.arg(particle.to_string())).with_code(0);
        assert!(ended.stdout.contains("to the last bit"), "{ended:#?}");
        for told in [
            "largest pressure",
            "closest particle of another body",
            "it yields",
        ] {
            assert!(ended.stdout.contains(told), "{told}: {ended:#?}");
        }
        assert!(out.join(format!("particle-{particle}.png")).exists());
        std::fs::read_to_string(out.join("gauges.csv")).unwrap()
    });
    assert_eq!(tables[0], tables[1]);
    // Inside the sphere and the plate there is matter about both.
    let names: Vec<&str> = tables[0].lines().nth(1).unwrap().split(',').collect();
    let column = |name: &str| names.iter().position(|own| *own == name).unwrap();
    let last = tables[0]
        .lines()
        .last()
        .unwrap()
        .split(',')
        .collect::<Vec<_>>();
    let number = |name: &str| last[column(name)].parse::<f64>().unwrap();
    assert!((10.0..100.0).contains(&number("neighbours")), "{last:?}");
    assert!(number("closest_neighbour") > 0.0 && number("coverage") == 1.0);

    let mut again = ranks(2);
    again
        .arg("replay")
        .arg(&run)
        .arg("--out")
        .arg(place.path().join("none"));
    let ended = end(again.args(["--to", "10ns", "--why", "987654321"])).with_code(2);
    assert!(
        ended.stderr.contains("there is no particle 987654321"),
        "{ended:#?}"
    );
}

/// Snapshots of a box hold what is in it alone, come as often as asked, with the bits of any ranks; the whole model's come as in the run.
#[test]
fn a_box_has_snapshots_of_its_own() {
    let place = tempfile::tempdir().unwrap();
    let run = place.path().join("run");
    end(&mut coarse_run(2, &run)).with_code(0);
    let watched = |number: usize, name: &str, more: &[&str]| {
        let out = place.path().join(name);
        let mut again = ranks(number);
        again.arg("replay").arg(&run).arg("--out").arg(&out);
        again.args(["--from", "0.1us", "--to", "0.12us"]).args(more);
        (end(&mut again), out)
    };
    let box_of_few = "--watch=-1mm,-1mm,-0.1mm:0.2mm,0.2mm,";
    let [one, three] = [(1, "one"), (3, "three")].map(|(number, name)| {
        let (ended, out) = watched(number, name, &[box_of_few, "--snapshot-every", "2ns"]);
        assert!(ended.stdout.contains("to the last bit"), "{ended:#?}");
        let ended = ended.with_code(0);
        let schedule = out.join("snapshots/watch");
        assert!(names(&schedule) > 5, "{ended:#?}");
        out
    });
    let compared = end(command(WHIPPLE).arg("compare").arg(&one).arg(&three)).with_code(0);
    assert!(!compared.stdout.contains("differ"), "{compared:#?}");
    let snapshot = |folder: &Path| {
        let mut all: Vec<_> = std::fs::read_dir(folder)
            .unwrap()
            .map(|entry| entry.unwrap().path())
            .collect();
        all.retain(|path| path.extension().is_some_and(|ending| ending == "vtkhdf"));
        all.sort();
        all.pop().unwrap()
    };
    let info = |path: &Path| -> serde_json::Value {
        let told = end(command(WHIPPLE).arg("info").arg("--json").arg(path)).with_code(0);
        serde_json::from_str(&told.stdout).unwrap()
    };
    let [part, whole] =
        ["snapshots/watch", "snapshots"].map(|folder| info(&snapshot(&one.join(folder))));
    let count = |of: &serde_json::Value| -> u64 {
        let bodies = of["bodies"].as_array().unwrap().iter();
        bodies.map(|body| body["particles"].as_u64().unwrap()).sum()
    };
    assert!(
        0 < count(&part) && count(&part) < count(&whole) / 2,
        "{part} {whole}"
    );
    // Without an interval there are some fifty, as far as steps allow.
    let (ended, out) = watched(1, "two-boxes", &[box_of_few, "--watch=,,:,,0mm"]);
    ended.with_code(0);
    for name in ["watch", "watch-2"] {
        assert!(names(&out.join("snapshots").join(name)) > 5);
    }
    let (ended, _) = watched(1, "none", &["--watch=1mm,1mm,1mm"]);
    assert!(ended.with_code(2).stderr.contains("LOWER:UPPER"));
}
