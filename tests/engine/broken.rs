//! A broken body on many virtual ranks: its labels and its fragments are those on one, and nobody hears of all of them.

use std::collections::BTreeMap;

use comm::{Call, Comm, Machine};
use engine::fragments::Fragment;
use engine::step::Simulation;
use engine::step::fragments::find_in;
use files::input;
use model::{Case, FragmentOptions};

use crate::common::outcome::start;
use crate::common::virtual_ranks::on_virtual_ranks;

/// The step before those that are looked at, and their number: before step 10 all parts are labelled.
const BEGUN: u64 = 8;
const STEPS: usize = 3;

/// Times that a rank calls all others at one place at most; messages to peers are more.
const MOST_CALLS: u64 = 4 * STEPS as u64;

/// Bytes in all steps that one rank may have more than others because of the owners that hashes give.
const NOISE: u64 = 4096;

/// A cube of `n` particles along each edge in pieces of three along each, but for one of half the edge, all far apart.
fn pieces(n: usize) -> Case {
    let mut ends = vec![[0, n / 2]];
    ends.extend(
        (0..n / 6)
            .map(|k| n / 2 + 4 + 7 * k)
            .map(|from| [from, from + 3]),
    );
    let edge = format!("{}", n / 5);
    let slabs = [0, 1, 2].map(|axis| {
        let slab = |[from, to]: &[usize; 2]| {
            let corner = |at: usize, else_at: &str| {
                let mut corner = [0; 3].map(|_| format!("\"{else_at} mm\""));
                corner[axis] = format!("\"{}.{} mm\"", at / 10, at % 10);
                corner.join(", ")
            };
            let (lower, upper) = (corner(*from, "0"), corner(*to, &edge));
            format!("{{ box = {{ lower = [{lower}], upper = [{upper}] }} }}")
        };
        let slabs: Vec<String> = ends.iter().map(slab).collect();
        format!("{{ union = [{}] }}", slabs.join(", "))
    });
    let body = format!(
        "[[body]]\nname = \"pieces\"\nmaterial = \"aluminium\"\nlattice = \"cubic\"\nvelocity = [0, 0, \"100 m/s\"]\n\
         shape.intersection = [{}]\n",
        slabs.join(", ")
    );
    let text = include_str!("../common/broken.toml").to_owned() + &body;
    input::parse("tests/common/broken.toml", &text, &[]).unwrap()
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

/// Bytes that a rank sends and receives by a call, and its messages: the most of all ranks.
type Bytes = BTreeMap<Call, [u64; 2]>;

fn bytes(comm: &Comm) -> Bytes {
    let calls = comm.traffic_by_call().into_iter();
    calls
        .map(|(call, traffic)| (call, [traffic.sent + traffic.received, traffic.messages]))
        .collect()
}

/// Bytes by call on each of these numbers of ranks, which find what one rank does.
fn broken(n: usize, numbers: &[usize]) -> Vec<Bytes> {
    let case = pieces(n);
    let mut whole = start(case.clone());
    whole.state.step = BEGUN;
    let mut begun = whole.particles.clone();
    begun.resize_halo(0);
    begun.poison();
    let state = whole.state.clone();
    let mut none = begun.clone();
    none.resize_owned(0);
    let resume = |comm: &Comm| {
        let mine = if comm.is_root() { &begun } else { &none }.clone();
        Simulation::resume(case.clone(), comm, state.clone(), mine).unwrap()
    };
    let alone = look(&Comm::solo(), &mut whole);
    let parts: std::collections::BTreeSet<u64> = alone.labels.values().map(|of| of[0]).collect();
    println!(
        "{} particles, {} parts, {} fragments",
        alone.labels.len(),
        parts.len(),
        alone.fragments.len()
    );
    assert!(parts.len() > n && alone.fragments.len() > n);
    let on = |&ranks: &usize| {
        let found = on_virtual_ranks(ranks, Machine::IDEAL, |comm| {
            let mut simulation = resume(comm);
            let before = bytes(comm);
            let found = look(comm, &mut simulation);
            let mut after = bytes(comm);
            for (call, before) in before {
                let of = after.entry(call).or_default();
                *of = [0, 1].map(|k| of[k] - before[k]);
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
                *most = [0, 1].map(|k| bytes[k].max(most[k]));
            }
        }
        assert!(labels == alone.labels, "labels on {ranks} ranks");
        most
    };
    numbers.iter().map(on).collect()
}

/// No call's bytes grow faster than the square root of the number of ranks, but for the faces of a balance: a word of each
/// rank, both ways.
#[allow(clippy::cast_precision_loss, reason = "ratios")]
fn assert_sparse(numbers: &[usize], bytes: &[Bytes], regards: impl Fn(&Call) -> bool) {
    let mut calls: Vec<Call> = bytes.iter().flat_map(BTreeMap::keys).copied().collect();
    calls.sort();
    calls.dedup();
    calls.retain(regards);
    let mut steep = Vec::new();
    for call in calls {
        let of: Vec<[u64; 2]> = bytes
            .iter()
            .map(|of| of.get(&call).copied().unwrap_or_default())
            .collect();
        println!("{of:>10?} {}:{}", call.file(), call.line());
        for k in 1..of.len() {
            // By the ranks of a row or of a column that one talks to.
            let [from, to] = [numbers[k - 1], numbers[k]].map(|ranks| (ranks as f64).sqrt() - 1.0);
            let growth = to / from;
            let [[before, _], [now, messages]] = [of[k - 1], of[k]];
            let faces = messages <= MOST_CALLS && call.file().ends_with("domain/balance.rs");
            let words = if faces {
                16 * messages * numbers[k] as u64
            } else {
                NOISE
            };
            if now as f64 > growth * before as f64 + words as f64 {
                steep.push((call.file(), call.line()));
            }
        }
    }
    assert!(steep.is_empty(), "{steep:?}");
}

/// Halos of slabs as thin as here reach beyond their neighbours: how they grow only a large body shows.
#[test]
fn nobody_hears_of_all_pieces() {
    let numbers = [16, 64, 256];
    assert_sparse(&numbers, &broken(24, &numbers), |call| {
        !call.file().ends_with("domain/halo.rs")
    });
}

#[test]
#[ignore = "slow: a million particles on up to a thousand ranks"]
fn nobody_hears_of_all_pieces_of_a_large_body() {
    let numbers = [64, 256, 1000];
    assert_sparse(&numbers, &broken(102, &numbers), |_| true);
}
