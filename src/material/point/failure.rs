//! Failure of a material: its laws of failure together, and their common options.

use serde::Deserialize;

use crate::at_least;
use crate::declare::{Constants, Value};
use numerics::counter::exponential;

/// Damage of matter that has failed.
pub const FAILED: f64 = 1.0;

/// Speed (m/s) of the artificial viscosity at a point, from that of its linear part (m/s), the pressure (Pa) and the
/// damage.
///
/// It is zero in failed matter without pressure, which bears no stress and has no waves that viscosity could damp, and
/// positive elsewhere, in a cold gas too.
#[inline(always)]
#[must_use]
pub fn viscous_speed(linear: f64, pressure: f64, damage: f64) -> f64 {
    if damage >= FAILED && pressure == 0.0 {
        0.0
    } else {
        at_least(linear, f64::MIN_POSITIVE)
    }
}

/// Loss of failed material.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Effect {
    /// All but pressure, once damage is one: it has neither shear nor tension.
    #[default]
    StrengthLost,
    /// The same, but shear and tension fade as damage grows: they scale with `1 − D`.
    Scaled,
    /// Tension alone, once damage is one: its largest principal stresses are zero at most.
    TensionLost,
    /// Tension, which scales with `1 − D`, and cohesion: shear is that of the damaged curve of the
    /// strength, under pressure.
    FrictionKept,
}

impl Effect {
    /// Its name in the input.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::StrengthLost => "strength_lost",
            Self::Scaled => "scaled",
            Self::TensionLost => "tension_lost",
            Self::FrictionKept => "friction_kept",
        }
    }
}

/// Behaviour, once molten, of material that follows the temperature and may fail.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Molten {
    /// It fails as soon as nothing presses it.
    #[default]
    Fails,
    /// It bears tension as solid matter does.
    Holds,
}

impl Molten {
    /// Its name in the input.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Fails => "fails",
            Self::Holds => "holds",
        }
    }
}

/// Common options of the laws of failure of a material.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FailureOptions {
    /// Loss of failed material.
    pub effect: Effect,
    /// Energy that opens a crack, `G_f` (J/m²): from its strength on, matter softens until it has
    /// taken this. Zero if it fails at once.
    pub fracture_energy: f64,
    /// Weibull modulus by which the failure strains of particles scatter; zero if they do not.
    pub scatter: f64,
    /// First word of the draws of scatter and flaws.
    pub seed: u32,
    /// Behaviour of molten material; if it is not said, that of [`Molten::Fails`] where a law follows the temperature.
    pub molten: Option<Molten>,
    /// Dimension of the model: by it the mass of a particle tells its size.
    pub dimension: u8,
}

impl FailureOptions {
    /// That of a material whose case says nothing else.
    pub const DEFAULT: Self = Self {
        effect: Effect::StrengthLost,
        fracture_energy: 0.0,
        scatter: 0.0,
        seed: 1,
        molten: None,
        dimension: 3,
    };

    /// True if matter that has failed still bears shear.
    #[inline(always)]
    #[must_use]
    pub fn keeps_shear(&self) -> bool {
        matches!(self.effect, Effect::TensionLost | Effect::FrictionKept)
    }

    /// True if matter that has reached its strength softens before it has failed.
    #[inline(always)]
    #[must_use]
    pub fn softens(&self) -> bool {
        self.fracture_energy > 0.0
    }

    /// True if tension fades as damage grows.
    #[inline(always)]
    #[must_use]
    pub fn fades(&self) -> bool {
        matches!(self.effect, Effect::Scaled | Effect::FrictionKept)
    }

    /// Share of tension that damage takes, and of shear if friction does not stay.
    #[inline(always)]
    #[must_use]
    pub fn taken(&self, damage: f64) -> f64 {
        if damage >= FAILED {
            1.0
        } else if self.fades() {
            damage
        } else {
            0.0
        }
    }

    /// By how much the failure strain of the particle `id` is larger than that of the law: drawn
    /// from Weibull's distribution of median one (Weibull 1951, J. Appl. Mech. 18, 293).
    #[inline(always)]
    #[must_use]
    pub fn strain_factor(&self, id: u64) -> f64 {
        if self.scatter > 0.0 {
            let drawn = exponential([u64::from(self.seed), SCATTER, id]);
            libm::pow(drawn / std::f64::consts::LN_2, 1.0 / self.scatter)
        } else {
            1.0
        }
    }

    /// Options that differ from the default, by the keys of the input.
    pub(super) fn constants(&self) -> Constants {
        let default = Self::DEFAULT;
        let rows = [
            (
                self.effect != default.effect,
                ("effect", Value::Word(self.effect.name())),
            ),
            (
                self.softens(),
                (
                    "fracture_energy",
                    Value::Number(self.fracture_energy, "J/m^2"),
                ),
            ),
            (
                self.scatter > 0.0,
                ("scatter", Value::Number(self.scatter, "")),
            ),
            (
                self.seed != default.seed,
                ("seed", Value::Number(f64::from(self.seed), "")),
            ),
        ];
        let given = rows.into_iter().filter(|(differs, _)| *differs);
        let molten = self.molten.map(|word| ("molten", Value::Word(word.name())));
        given.map(|(_, row)| row).chain(molten).collect()
    }
}

impl Default for FailureOptions {
    fn default() -> Self {
        Self::DEFAULT
    }
}

/// Key of the draws that scatter failure strains.
const SCATTER: u64 = 0x5343_4154;

/// Makes [`Failure`](super::Failure) of its table.
macro_rules! failure_laws {
    ($( $(#[doc = $doc:literal])+ $key:ident: $law:ident; )+) => {
        /// Laws of failure of a material.
        #[derive(Debug, Clone, Copy, Default, PartialEq)]
        pub struct Failure {
            $( $(#[doc = $doc])+ pub $key: Option<$law>, )+
            /// Their common options.
            pub options: FailureOptions,
        }

        impl Failure {
            /// Never.
            pub const NONE: Self = Self { $( $key: None, )+ options: FailureOptions::DEFAULT };

            /// That of a liquid: it cavitates where its pressure would fall below zero, and closes again.
            pub const CAVITATES: Self = Self {
                spall: Some(Spall { pressure: 0.0, after: AfterSpall::Hold }),
                ..Self::NONE
            };

            /// True if the material never fails.
            #[must_use]
            pub fn is_none(&self) -> bool {
                true $( && self.$key.is_none() )+
            }

            /// Fields of the point that the laws change.
            pub fn state(&self) -> impl Iterator<Item = &'static str> {
                let laws = [$( self.$key.as_ref().map_or(&[][..], |law| law.state()), )+];
                let own: &[_] = if self.has_onset() { &["failure_onset"] } else { &[] };
                laws.into_iter().flatten().chain(own).copied()
            }

            /// True if a law changes the state, so that what has failed stays so.
            #[must_use]
            pub fn has_memory(&self) -> bool {
                self.state().next().is_some()
            }

            /// True if a law asks who and how large a particle is.
            #[must_use]
            pub fn asks_identity(&self) -> bool {
                self.options.softens() || self.options.scatter > 0.0
                    $( || $law::ASKS_IDENTITY && self.$key.is_some() )+
            }

            /// True if a law asks how the flow stress hardens, to find the onset of softening.
            #[inline(always)]
            pub(in crate) fn asks_hardening(&self) -> bool {
                self.options.softens()
                    && (false $( || self.$key.is_some_and(|law| law.asks_hardening()) )+)
            }

            /// True if matter softens where deformation localises: a law asks for the plastic strain of the neighbours.
            #[inline(always)]
            #[must_use]
            pub fn localises(&self) -> bool {
                self.options.softens()
                    && (false $( || self.$key.is_some_and(|law| law.localises()) )+)
            }

            /// True if a law follows the temperature.
            #[must_use]
            pub fn needs_temperature(&self) -> bool {
                self.options.molten == Some(Molten::Fails)
                    $( || self.$key.is_some_and(|law| law.needs_temperature()) )+
            }

            /// True if a law needs the melting temperature of the thermal constants.
            #[must_use]
            pub fn needs_melting(&self) -> bool {
                false $( || $law::NEEDS_MELTING && self.$key.is_some_and(|law| law.needs_temperature()) )+
            }

            /// Keys of the laws in the input and their constants; those that the laws have in common
            /// have an empty key.
            #[must_use]
            pub fn constants(&self) -> Vec<(&'static str, $crate::Constants)> {
                let laws = [$( self.$key.map(|law| (stringify!($key), law.constants())), )+];
                let laws = laws.into_iter().flatten();
                laws.chain([("", self.options.constants())]).collect()
            }

            /// True if matter softens from an onset on.
            fn has_onset(&self) -> bool {
                self.options.softens()
                    && (false $( || $law::HAS_ONSET && self.$key.is_some_and(|law| law.follows_state()) )+)
            }

            #[inline(always)]
            pub(in crate) fn follows_state(&self) -> bool {
                false $( || $law::FOLLOWS_STATE && self.$key.is_some_and(|law| law.follows_state()) )+
            }

            /// Adds the pressure of bulking to that of the equation of state.
            #[inline(always)]
            pub(in crate) fn bulk(&self, point: &mut PointBatch) {
                if false $( || $law::BULKS && self.$key.is_some() )+ {
                    for k in 0..LANES {
                        point.pressure[k] += point.bulking_pressure[k];
                    }
                }
            }

            /// Stage 1.
            #[inline(always)]
            pub(in crate) fn limit_tension(&self, point: &mut PointBatch) {
                let softens = self.options.softens();
                $( if let Some(law) = &self.$key {
                    law.limit_tension(point, softens);
                } )+
                if self.follows_state() {
                    damage::limit_tension(point, &self.options);
                }
            }

            /// Stage 2.
            #[inline(always)]
            pub(super) fn soften(&self, point: &PointBatch, now: &mut Conditions) {
                $( if let Some(law) = &self.$key {
                    law.soften(point, now);
                } )+
                if self.follows_state() {
                    damage::soften(point, now);
                }
            }

            /// Stage 5, with the bulk modulus of the state (Pa).
            #[inline(always)]
            pub(in crate) fn fail(
                &self,
                point: &mut PointBatch,
                now: &mut Conditions,
                bulk_modulus: &Lanes,
            ) {
                let before = point.damage;
                if now.dt != 0.0 {
                    let softens = self.options.softens();
                    let onset = point.failure_onset;
                    if softens {
                        std::mem::swap(&mut point.damage, &mut point.failure_onset);
                    }
                    $( if let Some(law) = &self.$key {
                        law.fail(point, now);
                    } )+
                    if softens {
                        damage::reach_onset(point, &onset);
                        std::mem::swap(&mut point.damage, &mut point.failure_onset);
                        damage::open_cracks(point, now);
                        $( if let Some(law) = &self.$key {
                            law.open(point, now);
                        } )+
                    }
                    damage::crush(point, now);
                    damage::melt(point, now);
                    damage::end(point);
                }
                damage::let_go(point, now, &before, bulk_modulus);
            }
        }
    };
}
pub(super) use failure_laws;

#[cfg(test)]
mod tests {
    use super::viscous_speed;

    #[test]
    fn only_dust_has_no_viscosity() {
        assert_eq!(viscous_speed(5e3, 0.0, 1.0), 0.0);
        assert_eq!(viscous_speed(5e3, -0.0, 1.0), 0.0);
        for (pressure, damage) in [(1.0, 1.0), (0.0, 0.9), (-1.0, 0.0)] {
            assert_eq!(viscous_speed(5e3, pressure, damage), 5e3);
        }
        assert!(viscous_speed(0.0, 0.0, 0.0) > 0.0, "a cold gas closes");
        assert!(viscous_speed(f64::NAN, 0.0, 0.0).is_nan());
    }
}
