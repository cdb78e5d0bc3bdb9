//! What ranks tell each other of their trees: to each rank the cells that count as one body for all that it
//! owns, and the particles of those that do not (Warren & Salmon 1993, *A parallel hashed oct-tree N-body algorithm*).
//!
//! Sums of whole numbers do not show how ranks share a cell, so a rank finds in a cell that it opens, or takes
//! for one body, the moments of all that lies in it.

use rayon::prelude::*;

use super::cube::{Bounds, Cube, Facts, Key};
use super::moments::Moments;
use super::tree::{Bin, Point, Tree};
use super::trees::image_of_box;
use comm::{Comm, Exchange};
use particles::{Mirrors, copy_at_once, resize};

/// Words of a closed cell in a message: its key, and its moments.
const ROW: usize = size_of::<i128>() + size_of::<Moments>();

/// Adds to `all`, which holds this rank's points, what of the points and cells of other ranks' `own` trees this
/// rank needs. Collective.
pub(super) fn exchange(
    comm: &Comm,
    (cube, mirrors, told): (&Cube, &Mirrors, &[Facts]),
    own: &Tree,
    (all, closed): (&mut Tree, &mut Vec<Bin>),
    exchange: &mut Exchange,
) {
    let me = comm.rank();
    let meets = |rank: &usize| *rank != me && told[me].count > 0 && told[*rank].count > 0;
    exchange.set_peers((0..comm.size()).filter(meets));
    exchange.outgoing_all().par_iter_mut().for_each(|peer| {
        let facts = &told[peer.rank()];
        pack(cube, mirrors, facts, own, peer.outgoing());
    });
    exchange.post_with_sizes(comm);
    exchange.wait();
    closed.clear();
    for peer in exchange.incoming_all() {
        unpack(peer.incoming(), all, closed);
    }
}

/// Writes what a rank needs of a tree.
fn pack(cube: &Cube, mirrors: &Mirrors, facts: &Facts, tree: &Tree, message: &mut Vec<u8>) {
    let (bounds, side) = cube.around(facts);
    let is_closed = |cell: &Bounds, own: f64| {
        mirrors.masks().all(|mask| {
            let image = image_of_box(cube, mirrors, &bounds, mask);
            cube.is_apart((cell, own), (&image, side))
        })
    };
    message.extend_from_slice(&0_u64.to_ne_bytes());
    let mut rows = 0_u64;
    tree.walk(is_closed, |at, is_closed| {
        if is_closed {
            rows += 1;
            message.extend_from_slice(&i128::from(tree.cells[at].key).to_ne_bytes());
            message.extend_from_slice(bytemuck::bytes_of(&tree.moments[at]));
        }
    });
    message[..size_of::<u64>()].copy_from_slice(&rows.to_ne_bytes());
    tree.walk(is_closed, |at, is_closed| {
        if !is_closed {
            let [first, end] = tree.cells[at].points;
            let points = &tree.points[first as usize..end as usize];
            message.extend_from_slice(bytemuck::cast_slice(points));
        }
    });
}

/// Reads what another rank has packed.
fn unpack(message: &[u8], all: &mut Tree, closed: &mut Vec<Bin>) {
    let Some((rows, rest)) = message.split_at_checked(size_of::<u64>()) else {
        return;
    };
    let rows: u64 = bytemuck::pod_read_unaligned(rows);
    let (rows, points) = rest.split_at(usize::try_from(rows).unwrap_or(0) * ROW);
    closed.extend(rows.chunks_exact(ROW).map(|row| {
        let (key, moments) = row.split_at(size_of::<i128>());
        let key: i128 = bytemuck::pod_read_unaligned(key);
        Bin {
            key: Key::try_from(key).unwrap_or(0),
            points: [0, 0],
            moments: bytemuck::pod_read_unaligned(moments),
        }
    }));
    let first = all.points.len();
    resize(&mut all.points, first + points.len() / size_of::<Point>());
    copy_at_once(points, bytemuck::cast_slice_mut(&mut all.points[first..]));
}
