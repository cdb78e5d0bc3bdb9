//! Messages, migration, halo and balance between real ranks, against what every rank can work out
//! alone from the list of all particles.

use engine::step::measurements;
use std::collections::{BTreeMap, BTreeSet};
use std::thread;
use std::time::{Duration, Instant};

use crate::common::outcome::{CASES, Outcome, rubbing};
use crate::common::random::Random;
use crate::common::sentinel::{id, mix, sentinel};
use crate::ranks::on_each;
use comm::{Comm, Exchange, Joint, waited};
use engine::domain::{Balance, Decomposition, Halo, Migration, NestedSlabs, RankSpeeds, Reaches};
use engine::step::{Simulation, Timers};
use model::{Axis, Overlap, SelfContact, SymmetryPlane};
use particles::{
    ActiveMut, FIELDS, FieldInfo, HaloPhase, Image, Inactive, MirrorMask, Mirrors, ParticleStore,
    SCRATCH_WORDS, Select,
};

/// Particles of the tests, spread over a box of this many units.
const TOTAL: u64 = 400;
const LENGTH: f64 = 10.0;

/// Where particle k stands in a round: in the box but for some that have flown off.
fn position(k: u64, round: u64) -> [f64; 3] {
    let mut random = Random::new(mix(k) ^ round);
    let far = if random.below(40) == 0 { 1e5 } else { 1.0 };
    std::array::from_fn(|_| far * random.within(0.0, LENGTH))
}

/// What a field's value of particle k should be: its position in this round, or its sentinel.
fn expected(k: u64, row: usize, round: u64) -> Vec<u8> {
    let field = &FIELDS[row];
    let mut bytes = vec![0; field.kind.bytes()];
    if field.name == "position" {
        let x = position(k, round);
        bytes.copy_from_slice(x.map(f64::to_ne_bytes).as_flattened());
    } else {
        sentinel(id(k), row, &mut bytes);
    }
    bytes
}

fn value<'a>(particles: &'a ParticleStore, field: &FieldInfo, slot: usize) -> &'a [u8] {
    let size = field.kind.bytes();
    &particles.bytes(field.id)[slot * size..(slot + 1) * size]
}

fn set(
    particles: &mut ParticleStore,
    slot: usize,
    k: u64,
    round: u64,
    only: impl Fn(&FieldInfo) -> bool,
) {
    for (row, field) in FIELDS.iter().enumerate().filter(|(_, field)| only(field)) {
        let size = field.kind.bytes();
        let bytes = expected(k, row, round);
        particles.bytes_mut(field.id)[slot * size..(slot + 1) * size].copy_from_slice(&bytes);
    }
}

/// Asserts that slot `slot` holds particle k in all fields that `which` takes.
fn assert_holds(particles: &ParticleStore, slot: usize, k: u64, round: u64, which: impl Select) {
    for (row, field) in FIELDS.iter().enumerate() {
        if which.takes(field) {
            assert!(
                value(particles, field, slot) == expected(k, row, round),
                "{} of particle {k} in slot {slot}",
                field.name
            );
        }
    }
}

/// Particle numbers by id.
fn numbers() -> BTreeMap<u64, u64> {
    (0..TOTAL).map(|k| (id(k), k)).collect()
}

/// This rank's particles of a random share of all, with sentinels in every field.
fn scattered(comm: &Comm, seed: u64) -> ParticleStore {
    let mut random = Random::new(seed);
    let mine: Vec<u64> = (0..TOTAL)
        .filter(|_| random.below(comm.size()) == comm.rank())
        .collect();
    let mut particles = ParticleStore::default();
    particles.resize_owned(mine.len());
    for (slot, &k) in mine.iter().enumerate() {
        set(&mut particles, slot, k, 0, |_| true);
    }
    particles
}

/// Slabs of one to three levels along random axes at random places, some empty or thinner than any
/// reach; every third round, all ranks but one are.
fn random_slabs(comm: &Comm, axis: usize, random: &mut Random) -> NestedSlabs {
    let (levels, turned) = (1 + random.below(3), random.below(2));
    let others = [(axis + 1) % 3, (axis + 2) % 3];
    let axes = [axis, others[turned], others[1 - turned]];
    let mut faces: Vec<f64> = (1..comm.size())
        .map(|_| random.within(-0.2 * LENGTH, 1.2 * LENGTH))
        .collect();
    match random.below(4) {
        0 => {
            let lone = random.below(comm.size());
            for (rank, face) in faces.iter_mut().enumerate() {
                *face = if rank < lone { -1e9 } else { 1e9 };
            }
        }
        1 if faces.len() > 1 => faces[1] = faces[0],
        2 => faces
            .iter_mut()
            .for_each(|face| *face = 0.5 * LENGTH + 0.01 * *face),
        _ => {}
    }
    NestedSlabs::of_any(axes, levels, faces)
}

/// Every particle is on the rank that owns its place, whole; together they are all there.
fn check_owners(comm: &Comm, slabs: &NestedSlabs, particles: &ParticleStore, round: u64) {
    let numbers = numbers();
    for slot in 0..particles.owned() {
        let k = numbers[&particles.id[slot]];
        assert_eq!(slabs.owner(&position(k, round)), comm.rank());
        assert_holds(particles, slot, k, round, FieldInfo::leaves);
    }
    let mine: BTreeSet<u64> = particles.id[..particles.owned()].iter().copied().collect();
    assert_eq!(mine.len(), particles.owned());
    let mut count = [mine.len() as u64];
    comm.sum_u64(&mut count);
    assert_eq!(count, [TOTAL]);
}

/// Moves everybody somewhere else, reorders the store, and gives it the values of `round`.
fn next_round(particles: &mut ParticleStore, round: u64, random: &mut Random) {
    let mut order: Vec<u32> = (0..u32::try_from(particles.owned()).unwrap()).collect();
    random.shuffle(&mut order);
    particles.keep(&order, &mut vec![0; SCRATCH_WORDS * order.len()]);
    let numbers = numbers();
    for slot in 0..particles.owned() {
        let k = numbers[&particles.id[slot]];
        // Fields that need not travel get their values again; all others had better be right.
        assert_holds(particles, slot, k, round - 1, FieldInfo::leaves);
        set(particles, slot, k, round, |field| {
            field.name == "position" || !field.leaves()
        });
    }
}

fn migrate_any_distance(comm: &Comm) {
    for round in [1 << 14, 7] {
        migrate_in_rounds_of(comm, round);
    }
}

fn migrate_in_rounds_of(comm: &Comm, most: usize) {
    let mut particles = scattered(comm, 5);
    let mut migration = Migration::in_rounds_of(most);
    let mut random = Random::new(6);
    let mut own = Random::new(7 + comm.rank() as u64);
    let mut was_empty = false;
    let mut filled_again = false;
    for round in 1..30 {
        next_round(&mut particles, round, &mut own);
        let slabs = random_slabs(comm, random.below(3), &mut random);
        // All, some or none are near enough for the short way.
        let near: Vec<usize> = (0..comm.size())
            .filter(|other| other.abs_diff(comm.rank()) < usize::try_from(round % 5).unwrap())
            .filter(|&other| other != comm.rank())
            .collect();
        let reach = |particles: &ParticleStore, i: usize| reach_of(particles.id[i], 1.0);
        let farthest = migration.migrate(comm, &slabs, &mut particles, &near, reach);
        assert_eq!(farthest, if comm.size() == 1 { 0.0 } else { 3.0 });
        check_owners(comm, &slabs, &particles, round);
        filled_again |= was_empty && particles.owned() > 0;
        was_empty |= particles.owned() == 0;
    }
    assert!(comm.size() == 1 || filled_again);
    assert_eq!(migration.traffic().messages > 0, comm.size() > 1);
}

#[test]
fn migration_carries_every_field_by_any_distance() {
    on_each(
        "engine::migration_carries_every_field_by_any_distance",
        &[1, 3, 5],
        migrate_any_distance,
    );
}

/// The images (particle, mirror mask) that stand within reach of any particle of this rank, from the
/// list of all particles.
fn needed(
    comm: &Comm,
    slabs: &NestedSlabs,
    mirrors: &Mirrors,
    round: u64,
    reach: impl Fn(u64) -> f64,
) -> BTreeSet<(u64, MirrorMask)> {
    let all: Vec<_> = (0..TOTAL).map(|k| (k, position(k, round))).collect();
    let mut needed = BTreeSet::new();
    for &(i, x) in &all {
        if slabs.owner(&x) != comm.rank() {
            continue;
        }
        for &(j, y) in &all {
            for mirror_mask in MirrorMask::all() {
                if (0..3).any(|a| mirror_mask.has(a) && mirrors.plane(a).is_none()) {
                    continue;
                }
                let y = mirrors.reflect_position(&y, mirror_mask);
                let r2: f64 = (0..3).map(|a| (x[a] - y[a]).powi(2)).sum();
                if r2 < (reach(i) + reach(j)).powi(2) {
                    needed.insert((j, mirror_mask));
                }
            }
        }
    }
    needed
}

/// Reach of a particle: one for most, some reach much farther.
fn reach_of(k: u64, scale: f64) -> f64 {
    scale * if mix(k).is_multiple_of(50) { 3.0 } else { 1.0 }
}

fn check_halo(
    comm: &Comm,
    particles: &ParticleStore,
    halo: &Halo,
    needed: &BTreeSet<(u64, MirrorMask)>,
    round: u64,
) {
    let numbers = numbers();
    let mut held = BTreeSet::new();
    let mut copies = BTreeSet::new();
    let owned = (0..particles.owned()).map(|i| Image::new(i, MirrorMask::OWN));
    for image in owned.chain(halo.others().iter().copied()) {
        let slot = image.slot();
        assert!(slot < particles.owned() + particles.halo());
        let k = numbers[&particles.id[slot]];
        assert!(held.insert((k, image.mirror_mask())), "an image twice");
        if slot >= particles.owned() {
            copies.insert(slot);
        }
    }
    assert!(needed.is_subset(&held));
    // Whoever came has at least one image, and only ranks with particles have a halo at all.
    assert_eq!(copies.len(), particles.halo());
    assert!(particles.owned() > 0 || particles.halo() == 0);
    assert!(comm.size() > 1 || particles.halo() == 0);
    for slot in 0..particles.owned() + particles.halo() {
        let k = numbers[&particles.id[slot]];
        assert_holds(particles, slot, k, round, HaloPhase::MOTION);
    }
}

fn exchange_halos(comm: &Comm) {
    let mut random = Random::new(16);
    let mut own = Random::new(17 + comm.rank() as u64);
    let mut particles = scattered(comm, 15);
    let mut migration = Migration::default();
    let mut round = 0;
    let numbers = numbers();
    let mut farther = false;
    for axis in 0..3 {
        for planes in 0..=3 {
            let planes: Vec<SymmetryPlane> = Axis::ALL[..planes]
                .iter()
                .map(|&axis| SymmetryPlane {
                    axis,
                    position: -0.25,
                })
                .collect();
            let mirrors = Mirrors::new(&planes);
            let mut halo = Halo::new(mirrors);
            // The same halo is used again with more particles and with fewer.
            for scale in [0.4, 2.0, 0.1] {
                round += 1;
                next_round(&mut particles, round, &mut own);
                let slabs = random_slabs(comm, axis, &mut random);
                let reach = |k: u64| reach_of(k, scale);
                let reach = |particles: &ParticleStore, i: usize| reach(numbers[&particles.id[i]]);
                let peers = halo.peers();
                let farthest = migration.migrate(comm, &slabs, &mut particles, peers, reach);
                for slot in 0..particles.owned() {
                    let k = numbers[&particles.id[slot]];
                    set(&mut particles, slot, k, round, |_| true);
                }
                let reach = |k: u64| reach_of(k, scale);
                let reaches = Reaches {
                    slabs: &slabs,
                    farthest,
                };
                let awake = Inactive::default();
                halo.post_motion(
                    comm,
                    reaches,
                    ActiveMut {
                        particles: &mut particles,
                        inactive: &awake,
                    },
                    |particles, i| reach(numbers[&particles.id[i]]),
                );
                halo.finish_motion(&mut particles);
                let needed = needed(comm, &slabs, &mirrors, round, reach);
                check_halo(comm, &particles, &halo, &needed, round);
                for phase in [HaloPhase::STRESS, HaloPhase::FORCES] {
                    halo.exchange(comm, &mut particles, phase);
                    for slot in 0..particles.owned() + particles.halo() {
                        assert_holds(&particles, slot, numbers[&particles.id[slot]], round, phase);
                    }
                }
                for slot in 0..particles.owned() {
                    let k = numbers[&particles.id[slot]];
                    assert_holds(&particles, slot, k, round, FieldInfo::leaves);
                }
                farther |= (particles.owned()..particles.owned() + particles.halo())
                    .any(|slot| slabs.owner(&particles.position[slot]).abs_diff(comm.rank()) > 1);
            }
        }
    }
    assert!(
        comm.size() < 3 || comm.any(farther),
        "no halo beyond the next rank"
    );
}

#[test]
fn halos_carry_every_field_of_every_image_in_reach() {
    on_each(
        "engine::halos_carry_every_field_of_every_image_in_reach",
        &[1, 3, 5, 8],
        exchange_halos,
    );
}

/// The byte at a place of the message of `round` from one rank to another.
#[allow(clippy::cast_possible_truncation, reason = "any byte will do")]
fn byte(round: usize, from: usize, to: usize, at: usize) -> u8 {
    mix((round * 1000 + from * 100 + to * 10) as u64 + at as u64 / 64).to_ne_bytes()[2]
}

fn exchange_messages(comm: &Comm) {
    let mut random = Random::new(23);
    let mut exchange = Exchange::default();
    let size = comm.size();
    let mut sent = 0;
    for round in 0..60 {
        // Who talks to whom, and how much each way: the same on all ranks.
        let mut length = vec![None; size * size];
        for a in 0..size {
            for b in 0..=a {
                if random.below(3) > 0 {
                    for (from, to) in [(a, b), (b, a)] {
                        let most = [1, 50, 70_000, 3_000_000][random.below(4)];
                        length[from * size + to] = Some(random.below(most));
                    }
                }
            }
        }
        let me = comm.rank();
        let mut peers: Vec<usize> = (0..size)
            .filter(|&r| length[me * size + r].is_some())
            .collect();
        Random::new(me as u64).shuffle(&mut peers);
        exchange.set_peers(peers.iter().copied());
        assert_eq!(exchange.peers(), peers.len());
        for (k, &peer) in peers.iter().enumerate() {
            let bytes = length[me * size + peer].unwrap();
            assert_eq!(exchange.rank(k), peer);
            let message = (0..bytes).map(|at| byte(round, me, peer, at));
            exchange.outgoing(k).extend(message);
            sent += bytes as u64;
            if round % 2 == 0 {
                exchange.expect(k, length[peer * size + me].unwrap());
            }
        }
        if round % 2 == 1 {
            exchange.post_with_sizes(comm);
        } else {
            exchange.post(comm);
        }
        exchange.wait();
        for (k, &peer) in peers.iter().enumerate() {
            let bytes = length[peer * size + me].unwrap();
            let wanted: Vec<u8> = (0..bytes).map(|at| byte(round, peer, me, at)).collect();
            assert!(
                exchange.incoming(k) == wanted,
                "round {round}, {peer} to {me}"
            );
        }
    }
    assert!(exchange.traffic.bytes >= sent);
}

#[test]
fn messages_of_any_size_between_any_ranks() {
    on_each(
        "engine::messages_of_any_size_between_any_ranks",
        &[2, 5],
        exchange_messages,
    );
}

fn balance_work(comm: &Comm) {
    (1..=3).for_each(|levels| balance_work_in(comm, levels));
}

fn balance_work_in(comm: &Comm, levels: usize) {
    let mut particles = scattered(comm, 31);
    let mut migration = Migration::default();
    let mut balance = Balance::default();
    let rank_speeds = RankSpeeds::default();
    let numbers = numbers();
    for round in 1..12_u64 {
        // Work unevenly spread; in the last rounds all particles stand in few places.
        let place = |k: u64| match round {
            10 => [1.0; 3],
            11 => [if k.is_multiple_of(2) { 1.0 } else { 2.0 }; 3],
            _ => position(k, round).map(|x| x.min(LENGTH)),
        };
        let work = |k: u64| u32::try_from(mix(k ^ round) % 1000).unwrap();
        for slot in 0..particles.owned() {
            let k = numbers[&particles.id[slot]];
            particles.position[slot] = place(k);
            particles.work[slot] = work(k);
        }
        let axis = usize::try_from(round % 3).unwrap();
        let axes = [axis, (axis + 1) % 3, (axis + 2) % 3];
        let mut slabs = NestedSlabs::on_first(axes, levels, comm.size());
        let positions = &particles.position[..particles.owned()];
        let all = (positions, particles.work.as_slice());
        balance.cut(comm, &mut slabs, all, &rank_speeds);
        // The same faces everywhere.
        let mut faces = Vec::new();
        let mine: Vec<u64> = slabs.faces().iter().map(|face| face.to_bits()).collect();
        comm.all_gather_u64(&mine, &mut faces);
        assert!(faces.chunks(mine.len().max(1)).all(|theirs| theirs == mine));
        assert!(slabs.is_sorted());

        migration.migrate(comm, &slabs, &mut particles, &[], |_, _| 0.0);
        let share = |k: u64| u64::from(work(k).max(1));
        let mine: u64 = particles.id[..particles.owned()]
            .iter()
            .map(|id| share(numbers[id]))
            .sum();
        let total: u64 = (0..TOTAL).map(share).sum();
        let even = total / comm.size() as u64;
        match round {
            10 => assert!(mine == 0 || mine == total),
            11 => assert!(comm.size() == 1 || mine <= total / 2 + total / 10),
            // A face is off by half of what stands in its plane, which is a particle or two (and
            // those beyond the end of the box, who share the last), once a level.
            _ => assert!(
                mine < even + 2500 * levels as u64,
                "round {round}: {mine} of {total}"
            ),
        }
    }
    // Nobody anywhere: the faces stay.
    let mut slabs = NestedSlabs::of_any([0, 1, 2], levels, vec![1.0; comm.size() - 1]);
    let before = slabs.clone();
    balance.cut(comm, &mut slabs, (&[], &[]), &rank_speeds);
    assert_eq!(slabs, before);
}

/// Rank 0 takes twice as long for the same work: after some balances it has half of what each
/// other rank has; a measurement too short to mean anything changes nothing.
fn balance_paces(comm: &Comm) {
    let (mut balance, mut rank_speeds) = (Balance::default(), RankSpeeds::default());
    let positions: Vec<[f64; 3]> = (0..1000)
        .filter(|k| k % comm.size() == comm.rank())
        .map(|k| [0.001 * f64::from(u32::try_from(k).unwrap()), 0.0, 0.0])
        .collect();
    let mut slabs = NestedSlabs::on_first([0, 1, 2], 1, comm.size());
    let work = vec![1; positions.len()];
    let mut faces = |rank_speeds: &RankSpeeds| {
        balance.cut(comm, &mut slabs, (&positions, &work), rank_speeds);
        slabs.faces().to_vec()
    };
    let even = faces(&rank_speeds);
    let slow = if comm.is_root() { 2.0 } else { 1.0 };
    rank_speeds.measure(comm, 1000, 0.0);
    rank_speeds.measure(comm, 1000, 1e-3 * slow);
    assert_eq!(faces(&rank_speeds), even);
    for round in 1..=20 {
        rank_speeds.measure(comm, 1000, f64::from(round) * slow);
    }
    let ranks = f64::from(u32::try_from(comm.size()).unwrap());
    let first = 1.0 / (2.0 * ranks - 1.0);
    for (r, face) in (0_u32..).zip(faces(&rank_speeds)) {
        let share = first * (1.0 + 2.0 * f64::from(r));
        assert!((face - share).abs() < 0.005, "{r}: {face} {share}");
    }
}

#[test]
fn balance_evens_out_the_work() {
    on_each("engine::balance_evens_out_the_work", &[1, 4], balance_work);
}

#[test]
fn slower_ranks_get_less_work() {
    on_each(
        "engine::slower_ranks_get_less_work",
        &[1, 2, 3],
        balance_paces,
    );
}

/// Its name and a call of all ranks.
type Call = (&'static str, fn(&Comm));

/// What all ranks but the last wait in for it.
const CALLS: &[Call] = &[
    ("barrier", Comm::barrier),
    ("sum", |comm| comm.sum_u64(&mut [1])),
    ("any", |comm| assert!(!comm.any(false))),
    ("join", |comm| comm.join(&mut Joint::default())),
    ("gather", |comm| comm.all_gather_u64(&[1], &mut Vec::new())),
    ("broadcast", |comm| {
        comm.broadcast_from(comm.size() - 1, &mut vec![1]);
    }),
    ("messages", |comm| {
        let mut exchange = Exchange::default();
        exchange.set_peers((0..comm.size()).filter(|&rank| rank != comm.rank()));
        for k in 0..exchange.peers() {
            exchange.outgoing(k).push(1);
        }
        exchange.post_with_sizes(comm);
        exchange.wait();
    }),
];

/// The time in a call that waits is told apart from all other time, whatever the call.
fn wait_for_the_last(comm: &Comm) {
    let late = Duration::from_millis(40);
    for (name, call) in CALLS {
        let [mut all, mut told] = [Duration::ZERO; 2];
        for _ in 0..4 {
            comm.barrier();
            if comm.rank() + 1 == comm.size() {
                let before = waited();
                thread::sleep(late);
                assert_eq!(waited(), before, "sleep is no waiting for others");
                call(comm);
            } else {
                let (start, before) = (Instant::now(), waited());
                call(comm);
                told += waited().saturating_sub(before);
                all += start.elapsed();
            }
        }
        if comm.rank() + 1 < comm.size() {
            assert!(told <= all && told > all / 2, "{name}: {told:?} of {all:?}");
            assert!(all > late, "{name}: nobody was late");
        }
    }
}

/// Whatever phase of the step ranks wait in, friction and the search for parts among them: all time
/// in which a rank does not wait is its work, and no other.
fn waiting_is_no_work(comm: &Comm) {
    let mut case = rubbing();
    case.self_contact = Some(SelfContact {
        overlap: Overlap::default(),
        folds: None,
    });
    let mut simulation = Simulation::start(case, comm).unwrap();
    simulation.timers = Timers::default();
    let before = waited();
    for _ in 0..12 {
        simulation.advance(comm).unwrap();
    }
    let waited = waited().saturating_sub(before).as_secs_f64();
    let all: f64 = simulation.timers.report().map(|(_, seconds)| seconds).sum();
    let busy = simulation.timers.busy();
    // A little time passes between steps, in which nobody waits.
    assert!(waited > 0.0);
    assert!((all - waited - busy).abs() < 1e-9, "{all} {waited} {busy}");
}

#[test]
fn calls_that_wait_are_measured() {
    on_each(
        "engine::calls_that_wait_are_measured",
        &[2, 3],
        wait_for_the_last,
    );
}

#[test]
fn waiting_in_a_phase_is_no_work() {
    on_each(
        "engine::waiting_in_a_phase_is_no_work",
        &[2, 3],
        waiting_is_no_work,
    );
}

/// Steps of cases with all there is: every rank holds what one rank alone
/// computes, to the last bit.
fn step_together(comm: &Comm) {
    for case in CASES {
        let run = |cut: Option<(Axis, usize)>, comm: &Comm| {
            let mut case = case();
            if let Some((axis, levels)) = cut {
                case.domain.axes[0] = Some(axis);
                case.domain.levels = Some(levels.min(case.dimension));
            }
            case.domain.balance_every = 4;
            let mut simulation = Simulation::start(case, comm).unwrap();
            simulation.step_control.poison = true;
            for _ in 0..20 {
                simulation.advance(comm).unwrap();
            }
            measurements::diagnose(&mut simulation, comm);
            simulation
        };
        let alone = Outcome::of(&run(None, &Comm::solo()));
        for (axis, levels) in [(Axis::X, 1), (Axis::Z, 2)] {
            let together = run(Some((axis, levels)), comm);
            compare_with_one(
                &together,
                &alone,
                comm,
                &format!("along {axis:?}, levels {levels}"),
            );
        }
    }
}

/// This rank's share is what one rank alone has of it, and all shares make up the whole.
fn compare_with_one(together: &Simulation, alone: &Outcome, comm: &Comm, what: &str) {
    let share = Outcome::of(together);
    assert_eq!(share.state, alone.state);
    for (id, row) in &share.rows {
        assert!(alone.rows[id] == *row, "particle {id} {what}");
    }
    let mut count = [share.rows.len() as u64];
    comm.sum_u64(&mut count);
    assert_eq!(count, [alone.rows.len() as u64]);
    assert!(together.traffic().0 > 0);
}

#[test]
fn ranks_together_compute_what_one_does_alone() {
    on_each(
        "engine::ranks_together_compute_what_one_does_alone",
        &[2, 4],
        step_together,
    );
}
