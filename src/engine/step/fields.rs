//! Fields that a case uses.

use crate::contact::{Connectivity, ContactTable};
use crate::fragments::{BYTES_OF_SEARCH, Labels};
use crate::sph::Sph;
use model::{Body, Case, NumericalFailurePolicy, SphForm};
use particles::{FieldInfo, HaloPhase, Owner, ParticleStore, Select, rows};

/// Options of the table of fields that a case does not have.
pub(super) fn unused_fields(case: &Case, contact: &ContactTable) -> Owner {
    let sph = &case.sph;
    let driven = !case.loads.velocities.is_empty() || case.bodies.iter().any(|b| b.rigid.is_some());
    let localises = case.any_material(|material| material.failure.localises());
    let used = [
        (Owner::LOADS, driven),
        (Owner::FREE_RIGID, case.bodies.iter().any(Body::is_free)),
        (Owner::PRESSURES, !case.loads.pressures.is_empty()),
        (Owner::SELF_GRAVITY, case.loads.self_gravity.is_some()),
        (Owner::ABSORBERS, !case.loads.absorbers.is_empty()),
        (Owner::SELF_CONTACT, case.self_contact.is_some()),
        (
            Owner::FOLDS,
            case.self_contact.is_some_and(|s| s.folds.is_some()),
        ),
        (Owner::SURFACE_FRICTION, case.loads.has_friction()),
        (Owner::FAILURE, case.may_fail()),
        (Owner::SOFTENING, case.fails_with("failure_onset")),
        (Owner::LOCALISED, localises),
        (Owner::TOTAL, case.bodies.iter().any(|body| body.total)),
        (Owner::FLAWS, case.fails_with("flaws")),
        (Owner::POROUS, case.is_porous()),
        (Owner::EXPLOSIVE, case.is_explosive()),
        (Owner::BULKING, case.fails_with("bulking_pressure")),
        (Owner::YIELD, case.may_yield()),
        (Owner::DIRECTIONS, case.has_directions()),
        (Owner::CRACKS, case.fails_with("delamination")),
        (Owner::CARRIERS, case.measure.marks_particles()),
        (Owner::WITNESSES, !case.measure.witnesses.is_empty()),
        (Owner::CONVENTIONAL, sph.form == SphForm::Conventional),
        (Owner::CORRECTED, sph.form == SphForm::Corrected),
        (Owner::NORMALISED, sph.form == SphForm::Normalised),
        (
            Owner::FREEZE,
            case.numerical_limits.policy == NumericalFailurePolicy::Freeze,
        ),
        (Owner::STRESS_POINTS, sph.form == SphForm::StressPoints),
    ]
    .into_iter()
    .filter(|&(_, used)| used)
    .fold(Owner::of_terms(&sph.terms), |all, (option, _)| all | option);
    Owner::all().difference(used | contact.owners() | records(case))
}

/// Fields that particles have because snapshots or gauges are to show them.
fn records(case: &Case) -> Owner {
    let gauges = case.measure.gauges.iter().flat_map(|gauge| &gauge.fields);
    let names: Vec<&String> = case.output.all_fields().chain(gauges).collect();
    let records = rows(Owner::PEAKS).filter(|field| names.iter().any(|name| *name == field.name));
    records.fold(Owner::empty(), |all, field| all | field.owner)
}

/// A store without particles, with the fields that a case has use for.
#[must_use]
pub fn store_of(case: &Case) -> ParticleStore {
    let mut particles = ParticleStore::default();
    particles.drop_fields(unused_fields(case, &ContactTable::of_kinds(case)));
    particles
}

/// Bytes of a halo particle in each message of a step between two ranks: its motion, with the mirror masks of
/// its images; its fields for the forces; its friction, if there is any.
#[must_use]
pub fn bytes_of_messages(case: &Case) -> Vec<usize> {
    let (contact, store) = (ContactTable::of_kinds(case), store_of(case));
    let mut messages = vec![
        1 + store.bytes_per_particle(store.motion_phase()),
        store.bytes_per_particle(contact.halo | Sph::halo_of_forces(case)) + Sph::bytes_shown(case),
    ];
    if contact.has_friction() {
        messages.push(store.bytes_per_particle(HaloPhase::FRICTION));
    }
    messages
}

/// Bytes that the options of a case add beyond contact without friction: to an owned particle, and
/// to a halo particle with its messages.
#[must_use]
pub fn bytes_of_options(case: &Case) -> [usize; 2] {
    let contact = ContactTable::of_kinds(case);
    let unused = unused_fields(case, &contact) | Owner::CONTACT;
    let fields = || rows(FieldInfo::is_optional).filter(|field| field.is_held_without(unused));
    let owned: usize = fields().map(|field| field.kind.bytes()).sum();
    let phases = store_of(case).halo_phases();
    let halo = fields().filter(|field| phases.takes(field));
    let halo: usize = halo.map(|field| field.kind.bytes()).sum();
    let halo = halo + Sph::bytes_shown(case);
    let mut record = Sph::bytes_of_records(case) + Connectivity::bytes_of_image(case);
    if case.fragments.is_some() {
        record += Labels::BYTES + BYTES_OF_SEARCH;
    }
    // In the store, and in a message on its way out and in.
    [owned + record, 3 * halo + record]
}
