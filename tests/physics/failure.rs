//! Failure in whole bodies: the ready plates that spall, and the ready bar that cracks.

use crate::physics_support::{ready, run_with, sorted_by, start};

/// The rear face of a target falls back by `2 P/(ρ₀ c₀)` when it spalls at P; the tear is as far
/// from that face as the flyer is thick. The normal stress at the limit is up to `⅔ Y` more than P:
/// hence a sixth more at most.
#[test]
fn a_plate_spalls_where_releases_meet_and_lets_its_face_fall_back() {
    let mut s = start(ready("flyer-spall", &[]));
    let (spacing, thickness) = (2e-5, 2e-3);
    let rear = *sorted_by(&s, 0, |i| s.particles.position[i][0])
        .last()
        .unwrap();
    let id = s.particles.id[rear];
    let (mut peak, mut least) = (0.0_f64, f64::INFINITY);
    run_with(&mut s, 1.0, |s| {
        let i = s.particles.id.iter().position(|&other| other == id);
        let velocity = s.particles.velocity[i.unwrap()][0];
        if s.state.time < 1.7e-6 {
            if velocity > peak {
                (peak, least) = (velocity, velocity);
            }
            least = least.min(velocity);
        }
    });
    let order = sorted_by(&s, 0, |i| s.particles.position[i][0]);
    let depths = order.iter().rev().enumerate();
    let (mut sum, mut weights) = (0.0, 0.0);
    for (layer, &i) in depths {
        let torn = s.particles.damage[i] - 0.5;
        if torn > 0.0 {
            #[allow(clippy::cast_precision_loss, reason = "few")]
            let depth = (layer as f64 + 0.5) * spacing;
            sum += torn * depth;
            weights += torn;
        }
    }
    let plane = sum / weights;
    let fall = peak - least;
    let expected = 2.0 * 1.3e9 / (2703.0 * 5240.0);
    println!("falls back by {fall}, {expected}; tears at {plane}");
    assert!((fall / expected - 1.0).abs() < 0.1, "{fall} {expected}");
    assert!((plane - thickness).abs() < 2.0 * spacing, "{plane}");
}

/// A bar of continuous flaws bears Grady and Kipp's strength at its rate, and that grows with the
/// power `3/(m + 3)` of the rate.
#[test]
fn a_bar_bears_the_strength_of_its_rate() {
    let peak = |rate: f64| {
        let velocity = format!(
            "body.bar.velocity=[\"{rate}/s * x\", \"{side}/s * y\", \"{side}/s * z\"]",
            side = -0.169 * rate
        );
        let time = 1.4e-6 * (1e3 / rate).powf(0.75);
        let mut s = start(ready(
            "grady-kipp-bar",
            &[
                &velocity,
                "material.basalt.failure.grady_kipp.flaws=\"continuous\"",
                "spacing=\"1 mm\"",
                &format!("run.end_time=\"{time} s\""),
                &format!("time_step.max=\"{} s\"", time / 100.0),
            ],
        ));
        let mut largest = 0.0_f64;
        run_with(&mut s, 1.0, |s| {
            let middle =
                (0..s.particles.owned()).filter(|&i| s.particles.position[i][0].abs() < 5e-3);
            let (mut sum, mut count) = (0.0, 0.0);
            for i in middle {
                sum += s.particles.deviatoric_stress[i][0] - s.particles.pressure[i];
                count += 1.0;
            }
            largest = largest.max(sum / count);
        });
        largest
    };
    let [slow, fast] = [300.0, 3000.0].map(peak);
    // Of one sphere for each particle (theory page "Failure").
    for (peak, expected) in [(slow, 34.06e6), (fast, 60.57e6)] {
        assert!((peak / expected - 1.0).abs() < 0.03, "{peak} {expected}");
    }
    assert!(((fast / slow).log10() / 0.25 - 1.0).abs() < 0.02);
}
