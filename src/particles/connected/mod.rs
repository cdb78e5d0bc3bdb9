//! What hangs together on one rank: points that are near each other ([`Grid`]), and what they join ([`Sets`]).

mod grid;
mod sets;

use std::cmp::Reverse;

use rayon::prelude::*;

use crate::{Image, MirrorMask};

pub use grid::{Grid, Place, distance_squared, grids};
pub use sets::{SHARE, Set, Sets};

/// The sets of points that hang together: each is nearer than `reach` (m) to another of its set, and
/// any single one may join two. As indices, the largest set first, equals in the order of their
/// first points; points that are not finite are left out.
///
/// # Panics
/// If `reach` is not positive.
#[must_use]
pub fn components(points: &[[f64; 3]], reach: f64) -> Vec<Vec<usize>> {
    assert!(reach > 0.0, "a reach of {reach} m");
    let finite = |point: &[f64; 3]| point.iter().all(|x| x.is_finite());
    let included = points.iter().enumerate().filter(|(_, point)| finite(point));
    let place = |(i, &position)| Place {
        position,
        reach: 0.5 * reach,
        metric: None,
        image: Image::new(i, MirrorMask::OWN),
    };
    let mut sets = Sets::default();
    sets.reset(points.len());
    for grid in grids(included.clone().map(place).collect()) {
        (0..grid.cubes())
            .into_par_iter()
            .for_each(|cube| join(&grid, cube, &sets));
    }
    let mut found: Vec<Vec<usize>> = vec![Vec::new(); points.len()];
    for (i, _) in included {
        found[sets.root(number(i)) as usize].push(i);
    }
    found.retain(|set| !set.is_empty());
    found.sort_by_key(|set| Reverse(set.len()));
    found
}

/// Joins the places of a cube with those that they are linked to.
fn join(grid: &Grid, cube: usize, sets: &Sets) {
    let members = grid.members(cube);
    let at = grid.cube(&grid.places[members.start].position);
    grid.about(at, |row| {
        for place in &grid.places[members.clone()] {
            let linked = grid.places[row.clone()]
                .iter()
                .filter(|other| place.is_linked(other));
            linked.for_each(|other| {
                sets.join(number(place.image.slot()), number(other.image.slot()));
            });
        }
    });
}

fn number(i: usize) -> u32 {
    u32::try_from(i).unwrap_or(u32::MAX)
}
