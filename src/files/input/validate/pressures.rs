//! Pressures on faces, and the forms of the sums that have faces.

use toml::Spanned;

use crate::input::schema::PressureParams;
use crate::input::source::Diagnostic;
use model::{Case, SphForm};

/// Refuses pressures in forms whose sums know no faces.
pub fn check_form(case: &Case, params: &[Spanned<PressureParams>]) -> Result<(), Diagnostic> {
    match params.first() {
        Some(table) if case.sph.form != SphForm::Corrected => {
            let title = "a pressure acts on the faces of `sph.form = \"corrected\"` alone";
            Err(Diagnostic::new(table.span(), title).help("leave `sph.form` out"))
        }
        _ => Ok(()),
    }
}
