//! Hourglass control of the corrected form (theory page "Corrected SPH").
//!
//! The hourglass displacement `w` of a particle is the elastic part of its displacement against its
//! neighbours that no linear field explains. Gradients do not see it, so that stress does nothing
//! against it, and tension even drives it. It pulls pairs along the line between them.

use numerics::lane_matrix::{cross, dot};
use numerics::lanes::Lanes;

/// Keeps a quotient of zeros from being none (Pa).
const TINY: f64 = 1e-290;

/// `w` (m) after a step `dt` (s) in which the neighbours moved by `rest` (m/s) beyond a linear
/// field and all turned with the spin of `gradient` (1/s, row-major): turned as stress is
/// (Hughes & Winget 1980), then moved.
#[inline(always)]
#[must_use]
pub fn advance<V: Lanes>(w: &[V; 3], rest: &[V; 3], gradient: &[V; 9], dt: V) -> [V; 3] {
    let [_, xy, xz, yx, _, yz, zx, zy, _] = *gradient;
    let quarter = dt.mul(V::splat(0.25));
    let half_turn = [
        zy.sub(yz).mul(quarter),
        xz.sub(zx).mul(quarter),
        yx.sub(xy).mul(quarter),
    ];
    let one = V::splat(1.0);
    let scale = V::splat(2.0).div(one.add(dot(&half_turn, &half_turn)));
    let first = cross(&half_turn, w);
    let second = cross(&half_turn, &first);
    let mut moved = *w;
    for a in 0..3 {
        let turned = first[a].add(second[a]).mul_add(scale, moved[a]);
        moved[a] = rest[a].neg_mul_add(dt, turned);
    }
    moved
}

/// The share of `w` that plastic flow leaves, as of the deviatoric stress (Pa, after its return):
/// `q/(q + 3G Δε)` of the equivalent stress q, with `flow = 3G Δε` (Pa).
#[inline(always)]
#[must_use]
pub fn kept<V: Lanes>(deviator: &[V; 6], flow: V) -> V {
    let [xx, yy, zz, xy, xz, yz] = *deviator;
    let (normal, shear) = ([xx, yy, zz], [xy, xz, yz]);
    let square = dot(&shear, &shear).mul_add(V::splat(2.0), dot(&normal, &normal));
    let q = square.mul(V::splat(1.5)).sqrt().add(V::splat(TINY));
    q.div(q.add(flow))
}

#[cfg(test)]
mod tests {
    use numerics::lanes::F64x8;
    use numerics::vector::dot;

    fn in_lanes<const N: usize>(values: &[f64; N]) -> [F64x8; N] {
        values.map(|value| F64x8([value; 8]))
    }

    fn advance(w: &[f64; 3], rest: &[f64; 3], gradient: &[f64; 9], dt: f64) -> [f64; 3] {
        let [w, rest] = [w, rest].map(in_lanes);
        super::advance(&w, &rest, &in_lanes(gradient), F64x8([dt; 8])).map(|moved| moved.0[3])
    }

    fn kept(deviator: &[f64; 6], flow: f64) -> f64 {
        super::kept(&in_lanes(deviator), F64x8([flow; 8])).0[5]
    }

    /// A full turn about a slanted axis in steps as long as they come: the length stays to rounding at
    /// any step, and the vector comes back to second order.
    #[test]
    fn turns_with_matter() {
        let w = [3e-6, -1e-6, 2e-6];
        let back = |steps: u32| {
            let angle = std::f64::consts::TAU / f64::from(steps);
            // Angular velocity (2, -1, 2)/3 rad/s, with a stretch that must not matter.
            let gradient = [0.7, -2.0 / 3.0, -1.0 / 3.0, 2.0 / 3.0, -0.4, -2.0 / 3.0]
                .into_iter()
                .chain([1.0 / 3.0, 2.0 / 3.0, 0.9]);
            let gradient: Vec<f64> = gradient.collect();
            let gradient: [f64; 9] = gradient.try_into().unwrap();
            let mut now = w;
            for _ in 0..steps {
                now = advance(&now, &[0.0; 3], &gradient, angle);
            }
            let long = (dot(&now, &now) / dot(&w, &w)).sqrt();
            assert!((long - 1.0).abs() < 1e-13, "{long}");
            let off = [0, 1, 2].map(|a: usize| now[a] - w[a]);
            (dot(&off, &off) / dot(&w, &w)).sqrt()
        };
        let (coarse, fine) = (back(100), back(200));
        assert!(fine < 6e-4, "{fine}");
        assert!((3.9..4.1).contains(&(coarse / fine)), "{coarse} {fine}");
    }

    /// The particle lags behind by all that the neighbours move beyond a linear field. A step of no
    /// length changes nothing.
    #[test]
    fn lags_behind_its_neighbours() {
        let w = [1.0, 2.0, 3.0];
        let rest = [0.5, -1.0, 4.0];
        assert_eq!(advance(&w, &rest, &[0.0; 9], 0.25), [0.875, 2.25, 2.0]);
        assert_eq!(
            advance(
                &w,
                &rest,
                &[1.0, 5.0, -2.0, 0.3, 2.0, 9.0, 1.0, 1.0, 1.0],
                0.0
            ),
            w
        );
    }

    /// Plastic flow keeps the elastic share: all without flow, half where it returns as far as it stops.
    #[test]
    fn flow_leaves_the_elastic_share() {
        // Uniaxial: q = 3 Pa. Shear: q = √3 τ.
        let uniaxial = [2.0, -1.0, -1.0, 0.0, 0.0, 0.0];
        assert_eq!(kept(&uniaxial, 0.0), 1.0);
        assert!((kept(&uniaxial, 3.0) - 0.5).abs() < 1e-15);
        let shear = [0.0, 0.0, 0.0, 0.0, 1.0, 0.0];
        assert!((kept(&shear, 3.0_f64.sqrt()) - 0.5).abs() < 1e-15);
        assert_eq!(kept(&[0.0; 6], 0.0), 1.0);
        assert!(kept(&[0.0; 6], 1.0) < 1e-280);
    }
}
