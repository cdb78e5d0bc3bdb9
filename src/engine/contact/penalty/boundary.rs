//! The outermost layer of a body, and its normals.

use crate::contact::view::{ContactParticle, ContactView};
use numerics::kernel::{Kernel, SUPPORT};
use numerics::vector::{minus, norm};

/// Weight of a corner's normal beside that of a face.
pub(super) const CORNER: f64 = 1e-3;

/// Limits that distinguish particles of a body.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Boundary {
    /// Length of the boundary vector `|b| Δp` above which a particle is of the outermost layer.
    outer: f64,
    /// Share of the support that the body fills, `Σ V_j W_ij`, of a particle of a flat face.
    face: f64,
    /// The same of an edge between two faces at a right angle.
    edge: f64,
}

impl Boundary {
    /// For a cubic lattice of unit spacing with a flat face and the smoothing length `h`: half-way
    /// between the first layer and the second.
    pub(super) fn of_lattice(kernel: &Kernel, h: f64) -> Self {
        // Length of the boundary vector and filled share, `depth` below a face that is `edges`
        // times cut at a right angle.
        #[allow(clippy::cast_possible_truncation, reason = "a few layers")]
        let reach = (SUPPORT * h).ceil() as i32;
        let layer = |depth: i32, edges: usize| {
            let (mut outward, mut slope, mut filled) = (0.0, 0.0, kernel.value(0.0, h));
            let across = |a: usize| match a < kernel.dimension() - 1 {
                true if a < edges => 0..=reach,
                true => -reach..=reach,
                false => 0..=0,
            };
            for x in across(0) {
                for y in across(1) {
                    for z in -depth..=reach {
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

    /// Weight of the normal of a particle whose body fills `filled` of its support: 1 on faces,
    /// next to nothing at corners.
    fn weight(&self, filled: f64) -> f64 {
        ((filled - self.edge) / (self.face - self.edge)).clamp(CORNER, 1.0)
    }
}

/// The outward normal of the receiver `i`, as long as it counts beside others, from the images of
/// its own group; zero inside of the body.
pub(super) fn normal(
    view: &ContactView,
    i: &ContactParticle,
    own: &[u32],
    known: &Boundary,
) -> [f64; 3] {
    let pair = view.table.pair(i.size_class, i.size_class);
    let (mut outward, mut filled) = ([0.0; 3], 0.0);
    // B⁻¹; one on axes that the case does not have.
    let mut matrix = [[0.0; 3]; 3];
    for &other in own {
        let record = &view.motion[other as usize];
        let r = minus(&i.position, &record.position);
        let distance = norm(&r);
        filled += record.volume * pair.kernel.value(distance);
        if distance == 0.0 {
            continue;
        }
        let pull = -record.volume * pair.kernel.slope(distance) / distance;
        for a in 0..3 {
            outward[a] += pull * r[a];
            for b in 0..3 {
                matrix[a][b] += pull * r[a] * r[b];
            }
        }
    }
    for a in view.table.kernel.dimension()..3 {
        matrix[a][a] = 1.0;
    }
    let corrected = solve(&matrix, &outward).unwrap_or(outward);
    let length = norm(&corrected);
    if length * pair.spacing > known.outer {
        let scale = known.weight(filled) / length;
        corrected.map(|c| c * scale)
    } else {
        [0.0; 3]
    }
}

/// `A⁻¹ v` of a symmetric positive matrix; `None` where that is as good as singular, as about a
/// lone particle.
fn solve(a: &[[f64; 3]; 3], v: &[f64; 3]) -> Option<[f64; 3]> {
    let minor = |i: usize, j: usize| {
        let (k, l, m, n) = ((i + 1) % 3, (i + 2) % 3, (j + 1) % 3, (j + 2) % 3);
        a[k][m] * a[l][n] - a[k][n] * a[l][m]
    };
    let determinant = a[0][0] * minor(0, 0) + a[0][1] * minor(0, 1) + a[0][2] * minor(0, 2);
    (determinant > 1e-3).then(|| {
        std::array::from_fn(|i| {
            (v[0] * minor(0, i) + v[1] * minor(1, i) + v[2] * minor(2, i)) / determinant
        })
    })
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

    #[test]
    fn the_matrix_is_solved() {
        let a = [[2.0, 0.5, 0.1], [0.5, 1.5, -0.2], [0.1, -0.2, 1.0]];
        let x = [0.3, -1.0, 2.0];
        let v = std::array::from_fn(|i| a[i][0] * x[0] + a[i][1] * x[1] + a[i][2] * x[2]);
        let found = solve(&a, &v).expect("a solution");
        for k in 0..3 {
            assert!((found[k] - x[k]).abs() < 1e-14);
        }
        assert!(solve(&[[0.0; 3]; 3], &v).is_none());
    }
}
