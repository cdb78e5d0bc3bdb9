//! Images behind symmetry planes.

use model::SymmetryPlane;

/// The planes that particles have images behind. An image has a number: the sum of 1, 2 and 4 for
/// planes normal to x, y and z that it is behind; zero is what was computed.
#[derive(Debug, Clone)]
pub struct Images {
    planes: [Option<f64>; 3],
    numbers: Vec<u8>,
}

impl Images {
    /// Images behind some planes, none if these are not wanted.
    pub fn new(symmetry: &[SymmetryPlane], wanted: bool) -> Self {
        let mut planes = [None; 3];
        let mut numbers = vec![0];
        for plane in symmetry.iter().filter(|_| wanted) {
            let axis = plane.axis.index();
            if planes[axis].replace(plane.position).is_none() {
                numbers.extend(numbers.clone().iter().map(|number| number | 1 << axis));
            }
        }
        Self { planes, numbers }
    }

    /// The numbers of all, zero first.
    pub fn numbers(&self) -> &[u8] {
        &self.numbers
    }

    /// `true` if there are any beside the computed particles.
    pub fn any(&self) -> bool {
        self.numbers.len() > 1
    }

    /// A coordinate (m) along an axis as an image has it.
    pub fn coordinate(&self, image: u8, axis: usize, value: f64) -> f64 {
        match self.planes[axis] {
            Some(place) if image >> axis & 1 == 1 => 2.0 * place - value,
            _ => value,
        }
    }
}

/// `true` if a component changes its sign in an image: once for each of its indices (`"x"`, `"xy"`)
/// that is normal to a plane.
pub fn flips(image: u8, component: &str) -> bool {
    let normal = |letter: char| match "xyz".find(letter) {
        Some(axis) => image >> axis & 1 == 1,
        None => false,
    };
    component.chars().filter(|&letter| normal(letter)).count() % 2 == 1
}

#[cfg(test)]
mod tests {
    use super::*;
    use model::Axis;

    #[test]
    fn images_are_numbered_by_their_planes() {
        let plane = |axis, position| SymmetryPlane { axis, position };
        let images = Images::new(&[plane(Axis::X, 0.5), plane(Axis::Z, 0.0)], true);
        assert_eq!(images.numbers(), [0, 1, 4, 5]);
        assert_eq!(images.coordinate(5, 0, 0.75), 0.25);
        assert_eq!(images.coordinate(5, 1, 0.75), 0.75);
        assert_eq!(images.coordinate(4, 0, 0.75), 0.75);
        assert!(!Images::new(&[plane(Axis::X, 0.5)], false).any());
    }

    #[test]
    fn a_component_flips_once_for_each_normal_index() {
        let flipped = |image: u8, names: &[&'static str]| -> Vec<&str> {
            let all = names.iter().copied();
            all.filter(|name| flips(image, name)).collect()
        };
        let symmetric = ["xx", "yy", "zz", "xy", "yz", "xz"];
        assert_eq!(flipped(0b001, &symmetric), ["xy", "xz"]);
        assert_eq!(flipped(0b011, &symmetric), ["yz", "xz"]);
        assert_eq!(flipped(0b011, &["x", "y", "z", ""]), ["x", "y"]);
        assert!(flipped(0, &symmetric).is_empty());
    }
}
