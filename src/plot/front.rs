//! The front of a body over time: how far the largest piece of it reaches along an axis.

use std::fmt::Write as _;
use std::path::PathBuf;

use super::PlotError;
use super::field::Shown;
use super::snapshot::Snapshot;
use crate::diagnose::pieces;
use crate::model::Axis;

/// The front of a body in some snapshots, as a table.
///
/// Each row is a time (s) and the largest coordinate (m) of the body's largest connected piece
/// ([`pieces::front`]).
///
/// # Errors
/// [`PlotError::Body`] if there is no such body, [`PlotError::Read`] if a snapshot cannot be read.
pub fn front(snapshots: &[PathBuf], body: &str, axis: Axis) -> Result<String, PlotError> {
    let mut table = String::from("# units: s,m\ntime,front\n");
    for path in snapshots {
        let snapshot = Snapshot::open(path)?;
        let Some(wanted) = snapshot.bodies.iter().position(|name| name == body) else {
            return Err(PlotError::Body {
                name: body.to_owned(),
                known: snapshot.bodies,
            });
        };
        let mut points = Vec::new();
        for rows in snapshot.chunks() {
            let bodies = snapshot.body_of(rows.clone())?;
            let bearers = Shown::Body.bearers(&snapshot, rows.clone())?;
            let all = snapshot.file.points(rows)?.into_iter().zip(bodies);
            let wanted = all
                .zip(bearers)
                .filter(|((_, of), bears)| *bears && *of == wanted);
            points.extend(wanted.map(|((point, _), _)| point));
        }
        let front = pieces::front(&points, axis.index(), snapshot.spacings[wanted]);
        if let Some(front) = front {
            let _ = writeln!(table, "{:?},{front:?}", snapshot.time);
        }
    }
    Ok(table)
}
