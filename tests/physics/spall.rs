//! Spall: plates that part where the releases of both free faces meet, and a bar that is torn as it
//! turns.

use crate::common::{SPACING, body, case, make_elastic};
use crate::physics_support::{inline, run_with, sorted_by, start};
use comm::Comm;
use engine::diagnose::Worst;
use engine::step::Simulation;
use engine::step::measurements;
use material::{AfterSpall, Spall};
use model::{Shape, SphForm, Vec3};

/// Thickness h of the flyer (m), and half of that of the target.
const H: f64 = 2e-3;
/// Speed of the flyer (m/s).
const SPEED: f64 = 400.0;
/// Particles through the flyer.
const CELLS: f64 = 100.0;

fn plates(spall: &str) -> Simulation {
    start(inline(&format!(
        "dimension = 1\nspacing = \"{} m\"\nrun.end_time = \"2.6 us\"\n\
         [material.aluminium]\nlibrary = \"aluminium-2024\"\nstrength = \"none\"\n{spall}\n\
         [[body]]\nname = \"target\"\nmaterial = \"aluminium\"\n\
         shape.box = {{ lower = [0], upper = [\"4 mm\"] }}\n\
         [[body]]\nname = \"flyer\"\nmaterial = \"aluminium\"\n\
         shape.box = {{ lower = [\"-3 mm\"], upper = [\"-1 mm\"] }}\n\
         velocity = [\"{SPEED} m/s\"]\ntouch = {{ body = \"target\", direction = \"+x\" }}\n",
        H / CELLS
    )))
}

/// What a run of the plates shows.
#[derive(Debug)]
struct Outcome {
    /// Mass between the widest gap of the target and its free face, over that of h.
    scab: f64,
    /// Width of that gap in spacings.
    gap: f64,
    /// Mean velocity of the outermost .9 h, over that of the flyer, a wave's way through h after the
    /// releases have met, and at the end.
    outer: [f64; 2],
    /// Least velocity of the free face between the arrival of the shock and two more ways through h,
    /// over that of the flyer.
    pull_back: f64,
    failed: f64,
    /// Mean distance of failed matter from the free face, in matter of h.
    plane: f64,
    energy_error: f64,
    momentum_error: f64,
}

fn run(spall: &str) -> Outcome {
    let mut s = plates(spall);
    let way = H / 5600.0;
    let (mut outer, mut pull_back) = (None, f64::INFINITY);
    let target = |s: &Simulation| sorted_by(s, 0, |i| s.particles.position[i][0]);
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "100"
    )]
    let cells = CELLS as usize;
    let mean = |s: &Simulation| {
        let all = target(s);
        let some = &all[all.len() - 9 * cells / 10..];
        #[allow(clippy::cast_precision_loss, reason = "few")]
        let count = some.len() as f64;
        some.iter()
            .map(|&i| s.particles.velocity[i][0])
            .sum::<f64>()
            / count
            / SPEED
    };
    run_with(&mut s, 1.0, |s| {
        if s.state.time > 4.0 * way && outer.is_none() {
            outer = Some(mean(s));
        }
        if s.state.time > 2.5 * way && s.state.time < 5.0 * way {
            let face = *target(s).last().unwrap();
            pull_back = pull_back.min(s.particles.velocity[face][0] / SPEED);
        }
    });
    let order = target(&s);
    let x = |k: usize| s.particles.position[order[k]][0];
    let gaps = (1..order.len()).map(|k| (x(k) - x(k - 1), k));
    let (gap, k) = gaps.fold(
        (0.0, 0),
        |most, next| if next.0 > most.0 { next } else { most },
    );
    #[allow(clippy::cast_precision_loss, reason = "few")]
    let scab = (order.len() - k) as f64 / CELLS;
    let failed = |&k: &usize| s.particles.damage.get(order[k]).is_some_and(|d| *d >= 1.0);
    #[allow(clippy::cast_precision_loss, reason = "few")]
    let depths = (0..order.len())
        .filter(failed)
        .map(|k| (order.len() - k) as f64 / CELLS);
    let (sum, count) = depths.fold((0.0, 0.0), |(sum, count), depth| (sum + depth, count + 1.0));
    Outcome {
        plane: sum / count,
        scab,
        gap: gap * CELLS / H,
        outer: [outer.unwrap(), mean(&s)],
        pull_back,
        failed: s.state.totals.failed_mass / s.state.totals.mass,
        energy_error: s.state.worst.energy_error,
        momentum_error: s.state.worst.momentum_error[0],
    }
}

/// A flyer of thickness h on a target of 2 h: the releases of both free faces meet h from that of
/// the target, where all of it begins to be torn. What is beyond flies off with the momentum that
/// the shock has left in it, that of the flyer. Held at the limit it is slowed down instead, for as
/// long as that lasts.
#[test]
fn a_scab_of_the_flyers_thickness_flies_off_with_its_momentum() {
    let whole = run("");
    let failed = run("failure.spall.pressure = \"-1.2 GPa\"");
    let hold = run("failure.spall = { pressure = \"-1.2 GPa\", after = \"hold\" }");
    println!("whole {whole:?}\nfailed {failed:?}\nhold {hold:?}");
    // Releases spread over some spacings, and so does what fails: the gap opens at one end of it, half
    // of it (of three h in all) from its middle.
    let half = 0.5 * 3.0 * failed.failed;
    assert!((failed.plane - 1.0).abs() < 0.03, "{failed:?}");
    assert!(
        (failed.scab - failed.plane).abs() < half + 1.0 / CELLS,
        "{failed:?}"
    );
    assert!(failed.gap > 5.0 && failed.failed < 0.07);
    for outer in failed.outer {
        assert!(outer > 0.95, "{failed:?}");
    }
    // Without spall half of the momentum is thrown back.
    assert!(whole.gap < 2.0 && (whole.outer[0] - 0.5).abs() < 0.05);
    // Held tension pulls the free face back by 2 p/(ρ₀ c₀), and slows the scab for as long as it
    // lasts; let go, its pulse is short and fades on the way.
    let pull_back = 2.0 * 1.2e9 / (2785.0 * 5328.0) / SPEED;
    assert!(
        (hold.pull_back - (1.0 - pull_back)).abs() < 0.03,
        "{hold:?}"
    );
    assert!(failed.pull_back > hold.pull_back + 0.1);
    assert!(hold.outer[1] < failed.outer[1] - 0.1 && hold.failed == 0.0);
    for outcome in [&failed, &hold] {
        assert!(outcome.energy_error < 1.2 * whole.energy_error + 1e-6);
        assert!(outcome.momentum_error < 1e-12);
    }
}

/// A bar that turns and is drawn apart until it tears, free: angular momentum and energy stay.
#[test]
fn a_bar_torn_as_it_turns_keeps_angular_momentum_and_energy() {
    let comm = &Comm::solo();
    for (dimension, after) in [
        (2, AfterSpall::Failed),
        (2, AfterSpall::Recompacts),
        (3, AfterSpall::Failed),
    ] {
        let size = if dimension == 2 {
            [40.0, 8.0, 0.0]
        } else {
            [24.0, 6.0, 6.0]
        };
        let shape = Shape::Box {
            lower: Vec3::from(size) * (-0.5 * SPACING),
            upper: Vec3::from(size) * (0.5 * SPACING),
        };
        let mut case = case(
            dimension,
            vec![body("bar", shape, SPACING, Vec3::zeros())],
            1.0,
        );
        make_elastic(&mut case);
        case.sph.form = SphForm::Corrected;
        case.materials[0].failure.spall = Some(Spall {
            pressure: -8e8,
            after,
        });
        let mut simulation = Simulation::start(case, comm).unwrap();
        let particles = &mut simulation.particles;
        // Halves that fly apart as they turn, a tenth of a turn in the time of the run.
        let (apart, spin) = (150.0, 2e5);
        for i in 0..particles.owned() {
            let [x, y, _] = particles.position[i];
            let velocity = [apart * x.signum() - spin * y, spin * x, 0.0];
            particles.velocity[i] = velocity;
            particles.predicted_velocity[i] = velocity;
        }
        measurements::diagnose(&mut simulation, comm);
        simulation.state.initial = simulation.state.totals;
        let turn = simulation.state.totals.angular_momentum[2].abs();
        simulation.state.angular_momentum_scale = Some(turn);
        simulation.state.worst = Worst::default();
        while simulation.state.time < 3e-6 {
            simulation.advance(comm).unwrap();
            measurements::diagnose(&mut simulation, comm);
        }
        let state = &simulation.state;
        let failed = state.totals.failed_mass / state.totals.mass;
        let released = state.totals.failure_energy / state.initial.energy();
        println!(
            "{dimension}-D {after:?}: {} steps, failed {failed}, released {released}, {:?}",
            state.step, state.worst
        );
        assert!((0.02..0.5).contains(&failed) && released > 0.0);
        // A tear crosses the bar, and what is left flies apart.
        assert!(
            state.worst.angular_momentum_error[2] < 1e-12,
            "{:?}",
            state.worst
        );
        assert!(state.worst.energy_error < 1e-12, "{:?}", state.worst);
        assert!(state.worst.momentum_error.iter().all(|&e| e < 1e-12));
    }
}
