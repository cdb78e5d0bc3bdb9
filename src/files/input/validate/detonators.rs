//! Points from which detonations run, and explosives that none of them lights.

use toml::Spanned;

use super::shapes::vector;
use crate::input::schema::{BodyParams, DetonateParams};
use crate::input::source::Diagnostic;
use material::{Burn, Eos};
use model::{Case, Detonator};

/// The detonators of a case that is whole but for them.
pub fn detonators(
    params: &[Spanned<DetonateParams>],
    bodies: &[Spanned<BodyParams>],
    case: &Case,
) -> Result<Vec<Detonator>, Diagnostic> {
    let all = params.iter().map(|table| detonator(table, case));
    let all: Vec<Detonator> = all.collect::<Result<_, _>>()?;
    for (b, (body, table)) in case.bodies.iter().zip(bodies).enumerate() {
        let waits = match &case.materials[body.material].eos {
            Eos::Jwl(explosive) => explosive.burn == Burn::Programmed,
            _ => false,
        };
        if waits && !all.iter().any(|d| d.body.is_none_or(|lit| lit == b)) {
            let at = table.get_ref().material.as_ref();
            let title = format!("no `[[detonate]]` lights the explosive of `{}`", body.name);
            return Err(
                Diagnostic::new(at.map_or(table.span(), Spanned::span), title)
                    .help("`eos.jwl.burn` of another kind needs none"),
            );
        }
    }
    Ok(all)
}

fn detonator(table: &Spanned<DetonateParams>, case: &Case) -> Result<Detonator, Diagnostic> {
    let params = table.get_ref();
    let body = params.body.as_ref().map(|name| {
        let index = case.body_named(name.get_ref()).ok_or_else(|| {
            let known = case.bodies.iter().map(|body| body.name.as_str());
            Diagnostic::unknown(name.span(), "body", name.get_ref(), known)
        })?;
        if !case.materials[case.bodies[index].material].burns() {
            let title = format!("the body `{}` is no explosive", name.get_ref());
            return Err(Diagnostic::new(name.span(), title)
                .help("an explosive has the equation of state `eos.jwl`"));
        }
        Ok(index)
    });
    if !case.is_explosive() {
        let title = "no body of the case is an explosive that this could light";
        return Err(Diagnostic::new(table.span(), title)
            .help("an explosive has the equation of state `eos.jwl`"));
    }
    Ok(Detonator {
        body: body.transpose()?,
        at: vector("at", Some(&params.at), case.dimension)?.into(),
        time: params.time()?,
    })
}
