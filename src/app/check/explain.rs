//! A case key by key, as TOML that gives the same case again.

use std::path::Path;

use crate::app::materials::written;
use crate::input::{self, Explained, InputError};
use crate::material::Material;
use crate::model::Case;

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
    let (mut begun, mut of) = (false, None);
    let mut typed: Vec<String> = Vec::new();
    for line in &lines {
        match line {
            Explained::Header(header) => {
                constants(of, &typed, &mut add);
                typed.clear();
                of = material(&case, header);
                if begun {
                    add("");
                }
                add(header);
            }
            Explained::Typed { key, value, place } => {
                add(&beside(&format!("{key} = {value}"), place));
                typed.push(key.clone());
            }
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
    constants(of, &typed, &mut add);
    Ok(text)
}

/// A line with what is said of it.
fn beside(line: &str, said: &str) -> String {
    // What is longer than a line may be goes on in the next ones, as it is typed.
    format!("{line:<KEYS$}  # {said}")
}

/// The material whose table begins.
fn material<'a>(case: &'a Case, header: &str) -> Option<&'a Material> {
    let name = header.strip_prefix("[material.")?.strip_suffix(']')?;
    let name = name.trim_matches('"');
    case.materials.iter().find(|material| material.name == name)
}

/// The constants of a material that its table does not name.
fn constants(of: Option<&Material>, typed: &[String], add: &mut impl FnMut(&str)) {
    let Some(material) = of else { return };
    let from = if typed.iter().any(|key| key == "library") {
        "library"
    } else {
        "default"
    };
    for constant in material.constants() {
        if !typed.contains(&constant.key) {
            let line = format!("# {} = {}", constant.key, written(constant.value));
            add(&beside(&line, from));
        }
    }
}
