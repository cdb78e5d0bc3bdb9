//! What measures name: themselves, bodies and fields.

use toml::Spanned;

use crate::input::names;
use crate::input::source::Diagnostic;
use crate::model::Case;
use crate::particles::gauge_names;

/// What a gauge reads that names nothing.
const USUAL: [&str; 3] = ["pressure", "density", "velocity"];

/// Refuses a name that another one has, and one that cannot stand in tables.
pub fn unique<T>(
    taken: bool,
    what: &str,
    name: &str,
    own: Option<&Spanned<String>>,
    table: &Spanned<T>,
) -> Result<(), Diagnostic> {
    if let Some(own) = own {
        names::check(own, what)?;
    }
    if taken {
        let at = own.map_or_else(|| table.span(), Spanned::span);
        return Err(Diagnostic::new(at, format!("a second {what} `{name}`")));
    }
    Ok(())
}

/// The body of a name.
pub fn body(case: &Case, name: &Spanned<String>) -> Result<usize, Diagnostic> {
    case.body_named(name.get_ref()).ok_or_else(|| {
        let known = case.bodies.iter().map(|body| body.name.as_str());
        Diagnostic::unknown(name.span(), "body", name.get_ref(), known)
    })
}

/// What is read that a key names; `needs_any` of them.
pub fn fields(
    fields: Option<&Spanned<Vec<Spanned<String>>>>,
    needs_any: bool,
) -> Result<Vec<String>, Diagnostic> {
    let Some(fields) = fields else {
        return Ok(USUAL.map(str::to_owned).to_vec());
    };
    if fields.get_ref().is_empty() && needs_any {
        return Err(Diagnostic::new(fields.span(), "nothing is read"));
    }
    for (n, field) in fields.get_ref().iter().enumerate() {
        let name = field.get_ref();
        if !gauge_names().any(|known| known == name) {
            return Err(Diagnostic::unknown(
                field.span(),
                "field",
                name,
                gauge_names(),
            ));
        }
        if fields.get_ref()[..n].contains(field) {
            let title = format!("the field `{name}` is listed twice");
            return Err(Diagnostic::new(field.span(), title));
        }
    }
    let names = fields.get_ref().iter().map(|field| field.get_ref().clone());
    Ok(names.collect())
}
