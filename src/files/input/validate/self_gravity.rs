//! `[self_gravity]`, and what does not go with it.

use crate::input::schema::CaseParams;
use crate::input::source::Diagnostic;
use model::{Case, SelfGravity, SphForm};

/// Self-gravity of a case that is whole but for it, if there is any.
pub fn self_gravity(case: &Case, params: &CaseParams) -> Result<Option<SelfGravity>, Diagnostic> {
    let Some(table) = &params.self_gravity else {
        return Ok(None);
    };
    let options = SelfGravity {
        constant: table.get_ref().constant()?,
        opening_angle: table.get_ref().opening_angle()?,
    };
    let refused = |title: String, help: &str| Err(Diagnostic::new(table.span(), title).help(help));
    if case.dimension != 3 {
        let title = format!(
            "bodies in {} dimensions are infinite, and so is their gravity",
            case.dimension
        );
        return refused(title, "`self_gravity` takes `dimension = 3`");
    }
    if let Some(body) = case.bodies.iter().find(|body| body.rigid.is_some()) {
        let title = format!(
            "the rigid body `{}` has no mass that could attract",
            body.name
        );
        return refused(title, "leave `self_gravity` out, or let the body deform");
    }
    if !params.absorb.is_empty() {
        let title = "absorbing zones stand for matter without end, whose gravity nobody knows";
        return refused(title.to_owned(), "leave out `[[absorb]]` or `self_gravity`");
    }
    if case.sph.form == SphForm::StressPoints {
        let title = "stress points do not know self-gravity";
        return refused(title.to_owned(), "take another `sph.form`");
    }
    Ok(Some(options))
}
