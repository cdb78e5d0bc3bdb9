//! The commands that look at things, which need no MPI: `check`, `info`, `plot`, `compare`, help.

use std::path::Path;
use std::process::Command;

use crate::program::{Ended, WHIPPLE, coarse_run, command, end, quarter_impact, ranks};

/// The program where MPI cannot start.
fn without_mpi() -> Command {
    let mut command = command(WHIPPLE);
    command
        .env("OMPI_MCA_pml", "nonsense")
        .env("OMPI_COMM_WORLD_LOCAL_SIZE", "nonsense");
    command
}

#[track_caller]
fn output(arguments: &[&str]) -> String {
    let ended = end(without_mpi().args(arguments)).with_code(0);
    assert_eq!(ended.stderr, "", "{ended:#?}");
    ended.stdout
}

/// What `info` says, line by line, with single spaces.
#[track_caller]
fn info(path: &Path) -> Vec<String> {
    let said = output(&["info", text(path)]);
    let words = said
        .lines()
        .map(|line| line.split_whitespace().collect::<Vec<_>>());
    words.map(|words| words.join(" ")).collect()
}

fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}

#[test]
fn check_says_what_a_case_costs() {
    let check = ["check", &quarter_impact(), "--set", "spacing=0.05mm"];
    let ended = end(without_mpi().args(check)).with_code(0);
    let thin = "warning: `plate` has 4.0 particles across its thinnest part";
    assert_eq!(ended.complaints(thin).len(), 1, "{ended:#?}");
    assert_eq!(ended.stderr.lines().count(), 1, "{ended:#?}");
    let said = ended.stdout;
    let expected = "\
Aluminium sphere at 7 km/s on an aluminium plate (3-D)
  plate                  2828 particles of aluminium, spacing 0.05 mm, h 0.065 mm, 9.843e-7 kg (each 0.02 % less than its cell)
  sphere                  228 particles of aluminium, spacing 0.05 mm, h 0.065 mm, 7.8744e-8 kg (each 0.79 % less than its cell)
                   begins with velocity [0, 0, -7] km/s
  all                    3056 particles, about 50 MB a rank on 1 rank
  measures: plate, plate-debris
  about 63 steps to 0.2 us
  about 0.2 s on 1 rank of one core of an ordinary cluster (`whipple plan` tells more)
  about 11 MB on the disk at the end
can run, with 1 warning
";
    assert_eq!(said, expected);
    let check = ["check", &quarter_impact()];
    let ended = end(without_mpi().args(check)).with_code(0);
    assert_eq!(ended.stdout.lines().last(), Some("sound"), "{ended:#?}");

    // What is doubtful is said, and said by a run, too.
    let set = [
        "--set",
        "spacing=0.05mm",
        "--set",
        "symmetry=[{ axis = \"x\", position = \"0.0125mm\" }]",
    ];
    let doubt = "warning: the lattice of `plate` is not its own mirror image";
    let ended = end(without_mpi().args(["check", &quarter_impact()]).args(set)).with_code(0);
    assert_eq!(ended.complaints(doubt).len(), 1, "{ended:#?}");
    let place = tempfile::tempdir().unwrap();
    let run = place.path().join("run");
    let mut command = ranks(2);
    command.args(["run", &quarter_impact()]).args(set);
    let ended = end(command.args(["--until", "0us", "--out", text(&run)])).with_code(0);
    assert_eq!(ended.complaints(doubt).len(), 1, "{ended:#?}");
    let log = std::fs::read_to_string(run.join("log.txt")).unwrap();
    assert!(log.contains(doubt), "{log}");
}

#[test]
fn results_are_looked_at_without_mpi() {
    let place = tempfile::tempdir().unwrap();
    let [a, b, c] = ["a", "b", "c"].map(|name| place.path().join(name));
    let short = ["--set", "run.max_steps=12"];
    end(coarse_run(2, &a).args(short)).with_code(0);
    end(coarse_run(1, &b).args(short)).with_code(0);
    end(coarse_run(1, &c)
        .args(short)
        .args(["--set", "sph.alpha=1.1"]))
    .with_code(0);

    // MPI cannot start there indeed.
    let d = place.path().join("d");
    let ended = end(without_mpi().args(["run", &quarter_impact(), "--out", text(&d)]));
    assert!(
        !matches!(ended.code, Some(0 | 2)) && !d.exists(),
        "{ended:#?}"
    );

    let said = info(&a);
    for line in ["state finished", "step 12", "particles 3056"] {
        assert!(said.iter().any(|said| said == line), "{said:#?}");
    }
    let said = info(&a.join("snapshots/step-00000012.vtkhdf"));
    for begin in ["step 12", "particles 3056", "density kg/m^3 "] {
        assert!(said.iter().any(|line| line.starts_with(begin)), "{said:#?}");
    }
    let said = info(&a.join("checkpoints/step-00000012"));
    for begin in ["step 12", "ranks 2", "density kg/m^3 "] {
        assert!(said.iter().any(|line| line.starts_with(begin)), "{said:#?}");
    }
    // A closed pipe ends it without a word.
    let line = format!("{{ sleep 0.3; {WHIPPLE} info {}; }} | true", a.display());
    let ended = end(command("sh").args(["-c", &line])).with_code(0);
    assert_eq!(ended.stderr, "");

    let said = output(&["compare", text(&a), text(&b)]);
    assert!(said.lines().last().unwrap().starts_with("same: "), "{said}");
    let ended = end(without_mpi().args(["compare", text(&a), text(&c)])).with_code(1);
    assert!(ended.stdout.contains("sph.alpha"), "{ended:#?}");
    assert!(
        ended
            .stdout
            .lines()
            .last()
            .unwrap()
            .starts_with("different: "),
        "{ended:#?}"
    );

    let said = output(&["plot", text(&a), "--field", "pressure", "--out", text(&d)]);
    let picture = d.join("step-00000012-pressure.png");
    assert_eq!(said, format!("wrote {}\n", picture.display()));
    assert!(std::fs::read(&picture).unwrap().starts_with(b"\x89PNG"));
    output(&["plot", text(&a), "--history"]);
    assert!(a.join("pictures/history.png").is_file());
    for (history, name) in [
        ("time-step", ">sound</text>"),
        ("momentum", "kg m/s"),
        ("defect", ">of contact</text>"),
        ("load", ">work</text>"),
        ("ranks", ">work over the mean</text>"),
    ] {
        let option = format!("--history={history}");
        output(&["plot", text(&a), &option, "--format", "svg"]);
        let picture = a.join(format!("pictures/history-{history}.svg"));
        let picture = std::fs::read_to_string(picture).unwrap();
        assert!(picture.contains(name), "{picture}");
    }
    output(&[
        "plot",
        text(&a),
        "--history=load",
        "--with",
        text(&b),
        "--csv",
    ]);
    let table = std::fs::read_to_string(a.join("pictures/history-load.csv")).unwrap();
    assert!(table.contains("\nb: work,"), "{table}");
}

#[test]
fn what_is_no_result_is_an_input_error() {
    for arguments in [
        &["check", "nowhere"][..],
        &["info", "nowhere"],
        &["plot", "nowhere"],
        &["export", "nowhere", "--to", "csv"],
        &["compare", "nowhere", "nowhere"],
        &["info", "/"],
        &["plot", "/"],
        &["compare", "/", "/"],
        &["info", WHIPPLE],
        &["plot", WHIPPLE],
        &["export", WHIPPLE, "--to", "csv"],
    ] {
        let ended = end(without_mpi().args(arguments)).with_code(2);
        assert_eq!(ended.complaints("error: ").len(), 1, "{ended:#?}");
        assert_eq!(
            (ended.stdout.as_str(), ended.stderr.lines().count()),
            ("", 1),
            "{ended:#?}"
        );
    }
}

#[test]
fn help_says_how_to_use_each_command() {
    let Ended { stdout, .. } = end(without_mpi().arg("--help")).with_code(0);
    for word in ["mpirun -n 2 whipple run", "75", "restart", "compare"] {
        assert!(stdout.contains(word), "{stdout}");
    }
    for name in [
        "run", "restart", "check", "info", "plot", "export", "compare",
    ] {
        let help = output(&[name, "--help"]);
        assert!(
            help.contains("Examples:\n") && help.contains(&format!("whipple {name} ")),
            "{help}"
        );
        let wide = help.lines().find(|line| line.chars().count() > 100);
        assert_eq!(wide, None);
        assert!(!help.contains("poison"), "{help}");
    }
}
