//! What must change no bit: threads, the order in memory, a stop, the instruction set, and what is
//! not state. Ranks are in `mpi/engine.rs` and, by the whole program, in `same_bits.rs`.

use engine::step::measurements;
use std::process::Command;

use crate::bridge;
use crate::common::outcome::{
    CASES, Outcome, advance, assert_same, every_option, everything, loaded, normalised, start,
};
use crate::common::random::Random;
use comm::Comm;
use engine::step::Simulation;
use files::input;
use model::Case;
use numerics::dispatch::available;
use particles::SCRATCH_WORDS;

const STEPS: usize = 40;

/// A plate that waves do not cross at once.
const WIDE: &str = "body.plate.shape.cylinder.radius=\"3 mm\"";

/// The main job, coarse, with more keys.
fn quarter(more: &[&str]) -> Case {
    let path = crate::project::root().join("inputs/quarter-impact/case.toml");
    let keys = ["spacing=\"0.05 mm\""].iter().chain(more);
    let keys: Vec<String> = keys.map(|&key| key.to_owned()).collect();
    input::load(&path, &keys).unwrap()
}

fn reference(case: fn() -> Case) -> Outcome {
    after(STEPS, case)
}

fn after(steps: usize, case: fn() -> Case) -> Outcome {
    let mut simulation = start(case());
    advance(&mut simulation, steps);
    Outcome::of(&simulation)
}

/// NaN in everything that is not state, between any two steps, changes no bit.
#[test]
fn only_state_carries_over_a_step() {
    for case in CASES {
        let mut poisoned = start(case());
        poisoned.step_control.poison = true;
        advance(&mut poisoned, STEPS);
        assert_same(&Outcome::of(&poisoned), &reference(case));
    }
}

#[test]
fn threads_change_no_bit() {
    for case in CASES {
        let reference = reference(case);
        for threads in [1, 5] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
            assert_same(&pool.unwrap().install(|| self::reference(case)), &reference);
        }
    }
}

/// Where nothing moves relative to its neighbours and nothing is stressed the sums are zero, and
/// sparing them changes no bit.
#[test]
fn sparing_what_is_calm_changes_no_bit() {
    for case in [
        everything,
        every_option,
        loaded,
        normalised,
        || quarter(&[]),
    ] {
        let [spared, whole] = [true, false].map(|spare| {
            let mut simulation = Simulation::start(case(), &Comm::solo()).unwrap();
            simulation.search.lists.spare_quiescent = spare;
            advance(&mut simulation, 25);
            simulation
        });
        assert_same(&Outcome::of(&spared), &Outcome::of(&whole));
    }
}

/// Nothing moves far ahead of sound, to the last bit, and what rests has no lists.
#[test]
fn what_no_wave_has_reached_rests() {
    let case = quarter(&[WIDE]);
    let start = || Simulation::start(case.clone(), &Comm::solo()).unwrap();
    let (mut spared, mut whole) = (start(), start());
    whole.search.lists.spare_quiescent = false;
    for simulation in [&mut spared, &mut whole] {
        // Not a multiple of ten, where parts of bodies are told apart.
        advance(simulation, 24);
    }
    let sound = case.materials[0].longitudinal_speed();
    let heard = 0.3e-3 + sound * spared.state.time + 20.0 * 0.05e-3;
    assert!(heard < 2.2e-3, "{heard}");
    let particles = &spared.particles;
    let radius = |x: &[f64; 3]| (x[0] * x[0] + x[1] * x[1]).sqrt();
    let far = (0..particles.owned()).filter(|&i| radius(&particles.position[i]) > heard);
    let far: Vec<usize> = far.collect();
    assert!(far.len() > particles.owned() / 4, "{}", far.len());
    assert!(far.iter().all(|&i| particles.velocity[i] == [0.0; 3]));
    let [few, all] = [&spared, &whole].map(|simulation| simulation.search.lists.entries());
    assert!(4 * few < 3 * all, "{few} of {all}");
    assert_same(&Outcome::of(&spared), &Outcome::of(&whole));
}

/// What rests far from what moves is left out of steps and comes back as the wave does, whatever becomes of the
/// store meanwhile, and no bit tells.
#[test]
fn what_sleeps_changes_no_bit() {
    let case = quarter(&[WIDE, "domain.balance_every=7"]);
    let start = || Simulation::start(case.clone(), &Comm::solo()).unwrap();
    let (mut spared, mut shaken, mut whole) = (start(), start(), start());
    whole.search.lists.spare_quiescent = false;
    let mut random = Random::new(3);
    let mut asleep = Vec::new();
    for step in 0..75 {
        advance(&mut spared, 1);
        advance(&mut shaken, 1);
        advance(&mut whole, 1);
        asleep.push(spared.inactive());
        if step % 13 == 5 {
            let count = u32::try_from(shaken.particles.owned()).unwrap();
            let mut order: Vec<u32> = (0..count).collect();
            random.shuffle(&mut order);
            let mut scratch = vec![0; SCRATCH_WORDS * order.len()];
            shaken.particles.keep(&order, &mut scratch);
        }
    }
    assert_eq!(whole.inactive(), 0);
    let (most, last) = (asleep.iter().max().unwrap(), asleep.last().unwrap());
    let owned = spared.particles.owned();
    assert!(15 * most > owned, "{most} of {owned}");
    assert!(last < most, "{last} of {most}");
    let whole = Outcome::of(&whole);
    assert_same(&Outcome::of(&spared), &whole);
    assert_same(&Outcome::of(&shaken), &whole);
}

/// What sleeps hangs together as lists of all would tell, though they have it not: also when its pieces come apart
/// elsewhere, and when the store is put in order around it.
#[test]
#[ignore = "slow"]
fn what_sleeps_is_told_its_parts() {
    let solo = Comm::solo();
    let (mut spared, mut whole) = (start(bridge::case()), start(bridge::case()));
    whole.search.lists.spare_quiescent = false;
    for step in 0..bridge::STEPS {
        for simulation in [&mut spared, &mut whole] {
            bridge::advance(simulation, &solo);
        }
        let (asleep, owned) = (spared.inactive(), spared.particles.owned());
        // The smaller block does not, once it is one.
        let sleeps = (2..=30).contains(&step);
        assert!(!sleeps || 8 * asleep > owned, "{step}: {asleep} of {owned}");
        let figures = [&mut spared, &mut whole].map(|simulation| {
            measurements::diagnose(simulation, &solo);
            let totals = simulation.state.totals;
            format!("{totals:?} {:?}", measurements::bodies(simulation, &solo))
        });
        assert_eq!(figures[0], figures[1], "{step}");
        assert_same(&Outcome::of(&spared), &Outcome::of(&whole));
    }
    bridge::assert_apart(&whole.particles.part[..whole.particles.owned()]);
}

/// The order of particles in memory is nobody's business.
#[test]
fn order_in_memory_changes_no_bit() {
    for case in CASES {
        let mut simulation = start(case());
        let mut random = Random::new(2);
        for _ in 0..STEPS {
            let count = u32::try_from(simulation.particles.owned()).unwrap();
            let mut order: Vec<u32> = (0..count).collect();
            random.shuffle(&mut order);
            let mut scratch = vec![0; SCRATCH_WORDS * order.len()];
            simulation.particles.keep(&order, &mut scratch);
            advance(&mut simulation, 1);
        }
        assert_same(&Outcome::of(&simulation), &reference(case));
    }
}

/// A run taken up again from its state alone goes on as if nothing had happened.
#[test]
fn resuming_changes_no_bit() {
    for case in CASES {
        let mut first = start(case());
        advance(&mut first, STEPS / 2);
        let mut saved = first.particles.clone();
        saved.resize_halo(0);
        saved.poison();
        let state = first.state.clone();
        let mut second = Simulation::resume(case(), &Comm::solo(), state, saved).unwrap();
        advance(&mut second, STEPS - STEPS / 2);
        assert_same(&Outcome::of(&second), &reference(case));
    }
}

const DIGEST: &str = "WHIPPLE_TEST_DIGEST";

/// Every instruction set of this processor gives the same bits.
#[test]
fn instruction_sets_change_no_bit() {
    if std::env::var_os(DIGEST).is_some() {
        // Few steps: without vectors one takes twenty times as long.
        let outcomes = CASES.map(|case| after(10, case));
        let states: Vec<&String> = outcomes.iter().map(|outcome| &outcome.state).collect();
        // FNV-1a.
        let digest = outcomes
            .iter()
            .flat_map(|outcome| outcome.rows.values().flatten())
            .fold(0xcbf2_9ce4_8422_2325_u64, |hash, &byte| {
                (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
            });
        println!("digest {digest:x} {states:?}");
        return;
    }
    let outputs: Vec<String> = available()
        .into_iter()
        .map(|set| {
            let output = Command::new(std::env::current_exe().unwrap())
                .args([
                    "--exact",
                    "bits::instruction_sets_change_no_bit",
                    "--nocapture",
                ])
                .env(DIGEST, "1")
                .env("WHIPPLE_SIMD", set.name())
                .output()
                .unwrap();
            assert!(output.status.success());
            let text = String::from_utf8(output.stdout).unwrap();
            let line = text.lines().find_map(|line| line.split_once("digest "));
            line.expect("a digest").1.to_owned()
        })
        .collect();
    for (output, set) in outputs.iter().zip(available()) {
        assert_eq!(*output, outputs[0], "{}", set.name());
    }
}
