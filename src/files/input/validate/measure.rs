//! Measures of a run.

use toml::Spanned;

use super::loads::given_name;
use super::measures::measures;
use super::named::{body, fields, unique};
use super::shapes::vector;
use super::surfaces::unit_vector;
use crate::input::quantity::{Length, Placed};
use crate::input::schema::{GaugeParams, MeasureParams, WitnessParams};
use crate::input::source::Diagnostic;
use model::{Cadence, Case, Gauge, MeasureOptions, SphForm, SymmetryPlane, Witness};

/// Rows of `measures.csv` of a run that does not say when it has them.
const ROWS: f64 = 10.0;

/// Measures of a case that is whole but for them.
pub fn measure(
    case: &Case,
    params: &MeasureParams,
    gauge_tables: &[Spanned<GaugeParams>],
    witness_tables: &[Spanned<WitnessParams>],
) -> Result<MeasureOptions, Diagnostic> {
    let mut gauges: Vec<Gauge> = Vec::new();
    for (n, table) in gauge_tables.iter().enumerate() {
        let found = gauge(case, table, n + 1)?;
        let taken = gauges.iter().any(|other| other.name == found.name);
        let own = table.get_ref().name.as_ref();
        unique(taken, "gauge", &found.name, own, table)?;
        gauges.push(found);
    }
    let mut witnesses: Vec<Witness> = Vec::new();
    for (n, table) in witness_tables.iter().enumerate() {
        if n == Witness::MOST {
            let title = format!("a case can have {} witness planes", Witness::MOST);
            return Err(Diagnostic::new(table.span(), title));
        }
        let found = witness(case, table.get_ref(), n + 1)?;
        let taken = witnesses.iter().any(|other| other.name == found.name);
        let own = table.get_ref().name.as_ref();
        unique(taken, "witness plane", &found.name, own, table)?;
        witnesses.push(found);
    }
    Ok(MeasureOptions {
        bodies: params.bodies(),
        every: params.every()?.unwrap_or(case.run.end_time / ROWS),
        measures: {
            let space = case.axisymmetric.then(|| case.revolved());
            measures(space.as_ref().unwrap_or(case), params)?
        },
        arrival_pressure: params.arrival_pressure()?,
        gauges,
        witnesses,
    })
}

fn gauge(case: &Case, table: &Spanned<GaugeParams>, number_of: usize) -> Result<Gauge, Diagnostic> {
    let params = table.get_ref();
    if case.sph.form == SphForm::StressPoints {
        let title = "a gauge cannot read stress points";
        return Err(Diagnostic::new(table.span(), title)
            .help("the other forms have their stress at the particles, see `sph.form`"));
    }
    let particle = params.particle()?;
    let at = match (&params.at, &params.particle) {
        (Some(at), None) => place(case, at)?,
        (None, Some(_)) => [0.0; 3],
        (None, None) => {
            return Err(Diagnostic::new(
                table.span(),
                "a gauge needs `at` or `particle`",
            ));
        }
        (Some(_), Some(id)) => {
            let title = "a gauge is at a place or carried by a particle of this id, not both";
            return Err(Diagnostic::new(id.span(), title));
        }
    };
    let of_place = [
        ("moves", params.moves.as_ref().map(Spanned::span)),
        ("body", params.body.as_ref().map(Spanned::span)),
    ];
    if let (Some(_), Some((key, span))) = (
        particle,
        of_place
            .into_iter()
            .find_map(|(key, span)| Some((key, span?))),
    ) {
        let title = format!("`{key}` goes with `at`: this gauge is carried by its particle");
        return Err(Diagnostic::new(span, title));
    }
    let along = params.along.as_ref();
    let along = along.map(|normal| unit_vector("along", normal, case.dimension));
    Ok(Gauge {
        name: given_name(params.name.as_ref(), "gauge", number_of),
        at,
        moves: particle.is_some() || params.moves.as_ref().is_some_and(|moves| *moves.get_ref()),
        particle,
        body: params
            .body
            .as_ref()
            .map(|name| body(case, name))
            .transpose()?,
        fields: fields(params.fields.as_ref(), params.along.is_none())?,
        along: along.transpose()?,
        every: every(params)?,
    })
}

/// A position (m) that is not behind a symmetry plane.
fn place(case: &Case, at: &Spanned<Vec<Placed<Length>>>) -> Result<[f64; 3], Diagnostic> {
    let position = vector("at", Some(at), case.dimension)?;
    let behind = |plane: &&SymmetryPlane| position[plane.axis.index()] < plane.position;
    match case.symmetry.iter().find(behind) {
        Some(plane) => {
            let title = format!("behind the symmetry plane of {}", plane.axis.name());
            Err(Diagnostic::new(at.span(), title)
                .help("put the gauge at the mirror image of the place"))
        }
        None => Ok(position),
    }
}

fn every(params: &GaugeParams) -> Result<Cadence, Diagnostic> {
    if let (Some(_), Some(steps)) = (&params.every, &params.every_steps) {
        let title = "a gauge reads every so many steps or every so much time, not both";
        return Err(Diagnostic::new(steps.span(), title));
    }
    let steps = Cadence::Steps(params.every_steps()?.unwrap_or(1));
    Ok(params.every()?.map_or(steps, Cadence::Time))
}

fn witness(case: &Case, params: &WitnessParams, number_of: usize) -> Result<Witness, Diagnostic> {
    let normal = unit_vector("normal", &params.normal, case.dimension)?;
    let crosses = |plane: &&SymmetryPlane| normal[plane.axis.index()] != 0.0;
    if let Some(plane) = case.symmetry.iter().find(crosses) {
        let title = format!(
            "the plane is not its own mirror image at the symmetry plane of {}",
            plane.axis.name()
        );
        return Err(Diagnostic::new(params.normal.span(), title));
    }
    Ok(Witness {
        name: given_name(params.name.as_ref(), "witness", number_of),
        point: vector("point", params.point.as_ref(), case.dimension)?,
        normal,
    })
}
