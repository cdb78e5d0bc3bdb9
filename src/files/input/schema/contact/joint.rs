//! `contact.pair.joint`: table and parameters.

use serde::Deserialize;

use crate::input::quantity::{FractureEnergy, Placed, Pressure};
use crate::input::source::Diagnostic;
use model::Joint;

tables! {
    /// `contact.pair.joint`
    JointParams {
        /// Tension across it from which it comes apart.
        strength: Placed<Pressure>, Positive;
        /// Shear from which it comes apart.
        shear_strength: Option<Placed<Pressure>>, Positive => "as `strength`";
        /// Energy that an area takes to come apart in tension.
        energy: Option<Placed<FractureEnergy>>, Positive => "it comes apart at once";
        /// Energy that an area takes to come apart in shear.
        shear_energy: Option<Placed<FractureEnergy>>, Positive => "as `energy`";
    }
}

impl JointParams {
    /// The joint.
    pub fn joint(&self) -> Result<Joint, Diagnostic> {
        let (strength, energy) = (self.strength()?, self.energy()?);
        Ok(Joint {
            strength,
            shear_strength: self.shear_strength()?.unwrap_or(strength),
            energy,
            shear_energy: self.shear_energy()?.or(energy),
        })
    }
}
