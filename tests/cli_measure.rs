//! `whipple measure` against the run that wrote the snapshots.

mod cli_support;

use cli_support::{WHIPPLE, coarse_run, command, end};
use std::fs;
use whipple::output::Sheet;

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
    assert!(ended.stdout.contains("held"), "{}", ended.stdout);
    let mut measure = command(WHIPPLE);
    measure.arg("measure").arg(&run);
    measure.args(["--set", "measure.plate=[{ body = \"wall\" }]"]);
    let ended = end(&mut measure).with_code(2);
    assert!(ended.stderr.contains("wall"), "{}", ended.stderr);
    end(command(WHIPPLE).args(["measure", "nowhere"])).with_code(2);
}
