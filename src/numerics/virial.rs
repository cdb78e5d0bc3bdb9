//! The virial of forces: the stress that they carry, times the volume that bears it.

/// Sum of `−sym(f ⊗ r)` over forces (J), xx, yy, zz, xy, xz, yz; tension positive.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Virial(pub [f64; 6]);

/// xx, yy, zz, xy, xz, yz.
const COMPONENTS: [[usize; 2]; 6] = [[0, 0], [1, 1], [2, 2], [0, 1], [0, 2], [1, 2]];

impl Virial {
    /// Adds a force (N) on a particle, which the matter of this particle carries over `arm` (m)
    /// towards it.
    #[inline(always)]
    pub fn add(&mut self, force: &[f64; 3], arm: &[f64; 3]) {
        for (sum, [a, b]) in self.0.iter_mut().zip(COMPONENTS) {
            *sum -= 0.5 * (force[a] * arm[b] + force[b] * arm[a]);
        }
    }

    /// Adds that of other forces.
    #[inline(always)]
    pub fn join(&mut self, other: &Self) {
        for (sum, other) in self.0.iter_mut().zip(other.0) {
            *sum += other;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A push is compression along its arm, a drag across it shear.
    #[test]
    fn pushes_are_compression() {
        let mut virial = Virial::default();
        virial.add(&[3.0, 0.0, 0.0], &[0.5, 0.0, 0.0]);
        virial.add(&[0.0, 2.0, 0.0], &[0.0, 0.0, 0.25]);
        assert_eq!(virial.0, [-1.5, 0.0, 0.0, 0.0, 0.0, -0.25]);
    }
}
