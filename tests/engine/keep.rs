//! The box of interest: what leaves it is taken out with all that it carries booked, and what stays is
//! not kicked.

use crate::common::outcome::{advance, start};
use crate::common::{SPACING, ball, case, make_elastic, planes, sphere_on_plate};
use comm::Comm;
use engine::step::StepError;
use engine::step::measurements;
use model::{Axis, Case, ContactMode, Heat, Motion, Profile, Region, SelfGravity, SphForm, Vec3};
use numerics::vector::norm;

/// What is above and below some distances (spacings) from the origin.
fn region(above: [f64; 3], below: [f64; 3]) -> Region {
    Region {
        above: above.map(|x| x * SPACING),
        below: below.map(|x| x * SPACING),
    }
}

const FAR: f64 = f64::INFINITY;

/// Half of a hot ball that spins, flies and falls while it bursts.
fn bursting(form: SphForm) -> Case {
    let mut case = case(3, vec![ball("hot", 0.0, 5.0, 600.0)], 1.0);
    case.sph.form = form;
    case.bodies[0].initial.heat = Heat::Energy(Profile::Constant(3e6));
    case.bodies[0].angular_velocity = Vec3::new(0.0, 4e5, 0.0);
    case.loads.gravity = [1e8, 0.0, -2e8];
    case.symmetry = planes(&[Axis::Y]);
    case.domain.keep = Some(region([-5.5, -FAR, -FAR], [FAR, 5.5, 6.5]));
    case
}

#[test]
fn all_that_leaves_is_booked_to_rounding() {
    for form in [
        SphForm::Corrected,
        SphForm::Conventional,
        SphForm::Normalised,
        SphForm::StressPoints,
    ] {
        let mut simulation = start(bursting(form));
        let first = simulation.state.totals;
        let particles = simulation.particles.owned() as u64;
        advance(&mut simulation, 400);
        let state = &simulation.state;
        let gone = &state.departed[0];
        let left = simulation.particles.owned() as u64;
        assert_eq!(gone.particles + left, particles);
        assert!(gone.particles > 40 && left > particles / 10, "{gone:?}");
        let [begin, end] = gone.times.unwrap();
        assert!(0.0 < begin && begin < end && end <= state.time);
        let mass = state.totals.mass + gone.mass;
        assert!((mass / first.mass - 1.0).abs() < 1e-14);
        let worst = &state.worst;
        let momentum = worst.momentum_error.into_iter().fold(0.0, f64::max);
        let turn = worst.angular_momentum_error.into_iter().fold(0.0, f64::max);
        eprintln!(
            "{form:?}: {} of {particles} left, energy {:.1e}, momentum {momentum:.1e}, angular {turn:.1e}",
            gone.particles, worst.energy_error
        );
        assert!(worst.energy_error < 1e-12 && momentum < 1e-12);
        // The other forms do not keep angular momentum where there is stress.
        assert!(turn < 1e-12 || form != SphForm::Corrected);
        assert!(state.removed.is_empty());
    }
}

/// What leaves takes the energy along that ties it to all others, and momentum is booked with the error of the tree.
#[test]
fn what_leaves_takes_its_share_of_self_gravity() {
    let mut case = bursting(SphForm::Corrected);
    let before = start(case.clone());
    let radius = (before.particles.position.iter()).fold(0.0, |most: f64, x| most.max(x[1]));
    let totals = before.state.totals;
    case.loads.self_gravity = Some(SelfGravity {
        constant: 0.2 * totals.internal_energy * radius / (totals.mass * totals.mass),
        opening_angle: 0.5,
    });
    let mut simulation = start(case);
    advance(&mut simulation, 400);
    let state = &simulation.state;
    let (gone, worst) = (&state.departed[0], &state.worst);
    let momentum = worst.momentum_error.into_iter().fold(0.0, f64::max);
    let turn = worst.angular_momentum_error.into_iter().fold(0.0, f64::max);
    let tied = state.departed_self_gravity_energy / state.initial.self_gravity_energy;
    let drift = norm(&state.tree_impulse) / state.most_momentum;
    eprintln!(
        "{} left with {tied:.2} of the energy of self-gravity, energy {:.1e}, momentum {momentum:.1e}, angular {turn:.1e}, \
         by the tree {drift:.1e}",
        gone.particles, worst.energy_error
    );
    assert!(gone.particles > 40 && tied > 0.01);
    assert!(worst.energy_error < 1e-3 && momentum < 1e-12 && turn < 1e-12);
    assert!(0.0 < drift && drift < 1e-3);
}

/// What flies without stress goes on as it did to the last bit while one layer after the other leaves.
#[test]
fn what_stays_is_not_kicked() {
    let mut case = case(3, vec![ball("ball", 0.0, 5.0, 3000.0)], 1.0);
    case.domain.keep = Some(region([-FAR; 3], [FAR, FAR, 8.0]));
    let mut simulation = start(case);
    let (mut counts, mut cuts) = (simulation.particles.owned(), 0);
    let error = loop {
        if let Err(error) = simulation.advance(&Comm::solo()) {
            break error;
        }
        let particles = &simulation.particles;
        cuts += usize::from(particles.owned() < counts);
        counts = particles.owned();
        for i in 0..counts {
            assert_eq!(
                particles.velocity[i].map(f64::to_bits),
                [0.0, 0.0, 3000.0].map(f64::to_bits)
            );
            assert_eq!(particles.density[i].to_bits(), 2785.0_f64.to_bits());
        }
        measurements::diagnose(&mut simulation, &Comm::solo());
    };
    assert!(cuts >= 3, "{cuts}");
    assert!(matches!(error, StepError::NothingLeft { .. }), "{error}");
    assert!(error.to_string().contains("domain.keep"), "{error}");
    assert!(simulation.state.worst.energy_error < 1e-14);
}

/// A ball that vibrates while another one leaves: the bits of its velocities by id.
fn beside(keep: Option<Region>) -> Vec<(u64, [u64; 3])> {
    let mut case = case(
        3,
        vec![
            ball("stays", 0.0, 4.0, 0.0),
            ball("goes", 12.0, 3.0, 2000.0),
        ],
        1.0,
    );
    make_elastic(&mut case);
    case.default_contact = ContactMode::None;
    case.bodies[0].density = Some(2785.0 * 1.02);
    // The step does not depend on who is there.
    case.time_step.max = 2e-9;
    case.domain.keep = keep;
    let mut simulation = start(case);
    advance(&mut simulation, 150);
    let gone = simulation.state.departed.iter();
    let gone: Vec<bool> = gone.map(|gone| gone.particles > 0).collect();
    assert_eq!(
        gone,
        if keep.is_some() {
            vec![false, true]
        } else {
            vec![]
        }
    );
    let particles = &simulation.particles;
    let mut found: Vec<_> = (0..particles.owned())
        .filter(|&i| particles.body[i] == 0)
        .map(|i| (particles.id[i], particles.velocity[i].map(f64::to_bits)))
        .collect();
    found.sort_unstable();
    found
}

/// Its forces are summed anew when others leave, and have the same bits.
#[test]
fn bodies_that_others_leave_go_on_as_they_did() {
    let with = beside(Some(region([-FAR; 3], [FAR, FAR, 18.0])));
    assert!(with == beside(None));
}

/// A rigid body is no debris.
#[test]
fn a_rigid_body_stays_wherever_it_goes() {
    let mut case = case(
        3,
        vec![ball("ball", 0.0, 3.0, 0.0), ball("tool", 20.0, 3.0, 2000.0)],
        1.0,
    );
    case.bodies[1].rigid = Some(Motion::constant([0.0, 0.0, 2000.0]));
    case.domain.keep = Some(region([-FAR; 3], [FAR, FAR, 5.0]));
    let mut simulation = start(case);
    let particles = simulation.particles.owned();
    advance(&mut simulation, 40);
    assert_eq!(simulation.particles.owned(), particles);
}

/// Where bodies press, the energy of contact that goes is booked.
#[test]
fn contact_that_is_cut_gives_its_energy_away() {
    let defect = |keep: Option<Region>| {
        let mut case = sphere_on_plate(SPACING, 7e3, true, 1.0);
        case.domain.keep = keep;
        let mut simulation = start(case);
        advance(&mut simulation, 60);
        let state = &simulation.state;
        let departed = state.departed_contact_energy / state.initial.kinetic_energy;
        (
            state.worst.contact_defect,
            state.worst.energy_error,
            departed,
        )
    };
    let (defect_0, error_0, _) = defect(None);
    let (defect, error, departed) = defect(Some(region([-FAR, -FAR, -2.5], [FAR; 3])));
    eprintln!("defect {defect_0:.1e} and {defect:.1e}, departed {departed:.1e}");
    assert!(departed.abs() > 1e-6);
    assert!(defect < 1.5 * defect_0 && error < 1.5 * error_0);
}
