//! The contact potential of Vignjevic, De Vuyst & Campbell (2006), with the repulsive sign.
//!
//! `φ_i = Σ_j V_j K (W_ij/W(Δp̄))^n` (V 21) and `f_i = −Σ_j V_i V_j K n W_ij^{n−1}/W(Δp̄)^n ∇_i
//! W_ij` (V 24 read as −∇φ); the energy of all pairs is `½ Σ V_i φ_i`. With the range "spacing" the
//! force of a pair at the mean spacing is taken off, `W_ij^{n−1} − W(Δp̄)^{n−1}` in place of
//! `W_ij^{n−1}`, so that it sets in at zero there (theory page "Contact").

use super::mode::{Mode, PairForce, ParticlePair};
use super::pair::{Between, Constants};
use super::view::{ContactParticle, ContactView};
use model::{ContactDirection, Potential, PotentialRange};

/// Constants of an ordered pair of bodies.
#[derive(Debug, Clone, Default)]
pub(crate) struct PotentialPair {
    /// K (Pa/m^d).
    stiffness: f64,
    exponent: i32,
    /// W/W(Δp̄) at which the force sets in, 1 where the range is the mean spacing and 0 where it is
    /// the support.
    floor: f64,
    /// 1/W(Δp̄) (m^d).
    inverse_kernel: f64,
    /// True if forces act along the normals of the surfaces.
    along_normal: bool,
}

impl Constants for Potential {
    type Pair = PotentialPair;

    fn pair(&self, of: &Between) -> PotentialPair {
        PotentialPair {
            stiffness: self.stiffness * of.modulus / of.kernel.power(of.pair.spacing),
            exponent: i32::try_from(self.exponent).unwrap_or(i32::MAX),
            floor: match self.range {
                PotentialRange::Support => 0.0,
                PotentialRange::Spacing => 1.0,
            },
            inverse_kernel: 1.0 / of.pair.kernel.value(of.pair.spacing),
            along_normal: self.direction == ContactDirection::Normal,
        }
    }
}

impl Mode for Potential {
    type Measured = ();
    type Side = ();

    fn side(_: &ContactView, _: &ContactParticle) {}

    #[inline(always)]
    fn force(pair: &ParticlePair<Self>, stiffness: &mut f64) -> Option<PairForce> {
        let (own, kernel) = (pair.own, &pair.constants.kernel);
        let distance = pair.separation.distance;
        let ratio = kernel.value(distance) * own.inverse_kernel;
        let slope = -kernel.slope(distance) * own.inverse_kernel;
        let curvature = kernel.curvature(distance).abs() * own.inverse_kernel;
        let strength = own.stiffness * pair.mean_stiffening() * pair.i.volume * pair.j.volume;
        let n = f64::from(own.exponent);
        let steeper = power(ratio, own.exponent - 1);
        // With either range: the step must be short enough before the force sets in.
        *stiffness += 2.0
            * strength
            * n
            * ((n - 1.0) * power(ratio, own.exponent - 2) * (slope * slope) + steeper * curvature);
        (ratio > own.floor).then(|| {
            let rise = ratio * steeper - own.floor * (1.0 + n * (ratio - own.floor));
            let force = strength * n * (steeper - own.floor) * slope;
            PairForce {
                force: pair.along(force, own.along_normal),
                drag: 0.0,
                energy: 0.5 * strength * rise * pair.own_share(),
                loads: [0.0; 2],
            }
        })
    }
}

/// `x^n` by plain multiplication; 0 for negative n (met only as a factor of zero, n = 1).
fn power(x: f64, n: i32) -> f64 {
    if n < 0 {
        return 0.0;
    }
    (0..n).fold(1.0, |product, _| product * x)
}
