//! Two elastic–plastic steel blocks that meet with their long faces (`inputs/block-impact`),
//! section 3.3 of the paper: uniaxial strain on the axis until the edges' release arrives at .85
//! µs, then corners, plastic flow along the interface, and parting.

use crate::physics_support::{ready, run_to, run_with, start};
use engine::step::Simulation;

/// Stress and pressure on the axis behind the elastic precursor and the plastic wave (Pa): a
/// one-dimensional reference of the same law.
const STRESS: f64 = 0.0733e11;
const PRESSURE: f64 = 0.0713e11;
/// Force of a block under that stress on all its face (N per metre of thickness).
const PLATEAU: f64 = STRESS * 0.01;
/// Speed of each block (m/s).
const SPEED: f64 = 200.0;

/// The case with overrides, at time zero.
fn blocks(overrides: &[&str]) -> Simulation {
    start(ready("block-impact", overrides))
}

/// Particle spacing (m).
fn spacing(s: &Simulation) -> f64 {
    s.case.bodies[0].lattice.spacing
}

/// Mean compressive axial stress and pressure (Pa) within 1 mm of the axis and .8 mm of the
/// interface: four layers of the ready case. Alternate layers differ by some percent, which is a
/// mode that collocated sums do not see.
fn on_axis(s: &Simulation) -> [f64; 2] {
    let particles = &s.particles;
    let near = |i: &usize| {
        let [x, y, _] = particles.position[*i];
        x.abs() < 1e-3 && y.abs() < 0.8e-3
    };
    let chosen: Vec<usize> = (0..particles.owned()).filter(near).collect();
    #[allow(clippy::cast_precision_loss, reason = "few particles")]
    let n = chosen.len() as f64;
    let mean = |f: &dyn Fn(usize) -> f64| chosen.iter().map(|&i| f(i)).sum::<f64>() / n;
    [
        mean(&|i| particles.pressure[i] - particles.deviatoric_stress[i][1]),
        mean(&|i| particles.pressure[i]),
    ]
}

/// Force of the lower block on the upper one (N per metre of thickness), positive in compression:
/// what accelerates the upper block as a whole.
fn push(s: &Simulation) -> f64 {
    let particles = &s.particles;
    let own = (0..particles.owned()).filter(|&i| particles.body[i] == 1);
    own.map(|i| {
        let contact = particles.contact_acceleration.get(i).map_or(0.0, |a| a[1]);
        particles.mass[i] * (particles.acceleration[i][1] + contact)
    })
    .sum()
}

/// Smallest distance of the two faces (in spacings, by particle centres) within 4.5 mm of the axis.
fn gap(s: &Simulation) -> f64 {
    let particles = &s.particles;
    let mut faces = [f64::NEG_INFINITY, f64::INFINITY];
    for i in 0..particles.owned() {
        let [x, y, _] = particles.position[i];
        if x.abs() > 4.5e-3 {
            continue;
        }
        if particles.body[i] == 0 {
            faces[0] = faces[0].max(y);
        } else {
            faces[1] = faces[1].min(y);
        }
    }
    (faces[1] - faces[0]) / spacing(s)
}

/// Largest difference of a particle and the one nearest to its mirror image in the plane across
/// `axis`: places in spacings, velocities over those of the blocks.
fn asymmetry(s: &Simulation, axis: usize) -> [f64; 2] {
    let particles = &s.particles;
    let mut worst = [0.0_f64; 2];
    for i in 0..particles.owned() {
        let (mut x, mut v) = (particles.position[i], particles.velocity[i]);
        (x[axis], v[axis]) = (-x[axis], -v[axis]);
        let apart = |a: &[f64; 3], b: &[f64; 3]| {
            let square: f64 = (0..3).map(|c| (a[c] - b[c]) * (a[c] - b[c])).sum();
            square.sqrt()
        };
        let twin = (0..particles.owned())
            .min_by(|&j, &k| {
                apart(&x, &particles.position[j]).total_cmp(&apart(&x, &particles.position[k]))
            })
            .expect("particles");
        worst[0] = worst[0].max(apart(&x, &particles.position[twin]) / spacing(s));
        worst[1] = worst[1].max(apart(&v, &particles.velocity[twin]) / SPEED);
    }
    worst
}

/// Samples over .6–.8 µs: the mean of stress and pressure over their exact values, and the largest
/// deviation of a sample.
fn plateau(s: &mut Simulation) -> ([f64; 2], f64) {
    run_to(s, 0.6e-6);
    let (mut sums, mut samples, mut worst) = ([0.0; 2], 0.0, 0.0_f64);
    run_with(s, 0.8e-6, |s| {
        let [stress, pressure] = on_axis(s);
        let ratios = [stress / STRESS, pressure / PRESSURE];
        samples += 1.0;
        for (sum, ratio) in sums.iter_mut().zip(ratios) {
            *sum += ratio;
            worst = worst.max((ratio - 1.0).abs());
        }
    });
    (sums.map(|sum| sum / samples), worst)
}

#[test]
fn the_axis_follows_the_one_dimensional_answer() {
    for spacing in ["0.02", "0.01"] {
        let mut s = blocks(&[&format!("spacing=\"{spacing} cm\"")]);
        let ([stress, pressure], worst) = plateau(&mut s);
        println!("{spacing} cm: stress {stress:.4}, pressure {pressure:.4}, worst {worst:.4}");
        assert!(worst < 0.02, "{worst}");
    }
}

/// The faces part at 1.7 µs. At their very corners, which are late, two particles on each side stay
/// in touch with some thousandths of the force.
#[test]
fn blocks_meet_and_part() {
    let mut s = blocks(&[]);
    let (mut most, mut least, mut late) = (0.0_f64, f64::INFINITY, 0.0_f64);
    let mut look = |s: &Simulation| {
        let force = -s.state.pairs[0].force[1];
        most = most.max(force);
        least = least.min(force);
        if s.state.time > 1.75e-6 {
            late = late.max(force);
        }
    };
    run_with(&mut s, 2e-6, &mut look);
    let parted = gap(&s);
    run_with(&mut s, 2.4e-6, look);
    let asymmetry = [asymmetry(&s, 1), asymmetry(&s, 0)];
    let asymmetry = asymmetry.into_iter().flatten().fold(0.0, f64::max);
    let worst = &s.state.worst;
    println!(
        "force {most:.3e} N/m, least {:.1e}, {:.4} of the plateau after 1.75 us; gap {parted:.3} dp at 2 us, \
         {:.3} at 2.4; asymmetry {asymmetry:.1e}; energy error {:.1e}, {} steps",
        least,
        late / PLATEAU,
        gap(&s),
        worst.energy_error,
        s.state.step
    );
    assert!(least >= 0.0, "tension across the interface");
    assert!(late < 0.01 * PLATEAU, "the blocks have not parted");
    assert!(parted > 1.0 && gap(&s) > parted);
    assert!(asymmetry < 1e-10);
    assert!(worst.momentum_error.iter().all(|&e| e < 1e-12));
    assert_eq!(worst.interpenetrated, 0);
}

/// As one continuum the blocks hold on to each other when the release arrives.
#[test]
fn kernel_sums_pull_across_the_interface() {
    let mut s = blocks(&["contact.mode=kernel"]);
    run_to(&mut s, 0.8e-6);
    let most = push(&s);
    let (mut least, mut when) = (f64::INFINITY, 0.0);
    run_with(&mut s, 2.4e-6, |s| {
        if push(s) < least {
            (least, when) = (push(s), s.state.time);
        }
    });
    println!(
        "kernel: force {most:.3e} N/m at .8 us, least {:.3} of it at {:.2} us, gap {:.3} dp",
        least / most,
        1e6 * when,
        gap(&s)
    );
    assert!(least < -0.05 * most);
}
