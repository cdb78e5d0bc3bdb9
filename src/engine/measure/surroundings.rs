//! What stands around one particle.

use super::gauge_reader::Matter;
use particles::neighbours::Lists;

/// Numbers of it.
pub const NUMBERS: usize = 4;

/// Names and SI units of its numbers: neighbours of its own body and of others in whose support it is, and the distance of
/// the nearest of each.
pub const COLUMNS: [(&str, &str); NUMBERS] = [
    ("neighbours", ""),
    ("closest_neighbour", "m"),
    ("foreign_neighbours", ""),
    ("closest_foreign", "m"),
];

/// That of an owned particle, as the last search had it, images behind symmetry planes among it. Not a number where the
/// search had no use for the particle, as for matter that nothing has reached, and a distance where there is nothing.
pub fn around(matter: &Matter, i: usize) -> [f64; NUMBERS] {
    let Matter {
        particles, lists, ..
    } = matter;
    let Some(own) = place(lists, &particles.position[i], i) else {
        return [f64::NAN; NUMBERS];
    };
    let here = lists.motion()[own].position;
    let length = particles.smoothing_length[i];
    let (mut counts, mut squares) = ([0_u32; 2], [f64::INFINITY; 2]);
    lists.near_point(&here, length + lists.longest(), |index, square| {
        let slot = lists.images()[index].slot();
        let support = length + particles.smoothing_length[slot];
        if index != own && square < support * support {
            let kind = usize::from(particles.body[slot] != particles.body[i]);
            counts[kind] += 1;
            squares[kind] = squares[kind].min(square);
        }
    });
    let [own, foreign] = squares.map(|square| {
        if square < f64::INFINITY {
            square.sqrt()
        } else {
            f64::NAN
        }
    });
    [counts[0].into(), own, counts[1].into(), foreign]
}

/// Place of an owned particle in the sequence of the last search, from which it has moved by less than its reach.
fn place(lists: &Lists, position: &[f64; 3], i: usize) -> Option<usize> {
    let mut found = None;
    lists.near_point(position, 2.0 * lists.longest(), |index, _| {
        let image = lists.images()[index];
        if image.slot() == i && image.mirror_mask().is_own() {
            found = Some(index);
        }
    });
    found
}
