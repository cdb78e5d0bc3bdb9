//! Interface of a law of the material point, and the way those of a material act together.

use super::failure::FailureOptions;
use super::{LANES, Lanes, Members, PointBatch, Stiffness, strain_rates_squared};
use crate::ThermalConstants;
use crate::declare::Listed;
use numerics::lanes::F64x8;

/// Constants that cannot go together.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Contradiction {
    /// Keys at fault, the first one first.
    pub keys: &'static [&'static str],
    /// Statement of the contradiction.
    pub title: &'static str,
}

/// One law of the material point: elasticity, yield, softening or failure, or several of them.
///
/// In an update each law acts in the stages that it implements. First the equation of state sets
/// the pressure; then, each for all laws of the material, strength before failure:
///
/// 1. [`Law::limit_tension`], the largest tension,
/// 2. [`Law::soften`], moduli and softening at the pressure, temperature and damage of the point,
/// 3. [`Law::deform`], the stress of elastic deformation or of viscosity,
/// 4. [`Law::flow`], return to the yield surface,
/// 5. [`Law::fail`], damage.
///
/// Damage of one is failure, whichever law has brought it. At the end of stage 5 of the same step
/// failed matter lets go of tension and shear; in all later ones it has no tension after stage 1,
/// and neither shear modulus nor flow stress after stage 2, unless its strength keeps friction. What damage takes before, and what
/// failed matter keeps, is the [`FailureOptions`] of failure of the material. At last the
/// sound speed follows. With a step of zero no stage may change the state.
pub trait Law: Listed {
    /// Fields of the point that the law changes.
    const STATE: &'static [&'static str];
    /// True if the law follows the temperature.
    const NEEDS_TEMPERATURE: bool = false;
    /// True if the law needs the melting temperature of the thermal constants.
    const NEEDS_MELTING: bool = false;
    /// True if what the law does follows density, temperature or damage. Such laws act in a
    /// function of their own: inside that of the others they slow down those that have no need of
    /// them.
    const FOLLOWS_STATE: bool = false;
    /// True if matter that softens does so from an onset of this law on, and not while it is at a limit.
    const HAS_ONSET: bool = true;
    /// True if the law asks who and how large a particle is.
    const ASKS_IDENTITY: bool = false;
    /// True if damage takes a share of the law's own strength, and what has failed keeps friction.
    const KEEPS_FRICTION: bool = false;
    /// True if a law of failure adds the pressure of bulking to that of the equation of state.
    const BULKS: bool = false;
    /// True if a strength bounds the tension.
    const BOUNDS_TENSION: bool = false;

    /// True if the law follows the temperature with these constants.
    fn needs_temperature(&self) -> bool {
        Self::NEEDS_TEMPERATURE
    }

    /// True if the law needs the melting temperature with these constants.
    fn needs_melting(&self) -> bool {
        Self::NEEDS_MELTING
    }

    /// Fields of the point that the law changes with these constants.
    fn state(&self) -> &'static [&'static str] {
        Self::STATE
    }

    /// True if what the law does follows the state with these constants.
    #[inline(always)]
    fn follows_state(&self) -> bool {
        Self::FOLLOWS_STATE
    }

    /// True if the law asks how the flow stress hardens.
    #[inline(always)]
    fn asks_hardening(&self) -> bool {
        false
    }

    /// True if the law asks for the plastic strain of the neighbours.
    #[inline(always)]
    fn localises(&self) -> bool {
        false
    }

    /// Contradiction of constants that are each within their range.
    fn contradiction(&self) -> Option<Contradiction> {
        None
    }

    /// Elastic shear modulus G of the reference state (Pa); zero for a fluid.
    fn shear_modulus(&self) -> f64 {
        0.0
    }

    /// The modulus (Pa) that beside a reference bulk modulus (Pa) makes the stiffest wave, `K + 4G/3`.
    #[inline(always)]
    fn shear_modulus_beside(&self, _bulk_modulus: f64) -> f64 {
        self.shear_modulus()
    }

    /// Yield stress of the reference state (Pa); infinite for what does not yield.
    fn yield_stress(&self) -> f64 {
        f64::INFINITY
    }

    /// Dynamic viscosity (Pa s).
    fn viscosity(&self) -> f64 {
        0.0
    }

    /// The law's own melting temperature (K) at the compression `ρ/ρ₀`, if it has one.
    fn melts_at(&self, _compression: f64) -> Option<f64> {
        None
    }

    /// Bounds the pressure; `softens` tells whether matter that has reached its strength softens
    /// before it has failed.
    #[inline(always)]
    fn limit_tension(&self, _point: &mut PointBatch, _softens: bool) {}

    /// Sets moduli and softening.
    #[inline(always)]
    fn soften(&self, _point: &PointBatch, _now: &mut Conditions) {}

    /// Advances the stress as if nothing yielded.
    #[inline(always)]
    fn deform(&self, _point: &mut PointBatch, _now: &mut Conditions) {}

    /// Logarithmic derivatives of the flow stress of lane k, which has flowed, by the plastic strain and
    /// by the temperature (1/K).
    fn hardening(&self, _point: &PointBatch, _k: usize, _now: &Conditions) -> [f64; 2] {
        [0.0; 2]
    }

    /// Returns the stress to the yield surface.
    #[inline(always)]
    fn flow(&self, _point: &mut PointBatch, _now: &Conditions) {}

    /// Advances damage, in a step that is not zero. Where matter softens before it fails, this is
    /// how far it is on its way to the onset of that.
    #[inline(always)]
    fn fail(&self, _point: &mut PointBatch, _now: &Conditions) {}

    /// Advances the damage of matter that softens, beside that of matter beyond the onset.
    #[inline(always)]
    fn open(&self, _point: &mut PointBatch, _now: &Conditions) {}
}

/// Conditions that the laws of an update have in common and pass to each other.
#[derive(Debug, Clone, Copy)]
pub struct Conditions {
    /// Step (s).
    pub dt: f64,
    /// Reference density ρ₀ (kg/m³).
    pub reference_density: f64,
    /// Compression of the matter between pores over that of the whole, `α/α₀`; one without pores.
    pub packing: Lanes,
    /// Temperatures (K), where a law follows them; those of the reference state without heat.
    pub temperature: Lanes,
    /// Constants by which temperatures are judged.
    pub thermal: ThermalConstants,
    /// Temperatures (K) from which on matter is molten and fails; infinite where it does not.
    pub melting: Lanes,
    /// Shear moduli (Pa): at first those of the reference state.
    pub shear_modulus: Lanes,
    /// Share of the flow stress that is left: at first 1, all of it.
    pub softening: Lanes,
    /// Reference shear modulus G (Pa).
    pub reference_shear_modulus: f64,
    /// Reference bulk modulus K (Pa).
    pub bulk_modulus: f64,
    /// Share of stress that damage had left at the beginning of the step: stress over this is that
    /// of the material between the cracks.
    pub kept: Lanes,
    /// Growth of the cube root of damage by pores that have been crushed in the step.
    pub crushing: Lanes,
    /// Growth of the permanent compression by pores that have been crushed in the step.
    pub permanent: Lanes,
    /// Equivalent plastic strain of the step.
    pub plastic_increment: Lanes,
    /// Logarithmic derivative of the flow stress by the plastic strain, with the heat of the flow, where
    /// a law of failure asks for it.
    pub hardening: Lanes,
    /// Strengths at the pressure of the point, of a law that has two.
    pub curves: Curves,
    /// Moduli of a law with directions; at first none.
    pub stiffness: Stiffness,
    /// What members bear, of a law that has some; at first none.
    pub members: Members,
    /// Density (kg/m³) that the constants of the strength belong to: at first that of the reference state.
    pub bearing_density: f64,
    /// Options of the failure.
    pub options: FailureOptions,
    /// True if a spall limit rules where tension is all but hydrostatic.
    pub spalls: bool,
}

/// Strengths of intact and of fractured matter.
#[derive(Debug, Clone, Copy)]
pub struct Curves {
    /// Pressure above the largest tension, over the law's own scale.
    pub above: Lanes,
    /// Intact strength (Pa), at first without bound.
    pub intact: Lanes,
    /// Fractured strength (Pa), at first without bound.
    pub fractured: Lanes,
    /// Share of the intact strength at which flow begins, at first all of it.
    pub onset: Lanes,
    /// Plastic strain from which on intact matter has all of its strength, at first zero.
    pub hardened: Lanes,
}

impl Curves {
    /// Takes what `strengths` gives for the squares of the deviatoric rates of deformation (1/s²) of points that may flow:
    /// `above`, intact and fractured strength.
    #[inline(always)]
    pub(super) fn follow(
        &mut self,
        point: &PointBatch,
        strengths: impl FnOnce(&F64x8) -> [F64x8; 3],
    ) {
        let still = point.velocity_gradient == [[0.0; LANES]; 9];
        if still && point.deviatoric_stress == [[0.0; LANES]; 6] {
            // Nothing flows, whatever the strength.
            return;
        }
        let [above, intact, fractured] = strengths(&F64x8(strain_rates_squared(point)));
        *self = Self {
            above: above.0,
            intact: intact.0,
            fractured: fractured.0,
            ..*self
        };
    }

    /// Strength (Pa) of lane k at a damage.
    #[inline(always)]
    pub(super) fn at(&self, k: usize, damage: f64) -> f64 {
        (1.0 - damage) * self.intact[k] + damage * self.fractured[k]
    }
}

impl Conditions {
    /// Those of the reference state.
    #[inline(always)]
    pub(crate) fn new(
        dt: f64,
        reference_density: f64,
        [shear_modulus, bulk_modulus]: [f64; 2],
    ) -> Self {
        let thermal = ThermalConstants::ISOTHERMAL;
        Self {
            dt,
            reference_density,
            packing: [1.0; LANES],
            temperature: [thermal.reference_temperature; LANES],
            thermal,
            melting: [f64::INFINITY; LANES],
            shear_modulus: [shear_modulus; LANES],
            softening: [1.0; LANES],
            reference_shear_modulus: shear_modulus,
            bulk_modulus,
            kept: [1.0; LANES],
            crushing: [0.0; LANES],
            permanent: [0.0; LANES],
            plastic_increment: [0.0; LANES],
            hardening: [0.0; LANES],
            curves: Curves {
                above: [0.0; LANES],
                intact: [f64::MAX; LANES],
                fractured: [f64::MAX; LANES],
                onset: [1.0; LANES],
                hardened: [0.0; LANES],
            },
            stiffness: Stiffness::ZERO,
            members: Members::NONE,
            bearing_density: reference_density,
            options: FailureOptions::DEFAULT,
            spalls: false,
        }
    }

    /// Reference size of the point (m) in lane k: edge of the cube, square or length that its mass
    /// fills at the reference density.
    #[inline(always)]
    pub(crate) fn size(&self, point: &PointBatch, k: usize) -> f64 {
        let filled = point.mass[k] / self.reference_density;
        match self.options.dimension {
            1 => filled,
            2 => filled.sqrt(),
            _ => libm::cbrt(filled),
        }
    }
}

/// Makes [`Strength`](super::Strength) of its table.
macro_rules! strength_laws {
    ($( $(#[doc = $doc:literal])+ $key:ident: $law:ident; )+) => {
        /// The resistance of a material to shear.
        #[derive(Debug, Clone, PartialEq)]
        pub enum Strength {
            /// No shear stress: a fluid.
            None,
            $( $(#[doc = $doc])+ $law($law), )+
        }

        impl Strength {
            /// Elastic shear modulus G of the reference state (Pa); zero for a fluid.
            #[inline(always)]
            #[must_use]
            pub fn shear_modulus(&self) -> f64 {
                match self {
                    Self::None => 0.0,
                    $( Self::$law(law) => law.shear_modulus(), )+
                }
            }

            /// The modulus (Pa) that beside a reference bulk modulus (Pa) makes the stiffest wave; zero for a fluid.
            #[inline(always)]
            #[must_use]
            pub fn shear_modulus_beside(&self, bulk_modulus: f64) -> f64 {
                match self {
                    Self::None => 0.0,
                    $( Self::$law(law) => law.shear_modulus_beside(bulk_modulus), )+
                }
            }

            /// Yield stress of the reference state (Pa); infinite for what does not yield.
            #[must_use]
            pub fn yield_stress(&self) -> f64 {
                match self {
                    Self::None => f64::INFINITY,
                    $( Self::$law(law) => law.yield_stress(), )+
                }
            }

            /// Dynamic viscosity (Pa s); zero for all but a viscous fluid.
            #[must_use]
            pub fn viscosity(&self) -> f64 {
                match self {
                    Self::None => 0.0,
                    $( Self::$law(law) => law.viscosity(), )+
                }
            }

            /// True if the law follows the temperature.
            #[must_use]
            pub fn needs_temperature(&self) -> bool {
                match self {
                    Self::None => false,
                    $( Self::$law(law) => law.needs_temperature(), )+
                }
            }

            /// True if the law needs the melting temperature of the thermal constants.
            #[must_use]
            pub fn needs_melting(&self) -> bool {
                match self {
                    Self::None => false,
                    $( Self::$law(law) => law.needs_melting(), )+
                }
            }

            /// The law's own melting temperature (K) at the compression `ρ/ρ₀`, if it has one.
            #[must_use]
            pub fn melts_at(&self, compression: f64) -> Option<f64> {
                match self {
                    Self::None => None,
                    $( Self::$law(law) => law.melts_at(compression), )+
                }
            }

            /// Logarithmic derivatives of the flow stress of lane k, which has flowed, by the plastic
            /// strain and by the temperature (1/K).
            pub(in crate) fn hardening(&self, point: &PointBatch, k: usize, now: &Conditions) -> [f64; 2] {
                match self {
                    Self::None => [0.0; 2],
                    $( Self::$law(law) => law.hardening(point, k, now), )+
                }
            }

            /// Fields of the point that the law changes.
            #[must_use]
            pub fn state(&self) -> &'static [&'static str] {
                match self {
                    Self::None => &["deviatoric_stress"],
                    $( Self::$law(_) => $law::STATE, )+
                }
            }

            /// True if what has failed keeps the friction that the law gives it.
            #[must_use]
            pub fn keeps_friction(&self) -> bool {
                match self {
                    Self::None => false,
                    $( Self::$law(_) => $law::KEEPS_FRICTION, )+
                }
            }

            /// True if the law bounds the tension.
            #[inline(always)]
            #[must_use]
            pub fn bounds_tension(&self) -> bool {
                match self {
                    Self::None => false,
                    $( Self::$law(_) => $law::BOUNDS_TENSION, )+
                }
            }

            /// Stage 1, before that of failure.
            #[inline(always)]
            pub(in crate) fn limit_tension(&self, point: &mut PointBatch) {
                match self {
                    $( Self::$law(law) if $law::BOUNDS_TENSION => law.limit_tension(point, false), )+
                    _ => {}
                }
            }

            /// True if the material yields.
            #[must_use]
            pub fn yields(&self) -> bool {
                self.state().contains(&"plastic_strain")
            }

            /// Key of the law in the input and its constants; nothing for a fluid.
            #[must_use]
            pub fn constants(&self) -> Option<(&'static str, $crate::Constants)> {
                match self {
                    Self::None => None,
                    $( Self::$law(law) => Some((stringify!($key), law.constants())), )+
                }
            }

            #[inline(always)]
            pub(in crate) fn follows_state(&self) -> bool {
                match self {
                    Self::None => false,
                    $( Self::$law(_) => $law::FOLLOWS_STATE, )+
                }
            }

            /// Stages 2 to 4 of the law, and the second of `failure`. Without `ALL`, only of laws
            /// that do not follow the state.
            #[inline(always)]
            pub(in crate) fn act<const ALL: bool>(
                &self,
                point: &mut PointBatch,
                now: &mut Conditions,
                failure: &Failure,
            ) {
                match self {
                    Self::None => point.deviatoric_stress = [[0.0; LANES]; 6],
                    $( Self::$law(law) if ALL || !$law::FOLLOWS_STATE => {
                        law.soften(point, now);
                        if ALL {
                            failure.soften(point, now);
                        }
                        law.deform(point, now);
                        law.flow(point, now);
                    } )+
                    #[allow(unreachable_patterns, reason = "if no law follows the state")]
                    _ => {}
                }
            }
        }
    };
}
pub(super) use strength_laws;

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use crate::point_fields;
    use crate::{
        AfterSpall, Crosses, Effect, Eos, Failure, Flaws, GradyKipp, LANES, PointBatch,
        PrincipalStress, Spall, library,
    };

    macro_rules! values {
        ($( $(#[doc = $doc:literal])+ $name:ident: $kind:ident, $role:ident; )+) => {
            /// Names, roles and exact values of all fields.
            fn values(point: &PointBatch) -> Vec<(&'static str, &'static str, String)> {
                vec![$( (stringify!($name), stringify!($role), format!("{:?}", point.$name)), )+]
            }
        };
    }
    point_fields!(values);

    /// A strong load in all directions; the laws of failure are as weak.
    fn loaded(density: f64) -> PointBatch {
        let ramp = |c: u8, middle: f64| f64::from(c) - middle;
        PointBatch {
            density: [0.99 * density; LANES],
            velocity_gradient: [0, 1, 2, 3, 4, 5, 6, 7, 8].map(|c| [1e4 * ramp(c, 3.5); LANES]),
            deviatoric_stress: [0, 1, 2, 3, 4, 5].map(|c| [1e5 * ramp(c, 1.5); LANES]),
            plastic_strain: [0.01; LANES],
            mass: [1e-6; LANES],
            ..PointBatch::ZERO
        }
    }

    /// One law of failure after the other, and softening.
    fn failures() -> Vec<Failure> {
        let default = Failure::NONE;
        let spall = |after| Failure {
            spall: Some(Spall {
                pressure: -1e6,
                after,
            }),
            ..default
        };
        let mut softens = spall(AfterSpall::Failed);
        softens.options.fracture_energy = 1e5;
        softens.options.effect = Effect::Scaled;
        let mut cracks = default;
        cracks.options.effect = Effect::Scaled;
        cracks.grady_kipp = Some(GradyKipp {
            k: 1e20,
            m: 2.0,
            crack_speed: 0.4,
            crosses: Crosses::Particle,
            flaws: Flaws::Drawn,
            most_flaws: 0.0,
            least_size: 0.0,
        });
        vec![
            spall(AfterSpall::Hold),
            spall(AfterSpall::Failed),
            softens,
            cracks,
            Failure {
                principal_stress: Some(PrincipalStress { limit: 1e5 }),
                ..default
            },
        ]
    }

    /// The laws of each material of the library change the state that they name, and no other.
    #[test]
    fn laws_change_the_state_that_they_name() {
        for failure in failures() {
            for name in library::names() {
                let mut material = library::find(name).unwrap();
                let brittle = failure.grady_kipp.is_some();
                if brittle && material.strength.shear_modulus() == 0.0 {
                    continue;
                }
                // Matter with directions has the stress of its own strain, which is none here.
                material.failure = if material.has_directions() {
                    Failure::NONE
                } else {
                    failure
                };
                let mut point = loaded(material.reference_density);
                let before = values(&point);
                material.update(&mut point, 1e-5);
                let after = values(&point);
                let changed = before.iter().zip(&after).filter(|(a, b)| a != b);
                let changed = changed.filter(|((_, role, _), _)| *role != "Answer");
                let mut changed: BTreeSet<&str> = changed.map(|((name, _, _), _)| *name).collect();
                let mut named: BTreeSet<&str> = material.strength.state().iter().copied().collect();
                if material.porosity.is_some() {
                    named.insert("distension");
                }
                if material.has_directions() {
                    // Only what is pressed crushes, and how it is pressed here depends on its moduli.
                    named.extend(changed.get("plastic_strain"));
                    changed.extend(named.get("plastic_strain"));
                }
                // Neither gas, burnt or not, nor soil bears a tension that it could fail by here.
                let mut pulled = PointBatch {
                    pressure: [-2e6; LANES],
                    ..PointBatch::ZERO
                };
                material.strength.limit_tension(&mut pulled);
                let tension = -pulled.pressure[0];
                if 0.0 < tension && tension < 1e6 {
                    continue; // It bears too little to fail.
                }
                let bears = tension > 0.0;
                if material.burns() {
                    named.extend(["burn", "lighting_time"]);
                } else if bears && !matches!(material.eos, Eos::IdealGas(_)) {
                    named.extend(material.failure.state());
                }
                assert_eq!(changed, named, "{name} {failure:?}");
            }
        }
    }
}
