//! `[material.NAME]` and what belongs to it.

use serde::Deserialize;
use toml::Spanned;

use super::choices::FormName;
use crate::input::forms::OrNone;
use crate::input::quantity::{
    Density, PerPressure, PerTemperature, Placed, Pressure, Rate, SpecificEnergy, SpecificHeat,
    Temperature, Velocity, Viscosity,
};

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
        /// Largest tension.
        spall: Option<Spanned<OrNone<SpallParams>>>,
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
        form: Option<FormName>,
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
        /// Exponent.
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
        /// Stiffening pressure.
        stiffening_pressure: Option<Placed<Pressure>>,
        /// Pressure of the reference state.
        reference_pressure: Option<Placed<Pressure>>,
    }

    /// `strength`: exactly one of these.
    StrengthParams {
        /// Newtonian fluid.
        viscous: Option<ViscousParams>,
        /// Linear elastic.
        elastic: Option<ElasticParams>,
        /// Rubber.
        neo_hookean: Option<NeoHookeanParams>,
        /// Elastic–plastic.
        von_mises: Option<VonMisesParams>,
        /// Johnson and Cook.
        johnson_cook: Option<JohnsonCookParams>,
        /// Steinberg and Guinan.
        steinberg_guinan: Option<SteinbergGuinanParams>,
    }

    /// `strength.viscous`
    ViscousParams {
        /// Dynamic viscosity.
        viscosity: Option<Placed<Viscosity>>,
    }

    /// `strength.neo_hookean`
    NeoHookeanParams {
        /// Shear modulus.
        shear_modulus: Option<Placed<Pressure>>,
    }

    /// `strength.johnson_cook`
    JohnsonCookParams {
        /// Shear modulus.
        shear_modulus: Option<Placed<Pressure>>,
        /// Yield stress.
        a: Option<Placed<Pressure>>,
        /// Hardening coefficient.
        b: Option<Placed<Pressure>>,
        /// Hardening exponent.
        n: Option<Spanned<f64>>,
        /// Rate coefficient.
        c: Option<Spanned<f64>>,
        /// Exponent of thermal softening.
        m: Option<Spanned<f64>>,
        /// Reference strain rate.
        reference_rate: Option<Placed<Rate>>,
    }

    /// `strength.steinberg_guinan`
    SteinbergGuinanParams {
        /// Shear modulus.
        shear_modulus: Option<Placed<Pressure>>,
        /// Yield stress.
        yield_stress: Option<Placed<Pressure>>,
        /// Largest yield stress by hardening.
        max_yield_stress: Option<Placed<Pressure>>,
        /// Hardening coefficient.
        beta: Option<Spanned<f64>>,
        /// Hardening exponent.
        n: Option<Spanned<f64>>,
        /// Initial plastic strain.
        initial_strain: Option<Spanned<f64>>,
        /// G′p/G₀.
        pressure_coefficient: Option<Placed<PerPressure>>,
        /// −G′T/G₀.
        temperature_coefficient: Option<Placed<PerTemperature>>,
        /// Melting temperature of the fit.
        melting_temperature: Option<Placed<Temperature>>,
        /// Grüneisen parameter in the melting law.
        gamma0: Option<Spanned<f64>>,
        /// Its volume correction.
        a: Option<Spanned<f64>>,
    }

    /// `strength.elastic`
    ElasticParams {
        /// Shear modulus.
        shear_modulus: Option<Placed<Pressure>>,
    }

    /// `strength.von_mises`
    VonMisesParams {
        /// Shear modulus.
        shear_modulus: Option<Placed<Pressure>>,
        /// Yield stress.
        yield_stress: Option<Placed<Pressure>>,
        /// Hardening modulus.
        hardening_modulus: Option<Placed<Pressure>>,
    }

    /// `spall`
    SpallParams {
        /// Lowest pressure.
        pressure: Option<Placed<Pressure>>,
    }

    /// `thermal`
    ThermalParams {
        /// Specific heat.
        specific_heat: Option<Placed<SpecificHeat>>,
        /// Temperature of the reference state.
        reference_temperature: Option<Placed<Temperature>>,
        /// Melting temperature.
        melting_temperature: Option<Placed<Temperature>>,
    }
}
