//! Snapshots of this program: the end of a run as the start of another.

use std::ops::Range;
use std::path::Path;

use super::names::from_vtk;
use super::part::{PartName, choose};
use super::{Fault, Request, Table};
use crate::output::h5::read::SnapshotFile;
use model::Quantity;
use results::{ReadError, SnapshotReader as _};

/// Particles read at a time.
const CHUNK: usize = 1 << 20;

/// Reads the particles of some bodies of a snapshot, but for frozen ones, with all that it has of
/// them.
///
/// # Errors
/// A fault of the file, or of what is asked of it.
pub fn read(path: &Path, request: &Request) -> Result<Table, Fault> {
    let file = SnapshotFile::open(path).map_err(read_fault)?;
    let dimension = file.number("/whipple", "dimension").map_err(read_fault)?;
    if dimension != request.dimension as u64 {
        let d = request.dimension;
        return Err(format!("it is of a model of {dimension} dimensions, not {d}").into());
    }
    if let Some(part) = file.portion().map_err(read_fault)? {
        let part = format!("it holds a part of the model alone ({part})");
        return Err(format!("{part}; give a snapshot of all particles").into());
    }
    let bodies = file.attribute("/whipple", "bodies").map_err(read_fault)?;
    let bodies: Vec<String> = serde_json::from_str(&bodies)
        .map_err(|cause| format!("attribute bodies of /whipple: {cause}"))?;
    let parts: Vec<PartName> = bodies
        .into_iter()
        .map(|name| PartName { number: None, name })
        .collect();
    let names = file.names().map_err(read_fault)?;
    let mut columns = columns(&file, &names)?;
    let wanted = choose(&parts, &request.parts)?;
    let frozen = names.iter().any(|name| name == "frozen");
    for first in (0..file.particles()).step_by(CHUNK) {
        let rows = first..file.particles().min(first + CHUNK);
        let kept = kept(&file, rows.clone(), &wanted, frozen)?;
        for (quantity, all) in &mut columns {
            let n = quantity.components();
            let mut values = if *quantity == Quantity::Position {
                let points = file.points(rows.clone()).map_err(read_fault)?;
                points.into_flattened()
            } else {
                file.values(quantity.name(), rows.clone())
                    .map_err(read_fault)?
            };
            from_vtk(*quantity, &mut values);
            let rows = values.chunks_exact(n).zip(&kept);
            all.extend(rows.filter(|(_, kept)| **kept).flat_map(|(row, _)| row));
        }
    }
    Ok(Table { columns })
}

#[allow(clippy::needless_pass_by_value, reason = "to map errors by")]
fn read_fault(cause: ReadError) -> Fault {
    Fault::from(cause.to_string())
}

/// The quantities that a snapshot tells, of no rows yet.
fn columns(file: &SnapshotFile, names: &[String]) -> Result<Vec<(Quantity, Vec<f64>)>, Fault> {
    let holds = |name: &str| names.iter().any(|held| held == name);
    if holds("stress_mass") {
        return Err("it has stress points, which hold the state of the particles".into());
    }
    if !holds(Quantity::Mass.name()) {
        let help = "name it in `output.fields` of the run";
        return Err(format!("it does not tell the `mass` of its particles: {help}").into());
    }
    let mut columns = vec![(Quantity::Position, Vec::new())];
    for &quantity in Quantity::ALL {
        let is_other = matches!(
            quantity,
            Quantity::Position | Quantity::Volume | Quantity::Temperature
        );
        if is_other || !holds(quantity.name()) {
            continue;
        }
        let found = file.components(quantity.name()).map_err(read_fault)?;
        if found != quantity.components() {
            let name = quantity.name();
            return Err(format!("its field {name} has {found} components").into());
        }
        columns.push((quantity, Vec::new()));
    }
    Ok(columns)
}

/// Flags of some rows that are particles of the bodies that are wanted, and not frozen.
fn kept(
    file: &SnapshotFile,
    rows: Range<usize>,
    wanted: &[bool],
    frozen: bool,
) -> Result<Vec<bool>, Fault> {
    let scalar = |name: &str| {
        let values = file.scalar(name, 0, rows.clone());
        values.map_err(|cause| Fault::from(cause.to_string()))
    };
    let bodies = scalar("body")?;
    let frozen = if frozen {
        scalar("frozen")?
    } else {
        vec![0.0; rows.len()]
    };
    let kept = |(body, frozen): (&f64, f64)| {
        let known = wanted
            .iter()
            .zip(0_u32..)
            .find(|(_, b)| f64::from(*b) == *body);
        match known {
            Some((wanted, _)) => Ok(*wanted && frozen == 0.0),
            None => Err(format!("body {body} of {} bodies", wanted.len()).into()),
        }
    };
    bodies.iter().zip(frozen).map(kept).collect()
}
