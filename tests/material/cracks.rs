//! Cracks that grow from flaws, at a point: Grady and Kipp's closed form, and drawn flaws.
#![allow(clippy::cast_precision_loss, reason = "counts")]

use crate::support::{batch, material, step};
use material::{
    Crosses, Effect, Elastic, Eos, Flaws, GradyKipp, LANES, Linear, LinearForm, Material,
    PointBatch, Strength,
};
use nalgebra::Matrix3;

const RHO: f64 = 2700.0;

/// Basalt of Benz & Asphaug (1999).
fn basalt(crosses: Crosses, flaws: Flaws) -> Material {
    let eos = Eos::Linear(Linear {
        bulk_modulus: 26.7e9,
        form: LinearForm::Logarithmic,
    });
    let shear_modulus = 22.7e9;
    let mut basalt = material(RHO, eos, Strength::Elastic(Elastic { shear_modulus }));
    basalt.failure.grady_kipp = Some(GradyKipp {
        k: 4e35,
        m: 9.0,
        crack_speed: 0.4,
        crosses,
        flaws,
        most_flaws: 0.0,
        least_size: 0.0,
    });
    basalt.failure.options.effect = Effect::Scaled;
    basalt
}

/// Peak of the stress along x of a bar drawn at a rate, its sides free: K and G as of the material.
fn peak(basalt: &Material, rate: f64, volume: f64, first: u64, steps: f64) -> [f64; LANES] {
    let (k, g) = (26.7e9, 22.7e9);
    let nu = (3.0 * k - 2.0 * g) / (2.0 * (3.0 * k + g));
    let l = Matrix3::from_diagonal(&nalgebra::Vector3::new(rate, -nu * rate, -nu * rate));
    let mut points: PointBatch = batch(RHO, 0.0);
    points.mass = [RHO * volume; LANES];
    points.id = std::array::from_fn(|n| first + n as u64);
    let guess = 1e-4 * (rate / 1.0).powf(0.25);
    let dt = guess / rate / steps;
    let mut most = [0.0_f64; LANES];
    let mut n = 0;
    while points.damage.iter().any(|d| *d < 1.0) {
        step(basalt, &mut points, &l, dt);
        for lane in 0..LANES {
            most[lane] = most[lane].max(points.deviatoric_stress[0][lane] - points.pressure[lane]);
        }
        n += 1;
        assert!(n < 1_000_000);
    }
    most
}

/// Grady and Kipp's closed form with `α' = 36π c_g³ k/(m + 3)³` (see the page of theory).
fn closed_form(rate: f64, shrink: f64) -> f64 {
    let (k, g, m): (f64, f64, f64) = (26.7e9, 22.7e9, 9.0);
    let young = 9.0 * k * g / (3.0 * k + g);
    let speed = 0.4 * ((k + 4.0 / 3.0 * g) / RHO).sqrt();
    let alpha = 36.0 * std::f64::consts::PI * speed.powi(3) * 4e35 / (m + 3.0).powi(3) * shrink;
    let time = (alpha * (m + 4.0)).powf(-1.0 / (m + 3.0)) * rate.powf(-m / (m + 3.0));
    young * rate * time * (m + 3.0) / (m + 4.0)
}

#[test]
fn cracks_of_continuous_flaws_follow_the_closed_form() {
    // In MPa, worked out apart from the program.
    let published = [8.184, 14.55, 25.88, 46.02, 81.84];
    for (crosses, shrink) in [(Crosses::Particle, 1.0), (Crosses::Support, 1.0 / 73.6)] {
        let basalt = basalt(crosses, Flaws::Continuous);
        let mut peaks = Vec::new();
        for (n, wanted) in published.into_iter().enumerate() {
            let rate = 10_f64.powi(i32::try_from(n).unwrap());
            let found = peak(&basalt, rate, 1e-9, 0, 2000.0)[0];
            let closed = closed_form(rate, shrink);
            assert!(
                (found / closed - 1.0).abs() < 0.03,
                "{crosses:?} {rate}: {found} {closed}"
            );
            if crosses == Crosses::Particle {
                assert!((closed / (wanted * 1e6) - 1.0).abs() < 1e-3, "{closed}");
            }
            peaks.push(found);
        }
        let slope = (peaks[4] / peaks[0]).log10() / 4.0;
        assert!((slope / 0.25 - 1.0).abs() < 0.02, "{slope}");
    }
}

/// Particles that hold many flaws when they fail are as strong, on the mean, as with a continuous
/// count, and each draws the same whenever it is asked.
#[test]
fn drawn_flaws_scatter_about_the_continuous_count() {
    let [drawn, continuous] =
        [Flaws::Drawn, Flaws::Continuous].map(|f| basalt(Crosses::Particle, f));
    let (rate, volume) = (1e4, 1e-8);
    let wanted = peak(&continuous, rate, volume, 0, 500.0)[0];
    // Active flaws at the peak: the bar asks for ten and more.
    let strain = wanted * 13.0 / 12.0 / 53.06e9;
    assert!(4e35 * volume * strain.powi(9) > 10.0);
    let all: Vec<f64> = (0..125)
        .flat_map(|n| peak(&drawn, rate, volume, 8 * n, 500.0))
        .collect();
    let mean = all.iter().sum::<f64>() / all.len() as f64;
    assert!((mean / wanted - 1.0).abs() < 0.03, "{}", mean / wanted);
    assert_eq!(all[80..88], peak(&drawn, rate, volume, 80, 500.0));
    assert!(all.iter().any(|x| (x / mean - 1.0).abs() > 0.01));
    // First flaws of particles: x₁ has the mean one.
    let mut first = 0.0;
    let n = 1000;
    for batch_of in 0..n / LANES {
        let mut points: PointBatch = batch(RHO, 0.0);
        points.mass = [RHO * volume; LANES];
        points.id = std::array::from_fn(|k| (batch_of * LANES + k) as u64);
        step(&drawn, &mut points, &(Matrix3::identity() * 1.0), 1e-9);
        let x = |strain: &f64| 4e35 * volume * strain.powi(9);
        first += points.first_flaw.iter().map(x).sum::<f64>();
    }
    assert!((first / n as f64 - 1.0).abs() < 3.0 / (n as f64).sqrt());
}

/// Particles below the least size have the strength of one of that size, those above their own.
#[test]
fn no_particle_counts_as_smaller_than_the_least_size() {
    let plain = basalt(Crosses::Particle, Flaws::Drawn);
    let mut bounded = basalt(Crosses::Particle, Flaws::Drawn);
    bounded.failure.grady_kipp.as_mut().unwrap().least_size = 1e-3;
    let of = |basalt: &Material, volume: f64| peak(basalt, 1e3, volume, 0, 500.0);
    let near = |a: [f64; LANES], b: [f64; LANES]| {
        a.iter().zip(b).all(|(a, b)| (a / b - 1.0).abs() < 1e-12)
    };
    assert!(near(of(&bounded, 1e-10), of(&plain, 1e-9)));
    assert!(!near(of(&plain, 1e-10), of(&plain, 1e-9)));
    assert!(near(of(&bounded, 8e-9), of(&plain, 8e-9)));
}

/// With a limit of flaws, a particle is damaged no more than the share that is active.
#[test]
fn damage_stays_below_the_share_of_active_flaws() {
    let mut basalt = basalt(Crosses::Particle, Flaws::Drawn);
    basalt.failure.grady_kipp.as_mut().unwrap().most_flaws = 10.0;
    let mut points: PointBatch = batch(RHO, 0.0);
    points.mass = [RHO * 1e-9; LANES];
    points.id = std::array::from_fn(|k| k as u64);
    let l = Matrix3::from_diagonal(&nalgebra::Vector3::new(1e3, 0.0, 0.0));
    let mut partial = false;
    for _ in 0..20_000 {
        step(&basalt, &mut points, &l, 1e-10);
        for k in 0..LANES {
            assert!(points.damage[k] <= points.flaws[k] / 10.0 + 1e-15);
            partial |= (0.05..0.95).contains(&points.damage[k]);
        }
    }
    assert!(partial);
}
