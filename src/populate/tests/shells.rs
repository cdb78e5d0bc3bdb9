//! Layers of balls and of hollow balls.

use super::*;

/// Nearest distances (spacings), and numbers and mean radii (m) of layers.
fn look(body: &Body) -> (Vec<f64>, Vec<(f64, usize)>) {
    let spacing = body.lattice.spacing;
    let mut sites = all(body, 3);
    let mut layers: Vec<(f64, usize)> = Vec::new();
    for site in &sites {
        let r = Vec3::from(site.position).norm();
        match layers.last_mut() {
            Some((radius, count)) if (*radius - r).abs() < 1e-9 => *count += 1,
            _ => layers.push((r, 1)),
        }
    }
    sites.sort_by(|a, b| a.position[0].total_cmp(&b.position[0]));
    let mut nearest = vec![f64::INFINITY; sites.len()];
    for i in 0..sites.len() {
        for j in i + 1..sites.len() {
            if sites[j].position[0] - sites[i].position[0] > 1.5 * spacing {
                break;
            }
            let way = Vec3::from(sites[j].position) - Vec3::from(sites[i].position);
            let r = way.norm() / spacing;
            nearest[i] = nearest[i].min(r);
            nearest[j] = nearest[j].min(r);
        }
    }
    (nearest, layers)
}

/// The outermost layer lies half a layer inside, the innermost half a layer outside of a hollow.
/// Sites have the volume of their cells nearly, and in any direction there are as many.
#[test]
#[allow(clippy::cast_precision_loss)] // thousands
fn shells_follow_the_surface() {
    for (shape, inner, number) in [
        (ball(1.0), 0.0, 20.0),
        (shell(1.0, 0.52), 0.52, 10.0),
        (shell(1.0, 0.97), 0.97, 1.0),
    ] {
        let body = body(shape, LatticeKind::Shells, 0.05, 0.0);
        let (nearest, layers) = look(&body);
        let pitch = (1.0 - inner) / number;
        assert_eq!(layers.len() as f64, number);
        for (n, (radius, _)) in layers.iter().enumerate() {
            let at = inner + (n as f64 + 0.5) * pitch;
            assert!((radius - at).abs() < 1e-9, "{radius} {at}");
        }
        let sites = all(&body, 3);
        let filled = sites.len() as f64 * 0.05_f64.powi(3);
        let volume = body.shape.volume(3);
        assert!((filled / volume - 1.0).abs() < 1e-3, "{filled} of {volume}");
        assert!(sites.windows(2).all(|two| two[0].index + 1 == two[1].index));
        assert_eq!(sites.len() as u64, index_end(&body, 3));
        let least = nearest.iter().copied().fold(f64::INFINITY, f64::min);
        let mean = nearest.iter().sum::<f64>() / nearest.len() as f64;
        println!(
            "inner {inner}: {} sites, nearest {least}, mean {mean}",
            sites.len()
        );
        assert!(mean > 0.95 && least > 0.7, "{least} {mean}");
        let sum = sites
            .iter()
            .fold(Vec3::zeros(), |sum, s| sum + Vec3::from(s.position));
        assert!((sum / sites.len() as f64).norm() < 2e-3);
    }
}

/// Slabs of a ball give each site once with the same bits, and a count visits few.
#[test]
fn slabs_of_shells_add_up() {
    let body = body(ball(1.0), LatticeKind::Shells, 0.04, 0.0);
    let whole = bits(sites(&body, 3, &[], None));
    for axis in 0..3 {
        let on_site = f64::from_bits(whole[77].1[axis]);
        let mut faces = [f64::NEG_INFINITY, -0.5, -0.47, on_site, 0.8, f64::INFINITY];
        faces.sort_by(f64::total_cmp);
        let mut union = Vec::new();
        for pair in faces.windows(2) {
            let slab = Some(Brick::slab(axis, pair[0], pair[1]));
            let part = bits(sites(&body, 3, &[], slab));
            assert_eq!(part.len() as u64, count(&body, 3, &[], slab));
            union.extend(part);
        }
        union.sort_unstable();
        assert_eq!(union, whole);
    }
}
