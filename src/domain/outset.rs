//! Where the particles of a case stand before its first step.

use super::balance::Histogram;
use super::rank_speed::RankSpeeds;
use super::slabs::Slabs;
use crate::comm::Comm;
use crate::model::{Axis, Case};
use crate::populate::{self, Share};

/// The ends of boxes along all axes (m).
type Ends = ([f64; 3], [f64; 3]);

/// The boxes of all bodies, and the axis along which slabs are cut.
#[derive(Debug, Clone)]
pub struct Outset {
    /// Boxes of the sites (m), by body, cut at the symmetry planes.
    pub boxes: Vec<Ends>,
    /// The axis along which the case is longest (0, 1, 2).
    pub longest: usize,
    /// The axis of the slabs: the longest one, unless the case names another.
    pub axis: usize,
}

impl Outset {
    /// Of a case; `None` if a body has no sites, or there is none.
    #[must_use]
    pub fn new(case: &Case) -> Option<Self> {
        let bodies = case.bodies.iter();
        let boxes = bodies.map(|body| {
            let (mut lower, upper) = populate::bounds(body, case.dimension)?;
            for plane in &case.symmetry {
                let a = plane.axis.index();
                lower[a] = lower[a].max(plane.position);
            }
            Some((lower, upper))
        });
        let boxes: Vec<Ends> = boxes.collect::<Option<_>>()?;
        let (lower, upper) = Self::join(boxes.iter().copied());
        let length = |a: usize| upper[a] - lower[a];
        let longest = (1..3).fold(0, |best, a| if length(a) > length(best) { a } else { best });
        (!boxes.is_empty()).then(|| Self {
            boxes,
            longest,
            axis: case.domain.axis.map_or(longest, Axis::index),
        })
    }

    /// The box around some boxes (m).
    #[must_use]
    pub fn join(boxes: impl IntoIterator<Item = Ends>) -> Ends {
        let mut all = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for (lower, upper) in boxes {
            for a in 0..3 {
                all.0[a] = all.0[a].min(lower[a]);
                all.1[a] = all.1[a].max(upper[a]);
            }
        }
        all
    }

    /// Particles of each body. The processes of `comm` share the lattice rows among them.
    /// Collective.
    #[must_use]
    pub fn counts(case: &Case, comm: &Comm) -> Vec<u64> {
        let share = share_of(comm);
        let (dimension, planes) = (case.dimension, &case.symmetry);
        let of_body = |body| {
            let mut particles = 0;
            // Along z, layers that are alike are counted at once.
            populate::tally(body, dimension, planes, 2, share, |_, n| particles += n);
            particles
        };
        let mut counts: Vec<u64> = case.bodies.iter().map(of_body).collect();
        comm.sum_u64(&mut counts);
        counts
    }

    /// Counts the particles between planes that are fine enough for slabs of so many ranks. The
    /// processes of `comm` share the lattice rows among them and count their own; what they have is
    /// still to be summed.
    pub fn count(&self, case: &Case, comm: &Comm, ranks: usize, histogram: &mut Histogram) {
        let (lower, upper) = Self::join(self.boxes.iter().copied());
        histogram.reset(lower[self.axis], upper[self.axis], ranks);
        let share = share_of(comm);
        let (dimension, planes) = (case.dimension, &case.symmetry);
        for body in &case.bodies {
            populate::tally(body, dimension, planes, self.axis, share, |x, count| {
                histogram.add(x, count);
            });
        }
    }

    /// Slabs with an even number of particles, of which none is created. Collective.
    pub fn slabs(&self, case: &Case, comm: &Comm, histogram: &mut Histogram) -> Slabs {
        if comm.size() == 1 {
            return Slabs::new(self.axis, Vec::new());
        }
        self.count(case, comm, comm.size(), histogram);
        Slabs::new(self.axis, histogram.split(comm, &RankSpeeds::default()))
    }
}

/// The lattice rows that a process counts.
fn share_of(comm: &Comm) -> Share {
    Share {
        part: comm.rank(),
        parts: comm.size(),
    }
}
