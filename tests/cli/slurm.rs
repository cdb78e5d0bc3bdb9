//! The chain of jobs under a real SLURM: a cluster of one node, made of this machine for the test.
//!
//! It needs slurmctld, slurmd and sbatch (Debian's `slurm-wlm`), and is skipped with a message
//! where they are not.

use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use crate::program::{
    WHIPPLE, assert_same, command, end, project, quarter_impact, ranks, status, strike,
};

/// Longer than anything here takes on a busy machine.
const PATIENCE: Duration = Duration::from_secs(200);

/// Some 15,000 particles and 190 steps, a few seconds.
const CASE: [&str; 6] = [
    "--set",
    "spacing=0.03mm",
    "--set",
    "output.history_every=1",
    "--set",
    "output.checkpoint_every=0.05us",
];

/// The two daemons; they end with it.
struct Cluster {
    place: PathBuf,
    daemons: Vec<Child>,
}

fn installed(program: &str) -> bool {
    let found = Command::new("sh")
        .args(["-c", &format!("command -v {program}")])
        .stdout(Stdio::null())
        .status();
    found.is_ok_and(|status| status.success())
}

fn words(program: &str, arguments: &[&str]) -> String {
    let output = Command::new(program).args(arguments).output().unwrap();
    String::from_utf8_lossy(&output.stdout).trim().to_owned()
}

/// Two ports that nobody uses.
fn ports() -> [u16; 2] {
    let sockets = [(); 2].map(|()| std::net::TcpListener::bind("127.0.0.1:0").unwrap());
    sockets.map(|socket| socket.local_addr().unwrap().port())
}

impl Cluster {
    /// Starts a cluster in a folder; nothing without SLURM.
    fn start(place: &Path) -> Option<Self> {
        if !["slurmctld", "slurmd", "sbatch", "squeue"]
            .into_iter()
            .all(installed)
        {
            eprintln!("skipped: no SLURM here (apt-get install slurm-wlm)");
            return None;
        }
        let (host, user) = (words("hostname", &["-s"]), words("id", &["-un"]));
        let [ctld_port, d_port] = ports();
        let cores = std::thread::available_parallelism().map_or(1, usize::from);
        let at = place.display();
        let text = format!(
            "ClusterName=whipple\nSlurmctldHost={host}(127.0.0.1)\nSlurmUser={user}\nSlurmdUser={user}\n\
             AuthType=auth/none\nCredType=cred/none\nSlurmctldPort={ctld_port}\nSlurmdPort={d_port}\n\
             StateSaveLocation={at}/state\nSlurmdSpoolDir={at}/spool\nSlurmctldPidFile={at}/ctld.pid\n\
             SlurmdPidFile={at}/d.pid\nSlurmctldLogFile={at}/ctld.log\nSlurmdLogFile={at}/d.log\n\
             ProctrackType=proctrack/linuxproc\nTaskPlugin=task/none\nSwitchType=switch/none\n\
             MpiDefault=none\nReturnToService=2\nSelectType=select/cons_tres\n\
             JobAcctGatherType=jobacct_gather/none\nAccountingStorageType=accounting_storage/none\n\
             NodeName={host} NodeAddr=127.0.0.1 CPUs={cores} State=UNKNOWN\n\
             PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP\n"
        );
        std::fs::create_dir_all(place.join("state")).unwrap();
        std::fs::create_dir_all(place.join("spool")).unwrap();
        std::fs::write(place.join("slurm.conf"), text).unwrap();
        let mut cluster = Self {
            place: place.to_owned(),
            daemons: Vec::new(),
        };
        for daemon in [&["slurmctld", "-D"][..], &["slurmd", "-D", "-N", &host]] {
            let mut child = cluster.command(daemon[0]);
            child.args(&daemon[1..]);
            child.stdout(Stdio::null()).stderr(Stdio::null());
            cluster.daemons.push(child.spawn().unwrap());
        }
        cluster.until("a node that is idle", || {
            let said = cluster.command("sinfo").arg("-ho%T").output().unwrap();
            String::from_utf8_lossy(&said.stdout).trim() == "idle"
        });
        Some(cluster)
    }

    /// A command that finds this cluster.
    fn command(&self, program: &str) -> Command {
        let mut command = command(program);
        command.env("SLURM_CONF", self.place.join("slurm.conf"));
        command.current_dir(&self.place);
        command
    }

    fn until(&self, what: &str, there: impl Fn() -> bool) {
        let begun = Instant::now();
        while !there() {
            if begun.elapsed() > PATIENCE {
                let logs = ["ctld.log", "d.log"].map(|log| self.place.join(log));
                let logs = logs.map(|log| std::fs::read_to_string(log).unwrap_or_default());
                panic!("no {what}: {logs:#?}");
            }
            std::thread::sleep(Duration::from_millis(50));
        }
    }

    /// Submits the chain of a run, with a pause before a step; gives the number of the job.
    fn submit(&self, run: &Path, pause: u64) -> String {
        let mut sbatch = self.command("sbatch");
        strike(&mut sbatch, &format!("pause:0:{pause}"));
        sbatch.args(["--parsable", "--time=10", "--cpus-per-task=1"]);
        // As a user calls it: the shell's folder is the project's.
        sbatch.current_dir(project("."));
        sbatch.args(["--ntasks-per-node=2", "--open-mode=append"]);
        sbatch.arg(format!(
            "--output={}",
            self.place.join("first.log").display()
        ));
        sbatch.args(["jobs/chain.sh", &quarter_impact()]).arg(run);
        let ended = end(sbatch.args(CASE)).with_code(0);
        ended.stdout.trim().to_owned()
    }

    fn until_step(&self, run: &Path, step: u64) {
        let history = run.join("history.csv");
        self.until("such step", || {
            let text = std::fs::read_to_string(&history).unwrap_or_default();
            let last = text.lines().last().and_then(|line| line.split(',').next());
            last.and_then(|step| step.parse().ok()).unwrap_or(0) >= step
        });
    }

    /// Sends a signal to the script of a job.
    fn signal(&self, name: &str, job: &str) {
        let signal = format!("--signal={name}");
        end(self.command("scancel").args(["--batch", &signal, job])).with_code(0);
    }

    fn jobs(&self) -> usize {
        let said = self.command("squeue").args(["-h", "-oX"]).output().unwrap();
        String::from_utf8_lossy(&said.stdout).lines().count()
    }
}

impl Drop for Cluster {
    fn drop(&mut self) {
        let _ = self.command("scancel").args(["--state=RUNNING"]).output();
        let _ = self.command("scontrol").arg("shutdown").output();
        let begun = Instant::now();
        for daemon in &mut self.daemons {
            while !matches!(daemon.try_wait(), Ok(Some(_))) {
                if begun.elapsed() > Duration::from_secs(10) {
                    let _ = daemon.kill();
                }
                std::thread::sleep(Duration::from_millis(20));
            }
        }
    }
}

#[test]
#[cfg_attr(not(debug_assertions), ignore = "needs debug assertions")]
fn a_chain_of_jobs_goes_on_until_the_end_with_the_bits_of_one_run() {
    let place = tempfile::tempdir().unwrap();
    let Some(cluster) = Cluster::start(&place.path().join("slurm")) else {
        return;
    };
    let run = place.path().join("run");

    // Asked to end by hand: the leg stops softly, and there is no next one.
    let job = cluster.submit(&run, 20);
    cluster.until_step(&run, 19);
    cluster.signal("TERM", &job);
    cluster.until("end of the chain", || cluster.jobs() == 0);
    let (state, first, reason) = status(&run);
    assert_eq!(
        (&state[..], &reason[..]),
        ("stopped", "a signal asked to stop")
    );

    // Taken up again; what the scheduler sends before a job's time is up ends a leg alone.
    let job = cluster.submit(&run, 60);
    cluster.until_step(&run, 59);
    cluster.signal("USR1", &job);
    cluster.until("the end of the case", || status(&run).0 == "finished");
    cluster.until("end of the chain", || cluster.jobs() == 0);
    let log = std::fs::read_to_string(run.join("log.txt")).unwrap();
    let starts: Vec<&str> = log
        .lines()
        .filter(|line| line.contains(" particles, "))
        .collect();
    assert_eq!(starts.len(), 3, "{log}");
    assert!(starts[1].contains(&format!("step-{first:08}")), "{log}");
    // The next job has what the first was given and not what the headers ask for.
    assert!(
        starts
            .iter()
            .all(|line| line.contains("2 ranks with 1 thread")),
        "{log}"
    );

    let reference = place.path().join("reference");
    let mut untouched = ranks(2);
    untouched
        .args(["run", &quarter_impact(), "--out"])
        .arg(&reference);
    end(untouched.args(CASE)).with_code(0);
    assert_same(&run, &reference);
    // Where the job after that left its output.
    let next = job.parse::<u32>().unwrap() + 1;
    std::fs::remove_file(project(&format!("slurm-{next}.out"))).unwrap();
}

/// The script that `whipple plan` writes asks SLURM for its layout, each time that it submits itself.
#[test]
#[cfg_attr(not(debug_assertions), ignore = "needs debug assertions")]
fn a_planned_job_submits_itself() {
    let place = tempfile::tempdir().unwrap();
    let place = place.path();
    let Some(cluster) = Cluster::start(&place.join("slurm")) else {
        return;
    };
    std::os::unix::fs::symlink(project("jobs"), place.join("jobs")).unwrap();
    std::fs::write(place.join("machine.toml"), "cores_per_node = 2.0\n").unwrap();
    let mut plan = command(WHIPPLE);
    plan.args(["plan", &quarter_impact(), "--nodes=1", "--threads=1"]);
    plan.args(["--machine=machine.toml", "--job=its job"]);
    plan.args(["--set=spacing=0.05mm", "--set=output.history_every=1"]);
    plan.arg("--set=run.max_steps=8");
    end(plan.current_dir(place)).with_code(0);

    let mut sbatch = cluster.command("sbatch");
    strike(&mut sbatch, "pause:0:4");
    sbatch.current_dir(place).args(["--parsable", "its job"]);
    let job = end(&mut sbatch).with_code(0).stdout.trim().to_owned();
    let run = place.join("runs/quarter-impact");
    cluster.until_step(&run, 3);
    cluster.signal("USR1", &job);
    cluster.until("the end of the case", || status(&run).0 == "finished");
    cluster.until("end of the chain", || cluster.jobs() == 0);
    let log = std::fs::read_to_string(run.join("log.txt")).unwrap();
    let starts = log.lines().filter(|line| line.contains(" particles, "));
    let starts: Vec<&str> = starts.collect();
    let layout = |line: &&str| line.contains("2 ranks with 1 thread");
    assert!(starts.len() == 2 && starts.iter().all(layout), "{log}");
}
