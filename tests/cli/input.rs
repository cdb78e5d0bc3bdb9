//! A user's mistake gives one message for all ranks, in words that help, and exit code 2.

use std::fs;
use std::path::Path;
use std::process::Command;

use crate::program::{
    COARSE, WHIPPLE, coarse_run, command, end, project, quarter_impact, ranks, status,
};

/// Runs `whipple …` on two ranks; gives what it complains about, of which there must be one.
#[track_caller]
fn complaint(arguments: &[&str]) -> String {
    complaint_of(ranks(2), arguments)
}

/// The same without mpirun, which takes a moment to start.
#[track_caller]
fn complaint_alone(arguments: &[&str]) -> String {
    complaint_of(command(WHIPPLE), arguments)
}

#[track_caller]
fn complaint_of(mut command: Command, arguments: &[&str]) -> String {
    let ended = end(command.args(arguments)).with_code(2);
    assert_eq!(ended.complaints("error:").len(), 1, "{ended:#?}");
    assert_eq!(ended.stdout, "", "{ended:#?}");
    ended.stderr.trim_end().to_owned()
}

#[test]
fn a_wrong_case_is_shown_with_file_line_and_caret() {
    let place = tempfile::tempdir().unwrap();
    let path = place.path().join("case.toml");
    let text = fs::read_to_string(project("inputs/quarter-impact/case.toml")).unwrap();
    fs::write(&path, text.replace("alpha = 1.0", "alfa = 1.0")).unwrap();
    let line = 1 + text[..text.find("alpha = 1.0").unwrap()].lines().count();
    let (path, out) = (path.to_str().unwrap(), place.path().join("out"));
    let said = complaint(&["run", path, "--out", out.to_str().unwrap()]);
    assert!(said.starts_with("error: unknown key `alfa`\n"), "{said}");
    assert!(said.contains(&format!("--> {path}:{line}:1\n")), "{said}");
    assert!(said.contains("^^^^"), "{said}");
    assert!(!out.exists());

    // An override is shown in the same way, and so by `check`.
    let set = ["--set", "spacing=2"];
    let wrong = "error: expected a length with a unit";
    let case = quarter_impact();
    for said in [
        complaint(&[&["run", &case][..], &set].concat()),
        end(command(WHIPPLE).args(["check", &case]).args(set))
            .with_code(2)
            .stderr,
    ] {
        assert!(
            said.starts_with(wrong) && said.contains("--set:1:9"),
            "{said}"
        );
    }
}

#[test]
fn a_wrong_command_line_is_told_once() {
    let case = quarter_impact();
    for (arguments, begin) in [
        (&["frob"][..], "error: unrecognized subcommand 'frob'"),
        (
            &["run"],
            "error: the following required arguments were not provided",
        ),
        (
            &["run", &case, "--fast"],
            "error: unexpected argument '--fast'",
        ),
        (
            &["run", &case, "--threads", "0"],
            "error: invalid value '0' for '--threads <N>'",
        ),
        (
            &["run", &case, "--walltime", "soon"],
            "error: invalid value 'soon' for '--walltime",
        ),
        (
            &["run", &case, "--until", "soon"],
            "error: invalid value 'soon' for '--until <TIME>'",
        ),
        (
            &["run", &case, "--until", "3 mm"],
            "error: invalid value '3 mm' for '--until <TIME>'",
        ),
        (
            &["run", &case, "--until=-1us"],
            "error: invalid value '-1us' for '--until <TIME>'",
        ),
        (
            &["run", "nowhere.toml"],
            "error: cannot read the case nowhere.toml: No such file",
        ),
        (
            &["run", "/dev/null/case"],
            "error: cannot read the case /dev/null/case: Not a dir",
        ),
        (
            &["restart", "nowhere"],
            "error: cannot restart nowhere: No such file",
        ),
        (
            &["restart", &case],
            &format!("error: {case} is neither a run nor a checkpoint"),
        ),
    ] {
        let said = complaint_alone(arguments);
        assert!(said.starts_with(begin), "{said}");
    }
    // So it is under mpirun, and what is no mistake is told once, too.
    for arguments in [
        &["run", &case, "--until", "soon"][..],
        &["restart", "nowhere"],
    ] {
        assert_eq!(complaint(arguments), complaint_alone(arguments));
    }
    let ended = end(ranks(2).arg("-V")).with_code(0);
    assert_eq!(ended.stdout.lines().count(), 1, "{ended:#?}");
}

/// The long form tells what a result may hang on, alone and once for all ranks.
#[test]
fn the_version_tells_the_libraries() {
    let alone = end(command(WHIPPLE).arg("--version")).with_code(0);
    let words: Vec<Vec<&str>> = (alone.stdout.lines())
        .map(|line| line.split_whitespace().collect())
        .collect();
    assert_eq!(words[0], ["whipple", env!("CARGO_PKG_VERSION")]);
    let names: Vec<&str> = words[1..].iter().map(|words| words[0]).collect();
    assert_eq!(names, ["commit", "MPI", "HDF5", "instructions"]);
    for line in &words[1..] {
        assert!(line.len() > 1 && line.len() < 9, "{line:?}");
    }
    assert!(words[3][1].contains('.'), "{alone:#?}");
    let ranks = end(ranks(2).arg("--version")).with_code(0);
    assert_eq!(ranks.stdout, alone.stdout);
}

#[test]
fn folders_are_not_overwritten_by_mistake() {
    let place = tempfile::tempdir().unwrap();
    let run = place.path().join("run");
    let out = run.to_str().unwrap();
    let case = quarter_impact();
    fs::create_dir(&run).unwrap();
    fs::write(run.join("notes.txt"), "mine").unwrap();
    let said = complaint_alone(&["run", &case, "--out", out]);
    assert!(
        said.contains("is not empty") && said.contains("--force"),
        "{said}"
    );
    let said = complaint_alone(&["run", &case, "--out", out, "--force"]);
    assert!(said.contains("holds no run"), "{said}");
    assert_eq!(fs::read_dir(&run).unwrap().count(), 1);
    fs::remove_dir_all(&run).unwrap();

    let short = ["--set", "run.max_steps=5"];
    end(coarse_run(2, &run).args(short)).with_code(0);
    let said = complaint_alone(&[&["run", &case, "--out", out][..], &COARSE].concat());
    assert!(said.contains("--force"), "{said}");
    end(coarse_run(1, &run).args(short).arg("--force")).with_code(0);

    // A file where the folder should be, and a place where none can be made.
    let file = run.join("case.toml");
    let said = complaint_alone(&["run", &case, "--out", file.to_str().unwrap()]);
    assert!(said.contains("cannot create the folder"), "{said}");
    let said = complaint(&["run", &case, "--out", "/proc/run"]);
    assert!(
        said.contains("cannot create the folder /proc/run"),
        "{said}"
    );
}

#[test]
fn a_case_that_fits_no_memory_is_refused_before_it_takes_any() {
    let place = tempfile::tempdir().unwrap();
    let run = place.path().join("run");
    let (case, out) = (quarter_impact(), run.to_str().unwrap());
    let huge = ["run", &case, "--set", "spacing=0.0006mm", "--out", out];
    let said = complaint_alone(&huge);
    assert!(said.starts_with("error: a rank takes about "), "{said}");
    assert!(
        said.contains(" GB of memory are free") && said.contains("--ignore-memory"),
        "{said}"
    );
    assert!(!run.exists());
}

/// Whatever words, paths and names hold, a terminal shows it and does nothing else.
#[test]
fn no_control_character_reaches_the_terminal() {
    let place = tempfile::tempdir().unwrap();
    let escape = "\u{1b}[2J\u{1b}]0;x\u{7}\u{9b}1m\u{202e}";
    let case = quarter_impact();
    let at = |name: &str| place.path().join(name).to_str().unwrap().to_owned();
    let nowhere = at(&format!("no{escape}where"));
    fs::create_dir(at(&format!("folder{escape}"))).unwrap();
    let sound = fs::read_to_string(project("inputs/quarter-impact/case.toml")).unwrap();
    let wrong = at(&format!("folder{escape}/case.toml"));
    fs::write(&wrong, sound.replace("\"aluminium\"", "\"tin\\u001b[31m\"")).unwrap();
    let option = format!("--op{escape}tion");
    let set = format!("spacing=1 m{escape}m");
    let key = format!("spa{escape}cing=1 mm");
    for arguments in [
        &["check", &nowhere][..],
        &["check", &wrong],
        &["check", &case, &option],
        &["check", &case, "--set", &set],
        &["check", &case, "--set", &key],
        &["info", &nowhere],
        &["plot", &nowhere],
        &["compare", &nowhere, &nowhere],
        &["materials", &nowhere],
    ] {
        let ended = end(command(WHIPPLE).args(arguments)).with_code(2);
        let all = ended.stdout + &ended.stderr;
        assert!(!all.is_empty(), "{arguments:?}");
        let hostile = |c: char| c != '\n' && (c.is_control() || c == '\u{202e}');
        assert!(!all.contains(hostile), "{arguments:?}: {all:?}");
    }
}

/// A thread is started for a case that can be run alone.
#[test]
fn the_case_is_read_before_threads_are_started() {
    let many = ["-t", "60000"];
    let said = complaint_alone(&[&["run", "nowhere.toml"][..], &many].concat());
    assert!(said.starts_with("error: cannot read the case"), "{said}");
    let case = quarter_impact();
    let set = ["--set", "sph.alpha=-1"];
    let said = complaint_alone(&[&["run", &case][..], &set, &many].concat());
    assert!(said.starts_with("error: `alpha` must be"), "{said}");
}

/// A body whose particles are looked at as the case is read: its filling is fitted, and what it begins with varies.
#[test]
fn what_varies_leaves_the_threads_to_the_run() {
    let place = tempfile::tempdir().unwrap();
    let mut run = coarse_run(1, &place.path().join("run"));
    run.args(["--until", "0us", "-t", "1", "--set", "symmetry=[]"]);
    run.args(["--set", "body.sphere.lattice=glass"]);
    run.args([
        "--set",
        "body.sphere.velocity=[0, 0, \"-7 km/s * (1 + x / 1 m)\"]",
    ]);
    let ended = end(&mut run).with_code(0);
    assert!(
        ended.complaints("warning: rank 0 cannot start").is_empty(),
        "{ended:#?}"
    );
    assert!(ended.stdout.contains("1 thread"), "{ended:#?}");
}

#[test]
fn more_threads_than_cores_are_told() {
    let place = tempfile::tempdir().unwrap();
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let mut run = coarse_run(2, &place.path().join("run"));
    let ended = end(run.args(["--until", "0us", "-t", &(cores + 1).to_string()])).with_code(0);
    let warned = ended.complaints("warning: each rank has ");
    assert_eq!(warned.len(), 1, "{ended:#?}");
}

/// Changes a byte in the middle of a file.
fn damage(path: &Path) {
    let mut bytes = fs::read(path).unwrap();
    let middle = bytes.len() / 2;
    bytes[middle] ^= 1;
    fs::write(path, bytes).unwrap();
}

#[test]
fn what_cannot_be_restarted_is_left_alone() {
    let place = tempfile::tempdir().unwrap();
    let run = place.path().join("run");
    let out = run.to_str().unwrap();
    end(coarse_run(2, &run).args(["--until", "0.12us"])).with_code(0);
    let before = status(&run);

    for key in ["sph.alpha", "spacing", "body.sphere.velocity"] {
        let said = complaint_alone(&["restart", out, "--set", &format!("{key}=2")]);
        let section = key.split('.').next().unwrap();
        let begin = format!("error: `{section}` cannot change on a restart\n --> --set:1:1\n");
        assert!(said.starts_with(&begin), "{said}");
    }
    let said = complaint_alone(&["restart", out, "--set", "run.end_tme=1us"]);
    assert!(said.contains("did you mean `end_time`?"), "{said}");
    let said = complaint_alone(&["restart", out, "--set", "output.fields=[\"presure\"]"]);
    assert!(said.contains("presure"), "{said}");

    let mut checkpoints: Vec<_> = fs::read_dir(run.join("checkpoints"))
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .collect();
    checkpoints.sort();
    let [.., older, newest] = &checkpoints[..] else {
        panic!("{checkpoints:?}");
    };
    let manifest = fs::read_to_string(newest.join("manifest.json")).unwrap();
    fs::write(
        newest.join("manifest.json"),
        manifest.replace("\"format\": 3", "\"format\": 99"),
    )
    .unwrap();
    let said = complaint_alone(&["restart", out]);
    assert!(
        said.contains("has format 99, this program reads format 3"),
        "{said}"
    );
    fs::write(newest.join("manifest.json"), manifest).unwrap();
    damage(&newest.join("state.h5"));
    let named = newest.to_str().unwrap();
    let said = complaint_alone(&["restart", named]);
    assert!(
        said.contains("is damaged") && said.contains("older checkpoint"),
        "{said}"
    );
    fs::remove_file(newest.join("state.h5")).unwrap();
    let said = complaint_alone(&["restart", named]);
    assert!(
        said.contains("state.h5 is damaged: it is missing"),
        "{said}"
    );
    assert_eq!(status(&run), before);

    end(ranks(2).arg("restart").arg(older)).with_code(0);
    assert_eq!(status(&run).0, "finished");
    fs::remove_dir_all(run.join("checkpoints")).unwrap();
    let said = complaint_alone(&["restart", out]);
    assert!(said.contains("has no checkpoint to restart from"), "{said}");
}

/// Names of bytes that are no text would mangle the folder of a run.
#[test]
fn a_case_with_a_name_that_is_no_text_is_refused() {
    use std::ffi::OsStr;
    use std::os::unix::ffi::OsStrExt;
    let place = tempfile::tempdir().unwrap();
    let name = |bytes: &[u8]| place.path().join(OsStr::from_bytes(bytes));
    let (file, folder) = (name(b"caf\xe9.toml"), name(b"\xe9tude"));
    let case = project("inputs/quarter-impact/case.toml");
    fs::copy(&case, &file).unwrap();
    fs::create_dir(&folder).unwrap();
    fs::copy(&case, folder.join("case.toml")).unwrap();
    for case in [&file, &folder] {
        for words in [
            &["run"][..],
            &["check"],
            &["check", "--json"],
            &["plan"],
            &["sweep", "--vary", "sph.alpha=1,2"],
            &["new", "--from", "shield"],
        ] {
            if words[0] == "new" && *case == file {
                continue;
            }
            let mut command = command(WHIPPLE);
            command.current_dir(place.path());
            let ended = end(command.arg(words[0]).arg(case).args(&words[1..])).with_code(2);
            let said = ended.complaints("error:");
            assert_eq!(said.len(), 1, "{ended:#?}");
            assert!(said[0].contains("no UTF-8 text"), "{ended:#?}");
        }
    }
    let left: Vec<_> = fs::read_dir(place.path()).unwrap().collect();
    assert_eq!(left.len(), 2, "{left:?}");
}
