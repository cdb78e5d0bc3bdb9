//! Initial pairs lane by lane: each of eight receivers meets neighbours of its own, whose records are turned into vectors.

use crate::neighbourhood::{Neighbourhood, SMALLEST_SQUARE, gather_at};
use numerics::dispatch::Vectorised;
use numerics::kernel::{PairKernel, PairScale};
use numerics::lane_matrix::dot;
use numerics::lanes::{LANES, Lanes};

/// The records at eight places among all images.
///
/// # Safety
/// There is a record of each image, and each place is that of an image.
#[inline(always)]
pub(super) unsafe fn at<'a, T>(records: &'a [T], places: &[u32; LANES]) -> [&'a T; LANES] {
    // SAFETY: by the contract of this function. (Looked at, eight bounds an array take as long as a tenth of the sums.)
    let at = |k: usize| unsafe { records.get_unchecked(places[k] as usize) };
    [at(0), at(1), at(2), at(3), at(4), at(5), at(6), at(7)]
}

/// Row `c` of each of eight records of rows of four numbers, as vectors.
#[inline(always)]
pub(super) fn columns<V: Lanes, const N: usize>(
    records: [&[[f64; 4]; N]; LANES],
    c: usize,
) -> [V; 4] {
    let row = |k: usize| &records[k][c];
    V::columns([
        row(0),
        row(1),
        row(2),
        row(3),
        row(4),
        row(5),
        row(6),
        row(7),
    ])
}

/// Eight receivers and a neighbour of each.
pub(super) struct Pair<V> {
    /// Places of the neighbours among all sources.
    pub(super) places: [u32; LANES],
    /// `X_i − X_j` (m).
    pub(super) r: [V; 3],
    /// Its square (m²), not below [`SMALLEST_SQUARE`].
    pub(super) square: V,
    /// Its length (m).
    pub(super) distance: V,
    /// Velocities of the neighbours (m/s).
    pub(super) velocity: [V; 3],
    /// Volumes of the neighbours (m^d).
    pub(super) volume: V,
    /// The kernel.
    pub(super) kernel: PairKernel<V>,
    /// `h_ij` (m).
    pub(super) h: V,
}

/// What is known of a pair before its turn.
#[derive(Clone, Copy)]
struct Ahead<V> {
    places: [u32; LANES],
    r: [V; 3],
    /// Volumes of the neighbours (m^d), which stand beside their positions.
    volume: V,
    square: V,
    distance: V,
}

/// Pairs of eight receivers, one of each at a time. Roots are begun a pair ahead.
pub(super) struct Pairs<'a, V, S> {
    around: Neighbourhood<'a, S>,
    /// Motion of all sources by rows of four numbers.
    motion: &'a [[[f64; 4]; 2]],
    /// Initial positions of the receivers (m).
    initial: [V; 3],
    h: V,
    done: usize,
    count: usize,
    next: Ahead<V>,
}

impl<'a, V: Lanes, S: PairScale> Pairs<'a, V, S> {
    /// Of receivers with these initial positions (m).
    ///
    /// # Panics
    /// If one of the `lengths`, of what the sums read of all images, is not their number.
    #[inline(always)]
    pub(super) fn new<const N: usize>(
        around: Neighbourhood<'a, S>,
        initial: &[V; 3],
        lengths: [usize; N],
    ) -> Self {
        for length in lengths {
            assert_eq!(length, around.sources.records.len(), "one of each image");
        }
        let zero = V::splat(0.0);
        let mut pairs = Self {
            around,
            motion: bytemuck::cast_slice(around.sources.records),
            initial: *initial,
            h: around.h(),
            done: 0,
            count: if around.close.is_empty() {
                around.neighbours.len()
            } else {
                around.close.len()
            },
            next: Ahead {
                places: [0; LANES],
                r: [zero; 3],
                volume: zero,
                square: zero,
                distance: zero,
            },
        };
        if pairs.count > 0 {
            // The compiler must not know how it comes about: else it takes the root when it is due.
            pairs.next = std::hint::black_box(pairs.begin(0));
        }
        pairs
    }

    /// Where the neighbours stand.
    #[inline(always)]
    fn places(&self, step: usize) -> [u32; LANES] {
        let Neighbourhood {
            neighbours, close, ..
        } = self.around;
        if close.is_empty() {
            return [neighbours[step]; LANES];
        }
        let row = &close[step];
        // SAFETY: rows are made of places in this list.
        let place = |k: usize| unsafe { *neighbours.get_unchecked(usize::from(row[k])) };
        [
            place(0),
            place(1),
            place(2),
            place(3),
            place(4),
            place(5),
            place(6),
            place(7),
        ]
    }

    #[inline(always)]
    fn motion_at(&self, places: &[u32; LANES]) -> [&'a [[f64; 4]; 2]; LANES] {
        // SAFETY: lists name places of images, each of which has its motion.
        unsafe { at(self.motion, places) }
    }

    #[inline(always)]
    fn begin(&self, step: usize) -> Ahead<V> {
        let places = self.places(step);
        let [x, y, z, volume] = columns(self.motion_at(&places), 0);
        let r = [
            self.initial[0].sub(x),
            self.initial[1].sub(y),
            self.initial[2].sub(z),
        ];
        let square = dot(&r, &r).max(V::splat(SMALLEST_SQUARE));
        Ahead {
            places,
            r,
            volume,
            square,
            distance: square.sqrt(),
        }
    }
}

impl<V: Lanes, S: PairScale> Iterator for Pairs<'_, V, S> {
    type Item = Pair<V>;

    #[inline(always)]
    fn next(&mut self) -> Option<Pair<V>> {
        if self.done == self.count {
            return None;
        }
        let Ahead {
            places,
            r,
            volume,
            square,
            distance,
        } = self.next;
        self.done += 1;
        self.next = self.begin(self.done.min(self.count - 1));
        let [x, y, z, _] = columns(self.motion_at(&places), 1);
        let sources = self.around.sources;
        let h = if S::VARIABLE {
            let theirs = gather_at(&places, |place| sources.lengths[place]);
            sources.scale.length(self.h, theirs)
        } else {
            sources.scale.length(self.h, self.h)
        };
        let inverse_h = if S::VARIABLE { V::splat(1.0).div(h) } else { h };
        Some(Pair {
            places,
            r,
            square,
            distance,
            velocity: [x, y, z],
            volume,
            kernel: sources.scale.kernel(distance, inverse_h),
            h,
        })
    }
}

/// Tells which of a cluster's neighbours each of its receivers sums.
pub struct Close<'a, S> {
    /// The receivers and their neighbours at their initial positions.
    pub around: Neighbourhood<'a, S>,
    /// For each neighbour a byte is added: bit k is lane k.
    pub bits: &'a mut Vec<u8>,
}

impl<S: PairScale> Vectorised for Close<'_, S> {
    type Output = ();

    #[inline(always)]
    fn run<V: Lanes>(self) {
        let (initial, _) = self.around.motion::<V>();
        for pair in self.around.pairs(&initial) {
            let bits = V::splat(0.0).less_than(pair.kernel.inside);
            self.bits.push(bits);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::{InitialPairs, InitialSums, TotalGradient, TotalRecord};
    use super::*;
    use crate::momentum::{Momentum, Viscosity};
    use crate::neighbourhood::Sources;
    use crate::terms::PairTerms;
    use numerics::dispatch::available;
    use numerics::kernel::{ConstantScale, Kernel, MeanScale};
    use numerics::lanes::F64x8;
    use particles::neighbours::MotionRecord;

    const COUNT: usize = 60;

    /// A number between −1 and 1 that follows from where it stands.
    fn noise(place: usize, number: usize) -> f64 {
        let bits = (place * 64 + number + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        f64::from(u32::try_from(bits >> 40 & 0xffff).unwrap()) / 32768.0 - 1.0
    }

    fn bits(values: &[F64x8]) -> Vec<u64> {
        let all = values.iter().flat_map(|lanes| lanes.0);
        all.map(f64::to_bits).collect()
    }

    /// Rows that hold for each lane its own part of the list, in its order, and its receiver where it has no more.
    fn rows(list: &[u32], receivers: &[u32; LANES], near: &[u8]) -> Vec<[u16; LANES]> {
        let place = |at: usize| u16::try_from(at).unwrap();
        let own = receivers.map(|i| place(list.iter().position(|&j| j == i).unwrap()));
        let (mut rows, mut used) = (Vec::new(), [0; LANES]);
        for (at, bits) in near.iter().enumerate() {
            for k in (0..LANES).filter(|&k| bits >> k & 1 == 1 && own[k] != place(at)) {
                if used[k] == rows.len() {
                    rows.push(own);
                }
                rows[used[k]][k] = place(at);
                used[k] += 1;
            }
        }
        rows
    }

    fn check<S: PairScale>(scale: S) {
        let numbers = |place: usize, from: usize| -> [f64; 9] {
            std::array::from_fn(|c| noise(place, from + c))
        };
        let motion: Vec<MotionRecord> = (0..COUNT)
            .map(|i| MotionRecord {
                position: std::array::from_fn(|a| noise(i, a)),
                velocity: std::array::from_fn(|a| noise(i, 3 + a)),
                volume: 0.1 + 0.01 * noise(i, 6),
                mass: 0.3,
            })
            .collect();
        let records: Vec<TotalRecord> = (0..COUNT)
            .map(|i| TotalRecord {
                stress: numbers(i, 10),
                hourglass: 1.0 + 0.1 * noise(i, 19),
                density: 3.0 + 0.1 * noise(i, 20),
                viscous_speed: 1.0 + noise(i, 21),
                position: std::array::from_fn(|a| 1.1 * noise(i, a)),
                half_deformation: numbers(i, 22),
            })
            .collect();
        let positions: Vec<[f64; 4]> = (records.iter())
            .map(|record| {
                let [x, y, z] = record.position;
                [x, y, z, f64::NAN]
            })
            .collect();
        let lengths: Vec<f64> = (0..COUNT).map(|i| 0.4 + 0.05 * noise(i, 40)).collect();
        let sources = Sources {
            records: &motion,
            lengths: &lengths,
            scale,
        };
        let list: Vec<u32> = (0..60).rev().collect();
        let receivers = [3, 7, 20, 21, 40, 59, 59, 59];
        let shared = sources.around(receivers, &list);
        let mut initial = vec![InitialSums::default(); COUNT];
        for (place, own) in receivers
            .into_iter()
            .zip(available()[0].run(InitialPairs { around: shared }))
        {
            initial[place as usize] = own;
        }
        let mut results = Vec::new();
        for set in available() {
            let mut near = Vec::new();
            set.run(Close {
                around: shared,
                bits: &mut near,
            });
            let rows = rows(&list, &receivers, &near);
            assert!(!rows.is_empty() && 2 * rows.len() < list.len());
            for around in [shared, shared.close(&rows)] {
                let total = set.run(TotalGradient {
                    around,
                    initial: &initial,
                    positions: &positions,
                    dimension: 3,
                });
                let forces = set.run(Momentum::<_, TotalRecord, false> {
                    around,
                    stresses: &records,
                    viscosity: Viscosity {
                        alpha: 1.0,
                        beta: 2.0,
                        negligible: 1e-6,
                    },
                    terms: PairTerms::default(),
                });
                results.push([
                    bits(&total.gradient),
                    bits(&total.deformation),
                    bits(&total.rest),
                    bits(&[total.farthest, total.limiter.linear]),
                    bits(&forces.acceleration),
                    bits(&[forces.power, forces.approach]),
                ]);
            }
        }
        assert!(results.iter().all(|result| *result == results[0]));
    }

    /// Lists that lanes share and those that they do not give the same bits, on all instruction sets.
    #[test]
    fn lists_of_lanes_change_no_bit() {
        check(ConstantScale::new(&Kernel::new(3), 0.4));
        check(MeanScale::new(&Kernel::new(3)));
    }
}
