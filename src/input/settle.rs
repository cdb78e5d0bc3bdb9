//! The resolved text of a case that names files: it stands for the same case wherever it is read.

use std::path::Path;

use toml::{Table, Value};

use super::source::Diagnostic;
use super::triangles::{Format, absolute};
use crate::model::Case;

/// The resolved text of a case from a folder with the absolute paths of its surfaces' files and their
/// digests.
pub fn settle(resolved: String, folder: &Path, case: &Case) -> Result<String, Diagnostic> {
    let meshes = case.meshes().into_iter();
    let files: Vec<[&str; 2]> = meshes
        .filter_map(|(_, mesh)| mesh.file())
        .map(|file| [file.path.as_str(), file.sha256.as_str()])
        .collect();
    if files.is_empty() {
        return Ok(resolved);
    }
    let failed = |cause: String| Diagnostic::new(0..0, cause);
    let mut document: Table = toml::from_str(&resolved).map_err(|e| failed(e.to_string()))?;
    let mut settle = |table: &mut Table| {
        let Some(Value::String(name)) = table.get("file") else {
            return;
        };
        let path = absolute(&folder.join(name));
        if let Some([path, digest]) = files.iter().find(|[other, _]| *other == path) {
            table.insert("file".to_owned(), (*path).into());
            table.insert("sha256".to_owned(), (*digest).into());
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
    toml::to_string(&document).map_err(|e| failed(e.to_string()))
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
