//! The tensile part of a symmetric tensor, in its principal frame.

use numerics::principal::principal;

/// `Σ_a ⟨σ_a⟩₊ n_a ⊗ n_a` over the principal values `σ_a` and directions `n_a` of a symmetric
/// tensor; components xx, yy, zz, xy, xz, yz, in and out.
#[must_use]
pub fn tensile_part(tensor: &[f64; 6]) -> [f64; 6] {
    let (value, n) = principal(tensor);
    let value = value.map(|x| x.max(0.0));
    [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)].map(|(i, j): (usize, usize)| {
        value[0] * (n[i][0] * n[j][0])
            + value[1] * (n[i][1] * n[j][1])
            + value[2] * (n[i][2] * n[j][2])
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Matrix3, SymmetricEigen};

    fn matrix(t: &[f64; 6]) -> Matrix3<f64> {
        Matrix3::new(t[0], t[3], t[4], t[3], t[1], t[5], t[4], t[5], t[2])
    }

    /// The same by another solver.
    fn reference(t: &[f64; 6]) -> Matrix3<f64> {
        let eigen = SymmetricEigen::new(matrix(t));
        let positive = Matrix3::from_diagonal(&eigen.eigenvalues.map(|x| x.max(0.0)));
        eigen.eigenvectors * positive * eigen.eigenvectors.transpose()
    }

    #[test]
    fn agrees_with_another_solver() {
        let mut number = 1_u64;
        let mut random = || {
            number = number
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            #[allow(clippy::cast_precision_loss, reason = "random bits")]
            let x = (number >> 11) as f64 / (1_u64 << 53) as f64;
            2e9 * x - 1e9
        };
        for k in 0..2000 {
            let mut tensor = [(); 6].map(|()| random());
            if k % 3 == 0 {
                // Plane strain.
                (tensor[4], tensor[5]) = (0.0, 0.0);
            }
            if k % 5 == 0 {
                // Almost hydrostatic.
                tensor[0] = 1e9;
                tensor[1] = 1e9;
                tensor[2] = 1e9 + 1e-6 * tensor[2];
                tensor[3] *= 1e-9;
            }
            let error = (matrix(&tensile_part(&tensor)) - reference(&tensor)).norm();
            assert!(
                error < 1e-14 * matrix(&tensor).norm(),
                "{tensor:?}: {error:e}"
            );
        }
    }

    #[test]
    fn what_is_known_is_exact() {
        assert_eq!(
            tensile_part(&[3.0, -2.0, 1.0, 0.0, 0.0, 0.0]),
            [3.0, 0.0, 1.0, 0.0, 0.0, 0.0]
        );
        assert_eq!(tensile_part(&[0.0; 6]), [0.0; 6]);
        assert_eq!(tensile_part(&[-1.0, -2.0, -1.0, 0.0, 0.0, 0.0]), [0.0; 6]);
        // Pure shear: tension along the diagonal.
        let half = tensile_part(&[0.0, 0.0, 0.0, 2.0, 0.0, 0.0]);
        for (found, wanted) in half.into_iter().zip([1.0, 1.0, 0.0, 1.0, 0.0, 0.0]) {
            assert!((found - wanted).abs() < 1e-15, "{half:?}");
        }
        assert!(tensile_part(&[f64::NAN; 6])[0].is_nan());
    }
}
