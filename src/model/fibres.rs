//! Directions of matter that has some of its own.

use serde::Deserialize;

use super::Vec3;

/// How directions depend on the place.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum FibrePattern {
    /// The same everywhere.
    #[default]
    Straight,
    /// Direction 1 away from an axis, 3 along it.
    Radial,
    /// Direction 1 around an axis, 3 away from it.
    Wrapped,
}

/// Layers on each other whose fibres are turned about direction 3.
#[derive(Debug, Clone, PartialEq)]
pub struct Layup {
    /// Thickness of a layer (m).
    pub ply: f64,
    /// Turns of layers (rad), from `centre` on along direction 3; the first follows the last.
    pub angles: Vec<f64>,
}

impl Layup {
    /// Turn (rad) of the layer at a height (m).
    fn at(&self, height: f64) -> f64 {
        #[allow(clippy::cast_precision_loss, reason = "few layers")]
        let count = self.angles.len() as f64;
        let layer = (height / self.ply).floor();
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a place in the list"
        )]
        let place = (layer - count * (layer / count).floor()) as usize;
        let place = place.min(self.angles.len() - 1);
        self.angles[place]
    }
}

/// The directions of the matter of a body at the start.
#[derive(Debug, Clone, PartialEq)]
pub struct Fibres {
    /// How they depend on the place.
    pub pattern: FibrePattern,
    /// Unit vectors: of what is straight direction 1 before it is turned; of the others any direction across the axis, which
    /// counts on the axis itself.
    pub along: Vec3,
    /// Of what is straight direction 3, of the others the axis; it is across `along`.
    pub normal: Vec3,
    /// A point of the axis (m).
    pub centre: Vec3,
    /// Turn of directions 1 and 2 about 3 (rad).
    pub angle: f64,
    /// Layers that are turned beside that.
    pub layup: Option<Layup>,
}

impl Fibres {
    /// Directions 1 and 3 at a place (m), unit vectors across each other.
    #[must_use]
    pub fn at(&self, place: &Vec3) -> [Vec3; 2] {
        let from = place - self.centre;
        let across = from - self.normal * from.dot(&self.normal);
        let outward = across.try_normalize(0.0).unwrap_or(self.along);
        let around = self.normal.cross(&outward);
        let (along, normal) = match self.pattern {
            FibrePattern::Straight => (self.along, self.normal),
            FibrePattern::Radial => (outward, self.normal),
            FibrePattern::Wrapped => (around, outward),
        };
        let layer = self.layup.as_ref();
        let angle = self.angle + layer.map_or(0.0, |layup| layup.at(from.dot(&normal)));
        let second = normal.cross(&along);
        let turned = along * libm::cos(angle) + second * libm::sin(angle);
        [turned, normal]
    }

    /// Turns of directions 1 and 2 about 3 (rad) that are somewhere.
    pub fn angles(&self) -> impl Iterator<Item = f64> {
        let layers = self
            .layup
            .as_ref()
            .map_or(&[0.0][..], |layup| &layup.angles);
        layers.iter().map(|layer| self.angle + layer)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directions_follow_the_pattern() {
        let of = |pattern, angle: f64| Fibres {
            pattern,
            along: Vec3::x(),
            normal: Vec3::z(),
            centre: Vec3::new(1.0, 0.0, 0.0),
            angle,
            layup: None,
        };
        let place = Vec3::new(1.0, 2.0, 5.0);
        let close = |found: [Vec3; 2], wanted: [Vec3; 2]| {
            for (a, b) in found.into_iter().zip(wanted) {
                assert!((a - b).norm() < 1e-15, "{a} {b}");
            }
        };
        let right = std::f64::consts::FRAC_PI_2;
        let (x, y, z) = (Vec3::x(), Vec3::y(), Vec3::z());
        close(of(FibrePattern::Straight, 0.0).at(&place), [x, z]);
        close(of(FibrePattern::Straight, right).at(&place), [y, z]);
        close(of(FibrePattern::Radial, 0.0).at(&place), [y, z]);
        close(of(FibrePattern::Wrapped, 0.0).at(&place), [-x, y]);
        close(of(FibrePattern::Wrapped, right).at(&place), [z, y]);
        let on_axis = Vec3::new(1.0, 0.0, 3.0);
        close(of(FibrePattern::Radial, 0.0).at(&on_axis), [x, z]);
    }

    #[test]
    fn layers_follow_each_other() {
        let layup = Layup {
            ply: 0.5,
            angles: vec![0.0, 1.0, 2.0],
        };
        let found = [-0.1, 0.1, 0.6, 1.4, 1.6, 3.2].map(|height| layup.at(height));
        assert_eq!(found, [2.0, 0.0, 1.0, 2.0, 0.0, 0.0]);
    }
}
