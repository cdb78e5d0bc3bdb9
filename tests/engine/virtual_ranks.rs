//! Virtual ranks: their messages and collective calls, their clock, and the step on up to a thousand
//! of them.

use engine::step::measurements;
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::panic::catch_unwind;
use std::thread;
use std::time::Duration;

use crate::bridge;
use crate::common::collectives::{check_collectives, check_parts};
use crate::common::outcome::{Outcome, assert_same};
use crate::common::sentinel::mix;
use crate::common::virtual_ranks::on_virtual_ranks;
use crate::physics_support::{ready, run_to, start};
use comm::{Comm, Computing, Exchange, Joint, Machine, virtual_ranks, waited};
use engine::step::{Phase, Simulation, Timers};
use files::input;
use model::{Axis, Case};

/// Numbers of ranks: one, few, and one that is no power of two, many.
const RANKS: [usize; 6] = [1, 2, 3, 7, 64, 1000];

#[test]
fn collective_calls_give_what_the_numbers_of_all_ranks_give() {
    for ranks in RANKS {
        let done = virtual_ranks(ranks, Machine::IDEAL, |comm| {
            assert_eq!(comm.size(), ranks);
            check_collectives(comm);
            check_parts(comm);
            comm.rank()
        });
        assert!(done.into_iter().eq(0..ranks));
    }
}

/// How much a rank sends to another, if they talk: about eight others.
fn length(round: u64, ranks: usize, from: usize, to: usize) -> Option<usize> {
    let pair = [from.min(to), from.max(to)].map(|rank| rank as u64);
    let talks = mix(pair[0] << 32 ^ pair[1] ^ round).is_multiple_of((ranks as u64).div_ceil(8));
    let most = [1, 60, 4000][usize::try_from(round % 3).unwrap()];
    let bytes = mix((from as u64) << 40 ^ (to as u64) << 20 ^ round) % most;
    (talks && from != to).then(|| usize::try_from(bytes).unwrap())
}

fn byte(round: u64, from: usize, to: usize, at: usize) -> u8 {
    (mix(round ^ (from as u64) << 32 ^ (to as u64) << 16 ^ at as u64) & 255) as u8
}

/// Fills the messages of a round.
fn fill(comm: &Comm, exchange: &mut Exchange, round: u64) {
    let (me, ranks) = (comm.rank(), comm.size());
    let peers = || (0..ranks).filter(|&rank| length(round, ranks, me, rank).is_some());
    exchange.set_peers(peers());
    for (k, peer) in peers().enumerate() {
        assert_eq!(exchange.rank(k), peer);
        let bytes = length(round, ranks, me, peer).unwrap();
        let message = (0..bytes).map(|at| byte(round, me, peer, at));
        exchange.outgoing(k).extend(message);
        exchange.expect(k, length(round, ranks, peer, me).unwrap());
    }
}

fn check_received(comm: &Comm, exchange: &Exchange, round: u64) {
    let (me, ranks) = (comm.rank(), comm.size());
    for k in 0..exchange.peers() {
        let peer = exchange.rank(k);
        let bytes = length(round, ranks, peer, me).unwrap();
        let wanted = (0..bytes).map(|at| byte(round, peer, me, at));
        assert!(exchange.incoming(k).iter().copied().eq(wanted));
    }
}

#[test]
fn messages_come_to_whom_they_are_for() {
    for ranks in RANKS {
        virtual_ranks(ranks, Machine::IDEAL, |comm| {
            let (mut first, mut second) = (Exchange::default(), Exchange::default());
            for round in 0..6 {
                fill(comm, &mut first, round);
                if round % 2 == 1 {
                    first.post_with_sizes(comm);
                } else {
                    first.post(comm);
                }
                // Another exchange, which ends before.
                fill(comm, &mut second, round + 100);
                second.post(comm);
                second.wait();
                first.wait();
                check_received(comm, &first, round);
                check_received(comm, &second, round + 100);
            }
            let time = comm.virtual_time().unwrap();
            let sent = |count: fn(&Exchange) -> u64| count(&first) + count(&second);
            assert_eq!(time.messages, sent(|e| e.traffic.messages));
            assert_eq!(time.bytes, sent(|e| e.traffic.bytes));
            assert_eq!(time.now, 0.0);
        });
    }
}

/// What a panic in the task says.
fn trouble(ranks: usize, task: fn(&Comm)) -> String {
    let result = catch_unwind(|| virtual_ranks(ranks, Machine::IDEAL, task));
    let cause = result.expect_err("a panic");
    let text = cause.downcast_ref::<String>().cloned();
    text.unwrap_or_else(|| (*cause.downcast_ref::<&str>().unwrap()).to_owned())
}

/// One rank's trouble ends all that wait for it, and for those that wait.
#[test]
fn a_panic_of_one_rank_is_that_of_all() {
    let said = trouble(8, |comm| {
        let mut exchange = Exchange::default();
        for round in 0..5 {
            comm.barrier();
            assert!(comm.rank() != 5 || round != 3, "rank 5 has had enough");
            if comm.rank() % 2 == 1 {
                let others = (1..8).step_by(2).filter(|&rank| rank != comm.rank());
                exchange.set_peers(others);
                exchange.post_with_sizes(comm);
                exchange.wait();
            }
        }
    });
    assert_eq!(said, "rank 5 has had enough");
}

#[test]
fn ranks_that_wait_for_nothing_are_told() {
    let tasks: [fn(&Comm); 3] = [
        // One has gone.
        |comm| {
            if comm.rank() != 2 {
                comm.barrier();
            }
        },
        // A ring in which all listen.
        |comm| {
            let mut exchange = Exchange::default();
            let next = (comm.rank() + 1) % comm.size();
            exchange.set_peers(std::iter::once(next));
            exchange.post_with_sizes(comm);
        },
        // Nobody says what all expect.
        |comm| swap(comm, 0, 1),
    ];
    for task in tasks {
        assert!(trouble(4, task).contains("wait for others"));
    }
    let said = trouble(2, |comm| swap(comm, 2, 1));
    assert!(said.contains("a message as expected"), "{said}");
}

/// Pairs of ranks say so many bytes and expect so many.
fn swap(comm: &Comm, said: usize, expected: usize) {
    let mut exchange = Exchange::default();
    exchange.set_peers(std::iter::once(comm.rank() ^ 1));
    exchange.outgoing(0).resize(said, 1);
    exchange.expect(0, expected);
    exchange.post(comm);
    exchange.wait();
}

/// A slow machine of round numbers: ¼ s and 8 bytes a second.
const SLOW: Machine = Machine {
    latency: 0.25,
    bandwidth: 8.0,
    computing: Computing::Reported,
};

/// Bytes of a message, and the time that it takes on [`SLOW`] (s).
const BYTES: usize = 16;
const TRIP: f64 = 2.25;

/// Sends a message to a rank.
fn send(comm: &Comm, to: usize) {
    let mut exchange = Exchange::default();
    exchange.set_peers(std::iter::once(to));
    exchange.outgoing(0).resize(BYTES, 1);
    exchange.post(comm);
}

/// Waits for a message of a rank.
fn receive(comm: &Comm, from: usize) {
    let mut exchange = Exchange::default();
    exchange.set_peers(std::iter::once(from));
    exchange.expect(0, BYTES);
    exchange.post(comm);
    exchange.wait();
}

#[test]
fn a_ball_between_two_ranks_takes_a_trip_each_way() {
    let times = virtual_ranks(2, SLOW, |comm| {
        for _ in 0..10 {
            if comm.is_root() {
                send(comm, 1);
                receive(comm, 1);
            } else {
                receive(comm, 0);
                comm.compute(0.5);
                send(comm, 0);
            }
        }
        comm.virtual_time().unwrap()
    });
    assert_eq!(times[0].now, 10.0 * (2.0 * TRIP + 0.5));
    assert_eq!(times[0].waiting, times[0].now);
    assert_eq!(times[1].now, times[0].now - TRIP);
    assert_eq!(times[1].computing, 5.0);
    assert_eq!([times[0].messages, times[0].bytes], [10, 10 * BYTES as u64]);
}

#[test]
fn a_pipeline_is_as_fast_as_its_stages() {
    let (ranks, parts) = (6, 9);
    let times = virtual_ranks(ranks, SLOW, |comm| {
        for _ in 0..parts {
            if comm.rank() > 0 {
                receive(comm, comm.rank() - 1);
            }
            comm.compute(3.0);
            if comm.rank() + 1 < comm.size() {
                send(comm, comm.rank() + 1);
            }
        }
        comm.virtual_time().unwrap()
    });
    for (rank, time) in (0_u32..).zip(&times) {
        let filling = f64::from(rank) * (3.0 + TRIP);
        assert_eq!(time.waiting, filling);
        assert_eq!(time.now, filling + 3.0 * f64::from(parts));
    }
}

/// Messages of a rank leave one after the other, and computing hides them.
#[test]
fn computing_hides_messages() {
    for (hidden, waiting) in [(0.0, [TRIP, TRIP + 2.0]), (4.0, [0.0, 0.25])] {
        let times = virtual_ranks(3, SLOW, |comm| {
            let mut exchange = Exchange::default();
            if comm.is_root() {
                exchange.set_peers([1, 2].into_iter());
                (0..2).for_each(|k| exchange.outgoing(k).resize(BYTES, 1));
            } else {
                exchange.set_peers(std::iter::once(0));
                exchange.expect(0, BYTES);
            }
            exchange.post(comm);
            comm.compute(hidden);
            exchange.wait();
            comm.virtual_time().unwrap().waiting
        });
        assert_eq!(times, [0.0, waiting[0], waiting[1]]);
    }
}

#[test]
fn collective_calls_cost_what_their_trees_do() {
    type Call = (fn(&Comm), f64);
    let calls: [Call; 5] = [
        (Comm::barrier, 3.0 * 0.25),
        (|comm| comm.sum_u64(&mut [1; 4]), 3.0 * (0.25 + 4.0)),
        // Six words, and no sums.
        (|comm| comm.join(&mut Joint::default()), 3.0 * (0.25 + 6.0)),
        (
            |comm| comm.all_gather_u64(&[1; 4], &mut Vec::new()),
            3.0 * 0.25 + 6.0 * 4.0,
        ),
        (
            |comm| comm.broadcast(&mut vec![1; 16]),
            3.0 * (0.25 + 1.0) + 3.0 * (0.25 + 2.0),
        ),
    ];
    for (call, cost) in calls {
        let times = virtual_ranks(7, SLOW, |comm| {
            comm.compute(f64::from(u32::try_from(comm.rank()).unwrap()));
            call(comm);
            comm.virtual_time().unwrap()
        });
        for time in times {
            assert_eq!(time.now, 6.0 + cost);
            assert_eq!(time.waiting, time.now - time.computing);
            assert_eq!(time.collectives, 1);
        }
    }
}

/// What a rank is measured to compute is its work; what it sleeps or waits is none, and neither is by the phases'
/// clock what is told.
#[test]
fn computing_is_work_and_waiting_is_none() {
    let told = virtual_ranks(4, SLOW, |comm| {
        let mut timers = Timers::default();
        comm.compute(5.0);
        comm.barrier();
        timers.lap(Phase::Momentum);
        timers.busy()
    });
    for busy in told {
        assert!(busy.abs() < 0.05, "{busy}");
    }
    let measured = Machine {
        computing: Computing::Measured,
        ..SLOW
    };
    virtual_ranks(4, measured, |comm| {
        let time = || comm.virtual_time().unwrap();
        let (before, aside) = (time(), waited());
        thread::sleep(Duration::from_millis(200));
        assert!(time().computing - before.computing < 0.05);
        assert!(waited() > aside + Duration::from_millis(150));
        while time().computing - before.computing < 0.05 {
            std::hint::black_box(mix(1));
        }
        let spent = time();
        assert!((spent.now - spent.computing - spent.waiting).abs() < 1e-9);
    });
}

/// The main job with slabs of so many levels.
fn impact(spacing: &str, levels: usize, balance_every: u64) -> Case {
    let mut case = ready("quarter-impact", &[&format!("spacing={spacing}")]);
    case.domain.levels = Some(levels);
    case.domain.axes[0] = Some(Axis::X);
    case.domain.balance_every = balance_every;
    case
}

fn advance(comm: &Comm, simulation: &mut Simulation, steps: usize) {
    simulation.step_control.poison = true;
    for _ in 0..steps {
        simulation.advance(comm).unwrap();
    }
    measurements::diagnose(simulation, comm);
}

/// What so many virtual ranks make of a start in so many steps, joined.
fn together(ranks: usize, steps: usize, start: impl Fn(&Comm) -> Simulation + Sync) -> Outcome {
    let shares = on_virtual_ranks(ranks, Machine::IDEAL, |comm| {
        let mut simulation = start(comm);
        advance(comm, &mut simulation, steps);
        assert!(simulation.traffic().0 > 0);
        Outcome::of(&simulation)
    });
    joined(shares)
}

fn joined(shares: Vec<Outcome>) -> Outcome {
    let mut all = Outcome {
        rows: BTreeMap::new(),
        state: shares[0].state.clone(),
    };
    for share in shares {
        assert_eq!(share.state, all.state);
        for (id, row) in share.rows {
            let before = all.rows.insert(id, row);
            assert!(before.is_none(), "particle {id} is on two ranks");
        }
    }
    all
}

/// Once to agree on who goes where, once to join sums and candidates. Who hangs together takes more, every few
/// steps.
#[test]
fn a_common_step_calls_all_ranks_together_twice() {
    let counts = on_virtual_ranks(6, Machine::IDEAL, |comm| {
        let mut case = impact("0.05mm", 2, 0);
        case.self_contact = None;
        let mut simulation = Simulation::start(case, comm).unwrap();
        let mut count = |_| {
            let before = comm.virtual_time().unwrap().collectives;
            simulation.advance(comm).unwrap();
            comm.virtual_time().unwrap().collectives - before
        };
        (0..12).map(&mut count).collect::<Vec<_>>()
    });
    for counts in counts {
        assert_eq!(counts, [2; 12]);
    }
}

/// From a state of the main job in which sphere and plate have failed and fly apart in parts, with
/// all particles on one rank at first.
#[test]
#[ignore = "slow"]
fn debris_on_any_ranks_is_that_on_one() {
    let mut begun = start(impact("0.05mm", 1, 4));
    run_to(&mut begun, 0.12e-6);
    assert!(begun.state.totals.failed_mass > 0.0);
    let mut saved = begun.particles.clone();
    saved.resize_halo(0);
    saved.poison();
    let state = begun.state.clone();
    let resume = |comm: &Comm, levels: usize| {
        let mine = if comm.is_root() {
            saved.clone()
        } else {
            let mut none = saved.clone();
            none.resize_owned(0);
            none
        };
        Simulation::resume(impact("0.05mm", levels, 4), comm, state.clone(), mine).unwrap()
    };
    let solo = Comm::solo();
    let mut alone = resume(&solo, 1);
    advance(&solo, &mut alone, 12);
    let alone = Outcome::of(&alone);
    for ranks in [2, 3, 5, 8, 12, 16, 64] {
        for levels in 1..=3 {
            let all = together(ranks, 12, |comm| resume(comm, levels));
            assert_same(&all, &alone);
        }
    }
}

/// From the first step on, with faces that move.
#[test]
fn two_hundred_ranks_compute_what_one_does() {
    many_compute_what_one_does(200, "0.05mm");
}

#[test]
#[ignore = "slow: a thousand threads that wait for each other"]
fn a_thousand_ranks_compute_what_one_does() {
    many_compute_what_one_does(1000, "0.03mm");
}

fn many_compute_what_one_does(ranks: usize, spacing: &str) {
    are_as_one(ranks, &impact(spacing, 3, 2));
}

/// Cubes of eight particles, `counts` along each axis, of which every other one flies towards its neighbour.
fn crowd(counts: [u32; 3]) -> Case {
    let mut text =
        "dimension = 3\nspacing = \"0.1 mm\"\nrun.end_time = \"1 us\"\ndomain.levels = 3\n\
                    domain.balance_every = 2\nmaterial.metal.library = \"aluminium-2024\"\n"
            .to_owned();
    for k in 0..counts.iter().product() {
        let place = [
            k % counts[0],
            k / counts[0] % counts[1],
            k / (counts[0] * counts[1]),
        ];
        let [x, y, z] = place.map(|n| 3 * n);
        let speed = if place[0].is_multiple_of(2) { 500 } else { 0 };
        let corner = |shift: u32| {
            let at = [x, y, z].map(|n| format!("\"{} um\"", 100 * (n + shift)));
            at.join(", ")
        };
        let _ = write!(
            text,
            "[[body]]\nname = \"b{k}\"\nmaterial = \"metal\"\nlattice = \"cubic\"\nvelocity = [\"{speed} m/s\", 0, 0]\n\
             shape.box = {{ lower = [{}], upper = [{}] }}\n",
            corner(0),
            corner(2)
        );
    }
    input::parse("crowd", &text, &[]).unwrap()
}

/// Each virtual rank holds the whole case: of a hundred thousand bodies 64 of them would take 160 GB.
#[test]
#[ignore = "slow: a thousand bodies on 64 ranks"]
fn a_thousand_bodies_on_64_ranks_are_as_on_one() {
    are_as_one(64, &crowd([10, 10, 10]));
}

fn are_as_one(ranks: usize, case: &Case) {
    let begin = |comm: &Comm| Simulation::start(case.clone(), comm).unwrap();
    let solo = Comm::solo();
    let mut alone = begin(&solo);
    advance(&solo, &mut alone, 4);
    let all = together(ranks, 4, begin);
    assert_same(&all, &Outcome::of(&alone));
}

/// What flies apart is cut otherwise while the run goes on, and nothing that comes out depends on it.
#[test]
fn levels_that_change_on_the_way_change_no_bit() {
    let case = || {
        let text = include_str!("../common/spreading.toml");
        input::parse("tests/common/spreading.toml", text, &[]).unwrap()
    };
    let (solo, steps) = (Comm::solo(), 40);
    let mut alone = Simulation::start(case(), &solo).unwrap();
    advance(&solo, &mut alone, steps);
    let alone = Outcome::of(&alone);
    for (ranks, last) in [(8, 1), (13, 3)] {
        let cuts = |simulation: &Simulation| {
            let slabs = simulation.slabs();
            (slabs.levels(), slabs.axis(0))
        };
        let shares = on_virtual_ranks(ranks, Machine::IDEAL, |comm| {
            let mut simulation = Simulation::start(case(), comm).unwrap();
            let begun = cuts(&simulation);
            advance(comm, &mut simulation, steps);
            let told = (begun, cuts(&simulation), simulation.changes_of_slabs());
            (told, Outcome::of(&simulation))
        });
        let (told, shares): (Vec<_>, Vec<_>) = shares.into_iter().unzip();
        println!("{ranks} ranks: {:?}", told[0]);
        assert!(told.iter().all(|of_rank| *of_rank == told[0]));
        let (begun, ended, changes) = told[0];
        assert!(begun.0 > 1 && changes > 0, "{:?}", told[0]);
        // Along z, and only where plates are fewer than ranks also across.
        assert_eq!(ended, (last, 2));
        assert_same(&joined(shares), &alone);
    }
    // Named levels stay.
    let changes = on_virtual_ranks(8, Machine::IDEAL, |comm| {
        let mut case = case();
        case.domain.levels = Some(2);
        let mut simulation = Simulation::start(case, comm).unwrap();
        advance(comm, &mut simulation, steps);
        assert_eq!(simulation.slabs().levels(), 2);
        simulation.changes_of_slabs()
    });
    assert_eq!(changes, [0; 8]);
}

/// Faces move every few steps, what sleeps comes to other ranks, and ranks on which some sleeps get more.
#[test]
fn what_sleeps_on_ranks_is_told_its_parts() {
    let solo = Comm::solo();
    let mut alone = Simulation::start(bridge::case(), &solo).unwrap();
    alone.search.lists.spare_quiescent = false;
    for _ in 0..bridge::STEPS {
        bridge::advance(&mut alone, &solo);
    }
    bridge::assert_apart(&alone.particles.part[..alone.particles.owned()]);
    let alone = Outcome::of(&alone);
    for ranks in [2, 5] {
        let shares = on_virtual_ranks(ranks, Machine::IDEAL, |comm| {
            let mut simulation = Simulation::start(bridge::case(), comm).unwrap();
            let (mut asleep, mut grown) = (0, 0);
            for _ in 0..bridge::STEPS {
                let before = (simulation.inactive(), simulation.particles.owned());
                bridge::advance(&mut simulation, comm);
                grown += usize::from(before.0 > 0 && before.1 < simulation.particles.owned());
                asleep = asleep.max(simulation.inactive());
            }
            ((asleep, grown), Outcome::of(&simulation))
        });
        let (told, shares): (Vec<_>, Vec<_>) = shares.into_iter().unzip();
        println!("{ranks} ranks: asleep at most, grown {told:?}");
        assert!(told.iter().any(|(asleep, _)| *asleep > 0));
        assert_same(&joined(shares), &alone);
    }
}
