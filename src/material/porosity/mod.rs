//! Porosity below the size of particles: a matrix of solid matter with pores, which crush for good.
//!
//! The distension `α = ρ_s/ρ` is the density of the solid between the pores over that of the whole.
//! With the equation of state `p_s` of the solid the pressure of the whole is
//!
//! ```text
//! p = p_s(α ρ, e)/α
//! ```
//!
//! (Herrmann 1969, J. Appl. Phys. 40, 2490; the factor 1/α of Carroll & Holt 1972, J. Appl. Phys. 43,
//! 759). A law of compaction gives α. [`PAlpha`] makes it a function of the pressure, [`EpsilonAlpha`] of
//! the volumetric strain, and [`HolmquistJohnsonCookCompaction`] gives the pressure of concrete. In all, matter loads and unloads elastically up to the place on the crush
//! curve that it has reached, and beyond it the place moves and never returns.
//!
//! The reference density of a porous material is that of the whole, `ρ₀ = ρ_s0/α₀`: masses, volumes of
//! contact and sizes of particles follow from it. The solid's density is known here alone.
//!
//! A law is a file that implements [`CompactionLaw`]; its row here gives it a name and a key of the
//! input, its rows in `input/schema/materials.rs` its constants.

use serde::Deserialize;

use super::eos::{Eos, EquationOfState, PointResponse, Response};
use super::{Contradiction, LANES, Lanes, Listed, PointBatch, at_least, at_most};
use crate::declare::{Constants, Value};

/// Meaning of the constants of the strength of a porous material.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum StrengthOf {
    /// They are those of the whole, measured on porous matter.
    #[default]
    Whole,
    /// They are those of the solid between the pores: the deviatoric stress of the whole is `1/α` of
    /// the solid's (Jutzi, Benz & Michel 2008).
    Matrix,
}

impl StrengthOf {
    /// Its name in the input.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Whole => "whole",
            Self::Matrix => "matrix",
        }
    }
}

/// Effect of compaction on damage.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum CompactionDamage {
    /// Pores crush without damage.
    #[default]
    None,
    /// Damage grows as pores crush, and is one without pores.
    Crushed,
}

impl CompactionDamage {
    /// Its name in the input.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Crushed => "crushed",
        }
    }
}

/// Matter with pores.
#[derive(Debug, Clone, PartialEq)]
pub struct Porosity {
    /// Distension α₀ of virgin matter.
    pub distension: f64,
    /// Reference density ρ₀ of the whole (kg/m³).
    pub density: f64,
    /// What the constants of the strength belong to.
    pub strength: StrengthOf,
    /// What crushing damages.
    pub damage: CompactionDamage,
    /// Distension from pressure or strain.
    pub law: Compaction,
    /// The solid between the pores.
    pub solid: Solid,
}

/// Bulk modulus (Pa) of a density (kg/m³) and the bulk sound speed (m/s) of virgin matter; zero for that of the solid.
fn modulus(density: f64, sound_speed: f64, solid: &Solid) -> f64 {
    let speed = if sound_speed == 0.0 {
        solid.sound_speed()
    } else {
        sound_speed
    };
    density * speed * speed
}

/// Reference state of the solid between pores.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Solid {
    /// Density `ρ_s0` (kg/m³).
    pub density: f64,
    /// Bulk modulus `K_s` (Pa).
    pub bulk_modulus: f64,
}

impl Solid {
    /// Bulk sound speed (m/s).
    #[must_use]
    pub fn sound_speed(&self) -> f64 {
        (self.bulk_modulus / self.density).sqrt()
    }
}

/// One porous point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PorousPoint {
    /// Pressure of the whole and its elastic derivatives.
    pub response: PointResponse,
    /// Distension α.
    pub distension: f64,
    /// How far the point has come along the crush curve, from zero to one.
    pub compaction: f64,
    /// Share of a strain of the whole that strains the solid, `∂ ln(α ρ)/∂ ln ρ`.
    pub share: f64,
    /// Growth of the permanent compression, that of the whole without pressure.
    pub crushed: f64,
}

/// The state of a point that a law of compaction works on.
pub struct PoreState<'a> {
    /// α₀.
    pub(super) distension: f64,
    pub(super) solid: &'a Solid,
    /// Density over that of the reference state, as `ρ/ρ₀`.
    pub(super) compression: f64,
    /// Density (kg/m³).
    pub(super) density: f64,
    /// How far the point has come along the crush curve.
    pub(super) compaction: f64,
    /// False if pores may not crush now.
    pub(super) crushes: bool,
}

/// A law of compaction.
pub trait CompactionLaw: Listed {
    /// Contradiction of constants that are each within their range.
    fn contradiction(&self) -> Option<Contradiction>;

    /// Contradiction of constants with the distension α₀ and the solid.
    fn contradicts(&self, distension: f64, solid: &Solid) -> Option<Contradiction>;

    /// Bulk modulus (Pa) of virgin matter of the whole, whose density is `density` (kg/m³).
    fn bulk_modulus(&self, density: f64, solid: &Solid) -> f64;

    /// Distension of a place on the crush curve.
    fn crushed(&self, distension: f64, solid: &Solid, compaction: f64) -> f64;

    /// Permanent compression `ρ/ρ₀ − 1` of a place on the crush curve.
    #[inline]
    fn permanent(
        &self,
        at: &PoreState,
        _solid: &impl Fn(f64) -> PointResponse,
        compaction: f64,
    ) -> f64 {
        at.distension / self.crushed(at.distension, at.solid, compaction) - 1.0
    }

    /// The point at a density, with the solid's response as a function of the solid's density (kg/m³).
    fn advance(&self, at: &PoreState, solid: impl Fn(f64) -> PointResponse) -> PorousPoint;
}

/// Makes [`Compaction`] of its table.
macro_rules! laws {
    ($( $(#[doc = $doc:literal])+ $key:ident: $law:ident; )+) => {
        $( mod $key; )+
        $( pub use $key::$law; )+

        /// Law of compaction of a porous material.
        #[derive(Debug, Clone, PartialEq)]
        pub enum Compaction {
            $( $(#[doc = $doc])+ $law($law), )+
        }

        impl Compaction {
            /// Key of the law in the input and its constants.
            #[must_use]
            pub fn constants(&self) -> (&'static str, Constants) {
                match self {
                    $( Self::$law(law) => (stringify!($key), law.constants()), )+
                }
            }

            /// See [`CompactionLaw::contradicts`].
            #[must_use]
            pub fn contradicts(&self, distension: f64, solid: &Solid) -> Option<Contradiction> {
                match self {
                    $( Self::$law(law) => law.contradicts(distension, solid), )+
                }
            }

            fn bulk_modulus(&self, density: f64, solid: &Solid) -> f64 {
                match self {
                    $( Self::$law(law) => law.bulk_modulus(density, solid), )+
                }
            }

            #[inline]
            fn crushed(&self, distension: f64, solid: &Solid, compaction: f64) -> f64 {
                match self {
                    $( Self::$law(law) => law.crushed(distension, solid, compaction), )+
                }
            }
        }

        impl Porosity {
            /// All points of a batch at its densities and specific energies.
            #[inline(never)]
            pub(super) fn of_batch<E: EquationOfState>(
                &self,
                eos: &E,
                batch: &PointBatch,
                crushes: bool,
            ) -> [PorousPoint; LANES] {
                match &self.law {
                    $( Compaction::$law(law) => {
                        std::array::from_fn(|k| {
                            let state = [batch.density[k], batch.specific_energy[k], batch.compaction[k]];
                            self.by_law(law, eos, state, crushes)
                        })
                    } )+
                }
            }

            /// A point that was virgin, of a density (kg/m³) and a specific energy (J/kg).
            pub(super) fn first<E: EquationOfState>(
                &self,
                eos: &E,
                [density, energy]: [f64; 2],
                crushes: bool,
            ) -> PorousPoint {
                match &self.law {
                    $( Compaction::$law(law) => {
                        self.by_law(law, eos, [density, energy, 0.0], crushes)
                    } )+
                }
            }
        }
    };
}

// The key below `porosity` in the input, and the law. A porous material has one of them.
laws! {
    /// Distension as a function of the pressure.
    p_alpha: PAlpha;
    /// Distension as a function of the volumetric strain.
    epsilon_alpha: EpsilonAlpha;
    /// Crushing of concrete between two points.
    holmquist_johnson_cook: HolmquistJohnsonCookCompaction;
}

/// Regularisation δ of the damage by compaction (Jutzi, Benz & Michel 2008).
const DELTA: f64 = 0.01;

impl Porosity {
    /// That of a law of compaction and an equation of state whose solid has the density `density` (kg/m³).
    #[must_use]
    pub fn new(distension: f64, law: Compaction, density: f64, eos: &Eos) -> Self {
        let whole = density / distension;
        // The product to the bit, so that virgin matter has no pressure.
        let density = distension * whole;
        Self {
            distension,
            density: whole,
            strength: StrengthOf::default(),
            damage: CompactionDamage::default(),
            law,
            solid: Solid {
                density,
                bulk_modulus: eos.bulk_modulus(density),
            },
        }
    }

    /// Bulk modulus (Pa) of virgin matter of the whole.
    #[must_use]
    pub fn bulk_modulus(&self) -> f64 {
        self.law.bulk_modulus(self.density, &self.solid)
    }

    /// Share of the shear modulus of the strength that virgin matter of the whole has.
    #[must_use]
    pub fn shear_share(&self) -> f64 {
        match self.strength {
            StrengthOf::Whole => 1.0,
            StrengthOf::Matrix => 1.0 / self.distension,
        }
    }

    /// The distension of a particle, α₀ where none has been set.
    #[inline]
    #[must_use]
    pub fn known(&self, distension: f64) -> f64 {
        if distension == 0.0 {
            self.distension
        } else {
            distension
        }
    }

    /// The constants by the keys of the input.
    #[must_use]
    pub fn constants(&self) -> Vec<(String, Value)> {
        let mut rows = vec![("distension".to_owned(), Value::Number(self.distension, ""))];
        if self.strength != StrengthOf::default() {
            rows.push(("strength".to_owned(), Value::Word(self.strength.name())));
        }
        if self.damage != CompactionDamage::default() {
            rows.push(("damage".to_owned(), Value::Word(self.damage.name())));
        }
        let (law, constants) = self.law.constants();
        let of_law = constants.into_iter();
        rows.extend(of_law.map(|(key, value)| (format!("{law}.{key}"), value)));
        rows
    }

    /// A point of a density (kg/m³), specific energy (J/kg) and compaction by one law.
    #[inline(always)]
    fn by_law<L: CompactionLaw, E: EquationOfState>(
        &self,
        law: &L,
        eos: &E,
        [density, energy, compaction]: [f64; 3],
        crushes: bool,
    ) -> PorousPoint {
        let at = self.state(density, compaction, crushes);
        let solid = |rho| eos.at(self.solid.density, rho, energy);
        let mut point = law.advance(&at, solid);
        if point.compaction > at.compaction {
            point.crushed = law.permanent(&at, &solid, point.compaction)
                - law.permanent(&at, &solid, at.compaction);
        }
        point
    }

    fn state(&self, density: f64, compaction: f64, crushes: bool) -> PoreState<'_> {
        PoreState {
            distension: self.distension,
            solid: &self.solid,
            compression: density / self.density,
            density,
            compaction,
            crushes,
        }
    }

    /// Pressures and derivatives of a batch, whose distension and compaction become those of its
    /// densities and energies, the shares of strain that the solid takes, and the growth of the permanent
    /// compression. Pores crush if `crushes`.
    pub(super) fn respond(
        &self,
        eos: &Eos,
        batch: &mut PointBatch,
        crushes: bool,
    ) -> (Response, [Lanes; 2]) {
        let points = eos.porous(self, batch, crushes);
        let (mut response, mut shares) = (Response::default(), [0.0; LANES]);
        let mut crushed = [0.0; LANES];
        for (k, point) in points.iter().enumerate() {
            response.set(k, point.response);
            batch.distension[k] = point.distension;
            batch.compaction[k] = point.compaction;
            shares[k] = point.share;
            crushed[k] = point.crushed;
        }
        (response, [shares, crushed])
    }

    /// Growth of the cube root of damage as compaction rises from `before` to `after`: the
    /// integral of Jutzi, Benz & Michel (2008), equation for `dD^{1/3}/dt` with
    /// `D = 1 − (α − 1)/(α₀ − 1)` but for a regularisation at its beginning.
    #[inline]
    pub(super) fn damage(&self, before: f64, after: f64) -> f64 {
        if self.damage == CompactionDamage::None || before >= after {
            return 0.0;
        }
        if after >= 1.0 {
            return 1.0;
        }
        let first = self.law.crushed(self.distension, &self.solid, 0.0) - 1.0;
        let root = |compaction: f64| {
            let left = self.law.crushed(self.distension, &self.solid, compaction) - 1.0;
            libm::cbrt(1.0 - left / first + DELTA)
        };
        (root(after) - root(before)) / (libm::cbrt(1.0 + DELTA) - libm::cbrt(DELTA))
    }
}

/// Most evaluations of a root; Newton's rule takes three to eight.
const MOST: usize = 100;

/// The root of a function that rises from `low` to `high`, from its value and slope: by Newton's rule
/// kept in its bracket. A function of its arguments alone.
#[inline]
fn root(mut low: f64, mut high: f64, start: f64, f: impl Fn(f64) -> [f64; 2]) -> f64 {
    let mut x = start;
    for _ in 0..MOST {
        let [value, slope] = f(x);
        if value == 0.0 {
            break;
        }
        if value > 0.0 {
            high = x;
        } else {
            low = x;
        }
        let newton = x - value / slope;
        // At the root itself a step of nothing ends on the bracket.
        let inside = low <= newton && newton <= high;
        let next = if inside { newton } else { 0.5 * (low + high) };
        let step = (next - x).abs();
        x = next;
        if step <= 4.0 * f64::EPSILON * x.abs() {
            break;
        }
    }
    x
}

/// Pressure and derivatives of the whole at a distension whose derivative by the pressure is `slope`
/// (1/Pa, zero or negative), and the solid's share of a strain.
#[inline]
fn whole(solid: &PointResponse, density: f64, distension: f64, slope: f64) -> (PointResponse, f64) {
    let pressure = solid.pressure / distension;
    // α dp + p dα = dp_s: what a softer matrix takes off is never added to.
    let stiff = at_least(
        distension + slope * (pressure - density * solid.dp_drho),
        distension,
    );
    let dp_drho = distension * solid.dp_drho / stiff;
    let share = at_least(
        at_most(1.0 + density / distension * slope * dp_drho, 1.0),
        0.0,
    );
    let response = PointResponse {
        pressure,
        dp_drho,
        dp_de: solid.dp_de / stiff,
    };
    (response, share)
}
