//! Options that go with `form = "stress_points"`.

use std::ops::Range;

use super::contact::without_sums;
use crate::input::source::Diagnostic;
use model::{Body, Case, LatticeKind, Shape, SphForm};

/// Stress points stand between the particles of cubic lattices, and have the sums of no pair of
/// particles that the options of these could act in.
pub fn check(case: &Case, at: Option<Range<usize>>) -> Result<(), Diagnostic> {
    let Some(at) = at.filter(|_| case.sph.form == SphForm::StressPoints) else {
        return Ok(());
    };
    let refuse = |title: String, help: &str| Err(Diagnostic::new(at.clone(), title).help(help));
    if let Some((_, key)) = case.sph.terms.acting().next() {
        let title = format!("stress points have no pairs of particles that `{key}` could act in");
        return refuse(
            title,
            "leave it out, or take \"conventional\" or \"normalised\"",
        );
    }
    let mut bodies = case.bodies.iter();
    if let Some(body) = bodies.find(|b| b.rigid.is_none() && b.lattice.kind != LatticeKind::Cubic) {
        let title = format!(
            "stress points stand between the particles of cubic lattices, and that of `{}` is \
             hexagonal",
            body.name
        );
        return refuse(
            title,
            "take a cubic lattice, which may be turned by an `angle`",
        );
    }
    let is_straight = |b: &Body| !matches!(b.shape, Shape::Solid(_)) && b.lattice.axis.is_none();
    if let Some(body) = case
        .bodies
        .iter()
        .find(|b| b.rigid.is_none() && !is_straight(b))
    {
        let title = format!("stress points cannot fill the shape of `{}`", body.name);
        return refuse(title, "take a box, a sphere or a cylinder along an axis");
    }
    let n = case.bodies.len();
    let named = case.contacts.iter().map(|pair| &pair.mode);
    let others = (case.contacts.len() < n * (n - 1) / 2).then_some(&case.default_contact);
    let mut modes = named.chain(others);
    if let Some(mode) = modes.find(|mode| mode.needs_sums()) {
        let mode = mode.name();
        let title = format!(
            "contact of mode `{mode}` needs sums over pairs of particles of a body, which stress \
             points do without"
        );
        return refuse(title, &format!("take {}", without_sums()));
    }
    if case.self_contact.is_some() {
        let title = "`self_contact` tells parts by the neighbours of particles in their body, which \
                     stress points do without";
        return refuse(title.to_owned(), "leave it out, or take another form");
    }
    Ok(())
}
