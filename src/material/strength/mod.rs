//! Strength: the deviatoric stress.

pub mod elastic;
pub mod jaumann;
pub mod johnson_cook;
pub mod neo_hookean;
mod radial_return;
pub mod steinberg_guinan;
pub mod viscous;
pub mod von_mises;

pub use elastic::Elastic;
pub use johnson_cook::JohnsonCook;
pub use neo_hookean::NeoHookean;
pub use steinberg_guinan::SteinbergGuinan;
pub use viscous::Viscous;
pub use von_mises::VonMises;

/// The resistance of a material to shear.
#[derive(Debug, Clone, PartialEq)]
pub enum Strength {
    /// No shear stress: a fluid.
    None,
    /// Newtonian fluid.
    Viscous(Viscous),
    /// Linear elastic (hypoelastic with the Jaumann rate), without bound.
    Elastic(Elastic),
    /// Neo-Hookean rubber (hyperelastic), without bound.
    NeoHookean(NeoHookean),
    /// Elastic–plastic with a von Mises yield stress and linear hardening.
    VonMises(VonMises),
    /// Elastic–plastic with the flow stress of Johnson and Cook.
    JohnsonCook(JohnsonCook),
    /// Elastic–plastic with the moduli of Steinberg and Guinan.
    SteinbergGuinan(SteinbergGuinan),
}

impl Strength {
    /// Elastic shear modulus G of the reference state (Pa); zero for a fluid.
    #[must_use]
    pub fn shear_modulus(&self) -> f64 {
        match self {
            Self::None | Self::Viscous(_) => 0.0,
            Self::Elastic(law) => law.shear_modulus,
            Self::NeoHookean(law) => law.shear_modulus,
            Self::VonMises(law) => law.shear_modulus,
            Self::JohnsonCook(law) => law.shear_modulus,
            Self::SteinbergGuinan(law) => law.shear_modulus,
        }
    }

    /// Whether the law follows the temperature.
    #[must_use]
    pub fn needs_temperature(&self) -> bool {
        matches!(self, Self::JohnsonCook(_) | Self::SteinbergGuinan(_))
    }

    /// Whether the law needs the melting temperature of the thermal constants.
    #[must_use]
    pub fn needs_melting(&self) -> bool {
        matches!(self, Self::JohnsonCook(_))
    }
}
