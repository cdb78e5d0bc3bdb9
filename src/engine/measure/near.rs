//! Input of a gauge: images of particles with their weights, and sums over them.

use numerics::lanes::{LANES, Lanes};
use particles::MirrorMask;

/// Images of particles that a gauge reads, in canonical order.
#[derive(Debug, Default)]
pub struct Near {
    count: usize,
    /// Particles, up to whole eights: beyond the last one it stands again.
    particles: Vec<u32>,
    /// `V W`, or one; beyond the last one zero.
    weights: Vec<f64>,
    /// Places in the lists.
    places: Vec<u32>,
    parts: Vec<Part>,
}

/// Images behind the same planes, of the same group.
#[derive(Debug, Clone, Copy)]
struct Part {
    end: usize,
    mirror_mask: MirrorMask,
    group: usize,
}

/// One of them.
#[derive(Debug, Clone, Copy)]
pub struct One {
    pub i: usize,
    pub mirror_mask: MirrorMask,
    pub weight: f64,
    /// Its place in the lists: group and place.
    pub listed: [usize; 2],
}

impl Near {
    /// Number of images.
    #[must_use]
    pub fn len(&self) -> usize {
        self.count
    }

    /// Bytes allocated.
    #[must_use]
    pub fn memory(&self) -> usize {
        4 * (self.particles.capacity() + self.places.capacity())
            + 8 * self.weights.capacity()
            + size_of::<Part>() * self.parts.capacity()
    }

    /// None.
    pub fn clear(&mut self) {
        self.count = 0;
        self.parts.clear();
        self.particles.clear();
        self.weights.clear();
        self.places.clear();
    }

    /// Ends the images of a mirror mask and group.
    pub fn part(&mut self, end: usize, mirror_mask: MirrorMask, group: usize) {
        self.parts.push(Part {
            end,
            mirror_mask,
            group,
        });
    }

    /// A particle alone, of the weight one.
    pub fn set_carrier(&mut self, i: usize) {
        self.clear();
        self.part(1, MirrorMask::OWN, 0);
        let particle = u32::try_from(i).unwrap_or(u32::MAX);
        self.set(&[0], |_| particle);
        self.weigh(&[1.0; LANES]);
        self.end();
    }

    /// Takes what stands at some places of the lists, particles that are still to be weighed.
    #[inline(always)]
    pub fn set(&mut self, places: &[u32], particle: impl Fn(u32) -> u32) {
        self.count = places.len();
        self.places.extend_from_slice(places);
        self.particles
            .extend(places.iter().map(|&place| particle(place)));
        if let Some(&last) = self.particles.last() {
            self.particles
                .resize(self.count.next_multiple_of(LANES), last);
        }
    }

    /// Eights of particles, so many.
    #[inline(always)]
    #[must_use]
    pub fn eights(&self) -> usize {
        self.particles.len() / LANES
    }

    /// The particles of an eight.
    #[inline(always)]
    #[must_use]
    pub fn eight(&self, eight: usize) -> &[u32; LANES] {
        &self.particles.as_chunks().0[eight]
    }

    /// Weighs the next eight.
    #[inline(always)]
    pub fn weigh(&mut self, weights: &[f64; LANES]) {
        self.weights.extend_from_slice(weights);
    }

    /// After the last eight.
    #[inline(always)]
    pub fn end(&mut self) {
        self.weights[self.count..].fill(0.0);
    }

    /// True if any of them stands behind symmetry planes.
    #[inline(always)]
    #[must_use]
    pub fn any_behind(&self) -> bool {
        let mut begin = 0;
        self.parts.iter().any(|part| {
            let is_empty = part.end == begin;
            begin = part.end;
            !part.mirror_mask.is_own() && !is_empty
        })
    }

    /// All of them.
    pub fn iter(&self) -> impl Iterator<Item = One> {
        let mut parts = self.parts.iter();
        let mut part = parts.next();
        (0..self.count).map(move |k| {
            while part.is_some_and(|part| part.end <= k) {
                part = parts.next();
            }
            let (mirror_mask, group) =
                part.map_or((MirrorMask::OWN, 0), |part| (part.mirror_mask, part.group));
            One {
                i: self.particles[k] as usize,
                mirror_mask,
                weight: self.weights[k],
                listed: [group, self.places[k] as usize],
            }
        })
    }

    /// Sum of the weights.
    #[inline(always)]
    #[must_use]
    pub fn coverage<V: Lanes>(&self) -> f64 {
        let mut sum = V::splat(0.0);
        for weights in self.weights.as_chunks().0 {
            sum = sum.add(V::read(weights));
        }
        LaneSum(sum.store().0).total()
    }

    /// Sums of numbers of particles, each times its weight.
    #[inline(always)]
    #[must_use]
    pub fn sums<V: Lanes, const N: usize>(&self, read: impl Fn(usize) -> [f64; N]) -> [f64; N] {
        let mut sums = [V::splat(0.0); N];
        let eights = self.particles.as_chunks::<LANES>().0;
        for (eight, weights) in eights.iter().zip(self.weights.as_chunks().0) {
            let weights = V::read(weights);
            let mut values = [[0.0; LANES]; N];
            for k in 0..LANES {
                let numbers = read(eight[k] as usize);
                for (value, number) in values.iter_mut().zip(numbers) {
                    value[k] = number;
                }
            }
            for (sum, values) in sums.iter_mut().zip(&values) {
                *sum = sum.add(weights.mul(V::read(values)));
            }
        }
        let mut totals = [0.0; N];
        for (total, sum) in totals.iter_mut().zip(sums) {
            *total = LaneSum(sum.store().0).total();
        }
        totals
    }
}

/// A sum whose terms go to eight sums in turn, and these in a fixed order into one.
#[derive(Debug, Clone, Copy, Default)]
pub struct LaneSum([f64; LANES]);

impl LaneSum {
    /// Adds a term of a number in canonical order.
    #[inline(always)]
    pub fn add(&mut self, number: usize, term: f64) {
        self.0[number % LANES] += term;
    }

    /// The sum of all.
    #[inline(always)]
    #[must_use]
    pub fn total(&self) -> f64 {
        let [a, b, c, d, e, f, g, h] = self.0;
        ((a + b) + (c + d)) + ((e + f) + (g + h))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use numerics::lanes::F64x8;

    #[test]
    fn sums_of_eights_are_those_of_terms_one_by_one() {
        for count in [1, 8, 19_u32] {
            let mut near = Near::default();
            let places: Vec<u32> = (0..count).collect();
            let corner = MirrorMask::from_bits(3);
            near.part(2.min(count as usize), MirrorMask::OWN, 1);
            near.part(count as usize, corner, 0);
            near.set(&places, |place| 50 - place);
            for eight in 0..near.eights() {
                near.weigh(&near.eight(eight).map(|i| 1.0 / f64::from(i)));
            }
            near.end();
            let value = |i: usize| 1.0 + 0.1 / f64::from(u8::try_from(i).unwrap());
            let mut lanes = [LaneSum::default(); 2];
            for (k, one) in near.iter().enumerate() {
                assert_eq!((one.i, one.listed[1]), (50 - k, k));
                assert_eq!(
                    one.mirror_mask,
                    if k < 2 { MirrorMask::OWN } else { corner }
                );
                lanes[0].add(k, one.weight);
                lanes[1].add(k, one.weight * value(one.i));
            }
            assert_eq!(
                near.coverage::<F64x8>().to_bits(),
                lanes[0].total().to_bits()
            );
            let [sum] = near.sums::<F64x8, 1>(|i| [value(i)]);
            assert_eq!(sum.to_bits(), lanes[1].total().to_bits());
            assert_eq!(near.any_behind(), count > 2);
        }
    }
}
