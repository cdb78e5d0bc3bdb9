//! Velocities as functions of time.

use toml::Spanned;

use super::check::Value;
use super::in_dimension;
use crate::input::forms::OneOrMany;
use crate::input::quantity::{Placed, Time};
use crate::input::schema::{MotionParams, PressureParams, RotationParams};
use crate::input::source::Diagnostic;
use model::{Axis, Motion};

/// The motion in a table that names at least one axis, all of them in the dimension.
pub fn motion(table: &Spanned<MotionParams>, dimension: usize) -> Result<Motion, Diagnostic> {
    let params = table.get_ref();
    let times = times(params.times.as_ref())?;
    let mut motion = Motion {
        times,
        ..Motion::default()
    };
    let count = motion.times.len();
    for (axis, values) in Axis::ALL.into_iter().zip([&params.x, &params.y, &params.z]) {
        let Some(values) = values else { continue };
        in_dimension(axis, dimension, values.span())?;
        motion.velocities[axis.index()] =
            Some(along(values, axis.name(), params.times.is_some(), count)?);
    }
    if motion.velocities.iter().all(Option::is_none) {
        let title = "a velocity must be given along at least one of `x`, `y`, `z`";
        return Err(Diagnostic::new(table.span(), title));
    }
    Ok(motion)
}

/// The rate of a rotation (rad/s), as a motion along the first axis.
pub fn rate(params: &RotationParams) -> Result<Motion, Diagnostic> {
    let times = times(params.times.as_ref())?;
    let timed = params.times.is_some();
    let values = along(&params.rate, "rate", timed, times.len())?;
    Ok(Motion {
        times,
        velocities: [Some(values), None, None],
    })
}

/// A pressure (Pa) as a motion along the first axis.
pub fn pressure(params: &PressureParams) -> Result<Motion, Diagnostic> {
    let times = times(params.times.as_ref())?;
    let timed = params.times.is_some();
    let values = along(&params.value, "value", timed, times.len())?;
    Ok(Motion {
        times,
        velocities: [Some(values), None, None],
    })
}

fn times(params: Option<&Spanned<Vec<Placed<Time>>>>) -> Result<Vec<f64>, Diagnostic> {
    let Some(times) = params else {
        return Ok(vec![0.0]);
    };
    let mut read: Vec<f64> = Vec::new();
    for time in times.get_ref() {
        let t = time.get_ref().si();
        if t < 0.0 || read.last().is_some_and(|&before| t < before) {
            let title = "`times` must begin at zero or later and never fall";
            return Err(Diagnostic::new(time.span(), title).label("out of order"));
        }
        read.push(t);
    }
    if read.is_empty() {
        return Err(Diagnostic::new(times.span(), "`times` must not be empty"));
    }
    Ok(read)
}

fn along<K>(
    values: &Spanned<OneOrMany<K>>,
    name: &str,
    timed: bool,
    count: usize,
) -> Result<Vec<f64>, Diagnostic> {
    match values.get_ref() {
        OneOrMany::One(value) => Ok(vec![value.si(); count]),
        OneOrMany::Many(_) if !timed => {
            let title = format!("`{name}` is a table of time without `times`");
            Err(Diagnostic::new(values.span(), title)
                .help("add `times`, one for each value, or give one value for ever"))
        }
        OneOrMany::Many(list) if list.len() == count => {
            Ok(list.iter().map(|value| value.get_ref().si()).collect())
        }
        OneOrMany::Many(list) => {
            let found = list.len();
            let title = format!("`{name}` must have {count} values as `times` has, found {found}");
            Err(Diagnostic::new(values.span(), title))
        }
    }
}
