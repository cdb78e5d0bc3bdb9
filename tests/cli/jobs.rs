//! The scripts in `jobs/`: what they make of their arguments, with stand-ins for `mpirun` and
//! `qsub`.

use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::program::{Ended, WHIPPLE, command, end, project, quarter_impact};

/// Prints its arguments, one a line, in place of starting anything.
const MPIRUN: &str = "#!/bin/sh\nprintf '%s\\n' \"$@\"\n";

/// Parts the variables of `-v` at commas, as PBS does, and runs the script as the job that they
/// make: a copy in a folder of its own, in the user's home.
const QSUB: &str = r#"#!/bin/bash
[ "$1" = -v ] || exit 9
IFS=, read -ra variables <<<"$2"
cp "$3" "$SPOOL/job"
cd "$HOME" && env "${variables[@]}" PBS_JOBID=7 PBS_O_WORKDIR="$OLDPWD" bash "$SPOOL/job"
"#;

struct Machine {
    place: tempfile::TempDir,
}

impl Machine {
    fn new() -> Self {
        let place = tempfile::tempdir().unwrap();
        for folder in ["bin", "spool", "home"] {
            fs::create_dir(place.path().join(folder)).unwrap();
        }
        let machine = Self { place };
        machine.program("mpirun", MPIRUN);
        machine.program("qsub", QSUB);
        machine
    }

    fn at(&self, path: &str) -> PathBuf {
        self.place.path().join(path)
    }

    fn program(&self, name: &str, text: &str) {
        let path = self.at("bin").join(name);
        fs::write(&path, text).unwrap();
        fs::set_permissions(&path, fs::Permissions::from_mode(0o755)).unwrap();
    }

    /// A command that finds the stand-ins, with the project as its folder.
    fn command(&self, program: &str) -> Command {
        let mut command = command(program);
        let path = std::env::var("PATH").unwrap();
        command.env("PATH", format!("{}:{path}", self.at("bin").display()));
        command.env("SPOOL", self.at("spool"));
        command.env("HOME", self.at("home"));
        for name in [
            "WHIPPLE_ARGS",
            "SLURM_JOB_ID",
            "PBS_JOBID",
            "PBS_O_WORKDIR",
            "WHIPPLE_JOB",
        ] {
            command.env_remove(name);
        }
        command.current_dir(project("."));
        command
    }

    fn run(&self, arguments: &[&str]) -> Ended {
        end(self.command(&project("jobs/run.sh")).args(arguments))
    }

    fn submit(&self, script: &str, arguments: &str) -> Ended {
        let variable = format!("WHIPPLE_ARGS={arguments}");
        end(self.command("qsub").args(["-v", &variable, script]))
    }
}

/// What the program would be started with: all that follows it on the line of `mpirun`.
fn started(ended: &Ended) -> Vec<&str> {
    let words = ended
        .stdout
        .lines()
        .skip_while(|word| !word.ends_with("whipple"));
    words.skip(1).collect()
}

#[test]
fn numbers_of_ranks_and_threads_are_numbers() {
    let machine = Machine::new();
    let refused = |arguments: &[&str], said: &str| {
        for script in ["run.sh", "chain.sh"] {
            let mut command = machine.command(&project(&format!("jobs/{script}")));
            let ended = end(command.args(arguments).args(["case", "run"])).with_code(2);
            assert_eq!(ended.stderr.trim_end(), said, "{script}");
            assert_eq!(ended.stdout, "", "{script}");
        }
    };
    let said = |option: &str, value: &str| {
        format!("error: {option} takes a whole number from 1 on, not {value}")
    };
    for option in ["-n", "-t"] {
        for value in ["0", "abc", "-1", "1.5", "2x", "99999999"] {
            refused(&[option, value], &said(option, value));
        }
        refused(&[option, ""], &said(option, "''"));
        refused(&[option, "a\u{1b}[2J"], &said(option, "$'a\\E[2J'"));
    }
    let ended = machine.run(&["-n", "3", "-t", "2", "case"]).with_code(0);
    assert!(ended.stdout.starts_with("-n\n3\n"), "{ended:#?}");
    assert_eq!(started(&ended), ["run", "case", "--threads", "2"]);
}

#[test]
fn arguments_reach_a_job_of_pbs_as_they_are() {
    let machine = Machine::new();
    let simple = machine.submit(
        "jobs/run.sh",
        "-n 4 inputs/sod --out runs/* --set sph.alpha=1",
    );
    let words = [
        "run",
        "inputs/sod",
        "--out",
        "runs/*",
        "--set",
        "sph.alpha=1",
    ];
    assert_eq!(started(&simple.with_code(0))[..6], words);

    let velocity = "body.sphere.velocity=[0, 0, \"-5 km/s\"]";
    let arguments = [
        "restart",
        "runs/a b",
        "--set",
        velocity,
        "--set",
        "title=it's 'x'",
    ];
    fs::write(machine.at("arguments"), arguments.join("\n") + "\n").unwrap();
    let file = format!("@{}", machine.at("arguments").display());
    let ended = machine.submit("jobs/run.sh", &file).with_code(0);
    assert_eq!(started(&ended)[..6], arguments);

    let ended = machine.submit("jobs/run.sh", "@nowhere").with_code(2);
    assert!(
        ended.stderr.contains("names no file of arguments"),
        "{ended:#?}"
    );
    assert_eq!(machine.submit("jobs/run.sh", "").with_code(2).stdout, "");
}

/// Tells what it was asked for.
const LFS: &str = "#!/bin/sh\necho \"lfs $*\"\n[ \"$3\" != 7 ]\n";

#[test]
fn folders_of_new_runs_are_striped_where_that_is_asked_for() {
    let machine = Machine::new();
    let run = |stripes: &str, arguments: &[&str]| {
        let mut command = machine.command(&project("jobs/run.sh"));
        command.current_dir(machine.place.path());
        command.env("WHIPPLE_STRIPES", stripes).args(arguments);
        end(&mut command)
    };
    let ended = run("4", &["case"]).with_code(2);
    assert!(
        ended.stderr.contains("lfs cannot stripe runs/case"),
        "{ended:#?}"
    );
    assert!(!ended.stdout.contains("--threads"), "{ended:#?}");
    machine.program("lfs", LFS);
    for (arguments, folder) in [
        (&["inputs/sod"][..], "runs/sod"),
        (&["inputs/sod/"], "runs/sod"),
        (&["inputs/sod/case.toml"], "runs/sod"),
        (&["my.toml", "--set", "a=1"], "runs/my"),
        (&["inputs/sod", "--out", "else where"], "else where"),
        (&["inputs/sod", "-o", "there"], "there"),
        (&["inputs/sod", "--out=there", "--force"], "there"),
    ] {
        let ended = run("-1", arguments).with_code(0);
        let first = ended.stdout.lines().next().unwrap_or_default();
        assert_eq!(first, format!("lfs setstripe -c -1 {folder}"));
        assert!(machine.at(folder).is_dir());
        assert_eq!(started(&ended)[1], arguments[0]);
    }
    assert_eq!(run("7", &["case"]).with_code(2).stdout.lines().count(), 1);
    // What is there already, or not asked for, stays as it is.
    for (stripes, command) in [("4", "restart"), ("", "case")] {
        let ended = run(stripes, &[command, "runs/sod"]).with_code(0);
        assert!(!ended.stdout.contains("lfs"), "{ended:#?}");
    }
}

/// In place of `mpirun`: prints its arguments; the first leg of a run stops, and the second finishes.
fn two_legs(run: &Path) -> String {
    format!(
        "#!/bin/bash\nprintf '%s\\n' \"$@\"\nrun='{}'\nif [ -e \"$run/status.json\" ]\n\
         then echo '\"finished\"' >\"$run/status.json\"\n\
         else mkdir -p \"$run/checkpoints/step-00000001\"; echo '\"stopped\"' >\"$run/status.json\"; exit 75\nfi\n",
        run.display()
    )
}

/// The first leg stops, and the chain submits the second with the arguments of the first.
#[test]
fn a_chain_of_jobs_of_pbs_keeps_its_arguments() {
    let machine = Machine::new();
    let run = machine.at("a run");
    machine.program("mpirun", &two_legs(&run));
    let set = "output.fields=[\"pressure\", \"density\"]";
    let arguments = ["inputs/sod", run.to_str().unwrap(), "--set", set];
    fs::write(machine.at("arguments"), arguments.join("\n")).unwrap();
    let file = format!("@{}", machine.at("arguments").display());
    let ended = machine.submit("jobs/chain.sh", &file).with_code(0);
    let legs: Vec<&str> = ended.stdout.lines().collect();
    let has = |words: &[&str]| legs.windows(words.len()).any(|found| found == words);
    assert!(
        has(&["run", "inputs/sod", "--out", arguments[1], "--set", set]),
        "{ended:#?}"
    );
    let again = format!("--set={set}");
    assert!(has(&["restart", arguments[1], &again]), "{ended:#?}");
    assert_eq!(
        legs.last().copied(),
        Some(&*format!("{} is finished", arguments[1]))
    );
    assert!(Path::new(&run).join("chain.arguments").is_file());
}

/// Gives a job what the headers of its script ask for, as SLURM and PBS do, and runs a copy of it; tells its options.
const SBATCH: &str = r#"#!/bin/bash
header() { sed -n "s/^#SBATCH --$1=//p" "${!#}"; }
cd "$PLACE" && cp "${!#}" "$SPOOL/job"
printf '%s\n' "sbatch $*"
export SLURM_JOB_ID=7 SLURM_JOB_NAME=whipple SLURM_JOB_PARTITION=all SLURM_SUBMIT_DIR="$PWD"
export SLURM_JOB_NUM_NODES=$(header nodes "$@") SLURM_CPUS_PER_TASK=$(header cpus-per-task "$@")
export SLURM_NTASKS=$((SLURM_JOB_NUM_NODES * $(header ntasks-per-node "$@")))
exec bash "$SPOOL/job"
"#;
const QSUB_FILE: &str = r#"#!/bin/bash
[ $# = 1 ] || exit 9
printf '%s\n' "qsub $*"
asked=$(sed -n 's/^#PBS -l select=//p' "$1")
IFS=:= read -r nodes _ cores _ ranks _ OMP_NUM_THREADS _ <<<"$asked"
[ "$cores" = $((ranks * OMP_NUM_THREADS)) ] || exit 9
export OMP_NUM_THREADS PBS_JOBID=7 PBS_O_WORKDIR="$PWD" PBS_NODEFILE="$SPOOL/nodes"
for ((k = 0; k < nodes * ranks; k++)); do echo "node$((k / ranks))"; done >"$PBS_NODEFILE"
cp "$1" "$SPOOL/job" && cd "$HOME" && exec bash "$SPOOL/job"
"#;

/// The script that `whipple plan` writes runs under both schedulers until the run is at its end.
#[test]
fn a_planned_job_submits_itself_until_the_end() {
    for scheduler in ["sbatch", "qsub"] {
        let machine = Machine::new();
        let place = machine.place.path();
        std::os::unix::fs::symlink(project("jobs"), place.join("jobs")).unwrap();
        machine.program("mpirun", &two_legs(&place.join("runs/quarter-impact")));
        machine.program("sbatch", SBATCH);
        machine.program("qsub", QSUB_FILE);
        machine.program("squeue", "#!/bin/sh\necho 10:00\n");
        fs::write(machine.at("machine.toml"), "cores_per_node = 8.0\n").unwrap();
        let case = quarter_impact();
        let title = "title=\"it's here\"";
        let mut plan = command(WHIPPLE);
        plan.args(["plan", &case, "--set", "spacing=0.05mm", "--set", title]);
        plan.args([
            "--machine",
            "machine.toml",
            "--nodes=3",
            "--threads=4",
            "--job=a job",
        ]);
        end(plan.current_dir(place)).with_code(0);
        let mut submit = machine.command(scheduler);
        submit.env("PLACE", place).current_dir(place).arg("a job");
        let ended = end(&mut submit).with_code(0);
        let words: Vec<&str> = ended.stdout.lines().collect();
        let count = |sought: &[&str]| {
            let found = words.windows(sought.len()).filter(|words| *words == sought);
            found.count()
        };
        // Both legs alike.
        assert_eq!(
            count(&["-n", "6", "--map-by", "slot:PE=4"]),
            2,
            "{ended:#?}"
        );
        let stop = ["--walltime", "0:05:00", "--threads", "4"];
        assert_eq!(count(&stop), 2, "{ended:#?}");
        let run = "runs/quarter-impact";
        let first = [
            "run",
            &case,
            "--out",
            run,
            "--set",
            "spacing=0.05mm",
            "--set",
            title,
        ];
        assert_eq!(
            (count(&first), count(&["restart", run])),
            (1, 1),
            "{ended:#?}"
        );
        assert_eq!(words.last(), Some(&"runs/quarter-impact is finished"));
        let submitted = words.iter().filter(|word| word.starts_with(scheduler));
        let submitted: Vec<&&str> = submitted.collect();
        assert_eq!(submitted.len(), 2, "{ended:#?}");
        assert!(
            submitted.iter().all(|word| word.ends_with(" a job")),
            "{ended:#?}"
        );
    }
}
