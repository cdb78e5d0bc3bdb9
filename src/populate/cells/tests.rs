//! Tiles, fits, counts, volumes.

#![allow(
    clippy::cast_precision_loss,
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "small numbers"
)]

use super::forces::{REACH, Sites};
use super::relax::step;
use super::tile::{GLASS_EDGES, Tile};
use super::*;
use model::{Axis, Body, Focus, Grading, LatticeKind, Shape, SymmetryPlane, Vec3};
use numerics::counter::split_mix;
use numerics::kernel::Kernel;

mod harmonics;
mod slabs;

/// Steps in which a tile comes to rest.
const STEPS: usize = 600;
/// The first draws of tiles in the plane and in space. Of sixteen starts in space this one leaves
/// pairs whose directions are as those of random ones.
const STARTS: [u64; 2] = [18, 1];

/// A tile of glass: sites thrown at random into a periodic box, and relaxed.
fn made(dimension: usize) -> Vec<[f64; 3]> {
    let edge = GLASS_EDGES[dimension - 2];
    let mut state = STARTS[dimension - 2];
    let mut draw = || (split_mix(&mut state) >> 11) as f64 / (1_u64 << 53) as f64 * edge;
    let mut x: Vec<[f64; 3]> = (0..4096)
        .map(|_| {
            let point = [draw(), draw(), draw()];
            if dimension == 2 {
                [point[0], point[1], 0.0]
            } else {
                point
            }
        })
        .collect();
    let count = x.len();
    let moving: Vec<u32> = (0..4096).collect();
    let mut velocity = vec![[0.0; 3]; count];
    for _ in 0..STEPS {
        for site in &mut x {
            for c in &mut site[..dimension] {
                *c = c.rem_euclid(edge);
            }
        }
        add_images(&mut x, edge, dimension);
        let mut sites = Sites {
            sizes: vec![1.0; x.len()],
            positions: std::mem::take(&mut x),
            largest: vec![1.0],
        };
        step(
            &mut sites,
            &mut velocity,
            &moving,
            |_, _| [0.0; 3],
            |_, _, _| (),
        );
        x = sites.positions;
        x.truncate(count);
    }
    ranked(&x, edge, dimension)
}

/// Sites in an order of which any first ones are spread evenly: the one that has most others near
/// it goes last, and so on with the rest, as in dithering by voids and clusters (Ulichney 1993).
/// Nearness is measured in spacings of those that are left.
fn ranked(x: &[[f64; 3]], edge: f64, dimension: usize) -> Vec<[f64; 3]> {
    const WIDTH: f64 = 0.6;
    const WIDER: f64 = 1.02;
    let square = |i: usize, j: usize| -> f64 {
        let along = |a: usize| {
            let way = x[i][a] - x[j][a];
            way - edge * (way / edge).round()
        };
        (0..dimension).map(|a| along(a) * along(a)).sum()
    };
    let near = |i: usize, j: usize, width: f64| libm::exp(-square(i, j) / (2.0 * width * width));
    let mut left: Vec<usize> = (0..x.len()).collect();
    let (mut order, mut width) = (Vec::new(), 0.0);
    let mut crowds = vec![0.0; x.len()];
    while !left.is_empty() {
        let spacing = (x.len() as f64 / left.len() as f64).powf(1.0 / dimension as f64);
        if WIDTH * spacing > WIDER * width {
            width = WIDTH * spacing;
            for &i in &left {
                crowds[i] = left.iter().map(|&j| near(i, j, width)).sum();
            }
        }
        let most = (0..left.len()).max_by(|&a, &b| crowds[left[a]].total_cmp(&crowds[left[b]]));
        let gone = left.remove(most.unwrap());
        for &i in &left {
            crowds[i] -= near(i, gone, width);
        }
        order.push(x[gone]);
    }
    order.reverse();
    order
}

/// Appends the periodic images of sites within reach of a box.
fn add_images(x: &mut Vec<[f64; 3]>, edge: f64, dimension: usize) {
    for a in 0..dimension {
        for i in 0..x.len() {
            let mut image = x[i];
            if image[a] < REACH {
                image[a] += edge;
                x.push(image);
            } else if image[a] > edge - REACH {
                image[a] -= edge;
                x.push(image);
            }
        }
    }
}

fn bytes(x: &[[f64; 3]], dimension: usize) -> Vec<u8> {
    let edge = GLASS_EDGES[dimension - 2];
    let word = |c: &f64| (((c.rem_euclid(edge) / edge * 65536.0).round() as u32) & 0xFFFF) as u16;
    let words = x.iter().flat_map(|site| site[..dimension].iter().map(word));
    words.flat_map(u16::to_le_bytes).collect()
}

/// The shipped tiles are what the relaxation makes. With `WHIPPLE_WRITE_TILES` in the environment it
/// writes them.
#[test]
#[ignore = "a minute"]
fn tiles_are_relaxed_by_the_rules_of_the_fit() {
    for dimension in [2, 3] {
        let made = bytes(&made(dimension), dimension);
        let path = format!("{}/cells/glass{dimension}.bin", env!("CARGO_MANIFEST_DIR"));
        if std::env::var_os("WHIPPLE_WRITE_TILES").is_some() {
            std::fs::write(&path, &made).unwrap();
        }
        assert!(std::fs::read(&path).unwrap() == made, "{path}");
    }
}

fn body(shape: Shape, kind: LatticeKind, spacing: f64) -> Body {
    let mut body = crate::tests::body(shape, kind, spacing, 0.0);
    body.lattice.seed = 3;
    body
}

fn ball(radius: f64) -> Shape {
    Shape::Sphere {
        centre: Vec3::new(0.3, -0.2, 0.1),
        radius,
    }
}

/// Nearest distance of each site and its kernel sum at a smoothing length of 1.3 spacings.
fn pairs(sites: &[Site], dimension: usize) -> (Vec<f64>, Vec<f64>) {
    let kernel = Kernel::new(dimension).of_length(1.3);
    let mut by_x: Vec<[f64; 3]> = sites.iter().map(|s| s.position).collect();
    by_x.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let mut nearest = vec![f64::INFINITY; by_x.len()];
    let mut sums = vec![kernel.value(0.0); by_x.len()];
    for i in 0..by_x.len() {
        for j in i + 1..by_x.len() {
            if by_x[j][0] - by_x[i][0] > 2.6 {
                break;
            }
            let square: f64 = (0..3).map(|a| (by_x[i][a] - by_x[j][a]).powi(2)).sum();
            let r = square.sqrt();
            if r < 2.6 {
                let w = kernel.value(r);
                sums[i] += w;
                sums[j] += w;
                nearest[i] = nearest[i].min(r);
                nearest[j] = nearest[j].min(r);
            }
        }
    }
    (nearest, sums)
}

fn spread(values: &[f64]) -> (f64, f64) {
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    let square = values.iter().map(|v| (v - mean).powi(2)).sum::<f64>();
    (mean, (square / values.len() as f64).sqrt())
}

#[test]
fn tiles_are_even_and_isotropic() {
    for dimension in [2, 3] {
        let tile = Tile::of(LatticeKind::Glass, dimension);
        let count = tile.sites.len();
        assert_eq!(count, 4096);
        let edge = GLASS_EDGES[dimension - 2];
        let mut x: Vec<[f64; 3]> = tile.sites.iter().map(|s| (*s).into()).collect();
        for a in 0..dimension {
            for i in 0..x.len() {
                for shift in [-edge, edge] {
                    let mut image = x[i];
                    image[a] += shift;
                    if image[a] > -2.7 && image[a] < edge + 2.7 {
                        x.push(image);
                    }
                }
            }
        }
        let kernel = Kernel::new(dimension).of_length(1.3);
        let (mut sums, mut least, mut k4) = (Vec::new(), f64::INFINITY, 0.0);
        for i in 0..count {
            let (mut sum, mut near, mut way) = (0.0, f64::INFINITY, [0.0; 3]);
            for other in &x {
                let d: [f64; 3] = std::array::from_fn(|a| other[a] - x[i][a]);
                let r = (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]).sqrt();
                sum += kernel.value(r);
                if r > 0.0 && r < near {
                    (near, way) = (r, d);
                }
            }
            sums.push(sum);
            least = least.min(near);
            k4 += way.iter().map(|c| (c / near).powi(4)).sum::<f64>() / count as f64;
        }
        let (mean, rms) = spread(&sums);
        // The mean of Σ e⁴ over random directions is 3/5 in space and 3/4 in the plane; its scatter
        // over 4096 directions is .0027 and .0028.
        let isotropic = if dimension == 3 { 0.6 } else { 0.75 };
        println!(
            "{dimension}-D: sum {mean} ± {rms}, nearest {least}, K4 {}",
            k4 - isotropic
        );
        assert!(
            (mean - 1.0).abs() < 0.01 && rms < 0.01,
            "{dimension}: {mean} ± {rms}"
        );
        assert!(least > 0.8, "{dimension}: nearest {least}");
        assert!(
            (k4 - isotropic).abs() < 0.01,
            "{dimension}: K4 {}",
            k4 - isotropic
        );
    }
}

#[test]
fn a_fitted_body_has_a_smooth_layer_half_a_spacing_below_its_faces() {
    let cube = Shape::Box {
        lower: Vec3::repeat(-8.0),
        upper: Vec3::repeat(8.0),
    };
    let plane = |axis, position| SymmetryPlane { axis, position };
    let planes = [plane(Axis::X, 0.3), plane(Axis::Y, -0.2)];
    for (shape, planes) in [(ball(12.0), &[][..]), (cube, &[]), (ball(15.0), &planes)] {
        let body = body(shape, LatticeKind::Glass, 1.0);
        let cells = Cells::of(&body, 3, planes).unwrap();
        let sites: Vec<Site> = crate::sites(&body, 3, planes, None).collect();
        let depths = sites.iter().map(|s| -cells.distance(&s.position.into()));
        let depths: Vec<f64> = depths.collect();
        let layer: Vec<f64> = depths.iter().copied().filter(|&d| d < 1.0).collect();
        let (mean, rms) = spread(&layer);
        let (nearest, _) = pairs(&sites, 3);
        let least = nearest.iter().copied().fold(f64::INFINITY, f64::min);
        println!(
            "layer of {} at {mean} ± {rms}, nearest {least}",
            layer.len()
        );
        assert!((mean - 0.5).abs() < 0.02 && rms < 0.05, "{mean} ± {rms}");
        assert!(depths.iter().all(|&d| d > 0.4));
        assert!(least > 0.6, "nearest {least}");
    }
}

#[test]
fn crystals_have_their_density_and_neighbours() {
    for (kind, nearest_of, count_of) in [
        (
            LatticeKind::BodyCentred,
            3.0_f64.sqrt() / 2.0 * 2.0_f64.cbrt(),
            8,
        ),
        (
            LatticeKind::FaceCentred,
            0.5_f64.sqrt() * 4.0_f64.cbrt(),
            12,
        ),
    ] {
        let body = body(ball(10.0), kind, 1.0);
        let sites: Vec<Site> = crate::sites(&body, 3, &[], None).collect();
        let volume = 4.0 / 3.0 * std::f64::consts::PI * 1000.0;
        assert!((sites.len() as f64 / volume - 1.0).abs() < 0.02);
        let (nearest, _) = pairs(&sites, 3);
        assert!(
            nearest.iter().all(|n| (n - nearest_of).abs() < 1e-9),
            "{kind:?}"
        );
        let middle = sites.iter().min_by(|a, b| {
            let far = |s: &Site| (Vec3::from(s.position) - Vec3::new(0.3, -0.2, 0.1)).norm();
            far(a).total_cmp(&far(b))
        });
        let middle = Vec3::from(middle.unwrap().position);
        let beside = sites
            .iter()
            .filter(|s| ((Vec3::from(s.position) - middle).norm() - nearest_of).abs() < 1e-9);
        assert_eq!(beside.count(), count_of);
    }
}

#[test]
fn the_mass_of_all_particles_is_that_of_the_shape() {
    let body_of = |shape| body(shape, LatticeKind::Glass, 0.07);
    let ball_of = |radius: f64| 4.0 / 3.0 * std::f64::consts::PI * radius * radius * radius;
    let plane = [SymmetryPlane {
        axis: Axis::X,
        position: 0.3,
    }];
    for (planes, volume) in [(&[][..], ball_of(1.0)), (&plane, 0.5 * ball_of(1.0))] {
        let body = body_of(ball(1.0));
        let each = crate::even_volume(&body, 3, planes).unwrap();
        let count = crate::sites(&body, 3, planes, None).count();
        let error = each * count as f64 / volume - 1.0;
        println!("{} planes: volume {error:e}", planes.len());
        assert!(error.abs() < 1e-5, "{error:e}");
    }
}

/// Particles of a graded body are even: kernel sums with the mean smoothing length of each pair are
/// one, all through the grading.
#[test]
fn a_graded_body_is_even() {
    let from = Focus::Point(Vec3::new(0.3, -0.2, 0.1));
    for growth in [0.1, 0.3] {
        let mut body = body(ball(45.0), LatticeKind::Glass, 1.0);
        body.lattice.grading = Some(Grading {
            from,
            even: 6.0,
            growth,
            coarsest: 4.0,
        });
        let sites: Vec<Site> = crate::sites(&body, 3, &[], None).collect();
        let shares = crate::shares(&body, 3, &[]);
        let sum = sites.iter().fold(0.0, |sum, site| sum + site.share);
        assert!((sum / shares - 1.0).abs() < 1e-12);
        let volume = 4.0 / 3.0 * std::f64::consts::PI * 45.0_f64.powi(3);
        println!(
            "{} sites, shares over volume {}",
            sites.len(),
            shares / volume
        );
        assert!((shares / volume - 1.0).abs() < 0.01);
        let kernel = Kernel::new(3);
        let size: Vec<f64> = sites.iter().map(|site| site.share.cbrt()).collect();
        let (mut sums, mut layer, mut least) = (Vec::new(), Vec::new(), f64::INFINITY);
        for (site, s) in sites.iter().zip(&size) {
            let x = Vec3::from(site.position);
            let depth = 45.0 - (x - Vec3::new(0.3, -0.2, 0.1)).norm();
            if depth < *s {
                layer.push(depth / s);
            }
            if depth < 3.0 * s {
                continue;
            }
            let around = sites.iter().zip(&size).filter_map(|(other, t)| {
                let h = 0.65 * (s + t);
                let r = (x - Vec3::from(other.position)).norm();
                if other.index != site.index {
                    least = least.min(2.0 * r / (s + t));
                }
                (r < 2.0 * h).then(|| other.share * kernel.of_length(h).value(r))
            });
            sums.push(around.fold(0.0, |sum, part| sum + part));
        }
        let (mean, rms) = spread(&sums);
        let (deep, uneven) = spread(&layer);
        println!("growth {growth}: sum {mean} ± {rms}, nearest {least}, layer {deep} ± {uneven}");
        let noise = libm::hypot(mean - 1.0, rms);
        assert!(noise < if growth < 0.2 { 0.02 } else { 0.04 }, "{noise}");
        assert!((deep - 0.5).abs() < 0.02 && uneven < 0.05);
    }
}
