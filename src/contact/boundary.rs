//! What tells the outermost layer of a body, for `penalty` contact.

use crate::numerics::kernel::Kernel;

/// Weight of a corner's normal beside that of a face.
pub(super) const CORNER: f64 = 1e-3;

/// What tells particles of a body apart.
#[derive(Debug, Clone, Copy, Default)]
pub struct Boundary {
    /// Length of the boundary vector `|b| Δp` above which a particle is of the outermost layer.
    pub outer: f64,
    /// Share of the support that the body fills, `Σ V_j W_ij`, of a particle of a flat face.
    pub face: f64,
    /// The same of an edge between two faces at a right angle.
    pub edge: f64,
}

impl Boundary {
    /// For a cubic lattice of unit spacing with a flat face and the smoothing length `h`: half-way
    /// between the first layer and the second.
    #[must_use]
    pub fn of_lattice(kernel: &Kernel, h: f64) -> Self {
        // Length of the boundary vector and filled share, `depth` below a face that is `edges` times
        // cut at a right angle.
        let layer = |depth: i32, edges: usize| {
            let (mut outward, mut slope, mut filled) = (0.0, 0.0, kernel.value(0.0, h));
            let across = |a: usize| match a < kernel.dimension() - 1 {
                true if a < edges => 0..=6,
                true => -6..=6,
                false => 0..=0,
            };
            for x in across(0) {
                for y in across(1) {
                    for z in -depth..=6 {
                        let square = f64::from(x * x + y * y + z * z);
                        if square > 0.0 {
                            let r = square.sqrt();
                            let pull = -kernel.slope(r, h) / r;
                            outward += pull * f64::from(z);
                            slope += pull * f64::from(z * z);
                            filled += kernel.value(r, h);
                        }
                    }
                }
            }
            (outward / slope, filled)
        };
        let ((first, face), (second, _)) = (layer(0, 0), layer(1, 0));
        Self {
            outer: 0.5 * (first + second),
            face,
            // A line has ends and no edges.
            edge: if kernel.dimension() == 1 {
                0.0
            } else {
                layer(0, 1).1
            },
        }
    }

    /// How much the normal of a particle counts whose body fills `filled` of its support: 1 on
    /// faces, next to nothing at corners.
    pub(super) fn weight(&self, filled: f64) -> f64 {
        ((filled - self.edge) / (self.face - self.edge)).clamp(CORNER, 1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Edges fill well less of their support than faces, and these less than the inside.
    #[test]
    fn layers_are_told_apart() {
        for dimension in 1..=3 {
            for h in [1.0, 1.2, 1.3, 1.5] {
                let kernel = Kernel::new(dimension);
                let known = Boundary::of_lattice(&kernel, h);
                println!("{dimension}-D h {h}: {known:?}");
                assert!(known.outer > 0.2 && known.outer < 1.0);
                assert!(known.edge < 0.9 * known.face && known.face < 0.9);
            }
        }
    }
}
