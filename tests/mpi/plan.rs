//! What a plan tells of any number of ranks is what the counters of real runs say, to the unit.

use crate::common::outcome::{everything, rubbing, stress_points};
use crate::ranks::on_each;
use comm::{Comm, Traffic};
use engine::sph::Smoothing;
use engine::step::{Simulation, bytes_of_messages};
use files::plan::{Load, Particles, loads, loads_of, slabs_at_start, slabs_of};
use model::Case;

/// Steps that are compared, through the impact and several balances.
const STEPS: usize = 50;

/// All particles of a run, on every rank. Collective.
fn gathered(comm: &Comm, simulation: &Simulation) -> Particles {
    let (particles, smoothing) = (&simulation.particles, Smoothing::new(&simulation.case));
    let owned = particles.owned();
    let longest = {
        let mut most = [owned as u64];
        comm.max_u64(&mut most);
        usize::try_from(most[0]).unwrap()
    };
    let mut words = Vec::new();
    for (i, position) in particles.position[..owned].iter().enumerate() {
        let [x, y, z] = *position;
        words.extend([x, y, z, smoothing.reach(particles, i)].map(f64::to_bits));
    }
    words.resize(4 * longest, u64::MAX);
    let mut all = Vec::new();
    comm.all_gather_u64(&words, &mut all);
    let mut gathered = Particles::default();
    for row in all.chunks_exact(4).filter(|row| row[0] != u64::MAX) {
        let [x, y, z, reach] = [0, 1, 2, 3].map(|k| f64::from_bits(row[k]));
        gathered.add(0, [x, y, z], reach);
    }
    gathered
}

/// What a rank has and has sent, as its own counters tell.
fn counted(simulation: &Simulation) -> (u64, u64, usize, usize, Traffic) {
    let (particles, halo) = (&simulation.particles, simulation.halo());
    let (owned, others) = (particles.owned() as u64, particles.halo() as u64);
    let (images, peers) = (halo.others().len(), halo.peers().len());
    (owned, others, images, peers, halo.traffic())
}

/// Asserts that the plan for the faces of a run tells what its counters do, with what was sent since
/// `before` in so many searches, and in what else a step sends once. Collective.
fn assert_told(comm: &Comm, simulation: &Simulation, before: Traffic, searches: u64, what: &str) {
    let all = gathered(comm, simulation);
    let told = loads(&simulation.case, &all, simulation.slabs(), 1);
    assert_eq!(told.len(), comm.size());
    let Load {
        tally,
        sent,
        beyond,
        late,
    } = told[comm.rank()];
    let (owned, halo, images, peers, traffic) = counted(simulation);
    let what = format!("{what}, rank {}", comm.rank());
    assert_eq!(tally.owned, owned, "owned: {what}");
    assert_eq!(tally.halo, halo, "halo: {what}");
    assert_eq!(tally.images, images as u64, "images: {what}");
    assert_eq!(tally.peers, peers as u64, "peers: {what}");
    let since = traffic - before;
    let motion = &bytes_of_messages(&simulation.case)[..1];
    let search = loads_of(&simulation.case, &all, simulation.slabs(), 1, motion)[comm.rank()].sent;
    let more = searches - 1;
    assert_eq!(
        sent.messages + more * search.messages,
        since.messages,
        "messages: {what}"
    );
    assert_eq!(
        sent.bytes + more * search.bytes,
        since.bytes,
        "bytes: {what}"
    );
    assert_eq!(late, sent.bytes - search.bytes, "late: {what}");
    assert_eq!(sent, beyond, "each rank has a node of its own: {what}");
}

/// Through the impact, on levels of all numbers.
fn follow(comm: &Comm, case: &Case, name: &str) {
    for levels in 1..=3 {
        let mut case = case.clone();
        case.domain.levels = Some(levels);
        let what = format!("{name}, {levels} levels");
        let start = Particles::at_start(&case);
        let told = slabs_at_start(&case, &start, comm.size(), None).unwrap();
        let mut simulation = Simulation::start(case, comm).unwrap();
        assert_eq!(&told, simulation.slabs(), "faces: {what}");
        // Two searches come before the first forces.
        assert_told(comm, &simulation, Traffic::default(), 2, &what);
        for step in 1..=STEPS {
            let before = simulation.halo().traffic();
            simulation.advance(comm).unwrap();
            assert_told(
                comm,
                &simulation,
                before,
                1,
                &format!("{what}, step {step}"),
            );
        }
    }
}

const RANKS: [usize; 6] = [2, 3, 5, 8, 12, 16];

#[test]
#[ignore = "slow"]
fn a_plan_is_what_counters_tell_of_an_impact() {
    let test = "plan::a_plan_is_what_counters_tell_of_an_impact";
    on_each(test, &RANKS, |comm| follow(comm, &everything(), "impact"));
}

#[test]
fn a_plan_is_what_counters_tell_of_friction() {
    let test = "plan::a_plan_is_what_counters_tell_of_friction";
    on_each(test, &[3, 8], |comm| follow(comm, &rubbing(), "friction"));
}

#[test]
#[ignore = "slow"]
fn a_plan_is_what_counters_tell_of_stress_points() {
    let test = "plan::a_plan_is_what_counters_tell_of_stress_points";
    let case = stress_points();
    on_each(test, &[2, 5], |comm| follow(comm, &case, "stress points"));
}

/// From later particles, as from a checkpoint, the faces are those with which a run goes on.
#[test]
fn later_particles_are_cut_as_a_restart_cuts_them() {
    let test = "plan::later_particles_are_cut_as_a_restart_cuts_them";
    on_each(test, &[3, 8], |comm| {
        let mut simulation = Simulation::start(everything(), comm).unwrap();
        for _ in 0..10 {
            simulation.advance(comm).unwrap();
        }
        let all = gathered(comm, &simulation);
        let (case, state) = (simulation.case.clone(), simulation.state.clone());
        let told = slabs_of(&case, &all, comm.size(), None).unwrap();
        let mut particles = simulation.particles;
        particles.resize_halo(0);
        particles.work.fill(0);
        let resumed = Simulation::resume(case, comm, state, particles).unwrap();
        assert_eq!(&told, resumed.slabs());
    });
}
