//! The P–α law: distension as a function of the pressure.
//!
//! Pores crush along
//!
//! ```text
//! α = 1 + (α_e − 1) [(P_s − P)/(P_s − P_e)]^n,    P_e < P < P_s
//! ```
//!
//! (Herrmann 1969, J. Appl. Phys. 40, 2490, with n = 2; Carroll & Holt 1972 have α = 1 from `P_s` on), or
//! with a steeper beginning up to a transition pressure `P_t`,
//!
//! ```text
//! α = 1 + (α_e − α_t) [(P_t − P)/(P_t − P_e)]^n₁ + (α_t − 1) [(P_s − P)/(P_s − P_e)]^n,    P_e < P < P_t
//! ```
//!
//! and the second power alone beyond it (Jutzi, Michel, Hiraoka, Nakamura & Benz 2009, Icarus 201, 802).
//!
//! Below the largest pressure `P_k` of the curve that the matter has been at, α is elastic (Jutzi, Benz &
//! Michel 2008, Icarus 198, 242):
//!
//! ```text
//! dα/dP = (α²/K_s) (1 − 1/h²),    h = 1 + (α − 1) (c_e/c_s − 1)/(α_e − 1)
//! ```
//!
//! so that sound has the speed `c_e` in virgin matter and that of the solid, `c_s`, once all pores are
//! crushed. With the h of the place on the curve this integrates to `α = α_z/(1 + β P)`,
//! `β = α_z (1/h² − 1)/K_s`, where `α_z` is the distension without pressure; without a `c_e`, h = 1 and α
//! does not change below `P_k`. Under tension the same line holds, and pores open by no more than
//! `β K_s`.
//!
//! The pressure and α at the end of a step are the roots of both equations at its density and energy, so
//! that a step of any size leads to the same place as many small ones.

use super::{CompactionLaw, PointResponse, PoreState, PorousPoint, Solid, modulus, root, whole};
use crate::{Contradiction, at_least};

law! {
    /// Distension as a function of the pressure.
    PAlpha {
        /// Pressure `P_e` from which on pores crush (Pa).
        elastic_pressure: "Pa",
        /// Pressure `P_s` at which all pores are crushed (Pa).
        solid_pressure: "Pa",
        /// Exponent n of the crush curve.
        exponent: "",
        /// Pressure `P_t` at which the steep beginning of the crush curve ends (Pa); zero without one.
        transition_pressure: "Pa",
        /// Distension `α_t` of the steep beginning.
        transition_distension: "",
        /// Exponent n₁ of the steep beginning.
        transition_exponent: "",
        /// Bulk sound speed `c_e` of virgin matter (m/s); zero for that of the solid.
        sound_speed: "m/s",
    }
}

/// Elastic line of matter that has been at one place of the crush curve.
struct Line {
    /// Distension without pressure, `α_z`.
    free: f64,
    /// β (1/Pa).
    beta: f64,
}

impl PAlpha {
    /// h of virgin matter.
    fn virgin_ratio(&self, solid: &Solid) -> f64 {
        if self.sound_speed > 0.0 {
            self.sound_speed / solid.sound_speed()
        } else {
            1.0
        }
    }

    /// Distension `α_e` at which crushing begins.
    fn elastic_limit(&self, distension: f64, solid: &Solid) -> f64 {
        let h = self.virgin_ratio(solid);
        let softer = 1.0 / (h * h) - 1.0;
        1.0 / (1.0 / distension + self.elastic_pressure / solid.bulk_modulus * softer)
    }

    /// Distension on the crush curve, which begins at `first`, and its slope (1/Pa).
    fn curve(&self, first: f64, pressure: f64) -> [f64; 2] {
        let (begin, end) = (self.elastic_pressure, self.solid_pressure);
        let power = |to: f64, exponent: f64, height: f64| {
            let span = to - begin;
            let left = at_least((to - pressure) / span, 0.0);
            let base = libm::pow(left, exponent - 1.0);
            [height * base * left, -height * exponent * base / span]
        };
        if self.transition_pressure == 0.0 {
            let [rest, slope] = power(end, self.exponent, first - 1.0);
            return [1.0 + rest, slope];
        }
        let middle = self.transition_distension;
        let [rest, slope] = power(end, self.exponent, middle - 1.0);
        if pressure >= self.transition_pressure {
            return [1.0 + rest, slope];
        }
        let [steep, steep_slope] = power(
            self.transition_pressure,
            self.transition_exponent,
            first - middle,
        );
        [1.0 + steep + rest, steep_slope + slope]
    }

    /// Pressure (Pa) of a place on the crush curve.
    fn pressure(&self, compaction: f64) -> f64 {
        self.elastic_pressure + compaction * (self.solid_pressure - self.elastic_pressure)
    }

    /// The elastic line of a place on the crush curve.
    fn line(&self, at: &PoreState, first: f64, compaction: f64) -> Line {
        let virgin = self.virgin_ratio(at.solid);
        let softer = |h: f64| (1.0 / (h * h) - 1.0) / at.solid.bulk_modulus;
        if compaction == 0.0 {
            let free = at.distension;
            let beta = free * softer(virgin);
            return Line { free, beta };
        }
        let pressure = self.pressure(compaction);
        let [alpha, _] = self.curve(first, pressure);
        let soft = softer(1.0 + (alpha - 1.0) * (virgin - 1.0) / (first - 1.0));
        // 1/α = 1/α_z + soft P.
        let free = 1.0 / (1.0 / alpha - soft * pressure);
        Line {
            free,
            beta: free * soft,
        }
    }
}

impl CompactionLaw for PAlpha {
    fn contradiction(&self) -> Option<Contradiction> {
        let (begin, middle, end) = (
            self.elastic_pressure,
            self.transition_pressure,
            self.solid_pressure,
        );
        if end <= begin {
            return Some(Contradiction {
                keys: &["solid_pressure", "elastic_pressure"],
                title: "`solid_pressure` must be above `elastic_pressure`: pores crush between them",
            });
        }
        for (keys, exponent, title) in [
            (
                &["exponent"] as &'static [&str],
                self.exponent,
                "`exponent` must be 1 or more: pores crush from `elastic_pressure` on",
            ),
            (
                &["transition_exponent"],
                self.transition_exponent,
                "`transition_exponent` must be 1 or more: pores crush from `elastic_pressure` on",
            ),
        ] {
            if exponent < 1.0 {
                return Some(Contradiction { keys, title });
            }
        }
        let stated = middle != 0.0;
        (stated && !(begin < middle && middle < end)).then_some(Contradiction {
            keys: &["transition_pressure"],
            title: "`transition_pressure` must lie between `elastic_pressure` and `solid_pressure`",
        })
    }

    fn contradicts(&self, distension: f64, solid: &Solid) -> Option<Contradiction> {
        let h = self.virgin_ratio(solid);
        if h > 1.0 {
            return Some(Contradiction {
                keys: &["sound_speed"],
                title: "`sound_speed` of the porous material must not be above that of the solid",
            });
        }
        let first = self.elastic_limit(distension, solid);
        // Elastic lines stay far from their pole at all pressures of the curve.
        let soft = (1.0 / (h * h) - 1.0) * self.solid_pressure / solid.bulk_modulus;
        if first <= 1.0 || soft * distension > 0.5 {
            return Some(Contradiction {
                keys: &["sound_speed", "elastic_pressure"],
                title: "with this `sound_speed` pores close elastically before they crush",
            });
        }
        let middle = self.transition_distension;
        (self.transition_pressure > 0.0 && !(1.0..=first).contains(&middle)).then_some(
            Contradiction {
                keys: &["transition_distension", "transition_pressure"],
                title: "`transition_distension` must lie between 1 and the initial distension",
            },
        )
    }

    fn bulk_modulus(&self, density: f64, solid: &Solid) -> f64 {
        modulus(density, self.sound_speed, solid)
    }

    #[inline]
    fn crushed(&self, distension: f64, solid: &Solid, compaction: f64) -> f64 {
        let first = self.elastic_limit(distension, solid);
        self.curve(first, self.pressure(compaction))[0]
    }

    #[inline]
    fn advance(&self, at: &PoreState, solid: impl Fn(f64) -> PointResponse) -> PorousPoint {
        let (first, rho) = (self.elastic_limit(at.distension, at.solid), at.density);
        let elastic = |compaction: f64| {
            let line = self.line(at, first, compaction);
            let alpha = if line.beta == 0.0 {
                line.free
            } else {
                let most = line.free + line.beta * at.solid.bulk_modulus;
                root(1.0, most, line.free, |alpha| {
                    let of = solid(alpha * rho);
                    let inverse = 1.0 / line.beta;
                    [
                        of.pressure - (line.free - alpha) * inverse,
                        rho * of.dp_drho + inverse,
                    ]
                })
            };
            (alpha, -line.beta * alpha * alpha / line.free)
        };
        let (alpha, slope) = elastic(at.compaction);
        let of = solid(alpha * rho);
        let (response, share) = whole(&of, rho, alpha, slope);
        let reached = self.pressure(at.compaction);
        if !(at.crushes && at.compaction < 1.0 && response.pressure > reached) {
            return PorousPoint {
                response,
                distension: alpha,
                compaction: at.compaction,
                share,
                crushed: 0.0,
            };
        }
        // All pores are crushed, or pressure and distension are on the curve.
        let dense = solid(rho);
        if dense.pressure >= self.solid_pressure {
            return PorousPoint {
                response: dense,
                distension: 1.0,
                compaction: 1.0,
                share: 1.0,
                crushed: 0.0,
            };
        }
        let pressure = root(reached, self.solid_pressure, reached, |pressure| {
            let [alpha, slope] = self.curve(first, pressure);
            let of = solid(alpha * rho);
            [
                alpha * pressure - of.pressure,
                alpha + slope * (pressure - rho * of.dp_drho),
            ]
        });
        let span = self.solid_pressure - self.elastic_pressure;
        let compaction = ((pressure - self.elastic_pressure) / span).clamp(at.compaction, 1.0);
        let [alpha, crushing] = self.curve(first, pressure);
        let of = solid(alpha * rho);
        let line = self.line(at, first, compaction);
        // Sound is that of release, which is faster than that of crushing.
        let (response, _) = whole(&of, rho, alpha, -line.beta * alpha * alpha / line.free);
        let (_, share) = whole(&of, rho, alpha, crushing);
        PorousPoint {
            response,
            distension: alpha,
            compaction,
            share,
            crushed: 0.0,
        }
    }
}
