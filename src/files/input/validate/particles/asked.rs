//! Demands of the input on a file.

use toml::Spanned;

use crate::input::cloud::{Columns, Wanted};
use crate::input::schema::{ColumnsParams, NamesParams, PartParams, PartsParams};
use crate::input::source::Diagnostic;
use model::Quantity;

/// Names of the columns of a file.
pub fn columns(table: &Spanned<ColumnsParams>) -> Columns {
    let params = table.get_ref();
    let names = |names: &NamesParams| match names {
        NamesParams::One(name) => vec![name.clone()],
        NamesParams::Many(names) => names.clone(),
    };
    let of = [
        (Quantity::Position, &params.position),
        (Quantity::Mass, &params.mass),
        (Quantity::Volume, &params.volume),
        (Quantity::Density, &params.density),
        (Quantity::Velocity, &params.velocity),
        (Quantity::SpecificEnergy, &params.specific_energy),
        (Quantity::Temperature, &params.temperature),
        (Quantity::DeviatoricStress, &params.deviatoric_stress),
        (Quantity::PlasticStrain, &params.plastic_strain),
        (Quantity::Damage, &params.damage),
    ];
    let stated = of
        .into_iter()
        .filter_map(|(quantity, given)| Some((quantity, names(given.as_ref()?.get_ref()))));
    let part = params.part.as_ref();
    Columns {
        of: stated.collect(),
        part: part.and_then(|part| names(part.get_ref()).into_iter().next()),
    }
}

/// Parts by name or number.
pub fn parts(table: &Spanned<PartsParams>) -> Result<Vec<Wanted>, Diagnostic> {
    let number = |number: f64| {
        #[allow(clippy::cast_possible_truncation)] // as checked
        let whole = (number.fract() == 0.0 && number.abs() < 9e15).then_some(number as i64);
        let title = "the number of a part is a whole one";
        whole
            .map(Wanted::Number)
            .ok_or_else(|| Diagnostic::new(table.span(), title))
    };
    match table.get_ref() {
        PartsParams::Name(name) => Ok(vec![Wanted::Name(name.clone())]),
        PartsParams::Number(n) => Ok(vec![number(*n)?]),
        PartsParams::Many(parts) if parts.is_empty() => {
            Err(Diagnostic::new(table.span(), "`part` names no part"))
        }
        PartsParams::Many(parts) => {
            let wanted = |part: &PartParams| match part {
                PartParams::Name(name) => Ok(Wanted::Name(name.clone())),
                PartParams::Number(n) => number(*n),
            };
            parts.iter().map(wanted).collect()
        }
    }
}
