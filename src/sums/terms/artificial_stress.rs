//! Artificial stress (Monaghan 2000; Gray, Monaghan & Swift 2001): pairs in tension repel each
//! other, the nearer the more.

use super::TermRecord;
use crate::neighbourhood::gather_all;
use crate::principal::tensile_part;
use numerics::lanes::{LANES, Lanes};

/// Artificial stress over density squared (Pa m⁶/kg²), `R = −ε Σ_a ⟨σ_a⟩₊ n_a ⊗ n_a/ρ²` over the
/// principal stresses `σ_a` and directions `n_a` (Gray, Monaghan & Swift 2001): a pressure along
/// each direction in tension. From the factor ε, pressure and deviatoric stress (Pa) and density
/// (kg/m³).
#[must_use]
pub fn repulsion(epsilon: f64, pressure: f64, deviatoric: &[f64; 6], density: f64) -> [f64; 6] {
    let [xx, yy, zz, xy, xz, yz] = *deviatoric;
    let stress = [xx - pressure, yy - pressure, zz - pressure, xy, xz, yz];
    let scale = -epsilon / (density * density);
    tensile_part(&stress).map(|x| scale * x)
}

/// The part of eight receivers.
pub(super) struct Lane<V> {
    normal: [V; 3],
    shear: [V; 3],
    inverse_shape: V,
}

impl<V: Lanes> Lane<V> {
    #[inline(always)]
    pub fn begin(own: &[&TermRecord; LANES], inverse_shape: f64) -> Self {
        Self {
            normal: gather_all(own, |record, a| record.repulsion[a]),
            shear: gather_all(own, |record, a| record.repulsion[3 + a]),
            inverse_shape: V::splat(inverse_shape),
        }
    }

    /// Adds `(R_i + R_j) f⁴` to the stress (xx, yy, zz, xy, xz, yz) of pairs of a `shape`
    /// `w = W h^d/σ_d`, with `f = w/w(Δp/h)`.
    #[inline(always)]
    pub fn repel(&self, stress: &mut [V; 6], other: &TermRecord, shape: V) {
        let f = shape.mul(self.inverse_shape);
        let square = f.mul(f);
        let weight = square.mul(square);
        for a in 0..3 {
            let normal = self.normal[a].add(V::splat(other.repulsion[a]));
            stress[a] = normal.mul_add(weight, stress[a]);
            let shear = self.shear[a].add(V::splat(other.repulsion[3 + a]));
            stress[3 + a] = shear.mul_add(weight, stress[3 + a]);
        }
    }
}
