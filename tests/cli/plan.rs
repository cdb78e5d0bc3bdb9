//! `whipple plan`: its table, its files, what it refuses.

use std::fs;
use std::path::Path;
use std::process::Command;

use crate::program::{WHIPPLE, command, end, quarter_impact};
use files::plan::{CONSTANTS, Machine, Terms};

const COARSE: [&str; 2] = ["--set", "spacing=0.05mm"];

fn plan(path: &str, more: &[&str]) -> Command {
    let mut plan = command(WHIPPLE);
    plan.args(["plan", path]).args(more);
    plan
}

/// The cells of the lines of the table that are of so many ranks.
fn rows(said: &str, ranks: &str) -> Vec<Vec<String>> {
    let cells = said
        .lines()
        .map(|line| line.split_whitespace().map(str::to_owned));
    let cells = cells.map(Iterator::collect::<Vec<String>>);
    cells
        .filter(|row| {
            row.len() > 10 && row[0] == ranks && row[1].trim_start_matches('*').len() == 1
        })
        .collect()
}

#[test]
fn levels_are_compared_for_each_number_of_ranks() {
    let folder = tempfile::tempdir().unwrap();
    let [csv, chart] = ["plan.csv", "plan.svg"].map(|name| folder.path().join(name));
    let files = [
        "--csv",
        csv.to_str().unwrap(),
        "--chart",
        chart.to_str().unwrap(),
    ];
    let more = [
        &COARSE[..],
        &["--ranks", "1,8,64", "--doubled", "--terms"],
        &files,
    ]
    .concat();
    let said = end(&mut plan(&quarter_impact(), &more)).with_code(0).stdout;
    assert_eq!(rows(&said, "1").len(), 1, "{said}");
    for ranks in ["8", "64"] {
        let rows = rows(&said, ranks);
        let levels: Vec<&str> = rows
            .iter()
            .map(|row| row[1].trim_start_matches('*'))
            .collect();
        assert_eq!(levels, ["1", "2", "3"], "{said}");
        // Those of the case itself.
        assert_eq!(
            rows.iter().filter(|row| row[1].starts_with('*')).count(),
            1,
            "{said}"
        );
    }
    for constant in &CONSTANTS {
        assert!(said.contains(&format!("2 x {} ", constant.key)), "{said}");
    }
    for (term, _) in Terms::default().named() {
        assert!(said.contains(&format!("  {term} ")), "{said}");
    }
    let table = fs::read_to_string(csv).unwrap();
    // Names, units, and seven rows.
    assert_eq!(table.lines().count(), 9, "{table}");
    let chart = fs::read_to_string(chart).unwrap();
    assert!(chart.starts_with("<svg ") && chart.contains(">strong, 3 levels</text>"));
}

/// A run, a snapshot and a checkpoint are planned from the particles that they hold.
#[test]
fn later_states_are_planned_too() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("run");
    let mut run = command(WHIPPLE);
    run.args(["run", &quarter_impact(), "--out", out.to_str().unwrap()]);
    run.args(COARSE).args(["--set", "run.max_steps=3"]);
    end(&mut run).with_code(0);
    let start = end(&mut plan(&quarter_impact(), &COARSE))
        .with_code(0)
        .stdout;
    let count = start.split(" particles").next().unwrap();
    let count = count.split_whitespace().last().unwrap();
    let last = |folder: &str| -> String {
        let entries = fs::read_dir(out.join(folder)).unwrap();
        let paths = entries.map(|entry| entry.unwrap().path());
        let named = paths.filter(|path| path.to_string_lossy().contains("step-00000003"));
        named.last().unwrap().to_string_lossy().into_owned()
    };
    let places = [
        out.to_string_lossy().into_owned(),
        last("snapshots"),
        last("checkpoints"),
    ];
    for place in places {
        let said = end(&mut plan(&place, &["--ranks", "4"]))
            .with_code(0)
            .stdout;
        assert!(said.contains(&format!("{count} particles at ")), "{said}");
        assert_eq!(rows(&said, "4").len(), 3, "{said}");
    }
    // A job goes on with a run, not with one of its states.
    let job = folder.path().join("job");
    let job = [
        "--nodes",
        "1",
        "--threads",
        "128",
        "--job",
        job.to_str().unwrap(),
    ];
    end(&mut plan(out.to_str().unwrap(), &job)).with_code(0);
    let text = fs::read_to_string(job[5]).unwrap();
    let again = format!("exec jobs/chain.sh {0} {0} --walltime", out.display());
    assert!(text.contains(&again), "{text}");
    for place in ["snapshots", "checkpoints"].map(last) {
        assert!(refusal(&place, &job).contains("--job takes a case"));
    }
}

fn refusal(path: &str, more: &[&str]) -> String {
    end(&mut plan(path, more)).with_code(2).stderr
}

#[test]
fn what_is_no_machine_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("machine.toml");
    let path = file.to_str().unwrap();
    let ranks = [&COARSE[..], &["--ranks", "2", "--machine", path]].concat();
    for (bytes, what) in [
        (&b"latency = -1.0"[..], "latency is -1"),
        (b"bandwidth = nan", "bandwidth is NaN"),
        (b"overlap = 2.0", "overlap is 2"),
        (b"cores_per_node = 0.5", "cores_per_node is 0.5"),
        (b"latency = \"fast\"", "latency"),
        (b"memory_per_node = 0.0", "memory_per_node is 0"),
        (b"longest_job = inf", "longest_job is inf"),
        (b"speed = 1.0", "speed"),
        (b"latency = ", "latency"),
        (b"\xff\xfe", "no text"),
    ] {
        fs::write(&file, bytes).unwrap();
        let said = refusal(&quarter_impact(), &ranks);
        assert!(said.contains(what) && said.contains(path), "{said}");
    }
    fs::remove_file(&file).unwrap();
    assert!(refusal(&quarter_impact(), &ranks).contains(path));
    assert!(refusal("/no/such/case", &[]).contains("/no/such/case"));
    assert!(refusal(Path::new(WHIPPLE).to_str().unwrap(), &[]).contains("error"));
    assert!(refusal(&quarter_impact(), &["--chart", "plan.pdf"]).contains("pdf"));
}

/// A machine of 8 cores a node; 3,056 particles are enough for three ranks.
fn small_nodes(folder: &Path, more: &str) -> String {
    let file = folder.join("machine.toml");
    fs::write(&file, format!("cores_per_node = 8.0\n{more}")).unwrap();
    file.to_str().unwrap().to_owned()
}

#[test]
fn ranks_and_threads_are_compared_for_each_number_of_nodes() {
    let folder = tempfile::tempdir().unwrap();
    let machine = small_nodes(folder.path(), "");
    let csv = folder.path().join("plan.csv");
    let nodes = |nodes: &str, more: &[&str]| {
        let all = ["--machine", &machine, "--nodes", nodes];
        let all = [&COARSE[..], &all, more].concat();
        let said = end(&mut plan(&quarter_impact(), &all)).with_code(0).stdout;
        let lines = said.lines().filter(|line| line.contains(" x "));
        let layouts = lines.map(|line| line.split_whitespace().take(5).collect::<String>());
        layouts.skip(1).collect::<Vec<String>>()
    };
    let layouts = nodes("1,2", &["--csv", csv.to_str().unwrap()]);
    let plain: Vec<&str> = layouts.iter().map(|l| l.trim_start_matches('*')).collect();
    assert_eq!(plain, ["1x2x4", "1x1x8", "2x1x8"]);
    let table = fs::read_to_string(csv).unwrap();
    let head: Vec<&str> = table.lines().nth(1).unwrap().split(',').collect();
    let column = |name: &str| head.iter().position(|held| *held == name).unwrap();
    let value = |row: &str, name: &str| -> f64 {
        let cell = row.split(',').nth(column(name)).unwrap();
        cell.parse().unwrap()
    };
    let rows: Vec<&str> = table.lines().skip(2).collect();
    let times: Vec<f64> = rows.iter().map(|row| value(row, "step_time")).collect();
    let starred: Vec<bool> = layouts.iter().map(|l| l.starts_with('*')).collect();
    let first = times[0] <= times[1];
    assert_eq!(starred, [first, !first, true], "{times:?}");
    assert!((value(rows[0], "threads") - 4.0).abs() < 1e-9);
    assert!((value(rows[0], "ranks_per_node") - 2.0).abs() < 1e-9);
    // What is asked for is all that there is.
    assert_eq!(nodes("1", &["--threads", "2"]), ["*1x4x2"]);
    assert_eq!(nodes("3", &["--ranks-per-node", "2"]), ["*3x2x4"]);
    let both = ["--ranks-per-node", "3", "--threads", "1"];
    assert_eq!(nodes("1", &both), ["*1x3x1"]);
}

#[test]
fn a_job_asks_for_the_layout_and_names_itself() {
    let folder = tempfile::tempdir().unwrap();
    let machine = small_nodes(folder.path(), "memory_per_node = 4294967296.0\n");
    let title = "title=\"it's \\\"here\\\"\"";
    let more = ["--machine", &machine, "--nodes", "2", "--threads", "4"];
    let more = [&COARSE[..], &["--set", title, "--job", "a job"], &more].concat();
    let mut planned = plan(&quarter_impact(), &more);
    let said = end(planned.current_dir(folder.path())).with_code(0).stdout;
    let told =
        "2 nodes of 2 ranks of 4 threads, for 0:10:00; submit it: sbatch 'a job', or qsub 'a job'";
    assert!(said.contains(told), "{said}");
    let text = fs::read_to_string(folder.path().join("a job")).unwrap();
    for line in [
        "#SBATCH --nodes=2",
        "#SBATCH --ntasks-per-node=2",
        "#SBATCH --cpus-per-task=4",
        "#SBATCH --mem=4096M",
        "#SBATCH --time=0:10:00",
        "#PBS -l select=2:ncpus=8:mpiprocs=2:ompthreads=4:mem=4096mb",
        "#PBS -l walltime=0:10:00",
        "export WHIPPLE_JOB='a job'",
    ] {
        assert!(text.lines().any(|held| held == line), "{line}: {text}");
    }
    let last = text.lines().last().unwrap();
    let case = quarter_impact();
    let begins =
        format!("exec jobs/chain.sh {case} runs/quarter-impact --set spacing=0.05mm --set '");
    assert!(last.starts_with(&begins), "{last}");
    assert!(last.ends_with(" --walltime 0:05:00"), "{last}");
    // A shell gives the words back.
    let words = last.strip_prefix("exec jobs/chain.sh ").unwrap();
    let print = format!("set -- {words}; printf '%s' \"$6\"");
    let shell = end(command("sh").args(["-c", &print])).with_code(0);
    assert_eq!(shell.stdout, title);
}

fn joined<'a>(base: &[&'a str], more: &[&'a str]) -> Vec<&'a str> {
    [base, more].concat()
}

#[test]
fn layouts_that_do_not_fit_get_no_job() {
    let folder = tempfile::tempdir().unwrap();
    let job = folder.path().join("job");
    let job = job.to_str().unwrap();
    let machine = small_nodes(folder.path(), "memory_per_node = 60e6\n");
    let base = [&COARSE[..], &["--machine", &machine]].concat();
    // One rank of all particles fits, and two of them, each with MPI and HDF5, do not.
    let more = [&base[..], &["--nodes", "1", "--job", job]].concat();
    let said = end(&mut plan(&quarter_impact(), &more)).with_code(0).stdout;
    assert!(said.contains("a node has not the"), "{said}");
    assert!(said.contains("1 node of 1 rank of 8 threads"), "{said}");
    fs::remove_file(job).unwrap();
    let refused = |path: &str, more: &[&str], what: &str| {
        let said = refusal(path, &joined(&base, more));
        assert!(said.contains(what), "{said}");
        assert!(!Path::new(job).exists());
    };
    let case = quarter_impact();
    let on = |more: &[&'static str]| [&["--nodes", "1", "--job", job][..], more].concat();
    refused(&case, &on(&["--threads", "4"]), "memory_per_node is 60 MB");
    refused(&case, &on(&["--threads", "9"]), "more than the 8 cores");
    refused(
        &case,
        &["--nodes", "99999", "--ranks-per-node", "2"],
        "199998 ranks",
    );
    refused(&case, &["--job", job], "--nodes");
    refused(&case, &["--nodes", "0"], "0");
    refused(&case, &["--nodes", "1", "--ranks", "4"], "--ranks");
}

#[test]
fn a_machine_is_read_as_it_was_written() {
    let machine = Machine {
        name: "ours \"here\"".to_owned(),
        latency: 1.25e-6,
        ..Machine::default()
    };
    assert_eq!(Machine::parse(&machine.text()).unwrap(), machine);
    assert_eq!(Machine::parse("").unwrap(), Machine::default());
    for constant in &CONSTANTS {
        let mut doubled = machine.doubled(constant);
        let now = *constant.of(&mut doubled);
        let mut before = machine.clone();
        assert_eq!(now.to_bits(), (2.0 * *constant.of(&mut before)).to_bits());
    }
}

/// What a run will take is told before it: time and disk.
#[test]
fn a_check_tells_time_and_disk() {
    let mut check = command(WHIPPLE);
    check
        .args(["check", &quarter_impact(), "--ranks", "8"])
        .args(COARSE);
    let said = end(&mut check).with_code(0).stdout;
    assert!(said.contains(" on 8 ranks of one core of "), "{said}");
    assert!(said.contains(" on the disk at the end"), "{said}");
}
