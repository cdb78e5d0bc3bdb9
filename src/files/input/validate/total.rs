//! `body.form`: which bodies have the total form.

use toml::Spanned;

use crate::input::schema::BodyParams;
use crate::input::source::Diagnostic;
use model::{BodyForm, Case, ClosingSpeeds};

/// Chooses the form of each body.
pub fn resolve(case: &mut Case, params: &[Spanned<BodyParams>]) -> Result<(), Diagnostic> {
    let speeds = ClosingSpeeds::new(case);
    for (body, table) in params.iter().enumerate() {
        let table = table.get_ref();
        let obstacle = case.total_obstacle(body);
        case.bodies[body].total = match (table.form(), obstacle) {
            (BodyForm::Total, Some(why)) => {
                let name = &case.bodies[body].name;
                let title = format!("the body `{name}` cannot have the total form: {why}");
                let span = table.form.as_ref().map_or(0..0, Spanned::span);
                return Err(Diagnostic::new(span, title).help("leave `form` out"));
            }
            (BodyForm::Total, None) => true,
            (BodyForm::Updated, _) => false,
            (BodyForm::Auto, obstacle) => obstacle.is_none() && case.flows_slowly(body, &speeds),
        };
    }
    Ok(())
}
