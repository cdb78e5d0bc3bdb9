//! Every contact mode on the same problems: the tables of the book's page on choosing a contact,
//! which `make contact-lab` writes. Reported; the bounds stand in the tests of each problem.

use engine::step::measurements;
use std::collections::BTreeMap;
use std::sync::Mutex;
use std::thread;

use crate::physics_support::bars::{STEP, in_one_piece, in_order};
use comm::Comm;
use engine::step::Simulation;
use files::input;
use model::Case;
use rayon::ThreadPoolBuilder;

/// Names of the modes and what each changes.
const MODES: &[(&str, &[&str])] = &[
    ("`overlap`", &["contact.mode=overlap"]),
    (
        "`overlap`, normalised",
        &["contact.mode=overlap", "sph.form=normalised"],
    ),
    ("`potential`", &["contact.mode=potential"]),
    (
        "`potential`, k = .03",
        &["contact.mode=potential", "contact.potential.stiffness=0.03"],
    ),
    ("`penalty`", &["contact.mode=penalty"]),
    ("`kernel`", &["contact.mode=kernel"]),
];

/// A problem: its input, what it changes there, when it ends (s), and what its answer is off by
/// (%).
struct Problem {
    name: &'static str,
    input: &'static str,
    changes: &'static [&'static str],
    end: f64,
    error: fn(&Simulation, &Run) -> Option<f64>,
}

const EDGES: &[&str] = &[
    r#"body.below.shape={ box = { lower = ["-8 spacing", "-1 spacing", "-8 spacing"], upper = ["8 spacing", "1 spacing", 0] } }"#,
    r#"body.above.shape={ box = { lower = ["-1 spacing", "-8 spacing", 0], upper = ["1 spacing", "8 spacing", "8 spacing"] } }"#,
];

const PROBLEMS: &[Problem] = &[
    problem("wave", "wave-step", &[], 1.0, wave),
    problem("pulse", "wave-pulse", &[], 1.0, wave),
    problem("bars", "bar-impact", &[], 1.0, rebound),
    problem("block", "block-impact", &[], 2e-6, plateau),
    problem("sliding", "sliding-block", &[], 0.5e-3, none),
    problem("sliding, 30°", "sliding-block", &[TURNED], 0.5e-3, none),
    problem("dam", "dam-break", &["spacing=\"0.73 cm\""], 0.3, arrivals),
    problem("quarter impact", "quarter-impact", COARSE, 1.0, finer_steps),
    problem(
        "oblique impact, 60°",
        "contact-lab/solid",
        OBLIQUE,
        1.0,
        finer_steps,
    ),
    problem("rings", "rubber-rings", RINGS, 3e-3, off_a_wall),
    problem("edge on edge", "contact-lab/solid", EDGES, 1.0, finer_steps),
    problem("seam", "contact-lab/seam-solid", &[], 1.0, seam),
];

const TURNED: &str = r#"body.block.lattice={ kind = "cubic", angle = "30 deg" }"#;
const COARSE: &[&str] = &["spacing=\"0.04 mm\""];
const RINGS: &[&str] = &["spacing=\"2 mm\""];
const OBLIQUE: &[&str] = &[r#"body.above.velocity=["6.062 km/s", 0, "-3.5 km/s"]"#];

const fn problem(
    name: &'static str,
    input: &'static str,
    changes: &'static [&'static str],
    end: f64,
    error: fn(&Simulation, &Run) -> Option<f64>,
) -> Problem {
    Problem {
        name,
        input,
        changes,
        end,
        error,
    }
}

/// What one mode did on one problem.
struct Run {
    problem: &'static Problem,
    /// What the mode changes.
    mode: &'static [&'static str],
    /// Of the answer, in %.
    error: Option<f64>,
    /// Largest change of energy and contact defect, over the first kinetic energy or the work put
    /// in.
    energy: f64,
    defect: f64,
    /// Mean and largest tangential force over the mean normal force.
    friction: Option<[f64; 2]>,
    closest: Option<f64>,
    steps: u64,
    limited: u64,
    /// Share of contact in the seconds of all phases.
    share: f64,
    /// What was read off on the way: times of the dam's front, mean stress over that of the axis.
    samples: Vec<f64>,
    /// Why it ended early.
    stopped: Option<String>,
}

impl Run {
    fn new(problem: &'static Problem, mode: &'static [&'static str]) -> Self {
        Self {
            problem,
            mode,
            error: None,
            energy: 0.0,
            defect: 0.0,
            friction: None,
            closest: None,
            steps: 0,
            limited: 0,
            share: 0.0,
            samples: Vec::new(),
            stopped: None,
        }
    }

    /// All figures in one line.
    fn line(&self, mode: &str) -> String {
        let name = self.problem.name;
        if let Some(why) = &self.stopped {
            return format!("{name}, {mode}: {}", why.lines().next().unwrap_or(""));
        }
        let [mean, largest] = self.friction.unwrap_or([f64::NAN; 2]);
        format!(
            "{name}, {mode}: error {:.2} %, energy {:.3} %, defect {:.3} %, friction {mean:.5} {largest:.4}, \
             closest {:.3}, {} steps, {} limited, share {:.1} %",
            self.error.unwrap_or(f64::NAN),
            self.energy,
            self.defect,
            self.closest.unwrap_or(f64::NAN),
            self.steps,
            self.limited,
            self.share,
        )
    }
}

/// The input `inputs/<name>/case.toml`, or `inputs/<name>.toml`.
fn load(name: &str, changes: &[&str]) -> Result<Case, String> {
    let inputs = crate::project::root().join("inputs");
    let folder = inputs.join(name).join("case.toml");
    let path = if folder.exists() {
        folder
    } else {
        inputs.join(name).with_extension("toml")
    };
    let changes: Vec<String> = changes.iter().map(ToString::to_string).collect();
    input::load(&path, &changes).map_err(|error| error.to_string())
}

/// Steps to the end, or to the first trouble.
fn advance(
    case: Case,
    end: f64,
    look: &mut dyn FnMut(&Simulation),
) -> (Simulation, Option<String>) {
    let comm = Comm::solo();
    let mut s = Simulation::start(case, &comm).expect("the case starts");
    while !s.is_finished() && s.state.time < end {
        if let Err(error) = s.advance(&comm) {
            return (s, Some(error.to_string()));
        }
        measurements::diagnose(&mut s, &comm);
        look(&s);
    }
    (s, None)
}

fn run(problem: &'static Problem, mode: &'static [&'static str]) -> Run {
    let mut run = Run::new(problem, mode);
    let case = match load(problem.input, &[problem.changes, mode].concat()) {
        Ok(case) => case,
        Err(error) => {
            run.stopped = Some(error);
            return run;
        }
    };
    let mut force = [0.0_f64; 4];
    let (s, stopped) = advance(case, problem.end, &mut |s| {
        if problem.name.starts_with("sliding") && s.state.time > 0.3e-3 {
            // Force of the block on the plate, once the load has settled.
            let [x, y, z] = s.state.pairs.first().map_or([0.0; 3], |pair| pair.force);
            let tangential = (x * x + y * y).sqrt();
            force = [
                force[0] + 1.0,
                force[1] + x,
                force[2] - z,
                force[3].max(tangential),
            ];
        }
        sample(problem, s, &mut run.samples);
    });
    if force[2] > 0.0 {
        run.friction = Some([force[1] / force[2], force[3] * force[0] / force[2]]);
    }
    let worst = &s.state.worst;
    (run.energy, run.defect) = (1e2 * worst.energy_error, 1e2 * worst.contact_defect);
    (run.closest, run.limited) = (worst.closest, worst.contact_limited_steps);
    run.steps = s.state.step;
    let seconds = |wanted: &str| -> f64 {
        let phases = s.timers.report().filter(|(name, _)| name.contains(wanted));
        phases.map(|(_, seconds)| seconds).sum()
    };
    run.share = 1e2 * seconds("contact") / seconds("");
    run.error = match stopped {
        None => (problem.error)(&s, &run),
        Some(_) => None,
    };
    run.stopped = stopped;
    run
}

/// What must be read off while a problem runs.
fn sample(problem: &Problem, s: &Simulation, samples: &mut Vec<f64>) {
    let particles = &s.particles;
    if problem.name == "block" && (0.6e-6..0.8e-6).contains(&s.state.time) {
        let near = |i: &usize| {
            particles.position[*i][0].abs() < 1e-3 && particles.position[*i][1].abs() < 0.8e-3
        };
        let chosen = (0..particles.owned()).filter(near);
        let stress = chosen.map(|i| particles.pressure[i] - particles.deviatoric_stress[i][1]);
        samples.push(mean(stress));
    }
    if problem.name == "dam" && s.state.step.is_multiple_of(10) {
        let spacing = s.case.bodies[0].lattice.spacing;
        let water = (0..particles.owned()).filter(|&i| particles.body[i] == 0);
        let points: Vec<[f64; 3]> = water.map(|i| particles.position[i]).collect();
        let front = plot::largest_reaches(&points, 0, spacing).unwrap_or(0.0);
        // Distance of the front over the column's width, and Martin & Moyce's time of it over
        // √(a/2g).
        let measured = [(2.0, 1.71), (3.0, 2.52), (4.0, 3.21)];
        if let Some((z, time)) = measured.get(samples.len())
            && front + 0.05 * spacing >= z * 0.146
        {
            samples.push(s.state.time / 0.086_26 / time);
        }
    }
}

fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, n) = values.fold((0.0, 0.0), |(sum, n), value| (sum + value, n + 1.0));
    sum / n
}

fn none(_: &Simulation, _: &Run) -> Option<f64> {
    None
}

/// Largest difference of velocity from the bar in one piece over that of the step, farther than
/// three spacings from the interface.
fn wave(s: &Simulation, run: &Run) -> Option<f64> {
    let whole = in_one_piece(load(run.problem.input, run.mode).ok()?);
    let (whole, _) = advance(whole, f64::INFINITY, &mut |_| {});
    let both = in_order(s).into_iter().zip(in_order(&whole)).enumerate();
    let away = both.filter(|(k, _)| !(47..53).contains(k));
    let off = |(a, b): (usize, usize)| {
        (s.particles.velocity[a][0] - whole.particles.velocity[b][0]).abs()
    };
    Some(1e2 / STEP * away.map(|(_, pair)| off(pair)).fold(0.0, f64::max))
}

/// Final velocity of the aluminium bar beside the exact one of small strain, 386.1 m/s.
#[allow(clippy::unnecessary_wraps, reason = "the form of a measure")]
fn rebound(s: &Simulation, _: &Run) -> Option<f64> {
    let aluminium = (0..s.particles.owned()).filter(|&i| s.particles.body[i] == 1);
    Some(1e2 * (mean(aluminium.map(|i| s.particles.velocity[i][0])) / 386.1 - 1.0))
}

/// Mean stress on the axis beside that of one dimension, .0733 Mbar.
#[allow(clippy::unnecessary_wraps, reason = "the form of a measure")]
fn plateau(_: &Simulation, run: &Run) -> Option<f64> {
    Some(1e2 * (mean(run.samples.iter().copied()) / 0.0733e11 - 1.0))
}

/// Of the times of the dam's front, the one farthest from Martin & Moyce (1952).
fn arrivals(_: &Simulation, run: &Run) -> Option<f64> {
    let all = run.samples.iter().map(|ratio| 1e2 * (ratio - 1.0));
    let worst = all.fold(
        0.0,
        |worst: f64, off| if off.abs() > worst.abs() { off } else { worst },
    );
    (run.samples.len() == 3).then_some(worst)
}

/// Kinetic energy left beside that of the same case with steps a fifth as long.
fn finer_steps(s: &Simulation, run: &Run) -> Option<f64> {
    let changes = [run.problem.changes, run.mode, &["time_step.courant=0.1"]].concat();
    let fine = load(run.problem.input, &changes).ok()?;
    let (fine, stopped) = advance(fine, f64::INFINITY, &mut |_| {});
    let left = |s: &Simulation| s.state.totals.kinetic_energy;
    stopped
        .is_none()
        .then(|| 1e2 * (left(s) / left(&fine) - 1.0))
}

/// Velocity of the right ring as a whole beside that of one that a rigid plane throws back, as what
/// meets its mirror image without friction is.
#[allow(clippy::unnecessary_wraps, reason = "the form of a measure")]
fn off_a_wall(s: &Simulation, _: &Run) -> Option<f64> {
    let changes = [
        RINGS,
        &[
            r#"body.left.shape={ box = { lower = ["-20 cm", 0], upper = ["-19 cm", "1 cm"] } }"#,
            "body.left.velocity=[0, 0]",
            r#"plane=[{ name = "wall", normal = "+x", bodies = ["right"] }]"#,
        ],
    ]
    .concat();
    let wall = load("rubber-rings", &changes).expect("a ring and a wall");
    let (wall, _) = advance(wall, s.state.time, &mut |_| {});
    let rebound = |s: &Simulation| {
        let right = (0..s.particles.owned()).filter(|&i| s.particles.body[i] == 1);
        mean(right.map(|i| s.particles.velocity[i][0]))
    };
    Some(1e2 * (rebound(s) / rebound(&wall) - 1.0))
}

/// Velocity that the sphere has lost beside that on a plate in one piece.
fn seam(s: &Simulation, run: &Run) -> Option<f64> {
    let (whole, _) = advance(
        load("contact-lab/solid", run.mode).ok()?,
        f64::INFINITY,
        &mut |_| {},
    );
    let lost = |s: &Simulation| {
        let body = u32::try_from(s.case.bodies.len() - 1).expect("few bodies");
        let sphere = (0..s.particles.owned()).filter(|&i| s.particles.body[i] == body);
        7000.0 + mean(sphere.map(|i| s.particles.velocity[i][2]))
    };
    Some(1e2 * (lost(s) / lost(&whole) - 1.0))
}

/// A table of one figure, problems by modes.
fn table(title: &str, runs: &BTreeMap<(usize, usize), Run>, cell: &dyn Fn(&Run, &Run) -> String) {
    println!("\n## {title}\n");
    let names: Vec<&str> = MODES.iter().map(|(name, _)| *name).collect();
    println!("| | {} |", names.join(" | "));
    println!("|---|{}", "---|".repeat(MODES.len()));
    for (row, problem) in PROBLEMS.iter().enumerate() {
        let of = |column| {
            let run = &runs[&(row, column)];
            match &run.stopped {
                Some(_) if run.steps == 0 => "refused".to_owned(),
                Some(_) => "stopped".to_owned(),
                None => cell(run, &runs[&(row, 0)]),
            }
        };
        let cells: Vec<String> = (0..MODES.len()).map(of).collect();
        println!("| {} | {} |", problem.name, cells.join(" | "));
    }
}

/// All runs, each on one thread, as many at a time as there are cores; says each as it ends.
fn run_all() -> BTreeMap<(usize, usize), Run> {
    let all = (0..PROBLEMS.len()).flat_map(|row| (0..MODES.len()).map(move |column| (row, column)));
    let (waiting, done) = (Mutex::new(all), Mutex::new(BTreeMap::new()));
    let next = || waiting.lock().expect("no panic").next();
    let work = || {
        let pool = ThreadPoolBuilder::new().num_threads(1).build();
        let pool = pool.expect("a thread");
        while let Some((row, column)) = next() {
            let (name, mode) = MODES[column];
            let run = pool.install(|| run(&PROBLEMS[row], mode));
            println!("{}", run.line(name));
            done.lock().expect("no panic").insert((row, column), run);
        }
    };
    thread::scope(|scope| {
        for _ in 0..thread::available_parallelism().map_or(1, usize::from) {
            scope.spawn(work);
        }
    });
    done.into_inner().expect("no panic")
}

#[test]
#[ignore = "slow: make contact-lab"]
fn every_mode_on_every_problem() {
    let runs = run_all();
    let or_dash = |value: Option<f64>, digits: usize| {
        value.map_or("–".to_owned(), |value| format!("{value:.digits$}"))
    };
    table("Error, %", &runs, &|run, _| or_dash(run.error, 1));
    table("Largest change of energy, %", &runs, &|run, _| {
        format!("{:.3}", run.energy)
    });
    table("Contact defect, %", &runs, &|run, _| {
        format!("{:.3}", run.defect)
    });
    table("Closest foreign pair, Δp", &runs, &|run, _| {
        or_dash(run.closest, 3)
    });
    table(
        "Friction, mean and largest",
        &runs,
        &|run, _| match run.friction {
            Some([mean, largest]) => format!("{mean:.5}, {largest:.4}"),
            None => "–".to_owned(),
        },
    );
    table(
        "Steps beside those of `overlap`; limited by contact",
        &runs,
        &|run, ours| {
            #[allow(clippy::cast_precision_loss, reason = "few steps")]
            let ratio = run.steps as f64 / ours.steps as f64;
            format!("{ratio:.2}; {}", run.limited)
        },
    );
    table("Share of the time, %", &runs, &|run, _| {
        format!("{:.1}", run.share)
    });
    let ours = |row: usize| &runs[&(row, 0)];
    assert!((0..PROBLEMS.len()).all(|row| ours(row).stopped.is_none()));
}
