//! The contact potential of Vignjevic, De Vuyst & Campbell (2006), with the repulsive sign.
//!
//! `φ_i = Σ_j V_j K (W_ij/W(Δp̄))^n` (V 21) and
//! `f_i = −Σ_j V_i V_j K n W_ij^{n−1}/W(Δp̄)^n ∇_i W_ij` (V 24 read as −∇φ); the energy of all
//! pairs is `½ Σ V_i φ_i`. With the range "spacing" the force of a pair at the mean spacing is taken
//! off, `W_ij^{n−1} − W(Δp̄)^{n−1}` in place of `W_ij^{n−1}`, so that it sets in at zero there (theory
//! page "Contact").

use super::{ContactView, Gap, Reaction};

/// Adds what the foreign neighbours do to the receiver at `place` to `reaction`.
pub fn react(view: &ContactView, place: u32, neighbours: &[u32], reaction: &mut Reaction) {
    let i = view.party(place);
    for &other in neighbours {
        let j = view.party(other);
        let gap = Gap::between(&i, &j);
        let pair = view.table.pair(i.body, j.body);
        let kernel = &pair.kernel;
        let ratio = kernel.value(gap.distance) * pair.inverse_kernel;
        let slope = -kernel.slope(gap.distance) * pair.inverse_kernel;
        let curvature = kernel.curvature(gap.distance).abs() * pair.inverse_kernel;
        let strength = pair.potential * i.volume * j.volume;
        let n = f64::from(pair.exponent);
        let steeper = power(ratio, pair.exponent - 1);
        // With either range: the step must be short enough before the force sets in.
        reaction.stiffness += 2.0
            * strength
            * n
            * ((n - 1.0) * power(ratio, pair.exponent - 2) * (slope * slope) + steeper * curvature);
        let floor = pair.floor;
        let (energy, force) = if ratio > floor {
            let rise = ratio * steeper - floor * (1.0 + n * (ratio - floor));
            (
                0.5 * strength * rise,
                strength * n * (steeper - floor) * slope,
            )
        } else {
            (0.0, 0.0)
        };
        let force = if pair.along_normal {
            gap.along_normal(force, view.normal(place, other))
        } else {
            gap.along(force)
        };
        reaction.book(&j, &gap, pair, force, energy);
    }
}

/// `x^n` by plain multiplication; 0 for negative n (met only as a factor of zero, n = 1).
fn power(x: f64, n: i32) -> f64 {
    if n < 0 {
        return 0.0;
    }
    (0..n).fold(1.0, |product, _| product * x)
}
