//! `[fragments]`

use super::check::{Allowed, optional, whole};
use crate::input::schema::FragmentsParams;
use crate::input::source::Diagnostic;
use model::FragmentOptions;

/// Links beyond it reach through gaps wider than the support of most kernels.
const LONGEST: f64 = 4.0;

/// The table as given, else the defaults, if there is one.
pub fn fragments(params: Option<&FragmentsParams>) -> Result<Option<FragmentOptions>, Diagnostic> {
    let Some(params) = params else {
        return Ok(None);
    };
    let usual = FragmentOptions::default();
    let least = params.min_particles.as_ref();
    Ok(Some(FragmentOptions {
        every: optional(params.every.as_ref(), "every", Allowed::Positive)?,
        link: number!(params.link, or usual.link, Within(1.0, LONGEST)),
        include: params.include.unwrap_or(usual.include),
        bridges: params.bridges.unwrap_or(usual.bridges),
        across_bodies: params.across_bodies.unwrap_or(usual.across_bodies),
        min_particles: whole(least, "min_particles", usual.min_particles, 1)?,
    }))
}
