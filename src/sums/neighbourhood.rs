//! The receivers of one cluster with their neighbours: what all sums over pairs begin with.

use std::marker::PhantomData;

use numerics::arc::{Arc, POINTS};
use numerics::kernel::{PairKernel, PairScale, SUPPORT};
use numerics::lanes::{LANES, Lanes};
use particles::neighbours::MotionRecord;

/// Squares of distances are never smaller than this (m²), so that a particle meeting itself
/// divides by something: it then adds an exact zero since its `r_ij` is zero.
pub const SMALLEST_SQUARE: f64 = 1e-60;

/// Facts of all particles and images that a sweep reads.
#[derive(Debug, Clone, Copy)]
pub struct Sources<'a, S> {
    /// Their motion.
    pub records: &'a [MotionRecord],
    /// Their smoothing lengths (m); empty where the scale is constant.
    pub lengths: &'a [f64],
    /// Smoothing length of pairs.
    pub scale: S,
}

impl<'a, S> Sources<'a, S> {
    /// The same with another scale.
    pub(crate) fn with<T>(&self, scale: T) -> Sources<'a, T> {
        Sources {
            records: self.records,
            lengths: self.lengths,
            scale,
        }
    }
}

impl<'a, S: PairScale> Sources<'a, S> {
    /// Eight receivers, of which unused lanes repeat a valid one, with the neighbours of all of
    /// them together, in canonical order.
    #[inline(always)]
    #[must_use]
    pub fn around(self, receivers: [u32; LANES], neighbours: &'a [u32]) -> Neighbourhood<'a, S> {
        Neighbourhood {
            sources: self,
            receivers,
            neighbours,
            close: &[],
        }
    }
}

/// The receivers of one cluster with their neighbours; sums go in the order of `neighbours`.
#[derive(Debug, Clone, Copy)]
pub struct Neighbourhood<'a, S> {
    pub(crate) sources: Sources<'a, S>,
    pub(crate) receivers: [u32; LANES],
    pub(crate) neighbours: &'a [u32],
    /// What each lane itself has to sum, as places in `neighbours`; empty where that is not listed.
    pub(crate) close: &'a [[u16; LANES]],
}

impl<'a, S: PairScale> Neighbourhood<'a, S> {
    /// With what each lane itself has to sum, as places among the neighbours.
    #[inline(always)]
    #[must_use]
    pub fn close(self, close: &'a [[u16; LANES]]) -> Self {
        Self { close, ..self }
    }

    /// Position (m) and velocity (m/s) of the receivers.
    #[inline(always)]
    pub(crate) fn motion<V: Lanes>(&self) -> ([V; 3], [V; 3]) {
        let receivers = records(self.sources.records, &self.receivers);
        (
            gather_all(&receivers, |record, a| record.position[a]),
            gather_all(&receivers, |record, a| record.velocity[a]),
        )
    }

    /// Smoothing lengths of the receivers (m), whatever if the scale is constant.
    #[inline(always)]
    pub(crate) fn h<V: Lanes>(&self) -> V {
        let at = |k: usize| length::<S>(self.sources.lengths, self.receivers[k] as usize);
        V::read(&[at(0), at(1), at(2), at(3), at(4), at(5), at(6), at(7)])
    }

    /// The receivers, which stand at `position` (m), with one neighbour after the other. A particle
    /// whose position is NaN has none, not even itself.
    #[inline(always)]
    pub(crate) fn pairs<V: Lanes>(&self, position: &[V; 3]) -> Pairs<'a, V, S, ()> {
        self.pairs_beside(position, ())
    }

    /// The same, with the inverse of a divisor.
    #[inline(always)]
    pub(crate) fn pairs_beside<V: Lanes, D: Divisor<V>>(
        &self,
        position: &[V; 3],
        divisor: D,
    ) -> Pairs<'a, V, S, D> {
        let one = V::splat(1.0);
        let mut pairs = Pairs {
            around: *self,
            position: *position,
            h: self.h(),
            divisor,
            done: 0,
            next: Divided::of::<S>(Distance::of(one), one, None),
            after: Distance::of(one),
            arc: Arc::none(),
            point: 0,
        };
        if !S::RING && !self.neighbours.is_empty() {
            // The compiler must not know how these come about: where they and those of the loop do alike, it
            // takes roots and divides behind the two, when the result is due.
            pairs.next = std::hint::black_box(pairs.divide(0, pairs.distance(0)));
            pairs.after = std::hint::black_box(pairs.distance(1));
        }
        pairs
    }
}

/// Divisor of a sum over pairs beside their distances.
pub(crate) trait Divisor<V>: Copy {
    /// Of the neighbour of this index, squares of distances (m²) and `h_ij` (m), if any.
    fn of(&self, index: usize, square: V, h: V) -> Option<V>;
}

impl<V> Divisor<V> for () {
    #[inline(always)]
    fn of(&self, _: usize, _: V, _: V) -> Option<V> {
        None
    }
}

/// Eight receivers and one neighbour, or one point of it that is a ring.
pub(crate) struct Pair<'a, V, S> {
    /// Index of the neighbour among all sources.
    pub(crate) index: usize,
    /// The neighbour.
    pub(crate) source: &'a MotionRecord,
    /// Their separation.
    pub(crate) separation: Separation<V>,
    /// The kernel.
    pub(crate) kernel: PairKernel<V>,
    /// `h_ij` (m).
    pub(crate) h: V,
    /// The inverse of the divisor, 1 without one.
    pub(crate) beside: V,
    /// Where on a ring.
    arc: Arc<V>,
    scale: PhantomData<S>,
}

impl<V: Lanes, S: PairScale> Pair<'_, V, S> {
    /// Volume of the neighbour (m^d), or what the point stands for of it.
    #[inline(always)]
    pub(crate) fn volume(&self) -> V {
        let volume = V::splat(self.source.volume);
        if S::RING {
            volume.mul(self.arc.share)
        } else {
            volume
        }
    }

    /// A vector of the neighbour, there.
    #[inline(always)]
    pub(crate) fn vector(&self, of: &[f64; 3]) -> [V; 3] {
        let plain = [V::splat(of[0]), V::splat(of[1]), V::splat(of[2])];
        if S::RING {
            let [cosine, sine] = self.arc.turn();
            [plain[0].mul(cosine), plain[1], plain[0].mul(sine)]
        } else {
            plain
        }
    }

    /// Velocity of the neighbour there (m/s).
    #[inline(always)]
    pub(crate) fn velocity(&self) -> [V; 3] {
        self.vector(&self.source.velocity)
    }

    /// A tensor of the neighbour (row-major), there; on a ring it has the plane and the ring's direction as axes.
    #[inline(always)]
    pub(crate) fn tensor(&self, of: &[f64; 9]) -> [V; 9] {
        let mut plain = [V::splat(0.0); 9];
        for c in 0..9 {
            plain[c] = V::splat(of[c]);
        }
        if !S::RING {
            return plain;
        }
        let [c, s] = self.arc.turn();
        let [rr, ry, _, yr, yy, _, _, _, hoop] = plain;
        let (cc, ss, cs) = (c.mul(c), s.mul(s), c.mul(s));
        let across = cs.mul(rr.sub(hoop));
        [
            cc.mul_add(rr, ss.mul(hoop)),
            c.mul(ry),
            across,
            c.mul(yr),
            yy,
            s.mul(yr),
            across,
            s.mul(ry),
            ss.mul_add(rr, cc.mul(hoop)),
        ]
    }
}

impl<S: PairScale> Neighbourhood<'_, S> {
    /// Takes out of the sum of a vector over the points of rings what their mirror images cancel.
    #[inline(always)]
    pub(crate) fn mirror<V: Lanes>(vector: &mut [V; 3]) {
        if S::RING {
            vector[2] = V::splat(0.0);
        }
    }

    /// The same of a tensor (row-major).
    #[inline(always)]
    pub(crate) fn mirror_tensor<V: Lanes>(tensor: &mut [V; 9]) {
        if S::RING {
            for c in [2, 5, 6, 7] {
                tensor[c] = V::splat(0.0);
            }
        }
    }

    /// The same of a symmetric tensor (xx yy zz xy xz yz).
    #[inline(always)]
    pub(crate) fn mirror_symmetric<V: Lanes>(tensor: &mut [V; 6]) {
        if S::RING {
            tensor[4] = V::splat(0.0);
            tensor[5] = V::splat(0.0);
        }
    }
}

/// Pairs of eight receivers, neighbour after neighbour. Roots are begun two neighbours ahead and divisions one:
/// both take long, and processors look no farther than some sixty operations that wait.
pub(crate) struct Pairs<'a, V, S, D: Divisor<V>> {
    around: Neighbourhood<'a, S>,
    position: [V; 3],
    h: V,
    divisor: D,
    done: usize,
    next: Divided<V>,
    after: Distance<V>,
    /// The point in hand of a ring, and its number.
    arc: Arc<V>,
    point: usize,
}

impl<V: Lanes, S: PairScale, D: Divisor<V>> Pairs<'_, V, S, D> {
    /// Index of the neighbour so many after the next, at most the last.
    #[inline(always)]
    fn index(&self, ahead: usize) -> usize {
        let neighbours = self.around.neighbours;
        neighbours[(self.done + ahead).min(neighbours.len() - 1)] as usize
    }

    #[inline(always)]
    fn apart(&self, index: usize) -> [V; 3] {
        let source = &self.around.sources.records[index].position;
        let along = |a: usize| self.position[a].sub(V::splat(source[a]));
        [along(0), along(1), along(2)]
    }

    #[inline(always)]
    fn distance(&self, ahead: usize) -> Distance<V> {
        let r = self.apart(self.index(ahead));
        Distance::of(r[2].mul_add(r[2], r[1].mul_add(r[1], r[0].mul(r[0]))))
    }

    #[inline(always)]
    fn divide(&self, ahead: usize, far: Distance<V>) -> Divided<V> {
        let index = self.index(ahead);
        let Sources { lengths, scale, .. } = self.around.sources;
        let h = scale.length(self.h, V::splat(length::<S>(lengths, index)));
        Divided::of::<S>(far, h, self.divisor.of(index, far.square, h))
    }

    /// The next point of a ring.
    #[inline(always)]
    fn on_ring(&mut self) -> (Separation<V>, Divided<V>) {
        let index = self.index(0);
        let Sources {
            records,
            lengths,
            scale,
        } = self.around.sources;
        let h = scale.length(self.h, V::splat(length::<S>(lengths, index)));
        let [x, y, _] = self.apart(index);
        let radii = [self.position[0], V::splat(records[index].position[0])];
        let flat = y.mul_add(y, x.mul(x));
        if self.point == 0 {
            self.arc = Arc::new(radii, flat, h.mul(V::splat(SUPPORT)));
        } else {
            self.arc.advance();
        }
        self.point += 1;
        if self.point == POINTS {
            self.point = 0;
            self.done += 1;
        }
        let far = Distance::of(self.arc.square(radii, flat));
        let divided = Divided::of::<S>(far, h, self.divisor.of(index, far.square, h));
        let [x, z] = self.arc.apart(radii[0], radii[1]);
        let separation = Separation {
            r: [x, y, z],
            square: far.square,
            distance: far.distance,
            inverse: divided.inverse,
        };
        (separation, divided)
    }
}

impl<'a, V: Lanes, S: PairScale, D: Divisor<V>> Iterator for Pairs<'a, V, S, D> {
    type Item = Pair<'a, V, S>;

    #[inline(always)]
    fn next(&mut self) -> Option<Self::Item> {
        let Sources {
            records,
            lengths,
            scale,
        } = self.around.sources;
        if self.done == self.around.neighbours.len() {
            return None;
        }
        let (index, now) = (self.index(0), self.next);
        if S::RING {
            let (separation, now) = self.on_ring();
            return Some(Pair {
                index,
                source: &records[index],
                kernel: scale.kernel(separation.distance, now.inverse_h),
                separation,
                h: scale.length(self.h, V::splat(length::<S>(lengths, index))),
                beside: now.beside,
                arc: self.arc,
                scale: PhantomData,
            });
        }
        let Distance { square, distance } = now.far;
        self.next = self.divide(1, self.after);
        self.after = self.distance(2);
        self.done += 1;
        Some(Pair {
            index,
            source: &records[index],
            separation: Separation {
                r: self.apart(index),
                square,
                distance,
                inverse: now.inverse,
            },
            kernel: scale.kernel(distance, now.inverse_h),
            h: scale.length(self.h, V::splat(length::<S>(lengths, index))),
            beside: now.beside,
            arc: self.arc,
            scale: PhantomData,
        })
    }
}

/// The records of eight receivers. (Written out, since what array methods call may be compiled
/// apart from the vector code.)
#[inline(always)]
pub(crate) fn records<'a, R>(sources: &'a [R], indices: &[u32; LANES]) -> [&'a R; LANES] {
    let at = |k: usize| &sources[indices[k] as usize];
    [at(0), at(1), at(2), at(3), at(4), at(5), at(6), at(7)]
}

/// One number of each of eight records.
#[inline(always)]
pub(crate) fn gather<V: Lanes, R>(records: &[&R; LANES], number: impl Fn(&R) -> f64) -> V {
    let at = |k: usize| number(records[k]);
    V::read(&[at(0), at(1), at(2), at(3), at(4), at(5), at(6), at(7)])
}

/// The value at each of eight places.
#[inline(always)]
pub(crate) fn gather_at<V: Lanes>(places: &[u32; LANES], value: impl Fn(usize) -> f64) -> V {
    let at = |k: usize| value(places[k] as usize);
    V::read(&[at(0), at(1), at(2), at(3), at(4), at(5), at(6), at(7)])
}

/// `N` numbers of each of eight records.
#[inline(always)]
pub(crate) fn gather_all<V: Lanes, R, const N: usize>(
    records: &[&R; LANES],
    number: impl Fn(&R, usize) -> f64,
) -> [V; N] {
    let mut all = [V::splat(0.0); N];
    for c in 0..N {
        all[c] = gather(records, |record| number(record, c));
    }
    all
}

/// Smoothing length of a neighbour (m), whatever if the scale is constant.
#[inline(always)]
fn length<S: PairScale>(lengths: &[f64], index: usize) -> f64 {
    if S::VARIABLE { lengths[index] } else { 0.0 }
}

/// Positions of eight receivers seen from one neighbour, with the distances.
#[derive(Clone, Copy)]
pub(crate) struct Separation<V> {
    /// `x_i − x_j` (m).
    pub(crate) r: [V; 3],
    /// Its square (m²), not below [`SMALLEST_SQUARE`].
    pub(crate) square: V,
    /// `r` (m).
    pub(crate) distance: V,
    /// `1/r` (1/m).
    pub(crate) inverse: V,
}

/// Distances of eight receivers from one neighbour.
#[derive(Clone, Copy)]
pub(crate) struct Distance<V> {
    pub(crate) square: V,
    pub(crate) distance: V,
}

impl<V: Lanes> Distance<V> {
    #[inline(always)]
    pub(crate) fn of(square: V) -> Self {
        let square = square.max(V::splat(SMALLEST_SQUARE));
        let distance = square.sqrt();
        Self { square, distance }
    }
}

/// The same, with what is divided by it.
#[derive(Clone, Copy)]
pub(crate) struct Divided<V> {
    far: Distance<V>,
    pub(crate) inverse: V,
    /// `1/h_ij` (1/m), whatever if that is constant.
    pub(crate) inverse_h: V,
    beside: V,
}

impl<V: Lanes> Divided<V> {
    /// Inverses of a distance, of `h_ij` where that differs, and of what is wanted beside them, by one division.
    #[inline(always)]
    pub(crate) fn of<S: PairScale>(far: Distance<V>, h: V, divisor: Option<V>) -> Self {
        let (one, distance) = (V::splat(1.0), far.distance);
        let (inverse, inverse_h, beside) = match (divisor, S::VARIABLE) {
            (None, false) => (one.div(distance), one, one),
            (None, true) => {
                let both = one.div(distance.mul(h));
                (both.mul(h), both.mul(distance), one)
            }
            (Some(divisor), false) => {
                let both = one.div(distance.mul(divisor));
                (both.mul(divisor), one, both.mul(distance))
            }
            (Some(divisor), true) => {
                let others = divisor.mul(h);
                let all = one.div(distance.mul(others));
                let of_others = all.mul(distance);
                (all.mul(others), of_others.mul(divisor), of_others.mul(h))
            }
        };
        Self {
            far,
            inverse,
            inverse_h,
            beside,
        }
    }
}
