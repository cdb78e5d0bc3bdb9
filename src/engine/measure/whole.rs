//! From what is computed to the whole: what symmetry planes leave out is its mirror image.

use numerics::vector::cross;
use particles::Mirrors;

/// A part of a model and its images behind the symmetry planes.
#[derive(Debug, Clone, Copy)]
pub struct Whole<'a> {
    mirrors: &'a Mirrors,
}

impl<'a> Whole<'a> {
    /// Behind these planes.
    #[must_use]
    pub fn new(mirrors: &'a Mirrors) -> Self {
        Self { mirrors }
    }

    /// The part and all its images: 1, 2, 4 or 8.
    #[must_use]
    pub fn copies(&self) -> u32 {
        self.mirrors.copies()
    }

    /// A sum such as a mass or an energy.
    #[must_use]
    pub fn sum(&self, part: f64) -> f64 {
        f64::from(self.copies()) * part
    }

    /// A number of particles.
    #[must_use]
    pub fn count(&self, part: u64) -> u64 {
        u64::from(self.copies()) * part
    }

    /// A momentum, an impulse or a force: none normal to a plane.
    #[must_use]
    pub fn momentum(&self, part: [f64; 3]) -> [f64; 3] {
        std::array::from_fn(|a| match self.mirrors.plane(a) {
            Some(_) => 0.0,
            None => self.sum(part[a]),
        })
    }

    /// A mean position (m) or velocity (m/s): in a plane, or along it.
    #[must_use]
    pub fn mean_position(&self, part: [f64; 3]) -> [f64; 3] {
        std::array::from_fn(|a| self.mirrors.plane(a).unwrap_or(part[a]))
    }

    /// An angular momentum about the origin (kg m²/s), of a part with a momentum (kg m/s).
    ///
    /// An image behind planes stands at `s∘x + o` and moves at `s∘v`, where `s` changes the signs of
    /// the axes normal to them and `o` is twice where they stand, so its angular momentum is `s_b s_c
    /// L_a + (o × s∘p)_a`.
    #[must_use]
    pub fn angular_momentum(&self, part: [f64; 3], momentum: [f64; 3]) -> [f64; 3] {
        let mut all = part;
        for mirror_mask in self.mirrors.masks().skip(1) {
            let sign = |a: usize| if mirror_mask.has(a) { -1.0 } else { 1.0 };
            let shift = std::array::from_fn(|a| match self.mirrors.plane(a) {
                Some(plane) if sign(a) < 0.0 => 2.0 * plane,
                _ => 0.0,
            });
            let turned = cross(&shift, &std::array::from_fn(|a| sign(a) * momentum[a]));
            for a in 0..3 {
                let (b, c) = ((a + 1) % 3, (a + 2) % 3);
                all[a] += sign(b) * sign(c) * part[a] + turned[a];
            }
        }
        all
    }

    /// Smallest and largest coordinates (m).
    #[must_use]
    pub fn extents(&self, [lower, upper]: [[f64; 3]; 2]) -> [[f64; 3]; 2] {
        let low = |a: usize| match self.mirrors.plane(a) {
            Some(plane) => lower[a].min(2.0 * plane - upper[a]),
            None => lower[a],
        };
        let high = |a: usize| match self.mirrors.plane(a) {
            Some(plane) => upper[a].max(2.0 * plane - lower[a]),
            None => upper[a],
        };
        [std::array::from_fn(low), std::array::from_fn(high)]
    }

    /// Smallest and largest components of velocities (m/s).
    #[must_use]
    pub fn velocities(&self, [least, most]: [[f64; 3]; 2]) -> [[f64; 3]; 2] {
        let fastest = |a: usize| match self.mirrors.plane(a) {
            Some(_) => most[a].max(-least[a]),
            None => most[a],
        };
        let slowest = |a: usize| match self.mirrors.plane(a) {
            Some(_) => least[a].min(-most[a]),
            None => least[a],
        };
        [std::array::from_fn(slowest), std::array::from_fn(fastest)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use model::{Axis, SymmetryPlane};

    fn mirrors(planes: &[(Axis, f64)]) -> Mirrors {
        let plane = |&(axis, position): &(Axis, f64)| SymmetryPlane { axis, position };
        Mirrors::new(&planes.iter().map(plane).collect::<Vec<_>>())
    }

    /// The sums of a part with its images are those of all images one by one.
    #[test]
    fn whole_sums_are_those_of_all_images() {
        let parts = [
            (2.0, [3.0, 5.0, 1.0], [-1.0, 4.0, 0.5]),
            (0.5, [2.5, 7.0, -3.0], [6.0, 0.25, -2.0]),
        ];
        for planes in [
            &[][..],
            &[(Axis::X, 2.0)],
            &[(Axis::X, 2.0), (Axis::Y, -1.0)],
            &[(Axis::X, 2.0), (Axis::Y, 0.0), (Axis::Z, -4.0)],
        ] {
            let mirrors = mirrors(planes);
            let whole = Whole::new(&mirrors);
            let (mut mass, mut copies) = (0.0, 0);
            let (mut momentum, mut turn, mut centre) = ([0.0; 3], [0.0; 3], [0.0; 3]);
            let (mut part_momentum, mut part_turn) = ([0.0; 3], [0.0; 3]);
            let (mut extents, mut part_extents) = ([[9e9; 3], [-9e9; 3]], [[9e9; 3], [-9e9; 3]]);
            for mirror_mask in mirrors.masks() {
                copies += 1;
                for (m, x, v) in parts {
                    let (y, w) = (
                        mirrors.reflect_position(&x, mirror_mask),
                        Mirrors::reflect_vector(&v, mirror_mask),
                    );
                    let spin = cross(&y, &w);
                    mass += m;
                    for a in 0..3 {
                        momentum[a] += m * w[a];
                        turn[a] += m * spin[a];
                        centre[a] += m * y[a];
                        extents[0][a] = f64::min(extents[0][a], y[a]);
                        extents[1][a] = f64::max(extents[1][a], y[a]);
                    }
                    if mirror_mask.is_own() {
                        for a in 0..3 {
                            part_momentum[a] += m * w[a];
                            part_turn[a] += m * spin[a];
                        }
                        part_extents = extents;
                    }
                }
            }
            assert_eq!(whole.copies(), copies);
            assert_eq!(whole.sum(2.5).to_bits(), f64::to_bits(mass));
            let close = |a: [f64; 3], b: [f64; 3]| {
                let far = (0..3).map(|k| (a[k] - b[k]).abs()).fold(0.0, f64::max);
                assert!(far < 1e-12, "{a:?} {b:?}");
            };
            close(whole.momentum(part_momentum), momentum);
            close(whole.angular_momentum(part_turn, part_momentum), turn);
            let own: [f64; 3] =
                std::array::from_fn(|a| parts.iter().map(|(m, x, _)| m * x[a]).sum::<f64>() / 2.5);
            close(whole.mean_position(own), centre.map(|c| c / mass));
            assert_eq!(whole.extents(part_extents), extents);
        }
    }
}
