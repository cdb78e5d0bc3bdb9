//! Failure by the largest principal stress (Rankine): matter has failed once a principal stress,
//! tension positive, exceeds the limit.

use super::failure::FAILED;
use super::principal_tension::{may_exceed, pull};
use super::{Conditions, LANES, Law, PointBatch};

law! {
    /// Largest principal stress.
    PrincipalStress {
        /// Largest tension in any direction (Pa).
        limit: "Pa",
    }
}

impl Law for PrincipalStress {
    const STATE: &'static [&'static str] = &["deviatoric_stress", "damage", "failure_energy"];
    const FOLLOWS_STATE: bool = true;

    #[inline(never)]
    fn fail(&self, point: &mut PointBatch, now: &Conditions) {
        for k in 0..LANES {
            let limit = self.limit * now.kept[k];
            if point.damage[k] < FAILED
                && may_exceed(point, k, limit)
                && pull(point, k, now) > limit
            {
                point.damage[k] = FAILED;
            }
        }
    }
}
