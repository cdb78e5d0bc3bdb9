//! Physics at one point: equation of state, strength, failure. Knows neither particles nor MPI.
//!
//! A [`Material`] advances eight points at a time ([`PointBatch`]); the choice of its laws is made
//! once for each batch, never for each point. They act in the order that [`Law`] states. Stress is
//! positive in tension, pressure in compression: `σ = −p I + S`. A NaN in a point's state gives NaN
//! at that point, no panic.

#[macro_use]
mod declare;
pub mod constants;
pub mod eos;
pub mod library;
mod point;
mod porosity;
mod rest;
mod stressed;
pub mod thermal;
mod undamaged;

pub use constants::Constant;
pub use declare::{Constants, Listed, Value};
pub use eos::{
    Burn, Eos, EquationOfState, Grid, IdealGas, Jwl, Linear, LinearForm, MieGruneisen, Murnaghan,
    PointResponse, Polynomial, Table, Tait, Tillotson, UNLIT,
};
pub use point::*;
pub use porosity::{
    Compaction, CompactionDamage, CompactionLaw, EpsilonAlpha, HolmquistJohnsonCookCompaction,
    PAlpha, Porosity, PorousPoint, Solid, StrengthOf,
};
pub use rest::{NEGLIGIBLE, Rest};
pub use stressed::{Stressed, Unborne, pressure_and_deviator};
pub use thermal::{Thermal, ThermalConstants};

use numerics::dispatch::{Vectorised, instructions};

/// Smallest square of the bulk sound speed, as a fraction of its reference value K/ρ₀: expanded
/// and hot states where the equation of state gives less (or no real sound speed) keep a tenth
/// of the reference speed.
pub const SOUND_SPEED_SQUARED_FLOOR: f64 = 0.01;

/// A material: equation of state, strength, failure and heat.
#[derive(Debug, Clone, PartialEq)]
pub struct Material {
    /// Name for reports.
    pub name: String,
    /// Reference density ρ₀ (kg/m³), with its pores.
    pub reference_density: f64,
    /// Pressure as a function of density and specific energy.
    pub eos: Eos,
    /// Resistance to shear.
    pub strength: Strength,
    /// Largest tension and damage, if the material has them.
    pub failure: Failure,
    /// Temperature as a function of density and specific energy; without it, strength stays that
    /// of the reference temperature.
    pub thermal: Option<Thermal>,
    /// Pores, if it has any; the equation of state and heat are then those of the solid between them.
    pub porosity: Option<Porosity>,
}

/// One call of [`Material::update`]; without `ALL`, of laws that do not follow the state.
struct Update<'a, const ALL: bool> {
    material: &'a Material,
    batch: &'a mut PointBatch,
    dt: f64,
}

impl<const ALL: bool> Vectorised for Update<'_, ALL> {
    type Output = Lanes;

    #[inline(always)]
    fn run<V: numerics::lanes::Lanes>(self) -> Lanes {
        self.material.compose::<ALL>(self.batch, self.dt)
    }
}

/// Most corrections of the energy of torn matter, and the relative error of its temperature after
/// which there are no more.
const TORN_STEPS: u32 = 8;
const TORN_ERROR: f64 = 1e-13;

impl Material {
    /// Reference p-wave modulus `M = K + 4G/3` (Pa): what contact stiffness scales with. For a
    /// fluid K alone, for a gas that of its reference pressure.
    #[must_use]
    pub fn p_wave_modulus(&self) -> f64 {
        self.bulk_modulus() + self.shear_modulus() * (4.0 / 3.0)
    }

    /// Reference bulk modulus K (Pa).
    #[inline(always)]
    #[must_use]
    pub fn bulk_modulus(&self) -> f64 {
        match &self.porosity {
            None => self.eos.bulk_modulus(self.reference_density),
            Some(porosity) => porosity.bulk_modulus(),
        }
    }

    /// Reference shear modulus G (Pa).
    #[inline(always)]
    #[must_use]
    pub fn shear_modulus(&self) -> f64 {
        let shear_modulus = self.strength.shear_modulus_beside(self.bulk_modulus());
        match &self.porosity {
            None => shear_modulus,
            Some(porosity) => shear_modulus * porosity.shear_share(),
        }
    }

    /// Reference density (kg/m³) of the matter between pores; without pores that of the material.
    #[inline(always)]
    #[must_use]
    pub fn matter_density(&self) -> f64 {
        let solid = |porosity: &Porosity| porosity.solid.density;
        self.porosity.as_ref().map_or(self.reference_density, solid)
    }

    /// Pressure and derivatives of virgin matter at a density (kg/m³) and specific energy (J/kg), before
    /// pores crush.
    #[must_use]
    pub fn virgin(&self, density: f64, specific_energy: f64) -> PointResponse {
        self.first(density, specific_energy, false).response
    }

    /// Pressure and derivatives of matter that has been compressed to a density (kg/m³) and specific energy
    /// (J/kg) for the first time.
    #[must_use]
    pub fn loaded(&self, density: f64, specific_energy: f64) -> PointResponse {
        self.first(density, specific_energy, true).response
    }

    /// Matter that was virgin; pores crush if `crushes`.
    fn first(&self, density: f64, energy: f64, crushes: bool) -> PorousPoint {
        let Some(porosity) = &self.porosity else {
            let mut response = self.eos.at(self.reference_density, density, energy);
            if let Eos::Jwl(explosive) = &self.eos {
                response.pressure = explosive.unburnt(self.reference_density, density);
            }
            return PorousPoint {
                response,
                distension: 1.0,
                compaction: 1.0,
                share: 1.0,
                crushed: 0.0,
            };
        };
        self.eos.first(porosity, [density, energy], crushes)
    }

    /// The distension of a particle that holds `distension`, which is zero before its first update; one
    /// without pores.
    #[inline(always)]
    fn distension(&self, distension: f64) -> f64 {
        let known = |porosity: &Porosity| porosity.known(distension);
        self.porosity.as_ref().map_or(1.0, known)
    }

    /// Longitudinal sound speed √(M/ρ₀) (m/s) of matter at rest.
    #[must_use]
    pub fn longitudinal_speed(&self) -> f64 {
        (self.p_wave_modulus() / self.reference_density).sqrt()
    }

    /// Melting temperature (K) at a density (kg/m³) and distension, if the material has any: that of its strength, or
    /// that of the thermal constants.
    #[must_use]
    pub fn melting_temperature(&self, density: f64, distension: f64) -> Option<f64> {
        let thermal = self.thermal.as_ref()?.constants();
        let matter = density * self.distension(distension);
        let own = self.strength.melts_at(matter / self.matter_density());
        own.or(thermal.melting_temperature)
    }

    /// Longest stable step (s) of viscous diffusion at the smoothing length `h` (m),
    /// `h² ρ₀/(8 η)` (Morris, Fox & Zhu 1997, J. Comput. Phys. 136, 214); infinite without
    /// viscosity.
    #[must_use]
    pub fn diffusion_time(&self, h: f64) -> f64 {
        let viscosity = self.strength.viscosity();
        if viscosity > 0.0 {
            0.125 * h * h * self.reference_density / viscosity
        } else {
            f64::INFINITY
        }
    }

    /// Temperature (K) at a density (kg/m³), [thermal energy](Self::thermal_energy) (J/kg), damage and distension, if
    /// the material has thermal constants.
    #[must_use]
    pub fn temperature(
        &self,
        density: f64,
        specific_energy: f64,
        [damage, distension]: [f64; 2],
    ) -> Option<f64> {
        let thermal = self.thermal.as_ref()?;
        let alpha = self.distension(distension);
        let matter = density * alpha;
        let at = self.eos.at(self.matter_density(), matter, specific_energy);
        if at.pressure >= 0.0 {
            // No tension that failure could limit.
            return Some(thermal.temperature(matter, specific_energy));
        }
        let pressure = at.pressure / alpha;
        let mut point = PointBatch {
            density: [density; LANES],
            specific_energy: [specific_energy; LANES],
            pressure: [pressure; LANES],
            damage: [damage; LANES],
            ..PointBatch::ZERO
        };
        self.limit_tension(&mut point);
        let limited = point.pressure[0];
        let matter = if limited > pressure {
            self.torn_density(matter, specific_energy, limited * alpha)
        } else {
            matter
        };
        Some(thermal.temperature(matter, specific_energy))
    }

    /// Density (kg/m³) of the matter between voids, whose pressure a cut-off has raised to `limited`
    /// (Pa), from its density without them.
    #[inline(always)]
    fn torn_density(&self, density: f64, energy: f64, limited: f64) -> f64 {
        let reference = self.matter_density();
        let from = self.eos.linear_density(reference, density);
        let at = self.eos.at(reference, from, energy);
        from + thermal::opening(limited - at.pressure, at.dp_drho)
    }

    /// Temperatures (K) of a batch whose pressure was limited from `before_failure` (Pa): that of the matter, not of
    /// the voids and pores in it.
    #[inline(always)]
    fn torn_temperatures(
        &self,
        thermal: &Thermal,
        [density, energy, distension]: [&Lanes; 3],
        limited: &Lanes,
        before_failure: &Lanes,
    ) -> Lanes {
        let mut matter = *density;
        let mut alpha = [1.0; LANES];
        if self.porosity.is_some() {
            for k in 0..LANES {
                alpha[k] = self.distension(distension[k]);
                matter[k] *= alpha[k];
            }
        }
        for k in 0..LANES {
            if limited[k] > before_failure[k] {
                matter[k] = self.torn_density(matter[k], energy[k], limited[k] * alpha[k]);
            }
        }
        thermal.temperatures(&matter, energy)
    }

    /// Specific energy (J/kg) without what plastic work (J/kg) has stored in the matter otherwise
    /// than as heat: what temperatures follow.
    #[inline(always)]
    #[must_use]
    pub fn thermal_energy(&self, specific_energy: f64, plastic_energy: f64) -> f64 {
        specific_energy - self.stored_share() * plastic_energy
    }

    /// Share of plastic work that is stored in the matter otherwise than as heat.
    #[inline(always)]
    #[must_use]
    pub fn stored_share(&self) -> f64 {
        let heat = |thermal: &Thermal| thermal.constants().taylor_quinney;
        1.0 - self.thermal.as_ref().map_or(1.0, heat)
    }

    /// [`Self::thermal_energy`] of a batch.
    #[inline(always)]
    #[must_use]
    pub fn thermal_energies(&self, energy: &Lanes, plastic_energy: &Lanes) -> Lanes {
        let mut thermal = *energy;
        for k in 0..LANES {
            thermal[k] = self.thermal_energy(energy[k], plastic_energy[k]);
        }
        thermal
    }

    /// [`Self::temperature`] of a batch, of densities, thermal energies, damage and distensions.
    #[must_use]
    pub fn temperatures(
        &self,
        [density, energy, damage, distension]: [&Lanes; 4],
    ) -> Option<Lanes> {
        let thermal = self.thermal.as_ref()?;
        let before_failure = if self.porosity.is_some() {
            let mut pressure = [0.0; LANES];
            for k in 0..LANES {
                let alpha = self.distension(distension[k]);
                let at = (self.eos).at(self.matter_density(), density[k] * alpha, energy[k]);
                pressure[k] = at.pressure / alpha;
            }
            pressure
        } else {
            let response = (self.eos).response(self.reference_density, density, energy);
            response.pressure
        };
        let limited = self.limited([density, energy], damage, &before_failure);
        let state = [density, energy, distension];
        Some(self.torn_temperatures(thermal, state, &limited, &before_failure))
    }

    /// [`Self::temperatures`] of a batch right after its [update](Self::update), which has returned `before_failure`: most need
    /// no equation of state any more.
    #[inline(always)]
    #[must_use]
    pub fn updated_temperatures(
        &self,
        after: &PointBatch,
        plastic_energy: &Lanes,
        before_failure: &Lanes,
    ) -> Option<Lanes> {
        let thermal = self.thermal.as_ref()?;
        let energy = self.thermal_energies(&after.specific_energy, plastic_energy);
        if energy != after.specific_energy {
            return self.temperatures([&after.density, &energy, &after.damage, &after.distension]);
        }
        let state = [&after.density, &energy, &after.distension];
        if self.porosity.is_none() && before_failure.iter().all(|&pressure| pressure >= 0.0) {
            // No tension that failure could limit.
            return Some(thermal.temperatures(state[0], state[1]));
        }
        let limited = self.limited([state[0], state[1]], &after.damage, before_failure);
        Some(self.torn_temperatures(thermal, state, &limited, before_failure))
    }

    /// Pressures (Pa) of a batch after the largest tension, from those of the equation of state.
    fn limited(
        &self,
        [density, energy]: [&Lanes; 2],
        damage: &Lanes,
        before_failure: &Lanes,
    ) -> Lanes {
        let mut point = PointBatch {
            density: *density,
            specific_energy: *energy,
            pressure: *before_failure,
            damage: *damage,
            ..PointBatch::ZERO
        };
        self.limit_tension(&mut point);
        point.pressure
    }

    /// Bounds the tension: that of the strength, and what failure leaves of it.
    #[inline(always)]
    fn limit_tension(&self, point: &mut PointBatch) {
        self.strength.limit_tension(point);
        self.failure.limit_tension(point);
    }

    /// Specific energy (J/kg) at a density (kg/m³) and temperature (K) of matter without damage, if
    /// the material has thermal constants: [`Self::temperature`] of it is that temperature.
    #[must_use]
    pub fn energy(&self, density: f64, temperature: f64) -> Option<f64> {
        self.energy_at(density, temperature, false)
    }

    /// The same of matter that has been compressed to its density for the first time.
    #[must_use]
    pub fn loaded_energy(&self, density: f64, temperature: f64) -> Option<f64> {
        self.energy_at(density, temperature, true)
    }

    /// The same; pores crush if `crushes`.
    fn energy_at(&self, density: f64, temperature: f64, crushes: bool) -> Option<f64> {
        let thermal = self.thermal.as_ref()?;
        let specific_heat = thermal.constants().specific_heat;
        let matter = density * self.distension(0.0);
        let mut energy = thermal.cold_energy(matter) + specific_heat * temperature;
        // What a cut-off tears is denser than its mean, and its cold energy another; and pores give way to heat.
        for _ in 0..TORN_STEPS {
            let PorousPoint { distension, .. } = self.first(density, energy, crushes);
            let missed = temperature - self.temperature(density, energy, [0.0, distension])?;
            if missed.abs() <= TORN_ERROR * temperature {
                break;
            }
            energy += specific_heat * missed;
        }
        Some(energy)
    }

    /// Advances a batch of points by `dt` (s), and tells the pressures (Pa) of the equation of state, which
    /// failure may limit.
    ///
    /// With `dt = 0` elastic stress, plastic strain and damage stay as they are, to the last bit,
    /// and all that follows from the given state (pressure, sound speed, viscous stress) becomes that
    /// of it.
    ///
    /// The laws are compiled once for each instruction set, apart from the sweeps that call them. Those that follow the
    /// state slow down those that do not where both stand in one function.
    pub fn update(&self, batch: &mut PointBatch, dt: f64) -> Lanes {
        let material = self;
        if self.follows_state() {
            instructions().run(Update::<true> {
                material,
                batch,
                dt,
            })
        } else {
            instructions().run(Update::<false> {
                material,
                batch,
                dt,
            })
        }
    }

    /// True if a law follows the state.
    fn follows_state(&self) -> bool {
        self.strength.follows_state()
            || self.failure.follows_state()
            || self.porosity.is_some()
            || self.burns()
            || self.eos.spray_energy().is_some()
    }

    /// All laws in their order; without `ALL`, only those that do not follow the state.
    #[inline(always)]
    fn compose<const ALL: bool>(&self, batch: &mut PointBatch, dt: f64) -> Lanes {
        let rho0 = self.reference_density;
        let cracks = self.failure.hashin.is_some();
        let torn = self.strength.bounds_tension() || cracks;
        let spray = self.eos.spray_energy();
        if ALL && (torn || self.failure.follows_state() || spray.is_some()) {
            let below = if torn { Some(f64::INFINITY) } else { spray };
            point::limit_expansion(batch, rho0, below.unwrap_or(f64::NEG_INFINITY));
        }
        let before = [batch.distension, batch.compaction];
        let unshared = [[1.0; LANES], [0.0; LANES]];
        let (response, [shares, crushed]) = match (&self.porosity, &self.eos) {
            (Some(porosity), _) if ALL => porosity.respond(&self.eos, batch, dt != 0.0),
            (_, Eos::Jwl(explosive)) if ALL => (self.burn(explosive, batch, dt), unshared),
            _ if ALL && cracks => (self.cracked_response(batch), unshared),
            _ => {
                let response = (self.eos).response(rho0, &batch.density, &batch.specific_energy);
                (response, unshared)
            }
        };
        batch.pressure = response.pressure;
        if ALL {
            self.failure.bulk(batch);
            self.strength.limit_tension(batch);
        }
        self.failure.limit_tension(batch);
        let bulk_modulus = self.bulk_modulus();
        let moduli = [
            self.strength.shear_modulus_beside(bulk_modulus),
            bulk_modulus,
        ];
        let mut now = Conditions::new(dt, rho0, moduli);
        now.options = self.failure.options;
        now.spalls = self
            .failure
            .spall
            .is_some_and(|spall| spall.follows_state());
        if ALL && let Some(porosity) = &self.porosity {
            now.permanent = crushed;
            if porosity.strength == StrengthOf::Matrix {
                now.bearing_density = porosity.solid.density;
            }
            now.reference_shear_modulus = self.shear_modulus();
            for k in 0..LANES {
                now.packing[k] = batch.distension[k] / porosity.distension;
                now.crushing[k] = porosity.damage(before[1][k], batch.compaction[k]);
            }
        }
        if ALL && self.needs_temperature() {
            self.set_temperatures(batch, &response, &mut now);
        }
        let strain = batch.plastic_strain;
        match &self.porosity {
            Some(porosity)
                if ALL && porosity.strength == StrengthOf::Matrix && !self.has_members() =>
            {
                self.act_in_matrix(batch, &mut now, (&before[0], &shares));
            }
            _ => self.strength.act::<ALL>(batch, &mut now, &self.failure),
        }
        if ALL && self.failure.follows_state() {
            for k in 0..LANES {
                now.plastic_increment[k] = batch.plastic_strain[k] - strain[k];
            }
            if self.failure.asks_hardening() {
                self.set_hardening(batch, &mut now);
            }
            let bulk_modulus = self.bulk_modulus_of(batch, &response);
            self.failure.fail(batch, &mut now, &bulk_modulus);
        }
        self.set_sound_speed(batch, &response, &now.shear_modulus);
        response.pressure
    }

    /// True if plastic strain tells where it has given way: what has directions cracks without any.
    #[must_use]
    pub fn shows_flow(&self) -> bool {
        self.strength.yields() && !self.has_directions()
    }

    /// True if it has directions of its own.
    #[must_use]
    pub fn has_directions(&self) -> bool {
        matches!(
            self.strength,
            Strength::Orthotropic(_) | Strength::Uncoupled(_)
        )
    }

    /// True if yarns or walls along its directions bear each for itself.
    #[inline(always)]
    #[must_use]
    pub fn has_members(&self) -> bool {
        matches!(self.strength, Strength::Uncoupled(_))
    }

    /// True if it is an explosive.
    #[must_use]
    pub fn burns(&self) -> bool {
        matches!(self.eos, Eos::Jwl(_))
    }

    /// The equation of state of the matter between cracks.
    #[inline(never)]
    fn cracked_response(&self, batch: &PointBatch) -> eos::Response {
        let (mut density, mut shares) = (batch.density, [1.0; LANES]);
        for k in 0..LANES {
            shares[k] = point::solid_share(batch, k);
            density[k] /= shares[k];
        }
        let energy = &batch.specific_energy;
        let mut response = (self.eos).response(self.reference_density, &density, energy);
        for k in 0..LANES {
            response.pressure[k] *= shares[k];
            response.dp_de[k] *= shares[k];
        }
        response
    }

    /// Burns a batch for a step (s).
    fn burn(&self, explosive: &Jwl, batch: &mut PointBatch, dt: f64) -> eos::Response {
        let mut now = Conditions::new(dt, self.reference_density, [0.0; 2]);
        now.options = self.failure.options;
        let mut sizes = [0.0; LANES];
        for k in 0..LANES {
            sizes[k] = now.size(batch, k);
        }
        explosive.burn_batch(self.reference_density, batch, dt, &sizes)
    }

    /// Strength of the matter between pores, whose stress is α times that of the whole, and whose strain is a share of that
    /// of the whole, from the distensions before the step.
    #[inline(never)]
    fn act_in_matrix(
        &self,
        batch: &mut PointBatch,
        now: &mut Conditions,
        (before, shares): (&Lanes, &Lanes),
    ) {
        let (stress, gradient) = (batch.deviatoric_stress, batch.velocity_gradient);
        let pressure = batch.pressure;
        for k in 0..LANES {
            let alpha = self.distension(before[k]);
            for component in &mut batch.deviatoric_stress {
                component[k] *= alpha;
            }
            batch.pressure[k] *= batch.distension[k];
            for row in 0..3 {
                for column in 0..3 {
                    let (here, across) =
                        (gradient[3 * row + column][k], gradient[3 * column + row][k]);
                    let (strain, spin) = (0.5 * (here + across), 0.5 * (here - across));
                    batch.velocity_gradient[3 * row + column][k] = shares[k] * strain + spin;
                }
            }
        }
        self.strength.act::<true>(batch, now, &self.failure);
        batch.velocity_gradient = gradient;
        batch.pressure = pressure;
        for k in 0..LANES {
            let share = 1.0 / batch.distension[k];
            now.shear_modulus[k] *= share;
            for component in &mut batch.deviatoric_stress {
                component[k] *= share;
            }
        }
        if now.dt == 0.0 {
            batch.deviatoric_stress = stress;
        }
    }

    /// True if a law follows the temperature.
    #[must_use]
    pub fn needs_temperature(&self) -> bool {
        self.strength.needs_temperature() || self.failure.needs_temperature()
    }

    /// True if a law asks who and how large a particle is, or what plastic work it has taken.
    #[must_use]
    pub fn needs_particle(&self) -> bool {
        self.failure.asks_identity()
            || self.needs_temperature() && self.stored_share() > 0.0
            || self.burns()
    }

    /// True if a law needs the melting temperature of the thermal constants.
    #[must_use]
    pub fn needs_melting(&self) -> bool {
        self.strength.needs_melting() || self.failure.needs_melting()
    }

    /// Temperatures (K) of a batch after the largest tension, and the constants they are judged by.
    fn set_temperatures(&self, batch: &PointBatch, response: &eos::Response, now: &mut Conditions) {
        if let Some(thermal) = &self.thermal {
            let rho = &batch.density;
            let e = self.thermal_energies(&batch.specific_energy, &batch.plastic_energy);
            let state = [rho, &e, &batch.distension];
            now.temperature =
                self.torn_temperatures(thermal, state, &batch.pressure, &response.pressure);
            now.thermal = *thermal.constants();
            if self.failure.has_memory() && now.options.molten != Some(Molten::Holds) {
                for k in 0..LANES {
                    let melting = self.melting_temperature(batch.density[k], batch.distension[k]);
                    now.melting[k] = melting.unwrap_or(f64::INFINITY);
                }
            }
        }
    }

    /// How the flow stress of what has flowed hardens, with the heat of the flow.
    #[inline(never)]
    fn set_hardening(&self, batch: &PointBatch, now: &mut Conditions) {
        let heat = 1.0 - self.stored_share();
        for k in 0..LANES {
            if now.plastic_increment[k] > 0.0 {
                let [by_strain, by_temperature] = self.strength.hardening(batch, k, now);
                let work = point::equivalent_stress(batch, k) / batch.density[k];
                let warming = heat * work / now.thermal.specific_heat;
                now.hardening[k] = by_strain + by_temperature * warming;
            }
        }
    }

    /// Bulk modulus (Pa) of the state, `ρ ∂p/∂ρ|ₛ`.
    #[inline(always)]
    fn bulk_modulus_of(&self, batch: &PointBatch, response: &eos::Response) -> Lanes {
        let mut modulus = self.bulk_speed_squared(batch, response);
        for k in 0..LANES {
            modulus[k] *= batch.density[k];
        }
        modulus
    }

    /// Longitudinal sound speed, `c² = ∂p/∂ρ|ₛ + 4G/(3ρ)`.
    #[inline(always)]
    fn set_sound_speed(
        &self,
        batch: &mut PointBatch,
        response: &eos::Response,
        shear_modulus: &Lanes,
    ) {
        let bulk = self.bulk_speed_squared(batch, response);
        for k in 0..LANES {
            let volume = 1.0 / batch.density[k];
            let shear = shear_modulus[k] * (4.0 / 3.0);
            batch.sound_speed[k] = (bulk[k] + shear * volume).sqrt();
        }
    }

    /// `∂p/∂ρ|ₛ`, by the first law `∂p/∂ρ|ₑ + (p/ρ²) ∂p/∂e|ᵨ`.
    ///
    /// `p` is the pressure after the cut-off, since that does the work. At the cut-off the
    /// pressure no longer answers to density; its derivatives are kept, so that the speed is
    /// that of the recompression to come.
    #[inline(always)]
    fn bulk_speed_squared(&self, batch: &PointBatch, response: &eos::Response) -> Lanes {
        let floor = SOUND_SPEED_SQUARED_FLOOR * self.bulk_modulus() / self.reference_density;
        let mut bulk = [0.0; LANES];
        for k in 0..LANES {
            let volume = 1.0 / batch.density[k];
            let de_drho = batch.pressure[k] * volume * volume;
            bulk[k] = at_least(response.dp_drho[k] + de_drho * response.dp_de[k], floor);
        }
        bulk
    }
}

/// The larger of a value and a bound; NaN stays NaN (which `f64::max` would hide).
#[inline(always)]
fn at_least(value: f64, bound: f64) -> f64 {
    if value < bound { bound } else { value }
}

/// The smaller of a value and a bound; NaN stays NaN.
#[inline(always)]
fn at_most(value: f64, bound: f64) -> f64 {
    if value > bound { bound } else { value }
}
