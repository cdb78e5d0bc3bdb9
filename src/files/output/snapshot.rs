//! Snapshots: the particles at one time as a VTKHDF file, for `ParaView`, `h5py` and the plots.
//!
//! One `UnstructuredGrid` of version 1.0, a vertex for each particle, rows in id order and cut into
//! partitions of a fixed number: the content does not depend on ranks. `/whipple` describes the case;
//! `/run` holds what depends on ranks and clocks.

mod format;
mod grid;
mod plan;
mod values;

use std::ops::Range;
use std::path::Path;

use comm::Comm;
use uuid::Uuid;

use model::{Case, Precision};
use particles::{FieldKind, Owner, ParticleStore};

use super::h5::read::{PORTION, RUN};
use super::h5::{Element, RowType, Writer};
pub use super::quantity::{Quantity, quantities, quantities_of};
use super::{OutputError, Rows, VERSION, commit, files, publish_or_remove, unit_of_model};
pub use format::{Portion, SnapshotFormat};
use grid::{GRID, write_grid};
pub use plan::Plan;
use values::write_values;

/// Extension of snapshot files.
pub const EXTENSION: &str = "vtkhdf";

/// Metadata of a snapshot.
#[derive(Debug, Clone, Copy)]
pub struct Meta<'a> {
    /// The case.
    pub case: &'a Case,
    /// Id of the run, if it is one in a folder.
    pub run: Option<Uuid>,
    /// Step number.
    pub step: u64,
    /// Time (s).
    pub time: f64,
    /// Threads of each rank.
    pub threads: usize,
    /// Time since the start of the run (s).
    pub wall_seconds: f64,
    /// Labels of fragments of this rank's particles, where the snapshot has these; the last particles,
    /// which have none, belong to no fragment.
    pub fragments: &'a [u64],
}

/// Writes a snapshot, which appears under its name once it is whole. Collective.
///
/// # Errors
/// The same on every rank; the old file of that name, if any, is then still there.
pub fn write(
    comm: &Comm,
    path: &Path,
    particles: &ParticleStore,
    meta: &Meta,
    format: &SnapshotFormat,
    rows: &mut Rows,
) -> Result<(), OutputError> {
    let temporary = files::partial(path);
    let written = write_file(comm, &temporary, particles, meta, format, rows);
    publish_or_remove(comm, written, &temporary, || {
        files::publish(&temporary, path)
    })
}

/// Bytes of a particle in a snapshot: its position, its cell and its quantities.
#[must_use]
pub fn bytes_per_particle(format: &SnapshotFormat, particles: &ParticleStore) -> usize {
    let real = match format.precision {
        Precision::Double => 8,
        Precision::Single => 4,
    };
    let bytes = |quantity: Quantity| match quantity {
        Quantity::Field(field) if field.kind.is_real() => field.kind.components() * real,
        Quantity::Field(field) => field.kind.bytes(),
        Quantity::Fragment => 8,
        Quantity::VonMisesStress | Quantity::Temperature => real,
    };
    let quantities = with_frozen(particles, format.quantities).map(bytes);
    3 * real + grid::BYTES_OF_CELL + quantities.sum::<usize>()
}

fn write_file(
    comm: &Comm,
    path: &Path,
    particles: &ParticleStore,
    meta: &Meta,
    format: &SnapshotFormat,
    rows: &mut Rows,
) -> Result<(), OutputError> {
    let ids = &particles.id[..particles.owned()];
    match format.portion.chosen(particles) {
        Some(chosen) => rows.plan_of(comm, ids, chosen)?,
        None => rows.plan(comm, ids)?,
    }
    let mut file = Writer::create_aligned(comm, path, rows.sharing().alignment)?;
    write_grid(comm, &mut file, particles, meta.time, format, rows)?;
    for quantity in with_frozen(particles, format.quantities) {
        let precision = format.precision;
        write_quantity(comm, &mut file, particles, meta, quantity, precision, rows)?;
    }
    write_meta(comm, &mut file, meta, format)?;
    file.close()
}

/// The quantities chosen, and the field of frozen particles where there may be any.
fn with_frozen(particles: &ParticleStore, chosen: &[Quantity]) -> impl Iterator<Item = Quantity> {
    let name = |quantity: &Quantity| quantity.name();
    let missing = particles.held(Owner::FREEZE).map(Quantity::Field);
    let missing = missing.filter(move |field| !chosen.iter().any(|q| name(q) == name(field)));
    chosen.iter().copied().chain(missing)
}

fn write_quantity(
    comm: &Comm,
    file: &mut Writer,
    particles: &ParticleStore,
    meta: &Meta,
    quantity: Quantity,
    precision: Precision,
    rows: &mut Rows,
) -> Result<(), OutputError> {
    let (block, case) = (rows.block(), meta.case);
    let path = format!("{GRID}/PointData/{}", quantity.name());
    let mut write = |kind: FieldKind, values: &[u8]| {
        let row = row_type(kind);
        let gathered = rows.collect(comm, values, row.bytes());
        let fill = |rows: Range<usize>, bytes: &mut [u8]| {
            gathered.fill(rows, bytes);
            if kind == FieldKind::Symmetric {
                // The store has xy, xz, yz at the end, VTK xy, yz, xz.
                for tensor in bytes.chunks_exact_mut(48) {
                    let (front, back) = tensor.split_at_mut(40);
                    front[32..].swap_with_slice(back);
                }
            }
        };
        write_values(file, &path, row, precision, block, &fill)
    };
    match quantity {
        Quantity::Field(field) => write(field.kind, &particles.bytes_or_zeros(field))?,
        Quantity::Fragment => {
            let mut labels = meta.fragments.to_vec();
            labels.resize(particles.owned(), u64::MAX);
            write(FieldKind::Id, bytemuck::cast_slice(&labels))?;
        }
        Quantity::VonMisesStress | Quantity::Temperature => {
            let value = |i: usize| match quantity {
                Quantity::Temperature => temperature(case, particles, i),
                _ => von_mises(&particles.deviatoric_stress[i]),
            };
            let values: Vec<f64> = (0..particles.owned()).map(value).collect();
            write(FieldKind::Scalar, bytemuck::cast_slice(&values))?;
        }
    }
    let unit = unit_of_model(quantity.unit(), case.extent());
    file.note(&path, "unit", unit)?;
    file.note(&path, "description", &quantity.description())
}

/// `√(3/2 s:s)` (Pa) of a deviatoric stress xx, yy, zz, xy, xz, yz (Pa).
fn von_mises(s: &[f64; 6]) -> f64 {
    let normal = s[0] * s[0] + s[1] * s[1] + s[2] * s[2];
    let shear = s[3] * s[3] + s[4] * s[4] + s[5] * s[5];
    (1.5 * (normal + 2.0 * shear)).sqrt()
}

/// Temperature (K) of an owned particle.
fn temperature(case: &Case, particles: &ParticleStore, i: usize) -> f64 {
    let body = case.bodies.get(particles.body[i] as usize);
    let material = body.and_then(|body| case.materials.get(body.material));
    material
        .and_then(|material| particles.temperature(material, i))
        .unwrap_or(f64::NAN)
}

/// VTK has no unsigned ids, so an id keeps its bits as `i64`.
fn row_type(kind: FieldKind) -> RowType {
    let element = match kind {
        FieldKind::Id => Element::I64,
        FieldKind::Index => Element::U32,
        _ => Element::F64,
    };
    RowType {
        element,
        components: kind.components(),
    }
}

/// Writes the metadata of the case and of the run.
fn write_meta(
    comm: &Comm,
    file: &mut Writer,
    meta: &Meta,
    format: &SnapshotFormat,
) -> Result<(), OutputError> {
    let case = meta.case;
    let names: Vec<&str> = case.bodies.iter().map(|b| b.name.as_str()).collect();
    let spacings: Vec<f64> = case.bodies.iter().map(|b| b.lattice.spacing).collect();
    let planes = case.symmetry.iter();
    let planes: Vec<_> = planes.map(|p| (p.axis.name(), p.position)).collect();
    let group = "/whipple";
    file.group(group)?;
    file.note(group, "title", &case.title)?;
    file.note(group, "bodies", &serde_json::json!(names).to_string())?;
    file.note(group, "spacings", &serde_json::json!(spacings).to_string())?;
    let coarsest: Vec<f64> = case.bodies.iter().map(|b| b.lattice.coarsest()).collect();
    let coarsest = serde_json::json!(coarsest).to_string();
    file.note(group, "coarsest_spacings", &coarsest)?;
    let densities = case.bodies.iter().map(|b| case.initial_density(b));
    let densities = serde_json::json!(densities.collect::<Vec<f64>>());
    file.note(group, "densities", &densities.to_string())?;
    let rigid: Vec<bool> = case.bodies.iter().map(|b| b.rigid.is_some()).collect();
    file.note(group, "rigid", &serde_json::json!(rigid).to_string())?;
    file.note(group, "symmetry", &serde_json::json!(planes).to_string())?;
    if let Some(schedule) = format.schedule {
        file.note(group, "schedule", schedule)?;
    }
    if !format.portion.is_all() {
        file.note(group, PORTION, &format.portion.text(case))?;
    }
    file.note(group, "version", VERSION)?;
    file.note(group, "commit", commit())?;
    file.number(group, "dimension", &(case.dimension as u64))?;
    file.number(group, "step", &meta.step)?;
    file.text(&format!("{group}/input"), &case.resolved)?;
    let group = "/run";
    file.group(group)?;
    if let Some(run) = meta.run {
        file.note(group, RUN, &run.to_string())?;
    }
    file.number(group, "ranks", &(comm.size() as u64))?;
    file.number(group, "threads", &(meta.threads as u64))?;
    // Every rank writes the same number into metadata.
    file.number(group, "wall_seconds", &comm.max_f64(meta.wall_seconds))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn von_mises_stress_of_uniaxial_and_shear_stress() {
        // σ_xx = 3: s = (2, −1, −1); σ_xy = τ: √3 τ.
        assert_eq!(
            von_mises(&[2.0, -1.0, -1.0, 0.0, 0.0, 0.0]).to_bits(),
            3.0_f64.to_bits()
        );
        let shear = von_mises(&[0.0, 0.0, 0.0, 0.0, 2.0, 0.0]);
        assert!((shear - 12.0_f64.sqrt()).abs() < 1e-15);
    }
}
