//! Which particles share a cluster: eight in a row of a column, and what is left at the ends of
//! columns with what is left of the next columns. Results do not depend on it, only speed.

use std::f64::consts::PI;
use std::ops::Range;

use super::clusters::Cluster;
use super::sequence::Sequence;
use crate::sph::lanes::LANES;

/// Gathers the clusters of one task; the buffer is kept from step to step.
#[derive(Debug, Clone, Default)]
pub(super) struct Gatherer {
    leftover: Vec<u32>,
}

/// A cluster takes a particle if its reach then grows by no more than this many spheres of reach.
const GROWTH: f64 = 1.0;

impl Gatherer {
    /// Fills `clusters` with the owned particles of a group among `places`; `range` is the reach
    /// of a particle (m).
    #[inline(always)]
    pub(super) fn gather(
        &mut self,
        sequence: &Sequence,
        group: usize,
        places: Range<usize>,
        range: f64,
        clusters: &mut Vec<Cluster>,
    ) {
        clusters.clear();
        self.leftover.clear();
        let mut growing = Growing::new(sequence, group, range);
        sequence.for_each_segment(places, |segment| {
            for place in segment {
                if !sequence.is_owned(place) {
                    continue;
                }
                if !growing.welcomes(place) {
                    growing.drain(|receivers, _| self.leftover.extend(receivers));
                }
                growing.add(place);
                if growing.cluster.lanes == LANES {
                    growing.drain(|_, cluster| clusters.push(*cluster));
                }
            }
            growing.drain(|receivers, _| self.leftover.extend(receivers));
        });
        for &place in &self.leftover {
            let place = place as usize;
            if growing.cluster.lanes == LANES || !growing.welcomes(place) {
                growing.drain(|_, cluster| clusters.push(*cluster));
            }
            growing.add(place);
        }
        growing.drain(|_, cluster| clusters.push(*cluster));
    }

    pub(super) fn memory(&self) -> usize {
        4 * self.leftover.capacity()
    }
}

/// A cluster that is being filled.
struct Growing<'a> {
    sequence: &'a Sequence,
    range: f64,
    cluster: Cluster,
}

impl<'a> Growing<'a> {
    #[inline(always)]
    fn new(sequence: &'a Sequence, group: usize, range: f64) -> Self {
        Self {
            sequence,
            range,
            cluster: Cluster {
                receivers: [0; LANES],
                lanes: 0,
                group,
                lower: [0.0; 3],
                upper: [0.0; 3],
            },
        }
    }

    #[inline(always)]
    fn box_with(&self, place: usize) -> ([f64; 3], [f64; 3]) {
        let x: [f64; 3] = std::array::from_fn(|a| self.sequence.coordinates(a, place)[0]);
        if self.cluster.lanes == 0 {
            return (x, x);
        }
        let (lower, upper) = (&self.cluster.lower, &self.cluster.upper);
        (
            std::array::from_fn(|a| x[a].min(lower[a])),
            std::array::from_fn(|a| x[a].max(upper[a])),
        )
    }

    /// Whether a particle is near enough to the others.
    #[inline(always)]
    fn welcomes(&self, place: usize) -> bool {
        if self.cluster.lanes == 0 {
            return true;
        }
        let (lower, upper) = self.box_with(place);
        let growth = reach(&lower, &upper, self.range)
            - reach(&self.cluster.lower, &self.cluster.upper, self.range);
        growth <= GROWTH * reach(&lower, &lower, self.range)
    }

    #[inline(always)]
    fn add(&mut self, place: usize) {
        let (lower, upper) = self.box_with(place);
        (self.cluster.lower, self.cluster.upper) = (lower, upper);
        #[allow(clippy::cast_possible_truncation, reason = "images fit u32")]
        self.cluster.receivers[self.cluster.lanes..].fill(place as u32);
        self.cluster.lanes += 1;
    }

    /// Hands over what is there, if anything, and begins anew.
    #[inline(always)]
    fn drain(&mut self, take: impl FnOnce(&[u32], &Cluster)) {
        if self.cluster.lanes > 0 {
            take(&self.cluster.receivers[..self.cluster.lanes], &self.cluster);
            self.cluster.lanes = 0;
        }
    }
}

/// Volume within `range` of a box (m³).
#[inline(always)]
fn reach(lower: &[f64; 3], upper: &[f64; 3], range: f64) -> f64 {
    let [x, y, z]: [f64; 3] = std::array::from_fn(|a| upper[a] - lower[a]);
    let faces = x * y + y * z + z * x;
    x * y * z + range * (2.0 * faces + range * (PI * (x + y + z) + 4.0 / 3.0 * PI * range))
}
