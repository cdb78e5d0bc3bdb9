//! Directions of pairs: how far they are from isotropic, by the invariants of Steinhardt, Nelson &
//! Ronchetti (1983).

use super::*;

/// Largest distance of pairs (spacings).
const NEAR: f64 = 1.3;

/// `Q_l² = 4π/(2l+1) Σ_m |⟨Y_lm⟩|²` of directions for l = 4 and 6: the mean of `P_l` over all pairs of
/// directions, whose powers are sums of squared moments.
fn invariants(directions: &[[f64; 3]]) -> [f64; 2] {
    let power = |k: i32| -> f64 {
        let factorial = |n: i32| (1..=n).map(f64::from).product::<f64>();
        let mut sum = 0.0;
        for a in 0..=k {
            for b in 0..=k - a {
                let c = k - a - b;
                let each = directions
                    .iter()
                    .map(|e| e[0].powi(a) * e[1].powi(b) * e[2].powi(c));
                let moment = each.sum::<f64>() / directions.len() as f64;
                let ways = factorial(k) / (factorial(a) * factorial(b) * factorial(c));
                sum += ways * moment * moment;
            }
        }
        sum
    };
    let (second, fourth, sixth) = (power(2), power(4), power(6));
    [
        (35.0 * fourth - 30.0 * second + 3.0) / 8.0,
        (231.0 * sixth - 315.0 * fourth + 105.0 * second - 5.0) / 16.0,
    ]
}

/// Directions of the near pairs of a periodic set of sites, once each.
fn near_pairs(x: &[Vec3], edges: &Vec3) -> Vec<[f64; 3]> {
    let mut directions = Vec::new();
    for (i, a) in x.iter().enumerate() {
        for b in &x[i + 1..] {
            let way = Vec3::from_fn(|k, _| {
                let way = b[k] - a[k];
                way - edges[k] * (way / edges[k]).round()
            });
            let r = way.norm();
            if r < NEAR {
                directions.push((way / r).into());
            }
        }
    }
    directions
}

/// Over all pairs of the tile the harmonics of orders 4 and 6 are those of as many random directions, of
/// which (2l + 1) n Q² is distributed as χ² with 2l + 1 degrees of freedom.
#[test]
fn pairs_of_the_tile_have_no_direction() {
    let tile = Tile::of(LatticeKind::Glass, 3);
    let directions = near_pairs(&tile.sites, &tile.edges);
    let n = directions.len() as f64;
    let [fourth, sixth] = invariants(&directions);
    println!(
        "glass: {n} pairs, Q4 {}, Q6 {}; χ² {} of 9, {} of 13",
        fourth.sqrt(),
        sixth.sqrt(),
        9.0 * n * fourth,
        13.0 * n * sixth
    );
    // Two standard deviations of χ².
    assert!(9.0 * n * fourth < 9.0 + 2.0 * 18.0_f64.sqrt());
    assert!(13.0 * n * sixth < 13.0 + 2.0 * 26.0_f64.sqrt());
}

/// Those of lattices are as in the literature.
#[test]
fn pairs_of_lattices_have_directions() {
    for (kind, expected) in [
        (LatticeKind::Cubic, [0.7638, 0.3536]),
        // Fourteen neighbours, of two distances.
        (LatticeKind::BodyCentred, [0.0364, 0.5107]),
        (LatticeKind::FaceCentred, [0.1909, 0.5745]),
        (LatticeKind::Hexagonal, [0.0972, 0.4848]),
    ] {
        let tile = Tile::of(kind, 3);
        let computed = invariants(&near_pairs(&tile.sites, &tile.edges)).map(f64::sqrt);
        println!("{kind:?}: Q4 {}, Q6 {}", computed[0], computed[1]);
        for (computed, expected) in computed.iter().zip(expected) {
            assert!(
                (computed - expected).abs() < 1e-3,
                "{kind:?}: {computed} {expected}"
            );
        }
    }
}
