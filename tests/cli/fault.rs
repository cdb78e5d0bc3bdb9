//! One rank's trouble ends all ranks in seconds, with one message.

use std::fs;
use std::path::Path;
use std::process::Command;
use std::time::Duration;

use crate::program::{
    COARSE, Ended, WHIPPLE, assert_same, coarse_run, command, end, project, quarter_impact, ranks,
    signal, start, status, strike,
};

/// A run takes a second or so, and mpirun gives ranks that do not end by themselves two more.
const SECONDS: Duration = Duration::from_secs(40);

fn faulty_run(number: usize, folder: &Path, fault: &str) -> Command {
    let mut command = coarse_run(number, folder);
    strike(&mut command, fault);
    command
}

/// The one line of the error stream that is the program's.
#[track_caller]
fn only_line(ended: &Ended) -> &str {
    assert!(ended.took < SECONDS, "{ended:#?}");
    // Open MPI's own file layer may add a line of its own when a disk is full: it prints one if
    // the system refuses a write, and none if it takes a part of it first.
    // mpirun's event loop may warn of a pipe that an abort has closed.
    let ignored = ["mca_fbtl_posix_pwritev: ", "[warn] Epoll "];
    let open_mpi = |line: &&str| ignored.iter().any(|begin| line.starts_with(begin));
    let mut lines = ended.stderr.lines().filter(|line| !open_mpi(line));
    let line = lines.next().unwrap_or_else(|| panic!("{ended:#?}"));
    assert_eq!(lines.next(), None, "{ended:#?}");
    line
}

#[test]
#[cfg_attr(not(debug_assertions), ignore = "needs debug assertions")]
fn a_panic_on_one_rank_ends_all() {
    let place = tempfile::tempdir().unwrap();
    for (fault, threads, number, rank) in [
        ("panic:2:20", "1", 3, 2),
        ("task:1:20", "2", 2, 1),
        ("panic:0:20", "1", 1, 0),
    ] {
        let run = place.path().join(fault);
        let mut command = faulty_run(number, &run, fault);
        let ended = end(command.args(["--threads", threads]));
        assert_eq!(ended.code, Some(101), "{ended:#?}");
        let line = only_line(&ended);
        let begin =
            format!("error: rank {rank}, step 20: a panic on purpose (src/files/run/fault.rs:");
        assert!(line.starts_with(&begin), "{line}");
        // What runs on how many ranks, and how these share out space.
        assert_eq!(ended.stdout.lines().count(), number.min(2), "{ended:#?}");
        // A crash has no time to write a status; what a chain reads is that nothing is finished.
        assert_eq!(status(&run).0, "running");
    }
}

#[test]
#[cfg_attr(not(debug_assertions), ignore = "needs debug assertions")]
fn an_error_on_one_rank_is_that_of_all() {
    let place = tempfile::tempdir().unwrap();
    let run = place.path().join("run");
    let ended = end(&mut faulty_run(3, &run, "nan:1:60")).with_code(1);
    let line = only_line(&ended);
    assert!(line.starts_with("error: step 60: particle "), "{line}");
    assert!(line.contains("non-finite"), "{line}");
    let (state, step, reason) = status(&run);
    assert_eq!((state.as_str(), step), ("failed", 60));
    assert_eq!(format!("error: {reason}"), line);
    let log = std::fs::read_to_string(run.join("log.txt")).unwrap();
    assert!(
        log.lines()
            .last()
            .unwrap()
            .ends_with(&format!("failed: {reason}")),
        "{log}"
    );

    // The checkpoint before the trouble is a good one.
    end(ranks(2).arg("restart").arg(&run)).with_code(0);
    let reference = place.path().join("reference");
    end(&mut coarse_run(2, &reference)).with_code(0);
    assert_same(&run, &reference);
}

#[test]
#[cfg_attr(not(debug_assertions), ignore = "needs debug assertions")]
fn a_killed_rank_ends_all() {
    let place = tempfile::tempdir().unwrap();
    let run = place.path().join("run");
    let running = start(&mut faulty_run(2, &run, "pause:0:30"));
    running.until_step(&run, 29);
    signal("KILL", running.rank_ids()[1]);
    let ended = running.end();
    assert!(!matches!(ended.code, Some(0 | 75)), "{ended:#?}");
    assert!(ended.took < SECONDS, "{ended:#?}");
    assert_eq!(status(&run).0, "running");
}

/// In a step and while a checkpoint is written; the restart ends in the same bits.
#[test]
#[ignore = "slow"]
#[cfg_attr(not(debug_assertions), ignore = "needs debug assertions")]
fn a_rank_killed_anywhere_costs_what_came_after_the_last_checkpoint() {
    kills_cost_little(&["kill:1:60", "kill-in-checkpoint:0:40"]);
}

#[test]
#[ignore = "slow: the other rank of each"]
fn another_rank_killed_costs_what_came_after_the_last_checkpoint() {
    kills_cost_little(&["kill:0:61", "kill-in-checkpoint:1:40"]);
}

fn kills_cost_little(faults: &[&str]) {
    let place = tempfile::tempdir().unwrap();
    let reference = place.path().join("reference");
    end(&mut coarse_run(2, &reference)).with_code(0);
    for fault in faults {
        let run = place.path().join(fault);
        let mut command = faulty_run(3, &run, fault);
        command.args(["--set", "output.checkpoint_every_steps=16"]);
        let ended = end(&mut command);
        assert!(!matches!(ended.code, Some(0 | 75)), "{ended:#?}");
        assert!(ended.took < SECONDS, "{ended:#?}");
        assert_eq!(status(&run).0, "running");
        eprintln!("{fault}: all ended after {:.1} s", ended.took.as_secs_f64());
        end(ranks(2).arg("restart").arg(&run)).with_code(0);
        assert_same(&run, &reference);
    }
}

/// A limit on the size of files in one rank is a disk that is full for that rank alone.
#[test]
#[ignore = "slow"]
#[cfg_attr(not(debug_assertions), ignore = "needs debug assertions")]
fn a_disk_full_for_one_rank_ends_all_with_one_message() {
    let place = tempfile::tempdir().unwrap();
    for rank in [0, 1] {
        let run = place.path().join(format!("{rank}"));
        let mut command = faulty_run(3, &run, &format!("full:{rank}:40"));
        let ended = end(&mut command).with_code(1);
        let line = only_line(&ended);
        assert!(line.starts_with("error: cannot "), "{line}");
        assert_eq!(status(&run).0, "failed");
        eprintln!(
            "full:{rank}: all ended after {:.1} s",
            ended.took.as_secs_f64()
        );
        end(ranks(2).arg("restart").arg(&run)).with_code(0);
    }
}

#[test]
fn a_folder_that_nobody_may_write_to_is_told() {
    let place = tempfile::tempdir().unwrap();
    let run = Path::new("/proc/self/run");
    let ended = end(&mut coarse_run(2, run)).with_code(2);
    assert!(only_line(&ended).starts_with("error: cannot create the folder "));
    drop(place);
}

#[test]
fn a_full_disk_ends_all_and_leaves_the_last_checkpoint() {
    let place = tempfile::tempdir().unwrap();
    let disk = place.path().join("disk");
    // A snapshot takes .6 MB and a checkpoint .95 MB: there is room for two checkpoints of many.
    let ran = on_small_disk(&disk, 3_200_000, |disk| {
        let run = disk.join("run");
        let mut command = coarse_run(3, &run);
        let ended = end(command.args(["--set", "output.checkpoint_every=0.02us"])).with_code(1);
        let line = only_line(&ended);
        assert!(line.starts_with("error: cannot "), "{line}");
        assert!(line.contains("No space left on device"), "{line}");
        let (state, step, reason) = status(&run);
        assert_eq!(state, "failed");
        assert!(step > 0);
        assert_eq!(format!("error: {reason}"), line);
        assert!(!run.join("summary.json").exists());
        // Where there is room again, the run goes on.
        let copied = Command::new("cp")
            .arg("-r")
            .arg(&run)
            .arg(place.path())
            .status();
        assert!(copied.unwrap().success());
    });
    if !ran {
        eprintln!("skipped: cannot mount a small file system (not root?)");
        return;
    }
    let run = place.path().join("run");
    end(ranks(2).arg("restart").arg(&run)).with_code(0);
    let reference = place.path().join("reference");
    end(&mut coarse_run(2, &reference)).with_code(0);
    assert_same(&run, &reference);
}

/// Does something on a file system of so many bytes, as root only.
fn on_small_disk(folder: &Path, bytes: u64, task: impl FnOnce(&Path)) -> bool {
    std::fs::create_dir(folder).unwrap();
    let options = format!("size={bytes}");
    let mount = Command::new("mount")
        .args(["-t", "tmpfs", "-o", &options, "tmpfs"])
        .arg(folder)
        .output();
    if !mount.is_ok_and(|mount| mount.status.success()) {
        return false;
    }
    let result = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| task(folder)));
    let unmounted = Command::new("umount").arg("-l").arg(folder).status();
    assert!(unmounted.is_ok_and(|status| status.success()));
    if let Err(panic) = result {
        std::panic::resume_unwind(panic);
    }
    true
}

/// One rank with these arguments, and one with those.
fn apart(first: &[&str], second: &[&str], out: &Path) -> Ended {
    let mut both = command("mpirun");
    both.args(["-n", "1"]).args(first).arg("--out").arg(out);
    both.args([":", "-n", "1"])
        .args(second)
        .arg("--out")
        .arg(out);
    end(&mut both)
}

#[test]
fn ranks_with_other_options_or_another_case_are_told() {
    let place = tempfile::tempdir().unwrap();
    let out = place.path().join("run");
    let case = quarter_impact();
    let run = [&[WHIPPLE, "run", &case], &COARSE[..]].concat();
    let longer = [&run[..], &["--set", "run.end_time=1us"]].concat();
    let ended = apart(&run, &longer, &out).with_code(2);
    assert!(only_line(&ended).starts_with("error: rank 1 has other options"));

    // A machine of its own may have a file of its own, or none.
    let cube = fs::read_to_string(project("tests/common/cube.obj")).unwrap();
    let parts = [
        Some(cube.clone()),
        Some(cube.replace("v 0 0 0", "v 0 0 0.1")),
        None,
    ];
    let folders = ["a", "b", "c"].map(|name| place.path().join(name));
    for (folder, part) in folders.iter().zip(parts) {
        fs::create_dir(folder).unwrap();
        let text = "dimension = 3\nspacing = \"0.1 mm\"\nrun.end_time = \"0.2 us\"\n\
                    material.metal.library = \"copper\"\n[[body]]\nname = \"part\"\nmaterial = \"metal\"\n\
                    shape.obj = { file = \"part.obj\", unit = \"0.1 mm\" }\n";
        fs::write(folder.join("case.toml"), text).unwrap();
        if let Some(part) = part {
            fs::write(folder.join("part.obj"), part).unwrap();
        }
    }
    let [a, b, c] = folders.each_ref().map(|folder| {
        let folder = folder.to_str().unwrap();
        ["-wdir", folder, WHIPPLE, "run", "case.toml"]
    });
    let ended = apart(&a, &b, &out).with_code(2);
    assert_eq!(
        only_line(&ended),
        "error: rank 1 has read another case than rank 0"
    );
    let ended = apart(&a, &c, &out).with_code(2);
    assert!(ended.stderr.contains("part.obj"), "{ended:#?}");
    assert!(!out.exists());
}

#[test]
fn a_launcher_of_another_mpi_is_told() {
    let place = tempfile::tempdir().unwrap();
    let run = place.path().join("run");
    let mut alone = command(WHIPPLE);
    alone.env("PMI_SIZE", "4").env("PMI_RANK", "0");
    alone
        .args(["run", &quarter_impact()])
        .args(COARSE)
        .arg("--out")
        .arg(&run);
    let ended = end(&mut alone).with_code(1);
    let told = only_line(&ended);
    assert!(
        told.contains("4 ranks (PMI_SIZE), and MPI (Open MPI"),
        "{told}"
    );
    assert!(!run.exists());
}
