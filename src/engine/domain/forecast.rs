//! Particles that the ranks of a decomposition would own and receive, before there is one.

use std::f64::consts::{FRAC_PI_4, FRAC_PI_6};

use super::choice::WORTHWHILE;
use super::histogram::{Cumulative, Histogram};
use super::nested::Slab;
use comm::Comm;
use model::Case;
use numerics::kernel::SUPPORT;
use particles::neighbours::SizeClasses;
use populate::{self, Share};

/// Spread of the sites of each body along each axis. Where a body's sites along one axis hang on
/// those along another, as in a ball, its parts are counted as if they did not.
pub struct Forecast {
    /// Sites of each body below planes that all bodies share, by axis.
    bodies: [Vec<Cumulative>; 3],
    axes: [usize; 3],
    dimension: usize,
    /// Reach across a face (m).
    reach: f64,
}

/// The most particles that a rank has.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Fullest {
    /// Its own.
    pub owned: f64,
    /// Of others.
    pub halo: f64,
}

/// The planes between which a slab lies, lower and upper by axis.
type Planes = [[usize; 2]; 3];

impl Forecast {
    /// Of a case whose sites lie between two corners (m), along the axes of slabs, of slabs of these
    /// and so on. Collective.
    #[must_use]
    pub(super) fn new(
        case: &Case,
        comm: &Comm,
        (lower, upper): ([f64; 3], [f64; 3]),
        axes: [usize; 3],
    ) -> Self {
        let bodies = case.bodies.len();
        let of_axis = |axis: usize| -> Vec<Cumulative> {
            let mut histogram = Histogram::default();
            let ends = (lower[axis], upper[axis]);
            histogram.reset_each((0..bodies).map(|_| (ends, 2)), 2 * bodies);
            let (dimension, planes) = (case.dimension, &case.symmetry);
            for (b, body) in case.bodies.iter().enumerate() {
                populate::tally(body, dimension, planes, axis, share_of(comm), |x, count| {
                    histogram.add_to(b, x, count);
                });
            }
            histogram.sum(comm);
            (0..bodies).map(|b| histogram.cumulate(b)).collect()
        };
        Self {
            bodies: std::array::from_fn(|axis| {
                if axis < case.dimension {
                    of_axis(axis)
                } else {
                    Vec::new()
                }
            }),
            axes,
            dimension: case.dimension,
            reach: reach(case),
        }
    }

    /// The levels of slabs for so many ranks: the fewest whose largest halo is not much larger than
    /// that of others.
    #[must_use]
    pub fn levels(&self, ranks: usize) -> usize {
        let halo = |levels| self.fullest(levels, ranks).halo;
        let mut best = (1, halo(1));
        for levels in 2..=self.dimension {
            let halo = halo(levels);
            if halo < WORTHWHILE * best.1 {
                best = (levels, halo);
            }
        }
        best.0
    }

    /// The most that one of so many ranks owns and receives in slabs of so many levels.
    #[must_use]
    pub fn fullest(&self, levels: usize, ranks: usize) -> Fullest {
        let mut planes = [[0; 2]; 3];
        for (planes, bodies) in planes.iter_mut().zip(&self.bodies) {
            planes[1] = bodies.first().map_or(0, Cumulative::last);
        }
        let mut fullest = Fullest::default();
        self.cut((Slab::whole(ranks, levels), 0), planes, &mut fullest);
        fullest
    }

    /// Cuts a slab by a level and those below, and looks at its ranks.
    fn cut(&self, (slab, level): (Slab, usize), planes: Planes, fullest: &mut Fullest) {
        if !slab.is_cut() {
            let bodies = 0..self.bodies[0].len();
            let [mut owned, mut halo] = [0.0; 2];
            let filled = self.filled(&planes);
            for body in bodies {
                let sites = as_number(self.bodies[0][body].total());
                owned += sites * self.share(body, &planes, None);
                halo += sites * self.share_about(body, &filled);
            }
            fullest.owned = fullest.owned.max(owned);
            fullest.halo = fullest.halo.max(halo);
            return;
        }
        let axis = self.axes[level];
        let shares: Vec<f64> = (0..self.bodies[axis].len())
            .map(|b| self.share(b, &planes, Some(axis)))
            .collect();
        let below = |plane: usize| -> f64 {
            let bodies = self.bodies[axis].iter().zip(&shares);
            bodies
                .map(|(body, share)| share * counted(body, plane, 0.0))
                .sum()
        };
        let [lower, upper] = planes[axis];
        let (start, ranks) = (below(lower), slab.ranks());
        let each = (below(upper) - start) / as_number(ranks.len() as u64);
        let mut part_lower = lower;
        for part in slab.cut().all() {
            let wanted = start + each * as_number((part.ranks().end - ranks.start) as u64);
            let part_upper = if part.ranks().end == ranks.end {
                upper
            } else {
                nearest(&below, [part_lower, upper], wanted)
            };
            let mut planes = planes;
            planes[axis] = [part_lower, part_upper];
            self.cut((part, level + 1), planes, fullest);
            part_lower = part_upper;
        }
    }

    /// All sites.
    #[must_use]
    pub fn total(&self) -> f64 {
        let totals = self.bodies[0].iter().map(|body| as_number(body.total()));
        totals.sum()
    }

    /// The part of a body between planes; along all axes but one.
    fn share(&self, body: usize, planes: &Planes, but: Option<usize>) -> f64 {
        let axes = (0..self.dimension).filter(|&axis| Some(axis) != but);
        let shares = axes.map(|axis| self.share_along(axis, (body, planes), 0.0));
        shares.product()
    }

    /// The part of a body between planes along an axis, and beyond them by a way (m).
    fn share_along(&self, axis: usize, (body, planes): (usize, &Planes), way: f64) -> f64 {
        let (body, [lower, upper]) = (&self.bodies[axis][body], planes[axis]);
        let within = counted(body, upper, way) - counted(body, lower, -way);
        within / as_number(body.total()).max(1.0)
    }

    /// The part of a body that is within reach of the box between planes, and not in it. Beside edges
    /// it is a quarter of a cylinder, at corners an eighth of a ball.
    fn share_about(&self, body: usize, planes: &Planes) -> f64 {
        // By the number of axes along which it is beside the box.
        let mut beside = [1.0, 0.0, 0.0, 0.0];
        for axis in 0..self.dimension {
            let along = |way| self.share_along(axis, (body, planes), way);
            let inside = along(0.0);
            let outside = along(self.reach) - inside;
            for n in (0..4).rev() {
                let before = if n > 0 { beside[n - 1] } else { 0.0 };
                beside[n] = inside * beside[n] + outside * before;
            }
        }
        beside[1] + FRAC_PI_4 * beside[2] + FRAC_PI_6 * beside[3]
    }

    /// The same planes nearer together, as far as there is nothing between: halos reach from particles.
    fn filled(&self, planes: &Planes) -> Planes {
        let there = |body: &usize| self.share(*body, planes, None) > 0.0;
        let there: Vec<usize> = (0..self.bodies[0].len()).filter(there).collect();
        let mut filled = *planes;
        for axis in 0..self.dimension {
            let of_body = |&body: &usize| self.bodies[axis][body].filled(planes[axis]);
            let join = |one: [usize; 2], two: [usize; 2]| [one[0].min(two[0]), one[1].max(two[1])];
            filled[axis] = there.iter().map(of_body).reduce(join).unwrap_or([0; 2]);
        }
        filled
    }
}

/// Upper bound of half of the sum of two supports (m): the reach across a face.
pub fn reach(case: &Case) -> f64 {
    let bodies = case.bodies.iter();
    let reach =
        bodies.map(|body| SUPPORT * body.longest_smoothing_length() * SizeClasses::widening(body));
    reach.fold(0.0, f64::max)
}

/// Sites below the last plane within a way (m, signed) of another.
fn counted(body: &Cumulative, plane: usize, way: f64) -> f64 {
    as_number(body.below(plane, way))
}

/// The plane, of some, that has nearly so much below it.
fn nearest(below: &impl Fn(usize) -> f64, [lower, upper]: [usize; 2], wanted: f64) -> usize {
    let (mut least, mut enough) = (lower, upper);
    while least < enough {
        let middle = usize::midpoint(least, enough);
        if below(middle) < wanted {
            least = middle + 1;
        } else {
            enough = middle;
        }
    }
    let before = least.max(lower + 1) - 1;
    if wanted - below(before) < below(least) - wanted {
        before
    } else {
        least
    }
}

/// A count as a number.
#[allow(clippy::cast_precision_loss, reason = "far fewer than 2^52")]
fn as_number(count: u64) -> f64 {
    count as f64
}

/// The lattice rows that a process counts.
pub(super) fn share_of(comm: &Comm) -> Share {
    Share {
        part: comm.rank(),
        parts: comm.size(),
    }
}
