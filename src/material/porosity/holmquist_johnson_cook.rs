//! Compaction of concrete after Holmquist, Johnson and Cook.
//!
//! With the compression `μ = ρ/ρ₀ − 1` of the whole, virgin matter is elastic up to the point of crushing,
//! and its pores crush along a straight line up to the point of locking:
//!
//! ```text
//! p = K_e μ,    K_e = p_crush/μ_crush                                       (μ ≤ μ_crush)
//! p = p_crush + (p_lock − p_crush) x,    x = (μ − μ_crush)/(μ_plock − μ_crush)    (0 < x < 1)
//! ```
//!
//! Beyond it p is the pressure of the solid, whose density is `(1 + μ_lock) ρ₀`, so that the distension of virgin matter is
//! `1 + μ_lock`; with the polynomial of the paper it is `K₁ μ̄ + K₂ μ̄² + K₃ μ̄³`, `μ̄ = (μ − μ_lock)/(1 + μ_lock)`. `μ_plock`
//! is the compression at which the solid has the pressure `p_lock`, so that p is continuous. Matter that has come to the
//! place x unloads and bears tension along a straight line with the modulus `(1 − x) K_e + x K₁`.
//!
//! Source: Holmquist, Johnson & Cook (1993), *A computational constitutive model for concrete subjected to
//! large strains, high strain rates, and high pressures*, 14th Int. Symp. Ballistics, 591. An equation of state with heat moves
//! `μ_plock` to where the hot solid has `p_lock`. The distension follows from the pressure, by that of the solid; it is
//! one at least.

use super::{CompactionLaw, PointResponse, PoreState, PorousPoint, Solid, root};
use crate::{Contradiction, at_least, at_most};

law! {
    /// Crushing of concrete between two points.
    HolmquistJohnsonCookCompaction {
        /// Pressure `p_crush` from which on pores crush (Pa).
        crush_pressure: "Pa",
        /// Compression `μ_crush` at that pressure.
        crush_strain: "",
        /// Pressure `p_lock` at which all pores are crushed (Pa).
        lock_pressure: "Pa",
    }
}

/// Compression and pressure (Pa) of a place on the crush curve, and the modulus (Pa) by which it unloads.
struct Place {
    compression: f64,
    pressure: f64,
    modulus: f64,
}

/// Largest share of the solid's bulk modulus that the pressure of locking may have.
const MOST_OF_MODULUS: f64 = 0.25;

impl HolmquistJohnsonCookCompaction {
    /// Modulus `K_e` (Pa) of virgin matter.
    fn elastic_modulus(&self) -> f64 {
        self.crush_pressure / self.crush_strain
    }

    /// The place x between the points of crushing and of locking.
    fn place(&self, x: f64, locked: f64, solid: &Solid) -> Place {
        Place {
            compression: self.crush_strain + x * (locked - self.crush_strain),
            pressure: self.crush_pressure + x * (self.lock_pressure - self.crush_pressure),
            modulus: (1.0 - x) * self.elastic_modulus() + x * solid.bulk_modulus,
        }
    }

    /// Density (kg/m³) at which the solid has the pressure `p_lock`, and what it answers there.
    fn locked(
        &self,
        at: &PoreState,
        solid: &impl Fn(f64) -> PointResponse,
    ) -> (f64, PointResponse) {
        let least = at.solid.density / at.distension * (1.0 + self.crush_strain);
        let stiff = self.lock_pressure / at.solid.bulk_modulus;
        let most = at.solid.density * (1.0 + stiff / MOST_OF_MODULUS);
        let density = root(least, most, at.solid.density * (1.0 + stiff), |rho| {
            let of = solid(rho);
            [of.pressure - self.lock_pressure, of.dp_drho]
        });
        (density, solid(density))
    }

    /// `μ_plock` of a solid without heat whose pressure is linear.
    fn linear_lock(&self, distension: f64, solid: &Solid) -> f64 {
        distension * (1.0 + self.lock_pressure / solid.bulk_modulus) - 1.0
    }
}

/// Compression at which the line of a place has no pressure.
fn permanent(place: &Place) -> f64 {
    place.compression - place.pressure / place.modulus
}

/// The distension with which the solid gives a pressure (Pa) of the whole, and its answer there.
fn distension(
    at: &PoreState,
    pressure: f64,
    solid: &impl Fn(f64) -> PointResponse,
) -> (f64, PointResponse) {
    let rho = at.density;
    let dense = solid(rho);
    if dense.pressure >= pressure {
        return (1.0, dense);
    }
    let free = at.solid.density / rho;
    let most = 2.0 * at_least(free, 1.0);
    let start = at_least(free * (1.0 + pressure / at.solid.bulk_modulus), 1.0);
    let alpha = root(1.0, most, start, |alpha| {
        let of = solid(alpha * rho);
        [of.pressure - alpha * pressure, rho * of.dp_drho - pressure]
    });
    (alpha, solid(alpha * rho))
}

impl CompactionLaw for HolmquistJohnsonCookCompaction {
    fn contradiction(&self) -> Option<Contradiction> {
        (self.lock_pressure <= self.crush_pressure).then_some(Contradiction {
            keys: &["lock_pressure", "crush_pressure"],
            title: "`lock_pressure` must be above `crush_pressure`: pores crush between them",
        })
    }

    fn contradicts(&self, distension: f64, solid: &Solid) -> Option<Contradiction> {
        let elastic = self.elastic_modulus();
        if elastic > solid.bulk_modulus {
            return Some(Contradiction {
                keys: &["crush_strain", "crush_pressure"],
                title: "virgin matter, `crush_pressure` over `crush_strain`, must not be stiffer than the solid",
            });
        }
        if self.lock_pressure > MOST_OF_MODULUS * solid.bulk_modulus {
            return Some(Contradiction {
                keys: &["lock_pressure"],
                title: "`lock_pressure` must be at most a quarter of the bulk modulus of the solid",
            });
        }
        let span = self.linear_lock(distension, solid) - self.crush_strain;
        let rise = self.lock_pressure - self.crush_pressure;
        (span * elastic <= rise).then_some(Contradiction {
            keys: &["crush_strain", "lock_pressure"],
            title: "with this `crush_strain` matter is softer before its pores crush than while they do",
        })
    }

    fn bulk_modulus(&self, _density: f64, _solid: &Solid) -> f64 {
        self.elastic_modulus()
    }

    /// That of the place without pressure.
    fn crushed(&self, distension: f64, solid: &Solid, compaction: f64) -> f64 {
        let locked = self.linear_lock(distension, solid);
        let place = self.place(compaction, locked, solid);
        at_least(distension / (1.0 + permanent(&place)), 1.0)
    }

    /// The compression at which the line of the place has no pressure.
    fn permanent(
        &self,
        at: &PoreState,
        solid: &impl Fn(f64) -> PointResponse,
        compaction: f64,
    ) -> f64 {
        let (density, _) = self.locked(at, solid);
        let locked = density / at.solid.density * at.distension - 1.0;
        permanent(&self.place(compaction, locked, at.solid))
    }

    #[inline]
    fn advance(&self, at: &PoreState, solid: impl Fn(f64) -> PointResponse) -> PorousPoint {
        let dense = |response| PorousPoint {
            response,
            distension: 1.0,
            compaction: 1.0,
            share: 1.0,
            crushed: 0.0,
        };
        if at.compaction >= 1.0 {
            return dense(solid(at.density));
        }
        let whole = at.solid.density / at.distension;
        let mu = at.compression - 1.0;
        // Virgin matter does not know where it will lock.
        let virgin = at.compaction == 0.0 && !(at.crushes && mu > self.crush_strain);
        let (locked, heat) = if virgin {
            (self.crush_strain, 0.0)
        } else {
            let (density, of) = self.locked(at, &solid);
            (density / whole - 1.0, of.dp_de / of.dp_drho)
        };
        let mut compaction = at.compaction;
        let mut place = self.place(compaction, locked, at.solid);
        let crushes = at.crushes && mu > place.compression;
        if crushes {
            if mu >= locked {
                return dense(solid(at.density));
            }
            let x = (mu - self.crush_strain) / (locked - self.crush_strain);
            compaction = at_least(at_most(x, 1.0), compaction);
            place = self.place(compaction, locked, at.solid);
        }
        let pressure = if compaction == 0.0 {
            // Without pressure at rest, to the bit.
            place.modulus * mu
        } else {
            place.pressure + place.modulus * (mu - place.compression)
        };
        // Sound is that of release, which is faster than that of crushing.
        let dp_drho = place.modulus / whole;
        let response = PointResponse {
            pressure,
            dp_drho,
            // Heat moves the point of locking, and with it the line.
            dp_de: compaction * dp_drho * heat,
        };
        let (distension, of) = distension(at, pressure, &solid);
        let slope = if crushes {
            (self.lock_pressure - self.crush_pressure) / (whole * (locked - self.crush_strain))
        } else {
            dp_drho
        };
        let taken = pressure / at.density;
        let share = at_most((slope - taken) / (of.dp_drho - taken), 1.0);
        PorousPoint {
            response,
            distension,
            compaction,
            share: at_least(share, 0.0),
            crushed: 0.0,
        }
    }
}
