//! Failure at a plastic strain: matter has failed once its equivalent plastic strain reaches the
//! limit, and damage is the strain over the limit before.

use super::{Conditions, LANES, Law, PointBatch};
use crate::at_least;

law! {
    /// Largest plastic strain.
    PlasticStrain {
        /// Equivalent plastic strain at which matter has failed.
        limit: "",
    }
}

impl Law for PlasticStrain {
    const STATE: &'static [&'static str] = &["deviatoric_stress", "damage", "failure_energy"];
    const FOLLOWS_STATE: bool = true;

    #[inline(always)]
    fn fail(&self, point: &mut PointBatch, now: &Conditions) {
        for k in 0..LANES {
            if now.plastic_increment[k] > 0.0 {
                let limit = self.limit * now.options.strain_factor(point.id[k]);
                point.damage[k] = at_least(point.damage[k], point.plastic_strain[k] / limit);
            }
        }
    }
}
