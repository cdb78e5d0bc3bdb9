//! A run that is asked to stop writes a checkpoint and exits with 75, and a restart goes on from
//! there to the same bits.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Duration;

use crate::program::{
    COARSE, Ended, Running, WHIPPLE, assert_same, coarse_run, command, end, project,
    quarter_impact, ranks, signal, start, status, strike,
};

/// The step before which rank 0 pauses, so that there is time to stop it.
const PAUSE: u64 = 30;

fn folder() -> tempfile::TempDir {
    tempfile::tempdir().unwrap()
}

/// Starts a command that pauses on its way, and asks it to stop while it does.
fn stopped(command: &mut Command, run: &Path, ask: impl FnOnce(&Running)) -> Ended {
    strike(command, &format!("pause:0:{PAUSE}"));
    let running = start(command);
    running.until_step(run, PAUSE - 1);
    ask(&running);
    running.end()
}

/// Fails unless the run in `run` was stopped for `reason`, with a checkpoint of its last step and
/// nothing said but what is to be said.
#[track_caller]
fn assert_stopped(ended: &Ended, run: &Path, reason: &str) {
    assert_eq!(ended.code, Some(75), "{ended:#?}");
    let (state, step, why) = status(run);
    assert_eq!((state.as_str(), why.as_str()), ("stopped", reason));
    assert!((PAUSE..PAUSE + 5).contains(&step), "stopped at step {step}");
    let checkpoint = run.join(format!("checkpoints/step-{step:08}/manifest.json"));
    assert!(checkpoint.is_file(), "{}", checkpoint.display());
    assert!(run.join("summary.json").is_file());
    let last = ended.stdout.lines().last().unwrap_or_default();
    assert!(
        last.starts_with(&format!("stopped ({reason}) at step {step}")),
        "{ended:#?}"
    );
    let lines = ended.stdout.lines();
    let others = lines.filter(|line| !line.starts_with("decomposition: "));
    assert_eq!(others.count(), 2, "{ended:#?}");
}

/// Restarts the run on other ranks and compares it with one that nobody has stopped.
#[track_caller]
fn assert_goes_on(run: &Path, reference: &Path, number: usize) {
    end(ranks(number).arg("restart").arg(run)).with_code(0);
    let (state, ..) = status(run);
    assert_eq!(state, "finished");
    assert!(!run.join("stop").exists());
    assert_same(run, reference);
}

fn reference(place: &Path) -> PathBuf {
    let run = place.join("reference");
    let ended = end(&mut coarse_run(2, &run)).with_code(0);
    assert_eq!(ended.stderr, "");
    run
}

#[test]
#[cfg_attr(not(debug_assertions), ignore = "needs debug assertions")]
fn signals_stop_softly() {
    let place = folder();
    let reference = reference(place.path());
    let reason = "a signal asked to stop";

    let run = place.path().join("mpirun");
    let ended = stopped(&mut coarse_run(2, &run), &run, |mpirun| {
        signal("USR1", mpirun.id());
    });
    assert_stopped(&ended, &run, reason);
    assert_eq!(ended.stderr, "");
    assert_goes_on(&run, &reference, 3);

    let run = place.path().join("rank");
    let ended = stopped(&mut coarse_run(2, &run), &run, |mpirun| {
        let ranks = mpirun.rank_ids();
        assert_eq!(ranks.len(), 2);
        signal("TERM", ranks[1]);
    });
    assert_stopped(&ended, &run, reason);
    assert_eq!(ended.stderr, "");
    assert_goes_on(&run, &reference, 1);
}

/// A closed terminal and a limit of processor time ask as SIGTERM does; under `nohup` a closed terminal asks nothing.
#[test]
#[ignore = "slow"]
#[cfg_attr(not(debug_assertions), ignore = "needs debug assertions")]
fn a_closed_terminal_and_the_processor_time_stop_softly() {
    let place = folder();
    let on = |mut program: Command, run: &Path| {
        program.args(["run", &quarter_impact()]).args(COARSE);
        program.arg("--out").arg(run);
        program
    };
    for name in ["HUP", "XCPU"] {
        let run = place.path().join(name);
        let mut alone = on(command(WHIPPLE), &run);
        let ended = stopped(&mut alone, &run, |rank| signal(name, rank.id()));
        assert_stopped(&ended, &run, "a signal asked to stop");
    }
    let run = place.path().join("nohup");
    let mut nohup = command("bash");
    nohup.args(["-c", "trap '' HUP; exec \"$0\" \"$@\"", WHIPPLE]);
    let ended = stopped(&mut on(nohup, &run), &run, |rank| signal("HUP", rank.id()));
    assert_eq!(ended.code, Some(0), "{ended:#?}");
    assert_eq!(status(&run).0, "finished");
}

#[test]
#[cfg_attr(not(debug_assertions), ignore = "needs debug assertions")]
fn ctrl_c_stops_a_lone_rank_softly_and_a_second_one_at_once() {
    let place = folder();
    let alone = |run: &Path| {
        let mut alone = command(WHIPPLE);
        alone.args(["run", &quarter_impact()]).args(COARSE);
        alone.arg("--out").arg(run);
        alone
    };
    let run = place.path().join("once");
    let ended = stopped(&mut alone(&run), &run, |rank| signal("INT", rank.id()));
    assert_stopped(&ended, &run, "a signal asked to stop");

    let run = place.path().join("twice");
    let ended = stopped(&mut alone(&run), &run, |rank| {
        signal("INT", rank.id());
        std::thread::sleep(Duration::from_millis(100));
        signal("INT", rank.id());
    });
    assert_eq!(ended.code, Some(130), "{ended:#?}");
    assert_eq!(status(&run).0, "running");
}

#[test]
#[ignore = "slow"]
#[cfg_attr(not(debug_assertions), ignore = "needs debug assertions")]
fn a_file_and_the_clock_stop_softly() {
    let place = folder();
    let reference = reference(place.path());

    let run = place.path().join("file");
    let ended = stopped(&mut coarse_run(2, &run), &run, |_| {
        std::fs::write(run.join("stop"), "").unwrap();
    });
    assert_stopped(&ended, &run, "the file `stop` asked to stop");
    assert_goes_on(&run, &reference, 3);

    // The clock runs from the program's start, so on a busy machine it may stop before the pause.
    let run = place.path().join("clock");
    let mut command = coarse_run(1, &run);
    strike(&mut command, &format!("pause:0:{PAUSE}"));
    end(command.args(["--walltime", "1.2s"])).with_code(75);
    let (state, step, reason) = status(&run);
    assert_eq!(
        (state.as_str(), reason.as_str()),
        ("stopped", "the wall time is used up")
    );
    assert!(step <= PAUSE + 1, "stopped at step {step}");
    assert_goes_on(&run, &reference, 2);
}

#[test]
#[ignore = "slow"]
#[cfg_attr(not(debug_assertions), ignore = "needs debug assertions")]
fn the_launch_script_turns_signals_into_soft_stops() {
    let place = folder();
    for name in ["TERM", "INT", "USR1"] {
        let run = place.path().join(name);
        // A shell cannot trap what its parent ignores, as shells do with INT for what they put
        // in the background.
        let mut script = command("env");
        script.args(["--default-signal=INT", &project("jobs/run.sh")]);
        script.args(["-n", "2", "-t", "1", &quarter_impact()]);
        script.args(COARSE).arg("--out").arg(&run);
        let ended = stopped(&mut script, &run, |script| signal(name, script.id()));
        assert_stopped(&ended, &run, "a signal asked to stop");
        assert!(
            ended.stderr.starts_with("stopping after this step"),
            "{ended:#?}"
        );
        assert_eq!(ended.stderr.lines().count(), 1, "{ended:#?}");
    }
}

#[test]
fn until_stops_at_its_time_and_is_no_failure() {
    let place = folder();
    let run = place.path().join("run");
    let ended = end(coarse_run(2, &run).args(["--until", "0.05us"])).with_code(0);
    assert_eq!(ended.stderr, "");
    let (state, step, reason) = status(&run);
    assert_eq!(
        (state.as_str(), reason.as_str()),
        ("stopped", "the time of --until is reached")
    );

    // The same time again leaves the run alone.
    let ended = end(ranks(2)
        .arg("restart")
        .arg(&run)
        .args(["--until", "0.05us"]))
    .with_code(0);
    assert!(ended.stdout.starts_with("nothing to do: "), "{ended:#?}");
    assert_eq!(status(&run), (state, step, reason));

    assert_goes_on(&run, &reference(place.path()), 2);
}

/// A file `stop` from before a restart is of the earlier run; one that comes while it starts
/// counts.
#[test]
#[cfg_attr(not(debug_assertions), ignore = "needs debug assertions")]
fn a_stop_file_that_comes_while_a_run_starts_is_not_lost() {
    let place = folder();
    let run = place.path().join("run");
    end(coarse_run(2, &run).args(["--until", "0.01us"])).with_code(0);
    let file = std::fs::File::create(run.join("stop")).unwrap();
    let soon = std::time::SystemTime::now() + Duration::from_mins(1);
    file.set_modified(soon).unwrap();
    // It is looked for each second.
    let mut again = ranks(2);
    strike(&mut again, &format!("pause:0:{PAUSE}"));
    end(again.arg("restart").arg(&run)).with_code(75);
    let (state, _, reason) = status(&run);
    let file = "the file `stop` asked to stop";
    assert_eq!((state.as_str(), reason.as_str()), ("stopped", file));
}
