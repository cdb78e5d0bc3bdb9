//! Cases built in code, for tests of the engine.

pub mod collectives;
pub mod outcome;
pub mod process;
pub mod random;
pub mod sentinel;
pub mod threads;
pub mod virtual_ranks;

use material::{Elastic, Eos, Linear, LinearForm, Strength, VonMises, library};
use model::{
    Axis, Body, Case, ContactMode, DomainOptions, Freedom, Initial, Lattice, LatticeKind, Loads,
    MeasureOptions, OutputOptions, Overlap, RunControl, Shape, SymmetryPlane, TimeStepOptions,
    Vec3,
};

/// A body on a cubic lattice with h = 1.3 Δp.
pub fn body(name: &str, shape: Shape, spacing: f64, velocity: Vec3) -> Body {
    Body {
        name: name.into(),
        shape,
        material: 0,
        lattice: Lattice {
            kind: LatticeKind::Cubic,
            spacing,
            angle: 0.0,
            ..Lattice::default()
        },
        density: None,
        initial: Initial::default(),
        velocity,
        angular_velocity: Vec3::zeros(),
        rigid: None,
        freedom: Freedom::default(),
        smoothing_length: 1.3 * spacing,
        total: false,
        layer: false,
        filled: None,
    }
}

/// A case of aluminium bodies with default options.
pub fn case(dimension: usize, bodies: Vec<Body>, end_time: f64) -> Case {
    Case {
        title: "test".into(),
        length_unit: model::readable::Readable::length(1.0),
        dimension,
        axisymmetric: false,
        materials: vec![library::find("aluminium-2024").expect("in the library")],
        bodies,
        contacts: Vec::new(),
        default_contact: ContactMode::Overlap(Overlap::default()),
        self_contact: None,
        fragments: None,
        symmetry: Vec::new(),
        loads: Loads::default(),
        sph: files::input::usual_sph(),
        numerical_limits: model::NumericalLimits::default(),
        time_step: TimeStepOptions {
            courant: 0.4,
            force: 0.25,
            contact: 0.6,
            max: f64::INFINITY,
        },
        domain: DomainOptions {
            levels: None,
            axes: [None; 3],
            balance_every: 20,
            keep: None,
        },
        run: RunControl {
            end_time,
            max_steps: None,
        },
        output: OutputOptions {
            snapshot_every: None,
            checkpoint_every: None,
            checkpoint_every_steps: None,
            checkpoint_every_wall: None,
            checkpoints_kept: 2,
            history_every: None,
            fields: Vec::new(),
            snapshots: Vec::new(),
            sharing: model::Sharing::default(),
        },
        measure: MeasureOptions::default(),
        resolved: String::new(),
    }
}

/// Sphere of radius 0.3 mm at `speed` (m/s) along −z on a plate of 0.2 mm × radius 1.5 mm;
/// `quarter` keeps x, y > 0.
pub fn sphere_on_plate(spacing: f64, speed: f64, quarter: bool, end_time: f64) -> Case {
    let sphere = Shape::Sphere {
        centre: Vec3::new(0.0, 0.0, 0.3e-3),
        radius: 0.3e-3,
    };
    let plate = Shape::Cylinder {
        centre: Vec3::new(0.0, 0.0, -0.1e-3),
        axis: Axis::Z,
        radius: 1.5e-3,
        length: 0.2e-3,
    };
    let bodies = vec![
        body("sphere", sphere, spacing, Vec3::new(0.0, 0.0, -speed)),
        body("plate", plate, spacing, Vec3::zeros()),
    ];
    let mut case = case(3, bodies, end_time);
    if let Strength::VonMises(VonMises { yield_stress, .. }) = &mut case.materials[0].strength {
        *yield_stress = 0.26e9;
    }
    if quarter {
        case.symmetry = [Axis::X, Axis::Y]
            .map(|axis| SymmetryPlane {
                axis,
                position: 0.0,
            })
            .to_vec();
    }
    case
}

/// Particle spacing of [`ball`] (m).
pub const SPACING: f64 = 1e-4;

/// A ball on the z axis at `speed` (m/s) along it; `z` and `radius` in spacings.
pub fn ball(name: &str, z: f64, radius: f64, speed: f64) -> Body {
    let shape = Shape::Sphere {
        centre: Vec3::new(0.0, 0.0, z) * SPACING,
        radius: radius * SPACING,
    };
    body(name, shape, SPACING, Vec3::new(0.0, 0.0, speed))
}

/// Planes of symmetry through the origin.
pub fn planes(axes: &[Axis]) -> Vec<SymmetryPlane> {
    let plane = |&axis| SymmetryPlane {
        axis,
        position: 0.0,
    };
    axes.iter().map(plane).collect()
}

/// Linear elastic aluminium.
pub fn make_elastic(case: &mut Case) {
    case.materials[0].eos = Eos::Linear(Linear {
        bulk_modulus: 79e9,
        form: LinearForm::Logarithmic,
    });
    case.materials[0].strength = Strength::Elastic(Elastic {
        shear_modulus: 28.6e9,
    });
    case.materials[0].failure.spall = None;
}
