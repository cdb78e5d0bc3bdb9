//! Which fields a case has use for.

use crate::contact::{Connectivity, ContactTable};
use crate::model::{Case, SphForm, TroublePolicy};
use crate::particles::{FieldUse, with_use};
use crate::sph::Sph;

/// Fields that a case has no use for.
pub(super) fn unused_fields(case: &Case, contact: &ContactTable) -> FieldUse {
    let sph = &case.sph;
    let driven = !case.loads.velocities.is_empty() || case.bodies.iter().any(|b| b.rigid.is_some());
    [
        (FieldUse::CONTACT, contact.is_active()),
        (FieldUse::PENALTY, contact.has_penalty()),
        (FieldUse::LOADS, driven),
        (FieldUse::FRICTION, contact.has_friction()),
        (FieldUse::SELF_CONTACT, case.self_contact.is_some()),
        (
            FieldUse::FOLDS,
            case.self_contact.is_some_and(|s| s.folds.is_some()),
        ),
        (FieldUse::SURFACE_FRICTION, case.loads.has_friction()),
        (FieldUse::BALSARA, sph.balsara),
        (FieldUse::CONDUCTION, sph.conduction > 0.0),
        (FieldUse::XSPH, sph.xsph > 0.0),
        (FieldUse::NORMALISED, sph.form == SphForm::Normalised),
        (
            FieldUse::FREEZE,
            case.trouble.policy == TroublePolicy::Freeze,
        ),
        (FieldUse::STRESS_POINTS, sph.form == SphForm::StressPoints),
    ]
    .into_iter()
    .filter(|&(_, used)| !used)
    .fold(FieldUse::default(), |all, (fields, _)| all.with(fields))
}

/// Bytes that the options of a case add beyond contact without friction: to an owned particle, and
/// to a halo particle with its messages.
#[must_use]
pub fn bytes_of_options(case: &Case) -> [usize; 2] {
    let contact = ContactTable::new(case);
    let unused = unused_fields(case, &contact).with(FieldUse::CONTACT);
    let fields = || with_use(FieldUse::OPTIONAL).filter(|field| !field.uses.meets(unused));
    let owned: usize = fields().map(|field| field.kind.bytes()).sum();
    let halo = fields().filter(|field| field.uses.meets(FieldUse::ANY_HALO));
    let halo: usize = halo.map(|field| field.kind.bytes()).sum();
    let record = Sph::bytes_of_records(case) + Connectivity::bytes_of_image(case);
    // In the store, and in a message on its way out and in.
    [owned + record, 3 * halo + record]
}
