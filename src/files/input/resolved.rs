//! The resolved text of a case that names files: it stands for the same case wherever it is read.

use std::path::Path;

use toml::{Table, Value};

use super::source::Diagnostic;
use super::triangles::{Format, absolute};
use material::Eos;
use model::{Case, SurfaceFile};

/// The resolved text of a case from a folder with the absolute paths of its files of triangles and of
/// particles, and their digests.
pub fn with_files(resolved: String, folder: &Path, case: &Case) -> Result<String, Diagnostic> {
    let meshes = case.meshes().into_iter();
    let files: Vec<&SurfaceFile> = meshes.filter_map(|(_, mesh)| mesh.file()).collect();
    let tables = || {
        case.materials
            .iter()
            .filter(|m| matches!(m.eos, Eos::Table(_)))
    };
    if files.is_empty()
        && case.bodies.iter().all(|body| body.cloud().is_none())
        && tables().next().is_none()
    {
        return Ok(resolved);
    }
    let failed = |cause: String| Diagnostic::new(0..0, cause);
    let mut document: Table = toml::from_str(&resolved).map_err(|e| failed(e.to_string()))?;
    let mut settle = |table: &mut Table| {
        let Some(Value::String(name)) = table.get("file") else {
            return;
        };
        let path = absolute(&folder.join(name));
        if let Some(file) = files.iter().find(|file| file.path == path) {
            state(table, file);
        }
    };
    for list in ["body", "surface"] {
        let tables = document.get_mut(list).and_then(Value::as_array_mut);
        for table in tables.into_iter().flatten() {
            if let Some(shape) = table.get_mut("shape") {
                each_file(shape, &mut settle);
            }
        }
    }
    let bodies = document.get_mut("body").and_then(Value::as_array_mut);
    for (table, body) in bodies.into_iter().flatten().zip(&case.bodies) {
        let particles = table.get_mut("particles").and_then(Value::as_table_mut);
        if let (Some(particles), Some((cloud, _))) = (particles, body.cloud()) {
            state(particles, &cloud.file);
        }
    }
    for material in tables() {
        let own = document
            .get_mut("material")
            .and_then(|all| all.get_mut(&material.name))
            .and_then(|own| own.get_mut("eos"))
            .and_then(|eos| eos.get_mut("table"))
            .and_then(Value::as_table_mut);
        if let (Some(table), Eos::Table(law)) = (own, &material.eos) {
            let [path, sha256] = law.file.clone();
            state(table, &SurfaceFile { path, sha256 });
        }
    }
    toml::to_string(&document).map_err(|e| failed(e.to_string()))
}

/// States in its table where a file is, and what it holds.
fn state(table: &mut Table, file: &SurfaceFile) {
    table.insert("file".to_owned(), file.path.clone().into());
    table.insert("sha256".to_owned(), file.sha256.clone().into());
}

/// Visits the tables of a shape, and of those that it is made of, that name files.
fn each_file(shape: &mut Value, visit: &mut impl FnMut(&mut Table)) {
    match shape {
        Value::Table(table) => {
            for (key, value) in table {
                match value {
                    Value::Table(file) if Format::KEYS.contains(&key.as_str()) => visit(file),
                    other => each_file(other, visit),
                }
            }
        }
        Value::Array(parts) => {
            for part in parts {
                each_file(part, visit);
            }
        }
        _ => {}
    }
}
