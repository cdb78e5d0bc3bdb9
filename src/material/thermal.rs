//! Temperature from density and specific energy.
//!
//! With a constant specific heat `c_v`, `T = (e − e_c(ρ))/c_v`, where `e_c` is the energy of the
//! cold curve: the isentrope of zero temperature, `de_c/dρ = p(ρ, e_c)/ρ²`, through `e_c(ρ₀) = e₀ −
//! c_v T₀`, since the reference state (ρ₀, e₀) has the temperature T₀. This is exact for an
//! equation of state that is linear in e (Mie–Grüneisen, ideal gas), for which `p = p_c(ρ) + Γ(ρ) ρ
//! c_v T` follows; for Tillotson's it is an approximation. Source: Zel'dovich & Raizer (1967),
//! *Physics of shock waves*, XI §§3–5. Heat of melting and vaporisation is not part of it, and T is
//! never below zero.

use super::eos::Eos;
use super::{LANES, Lanes, at_least, at_most};
use numerics::lanes as numerics;

/// The cold curve is held constant beyond these relative volumes ρ₀/ρ.
const VOLUMES: [f64; 2] = [0.2, 2.0];
/// Intervals of the table between them.
const INTERVALS: u32 = 180;
/// The node of the volume one, where branches of an equation of state may join.
const REFERENCE: u32 = 80;
/// Fourth-order steps in each interval.
const STEPS: u32 = 8;

/// Thermal constants of a material, with the cold curve of its equation of state.
#[derive(Debug, Clone, PartialEq)]
pub struct Thermal {
    constants: ThermalConstants,
    reference_density: f64,
    /// `e_c` (J/kg) and its slope by interval, `de_c/dn`, at each node.
    cold: Vec<[f64; 2]>,
    /// Lower bound of `e_c` (J/kg).
    least_cold: f64,
}

/// Constants that a user states of a material's heat.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ThermalConstants {
    /// Specific heat `c_v` (J/(kg K)).
    pub specific_heat: f64,
    /// Temperature T₀ of the reference state (K).
    pub reference_temperature: f64,
    /// Melting temperature (K), if there is one.
    pub melting_temperature: Option<f64>,
    /// Share of plastic work that becomes heat (Taylor & Quinney 1934, Proc. R. Soc. A 143, 307);
    /// the rest is stored in the lattice and heats nothing.
    pub taylor_quinney: f64,
}

impl ThermalConstants {
    /// Of a material without heat: always at its reference temperature.
    pub(super) const ISOTHERMAL: Self = Self {
        specific_heat: f64::INFINITY,
        reference_temperature: 0.0,
        melting_temperature: None,
        taylor_quinney: 1.0,
    };

    /// Homologous temperature `(T − T₀)/(T_m − T₀)` of Johnson and Cook's laws, between 0 and 1; 0
    /// without a melting temperature.
    #[inline(always)]
    #[must_use]
    pub fn homologous(&self, temperature: f64) -> f64 {
        let cold = self.reference_temperature;
        let melting = self.melting_temperature.unwrap_or(f64::INFINITY);
        if temperature > cold {
            at_most((temperature - cold) / (melting - cold), 1.0)
        } else {
            0.0
        }
    }
}

impl Thermal {
    /// Integrates the cold curve of an equation of state with reference density `rho0` (kg/m³).
    #[must_use]
    pub fn new(constants: ThermalConstants, rho0: f64, eos: &Eos) -> Self {
        let slope = |v: f64, e: f64| -eos.at(rho0, rho0 / v, e).pressure / rho0;
        let node = |n: u32, e: f64| [e, slope(volume(n), e) * width()];
        let first =
            eos.reference_energy(rho0) - constants.specific_heat * constants.reference_temperature;
        // From the reference volume down and up.
        let mut e = first;
        let mut cold = vec![node(REFERENCE, e)];
        for n in (0..REFERENCE).rev() {
            e = integrate(volume(n + 1), e, -width(), slope);
            cold.push(node(n, e));
        }
        cold.reverse();
        e = first;
        for n in REFERENCE..INTERVALS {
            e = integrate(volume(n), e, width(), slope);
            cold.push(node(n + 1, e));
        }
        Self {
            constants,
            reference_density: rho0,
            least_cold: least(&cold),
            cold,
        }
    }

    /// The constants.
    #[must_use]
    pub fn constants(&self) -> &ThermalConstants {
        &self.constants
    }

    /// Energy of the cold curve (J/kg) at density `rho` (kg/m³).
    #[must_use]
    pub fn cold_energy(&self, rho: f64) -> f64 {
        let (ends, t) = self.interval(self.place(rho));
        between(ends, t)
    }

    /// Place in the table of density `rho` (kg/m³), in intervals.
    #[inline(always)]
    fn place(&self, rho: f64) -> f64 {
        let v = at_least(self.reference_density / rho, VOLUMES[0]);
        (at_most(v, VOLUMES[1]) - VOLUMES[0]) / width()
    }

    /// Both ends of the interval of a place, and how far in it that is.
    #[inline(always)]
    fn interval(&self, place: f64) -> ([[f64; 2]; 2], f64) {
        // NaN has the interval 0 and stays in `t`.
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // within the table
        let n = (place as u32).min(INTERVALS - 1);
        let t = place - f64::from(n);
        let n = n as usize;
        ([self.cold[n], self.cold[n + 1]], t)
    }

    /// Temperature (K) at density `rho` (kg/m³) and specific energy `e` (J/kg).
    #[must_use]
    pub fn temperature(&self, rho: f64, e: f64) -> f64 {
        at_least(
            (e - self.cold_energy(rho)) / self.constants.specific_heat,
            0.0,
        )
    }

    /// Temperatures (K) that those of a batch with specific energies `e` (J/kg) are not above, at any density: those at
    /// the least cold energy.
    #[inline(always)]
    #[must_use]
    pub fn most<V: numerics::Lanes>(&self, e: &Lanes) -> V {
        let above = V::read(e).sub(V::splat(self.least_cold));
        above.div(V::splat(self.constants.specific_heat))
    }

    /// [`Self::temperature`] of a batch: loops of their own for what vectors do and for the table.
    #[inline(always)]
    #[must_use]
    pub fn temperatures(&self, rho: &Lanes, e: &Lanes) -> Lanes {
        let mut places = [0.0; LANES];
        for k in 0..LANES {
            places[k] = self.place(rho[k]);
        }
        let (mut e0, mut d0, mut e1, mut d1) =
            ([0.0; LANES], [0.0; LANES], [0.0; LANES], [0.0; LANES]);
        let mut t = [0.0; LANES];
        for k in 0..LANES {
            ([[e0[k], d0[k]], [e1[k], d1[k]]], t[k]) = self.interval(places[k]);
        }
        let mut all = [0.0; LANES];
        for k in 0..LANES {
            let cold = between([[e0[k], d0[k]], [e1[k], d1[k]]], t[k]);
            all[k] = at_least((e[k] - cold) / self.constants.specific_heat, 0.0);
        }
        all
    }
}

/// Lower bound of the cubics between all nodes: a cubic lies within its Bézier points, here those
/// of an interval, less some units of their last place.
fn least(nodes: &[[f64; 2]]) -> f64 {
    let points = nodes.windows(2).flat_map(|pair| {
        let [[e0, d0], [e1, d1]] = [pair[0], pair[1]];
        [e0, e0 + d0 / 3.0, e1 - d1 / 3.0, e1]
    });
    let (least, size) = points.fold((f64::INFINITY, 0.0), |(least, size): (f64, f64), e| {
        (least.min(e), size.max(e.abs()))
    });
    least - 1e-12 * size
}

/// Energy (J/kg) at `t` between two nodes with their slopes, by Hermite's cubic.
#[inline(always)]
fn between([[e0, d0], [e1, d1]]: [[f64; 2]; 2], t: f64) -> f64 {
    let (s, rise) = (1.0 - t, e1 - e0);
    e0 * s + e1 * t + t * s * ((d0 - rise) * s - (d1 - rise) * t)
}

/// Excess density (kg/m³) over the mean of torn material whose pressure a cut-off has raised by
/// `excess` (Pa). Voids hold no energy, so the cold energy is that of the material between them,
/// whose pressure is the cut-off. Exact where pressure is linear in density.
pub(super) fn opening(excess: f64, dp_drho: f64) -> f64 {
    if excess > 0.0 && dp_drho > 0.0 {
        excess / dp_drho
    } else {
        0.0
    }
}

/// Width of an interval.
fn width() -> f64 {
    (VOLUMES[1] - VOLUMES[0]) / f64::from(INTERVALS)
}

/// Relative volume of a node.
fn volume(n: u32) -> f64 {
    if n == REFERENCE {
        1.0
    } else {
        VOLUMES[0] + width() * f64::from(n)
    }
}

/// Runge and Kutta's fourth-order rule over an interval of the volume.
fn integrate(v: f64, e: f64, width: f64, slope: impl Fn(f64, f64) -> f64) -> f64 {
    let d = width / f64::from(STEPS);
    (0..STEPS).fold(e, |e, n| {
        let v = v + d * f64::from(n);
        let a = slope(v, e);
        let b = slope(v + 0.5 * d, e + 0.5 * d * a);
        let c = slope(v + 0.5 * d, e + 0.5 * d * b);
        let last = slope(v + d, e + d * c);
        e + d / 6.0 * (a + 2.0 * (b + c) + last)
    })
}
