//! A case, and particles of files, whose every number tells where it belongs.

use comm::Comm;
use files::output::snapshot;
use model::{
    Body, Case, ContactMode, DomainOptions, Freedom, Initial, Lattice, LatticeKind, Loads,
    MeasureOptions, OutputOptions, RunControl, Shape, SymmetryPlane, TimeStepOptions, Vec3,
};
use particles::{FIELDS, ParticleStore};

use crate::sentinel::{id, mix, sentinel};

/// A case with two bodies and a symmetry plane.
pub fn case() -> Case {
    let body = |name: &str, spacing| Body {
        name: name.to_owned(),
        shape: Shape::Sphere {
            centre: Vec3::zeros(),
            radius: 1.0,
        },
        material: 0,
        lattice: Lattice {
            kind: LatticeKind::Cubic,
            spacing,
            angle: 0.0,
            ..Lattice::default()
        },
        density: Some(2785.0),
        initial: Initial::default(),
        velocity: Vec3::zeros(),
        angular_velocity: Vec3::zeros(),
        rigid: None,
        freedom: Freedom::default(),
        smoothing_length: 1.3 * spacing,
        total: false,
        layer: false,
        filled: None,
    };
    Case {
        title: "Sphere on plate, ⌀ 0.6 mm".to_owned(),
        length_unit: model::readable::Readable::length(1.0),
        dimension: 3,
        axisymmetric: false,
        materials: Vec::new(),
        bodies: vec![body("sphere", 2e-5), body("plate", 1e-5)],
        contacts: Vec::new(),
        default_contact: ContactMode::None,
        self_contact: None,
        symmetry: vec![SymmetryPlane {
            axis: model::Axis::Y,
            position: 0.0,
        }],
        loads: Loads::default(),
        sph: files::input::usual_sph(),
        numerical_limits: model::NumericalLimits::default(),
        time_step: TimeStepOptions {
            courant: 0.3,
            force: 0.3,
            contact: 0.5,
            max: f64::INFINITY,
        },
        domain: DomainOptions {
            levels: None,
            axes: [None; 3],
            balance_every: 10,
            keep: None,
        },
        run: RunControl {
            end_time: 1e-6,
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
        fragments: None,
        measure: MeasureOptions::default(),
        resolved: "title = \"Sphere on plate, ⌀ 0.6 mm\"\n[run]\nend = \"1 us\"\n".to_owned(),
    }
}

pub fn meta(case: &Case) -> snapshot::Meta<'_> {
    snapshot::Meta {
        run: None,
        case,
        step: 12,
        time: 3.5e-8,
        threads: 2,
        wall_seconds: 1.0,
        fragments: &[],
    }
}

/// This rank's part of `total` particles, scattered over all ranks but rank 1, in no order of
/// ids, with halo particles behind the owned ones that must not be written.
pub fn particles(comm: &Comm, total: u64) -> ParticleStore {
    let size = comm.size() as u64;
    let owner = |k: u64| match mix(k) % size {
        1 => size - 1 - u64::from(size == 2),
        rank => rank,
    };
    let mine: Vec<u64> = (0..total)
        .filter(|&k| owner(k) == comm.rank() as u64)
        .collect();
    let mut particles = ParticleStore::default();
    particles.resize_owned(mine.len());
    particles.resize_halo(3);
    for (row, field) in FIELDS.iter().enumerate() {
        let size = field.kind.bytes();
        let values = particles.bytes_mut(field.id);
        for (bytes, &k) in values.chunks_exact_mut(size).zip(&mine) {
            sentinel(id(k), row, bytes);
        }
    }
    particles
}

/// All ids in order.
pub fn sorted_ids(total: u64) -> Vec<u64> {
    let mut ids: Vec<u64> = (0..total).map(id).collect();
    ids.sort_unstable();
    ids
}
