//! The grid of a snapshot as VTK wants it: points, and a cell for each, in partitions.

use std::ops::Range;

use super::format::SnapshotFormat;
use super::values::write_values;
use crate::output::h5::{Element, RowType, Writer};
use crate::output::partitions::Partitions;
use crate::output::{Block, OutputError, Rows};
use comm::Comm;
use model::Precision;
use particles::{FieldId, ParticleStore};

/// Group of the grid.
pub(super) const GRID: &str = "/VTKHDF";
/// VTK's number of a cell that is a single point.
const VERTEX: u8 = 1;

/// Bytes of a cell: the number of its point, its offset and its type.
pub(super) const BYTES_OF_CELL: usize = 8 + 8 + 1;

/// Points, their cells, and the time (s).
pub(super) fn write_grid(
    comm: &Comm,
    file: &mut Writer,
    particles: &ParticleStore,
    time: f64,
    format: &SnapshotFormat,
    rows: &mut Rows,
) -> Result<(), OutputError> {
    let partitions = Partitions::new(rows.block().total, format.partition_rows);
    let sizes: Vec<i64> = partitions.sizes().map(signed).collect();
    file.group(GRID)?;
    file.vtk_header(GRID, "UnstructuredGrid", [1, 0])?;
    for name in ["NumberOfPoints", "NumberOfCells", "NumberOfConnectivityIds"] {
        file.numbers(&format!("{GRID}/{name}"), Element::I64, &sizes)?;
    }
    write_points(comm, file, particles, format.precision, rows)?;
    write_cells(comm, file, partitions, rows)?;
    file.group(&format!("{GRID}/PointData"))?;
    file.group(&format!("{GRID}/FieldData"))?;
    file.numbers(
        &format!("{GRID}/FieldData/TimeValue"),
        Element::F64,
        &[time],
    )
}

fn write_points(
    comm: &Comm,
    file: &mut Writer,
    particles: &ParticleStore,
    precision: Precision,
    rows: &mut Rows,
) -> Result<(), OutputError> {
    let vector = RowType {
        element: Element::F64,
        components: 3,
    };
    let (path, block) = (format!("{GRID}/Points"), rows.block());
    let points = rows.collect(comm, particles.bytes(FieldId::position), vector.bytes());
    let fill = |rows: Range<usize>, bytes: &mut [u8]| points.fill(rows, bytes);
    write_values(file, &path, vector, precision, block, &fill)?;
    file.note(&path, "unit", "m")
}

/// A vertex for each point. Numbers of points and offsets start anew in each partition.
fn write_cells(
    comm: &Comm,
    file: &mut Writer,
    partitions: Partitions,
    rows: &Rows,
) -> Result<(), OutputError> {
    let block = rows.block();
    let mut write = |name: &str, block: Block, value: &dyn Fn(u64) -> u64| {
        let path = format!("{GRID}/{name}");
        let integer = RowType::single(Element::I64);
        file.rows_of(&path, integer, block, &|rows, bytes| {
            let numbers = (block.first + rows.start as u64..).map(|k| signed(value(k)));
            for (target, number) in bytes.chunks_exact_mut(8).zip(numbers) {
                target.copy_from_slice(&number.to_ne_bytes());
            }
        })
    };
    write("Connectivity", block, &|row| partitions.local_row(row))?;
    let longer = partitions.offsets(block, block.closes(comm.is_root()));
    write("Offsets", longer, &|entry| partitions.offset(entry))?;
    let (path, byte) = (format!("{GRID}/Types"), RowType::single(Element::U8));
    file.rows_of(&path, byte, block, &|_, bytes| bytes.fill(VERTEX))
}

/// VTK counts in signed numbers.
fn signed(number: u64) -> i64 {
    i64::try_from(number).unwrap_or(i64::MAX)
}
