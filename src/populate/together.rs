//! The sites of all bodies of a case, of which all threads fill small ones at the same time.

use rayon::prelude::*;

use super::{Brick, Site, count, sites};
use model::{Body, Case};

/// Sites of bodies that are filled at the same time.
const TOGETHER: u64 = 1 << 16;

/// The number of [`sites`] of each body above all symmetry planes and, if given, in a brick.
#[must_use]
pub fn counts(case: &Case, brick: Option<Brick>) -> Vec<u64> {
    let bodies = case.bodies.par_iter();
    let counts = bodies.map(|body| count(body, case.dimension, &case.symmetry, brick));
    counts.collect()
}

/// Passes the sites of each body, of which there are so many above all symmetry planes and, if given, in a brick, to
/// `take`, body by body.
///
/// # Errors
/// The first of `take`.
pub fn for_each_body<E>(
    case: &Case,
    brick: Option<Brick>,
    counts: &[u64],
    mut take: impl FnMut(usize, &mut dyn Iterator<Item = Site>) -> Result<(), E>,
) -> Result<(), E> {
    let of = |body: &Body| sites(body, case.dimension, &case.symmetry, brick);
    let mut first = 0;
    while let Some(body) = case.bodies.get(first) {
        let mut sum = 0;
        let few = counts[first..].iter().take_while(|&&count| {
            sum += count;
            sum <= TOGETHER
        });
        let bodies = &case.bodies[first..first + few.count()];
        if bodies.is_empty() {
            take(first, &mut of(body))?;
            first += 1;
            continue;
        }
        // Each body by itself, so the same bits in any order.
        let filled = bodies.par_iter().zip(&counts[first..]);
        let filled = filled.map(|(body, &count)| match count {
            0 => Vec::new(),
            _ => of(body).collect::<Vec<Site>>(),
        });
        for sites in filled.collect::<Vec<Vec<Site>>>() {
            take(first, &mut sites.into_iter())?;
            first += 1;
        }
    }
    Ok(())
}
