//! A broken body on many virtual ranks: its labels and its fragments are those on one, and nobody hears of all of them.

use std::collections::BTreeMap;

use comm::{Call, Comm, Machine};
use engine::fragments::Fragment;
use engine::step::fragments::find_in;
use engine::step::{RunState, Simulation};
use files::input;
use model::{Case, FragmentOptions};
use particles::ParticleStore;

use crate::common::outcome::start;
use crate::common::virtual_ranks::on_virtual_ranks;

/// Spacing (m).
const DP: f64 = 1e-4;

/// Steps, after one of which all parts are labelled.
const STEPS: usize = 11;

/// A cube of `n` particles along each edge, which hangs together.
fn cube(n: usize) -> Case {
    let text = include_str!("../common/broken.toml");
    let edge = format!("{} mm", n as f64 / 10.0);
    let shape = format!(
        "body.cube.shape={{ box = {{ lower = [\"0 mm\", \"0 mm\", \"0 mm\"], upper = [\"{edge}\", \"{edge}\", \"{edge}\"] }} }}"
    );
    input::parse("tests/common/broken.toml", text, &[shape]).unwrap()
}

/// Place along an axis of what stood at `x` (m): pieces of three spacings, those of the first half of the cube one large
/// piece, each six spacings from the next.
fn apart(x: f64, edge: f64) -> f64 {
    x + 6.0 * DP * ((x - 0.5 * edge) / (3.0 * DP)).ceil().max(0.0)
}

/// What ranks find: the fragments, and the labels of all particles by their ids.
struct Found {
    fragments: Vec<Fragment>,
    labels: BTreeMap<u64, [u64; 2]>,
}

/// Advances, and looks for fragments: on rank 0 all, and labels of this rank's particles.
fn look(comm: &Comm, simulation: &mut Simulation) -> Found {
    for _ in 0..STEPS {
        simulation.advance(comm).unwrap();
    }
    let census = find_in(simulation, comm, &FragmentOptions::default());
    let particles = &simulation.particles;
    let labels = (0..particles.owned()).map(|i| {
        let labels = [particles.part[i], census.labels[i]];
        (particles.id[i], labels)
    });
    Found {
        labels: labels.collect(),
        fragments: census.fragments,
    }
}

fn resume(comm: &Comm, n: usize, (state, all): (&RunState, &ParticleStore)) -> Simulation {
    let mut mine = all.clone();
    if !comm.is_root() {
        mine.resize_owned(0);
    }
    Simulation::resume(cube(n), comm, state.clone(), mine).unwrap()
}

/// Bytes that a rank sends and receives by a call, the most of all ranks.
type Bytes = BTreeMap<Call, u64>;

fn bytes(comm: &Comm) -> Bytes {
    let calls = comm.traffic_by_call().into_iter();
    calls
        .map(|(call, traffic)| (call, traffic.sent + traffic.received))
        .collect()
}

/// Bytes by call on each of these numbers of ranks, which find what one rank does.
fn broken(n: usize, numbers: &[usize]) -> Vec<Bytes> {
    let edge = n as f64 * DP;
    let mut whole = start(cube(n));
    let owned = whole.particles.owned();
    for position in &mut whole.particles.position[..owned] {
        *position = position.map(|x| apart(x, edge));
    }
    let mut all = whole.particles.clone();
    all.resize_halo(0);
    let begun = (&whole.state, &all);
    let alone = look(&Comm::solo(), &mut resume(&Comm::solo(), n, begun));
    let parts: std::collections::BTreeSet<u64> = alone.labels.values().map(|of| of[0]).collect();
    println!(
        "{owned} particles, {} parts, {} fragments",
        parts.len(),
        alone.fragments.len()
    );
    assert!(parts.len() > n && alone.fragments.len() > n);
    let on = |&ranks: &usize| {
        let found = on_virtual_ranks(ranks, Machine::IDEAL, |comm| {
            let mut simulation = resume(comm, n, begun);
            let before = bytes(comm);
            let found = look(comm, &mut simulation);
            let mut after = bytes(comm);
            for (call, bytes) in before {
                *after.entry(call).or_default() -= bytes;
            }
            (found, after)
        });
        let mut most = Bytes::new();
        let mut labels = BTreeMap::new();
        assert_eq!(found[0].0.fragments, alone.fragments);
        for (mut found, bytes) in found {
            labels.append(&mut found.labels);
            for (call, bytes) in bytes {
                let most = most.entry(call).or_default();
                *most = bytes.max(*most);
            }
        }
        assert!(labels == alone.labels, "labels on {ranks} ranks");
        most
    };
    numbers.iter().map(on).collect()
}

/// No call's bytes grow faster than the square root of the number of ranks.
#[allow(clippy::cast_precision_loss, reason = "ratios")]
fn assert_sparse(numbers: &[usize], bytes: &[Bytes]) {
    let mut calls: Vec<Call> = bytes.iter().flat_map(BTreeMap::keys).copied().collect();
    calls.sort();
    calls.dedup();
    let mut steep = Vec::new();
    for call in calls {
        let of: Vec<u64> = bytes
            .iter()
            .map(|of| of.get(&call).copied().unwrap_or(0))
            .collect();
        println!("{:>10?} {}:{}", of, call.file(), call.line());
        for k in 1..of.len() {
            let growth = (numbers[k] as f64 / numbers[k - 1] as f64).sqrt();
            if of[k] as f64 > growth * of[k - 1] as f64 + 1024.0 {
                steep.push(call);
            }
        }
    }
    assert!(steep.is_empty(), "{steep:?}");
}

#[test]
fn nobody_hears_of_all_pieces() {
    let numbers = [16, 64, 256];
    assert_sparse(&numbers, &broken(24, &numbers));
}

#[test]
#[ignore = "slow: a million particles on up to a thousand ranks"]
fn nobody_hears_of_all_pieces_of_a_large_body() {
    let numbers = [64, 256, 1000];
    assert_sparse(&numbers, &broken(100, &numbers));
}
