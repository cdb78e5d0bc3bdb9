//! What particles show to their neighbours.

/// What a particle shows to its neighbours of its stress and its correction.
#[derive(Debug, Clone, Copy, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub struct NormalisedRecord {
    /// `P = σ Bᵀ`, row-major (Pa).
    pub stress: [f64; 9],
    /// `P γ` (Pa/m).
    pub shift: [f64; 3],
}

impl NormalisedRecord {
    /// No stress.
    pub const FREE: Self = Self {
        stress: [0.0; 9],
        shift: [0.0; 3],
    };

    /// From pressure and deviatoric stress (Pa), `B` and `γ` (1/m).
    #[must_use]
    pub fn new(pressure: f64, deviatoric: &[f64; 6], matrix: &[f64; 9], shift: &[f64; 3]) -> Self {
        let [xx, yy, zz, xy, xz, yz] = *deviatoric;
        let sigma = [
            [xx - pressure, xy, xz],
            [xy, yy - pressure, yz],
            [xz, yz, zz - pressure],
        ];
        let mut record = Self::FREE;
        for a in 0..3 {
            for c in 0..3 {
                let along = |b: usize| sigma[a][b] * matrix[3 * c + b];
                let stress = along(0) + along(1) + along(2);
                record.stress[3 * a + c] = stress;
                record.shift[a] += stress * shift[c];
            }
        }
        record
    }
}
