//! `eos`: exactly one equation of state, all of it or single values changed.

use std::io;
use std::path::Path;

use sha2::{Digest, Sha256};
use toml::Spanned;

use super::check::{Allowed, exactly_one};
use super::laws::law;
use super::meshes::missing_file;
use crate::input::schema::value::Ranged;
use crate::input::schema::{EosParams, TableParams, equations_of_state};
use crate::input::source::Diagnostic;
use crate::input::triangles::absolute;
use material::{Eos, EquationOfState, Grid, Jwl, Table, Tait};
use results::regular;

macro_rules! eos {
    ($(
        $(#[$doc:meta])+ $law:ident: $table:ident => $made:ident { $(
            $(#[$key_doc:meta])+ $key:ident: $typed:ty
                $(= $value:expr)? $(, $allowed:ident)? $(=> $words:literal)?;
        )+ } $(or {
            $(#[$way_doc:meta])+ $way:ident: $way_typed:ty, $way_allowed:ident => $of:ident: $make:expr;
        })?
    )+) => {
        /// The equation of state of a table, with values of the library's `base` where the table has none;
        /// `rho0` is the reference density (kg/m³).
        pub fn eos(
            table: &Spanned<EosParams>,
            base: Option<&Eos>,
            rho0: f64,
            folder: &Path,
        ) -> Result<Eos, Diagnostic> {
            let (at, params) = (table.span(), table.get_ref());
            let choices = [$( concat!("`", stringify!($law), "`"), )+ "`table`"].join(", ");
            let chosen = [$( params.$law.is_some(), )+ params.table.is_some()];
            if chosen.iter().filter(|is_there| **is_there).count() != 1 {
                return Err(exactly_one(at, "eos", &choices));
            }
            if let Some(params) = &params.table {
                return of_table(params, rho0, folder);
            }
            $( if let Some(params) = &params.$law {
                let base = match base {
                    Some(Eos::$made(law)) => Some(law),
                    _ => None,
                };
                let other = |_: &str| None::<f64>;
                $(
                    let way = params.$way.within(stringify!($way), Allowed::$way_allowed)?;
                    if let (Some(_), Some(way)) = (&params.$of, &params.$way) {
                        let title = concat!(
                            "`", stringify!($of), "` and `", stringify!($way),
                            "` say the same twice: give one of them"
                        );
                        return Err(Diagnostic::new(way.span(), title));
                    }
                    if params.$of.is_none() && way.is_none() && base.is_none() {
                        let title = concat!(
                            "`eos.", stringify!($law), "` needs `", stringify!($way), "` or `",
                            stringify!($of), "`"
                        );
                        return Err(Diagnostic::new(at, title).label("in this table"));
                    }
                    // Known below.
                    let other = |key: &str| other(key).or(way.filter(|_| key == stringify!($of)));
                )?
                let law = law!(params, base, other, at, $made { $($key [$($value)?])+ });
                $( let law = way.map_or(law, |way| ($make)(&law, rho0, way)); )?
                return Ok(Eos::$made(law));
            } )+
            Err(exactly_one(at, "eos", &choices))
        }
    };
}
equations_of_state!(eos);

/// Longest table that is read (bytes): ten million entries.
const LONGEST: u64 = 1_000_000_000;

/// The equation of state of the table of a file, which must be the one that the case began with.
fn of_table(params: &Spanned<TableParams>, rho0: f64, folder: &Path) -> Result<Eos, Diagnostic> {
    let params = params.get_ref();
    let temperature = params.reference_temperature()?;
    let path = folder.join(params.file.get_ref());
    let refuse = |cause: &str| {
        let title = format!("cannot take the table `{}`: {cause}", params.file.get_ref());
        Diagnostic::new(params.file.span(), title)
    };
    let bytes = regular::content(&path, LONGEST, "a table").map_err(|cause| {
        let diagnostic = refuse(&cause.to_string());
        if cause.kind() == io::ErrorKind::NotFound {
            missing_file(diagnostic, &path)
        } else {
            diagnostic
        }
    })?;
    let sha256 = format!("{:x}", Sha256::digest(&bytes));
    if let Some(known) = params.sha256.as_ref().filter(|d| *d.get_ref() != sha256) {
        let path = absolute(&path);
        let title = format!("the file {path} is no longer the one that the case began with");
        return Err(Diagnostic::new(known.span(), title)
            .help("bring it back, or begin a new case without `sha256`"));
    }
    let text = String::from_utf8(bytes).map_err(|_| refuse("it is no text"))?;
    let grid = Grid::read(&text).map_err(|cause| refuse(&cause))?;
    let table = Table::new(grid, rho0, temperature, [absolute(&path), sha256]);
    Ok(Eos::Table(table.map_err(|cause| refuse(&cause))?))
}
