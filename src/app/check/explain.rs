//! A case key by key, as TOML that gives the same case again.

use std::path::Path;

use crate::materials::written;
use files::input::{self, Explained, InputError};
use material::{Constant, Material, library};
use model::Case;

/// Columns that keys and values take before what is said of them.
const KEYS: usize = 44;

/// The lines.
pub(super) fn explain(path: &Path, overrides: &[String]) -> Result<String, InputError> {
    let (case, lines) = input::explain(path, overrides)?;
    let mut text = String::new();
    let mut add = |line: &str| {
        text.push_str(line);
        text.push('\n');
    };
    let (mut begun, mut of) = (false, Vec::new());
    let mut typed: Vec<(&str, &str)> = Vec::new();
    for line in &lines {
        match line {
            Explained::Header(header) => {
                constants(&of, &typed, &mut add);
                typed.clear();
                of = constants_of(&case, header);
                if begun {
                    add("");
                }
                add(header);
            }
            Explained::Typed { key, value, place } => {
                add(&beside(&format!("{key} = {value}"), place));
                typed.push((key, value));
            }
            // It is among the constants.
            Explained::Absent { key, .. } if has(&of, key) => {}
            Explained::Absent {
                key,
                default: Some(value),
                ..
            } => add(&beside(&format!("# {key} = {value}"), "default")),
            Explained::Absent { key, said, .. } => {
                add(&beside(&format!("# {key}"), &format!("default: {said}")));
            }
        }
        begun = true;
    }
    constants(&of, &typed, &mut add);
    Ok(text)
}

/// A line with what is said of it.
fn beside(line: &str, said: &str) -> String {
    // A comment that is too long for its line goes on in the next ones.
    format!("{line:<KEYS$}  # {said}")
}

/// The constants of the material whose table begins, if it is one.
fn constants_of(case: &Case, header: &str) -> Vec<Constant> {
    let name = header.strip_prefix("[material.");
    let name = name.and_then(|name| name.strip_suffix(']'));
    let found = name.and_then(|name| {
        let mut materials = case.materials.iter();
        materials.find(|material| material.name == name.trim_matches('"'))
    });
    found.map_or_else(Vec::new, Material::constants)
}

fn has(constants: &[Constant], key: &str) -> bool {
    constants.iter().any(|constant| constant.key == key)
}

/// The constants of a material that its table does not name.
fn constants(of: &[Constant], typed: &[(&str, &str)], add: &mut impl FnMut(&str)) {
    let named = typed.iter().find(|(key, _)| *key == "library");
    let base = named.and_then(|(_, name)| library::find(name.trim_matches(['"', '\''])));
    let base = base.map_or_else(Vec::new, |base| base.constants());
    for Constant { key, value } in of {
        if !typed.iter().any(|(other, _)| other == key) {
            let line = format!("# {key} = {}", written(*value));
            let from = if comes_from(&base, key) {
                "library"
            } else {
                "default"
            };
            add(&beside(&line, from));
        }
    }
}

/// `true` if a constant is one of the library's material: a shear modulus may be that of another
/// law.
fn comes_from(base: &[Constant], key: &str) -> bool {
    let is_shear = |key: &str| key.starts_with("strength.") && key.ends_with(".shear_modulus");
    has(base, key) || is_shear(key) && base.iter().any(|constant| is_shear(&constant.key))
}
