//! Choice of the particles that share a cluster: eight in a row of a column, and those left at the
//! ends of columns with those left of the next columns. Only speed depends on it, not results.

use std::f64::consts::PI;
use std::ops::Range;

use super::cluster::Cluster;
use super::facts::IMAGE;
use super::sequence::Sequence;
use numerics::lanes::LANES;

/// Gathers the clusters of one task; the buffer is kept from step to step.
#[derive(Debug, Clone, Default)]
pub(super) struct Gatherer {
    leftover: Vec<u32>,
}

/// A cluster takes a particle if its reach then grows by no more than this many spheres of reach.
const GROWTH: f64 = 1.25;

impl Gatherer {
    /// Fills `clusters` with the owned particles of a group among `places`; `range` is the reach
    /// of a particle (m), the longest where smoothing lengths differ.
    #[inline(always)]
    pub(super) fn gather(
        &mut self,
        sequence: &Sequence,
        group: usize,
        indices: Range<usize>,
        range: f64,
        clusters: &mut Vec<Cluster>,
    ) {
        clusters.clear();
        self.leftover.clear();
        let mut growing = Growing::new(sequence, group, range);
        sequence.for_each_segment(indices, |segment| {
            let end = segment.end;
            let mut index = segment.start;
            while index < end {
                let whole = growing.cluster.lanes == 0 && index + LANES <= end;
                if whole && let Some(cluster) = growing.row(index) {
                    clusters.push(cluster);
                    index += LANES;
                    continue;
                }
                if sequence.is_owned(index) {
                    if !growing.try_add(index) {
                        growing.drain(|cluster| self.leftover.extend(cluster.valid()));
                        growing.try_add(index);
                    }
                    if growing.cluster.lanes == LANES {
                        growing.drain(|cluster| clusters.push(*cluster));
                    }
                }
                index += 1;
            }
            growing.drain(|cluster| self.leftover.extend(cluster.valid()));
        });
        for &index in &self.leftover {
            let index = index as usize;
            if growing.cluster.lanes == LANES || !growing.try_add(index) {
                growing.drain(|cluster| clusters.push(*cluster));
                growing.try_add(index);
            }
        }
        growing.drain(|cluster| clusters.push(*cluster));
    }

    pub(super) fn memory(&self) -> usize {
        4 * self.leftover.capacity()
    }
}

/// A cluster that is being filled.
struct Growing<'a> {
    sequence: &'a Sequence,
    /// Reach of a particle of the cluster (m).
    range: f64,
    /// Volume within reach of one particle and of the cluster (m³).
    sphere: f64,
    reach: f64,
    cluster: Cluster,
}

/// Volume within reach of a particle (m³).
#[inline(always)]
fn sphere(range: f64) -> f64 {
    reach(&[0.0; 3], &[0.0; 3], range)
}

impl<'a> Growing<'a> {
    #[inline(always)]
    fn new(sequence: &'a Sequence, group: usize, range: f64) -> Self {
        Self {
            sequence,
            range,
            sphere: sphere(range),
            reach: 0.0,
            cluster: Cluster {
                receivers: [0; LANES],
                lanes: 0,
                group,
                lower: [0.0; 3],
                upper: [0.0; 3],
            },
        }
    }

    /// The eight images from a place on as a cluster, if all are owned and near each other.
    #[inline(always)]
    fn row(&self, index: usize) -> Option<Cluster> {
        let eight = self.sequence.eights(index..index + LANES).next()?;
        let edge = |pick: fn(f64, f64) -> f64| {
            eight.coordinates.map(|x| {
                let four: [f64; 4] = std::array::from_fn(|k| pick(x[k], x[k + 4]));
                pick(pick(four[0], four[2]), pick(four[1], four[3]))
            })
        };
        let lower = edge(|a, b| if a < b { a } else { b });
        let upper = edge(|a, b| if a > b { a } else { b });
        let (mut range, mut alone) = (self.range, self.sphere);
        if let Some(lengths) = self.sequence.smoothing_lengths().get(index..index + LANES) {
            range = 2.0 * lengths.iter().copied().fold(0.0, f64::max);
            alone = sphere(range);
        }
        let near = reach(&lower, &upper, range) <= (1.0 + GROWTH) * alone;
        #[allow(clippy::cast_possible_truncation, reason = "images fit u32")]
        let owned = u64::from_le_bytes(*eight.special) & u64::from_le_bytes([IMAGE; LANES]) == 0;
        #[allow(clippy::cast_possible_truncation, reason = "images fit u32")]
        (near && owned).then(|| Cluster {
            receivers: std::array::from_fn(|k| (index + k) as u32),
            lanes: LANES,
            group: self.cluster.group,
            lower,
            upper,
        })
    }

    /// Adds a particle if it is near the others.
    #[inline(always)]
    fn try_add(&mut self, index: usize) -> bool {
        let Cluster {
            receivers,
            lanes,
            lower,
            upper,
            ..
        } = &mut self.cluster;
        let x: [f64; 3] = std::array::from_fn(|a| self.sequence.coordinates(a, index)[0]);
        if *lanes == 0 {
            if let Some(length) = self.sequence.smoothing_lengths().get(index) {
                // What comes next is about as large.
                self.range = 2.0 * length;
                self.sphere = sphere(self.range);
            }
            (*lower, *upper, self.reach) = (x, x, self.sphere);
        } else {
            let low = std::array::from_fn(|a| x[a].min(lower[a]));
            let high = std::array::from_fn(|a| x[a].max(upper[a]));
            let volume = reach(&low, &high, self.range);
            let near = volume - self.reach <= GROWTH * self.sphere;
            if !near {
                return false;
            }
            (*lower, *upper, self.reach) = (low, high, volume);
        }
        #[allow(clippy::cast_possible_truncation, reason = "images fit u32")]
        receivers[*lanes..].fill(index as u32);
        *lanes += 1;
        true
    }

    /// Hands over what is there, if anything, and begins anew.
    #[inline(always)]
    fn drain(&mut self, take: impl FnOnce(&Cluster)) {
        if self.cluster.lanes > 0 {
            take(&self.cluster);
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
