//! Images of particles at planes of symmetry.

use super::field::Drawn;
use super::shape::Shape;
use model::SymmetryPlane;

/// A place where a particle or an image of it is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Image {
    /// Position (m).
    pub point: [f64; 3],
    /// Shape.
    pub shape: Shape,
    /// `true` if the drawn number has the other sign there.
    pub flipped: bool,
}

impl Image {
    /// A drawn number as it is there.
    pub fn signed(&self, value: f64) -> f64 {
        if self.flipped { -value } else { value }
    }
}

/// Planes at which a model is reflected for a picture.
#[derive(Debug, Clone, PartialEq)]
pub struct Mirrors {
    /// Each with `true` if the drawn number changes its sign there.
    planes: Vec<(SymmetryPlane, bool)>,
}

impl Mirrors {
    /// Some planes, for a picture of a number.
    pub fn new(planes: Vec<SymmetryPlane>, drawn: &Drawn) -> Self {
        let flips = |plane: &SymmetryPlane| match drawn {
            Drawn::Body => false,
            Drawn::Field(field) => field.flips(plane.axis),
        };
        let planes = planes.into_iter().map(|plane| (plane, flips(&plane)));
        Self {
            planes: planes.collect(),
        }
    }

    /// The planes.
    pub fn planes(&self) -> impl Iterator<Item = &SymmetryPlane> {
        self.planes.iter().map(|(plane, _)| plane)
    }

    /// Fills `images` with a particle of a shape and its reflections.
    pub fn reflect(&self, point: &[f64; 3], shape: &Shape, images: &mut Vec<Image>) {
        images.clear();
        images.push(Image {
            point: *point,
            shape: *shape,
            flipped: false,
        });
        for (plane, flips) in &self.planes {
            let k = plane.axis.index();
            for n in 0..images.len() {
                let mut image = images[n];
                image.point[k] = 2.0 * plane.position - image.point[k];
                image.shape = image.shape.mirrored(k);
                image.flipped ^= flips;
                images.push(image);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use model::Axis;

    #[test]
    fn a_quarter_model_has_four_images() {
        let plane = |axis| SymmetryPlane {
            axis,
            position: 1.0,
        };
        let mirrors = Mirrors::new(vec![plane(Axis::X), plane(Axis::Y)], &Drawn::Body);
        let mut images = Vec::new();
        let ball = Shape::ball(1.0);
        mirrors.reflect(&[1.5, 1.25, 3.0], &ball, &mut images);
        let points: Vec<_> = images.iter().map(|image| image.point).collect();
        let expected = [
            [1.5, 1.25, 3.0],
            [0.5, 1.25, 3.0],
            [1.5, 0.75, 3.0],
            [0.5, 0.75, 3.0],
        ];
        assert_eq!(points, expected);
        Mirrors::new(Vec::new(), &Drawn::Body).reflect(&[1.5, 1.25, 3.0], &ball, &mut images);
        assert_eq!(images.len(), 1);
    }
}
