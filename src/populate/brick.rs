//! Boxes of space, any side of which may be open.

/// The part of space `lower ≤ x < upper` along each axis (m), infinite where it is open.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Brick {
    /// Smallest coordinates, included (m).
    pub lower: [f64; 3],
    /// Largest coordinates, excluded (m).
    pub upper: [f64; 3],
}

impl Brick {
    /// All of space.
    pub const OPEN: Self = Self {
        lower: [f64::NEG_INFINITY; 3],
        upper: [f64::INFINITY; 3],
    };

    /// All that lies between two coordinates (m) on one axis (0, 1, 2).
    #[must_use]
    pub fn slab(axis: usize, lower: f64, upper: f64) -> Self {
        let mut slab = Self::OPEN;
        slab.lower[axis] = lower;
        slab.upper[axis] = upper;
        slab
    }

    /// The same with all sides farther out by a length (m).
    #[must_use]
    pub fn widened(&self, by: f64) -> Self {
        Self {
            lower: self.lower.map(|x| x - by),
            upper: self.upper.map(|x| x + by),
        }
    }

    /// `true` if nothing is inside.
    #[must_use]
    #[inline]
    pub fn is_empty(&self) -> bool {
        (0..3).any(|a| self.lower[a] >= self.upper[a])
    }

    /// `true` if a position (m) is inside.
    #[inline]
    #[must_use]
    pub fn holds(&self, position: &[f64; 3]) -> bool {
        (0..3).all(|a| self.lower[a] <= position[a] && position[a] < self.upper[a])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_lower_side_belongs_to_it_and_an_upper_one_does_not() {
        let slab = Brick::slab(1, -1.0, 2.0);
        let holds = |y: f64| slab.holds(&[1e9, y, -1e9]);
        assert_eq!(
            [-1.5, -1.0, 1.9, 2.0].map(holds),
            [false, true, true, false]
        );
        assert!(slab.widened(0.5).holds(&[0.0, -1.5, 0.0]));
        assert!(Brick::OPEN.holds(&[f64::MAX; 3]));
        assert!(!Brick::OPEN.is_empty() && !slab.is_empty());
        assert!(Brick::slab(0, 1.0, 1.0).is_empty());
        assert!(Brick::slab(2, f64::INFINITY, f64::INFINITY).is_empty());
    }
}
