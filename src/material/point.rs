//! The material point: its state, and the laws that act on it, in two tables.
//!
//! A law is a file that implements [`Law`]; its row here gives it a name and a key of the input,
//! its rows in `input/schema/materials.rs` its constants.

mod batch;
mod collins;
mod collins_failure;
mod damage;
mod drucker_prager;
mod elastic;
mod failure;
mod grady_kipp;
mod hashin;
mod holmquist_johnson_cook;
mod holmquist_johnson_cook_failure;
mod ivanov;
mod jaumann;
mod johnson_cook;
mod johnson_cook_failure;
mod johnson_holmquist_2;
mod johnson_holmquist_2_failure;
mod law;
mod lundborg;
mod mohr_coulomb;
mod neo_hookean;
mod orthotropic;
mod plastic_strain;
mod principal_stress;
mod principal_tension;
mod radial_return;
mod riedel_hiermaier_thoma;
mod riedel_hiermaier_thoma_failure;
mod spall;
mod steinberg_guinan;
mod uncoupled;
mod uncoupled_failure;
mod viscous;
mod von_mises;

use super::declare::Listed;
use batch::strain_rates_squared;
pub use batch::{LANES, Lanes, PointBatch, PointField};
pub use collins::Collins;
pub use collins_failure::CollinsFailure;
pub(super) use damage::limit_expansion;
pub use drucker_prager::DruckerPrager;
pub use elastic::Elastic;
pub use failure::FAILED;
use failure::failure_laws;
pub use failure::{Effect, FailureOptions, Molten, viscous_speed};
pub use grady_kipp::{Crosses, Flaws, GradyKipp};
pub use hashin::{Criterion, Hashin};
pub use holmquist_johnson_cook::HolmquistJohnsonCook;
pub use holmquist_johnson_cook_failure::HolmquistJohnsonCookFailure;
pub use ivanov::Ivanov;
pub use johnson_cook::JohnsonCook;
pub use johnson_cook_failure::{Coupling, JohnsonCookFailure, RateForm};
pub use johnson_holmquist_2::JohnsonHolmquist2;
pub use johnson_holmquist_2_failure::JohnsonHolmquist2Failure;
use law::strength_laws;
pub use law::{Conditions, Contradiction, Curves, Law};
pub use lundborg::Lundborg;
pub use mohr_coulomb::MohrCoulomb;
pub use neo_hookean::NeoHookean;
pub(super) use orthotropic::solid_share;
pub use orthotropic::{Orthotropic, Stiffness};
pub use plastic_strain::PlasticStrain;
pub use principal_stress::PrincipalStress;
pub(super) use radial_return::equivalent_stress;
pub use riedel_hiermaier_thoma::RiedelHiermaierThoma;
pub use riedel_hiermaier_thoma_failure::RiedelHiermaierThomaFailure;
pub use spall::{AfterSpall, Spall};
pub use steinberg_guinan::SteinbergGuinan;
pub use uncoupled::{Members, Uncoupled};
pub use uncoupled_failure::UncoupledFailure;
pub use viscous::Viscous;
pub use von_mises::VonMises;

/// Passes the fields of a material point to the macro `$then`, after `$more`: name, kind and role
/// of each. `Given` is taken from the particle, `State` is taken and written back, and `Answer` is
/// written back. `Memory` is state of failure, of pores or of burning: the same as `State` where a material of the
/// case has a law that changes it, zero elsewhere. `Known` is given where a material of the case has a
/// law that asks for it.
#[macro_export]
macro_rules! point_fields {
    ($then:ident $($more:tt)*) => {
        $then! {
            $($more)*
            /// Density at the end of the step (kg/m³).
            density: Scalar, State;
            /// Specific internal energy at the end of the step (J/kg).
            specific_energy: Scalar, Given;
            /// Velocity gradient at the middle of the step, row-major `L_ij = ∂v_i/∂x_j` (1/s).
            velocity_gradient: Tensor, Given;
            /// Deviatoric stress `xx yy zz xy xz yz`, tension positive (Pa).
            deviatoric_stress: Symmetric, State;
            /// Equivalent plastic strain.
            plastic_strain: Scalar, State;
            /// Damage: below one intact, from one on failed.
            damage: Scalar, Memory;
            /// Elastic energy that failure has released so far (J/kg).
            failure_energy: Scalar, Memory;
            /// Progress to the onset of softening, for material that softens before it fails.
            failure_onset: Scalar, Memory;
            /// Flaws that have become active.
            flaws: Scalar, Memory;
            /// Strain at which the weakest flaw becomes active; zero if none has been drawn.
            first_flaw: Scalar, Memory;
            /// Strain at which the next flaw becomes active; zero if none has been drawn.
            next_flaw: Scalar, Memory;
            /// How far pores have been crushed, along the crush curve; one without pores.
            compaction: Scalar, Memory;
            /// Distension; zero before the first update, and of matter without pores.
            distension: Scalar, Memory;
            /// Share of an explosive that has burnt.
            burn: Scalar, Memory;
            /// Time until a detonation lights an explosive, negative since (s).
            lighting_time: Scalar, Memory;
            /// Pressure by bulking of what is broken (Pa).
            bulking_pressure: Scalar, Memory;
            /// Direction 1 of the matter, a unit vector; zero without directions.
            fibre: Vector, Memory;
            /// Direction 3 of the matter, a unit vector; zero without directions.
            normal: Vector, Memory;
            /// Elastic strain of matter with directions, `xx yy zz xy xz yz`.
            elastic_strain: Symmetric, Memory;
            /// Strain of open cracks across direction 1.
            opening_1: Scalar, Memory;
            /// Strain of open cracks across direction 2.
            opening_2: Scalar, Memory;
            /// Strain of open cracks across direction 3.
            opening_3: Scalar, Memory;
            /// Damage of fibres, by cracks across direction 1.
            fibre_damage: Scalar, Memory;
            /// Damage of the matrix, by cracks across direction 2.
            matrix_damage: Scalar, Memory;
            /// Damage between layers, by cracks across direction 3.
            delamination: Scalar, Memory;
            /// Identity.
            id: Id, Known;
            /// Mass (kg).
            mass: Scalar, Known;
            /// Mean plastic strain of the neighbours.
            neighbour_strain: Scalar, Known;
            /// Pressure, compression positive (Pa).
            pressure: Scalar, Answer;
            /// Longitudinal sound speed (m/s).
            sound_speed: Scalar, Answer;
        }
    };
}

// The key below `strength` in the input, and the law. A material has one of them.
strength_laws! {
    /// Newtonian fluid.
    viscous: Viscous;
    /// Linear elastic (hypoelastic with the Jaumann rate), without bound.
    elastic: Elastic;
    /// Neo-Hookean rubber (hyperelastic), without bound.
    neo_hookean: NeoHookean;
    /// Elastic along directions of the matter's own.
    orthotropic: Orthotropic;
    /// Yarns or walls along directions of the matter's own.
    uncoupled: Uncoupled;
    /// Elastic–plastic with a von Mises yield stress and linear hardening.
    von_mises: VonMises;
    /// Elastic–plastic with the flow stress of Johnson and Cook.
    johnson_cook: JohnsonCook;
    /// Elastic–plastic with the moduli of Steinberg and Guinan.
    steinberg_guinan: SteinbergGuinan;
    /// Strength that grows with pressure, linear up to a limit.
    drucker_prager: DruckerPrager;
    /// Strength that grows with pressure, by the friction in the plane of most shear.
    mohr_coulomb: MohrCoulomb;
    /// Strength of intact rock, which grows with pressure towards a limit.
    lundborg: Lundborg;
    /// Strength of rock, intact and damaged.
    collins: Collins;
    /// Strength of ceramics, intact and fractured.
    johnson_holmquist_2: JohnsonHolmquist2;
    /// Strength of concrete.
    holmquist_johnson_cook: HolmquistJohnsonCook;
    /// Strength of concrete by pressure, Lode angle and rate.
    riedel_hiermaier_thoma: RiedelHiermaierThoma;
}

// The key in the input, and the law. A material may have all of them; they act in this order.
failure_laws! {
    /// Largest tension.
    spall: Spall;
    /// Largest principal stress.
    principal_stress: PrincipalStress;
    /// Largest plastic strain.
    plastic_strain: PlasticStrain;
    /// Ductile damage of Johnson and Cook.
    johnson_cook: JohnsonCookFailure;
    /// Shear damage with a failure strain linear in the pressure.
    ivanov: Ivanov;
    /// Shear damage of rock that is brittle, semi-brittle or ductile.
    collins: CollinsFailure;
    /// Damage of ceramics, and their bulking.
    johnson_holmquist_2: JohnsonHolmquist2Failure;
    /// Damage of concrete.
    holmquist_johnson_cook: HolmquistJohnsonCookFailure;
    /// Damage of concrete beyond its failure surface.
    riedel_hiermaier_thoma: RiedelHiermaierThomaFailure;
    /// Cracks across directions of the matter.
    hashin: Hashin;
    /// Yarns or walls that tear.
    uncoupled: UncoupledFailure;
    /// Cracks that grow from flaws.
    grady_kipp: GradyKipp;
}
