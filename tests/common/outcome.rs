//! What runs must have in common to the last bit, and a case with all there is.

use engine::step::measurements;
use std::collections::BTreeMap;

use comm::Comm;
use engine::step::Simulation;
use material::{AfterSpall, Spall};
use model::{
    Case, ContactDirection, ContactMode, Overlap, Resistance, SelfGravity, SmoothingLength, SphForm,
};
use particles::{FieldInfo, HaloPhase, Life, rows as fields};

use super::sphere_on_plate;

/// A case on one rank, without MPI.
pub fn start(case: Case) -> Simulation {
    super::threads::stay_alone();
    Simulation::start(case, &Comm::solo()).unwrap()
}

/// So many steps, each with its sums.
pub fn advance(simulation: &mut Simulation, steps: usize) {
    for _ in 0..steps {
        simulation.advance(&Comm::solo()).unwrap();
        measurements::diagnose(simulation, &Comm::solo());
    }
}

/// All bytes of the particles that a user or the next step can see, by id.
pub fn rows(simulation: &Simulation) -> BTreeMap<u64, Vec<u8>> {
    let particles = &simulation.particles;
    // What is measured for a snapshot alone is in the tests of whole programs.
    let steps = |field: &FieldInfo| !field.halo.contains(HaloPhase::SHOWN);
    let seen = |field: &FieldInfo| field.life == Life::State || field.is_shown() && steps(field);
    let columns = fields(seen).map(|field| (field.kind.bytes(), particles.bytes_or_zeros(field)));
    let columns: Vec<_> = columns.collect();
    let mut rows = BTreeMap::new();
    for slot in 0..particles.owned() {
        let row: &mut Vec<u8> = rows.entry(particles.id[slot]).or_default();
        assert!(row.is_empty(), "an id twice");
        for (size, bytes) in &columns {
            row.extend_from_slice(&bytes[slot * size..(slot + 1) * size]);
        }
    }
    rows
}

/// What two runs must have in common to the last bit.
#[derive(PartialEq)]
pub struct Outcome {
    pub rows: BTreeMap<u64, Vec<u8>>,
    /// As debug output, which is exact.
    pub state: String,
}

impl Outcome {
    pub fn of(simulation: &Simulation) -> Self {
        Self {
            rows: rows(simulation),
            state: format!("{:?}", simulation.state),
        }
    }
}

pub fn assert_same(a: &Outcome, b: &Outcome) {
    assert_eq!(a.state, b.state);
    assert!(a.rows == b.rows, "the particles differ");
}

/// [`everything`] with all options of the SPH sums.
pub fn every_option() -> Case {
    let mut case = everything();
    case.sph.terms.artificial_stress = 0.3;
    case.sph.terms.balsara = true;
    case.sph.terms.conduction = 0.5;
    case.sph.terms.xsph = 0.5;
    case
}

/// A case with all there is: contact, two planes, variable h, plasticity, spall; without options of the
/// SPH sums.
pub fn everything() -> Case {
    let mut case = sphere_on_plate(6e-5, 7000.0, true, 1.0);
    case.sph.smoothing_length = SmoothingLength::Variable { min: 0.6, max: 2.0 };
    case.domain.balance_every = 7;
    case.materials[0].failure.spall = Some(Spall {
        pressure: -1e8,
        after: AfterSpall::Recompacts,
    });
    case
}

/// A case with all loads there are.
pub fn loaded() -> Case {
    let text = include_str!("loaded.toml");
    files::input::parse("tests/common/loaded.toml", text, &[])
        .unwrap_or_else(|error| panic!("{error}"))
}

/// The same with nothing in contact but a block and a plane.
pub fn on_a_plane() -> Case {
    let mut case = loaded();
    for body in &mut case.bodies {
        body.rigid = None;
    }
    case.bodies.drain(..1);
    case.bodies.truncate(1);
    case.loads.velocities.clear();
    case.loads.surfaces.truncate(1);
    case.loads.surfaces[0].bodies = vec![true];
    case
}

/// [`everything`] with friction and damping.
pub fn rubbing() -> Case {
    let mut case = everything();
    case.default_contact = ContactMode::Overlap(Overlap {
        resistance: Resistance {
            static_friction: 0.4,
            kinetic_friction: 0.3,
            damping: 0.1,
        },
        ..Overlap::default()
    });
    case
}

/// All loads with all options of the SPH sums.
pub fn loaded_with_options() -> Case {
    let mut case = loaded();
    case.sph = every_option().sph;
    case
}

/// [`everything`] in the normalised form, with contact along normals.
pub fn normalised() -> Case {
    let mut case = everything();
    case.sph.form = SphForm::Normalised;
    case.default_contact = ContactMode::Overlap(Overlap {
        direction: ContactDirection::Normal,
        ..Overlap::default()
    });
    case
}

/// All loads with all options of the SPH sums in the normalised form.
pub fn loaded_normalised() -> Case {
    let mut case = loaded_with_options();
    case.sph.form = SphForm::Normalised;
    case
}

/// [`rubbing`] with stress points.
pub fn stress_points() -> Case {
    let mut case = rubbing();
    case.sph.form = SphForm::StressPoints;
    case
}

/// All loads with stress points.
pub fn loaded_stress_points() -> Case {
    let mut case = loaded();
    case.sph.form = SphForm::StressPoints;
    case
}

/// [`everything`] with so much self-gravity that all falls together.
pub fn attracting() -> Case {
    let mut case = everything();
    case.loads.self_gravity = Some(SelfGravity {
        constant: 1e7,
        opening_angle: 0.5,
    });
    case
}

/// Without options of the SPH sums and with all, without loads and with all, in all forms,
/// with friction.
pub const CASES: [fn() -> Case; 11] = [
    everything,
    every_option,
    loaded,
    on_a_plane,
    loaded_with_options,
    rubbing,
    normalised,
    loaded_normalised,
    stress_points,
    loaded_stress_points,
    attracting,
];
