//! Typed values of keys that want a unit.

use std::fmt;
use std::marker::PhantomData;

use serde::de::{Deserialize, Deserializer, Error, Visitor};
use toml::Spanned;

use model::readable::short;
use model::units::{Powers, parse, unit_of};

/// The dimension of plain numbers.
pub(super) const PLAIN: Powers = [0; 5];

/// Names of dimensions, to say what was found where something else was expected.
const NAMES: &[(Powers, &str)] = &[
    (PLAIN, "a plain number"),
    (Length::POWERS, Length::NAME),
    (Time::POWERS, Time::NAME),
    (Velocity::POWERS, Velocity::NAME),
    (Density::POWERS, Density::NAME),
    (Pressure::POWERS, Pressure::NAME),
    (Angle::POWERS, Angle::NAME),
    (Temperature::POWERS, Temperature::NAME),
    (SpecificEnergy::POWERS, SpecificEnergy::NAME),
    (SpecificHeat::POWERS, SpecificHeat::NAME),
    (Viscosity::POWERS, Viscosity::NAME),
    (Rate::POWERS, Rate::NAME),
    (PerPressure::POWERS, PerPressure::NAME),
    (PerTemperature::POWERS, PerTemperature::NAME),
    (Mass::POWERS, Mass::NAME),
    (Acceleration::POWERS, Acceleration::NAME),
    (ArealMass::POWERS, ArealMass::NAME),
    (FractureEnergy::POWERS, FractureEnergy::NAME),
    (NumberDensity::POWERS, NumberDensity::NAME),
    ([1, 1, -2, 0, 0], "a force"),
    ([2, 1, -2, 0, 0], "an energy"),
];

/// A length cannot count more particle spacings.
const MOST_SPACINGS: f64 = 1e12;

/// A kind of quantity that an input key can ask for.
pub trait Kind {
    /// Its dimension.
    const POWERS: Powers;
    /// With its article, for messages.
    const NAME: &'static str;
    /// Example of one.
    const EXAMPLE: &'static str;
    /// No value is as large, in SI units, and why: a slip in a number or in its unit is reported
    /// before it makes infinities.
    const BEYOND: (f64, &'static str);
}

macro_rules! kinds {
    ($($(#[$doc:meta])+ $kind:ident = $powers:expr, $name:literal, $example:literal, $most:literal $why:literal;)+) => { $(
        $(#[$doc])+
        #[derive(Debug, Clone, Copy)]
        pub struct $kind;
        impl Kind for $kind {
            const POWERS: Powers = $powers;
            const NAME: &'static str = $name;
            const EXAMPLE: &'static str = $example;
            const BEYOND: (f64, &'static str) = ($most, $why);
        }
    )+ };
}

kinds! {
    /// Metres.
    Length = [1, 0, 0, 0, 0], "a length", "0.02 mm", 1e9 "farther than the Moon";
    /// Seconds.
    Time = [0, 0, 1, 0, 0], "a time", "0.2 us", 1e10 "more than three centuries";
    /// Kilograms.
    Mass = [0, 1, 0, 0, 0], "a mass", "1 g", 1e12 "more than a mountain";
    /// Metres in a second.
    Velocity = [1, 0, -1, 0, 0], "a velocity", "7 km/s", 299_792_458.0 "faster than light";
    /// Metres in a second squared.
    Acceleration = [1, 0, -2, 0, 0], "an acceleration", "9.81 m/s^2", 1e13 "more than the gravity of a neutron star";
    /// Cubic metres in a kilogram and a second squared.
    Gravitation = [3, -1, -2, 0, 0], "a constant of gravitation", "6.6743e-11 m^3/(kg s^2)", 1e12 "that of another world: here it is 6.6743e-11 m^3/(kg s^2)";
    /// Kilograms in a cubic metre.
    Density = [-3, 1, 0, 0, 0], "a density", "2785 kg/m^3", 1e6 "denser than anything on Earth: osmium has 22600 kg/m^3";
    /// Kilograms in a square metre.
    ArealMass = [-2, 1, 0, 0, 0], "an areal mass", "0.5 kg/m^2", 1e9 "that of hundreds of kilometres of rock";
    /// Pascals: pressures, stresses and moduli.
    Pressure = [-1, 1, -2, 0, 0], "a pressure or modulus", "0.26 GPa", 1e17 "more than the pressure in the middle of the Sun";
    /// Joules in a square metre.
    FractureEnergy = [0, 1, -2, 0, 0], "an energy of an area", "12 kJ/m^2", 1e12 "more than any matter takes to break";
    /// In a cubic metre.
    NumberDensity = [-3, 0, 0, 0, 0], "a number in a volume", "4e35/m^3", 1e150 "more than any volume holds";
    /// Radians.
    Angle = [0, 0, 0, 0, 1], "an angle", "30 deg", 1e6 "more turns than an angle keeps digits for";
    /// Radians in a second.
    AngularRate = [0, 0, -1, 0, 1], "an angular rate", "100 rad/s", 3e11 "so fast that a rim of a millimetre would outrun light";
    /// Kelvins.
    Temperature = [0, 0, 0, 1, 0], "a temperature", "300 K", 1e9 "hotter than the middle of any star";
    /// Joules per kilogram.
    SpecificEnergy = [2, 0, -2, 0, 0], "a specific energy", "2.5 MJ/kg", 9e16 "more than the energy of all its mass";
    /// Joules per kilogram and kelvin.
    SpecificHeat = [2, 0, -2, -1, 0], "a specific heat", "896 J/(kg K)", 1e7 "far beyond that of any matter: hydrogen has 14300 J/(kg K)";
    /// Pascal seconds.
    Viscosity = [-1, 1, -1, 0, 0], "a dynamic viscosity", "1 mPa s", 1e25 "stiffer than the mantle of the Earth";
    /// Per second.
    Rate = [0, 0, -1, 0, 0], "a rate", "1/s", 1e18 "faster than atoms vibrate";
    /// Per pascal.
    PerPressure = [1, -1, 2, 0, 0], "an inverse pressure", "6.52/Mbar", 1.0 "that of matter that a pascal changes";
    /// Length over length.
    Strain = [0, 0, 0, 0, 0], "a plain number", "0.1", 1e3 "more than any matter bears";
    /// Per kelvin.
    PerTemperature = [0, 0, 0, -1, 0], "an inverse temperature", "6.16e-4/K", 10.0 "that of matter that a tenth of a kelvin melts";
}

/// A quantity with its place in the text.
pub type Placed<K> = Spanned<Quantity<K>>;

/// A number in SI units that was written with a unit of the kind. Zero needs none.
#[derive(Debug)]
pub struct Quantity<K> {
    /// Value in SI units.
    pub si: f64,
    /// One of the unit that it was written with, in SI units.
    pub unit: f64,
    kind: PhantomData<K>,
}

impl<K> Clone for Quantity<K> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<K> Copy for Quantity<K> {}

/// A length in metres or in particle spacings (`"1.5 spacing"`).
#[derive(Debug, Clone, Copy)]
pub enum Extent {
    /// Metres.
    Metres(f64),
    /// Multiples of the body's particle spacing.
    Spacings(f64),
}

impl Extent {
    /// In metres, for a particle spacing in metres.
    pub fn metres(self, spacing: f64) -> f64 {
        match self {
            Self::Metres(length) => length,
            Self::Spacings(count) => count * spacing,
        }
    }
}

impl<'de, K: Kind> Deserialize<'de> for Quantity<K> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(TextVisitor {
            expected: || expected::<K>(""),
            read: quantity::<K>,
            takes_numbers: false,
        })
    }
}

impl<'de> Deserialize<'de> for Extent {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(TextVisitor {
            expected: || expected::<Length>(" or \"2 spacing\""),
            takes_numbers: false,
            read: |text| {
                let number = text
                    .strip_suffix("spacings")
                    .or(text.strip_suffix("spacing"));
                match number.map(|n| n.trim().parse::<f64>()) {
                    Some(Ok(count)) if count.abs() < MOST_SPACINGS => Ok(Self::Spacings(count)),
                    Some(Ok(count)) if count.is_finite() => Err(format!(
                        "`{text}` is more than any body has; check the number"
                    )),
                    _ => quantity::<Length>(text).map(|length| Self::Metres(length.si)),
                }
            },
        })
    }
}

/// Reads a string with a unit, or the plain number zero.
pub(super) struct TextVisitor<T> {
    /// Expected text, for messages.
    pub(super) expected: fn() -> String,
    /// Makes what is wanted of a text.
    pub(super) read: fn(&str) -> Result<T, String>,
    /// True if any plain number will do.
    pub(super) takes_numbers: bool,
}

impl<T> Visitor<'_> for TextVisitor<T> {
    type Value = T;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&(self.expected)())
    }

    fn visit_str<E: Error>(self, text: &str) -> Result<T, E> {
        (self.read)(text).map_err(E::custom)
    }

    fn visit_f64<E: Error>(self, value: f64) -> Result<T, E> {
        if value == 0.0 {
            return self.visit_str("0");
        }
        if self.takes_numbers {
            return self.visit_str(&value.to_string());
        }
        let expected = (self.expected)();
        Err(E::custom(format!(
            "expected {expected}, found the plain number {}",
            short(value)
        )))
    }

    #[allow(clippy::cast_precision_loss)] // only shown or zero
    fn visit_i64<E: Error>(self, value: i64) -> Result<T, E> {
        self.visit_f64(value as f64)
    }
}

/// Text that a key of a kind expects, or something else.
pub(super) fn expected<K: Kind>(or: &str) -> String {
    if K::POWERS == PLAIN {
        return format!("{}, such as {}{or}", K::NAME, K::EXAMPLE);
    }
    format!("{} with a unit, such as \"{}\"{or}", K::NAME, K::EXAMPLE)
}

/// The name of a dimension, with its article.
pub(super) fn dimension_name(powers: Powers) -> &'static str {
    let found = NAMES.iter().find(|(p, _)| *p == powers);
    found.map_or("a quantity of another dimension", |(_, name)| name)
}

/// Refuses a value (SI), written as `text`, of another dimension than that of a kind, or beyond all
/// sense.
pub(super) fn demand<K: Kind>(text: &str, si: f64, powers: Powers) -> Result<(), String> {
    // Zero is zero in any unit, so it may go without.
    if powers != K::POWERS && !(si == 0.0 && powers == PLAIN) {
        let found = dimension_name(powers);
        return Err(format!("expected {}, found {found}", expected::<K>("")));
    }
    let (most, why) = K::BEYOND;
    if si.abs() >= most {
        let text = text.trim();
        return Err(format!("`{text}` is {why}; check the number and its unit"));
    }
    Ok(())
}

/// Reads a number with a unit of a kind.
pub(super) fn quantity<K: Kind>(text: &str) -> Result<Quantity<K>, String> {
    let (si, powers) =
        parse(text).map_err(|why| format!("{why}; expected {}", expected::<K>("")))?;
    demand::<K>(text, si, powers)?;
    Ok(Quantity {
        si,
        unit: unit_of(text),
        kind: PhantomData,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn si<K: Kind>(text: &str) -> f64 {
        quantity::<K>(text).unwrap().si
    }

    #[test]
    #[allow(clippy::float_cmp)] // correctly rounded by construction
    fn decimal_units_are_exact() {
        assert_eq!(si::<Length>("0.02 mm"), 2e-5);
        assert_eq!(si::<Length>("0.3e-1cm"), 3e-4);
        assert_eq!(si::<Velocity>("7 km/s"), 7e3);
        assert_eq!(si::<Velocity>(".02 cm/us"), 200.0);
        assert_eq!(si::<Pressure>("0.2 Mbar"), 2e10);
        assert_eq!(si::<Pressure>("-1.2 GPa"), -1.2e9);
        assert_eq!(si::<Pressure>("3 dyn/cm^2"), 0.3);
        assert_eq!(si::<Pressure>("1 g/(cm us^2)"), 1e11);
        assert_eq!(si::<Pressure>("1 g cm^-1 us^-2"), 1e11);
        assert_eq!(si::<Pressure>("1 J/m³"), 1.0);
        for micro in ["0.2 us", "0.2 µs", "0.2 μs", "200 ns", "2e2ns"] {
            assert_eq!(si::<Time>(micro), 2e-7);
        }
        for density in ["2.785 g/cm^3", "2785 kg/m^3", "2.785 g/cm3", "2785 kg m^-3"] {
            assert_eq!(si::<Density>(density), 2785.0);
        }
        assert_eq!(si::<Rate>("1/s"), 1.0);
        assert_eq!(si::<Rate>("2.5 /us"), 2.5e6);
        assert_eq!(si::<PerPressure>("6.52/Mbar"), 6.52e-11);
        assert_eq!(si::<Viscosity>("1 mPa s"), 1e-3);
        assert_eq!(si::<Angle>("180 deg"), std::f64::consts::PI);
        assert_eq!(si::<Angle>("0.5 rad"), 0.5);
        assert_eq!(si::<Length>("0"), 0.0);
    }

    #[test]
    fn errors_say_what_was_expected() {
        for (text, message) in [
            (
                "7 km",
                "expected a velocity with a unit, such as \"7 km/s\", found a length",
            ),
            (
                "7",
                "expected a velocity with a unit, such as \"7 km/s\", found a plain number",
            ),
            (
                "0 m",
                "expected a velocity with a unit, such as \"7 km/s\", found a length",
            ),
            (
                "7 kn/s",
                "unknown unit `kn`; expected a velocity with a unit, such as \"7 km/s\"",
            ),
            (
                "fast",
                "`fast` does not begin with a number; expected a velocity",
            ),
            ("1 m/(s", "a parenthesis is not closed"),
            ("1 m/", "the unit `m/` ends too early"),
            ("1 m/s)", "`)` in the unit `m/s)` is not understood"),
            ("1 m/s^x", "`^x` is not a power of a unit"),
            ("1e999 m/s", "`1e999 m/s` is too large"),
            ("nan m/s", "does not begin with a number"),
            ("1 J^3", "found a quantity of another dimension"),
        ] {
            let error = quantity::<Velocity>(text).unwrap_err();
            assert!(error.contains(message), "{text}: {error}");
        }
    }
}
