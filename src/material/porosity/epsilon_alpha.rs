//! The ε–α law: distension as a function of the volumetric strain.
//!
//! With the strain `ε = ln(ρ₀/ρ)`, negative in compression, pores crush along
//!
//! ```text
//! α = α_e exp[κ (ε − ε_e)]                              ε_x < ε < ε_e
//! α = 1 + (α_x − 1) [(ε_c − ε)/(ε_c − ε_x)]²             ε_c < ε < ε_x
//! α = 1                                                  ε < ε_c
//! ```
//!
//! with `α_x` of the first at `ε_x` and `ε_c = ε_x + 2 (1 − α_x)/(κ α_x)`, so that value and slope are
//! continuous (Wünnemann, Collins & Melosh 2006, Icarus 180, 514). Above the least strain `ε_k` of the
//! curve that the matter has been at, α is elastic,
//!
//! ```text
//! dα/dε = α (1 − χ²),    χ = 1 + (α − 1) (c_e/c_s − 1)/(α₀ − 1)
//! ```
//!
//! so that sound has the speed `c_e` in virgin matter and that of the solid, `c_s`, once all pores are crushed
//! (Collins, Melosh & Wünnemann 2011, Int. J. Impact Eng. 38, 434); it keeps the χ of the place on the
//! curve. Without a `c_e`, χ = 1 and α does not change above `ε_k`. The correction of that paper for thermal
//! expansion of the solid is left out.

use super::{CompactionLaw, PointResponse, PoreState, PorousPoint, Solid, modulus};
use crate::{Contradiction, at_most};

law! {
    /// Distension as a function of the volumetric strain.
    EpsilonAlpha {
        /// Volumetric strain `ε_e` from which on pores crush, negative in compression.
        elastic_strain: "",
        /// Volumetric strain `ε_x` at which the exponential part of the crush curve ends.
        transition_strain: "",
        /// Rate κ of the exponential part.
        kappa: "",
        /// Bulk sound speed `c_e` of virgin matter (m/s); zero for that of the solid.
        sound_speed: "m/s",
    }
}

/// The crush curve of one distension.
struct Curve {
    /// χ² of virgin matter.
    virgin: f64,
    /// `α_e`, `α_x`.
    first: f64,
    middle: f64,
    /// `ε_c`.
    end: f64,
}

impl EpsilonAlpha {
    fn virgin_ratio(&self, solid: &Solid) -> f64 {
        if self.sound_speed > 0.0 {
            self.sound_speed / solid.sound_speed()
        } else {
            1.0
        }
    }

    fn curve(&self, distension: f64, solid: &Solid) -> Curve {
        let chi = self.virgin_ratio(solid);
        let virgin = chi * chi;
        let first = distension * libm::exp((1.0 - virgin) * self.elastic_strain);
        let strain = self.transition_strain - self.elastic_strain;
        let middle = first * libm::exp(self.kappa * strain);
        let end = self.transition_strain + 2.0 * (1.0 - middle) / (self.kappa * middle);
        Curve {
            virgin,
            first,
            middle,
            end,
        }
    }

    /// Distension on the crush curve and its derivative by the strain.
    fn on(&self, curve: &Curve, strain: f64) -> [f64; 2] {
        if strain >= self.transition_strain {
            let alpha = curve.first * libm::exp(self.kappa * (strain - self.elastic_strain));
            [alpha, self.kappa * alpha]
        } else if strain > curve.end {
            let span = curve.end - self.transition_strain;
            let left = (curve.end - strain) / span;
            let height = curve.middle - 1.0;
            [1.0 + height * left * left, -2.0 * height * left / span]
        } else {
            [1.0, 0.0]
        }
    }
}

impl CompactionLaw for EpsilonAlpha {
    fn contradiction(&self) -> Option<Contradiction> {
        (self.transition_strain > self.elastic_strain).then_some(Contradiction {
            keys: &["transition_strain", "elastic_strain"],
            title: "`transition_strain` must not be above `elastic_strain`: both are negative in compression",
        })
    }

    fn contradicts(&self, distension: f64, solid: &Solid) -> Option<Contradiction> {
        if self.virgin_ratio(solid) > 1.0 {
            return Some(Contradiction {
                keys: &["sound_speed"],
                title: "`sound_speed` of the porous material must not be above that of the solid",
            });
        }
        (self.curve(distension, solid).middle <= 1.0).then_some(Contradiction {
            keys: &["transition_strain", "kappa"],
            title: "with this `transition_strain` all pores are crushed before the exponential part of the curve ends",
        })
    }

    fn bulk_modulus(&self, density: f64, solid: &Solid) -> f64 {
        modulus(density, self.sound_speed, solid)
    }

    #[inline]
    fn crushed(&self, distension: f64, solid: &Solid, compaction: f64) -> f64 {
        let curve = self.curve(distension, solid);
        let strain = self.elastic_strain + compaction * (curve.end - self.elastic_strain);
        self.on(&curve, strain)[0]
    }

    #[inline]
    fn advance(&self, at: &PoreState, solid: impl Fn(f64) -> PointResponse) -> PorousPoint {
        let curve = self.curve(at.distension, at.solid);
        let strain = -libm::log(at.compression);
        let span = curve.end - self.elastic_strain;
        let reached = self.elastic_strain + at.compaction * span;
        let chi_squared = |alpha: f64| {
            let chi =
                1.0 + (alpha - 1.0) * (curve.virgin.sqrt() - 1.0) / (at.distension - 1.0);
            at_most(chi * chi, 1.0)
        };
        let (alpha, stiff, compaction, share) =
            if at.crushes && at.compaction < 1.0 && strain < reached {
                let [alpha, slope] = self.on(&curve, strain);
                let place = at_most((strain - self.elastic_strain) / span, 1.0);
                let stiff = if alpha > 1.0 { chi_squared(alpha) } else { 1.0 };
                (alpha, stiff, place, 1.0 - at_most(slope / alpha, 1.0))
            } else if at.compaction == 0.0 {
                let stiff = curve.virgin;
                let alpha = at.distension * libm::exp((1.0 - stiff) * strain);
                (alpha, stiff, 0.0, stiff)
            } else if at.compaction < 1.0 {
                let [crushed, _] = self.on(&curve, reached);
                let stiff = chi_squared(crushed);
                let alpha = crushed * libm::exp((1.0 - stiff) * (strain - reached));
                (alpha, stiff, at.compaction, stiff)
            } else {
                (1.0, 1.0, 1.0, 1.0)
            };
        let of = solid(alpha * at.density);
        let pressure = of.pressure / alpha;
        PorousPoint {
            response: PointResponse {
                pressure,
                // Of release, with dα/dρ = −(1 − χ²) α/ρ.
                dp_drho: stiff * of.dp_drho + (1.0 - stiff) * pressure / at.density,
                dp_de: of.dp_de / alpha,
            },
            distension: alpha,
            compaction,
            share,
            crushed: 0.0,
        }
    }
}
