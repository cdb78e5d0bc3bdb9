//! `[material.NAME]` and what belongs to it.

use serde::Deserialize;
use toml::Spanned;

use crate::input::forms::OrNone;
use crate::input::quantity::{
    Density, FractureEnergy, NumberDensity, PerPressure, PerTemperature, Placed, Pressure, Rate,
    SpecificEnergy, SpecificHeat, Temperature, Velocity, Viscosity,
};
use material::{AfterSpall, Crosses, Effect, Flaws, LinearForm, Molten, RateForm};

optional_tables! {
    /// `[material.NAME]`: from the library, or inline, or single values changed.
    MaterialParams {
        /// Name in the library.
        library: Option<Spanned<String>>,
        /// Reference density.
        density: Option<Placed<Density>>,
        /// Equation of state.
        eos: Option<Spanned<EosParams>>,
        /// Resistance to shear.
        strength: Option<Spanned<OrNone<StrengthParams>>>,
        /// How it fails.
        failure: Option<Spanned<OrNone<FailureParams>>>,
        /// Temperature.
        thermal: Option<Spanned<ThermalParams>>,
    }

    /// `eos`: exactly one of these.
    EosParams {
        /// Linear.
        linear: Option<LinearParams>,
        /// Mie–Grüneisen.
        mie_gruneisen: Option<MieGruneisenParams>,
        /// Tait.
        tait: Option<TaitParams>,
        /// Tillotson.
        tillotson: Option<TillotsonParams>,
        /// Ideal or stiffened gas.
        ideal_gas: Option<IdealGasParams>,
    }

    /// `eos.linear`
    LinearParams {
        /// Bulk modulus.
        bulk_modulus: Option<Placed<Pressure>>,
        /// Dependence on the density ratio.
        form: Option<LinearForm>,
    }

    /// `eos.mie_gruneisen`
    MieGruneisenParams {
        /// Bulk sound speed.
        c0: Option<Placed<Velocity>>,
        /// Hugoniot.
        s1: Option<Spanned<f64>>,
        /// Hugoniot.
        s2: Option<Spanned<f64>>,
        /// Hugoniot.
        s3: Option<Spanned<f64>>,
        /// Grüneisen parameter.
        gamma0: Option<Spanned<f64>>,
        /// Its linear coefficient.
        b: Option<Spanned<f64>>,
    }

    /// `eos.tait`
    TaitParams {
        /// Coefficient B; or the sound speed.
        b: Option<Placed<Pressure>>,
        /// Sound speed of the reference state.
        sound_speed: Option<Placed<Velocity>>,
        /// Exponent; 7 if absent.
        gamma: Option<Spanned<f64>>,
    }

    /// `eos.tillotson`
    TillotsonParams {
        /// Coefficient a.
        a: Option<Spanned<f64>>,
        /// Coefficient b.
        b: Option<Spanned<f64>>,
        /// Bulk modulus A.
        bulk_modulus: Option<Placed<Pressure>>,
        /// Coefficient B.
        quadratic_modulus: Option<Placed<Pressure>>,
        /// Exponent α.
        alpha: Option<Spanned<f64>>,
        /// Exponent β.
        beta: Option<Spanned<f64>>,
        /// Energy E₀.
        e0: Option<Placed<SpecificEnergy>>,
        /// Energy of incipient vaporisation.
        e_iv: Option<Placed<SpecificEnergy>>,
        /// Energy of complete vaporisation.
        e_cv: Option<Placed<SpecificEnergy>>,
    }

    /// `eos.ideal_gas`
    IdealGasParams {
        /// Ratio of specific heats.
        gamma: Option<Spanned<f64>>,
        /// Stiffening pressure; 0 if absent.
        stiffening_pressure: Option<Placed<Pressure>>,
        /// Pressure of the reference state; 0 if absent.
        reference_pressure: Option<Placed<Pressure>>,
    }

    /// `thermal`
    ThermalParams {
        /// Specific heat.
        specific_heat: Option<Placed<SpecificHeat>>,
        /// Temperature of the reference state; 300 K if absent.
        reference_temperature: Option<Placed<Temperature>>,
        /// Melting temperature.
        melting_temperature: Option<Placed<Temperature>>,
        /// Share of plastic work that becomes heat; 1 if absent.
        taylor_quinney: Option<Spanned<f64>>,
    }
}

/// Passes the laws of strength to the macro `$then`: key, table, the law that it makes, and keys
/// and values of its constants, with their range and what they are if neither the table nor the
/// library says. A shear modulus may be that of the library's law, whichever that is.
macro_rules! strength_laws {
    ($then:ident) => {
        $then! {
            /// `strength.viscous`: Newtonian fluid.
            viscous: ViscousParams => Viscous {
                /// Dynamic viscosity.
                viscosity: Placed<Viscosity>, Positive;
            }
            /// `strength.elastic`: linear elastic.
            elastic: ElasticParams => Elastic {
                /// Shear modulus.
                shear_modulus: Placed<Pressure>, Positive;
            }
            /// `strength.neo_hookean`: rubber.
            neo_hookean: NeoHookeanParams => NeoHookean {
                /// Shear modulus.
                shear_modulus: Placed<Pressure>, Positive;
            }
            /// `strength.von_mises`: elastic–plastic.
            von_mises: VonMisesParams => VonMises {
                /// Shear modulus.
                shear_modulus: Placed<Pressure>, Positive;
                /// Yield stress.
                yield_stress: Placed<Pressure>, NotNegative;
                /// Hardening modulus; 0 if absent.
                hardening_modulus: Placed<Pressure>, NotNegative, or 0.0;
            }
            /// `strength.johnson_cook`: Johnson and Cook.
            johnson_cook: JohnsonCookParams => JohnsonCook {
                /// Shear modulus.
                shear_modulus: Placed<Pressure>, Positive;
                /// Yield stress.
                a: Placed<Pressure>, NotNegative;
                /// Hardening coefficient.
                b: Placed<Pressure>, NotNegative;
                /// Hardening exponent.
                n: Spanned<f64>, UpToOne;
                /// Rate coefficient.
                c: Spanned<f64>, NotNegative;
                /// Exponent of thermal softening.
                m: Spanned<f64>, Positive;
                /// Reference strain rate; 1/s if absent.
                reference_rate: Placed<Rate>, Positive, or 1.0;
            }
            /// `strength.steinberg_guinan`: Steinberg and Guinan.
            steinberg_guinan: SteinbergGuinanParams => SteinbergGuinan {
                /// Shear modulus.
                shear_modulus: Placed<Pressure>, Positive;
                /// Yield stress.
                yield_stress: Placed<Pressure>, NotNegative;
                /// Largest yield stress by hardening.
                max_yield_stress: Placed<Pressure>, NotNegative;
                /// Hardening coefficient.
                beta: Spanned<f64>, NotNegative;
                /// Hardening exponent.
                n: Spanned<f64>, UpToOne;
                /// Initial plastic strain; 0 if absent.
                initial_strain: Spanned<f64>, NotNegative, or 0.0;
                /// G′p/G₀.
                pressure_coefficient: Placed<PerPressure>, NotNegative;
                /// −G′T/G₀.
                temperature_coefficient: Placed<PerTemperature>, NotNegative;
                /// Melting temperature of the fit.
                melting_temperature: Placed<Temperature>, Positive;
                /// Grüneisen parameter in the melting law.
                gamma0: Spanned<f64>, NotNegative;
                /// Its volume correction.
                a: Spanned<f64>, NotNegative;
            }
        }
    };
}
pub(in crate::input) use strength_laws;

/// Passes the laws of failure to the macro `$then`, in the same form. A `Word` is a choice with a
/// default of its own.
macro_rules! failure_laws {
    ($then:ident) => {
        $then! {
            /// `failure.spall`: largest tension.
            spall: SpallParams => Spall {
                /// Lowest pressure.
                pressure: Placed<Pressure>, NotPositive;
                /// What becomes of matter beyond it; `"failed"` if absent.
                after: Spanned<AfterSpall>, Word;
            }
            /// `failure.principal_stress`: largest principal stress.
            principal_stress: PrincipalStressParams => PrincipalStress {
                /// Largest tension in any direction.
                limit: Placed<Pressure>, Positive;
            }
            /// `failure.plastic_strain`: largest plastic strain.
            plastic_strain: PlasticStrainParams => PlasticStrain {
                /// Plastic strain of failure.
                limit: Spanned<f64>, Positive;
            }
            /// `failure.johnson_cook`: ductile damage.
            johnson_cook: JohnsonCookFailureParams => JohnsonCookFailure {
                /// D₁.
                d1: Spanned<f64>, Any;
                /// D₂.
                d2: Spanned<f64>, Any;
                /// D₃.
                d3: Spanned<f64>, Any;
                /// D₄; 0 if absent.
                d4: Spanned<f64>, Any, or 0.0;
                /// D₅; 0 if absent.
                d5: Spanned<f64>, Any, or 0.0;
                /// Reference strain rate; 1/s if absent.
                reference_rate: Placed<Rate>, Positive, or 1.0;
                /// How the failure strain follows the rate; `"logarithm"` if absent.
                rate_form: Spanned<RateForm>, Word;
                /// Least failure strain; 0.01 if absent.
                least_strain: Spanned<f64>, Positive, or 0.01;
                /// Mean tension at which the least strain is enough; no such stress if absent.
                spall_stress: Placed<Pressure>, NotNegative, or 0.0;
            }
            /// `failure.grady_kipp`: cracks that grow from flaws.
            grady_kipp: GradyKippParams => GradyKipp {
                /// Weibull's coefficient.
                k: Placed<NumberDensity>, Positive;
                /// Weibull's exponent.
                m: Spanned<f64>, Positive;
                /// Crack speed over the sound speed; 0.4 if absent.
                crack_speed: Spanned<f64>, Positive, or 0.4;
                /// What a crack crosses; `"particle"` if absent.
                crosses: Spanned<Crosses>, Word;
                /// How many flaws are active; `"drawn"` if absent.
                flaws: Spanned<Flaws>, Word;
                /// Flaws of a particle; no limit if absent.
                most_flaws: Spanned<f64>, NotNegative, or 0.0;
            }
        }
    };
}
pub(in crate::input) use failure_laws;

macro_rules! law_tables {
    ($(
        $(#[doc = $doc:literal])+ $law:ident: $table:ident => $made:ident {
            $( $(#[doc = $key_doc:literal])+ $key:ident: $value:ty, $allowed:ident $(, or $default:literal)?; )+
        }
    )+) => {
        optional_tables! {
            $( $(#[doc = $doc])+ $table { $( $(#[doc = $key_doc])+ $key: Option<$value>, )+ } )+
        }
    };
}
strength_laws!(law_tables);
failure_laws!(law_tables);

macro_rules! strength_table {
    ($( $(#[doc = $doc:literal])+ $law:ident: $table:ident => $made:ident { $($keys:tt)+ } )+) => {
        optional_tables! {
            /// `strength`: exactly one of these.
            StrengthParams { $( $(#[doc = $doc])+ $law: Option<$table>, )+ }
        }
    };
}
strength_laws!(strength_table);

macro_rules! failure_table {
    ($( $(#[doc = $doc:literal])+ $law:ident: $table:ident => $made:ident { $($keys:tt)+ } )+) => {
        optional_tables! {
            /// `failure`: any of these laws, and what they have in common.
            FailureParams {
                $( $(#[doc = $doc])+ $law: Option<Spanned<OrNone<$table>>>, )+
                /// What failed matter has lost.
                effect: Option<Spanned<Effect>>,
                /// Energy that opens a crack.
                fracture_energy: Option<Placed<FractureEnergy>>,
                /// Weibull modulus of failure strains.
                scatter: Option<Spanned<f64>>,
                /// Of draws.
                seed: Option<Spanned<u32>>,
                /// What molten matter does.
                molten: Option<Spanned<Molten>>,
            }
        }
    };
}
failure_laws!(failure_table);
