//! Principal values and directions of symmetric tensors.

/// Cyclic Jacobi sweeps at most; they converge quadratically, and five suffice at double precision.
const SWEEPS: usize = 8;
/// Off-diagonal over diagonal squares at which the rest is rounding.
const CONVERGED: f64 = 1e-34;

/// Principal values of a symmetric tensor, in no order, and its principal directions, as columns;
/// components xx, yy, zz, xy, xz, yz.
///
/// Jacobi's rotations (Golub & Van Loan, *Matrix computations*, section 8.5): additions, products,
/// quotients and roots alone, so that the bits are the same on any machine.
#[inline]
#[must_use]
pub fn principal(tensor: &[f64; 6]) -> ([f64; 3], [[f64; 3]; 3]) {
    let [xx, yy, zz, xy, xz, yz] = *tensor;
    let mut a = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]];
    let mut n = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    for _ in 0..SWEEPS {
        let off = a[0][1] * a[0][1] + a[0][2] * a[0][2] + a[1][2] * a[1][2];
        let on = a[0][0] * a[0][0] + a[1][1] * a[1][1] + a[2][2] * a[2][2];
        if off <= CONVERGED * on {
            break;
        }
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            rotate(&mut a, &mut n, p, q);
        }
    }
    ([a[0][0], a[1][1], a[2][2]], n)
}

/// Turns the plane of the axes `p` and `q` so that `a[p][q]` vanishes.
#[inline]
fn rotate(a: &mut [[f64; 3]; 3], n: &mut [[f64; 3]; 3], p: usize, q: usize) {
    if a[p][q] == 0.0 {
        return;
    }
    let theta = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
    let root = (theta * theta + 1.0).sqrt();
    let tangent = if theta < 0.0 {
        1.0 / (theta - root)
    } else {
        1.0 / (theta + root)
    };
    let cosine = 1.0 / (tangent * tangent + 1.0).sqrt();
    let sine = tangent * cosine;
    a[p][p] -= tangent * a[p][q];
    a[q][q] += tangent * a[p][q];
    (a[p][q], a[q][p]) = (0.0, 0.0);
    let k = 3 - p - q;
    let (kp, kq) = (a[k][p], a[k][q]);
    (a[k][p], a[k][q]) = (cosine * kp - sine * kq, sine * kp + cosine * kq);
    (a[p][k], a[q][k]) = (a[k][p], a[k][q]);
    for row in n {
        let (np, nq) = (row[p], row[q]);
        (row[p], row[q]) = (cosine * np - sine * nq, sine * np + cosine * nq);
    }
}
