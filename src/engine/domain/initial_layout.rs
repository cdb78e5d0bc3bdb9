//! Positions of the particles of a case before its first step, and their ranks.

use super::balance::Balance;
use super::choice::Choice;
use super::forecast::{Forecast, share_of};
use super::histogram::Histogram;
use super::nested::{Decomposition, NestedSlabs};
use super::rank_speed::RankSpeeds;
use comm::Comm;
use model::{Axis, Case, edge};
use numerics::extent::{Extent, around};
use populate;

/// The boxes of all bodies, and the axes along which slabs are cut.
#[derive(Debug, Clone)]
pub struct InitialLayout {
    /// Boxes of the sites (m), by body, cut at the symmetry planes.
    pub boxes: Vec<Extent>,
    /// The axis along which the case is longest (0, 1, 2).
    pub longest: usize,
    /// The axes of slabs, of slabs of these and so on: those that the case names, then the longest
    /// of the others.
    pub axes: [usize; 3],
}

impl InitialLayout {
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
        let boxes: Vec<Extent> = boxes.collect::<Option<_>>()?;
        let (lower, upper) = around(boxes.iter().copied());
        let length = |a: usize| upper[a] - lower[a];
        let longest = (1..3).fold(0, |best, a| if length(a) > length(best) { a } else { best });
        (!boxes.is_empty()).then(|| Self {
            boxes,
            longest,
            axes: axes(case.domain.axes, length),
        })
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
        let (lower, upper) = around(self.boxes.iter().copied());
        let axis = self.axes[0];
        histogram.reset(lower[axis], upper[axis], ranks);
        let share = share_of(comm);
        let (dimension, planes) = (case.dimension, &case.symmetry);
        for body in &case.bodies {
            populate::tally(body, dimension, planes, axis, share, |x, count| {
                histogram.add(x, count);
            });
        }
    }

    /// Particles that ranks would own and receive. Collective.
    #[must_use]
    pub fn forecast(&self, case: &Case, comm: &Comm) -> Forecast {
        let ends = around(self.boxes.iter().copied());
        Forecast::new(case, comm, ends, self.axes)
    }

    /// Number of levels of slabs of so many ranks, where that is not to be chosen by their halos.
    #[must_use]
    pub fn known_levels(&self, case: &Case, ranks: usize) -> Option<usize> {
        let few = ranks < FEW_RANKS || case.dimension == 1;
        case.domain.levels.or(few.then_some(1))
    }

    /// Slabs of so many levels, or as many as the case says or as a [`Choice`] takes, for so many ranks,
    /// with an even number of particles, of which none is created. The processes of `comm`, which need
    /// not be those ranks, share the work. Collective.
    #[must_use]
    pub fn slabs(
        &self,
        case: &Case,
        comm: &Comm,
        (ranks, levels): (usize, Option<usize>),
        balance: &mut Balance,
    ) -> NestedSlabs {
        let levels = levels.or_else(|| self.known_levels(case, ranks));
        if levels == Some(1) || ranks == 1 {
            return self.flat_slabs(case, comm, ranks);
        }
        // Each process counts for all what one slab has.
        let processes = self.flat_slabs(case, comm, comm.size());
        let brick = processes.region(comm.rank());
        let (mut places, mut reach) = (Vec::new(), Vec::new());
        for body in &case.bodies {
            let of = (body, case.dimension, case.symmetry.as_slice());
            populate::emit_unfitted(of, brick, |site| {
                places.push(site.position);
                reach.push(body.smoothing_length * edge(site.share, case.dimension));
            });
        }
        self.slabs_of(case, comm, (ranks, levels), (&places, &reach), balance)
    }

    /// The same for particles at some positions (m) that reach so far (m), shared by the processes of
    /// `comm`. Collective.
    #[must_use]
    pub fn slabs_of(
        &self,
        case: &Case,
        comm: &Comm,
        (ranks, levels): (usize, Option<usize>),
        (positions, reach): (&[[f64; 3]], &[f64]),
        balance: &mut Balance,
    ) -> NestedSlabs {
        let levels = levels.or_else(|| self.known_levels(case, ranks));
        let mut slabs = NestedSlabs::on_first(self.axes, levels.unwrap_or(1), ranks);
        let (work, even) = (vec![1; positions.len()], RankSpeeds::default());
        let all = (positions, work.as_slice());
        balance.cut(comm, &mut slabs, all, &even);
        if levels.is_none() {
            let mut choice = Choice::new(case);
            choice.revise(comm, &mut slabs, (balance, &even), all, |i| reach[i]);
        }
        slabs
    }

    /// The same of one level. Collective.
    fn flat_slabs(&self, case: &Case, comm: &Comm, ranks: usize) -> NestedSlabs {
        let mut slabs = NestedSlabs::on_first(self.axes, 1, ranks);
        if ranks == 1 {
            return slabs;
        }
        let mut histogram = Histogram::default();
        self.count(case, comm, ranks, &mut histogram);
        histogram.sum(comm);
        #[allow(clippy::cast_precision_loss, reason = "few ranks")]
        let parts = (1..ranks).map(|rank| rank as f64 / ranks as f64);
        let mut faces = slabs.faces_mut().iter_mut();
        histogram.split(0, parts, |face| {
            if let Some(place) = faces.next() {
                *place = face;
            }
        });
        slabs
    }
}

/// Ranks below which one level is enough, whatever the halo: eight are the first that three levels cut
/// alike, and fewer save little by boxes, which take more messages.
const FEW_RANKS: usize = 8;

/// The named axes, then the others by length (m), longest first.
fn axes(named: [Option<Axis>; 3], length: impl Fn(usize) -> f64) -> [usize; 3] {
    let mut axes = [0, 1, 2];
    let place = |axis: usize| {
        named
            .iter()
            .position(|name| name.map(Axis::index) == Some(axis))
    };
    axes.sort_by(|&a, &b| {
        let by_name = place(a).unwrap_or(3).cmp(&place(b).unwrap_or(3));
        by_name.then(length(b).total_cmp(&length(a)))
    });
    axes
}
