//! Models cut at symmetry planes against the whole.
#![allow(clippy::float_cmp, reason = "what is exact is held exactly")]
#![allow(
    clippy::needless_range_loop,
    reason = "components of vectors and tensors"
)]
#![allow(clippy::many_single_char_names, reason = "formulas as on paper")]

use engine::step::measurements;
use std::collections::BTreeMap;

use crate::common::outcome::{advance, start};
use crate::common::sentinel::mix;
use crate::common::{SPACING, ball, case, make_elastic, planes};
use comm::Comm;
use engine::step::Simulation;
use model::{Axis, ContactMode, Overlap, Potential, SmoothingLength, SymmetryPlane};
use particles::Mirrors;
use particles::{FIELDS, FieldInfo, ParticleStore};

/// Largest differences of position (in spacings) and velocity (relative to `speed`) between the
/// particles of a reduced model and the same ones of the whole. One that crosses a plane is from then on its image.
fn largest_difference(reduced: &Simulation, whole: &Simulation, speed: f64) -> (f64, f64) {
    let whole_slot: BTreeMap<u64, usize> = (0..whole.particles.owned())
        .map(|i| (whole.particles.id[i], i))
        .collect();
    let (mut position, mut velocity) = (0.0_f64, 0.0_f64);
    for i in 0..reduced.particles.owned() {
        let j = whole_slot[&reduced.particles.id[i]];
        for a in 0..3 {
            let x = reduced.particles.position[i][a];
            let there = whole.particles.position[j][a];
            let crossed = reduced.state.plane_crossings > 0 && x * there < 0.0;
            let side = if crossed { -1.0 } else { 1.0 };
            let dx = x - side * there;
            let dv = reduced.particles.velocity[i][a] - side * whole.particles.velocity[j][a];
            position = position.max(dx.abs() / SPACING);
            velocity = velocity.max(dv.abs() / speed);
        }
    }
    (position, velocity)
}

/// A mirrored half, quarter or eighth of a symmetric case moves as the whole does, with contact
/// across the planes and without.
#[test]
fn mirrored_models_equal_the_whole() {
    let overlap = ContactMode::Overlap(Overlap::default());
    let potential = ContactMode::Potential(Potential::default());
    for (contact, axes) in [
        (ContactMode::Kernel, &[Axis::X][..]),
        (ContactMode::Kernel, &[Axis::X, Axis::Y]),
        (ContactMode::Kernel, &[Axis::X, Axis::Y, Axis::Z]),
        (overlap, &[Axis::X, Axis::Y]),
        (potential, &[Axis::X, Axis::Y]),
    ] {
        let model = |symmetry: &[Axis]| {
            let bodies = vec![
                ball("lower", -4.0, 4.0, 800.0),
                ball("upper", 4.0, 4.0, -800.0),
            ];
            let mut case = case(3, bodies, 1.0);
            case.default_contact = contact.clone();
            case.sph.smoothing_length = SmoothingLength::Variable { min: 0.6, max: 2.0 };
            case.symmetry = planes(symmetry);
            start(case)
        };
        let (mut reduced, mut whole) = (model(axes), model(&[]));
        let share = 1_u32 << axes.len();
        assert_eq!(
            whole.particles.owned(),
            (share as usize) * reduced.particles.owned()
        );
        advance(&mut reduced, 60);
        advance(&mut whole, 60);
        let (position, velocity) = largest_difference(&reduced, &whole, 800.0);
        let name = contact.name();
        // Sums in other orders: rounding, which sixty steps amplify little.
        assert!(
            position < 1e-12 && velocity < 1e-12,
            "{name} {axes:?}: {position:e} {velocity:e}"
        );
        let energies = [&reduced, &whole].map(|model| model.state.totals.energy());
        let error = f64::from(share) * energies[0] - energies[1];
        assert!(error.abs() < 1e-12 * energies[1]);
        let momentum = reduced.state.worst.momentum_error;
        assert!(momentum.iter().all(|&e| e < 1e-12), "{momentum:?}");
    }
}

/// What a field holds behind planes x = 1 and z = −2, by its number of components.
fn image(field: &FieldInfo, value: &[f64]) -> Vec<f64> {
    let sign = [-1.0, 1.0, -1.0];
    let twice = [2.0, 0.0, -4.0];
    let pairs = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)];
    let of = |k: usize| match value.len() {
        1 => value[0],
        3 if field.name.contains("position") => twice[k] + sign[k] * value[k],
        3 => sign[k] * value[k],
        6 => sign[pairs[k].0] * sign[pairs[k].1] * value[k],
        _ => sign[k / 3] * sign[k % 3] * value[k],
    };
    (0..value.len()).map(of).collect()
}

/// All that a particle may take to another rank is mirrored when it crosses planes, whichever field
/// it is; nothing else of it is touched, and nobody else.
#[test]
fn every_field_is_folded() {
    let planes = [(Axis::X, 1.0), (Axis::Z, -2.0)];
    let planes = planes.map(|(axis, position)| SymmetryPlane { axis, position });
    let mirrors = Mirrors::new(&planes);
    let mut particles = ParticleStore::default();
    particles.resize_owned(3);
    for (row, field) in (0_u64..).zip(FIELDS) {
        for (word, number) in (0_u64..).zip(particles.bytes_mut(field.id).chunks_mut(8)) {
            let bits = mix(row << 32 | word) % 1_000_000;
            #[allow(clippy::cast_precision_loss, reason = "six digits")]
            let value = if field.kind.is_real() {
                (bits as f64 + 0.5).to_bits()
            } else {
                bits
            };
            number.copy_from_slice(&value.to_ne_bytes()[..number.len()]);
        }
    }
    particles.position[1] = [0.25, 7.0, -5.0];
    let before = particles.clone();
    assert_eq!(mirrors.fold(&mut particles, 1).bits(), 0b101);
    for field in FIELDS {
        let size = field.kind.bytes();
        let part = |particles: &ParticleStore, slot: usize| {
            particles.bytes(field.id)[slot * size..(slot + 1) * size].to_vec()
        };
        for slot in 0..3 {
            let mut expected = part(&before, slot);
            if slot == 1 && field.kind.is_real() && field.leaves() {
                let value: Vec<f64> = bytemuck::pod_collect_to_vec(&expected);
                expected = bytemuck::pod_collect_to_vec(&image(field, &value));
            }
            assert_eq!(part(&particles, slot), expected, "{} of {slot}", field.name);
        }
    }
}

/// Particles that cross a plane change places with their images and go on as in the whole model;
/// the impulse of that is booked.
#[test]
fn particles_that_cross_a_plane_go_on_as_their_images() {
    let model = |symmetry: &[Axis]| {
        let mut case = case(3, vec![ball("ball", 0.0, 4.0, 0.0)], 1.0);
        make_elastic(&mut case);
        (case.sph.alpha, case.sph.beta) = (0.0, 0.0);
        case.symmetry = planes(symmetry);
        let mut simulation = start(case);
        let particles = &mut simulation.particles;
        for i in 0..particles.owned() {
            let [x, y, z] = particles.position[i].map(|x| x / SPACING);
            // The layers nearest to the plane x = 0 fly through it and each other, in shear.
            if x.abs() < 1.0 {
                particles.velocity[i] = [-30e3 * x.signum(), 900.0 * z, 700.0 * y];
            }
        }
        simulation
    };
    let (mut reduced, mut whole) = (model(&[Axis::X]), model(&[]));
    measurements::diagnose(&mut reduced, &Comm::solo());
    let before = reduced.state.totals;
    let whole_slot = |whole: &Simulation| -> BTreeMap<u64, usize> {
        (0..whole.particles.owned())
            .map(|i| (whole.particles.id[i], i))
            .collect()
    };
    let mut crossed = 0;
    for _ in 0..40 {
        advance(&mut reduced, 1);
        advance(&mut whole, 1);
        let slots = whole_slot(&whole);
        let (half, full) = (&reduced.particles, &whole.particles);
        for i in 0..half.owned() {
            let j = slots[&half.id[i]];
            let side = if full.position[j][0] < 0.0 { -1.0 } else { 1.0 };
            crossed += usize::from(side < 0.0);
            let odd = [side, 1.0, 1.0];
            for a in 0..3 {
                let dx = half.position[i][a] - odd[a] * full.position[j][a];
                let dv = half.velocity[i][a] - odd[a] * full.velocity[j][a];
                assert!(
                    dx.abs() < 1e-10 * SPACING && dv.abs() < 1e-10 * 30e3,
                    "{dx:e} {dv:e}"
                );
                for b in 0..3 {
                    let (l, m) = (half.velocity_gradient[i], full.velocity_gradient[j]);
                    let error = l[3 * a + b] - odd[a] * odd[b] * m[3 * a + b];
                    assert!(error.abs() < 1e-9 * 30e3 / SPACING);
                }
            }
            let (s, t) = (half.deviatoric_stress[i], full.deviatoric_stress[j]);
            for (c, flip) in [1.0, 1.0, 1.0, side, side, 1.0].into_iter().enumerate() {
                assert!((s[c] - flip * t[c]).abs() < 1e-9 * 28.6e9, "component {c}");
            }
        }
    }
    assert!(crossed > 100, "{crossed}");
    let after = reduced.state.totals;
    for a in 0..3 {
        let error = after.momentum[a] - before.momentum[a] - reduced.state.plane_impulse[a];
        assert!(error.abs() < 1e-14 * before.momentum_scale, "{error:e}");
    }
}
