//! Triangles by the numbers of their corners, before they are known to be a closed surface.

use std::collections::BTreeMap;

use super::closed::{MeshError, check_closed, location};
use numerics::vector::{cross, dot, minus};

/// Triangles that may share corners.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Soup {
    /// Places (m).
    pub corners: Vec<[f64; 3]>,
    /// Numbers of corners.
    pub triangles: Vec<[u32; 3]>,
}

/// A number of a corner or a triangle.
pub(super) fn number(n: usize) -> u32 {
    u32::try_from(n).unwrap_or(u32::MAX)
}

/// Twice the area along the normal.
pub(super) fn normal_area(x: &[[f64; 3]; 3]) -> [f64; 3] {
    cross(&minus(&x[1], &x[0]), &minus(&x[2], &x[0]))
}

/// The smaller number first.
pub(super) fn undirected(a: u32, b: u32) -> (u32, u32) {
    (a.min(b), a.max(b))
}

impl Soup {
    /// Joins triangles that share corners to the bit. Triangles with two equal corners are left out.
    pub fn new(triangles: &[[[f64; 3]; 3]]) -> Self {
        let mut numbers: BTreeMap<[u64; 3], u32> = BTreeMap::new();
        let mut soup = Self::default();
        for triangle in triangles {
            let t = triangle.map(|x| {
                // Zero has one sign.
                let x = x.map(|c| c + 0.0);
                *numbers.entry(x.map(f64::to_bits)).or_insert_with(|| {
                    soup.corners.push(x);
                    number(soup.corners.len() - 1)
                })
            });
            soup.triangles.push(t);
        }
        soup.triangles.retain(|t| !is_needle(t));
        soup
    }

    /// The corners of a triangle (m).
    pub fn at(&self, t: &[u32; 3]) -> [[f64; 3]; 3] {
        t.map(|c| self.corners[c as usize])
    }

    /// Longest edge of the box around all corners (m).
    pub fn size(&self) -> f64 {
        let ends = |a: usize| {
            let along = self.corners.iter().map(|x| x[a]);
            let (low, high) = (f64::INFINITY, f64::NEG_INFINITY);
            along.fold((low, high), |(low, high), c| (c.min(low), c.max(high)))
        };
        let edges = [0, 1, 2].map(|a| ends(a).1 - ends(a).0);
        edges.into_iter().fold(0.0, f64::max)
    }

    /// Checks that the triangles make a closed surface, each of some area.
    ///
    /// # Errors
    /// The first defect.
    pub fn check(&self) -> Result<(), MeshError> {
        if self.triangles.is_empty() {
            return Err(MeshError::Empty);
        }
        for (n, t) in self.triangles.iter().enumerate() {
            let area = normal_area(&self.at(t));
            if dot(&area, &area) <= 0.0 {
                return Err(MeshError::Flat {
                    triangle: n + 1,
                    location: location(&self.corners[t[0] as usize]),
                });
            }
        }
        check_closed(&self.corners, &self.triangles)
    }
}

/// `true` if two corners are one.
pub(super) fn is_needle(t: &[u32; 3]) -> bool {
    t[0] == t[1] || t[1] == t[2] || t[2] == t[0]
}
