//! Names that measures use: their own, and those of bodies and fields.

use toml::Spanned;

use crate::input::names;
use crate::input::source::Diagnostic;
use model::Case;
use particles::gauge_names;

/// Fields of a gauge that names none.
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

/// Refuses the name at a place of a list if it is not known, or stands before it already.
pub fn check_listed<'a, I: Iterator<Item = &'a str>>(
    names: &[Spanned<String>],
    place: usize,
    what: &str,
    known: impl Fn() -> I,
) -> Result<(), Diagnostic> {
    let name = &names[place];
    let (at, text) = (name.span(), name.get_ref());
    if !known().any(|known| known == text) {
        return Err(Diagnostic::unknown(at, what, text, known()));
    }
    if names[..place].contains(name) {
        let title = format!("the {what} `{text}` is listed twice");
        return Err(Diagnostic::new(at, title));
    }
    Ok(())
}

/// Fields to read that a key names; `needs_any` of them.
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
    for n in 0..fields.get_ref().len() {
        check_listed(fields.get_ref(), n, "field", gauge_names)?;
    }
    let names = fields.get_ref().iter().map(|field| field.get_ref().clone());
    Ok(names.collect())
}
