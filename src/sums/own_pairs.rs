//! Eight receivers, each with its own neighbours: of those of all of them, what is within its support.
//!
//! A receiver meets its neighbours in the same order as among all, and those that are left out would add exact zeros. So the
//! sums have the same bits, by half as many steps. Each step gathers eight records, which pays where records are short.

use std::cell::Cell;

use super::neighbourhood::{Distance, Divided, Neighbourhood, gather_at, records};
use numerics::kernel::{PairScale, SUPPORT};
use numerics::lanes::{LANES, Lanes, TWICE};
use particles::neighbours::MotionRecord;

/// Neighbours that are looked at together.
pub(crate) const BLOCK: usize = 256;

/// Share of a support, and of the extent of a cluster, by which pairs are taken in that are farther apart: some ten times
/// what single precision rounds.
const SLACK: f64 = 1e-6;

/// Memory of a thread for the own neighbours of eight receivers.
#[derive(Debug)]
pub(crate) struct Own {
    /// Places of the neighbours of all.
    block: [u32; BLOCK],
    /// Their coordinates from the first receiver on, over its support, and the halves of their supports.
    points: [[f32; BLOCK]; 4],
    /// Places of the own neighbours of each receiver.
    places: [[u32; BLOCK + TWICE]; LANES],
    /// The largest number of own neighbours.
    most: usize,
}

thread_local! {
    static MEMORY: Cell<Option<Box<Own>>> = const { Cell::new(None) };
}

impl Own {
    /// That of this thread, until it is given back.
    pub(crate) fn take() -> Box<Self> {
        MEMORY.take().unwrap_or_else(|| {
            Box::new(Self {
                block: [0; BLOCK],
                points: [[0.0; BLOCK]; 4],
                places: [[0; BLOCK + TWICE]; LANES],
                most: 0,
            })
        })
    }

    /// Gives it back.
    pub(crate) fn give(self: Box<Self>) {
        MEMORY.set(Some(self));
    }

    /// Chooses from a block of neighbours those of each receiver, and few others.
    #[inline(always)]
    pub(crate) fn choose<V: Lanes, S: PairScale>(
        &mut self,
        around: &Neighbourhood<S>,
        block: &[u32],
    ) {
        let sources = &around.sources;
        let own = records(sources.records, &around.receivers);
        let h = around.h::<V>();
        let half = sources.scale.length(h, h).store().0;
        let (centre, per_support) = (&own[0].position, 1.0 / (SUPPORT * half[0]));
        let (mut here, mut extent) = ([[0.0; 3]; LANES], 1.0_f32);
        for k in 0..LANES {
            for a in 0..3 {
                here[k][a] = single((own[k].position[a] - centre[a]) * per_support);
                extent = extent.max(here[k][a].abs());
            }
        }
        let whole = block.len().next_multiple_of(TWICE);
        self.block[..block.len()].copy_from_slice(block);
        self.block[block.len()..whole].fill(block[0]);
        let scale = V::splat(per_support);
        for (n, eight) in self.block[..whole].as_chunks().0.iter().enumerate() {
            let at = |k: usize| &sources.records[eight[k] as usize];
            let columns = V::columns(halves(at, 0));
            for a in 0..3 {
                let along = columns[a].sub(V::splat(centre[a])).mul(scale);
                self.points[a].as_chunks_mut().0[n] = along.narrow();
            }
            if S::VARIABLE {
                let lengths = gather_at::<V>(eight, |place| sources.lengths[place]);
                self.points[3].as_chunks_mut().0[n] = lengths.mul(scale).narrow();
            }
        }
        let slack = single(SLACK) * extent;
        let mut far = [(1.0 + slack) * (1.0 + slack); TWICE];
        let mut used = [0; LANES];
        let [x, y, z, lengths] = self.points.each_ref().map(|all| all.as_chunks().0);
        for (n, numbers) in self.block[..whole].as_chunks().0.iter().enumerate() {
            let left = block.len() - TWICE * n;
            let known = if left < TWICE {
                (1 << left) - 1
            } else {
                u16::MAX
            };
            for k in 0..LANES {
                if S::VARIABLE {
                    let length = single(half[k] * per_support) + slack;
                    for (far, other) in far.iter_mut().zip(&lengths[n]) {
                        let range = (length + other) * (1.0 + slack);
                        *far = range * range;
                    }
                }
                let bits = V::near([&x[n], &y[n], &z[n]], &here[k], &far) & known;
                used[k] = V::keep(numbers, bits, &mut self.places[k], used[k]);
            }
        }
        self.most = 0;
        for k in 0..LANES {
            self.most = self.most.max(used[k]);
        }
        // Who has fewer meets itself, and adds nothing.
        for k in 0..LANES {
            self.places[k][used[k]..self.most + 2].fill(around.receivers[k]);
        }
    }

    /// The pairs of receivers at `position` (m) with those that were chosen.
    #[inline(always)]
    pub(crate) fn pairs<'a, V: Lanes, S: PairScale>(
        &'a self,
        around: &Neighbourhood<'a, S>,
        position: &[V; 3],
    ) -> OwnPairs<'a, V, S> {
        let any = V::splat(1.0);
        let mut pairs = OwnPairs {
            around: *around,
            position: *position,
            h: around.h(),
            own: self,
            done: 0,
            next: Ready {
                r: [any; 3],
                square: any,
                factor: any,
            },
            after: Ahead {
                r: [any; 3],
                volume: any,
                h: any,
                far: Distance::of(any),
            },
        };
        // See `Neighbourhood::pairs`.
        pairs.next = std::hint::black_box(pairs.ready(&pairs.ahead(0)));
        pairs.after = std::hint::black_box(pairs.ahead(1));
        pairs
    }
}

/// Rounded to single precision.
#[inline(always)]
fn single(x: f64) -> f32 {
    #[allow(clippy::cast_possible_truncation, reason = "rounding is meant")]
    {
        x as f32
    }
}

/// The first four numbers of eight records, or the second four.
#[inline(always)]
fn halves<'a>(record: impl Fn(usize) -> &'a MotionRecord, half: usize) -> [&'a [f64; 4]; LANES] {
    let at = |k: usize| {
        let halves: &[[f64; 4]; 2] = bytemuck::cast_ref(record(k));
        &halves[half]
    };
    [at(0), at(1), at(2), at(3), at(4), at(5), at(6), at(7)]
}

/// Eight receivers, each with a neighbour.
pub(crate) struct OwnPair<V> {
    /// `x_i − x_j` (m).
    pub(crate) r: [V; 3],
    /// Its square (m²), see [`Separation`](super::neighbourhood::Separation).
    pub(crate) square: V,
    /// `V_j W'/r` (1/m²).
    pub(crate) factor: V,
    /// Velocity of the neighbours (m/s).
    pub(crate) velocity: [V; 3],
}

/// What is known of a pair one step ahead.
#[derive(Clone, Copy)]
struct Ready<V> {
    r: [V; 3],
    square: V,
    factor: V,
}

/// What is known two steps ahead.
#[derive(Clone, Copy)]
struct Ahead<V> {
    r: [V; 3],
    volume: V,
    /// `h_ij` (m).
    h: V,
    far: Distance<V>,
}

/// Pairs of eight receivers with their own neighbours; roots and divisions are begun as in
/// [`Pairs`](super::neighbourhood::Pairs).
pub(crate) struct OwnPairs<'a, V, S> {
    around: Neighbourhood<'a, S>,
    position: [V; 3],
    h: V,
    own: &'a Own,
    done: usize,
    next: Ready<V>,
    after: Ahead<V>,
}

impl<V: Lanes, S: PairScale> OwnPairs<'_, V, S> {
    #[inline(always)]
    fn place(&self, step: usize, k: usize) -> usize {
        debug_assert!(step < self.own.most + 2);
        // SAFETY: `Own::choose` has filled so many places.
        unsafe { *self.own.places[k].get_unchecked(step) as usize }
    }

    /// The first four numbers of the neighbours of a step, or the second four.
    #[inline(always)]
    fn columns(&self, step: usize, half: usize) -> [V; 4] {
        let records = self.around.sources.records;
        // SAFETY: `Own::choose` has read the records of these places.
        let at = |k: usize| unsafe { records.get_unchecked(self.place(step, k)) };
        V::columns(halves(at, half))
    }

    #[inline(always)]
    fn ahead(&self, step: usize) -> Ahead<V> {
        let sources = &self.around.sources;
        let [x, y, z, volume] = self.columns(step, 0);
        let [a, b, c] = self.position;
        let r = [a.sub(x), b.sub(y), c.sub(z)];
        let h_j = if S::VARIABLE {
            let at = |k: usize| sources.lengths[self.place(step, k)];
            V::read(&[at(0), at(1), at(2), at(3), at(4), at(5), at(6), at(7)])
        } else {
            self.h
        };
        Ahead {
            r,
            volume,
            h: sources.scale.length(self.h, h_j),
            far: Distance::of(r[2].mul_add(r[2], r[1].mul_add(r[1], r[0].mul(r[0])))),
        }
    }

    #[inline(always)]
    fn ready(&self, of: &Ahead<V>) -> Ready<V> {
        let Distance { square, distance } = of.far;
        let Divided {
            inverse, inverse_h, ..
        } = Divided::of::<S>(of.far, of.h, None);
        let kernel = self.around.sources.scale.kernel(distance, inverse_h);
        Ready {
            r: of.r,
            square,
            factor: inverse.mul(of.volume).mul(kernel.slope),
        }
    }
}

impl<V: Lanes, S: PairScale> Iterator for OwnPairs<'_, V, S> {
    type Item = OwnPair<V>;

    #[inline(always)]
    fn next(&mut self) -> Option<Self::Item> {
        let step = self.done;
        if step == self.own.most {
            return None;
        }
        let Ready { r, square, factor } = self.next;
        let [u, v, w, _] = self.columns(step, 1);
        self.next = self.ready(&self.after);
        self.after = self.ahead(step + 2);
        self.done += 1;
        Some(OwnPair {
            r,
            square,
            factor,
            velocity: [u, v, w],
        })
    }
}
