//! The trees of a rank, and what they exert on its particles.

use rayon::prelude::*;

use super::cube::{Bounds, Cube, Facts, cell, level_of, side};
use super::essential;
use super::pull::{OnCell, Pull, TARGETS};
use super::tree::{Bin, Point, Tree};
use comm::{Comm, Exchange, Traffic};
use model::SelfGravity;
use particles::{GRAIN, MirrorMask, Mirrors};

/// Trees, with their memory.
#[derive(Default)]
pub(super) struct Trees {
    /// The particles of this rank.
    own: Tree,
    /// With what this rank needs of others, if there are any.
    all: Tree,
    /// Cells that other ranks keep closed.
    closed: Vec<Bin>,
    words: Vec<u64>,
    told: Vec<Facts>,
    exchange: Exchange,
}

impl Trees {
    /// Bytes allocated.
    pub fn memory(&self) -> usize {
        self.own.memory()
            + self.all.memory()
            + self.exchange.memory()
            + size_of::<Bin>() * self.closed.capacity()
            + size_of::<Facts>() * self.told.capacity()
            + size_of::<u64>() * self.words.capacity()
    }

    /// Messages and bytes that this rank has sent.
    pub fn traffic(&self) -> Traffic {
        self.exchange.traffic
    }

    /// This rank's particles, to be set but for their keys.
    pub fn points(&mut self) -> &mut Vec<Point> {
        &mut self.own.points
    }

    /// Grows the trees of all ranks' particles. Collective.
    pub fn grow(&mut self, comm: &Comm, options: &SelfGravity, mirrors: &Mirrors) -> Cube {
        let Self {
            own,
            all,
            closed,
            words,
            told,
            exchange,
        } = self;
        let cube = Cube::around_all(comm, &own.points, options, (words, told));
        let points = own.points.par_iter_mut().with_min_len(GRAIN);
        points.for_each(|point| point.key = cube.key(&point.position, point.length));
        own.sort(&cube);
        own.grow(&cube);
        if comm.size() > 1 {
            all.points.clear();
            all.points.par_extend(&own.points);
            essential::exchange(comm, (&cube, mirrors, told), own, (all, closed), exchange);
            all.sort(&cube);
            all.bins.append(closed);
            all.bins.par_sort_unstable_by_key(|bin| bin.key);
            all.grow(&cube);
        }
        cube
    }

    /// Gives `receive` each of this rank's particles once, with the pull of all particles and that of all their images.
    pub fn pull(&self, cube: &Cube, mirrors: &Mirrors, receive: impl Fn(&Point, [Pull; 2]) + Sync) {
        let tree = if self.all.bins.is_empty() {
            &self.own
        } else {
            &self.all
        };
        let Tree { bins, points, .. } = &self.own;
        bins.par_iter().for_each(|bin| {
            let [first, end] = bin.points.map(|point| point as usize);
            for points in points[first..end].chunks(TARGETS) {
                let pulls = on_cell(cube, tree, mirrors, (bin, points));
                for (point, pull) in points.iter().zip(pulls) {
                    receive(point, pull);
                }
            }
        });
    }
}

/// What a tree exerts on some particles of a bin: that of all particles, and that of all images.
fn on_cell(
    cube: &Cube,
    tree: &Tree,
    mirrors: &Mirrors,
    (bin, points): (&Bin, &[Point]),
) -> [[Pull; 2]; TARGETS] {
    let mut pulls = [[[0.0; 4]; 2]; TARGETS];
    let bounds = cell(bin.key);
    for mask in mirrors.masks() {
        // Images of the particles feel the particles as these feel their images.
        let mut on_image = [[0.0; 4]; TARGETS];
        let on_cell = OnCell {
            cube,
            tree,
            points,
            bounds: image_of_box(cube, mirrors, &bounds, mask),
            side: side(level_of(bin.key)),
            image: |x: &[f64; 3]| mirrors.reflect_position(x, mask),
            is_own: mask.is_own(),
            pulls: &mut on_image,
        };
        on_cell.run();
        for ([own, image], [x, y, z, depth]) in pulls.iter_mut().zip(on_image) {
            let [x, y, z] = Mirrors::reflect_vector(&[x, y, z], mask);
            let sum = if mask.is_own() { own } else { image };
            for (sum, part) in sum.iter_mut().zip([x, y, z, depth]) {
                *sum += part;
            }
        }
    }
    pulls
}

/// The image of a box in units of the cube.
pub(super) fn image_of_box(
    cube: &Cube,
    mirrors: &Mirrors,
    bounds: &Bounds,
    mask: MirrorMask,
) -> Bounds {
    let mut image = *bounds;
    for axis in (0..3).filter(|&axis| mask.has(axis)) {
        if let Some(plane) = mirrors.plane(axis) {
            let twice = 2.0 * cube.units(axis, plane);
            image.lower[axis] = twice - bounds.upper[axis];
            image.upper[axis] = twice - bounds.lower[axis];
        }
    }
    image
}
