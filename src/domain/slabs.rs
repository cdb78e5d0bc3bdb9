//! Slabs of space between faces normal to one axis.

/// Who owns a point. Slabs are one answer; recursive bisection could be another.
pub trait Decomposition {
    /// The rank that owns a position (m).
    fn owner(&self, position: &[f64; 3]) -> usize;
}

/// One slab for each rank, in rank order along an axis; a slab may be empty.
#[derive(Debug, Clone, PartialEq)]
pub struct Slabs {
    /// Axis normal to the faces (0, 1, 2).
    pub axis: usize,
    /// The faces between slabs (m), one fewer than ranks, ascending. A point on a face belongs
    /// to the slab above.
    faces: Vec<f64>,
}

impl Slabs {
    /// Slabs between ascending `faces` (m).
    #[must_use]
    pub fn new(axis: usize, faces: Vec<f64>) -> Self {
        debug_assert!(faces.is_sorted());
        Self { axis, faces }
    }

    /// Lower and upper end of a rank's slab (m), infinite at the outside.
    #[must_use]
    pub fn range(&self, rank: usize) -> (f64, f64) {
        let lower = rank
            .checked_sub(1)
            .map_or(f64::NEG_INFINITY, |k| self.faces[k]);
        let upper = self.faces.get(rank).copied().unwrap_or(f64::INFINITY);
        (lower, upper)
    }

    /// The faces (m).
    #[must_use]
    pub fn faces(&self) -> &[f64] {
        &self.faces
    }
}

impl Decomposition for Slabs {
    fn owner(&self, position: &[f64; 3]) -> usize {
        let x = position[self.axis];
        self.faces.partition_point(|&face| face <= x)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_face_belongs_to_the_slab_above_and_slabs_may_be_empty() {
        let slabs = Slabs::new(0, vec![1.0, 2.0, 2.0]);
        let owner = |x: f64| slabs.owner(&[x, 0.0, 0.0]);
        assert_eq!([-9.0, 1.0, 1.5, 2.0, 7.0].map(owner), [0, 1, 1, 3, 3]);
        assert_eq!(slabs.range(2), (2.0, 2.0));
        assert_eq!(slabs.range(0).0, f64::NEG_INFINITY);
    }
}
