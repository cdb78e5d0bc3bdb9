//! `whipple measure` against the run that wrote the snapshots.

use crate::program::{WHIPPLE, assert_same, coarse_run, command, end, ranks};
use files::output::Sheet;
use std::fs;

const EVERY: [&str; 4] = [
    "--set",
    "output.snapshot_every=0.03 us",
    "--set",
    "measure.every=0.03 us",
];

/// What a run tells is what its snapshots tell afterwards, to the last bit.
#[test]
fn snapshots_tell_what_the_run_told() {
    let place = tempfile::tempdir().unwrap();
    let [run, after] = ["run", "after.csv"].map(|name| place.path().join(name));
    end(coarse_run(2, &run).args(EVERY)).with_code(0);
    let mut measure = command(WHIPPLE);
    measure.arg("measure").arg(&run).arg("--all");
    let ended = end(measure.arg("--csv").arg(&after)).with_code(0);
    for line in ["plate (plate)", "plate-debris (debris)", "verdict"] {
        assert!(ended.stdout.contains(line), "{}", ended.stdout);
    }
    let [told, again] = [run.join("measures.csv"), after]
        .map(|path| Sheet::parse(&fs::read_to_string(path).unwrap()).unwrap());
    assert_eq!(told.names, again.names);
    assert_eq!(told.rows.len(), again.rows.len());
    for (a, b) in told.rows.iter().zip(&again.rows) {
        assert_eq!(a.1, b.1);
    }
    // One snapshot alone, and what is no measure.
    let mut measure = command(WHIPPLE);
    measure.arg("measure").arg(&run).args(["--at", "0us"]);
    let ended = end(&mut measure).with_code(0);
    assert!(ended.stdout.contains("not_loaded"), "{}", ended.stdout);
    let mut measure = command(WHIPPLE);
    measure.arg("measure").arg(&run);
    measure.args(["--set", "measure.plate=[{ body = \"wall\" }]"]);
    let ended = end(&mut measure).with_code(2);
    assert!(ended.stderr.contains("wall"), "{}", ended.stderr);
    end(command(WHIPPLE).args(["measure", "nowhere"])).with_code(2);
}

/// Schedules of their own write parts of the model, with the same bits on any ranks and through a
/// restart; what needs all particles says so.
#[test]
#[ignore = "slow"]
fn schedules_of_snapshots_have_the_same_bits_and_are_told_from_whole_ones() {
    let place = tempfile::tempdir().unwrap();
    let [one, three, gone_on] = ["one", "three", "on"].map(|name| place.path().join(name));
    let schedules = "output.snapshot=[\
        { name = \"close\", every = \"0.03 us\", bodies = [\"sphere\"], precision = \"single\", \
          fields = [\"pressure\", \"peak_pressure\"] }, \
        { name = \"rear\", every = \"0.07 us\", region.below.x = \"0.3 mm\" }]";
    let set = ["--set", schedules];
    end(coarse_run(1, &one).args(set)).with_code(0);
    end(coarse_run(3, &three).args(set)).with_code(0);
    end(coarse_run(2, &gone_on).args(set).args(["--until", "0.1us"])).with_code(0);
    end(ranks(1).arg("restart").arg(&gone_on)).with_code(0);
    assert_same(&three, &one);
    assert_same(&gone_on, &one);
    let files = |name: &str| {
        let found = fs::read_dir(one.join("snapshots").join(name)).unwrap();
        let mut found: Vec<_> = found.map(|entry| entry.unwrap().path()).collect();
        found.retain(|path| path.extension().is_some_and(|ending| ending == "vtkhdf"));
        found.sort();
        found
    };
    let (close, rear) = (files("close"), files("rear"));
    assert!(
        close.len() > rear.len() && rear.len() > 2,
        "{close:?} {rear:?}"
    );
    let index = fs::read_to_string(one.join("snapshots/close/close.vtkhdf.series")).unwrap();
    assert_eq!(index.matches("step-").count(), close.len());
    let index = |run: &std::path::Path| fs::read(run.join("snapshots/rear/rear.vtkhdf.series"));
    assert_eq!(index(&gone_on).unwrap(), index(&one).unwrap());

    let told = end(command(WHIPPLE).arg("info").arg(&one)).with_code(0);
    assert!(
        told.stdout.contains("snapshots of close"),
        "{}",
        told.stdout
    );
    let told = end(command(WHIPPLE).arg("info").arg(&close[1])).with_code(0);
    for line in ["of sphere", "schedule", "peak_pressure", "pressure"] {
        assert!(told.stdout.contains(line), "{}", told.stdout);
    }
    for path in [&close[0], &rear[0]] {
        for name in ["measure", "fragments"] {
            let told = end(command(WHIPPLE).arg(name).arg(path)).with_code(2);
            let part = "it holds a part of the model alone (";
            assert!(told.stderr.contains(part), "{}", told.stderr);
        }
    }
    let mut plot = command(WHIPPLE);
    plot.arg("plot").arg(one.join("snapshots/rear"));
    end(plot.arg("--out").arg(place.path().join("rear.png"))).with_code(0);
}
