//! `[material.NAME]` and what belongs to it.

use serde::Deserialize;
use toml::Spanned;

use crate::input::forms::OrNone;
use crate::input::quantity::{
    Density, FractureEnergy, Length, NumberDensity, PerPressure, PerTemperature, Placed, Pressure,
    Rate, SpecificEnergy, SpecificHeat, Temperature, Velocity, Viscosity,
};
use material::{
    AfterSpall, Burn, CompactionDamage, Coupling, Criterion, Crosses, Effect, Flaws, LinearForm,
    Molten, RateForm, StrengthOf,
};

optional_tables! {
    /// `[material.NAME]`: from the library, or inline, or single values changed.
    MaterialParams {
        /// Name in the library.
        library: Option<Spanned<String>>;
        /// Reference density; of a porous material that of the solid between the pores.
        density: Option<Placed<Density>>, Positive;
        /// Equation of state.
        eos: Option<Spanned<EosParams>>;
        /// Resistance to shear.
        strength: Option<Spanned<OrNone<StrengthParams>>>;
        /// How it fails.
        failure: Option<Spanned<OrNone<FailureParams>>>;
        /// Temperature.
        thermal: Option<Spanned<ThermalParams>>;
        /// Pores.
        porosity: Option<Spanned<OrNone<PorosityParams>>>;
    }

    /// `thermal`
    ThermalParams {
        /// Specific heat.
        specific_heat: Option<Placed<SpecificHeat>>, Positive;
        /// Temperature of the reference state.
        reference_temperature: Option<Placed<Temperature>> = "300 K", NotNegative => or "that of the library";
        /// Melting temperature.
        melting_temperature: Option<Placed<Temperature>>, Positive;
        /// Share of plastic work that becomes heat.
        taylor_quinney: Option<Spanned<f64>> = 1.0, Within(0.0, 1.0) => or "that of the library";
    }
}

/// Passes the equations of state to the macro `$then`: key, table, the law that it makes, and keys and values of its
/// constants, each as a row of [a table](super::declare) that need not be there: what it has not is that of the
/// library's law of the same kind, then that of the row. After `or` stands a key in place of one of the constants, and
/// what makes the law of it, from the other constants and the reference density.
macro_rules! equations_of_state {
    ($then:ident) => {
        $then! {
            /// `eos.linear`: linear.
            linear: LinearParams => Linear {
                /// Bulk modulus.
                bulk_modulus: Placed<Pressure>, Positive;
                /// Dependence on the density ratio.
                form: Spanned<LinearForm> = LinearForm::Logarithmic;
            }
            /// `eos.mie_gruneisen`: Mie–Grüneisen.
            mie_gruneisen: MieGruneisenParams => MieGruneisen {
                /// Bulk sound speed.
                c0: Placed<Velocity>, Positive;
                /// Hugoniot.
                s1: Spanned<f64>, NotNegative;
                /// Hugoniot.
                s2: Spanned<f64> = 0.0, Any;
                /// Hugoniot.
                s3: Spanned<f64> = 0.0, Any;
                /// Grüneisen parameter.
                gamma0: Spanned<f64>, NotNegative;
                /// Its linear coefficient.
                b: Spanned<f64> = 0.0, Any;
            }
            /// `eos.polynomial`: polynomial in the compression.
            polynomial: PolynomialParams => Polynomial {
                /// Bulk modulus K₁.
                k1: Placed<Pressure>, Positive;
                /// Coefficient K₂ of the square.
                k2: Placed<Pressure> = "0", Any;
                /// Coefficient K₃ of the cube.
                k3: Placed<Pressure> = "0", Any;
                /// Grüneisen parameter.
                gamma0: Spanned<f64> = 0.0, NotNegative;
            }
            /// `eos.tait`: Tait.
            tait: TaitParams => Tait {
                /// Coefficient B; or the sound speed.
                b: Placed<Pressure>, Positive;
                /// Exponent.
                gamma: Spanned<f64> = 7.0, Positive;
            } or {
                /// Sound speed of the reference state.
                sound_speed: Placed<Velocity>, Positive
                    => b: |law: &Tait, rho0, c0| Tait::with_sound_speed(rho0, c0, law.gamma);
            }
            /// `eos.tillotson`: Tillotson.
            tillotson: TillotsonParams => Tillotson {
                /// Coefficient a.
                a: Spanned<f64>, Positive;
                /// Coefficient b.
                b: Spanned<f64>, NotNegative;
                /// Bulk modulus A.
                bulk_modulus: Placed<Pressure>, Positive;
                /// Coefficient B.
                quadratic_modulus: Placed<Pressure>, NotNegative;
                /// Exponent α.
                alpha: Spanned<f64>, NotNegative;
                /// Exponent β.
                beta: Spanned<f64>, NotNegative;
                /// Energy E₀.
                e0: Placed<SpecificEnergy>, Positive;
                /// Energy of incipient vaporisation.
                e_iv: Placed<SpecificEnergy>, Positive;
                /// Energy of complete vaporisation.
                e_cv: Placed<SpecificEnergy>, Positive;
                /// Density over that of the reference state below which it bears no tension.
                least_density: Spanned<f64> = 0.9, NotNegative;
            }
            /// `eos.ideal_gas`: ideal or stiffened gas.
            ideal_gas: IdealGasParams => IdealGas {
                /// Ratio of specific heats.
                gamma: Spanned<f64>, AboveOne;
                /// Stiffening pressure.
                stiffening_pressure: Placed<Pressure> = "0", NotNegative;
                /// Pressure of the reference state.
                reference_pressure: Placed<Pressure> = "0", NotNegative;
            }
            /// `eos.murnaghan`: Murnaghan.
            murnaghan: MurnaghanParams => Murnaghan {
                /// Bulk modulus.
                bulk_modulus: Placed<Pressure>, Positive;
                /// Its derivative by the pressure.
                exponent: Spanned<f64>, Positive;
            }
            /// `eos.jwl`: products of an explosive.
            jwl: JwlParams => Jwl {
                /// Coefficient A.
                a: Placed<Pressure>, Positive;
                /// Coefficient B.
                b: Placed<Pressure>, NotNegative;
                /// Exponent R₁.
                r1: Spanned<f64>, Positive;
                /// Exponent R₂.
                r2: Spanned<f64>, Positive;
                /// Grüneisen parameter.
                omega: Spanned<f64>, Positive;
                /// Specific energy of detonation; or that of the volume.
                e0: Placed<SpecificEnergy>, Positive;
                /// Speed of the detonation.
                detonation_velocity: Placed<Velocity>, Positive;
                /// Pressure of Chapman and Jouguet.
                cj_pressure: Placed<Pressure>, Positive;
                /// Bulk modulus of unburnt matter.
                bulk_modulus: Placed<Pressure> = "0", NotNegative => "unburnt matter bears no pressure";
                /// What burns it.
                burn: Spanned<Burn> = Burn::Either;
                /// Width of the programmed burn in particles.
                width: Spanned<f64> = 3.0, Positive;
            } or {
                /// Energy of detonation of a volume of unburnt matter.
                energy_density: Placed<Pressure>, Positive
                    => e0: |law: &Jwl, rho0, energy| Jwl { e0: energy / rho0, ..*law };
            }
        }
    };
}
pub(in crate::input) use equations_of_state;

/// Passes the laws of strength to the macro `$then`, in the same form. A shear modulus may be that of the library's
/// law, whichever that is.
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
            /// `strength.orthotropic`: elastic along directions of the matter's own, which `body.fibres` gives.
            orthotropic: OrthotropicParams => Orthotropic {
                /// Young's modulus along direction 1.
                e1: Placed<Pressure>, Positive;
                /// Young's modulus along direction 2.
                e2: Placed<Pressure>, Positive;
                /// Young's modulus along direction 3.
                e3: Placed<Pressure>, Positive;
                /// Contraction along 2 over the stretch along 1.
                nu12: Spanned<f64>, Any;
                /// Contraction along 3 over the stretch along 1.
                nu13: Spanned<f64>, Any;
                /// Contraction along 3 over the stretch along 2.
                nu23: Spanned<f64>, Any;
                /// Shear modulus of 1 and 2.
                g12: Placed<Pressure>, Positive;
                /// Shear modulus of 1 and 3.
                g13: Placed<Pressure>, Positive;
                /// Shear modulus of 2 and 3.
                g23: Placed<Pressure>, Positive;
                /// Largest equivalent stress of the deviator of what is pressed.
                crush_stress: Placed<Pressure> = "0", NotNegative => "no limit";
            }
            /// `strength.uncoupled`: yarns or walls along directions of the matter's own, each for itself.
            uncoupled: UncoupledParams => Uncoupled {
                /// Young's modulus of members along direction 1.
                e1: Placed<Pressure>, Positive;
                /// Young's modulus of those along direction 2.
                e2: Placed<Pressure> = "0", NotNegative => "none";
                /// Young's modulus of those along direction 3.
                e3: Placed<Pressure> = "0", NotNegative => "none";
                /// Shear modulus of 1 and 2.
                g12: Placed<Pressure> = "0", NotNegative => "none";
                /// Shear modulus of 1 and 3.
                g13: Placed<Pressure> = "0", NotNegative => "none";
                /// Shear modulus of 2 and 3.
                g23: Placed<Pressure> = "0", NotNegative => "none";
                /// Stress at which members along direction 1 crush.
                c1: Placed<Pressure> = "0", NotNegative => "they buckle and bear none";
                /// Stress at which those along direction 2 crush.
                c2: Placed<Pressure> = "0", NotNegative => "they buckle and bear none";
                /// Stress at which those along direction 3 crush.
                c3: Placed<Pressure> = "0", NotNegative => "they buckle and bear none";
                /// Strength against shear of 1 and 2.
                s12: Placed<Pressure> = "0", NotNegative => "none";
                /// Strength against shear of 1 and 3.
                s13: Placed<Pressure> = "0", NotNegative => "none";
                /// Strength against shear of 2 and 3.
                s23: Placed<Pressure> = "0", NotNegative => "none";
            }
            /// `strength.von_mises`: elastic–plastic.
            von_mises: VonMisesParams => VonMises {
                /// Shear modulus.
                shear_modulus: Placed<Pressure>, Positive;
                /// Yield stress.
                yield_stress: Placed<Pressure>, NotNegative;
                /// Hardening modulus.
                hardening_modulus: Placed<Pressure> = "0", NotNegative;
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
                /// Reference strain rate.
                reference_rate: Placed<Rate> = "1/s", Positive;
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
                /// Initial plastic strain.
                initial_strain: Spanned<f64> = 0.0, NotNegative;
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
            /// `strength.drucker_prager`: linear in the pressure up to a limit.
            drucker_prager: DruckerPragerParams => DruckerPrager {
                /// Shear modulus.
                shear_modulus: Placed<Pressure>, Positive;
                /// Shear strength √J₂ at zero pressure.
                cohesion: Placed<Pressure>, NotNegative;
                /// Its slope over the pressure.
                friction: Spanned<f64>, NotNegative;
                /// Its limit.
                max_strength: Placed<Pressure> = "0", NotNegative => "no limit";
            }
            /// `strength.mohr_coulomb`: Mohr and Coulomb.
            mohr_coulomb: MohrCoulombParams => MohrCoulomb {
                /// Shear modulus.
                shear_modulus: Placed<Pressure>, Positive;
                /// Cohesion.
                cohesion: Placed<Pressure>, NotNegative;
                /// Coefficient of friction tan φ.
                friction: Spanned<f64>, NotNegative;
                /// Largest principal tension.
                tensile_strength: Placed<Pressure>, NotNegative;
            }
            /// `strength.lundborg`: intact rock.
            lundborg: LundborgParams => Lundborg {
                /// Shear modulus.
                shear_modulus: Placed<Pressure>, Positive;
                /// Shear strength √J₂ at zero pressure.
                cohesion: Placed<Pressure>, NotNegative;
                /// Its slope over the pressure there.
                friction: Spanned<f64>, NotNegative;
                /// Its limit at high pressure.
                max_strength: Placed<Pressure>, Positive;
            }
            /// `strength.collins`: rock, intact and damaged.
            collins: CollinsParams => Collins {
                /// Shear modulus.
                shear_modulus: Placed<Pressure>, Positive;
                /// Shear strength √J₂ of intact rock at zero pressure.
                cohesion: Placed<Pressure>, NotNegative;
                /// Its slope over the pressure there.
                friction: Spanned<f64>, NotNegative;
                /// Its limit at high pressure.
                max_strength: Placed<Pressure>, Positive;
                /// Shear strength √J₂ of damaged rock at zero pressure.
                damaged_cohesion: Placed<Pressure> = "0", NotNegative;
                /// Its slope over the pressure.
                damaged_friction: Spanned<f64>, NotNegative;
                /// Its limit.
                damaged_max_strength: Placed<Pressure> = "0", NotNegative => "that of intact rock";
                /// Coefficient ξ of softening by heat.
                softening: Spanned<f64> = 0.0, NotNegative => "none";
                /// Pressure a in Simon's law of melting.
                simon_a: Placed<Pressure> = "0", NotNegative => "no pressure in the melting temperature";
                /// Exponent c in Simon's law.
                simon_c: Spanned<f64> = 1.0, Positive;
            }
            /// `strength.johnson_holmquist_2`: ceramics and glass, intact and fractured.
            johnson_holmquist_2: JohnsonHolmquist2Params => JohnsonHolmquist2 {
                /// Shear modulus.
                shear_modulus: Placed<Pressure>, Positive;
                /// Intact strength A.
                a: Spanned<f64>, Positive;
                /// Fractured strength B.
                b: Spanned<f64>, NotNegative;
                /// Rate coefficient C.
                c: Spanned<f64> = 0.0, NotNegative;
                /// Exponent M of the fractured strength.
                m: Spanned<f64>, NotNegative;
                /// Exponent N of the intact strength.
                n: Spanned<f64>, NotNegative;
                /// Largest tension T.
                max_tension: Placed<Pressure>, NotNegative;
                /// Hugoniot elastic limit.
                hugoniot_limit: Placed<Pressure>, Positive;
                /// Pressure at the Hugoniot elastic limit.
                hugoniot_pressure: Placed<Pressure>, Positive;
                /// Largest fractured strength, over the stress at the Hugoniot elastic limit.
                max_fractured: Spanned<f64> = 0.0, NotNegative => "no limit";
                /// Reference strain rate.
                reference_rate: Placed<Rate> = "1/s", Positive;
            }
            /// `strength.holmquist_johnson_cook`: concrete.
            holmquist_johnson_cook: HolmquistJohnsonCookParams => HolmquistJohnsonCook {
                /// Shear modulus.
                shear_modulus: Placed<Pressure>, Positive;
                /// Strength A that damage takes.
                a: Spanned<f64>, Positive;
                /// Coefficient B of the pressure.
                b: Spanned<f64>, NotNegative;
                /// Rate coefficient C.
                c: Spanned<f64> = 0.0, NotNegative;
                /// Exponent N of the pressure.
                n: Spanned<f64>, NotNegative;
                /// Compressive strength.
                compressive_strength: Placed<Pressure>, Positive;
                /// Largest tension T.
                max_tension: Placed<Pressure>, NotNegative;
                /// Largest strength, over the compressive strength.
                max_strength: Spanned<f64>, Positive;
                /// Reference strain rate.
                reference_rate: Placed<Rate> = "1/s", Positive;
            }
            /// `strength.riedel_hiermaier_thoma`: concrete, by pressure, Lode angle and rate.
            riedel_hiermaier_thoma: RiedelHiermaierThomaParams => RiedelHiermaierThoma {
                /// Shear modulus.
                shear_modulus: Placed<Pressure>, Positive;
                /// Coefficient A of the failure surface.
                a: Spanned<f64>, Positive;
                /// Exponent N of the failure surface.
                n: Spanned<f64>, Positive;
                /// Compressive strength.
                compressive_strength: Placed<Pressure>, Positive;
                /// Tensile strength, over the compressive strength.
                tensile_ratio: Spanned<f64> = 0.1, Positive;
                /// Shear strength, over the compressive strength.
                shear_ratio: Spanned<f64> = 0.18, Positive;
                /// Strength in tension over that in compression, without pressure.
                lode_ratio: Spanned<f64> = 0.6805, Positive;
                /// Growth of that ratio with the pressure over the compressive strength.
                lode_slope: Spanned<f64> = 0.0105, NotNegative;
                /// Share of the compressive strength at which flow begins.
                elastic_compression: Spanned<f64> = 0.53, UpToOne;
                /// Share of the tensile strength at which flow begins.
                elastic_tension: Spanned<f64> = 0.7, UpToOne;
                /// Share of the shear modulus while flow hardens.
                hardening: Spanned<f64> = 0.5, UpToOne;
                /// Coefficient of the friction of what is broken.
                b: Spanned<f64>, NotNegative;
                /// Exponent of that friction.
                m: Spanned<f64>, NotNegative;
                /// Exponent of the rate in compression.
                rate_compression: Spanned<f64> = 0.0, NotNegative;
                /// Exponent of the rate in tension.
                rate_tension: Spanned<f64> = 0.0, NotNegative;
                /// Reference strain rate in compression.
                reference_compression: Placed<Rate> = "3e-5/s", Positive;
                /// Reference strain rate in tension.
                reference_tension: Placed<Rate> = "3e-6/s", Positive;
            }
        }
    };
}
pub(in crate::input) use strength_laws;

/// Passes the laws of failure to the macro `$then`, in the same form.
macro_rules! failure_laws {
    ($then:ident) => {
        $then! {
            /// `failure.spall`: largest tension.
            spall: SpallParams => Spall {
                /// Lowest pressure.
                pressure: Placed<Pressure>, NotPositive;
                /// What becomes of matter beyond it.
                after: Spanned<AfterSpall> = AfterSpall::Failed;
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
                /// D₄.
                d4: Spanned<f64> = 0.0, Any;
                /// D₅.
                d5: Spanned<f64> = 0.0, Any;
                /// Reference strain rate.
                reference_rate: Placed<Rate> = "1/s", Positive;
                /// How the failure strain follows the rate.
                rate_form: Spanned<RateForm> = RateForm::Logarithm;
                /// Least failure strain.
                least_strain: Spanned<f64> = 0.01, Positive;
                /// Mean tension at which the least strain is enough.
                spall_stress: Placed<Pressure> = "0", NotNegative => "no such stress";
                /// Share of the strength that damage takes before failure: none, its own, or that in shear bands.
                coupling: Spanned<Coupling> = Coupling::Uncoupled;
            }
            /// `failure.ivanov`: shear damage of rock.
            ivanov: IvanovParams => Ivanov {
                /// Failure strain of brittle rock.
                least_strain: Spanned<f64> = 1e-4, Positive;
                /// Growth of the failure strain with pressure.
                slope: Placed<PerPressure> = "1e-11/Pa", NotNegative;
                /// Pressure from which on it grows.
                pressure: Placed<Pressure> = "300 MPa", NotNegative;
            }
            /// `failure.collins`: shear damage of rock, brittle to ductile.
            collins: CollinsFailureParams => CollinsFailure {
                /// Pressure of the brittle–ductile transition.
                brittle_ductile: Placed<Pressure>, Positive;
                /// Pressure of the brittle–plastic transition.
                brittle_plastic: Placed<Pressure>, Positive;
            }
            /// `failure.johnson_holmquist_2`: damage of ceramics, and their bulking.
            johnson_holmquist_2: JohnsonHolmquist2FailureParams => JohnsonHolmquist2Failure {
                /// D₁.
                d1: Spanned<f64>, NotNegative;
                /// D₂.
                d2: Spanned<f64>, NotNegative;
                /// Share of the elastic energy lost that presses from then on.
                bulking: Spanned<f64> = 1.0, NotNegative;
            }
            /// `failure.holmquist_johnson_cook`: damage of concrete.
            holmquist_johnson_cook: HolmquistJohnsonCookFailureParams => HolmquistJohnsonCookFailure {
                /// D₁.
                d1: Spanned<f64>, NotNegative;
                /// D₂.
                d2: Spanned<f64>, NotNegative;
                /// Least failure strain.
                least_strain: Spanned<f64> = 0.01, Positive;
            }
            /// `failure.riedel_hiermaier_thoma`: damage of concrete beyond its failure surface.
            riedel_hiermaier_thoma: RiedelHiermaierThomaFailureParams => RiedelHiermaierThomaFailure {
                /// D₁.
                d1: Spanned<f64>, NotNegative;
                /// D₂.
                d2: Spanned<f64>, NotNegative;
                /// Least failure strain.
                least_strain: Spanned<f64> = 0.01, Positive;
            }
            /// `failure.hashin`: cracks across the directions of the matter.
            hashin: HashinParams => Hashin {
                /// Strength against tension along direction 1.
                t1: Placed<Pressure> = "0", NotNegative => "no limit";
                /// Strength against tension along direction 2.
                t2: Placed<Pressure> = "0", NotNegative => "no limit";
                /// Strength against tension along direction 3.
                t3: Placed<Pressure> = "0", NotNegative => "no limit";
                /// Strength against shear of 1 and 2.
                s12: Placed<Pressure> = "0", NotNegative => "no limit";
                /// Strength against shear of 1 and 3.
                s13: Placed<Pressure> = "0", NotNegative => "no limit";
                /// Strength against shear of 2 and 3.
                s23: Placed<Pressure> = "0", NotNegative => "no limit";
                /// Energy of a crack across direction 1.
                gf1: Placed<FractureEnergy> = "0", NotNegative => "fails at once";
                /// Energy of a crack across direction 2.
                gf2: Placed<FractureEnergy> = "0", NotNegative => "fails at once";
                /// Energy of a crack across direction 3.
                gf3: Placed<FractureEnergy> = "0", NotNegative => "fails at once";
                /// How tension and shear go together.
                criterion: Spanned<Criterion> = Criterion::Hashin;
            }
            /// `failure.uncoupled`: yarns or walls that tear.
            uncoupled: UncoupledFailureParams => UncoupledFailure {
                /// Strength against tension along direction 1.
                t1: Placed<Pressure> = "0", NotNegative => "no limit";
                /// Strength against tension along direction 2.
                t2: Placed<Pressure> = "0", NotNegative => "no limit";
                /// Strength against tension along direction 3.
                t3: Placed<Pressure> = "0", NotNegative => "no limit";
                /// Energy that tears the members along direction 1.
                gf1: Placed<FractureEnergy> = "0", NotNegative => "torn at once";
                /// Energy that tears those along direction 2.
                gf2: Placed<FractureEnergy> = "0", NotNegative => "torn at once";
                /// Energy that tears those along direction 3.
                gf3: Placed<FractureEnergy> = "0", NotNegative => "torn at once";
            }
            /// `failure.grady_kipp`: cracks that grow from flaws.
            grady_kipp: GradyKippParams => GradyKipp {
                /// Weibull's coefficient.
                k: Placed<NumberDensity>, Positive;
                /// Weibull's exponent.
                m: Spanned<f64>, Positive;
                /// Crack speed over the sound speed.
                crack_speed: Spanned<f64> = 0.4, Positive;
                /// What a crack crosses.
                crosses: Spanned<Crosses> = Crosses::Particle;
                /// How many flaws are active.
                flaws: Spanned<Flaws> = Flaws::Drawn;
                /// Flaws of a particle.
                most_flaws: Spanned<f64> = 0.0, NotNegative => "no limit";
                /// Least size of what flaws are drawn for.
                least_size: Placed<Length> = "0", NotNegative => "none";
            }
        }
    };
}
pub(in crate::input) use failure_laws;

/// Passes the laws of compaction to the macro `$then`, in the same form.
macro_rules! compaction_laws {
    ($then:ident) => {
        $then! {
            /// `porosity.p_alpha`: distension from the pressure.
            p_alpha: PAlphaParams => PAlpha {
                /// Pressure from which on pores crush.
                elastic_pressure: Placed<Pressure>, NotNegative;
                /// Pressure at which all pores are crushed.
                solid_pressure: Placed<Pressure>, Positive;
                /// Exponent of the crush curve.
                exponent: Spanned<f64> = 2.0, Positive;
                /// Pressure at which the steep beginning of the crush curve ends.
                transition_pressure: Placed<Pressure> = "0", NotNegative => "no steep beginning";
                /// Distension of the steep beginning.
                transition_distension: Spanned<f64> = 1.0, Positive;
                /// Exponent of the steep beginning.
                transition_exponent: Spanned<f64> = 2.0, Positive;
                /// Bulk sound speed of virgin matter.
                sound_speed: Placed<Velocity> = "0", NotNegative => "that of the solid";
            }
            /// `porosity.epsilon_alpha`: distension from the volumetric strain.
            epsilon_alpha: EpsilonAlphaParams => EpsilonAlpha {
                /// Volumetric strain from which on pores crush, negative in compression.
                elastic_strain: Spanned<f64> = 0.0, NotPositive;
                /// Volumetric strain at which the exponential part of the crush curve ends.
                transition_strain: Spanned<f64>, NotPositive;
                /// Rate of the exponential part.
                kappa: Spanned<f64>, UpToOne;
                /// Bulk sound speed of virgin matter.
                sound_speed: Placed<Velocity> = "0", NotNegative => "that of the solid";
            }
            /// `porosity.holmquist_johnson_cook`: crushing of concrete between two points.
            holmquist_johnson_cook: HolmquistJohnsonCookCompactionParams => HolmquistJohnsonCookCompaction {
                /// Pressure from which on pores crush.
                crush_pressure: Placed<Pressure>, Positive;
                /// Compression at that pressure.
                crush_strain: Spanned<f64>, Positive;
                /// Pressure at which all pores are crushed.
                lock_pressure: Placed<Pressure>, Positive;
            }
        }
    };
}
pub(in crate::input) use compaction_laws;

/// Declares the tables of laws, and the one that has them all.
macro_rules! law_tables {
    ($(
        $(#[doc = $doc:literal])+ $law:ident: $table:ident => $made:ident { $(
            $(#[doc = $key_doc:literal])+ $key:ident: $typed:ty
                $(= $value:expr)? $(, $allowed:ident)? $(=> $words:literal)?;
        )+ } $(or {
            $(#[doc = $way_doc:literal])+ $way:ident: $way_typed:ty, $way_allowed:ident => $of:ident: $make:expr;
        })?
    )+) => { $(
        table! {
            value_of_law true
            #[derive(Debug, Default, Deserialize)] #[serde(default, deny_unknown_fields, remote = "Self")]
            $(#[doc = $doc])+ $table {
                $( $(#[doc = $key_doc])+ $key: Option<$typed> $(= $value)? $(, $allowed)? $(=> $words)?; )+
                $( $(#[doc = $way_doc])+ $way: Option<$way_typed>; )?
            }
        }
    )+ };
}
equations_of_state!(law_tables);
strength_laws!(law_tables);
failure_laws!(law_tables);
compaction_laws!(law_tables);

macro_rules! eos_table {
    ($( $(#[doc = $doc:literal])+ $law:ident: $table:ident => $made:ident { $($keys:tt)+ } $(or { $($way:tt)+ })? )+) => {
        optional_tables! {
            /// `eos`: exactly one of these.
            EosParams {
                $( $(#[doc = $doc])+ $law: Option<$table>; )+
                /// `eos.table`: a table of densities and temperatures.
                table: Option<Spanned<TableParams>>;
            }
        }
    };
}
equations_of_state!(eos_table);

macro_rules! strength_table {
    ($( $(#[doc = $doc:literal])+ $law:ident: $table:ident => $made:ident { $($keys:tt)+ } )+) => {
        optional_tables! {
            /// `strength`: exactly one of these.
            StrengthParams { $( $(#[doc = $doc])+ $law: Option<$table>; )+ }
        }
    };
}
strength_laws!(strength_table);

macro_rules! failure_table {
    ($( $(#[doc = $doc:literal])+ $law:ident: $table:ident => $made:ident { $($keys:tt)+ } )+) => {
        optional_tables! {
            /// `failure`: any of these laws, and what they have in common.
            FailureParams {
                $( $(#[doc = $doc])+ $law: Option<Spanned<OrNone<$table>>>; )+
                /// What failed matter has lost.
                effect: Option<Spanned<Effect>>;
                /// Energy that opens a crack.
                fracture_energy: Option<Placed<FractureEnergy>>, NotNegative;
                /// Weibull modulus of failure strains.
                scatter: Option<Spanned<f64>>, NotNegative;
                /// Of draws.
                seed: Option<Spanned<u32>>;
                /// What molten matter does.
                molten: Option<Spanned<Molten>>;
            }
        }
    };
}
failure_laws!(failure_table);

macro_rules! porosity_table {
    ($( $(#[doc = $doc:literal])+ $law:ident: $table:ident => $made:ident { $($keys:tt)+ } )+) => {
        optional_tables! {
            /// `porosity`: exactly one of these laws, and what they have in common.
            PorosityParams {
                $( $(#[doc = $doc])+ $law: Option<$table>; )+
                /// Initial distension: density of the solid over that of the whole.
                distension: Option<Spanned<f64>>, Within(1.0, 100.0);
                /// Initial volume of pores over that of the whole, in place of the distension.
                porosity: Option<Spanned<f64>>, Within(0.0, 0.99);
                /// What the constants of the strength belong to.
                strength: Option<Spanned<StrengthOf>>;
                /// What crushing damages.
                damage: Option<Spanned<CompactionDamage>>;
            }
        }
    };
}
compaction_laws!(porosity_table);

tables! {
    /// `eos.table`
    TableParams {
        /// Path of the table, from the folder of the case.
        file: Spanned<String>;
        /// Temperature of the reference state.
        reference_temperature: Option<Placed<Temperature>> = "300 K", Positive;
        /// SHA-256 that the file must have.
        sha256: Option<Spanned<String>>;
    }
}
