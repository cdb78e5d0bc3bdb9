//! Extents of positions and velocities of some particles, in twelve numbers, and the longest step
//! that two such sets allow.

use numerics::ordered::{disordered, ordered};
use numerics::vector::norm;
use particles::{MirrorMask, Mirrors};

/// Smallest and largest coordinates (m) and velocities (m/s) of some particles.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Span {
    lower: [f64; 3],
    upper: [f64; 3],
    slowest: [f64; 3],
    fastest: [f64; 3],
}

impl Span {
    /// Of no particle.
    pub const NONE: Self = Self {
        lower: [f64::INFINITY; 3],
        upper: [f64::NEG_INFINITY; 3],
        slowest: [f64::INFINITY; 3],
        fastest: [f64::NEG_INFINITY; 3],
    };
    /// Of [`Self::write`].
    pub const WORDS: usize = 12;

    pub fn point(x: &[f64; 3], v: &[f64; 3]) -> Self {
        Self {
            lower: *x,
            upper: *x,
            slowest: *v,
            fastest: *v,
        }
    }

    pub fn is_empty(&self) -> bool {
        self.lower[0] > self.upper[0]
    }

    /// Smallest and largest coordinates (m).
    pub fn bounds(&self) -> [&[f64; 3]; 2] {
        [&self.lower, &self.upper]
    }

    /// Takes a particle in.
    #[inline(always)]
    pub fn add(&mut self, x: &[f64; 3], v: &[f64; 3]) {
        // Plain comparisons are one instruction each; `min` and `max` look for what is NaN.
        let least = |least: f64, x: f64| if x < least { x } else { least };
        let most = |most: f64, x: f64| if x > most { x } else { most };
        for a in 0..3 {
            self.lower[a] = least(self.lower[a], x[a]);
            self.upper[a] = most(self.upper[a], x[a]);
            self.slowest[a] = least(self.slowest[a], v[a]);
            self.fastest[a] = most(self.fastest[a], v[a]);
        }
    }

    pub fn join(&mut self, other: &Self) {
        for a in 0..3 {
            self.lower[a] = self.lower[a].min(other.lower[a]);
            self.upper[a] = self.upper[a].max(other.upper[a]);
            self.slowest[a] = self.slowest[a].min(other.slowest[a]);
            self.fastest[a] = self.fastest[a].max(other.fastest[a]);
        }
    }

    /// Takes in that velocities along an axis may be anything in a range (m/s).
    pub fn widen(&mut self, axis: usize, [least, most]: [f64; 2]) {
        self.slowest[axis] = self.slowest[axis].min(least);
        self.fastest[axis] = self.fastest[axis].max(most);
    }

    /// Its image behind planes.
    pub fn reflected(&self, mirrors: &Mirrors, mirror_mask: MirrorMask) -> Self {
        if self.is_empty() {
            return *self;
        }
        let at = |x: &[f64; 3]| mirrors.reflect_position(x, mirror_mask);
        let flying = |v: &[f64; 3]| Mirrors::reflect_vector(v, mirror_mask);
        let mut image = Self::NONE;
        image.add(&at(&self.lower), &flying(&self.slowest));
        image.add(&at(&self.upper), &flying(&self.fastest));
        image
    }

    /// Smallest and largest velocity along each axis (m/s).
    pub fn velocities(&self) -> [[f64; 2]; 3] {
        std::array::from_fn(|a| [self.slowest[a], self.fastest[a]])
    }

    /// Largest speed (m/s) along each axis against what moves with velocities in these ranges
    /// (m/s).
    pub fn against(&self, others: &[[f64; 2]; 3]) -> [f64; 3] {
        std::array::from_fn(|a| {
            let [least, most] = others[a];
            (self.fastest[a] - least).max(most - self.slowest[a])
        })
    }

    /// Largest speed (m/s) against a unit normal, beside ground that moves with velocities in these
    /// ranges (m/s); zero if all recede.
    pub fn onto_plane(&self, normal: &[f64; 3], ground: &[[f64; 2]; 3]) -> f64 {
        let along = |a: usize| {
            let [least, most] = ground[a];
            let n = normal[a];
            (n * (most - self.slowest[a])).max(n * (least - self.fastest[a]))
        };
        (0..3).map(along).sum::<f64>().max(0.0)
    }

    /// Largest distance (m) from an axis through a point (m) along a unit vector, or somewhat more.
    pub fn farthest_from(&self, point: &[f64; 3], axis: &[f64; 3]) -> f64 {
        let arm: [f64; 3] =
            std::array::from_fn(|a| (self.upper[a] - point[a]).max(point[a] - self.lower[a]));
        let across = |a: usize, b: usize| axis[a].abs() * arm[b] + axis[b].abs() * arm[a];
        norm(&[across(1, 2), across(2, 0), across(0, 1)])
    }

    /// A step (s) in which no particle of this and none of `other` that are farther from each other
    /// than 2h come nearer than h (m): they fly no farther than h towards each other, or they begin
    /// so far apart along an axis that h is left between them.
    pub fn longest_step(&self, other: &Self, h: f64) -> f64 {
        let mut apart: f64 = 0.0;
        let mut square = 0.0;
        for a in 0..3 {
            let [beyond, before] = [
                other.lower[a] - self.upper[a],
                self.lower[a] - other.upper[a],
            ];
            let [onward, back] = [
                self.fastest[a] - other.slowest[a],
                other.fastest[a] - self.slowest[a],
            ];
            let (gap, closing) = if beyond >= before {
                (beyond, onward)
            } else {
                (before, back)
            };
            // What is apart meets only if it closes in.
            let speed = if gap > 0.0 {
                closing.max(0.0)
            } else {
                onward.max(back)
            };
            square += speed * speed;
            if gap > h {
                apart = apart.max((gap - h) / closing.max(0.0));
            }
        }
        apart.max(h / square.sqrt())
    }

    /// Words whose smallest over some sets are those of all of them together.
    pub fn write(&self, words: &mut Vec<u64>) {
        let least = self.lower.iter().chain(&self.slowest);
        words.extend(least.map(|&x| ordered(x)));
        let most = self.upper.iter().chain(&self.fastest);
        words.extend(most.map(|&x| !ordered(x)));
    }

    /// Takes the words of [`Self::write`].
    pub fn read(words: &[u64]) -> Self {
        let three = |first: usize| std::array::from_fn(|a| disordered(words[first + a]));
        let most = |first: usize| std::array::from_fn(|a| disordered(!words[first + a]));
        Self {
            lower: three(0),
            slowest: three(3),
            upper: most(6),
            fastest: most(9),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ball(x: f64, v: f64) -> Span {
        let mut span = Span::point(&[x - 1.0, -1.0, -1.0], &[v, 0.0, 0.0]);
        span.add(&[x + 1.0, 1.0, 1.0], &[v, 0.0, 0.0]);
        span
    }

    /// Sets that fly apart or miss have all the time they want; those that meet have the time to
    /// come as near as h, or to fly h.
    #[test]
    fn steps_follow_gap_and_closing_speed() {
        let (h, at_rest) = (0.1, ball(0.0, 0.0));
        let step = |other: Span| at_rest.longest_step(&other, h);
        assert!((step(ball(5.0, -4.0)) - (3.0 - h) / 4.0).abs() < 1e-15);
        assert!((step(ball(2.05, -4.0)) - h / 4.0).abs() < 1e-15);
        assert!((step(ball(1.0, -4.0)) - h / 4.0).abs() < 1e-15);
        assert!(step(ball(5.0, 4.0)).is_infinite());
        assert!(step(ball(0.5, 0.0)).is_infinite());
        assert!(step(Span::NONE).is_infinite());
        let mut aside = ball(0.0, -4.0);
        aside.lower[1] += 3.0;
        aside.upper[1] += 3.0;
        assert!(step(aside).is_infinite());
        assert!((ball(5.0, -4.0).longest_step(&at_rest, h) - (3.0 - h) / 4.0).abs() < 1e-15);
    }

    #[test]
    fn words_join_spans() {
        let (a, b) = (ball(-3.0, -2.0), ball(1.0, 5.0));
        let [mut one, mut other] = [Vec::new(), Vec::new()];
        a.write(&mut one);
        b.write(&mut other);
        assert_eq!(one.len(), Span::WORDS);
        assert_eq!(Span::read(&one), a);
        let least: Vec<u64> = one.iter().zip(&other).map(|(a, b)| *a.min(b)).collect();
        let mut both = a;
        both.join(&b);
        assert_eq!(Span::read(&least), both);
        let mut none = Vec::new();
        Span::NONE.write(&mut none);
        assert!(Span::read(&none).is_empty());
        both.join(&Span::NONE);
        assert_eq!(Span::read(&least), both);
        let mirrors = Mirrors::default();
        assert!(
            Span::NONE
                .reflected(&mirrors, MirrorMask::OWN.with(0))
                .is_empty()
        );
    }
}
