//! Parts of space between sides normal to the axes.

/// A box whose sides may be open.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Region {
    /// Smallest coordinates (m); −∞ where it is open.
    pub above: [f64; 3],
    /// Largest coordinates (m); ∞ where it is open.
    pub below: [f64; 3],
}

impl Region {
    /// All of space.
    pub const OPEN: Self = Self {
        above: [f64::NEG_INFINITY; 3],
        below: [f64::INFINITY; 3],
    };

    /// `true` if a place (m) is in the region, its sides included.
    #[must_use]
    pub fn contains(&self, place: &[f64; 3]) -> bool {
        (0..3).all(|a| self.above[a] <= place[a] && place[a] <= self.below[a])
    }

    /// `true` if a place (m) is beyond a side; NaN is not.
    #[must_use]
    pub fn is_left_by(&self, place: &[f64; 3]) -> bool {
        (0..3).any(|a| place[a] < self.above[a] || place[a] > self.below[a])
    }

    /// `true` if it has any place of the box between two corners (m).
    #[must_use]
    pub fn meets(&self, lower: &[f64; 3], upper: &[f64; 3]) -> bool {
        (0..3).all(|a| self.above[a] <= upper[a] && lower[a] <= self.below[a])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sides_belong_to_it_and_what_is_no_number_has_not_left() {
        let mut region = Region::OPEN;
        (region.above[2], region.below[0]) = (-1.0, 2.0);
        assert!(region.contains(&[2.0, 1e300, -1.0]) && !region.is_left_by(&[2.0, 1e300, -1.0]));
        for place in [[2.0 + 1e-15, 0.0, 0.0], [0.0, 0.0, -1.0 - 1e-15]] {
            assert!(!region.contains(&place) && region.is_left_by(&place));
        }
        let nowhere = [f64::NAN, 0.0, 0.0];
        assert!(!region.contains(&nowhere) && !region.is_left_by(&nowhere));
        assert!(region.meets(&[1.0, 5.0, -3.0], &[3.0, 6.0, -1.0]));
        assert!(!region.meets(&[2.5, 5.0, -3.0], &[3.0, 6.0, 1.0]));
    }
}
