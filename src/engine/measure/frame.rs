//! A plane and its normal: coordinates across it and along it.

use std::f64::consts::PI;

use numerics::vector::{cross, dot};
use particles::{MirrorMask, Mirrors};

/// Two unit vectors in a plane, and its normal.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Frame {
    axes: [[f64; 3]; 3],
}

impl Frame {
    /// About a unit normal; along an axis its vectors are axes, too.
    #[must_use]
    pub fn new(normal: &[f64; 3]) -> Self {
        let least = (1..3).fold(0, |least, a| {
            if normal[a].abs() < normal[least].abs() {
                a
            } else {
                least
            }
        });
        let across: [f64; 3] =
            std::array::from_fn(|a| f64::from(u8::from(a == least)) - normal[least] * normal[a]);
        let length = dot(&across, &across).sqrt();
        let first = across.map(|c| c / length);
        Self {
            axes: [first, cross(normal, &first), *normal],
        }
    }

    /// Coordinates (m) of a place or components of a vector: two across the normal, one along it.
    #[must_use]
    pub fn turned(&self, x: &[f64; 3]) -> [f64; 3] {
        self.axes.map(|axis| dot(&axis, x))
    }

    /// Places (m) of symmetry planes on the vectors across the normal that are normal to them, and
    /// these planes by the axes that they are normal to.
    #[must_use]
    pub fn planes(&self, mirrors: &Mirrors) -> ([Option<f64>; 2], MirrorMask) {
        let (mut planes, mut along) = ([None; 2], MirrorMask::OWN);
        for (plane, axis) in planes.iter_mut().zip(&self.axes) {
            for a in 0..3 {
                let is_normal = (0..3).all(|b| b == a || axis[b] == 0.0);
                if let Some(place) = mirrors.plane(a).filter(|_| is_normal) {
                    *plane = Some(axis[a] * place);
                    along = along.with(a);
                }
            }
        }
        (planes, along)
    }

    /// The place (m) of coordinates (m).
    #[must_use]
    pub fn back(&self, place: &[f64; 3]) -> [f64; 3] {
        std::array::from_fn(|a| (0..3).map(|k| place[k] * self.axes[k][a]).sum())
    }
}

/// The sector, of `count` equal ones, that a direction in a plane points into.
#[must_use]
pub fn sector(x: f64, y: f64, count: usize) -> usize {
    #[expect(clippy::cast_precision_loss, reason = "small")]
    let turn = (libm::atan2(y, x) / (2.0 * PI) + 0.5) * count as f64;
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "at least zero"
    )]
    let sector = turn as usize;
    sector % count
}

#[cfg(test)]
mod tests {
    use super::*;
    use model::{Axis, SymmetryPlane};

    #[test]
    fn planes_across_a_normal_are_told() {
        let plane = |axis, position| SymmetryPlane { axis, position };
        let mirrors = Mirrors::new(&[plane(Axis::X, 2.0), plane(Axis::Z, 3.0)]);
        let planes = |normal| Frame::new(&normal).planes(&mirrors);
        let [u, w, _] = Frame::new(&[0.0, -1.0, 0.0]).axes;
        assert_eq!(
            planes([0.0, -1.0, 0.0]),
            (
                [Some(2.0 * u[0]), Some(3.0 * w[2])],
                MirrorMask::from_bits(0b101)
            )
        );
        assert_eq!(planes([1.0, 0.0, 0.0]).1.bits(), 0b100);
        assert_eq!(planes([0.8, 0.6, 0.0]).1.bits(), 0b100);
        assert_eq!(planes([0.8, 0.0, 0.6]), ([None; 2], MirrorMask::OWN));
    }

    #[test]
    fn frames_are_right_handed_and_keep_axes() {
        for normal in [[0.0, 0.0, 1.0], [0.0, -1.0, 0.0], [0.6, 0.0, 0.8]] {
            let [u, w, n] = Frame::new(&normal).axes;
            assert_eq!(n, normal);
            let turned = cross(&u, &w);
            for a in 0..3 {
                assert!((turned[a] - n[a]).abs() < 1e-15, "{u:?} {w:?} {n:?}");
            }
        }
        let x = Frame::new(&[0.0, 0.0, 1.0]).turned(&[1.0, 2.0, 3.0]);
        assert_eq!(x, [1.0, 2.0, 3.0]);
        let frame = Frame::new(&[0.6, 0.0, 0.8]);
        let again = frame.back(&frame.turned(&[1.0, 2.0, 3.0]));
        for (a, b) in again.into_iter().zip([1.0, 2.0, 3.0]) {
            assert!((a - b).abs() < 1e-14);
        }
    }
}
