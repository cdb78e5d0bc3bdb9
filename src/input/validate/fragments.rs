//! `[fragments]`

use crate::input::schema::FragmentsParams;
use crate::input::source::Diagnostic;
use crate::model::FragmentOptions;

/// The table as given, else the defaults, if there is one.
pub fn fragments(params: Option<&FragmentsParams>) -> Result<Option<FragmentOptions>, Diagnostic> {
    let Some(params) = params else {
        return Ok(None);
    };
    Ok(Some(FragmentOptions {
        every: params.every()?,
        link: params.link()?,
        include: params.include(),
        bridges: params.bridges(),
        across_bodies: params.across_bodies(),
        min_particles: params.min_particles()?,
    }))
}
