//! The hourglass displacements of particles, as the material answers a step (theory page "Corrected SPH").

use super::material_update::Updated;
use material::{FAILED, NEGLIGIBLE};
use numerics::lane_matrix::{load_all, read_all, store_all};
use numerics::lanes::{F64x8, LANES, Lanes};
use particles::Scatter;
use sums::hourglass;

/// Inputs and outputs of their update.
pub(super) struct HourglassUpdate<'a> {
    /// Length of the step (s).
    pub dt: f64,
    /// Stiffness ξ.
    pub stiffness: f64,
    /// The displacements (m).
    pub displacement: Scatter<'a, [f64; 3]>,
}

impl HourglassUpdate<'_> {
    /// Advances those of points whose neighbours moved by `rest` (m/s) beyond a linear field, by their deviatoric stress (Pa).
    ///
    /// # Safety
    /// No other thread may read or write those of these particles.
    #[inline(always)]
    pub(super) unsafe fn advance<V: Lanes>(
        &self,
        points: &Updated,
        deviator: &[V; 6],
        neighbours: &[F64x8; 3],
    ) {
        let (before, after) = (points.before, points.after);
        let mut old = [[0.0; LANES]; 3];
        let mut intact = [1.0; LANES];
        for k in 0..LANES {
            // SAFETY: by the contract of this function.
            let own = unsafe { *self.displacement.slot(points.particles[k]) };
            for a in 0..3 {
                old[a][k] = own[a];
            }
            let slow = |v: &F64x8| v.0[k].abs() < NEGLIGIBLE * after.sound_speed[k];
            let still = || after.velocity_gradient.iter().all(|l| l[k] == 0.0);
            let rests = own == [0.0; 3] && neighbours.iter().all(slow) && still();
            if after.damage[k] >= FAILED || rests {
                intact[k] = 0.0;
            }
        }
        let plastic = V::read(&after.plastic_strain).sub(V::read(&before.plastic_strain));
        let flow = plastic.mul(V::splat(3.0 * points.shear_modulus));
        let kept = hourglass::kept(deviator, flow).mul(V::read(&intact));
        let new = hourglass::advance(
            &read_all(&old),
            &load_all(neighbours),
            &read_all(&after.velocity_gradient),
            V::splat(self.dt),
        );
        let new = [new[0].mul(kept), new[1].mul(kept), new[2].mul(kept)];
        let new: [F64x8; 3] = store_all::<V, 3>(&new);
        points.each(|k, i, _| {
            // SAFETY: by the contract of this function.
            unsafe { *self.displacement.slot(i) = [new[0].0[k], new[1].0[k], new[2].0[k]] };
        });
    }
}
