//! Symmetry planes: mirror images of particles behind them, and particles that cross them.

use crate::{FieldInfo, Mirror, MirrorMask, ParticleStore};
use model::{Case, SymmetryPlane};

/// The symmetry planes of a case, at most one for each axis.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Mirrors {
    planes: [Option<f64>; 3],
    /// True if the plane normal to x is an axis: what crosses it turns by half, and it has no images.
    axis: bool,
}

/// Force of images behind symmetry planes on one particle.
#[derive(Debug, Clone, Copy)]
pub struct MirrorForce {
    /// Index of the particle.
    pub particle: usize,
    /// Force (N).
    pub force: [f64; 3],
    /// Torque beyond that of the force at the particle (N m): that which pairs on this side of the plane
    /// exert on each other without those across it.
    pub couple: [f64; 3],
}

impl Mirrors {
    /// Planes of a case.
    #[must_use]
    pub fn new(planes: &[SymmetryPlane]) -> Self {
        let mut mirrors = Self::default();
        for plane in planes {
            mirrors.planes[plane.axis.index()] = Some(plane.position);
        }
        mirrors
    }

    /// The planes of a case; of rings about an axis the first of them is that axis.
    #[must_use]
    pub fn of(case: &Case) -> Self {
        Self {
            axis: case.axisymmetric,
            ..Self::new(&case.symmetry)
        }
    }

    /// Coordinate (m) of the plane normal to an axis, if there is one.
    #[must_use]
    pub fn plane(&self, axis: usize) -> Option<f64> {
        self.planes[axis]
    }

    /// True if there are no planes.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.planes.iter().all(Option::is_none)
    }

    /// The mirror masks of a particle and all its images, itself first.
    pub fn masks(&self) -> impl Iterator<Item = MirrorMask> {
        let axes = (0..3).filter(|&axis| self.planes[axis].is_some());
        axes.fold(MirrorMask::OWN, MirrorMask::with).subsets(true)
    }

    /// How often the sums of what is computed are in the whole: 1, 2, 4 or 8. What is about an axis is whole.
    #[must_use]
    pub fn copies(&self) -> u32 {
        let planes = self.planes.iter().skip(usize::from(self.axis));
        1 << planes.flatten().count()
    }

    /// The planes that a particle at `position` (m) stands within `reach` (m) of. Its images are
    /// those behind all subsets of these planes.
    #[inline]
    #[must_use]
    pub fn near(&self, position: &[f64; 3], reach: f64) -> MirrorMask {
        let mut planes = MirrorMask::OWN;
        for axis in usize::from(self.axis)..3 {
            if let Some(plane) = self.planes[axis]
                && position[axis] - plane <= reach
            {
                planes = planes.with(axis);
            }
        }
        planes
    }

    /// The image of a position under a mirror mask.
    #[inline]
    #[must_use]
    pub fn reflect_position(&self, position: &[f64; 3], mirror_mask: MirrorMask) -> [f64; 3] {
        if mirror_mask.is_own() {
            return *position;
        }
        std::array::from_fn(|axis| match self.planes[axis] {
            Some(plane) if mirror_mask.has(axis) => 2.0 * plane - position[axis],
            _ => position[axis],
        })
    }

    /// The image of a vector under a mirror mask.
    #[inline]
    #[must_use]
    pub fn reflect_vector(vector: &[f64; 3], mirror_mask: MirrorMask) -> [f64; 3] {
        if mirror_mask.is_own() {
            return *vector;
        }
        std::array::from_fn(|axis| {
            if mirror_mask.has(axis) {
                -vector[axis]
            } else {
                vector[axis]
            }
        })
    }

    /// The image of a symmetric tensor (xx yy zz xy xz yz) under a mirror mask.
    #[inline]
    #[must_use]
    pub fn reflect_symmetric(tensor: &[f64; 6], mirror_mask: MirrorMask) -> [f64; 6] {
        if mirror_mask.is_own() {
            return *tensor;
        }
        let flip = |a, b| if mirror_mask.flips(a, b) { -1.0 } else { 1.0 };
        let mut image = *tensor;
        image[3] *= flip(0, 1);
        image[4] *= flip(0, 2);
        image[5] *= flip(1, 2);
        image
    }

    /// The image of a tensor (row-major) under a mirror mask.
    #[inline]
    #[must_use]
    pub fn reflect_tensor(tensor: &[f64; 9], mirror_mask: MirrorMask) -> [f64; 9] {
        let mut image = *tensor;
        for a in 0..3 {
            for b in 0..3 {
                if mirror_mask.flips(a, b) {
                    image[3 * a + b] *= -1.0;
                }
            }
        }
        image
    }

    /// The planes that a position is beyond.
    #[inline]
    #[must_use]
    pub fn beyond(&self, position: &[f64; 3]) -> MirrorMask {
        let mut planes = MirrorMask::OWN;
        for axis in 0..3 {
            if let Some(plane) = self.planes[axis]
                && position[axis] < plane
            {
                planes = planes.with(axis);
            }
        }
        planes
    }

    /// Exchanges an owned particle that has crossed a plane with its image, which has crossed
    /// the other way: both are the same material. All that a particle takes along when it changes
    /// ranks, as it may next, is mirrored as the table of fields says. Returns the mirror mask, that of
    /// the particle itself if it stays.
    pub fn fold(&self, particles: &mut ParticleStore, i: usize) -> MirrorMask {
        let mirror_mask = self.beyond(&particles.position[i]);
        if !mirror_mask.is_own() {
            for field in particles.held(FieldInfo::leaves) {
                let size = field.kind.bytes();
                let value = &mut particles.bytes_mut(field.id)[i * size..(i + 1) * size];
                self.reflect(field.mirror, value, mirror_mask);
            }
        }
        mirror_mask
    }

    /// Puts the image under a mirror mask in the place of what one particle holds in a field.
    fn reflect(&self, rule: Mirror, value: &mut [u8], mirror_mask: MirrorMask) {
        match rule {
            Mirror::Same => {}
            Mirror::Place => replace(value, |x| self.reflect_position(x, mirror_mask)),
            Mirror::Vector => replace(value, |v| Self::reflect_vector(v, mirror_mask)),
            Mirror::Symmetric => replace(value, |t| Self::reflect_symmetric(t, mirror_mask)),
            Mirror::Tensor => replace(value, |t| Self::reflect_tensor(t, mirror_mask)),
        }
    }
}

/// Replaces the value that the bytes are.
fn replace<T: bytemuck::Pod>(value: &mut [u8], image: impl FnOnce(&T) -> T) {
    let value: &mut T = bytemuck::from_bytes_mut(value);
    *value = image(value);
}

#[cfg(test)]
mod tests {
    use super::*;
    use model::Axis;

    #[test]
    fn images_of_two_planes_and_their_edge() {
        let planes = [Axis::X, Axis::Y].map(|axis| SymmetryPlane {
            axis,
            position: 0.0,
        });
        let mirrors = Mirrors::new(&planes);
        let near = mirrors.near(&[0.1, 0.2, 0.0], 0.5);
        assert_eq!(near.bits(), 0b11);
        let subsets = |own| near.subsets(own).map(MirrorMask::bits).collect::<Vec<_>>();
        assert_eq!(subsets(true), [0, 1, 2, 3]);
        assert_eq!(subsets(false), [1, 2, 3]);
        assert_eq!(
            mirrors.reflect_position(&[0.1, 0.2, 0.3], near),
            [-0.1, -0.2, 0.3]
        );
        let stress = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0];
        assert_eq!(
            Mirrors::reflect_symmetric(&stress, MirrorMask::OWN.with(0)),
            [1.0, 2.0, 3.0, -4.0, -5.0, 6.0]
        );
        assert_eq!(
            Mirrors::reflect_symmetric(&stress, near),
            [1.0, 2.0, 3.0, 4.0, -5.0, -6.0]
        );
    }
}
