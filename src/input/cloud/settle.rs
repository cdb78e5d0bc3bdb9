//! The text of a case that stands for the same files wherever it is read.

use crate::input::source::Diagnostic;
use crate::model::Body;

/// The resolved text of a case with the absolute paths of its files of particles and their digests.
///
/// # Errors
/// If the text is no TOML.
pub fn settle(resolved: String, bodies: &[Body]) -> Result<String, Diagnostic> {
    if bodies.iter().all(|body| body.cloud().is_none()) {
        return Ok(resolved);
    }
    let failed = |cause: String| Diagnostic::new(0..0, cause);
    let mut table: toml::Table = toml::from_str(&resolved).map_err(|e| failed(e.to_string()))?;
    let tables = table.get_mut("body").and_then(toml::Value::as_array_mut);
    for (table, body) in tables.into_iter().flatten().zip(bodies) {
        let particles = table.get_mut("particles");
        let particles = particles.and_then(toml::Value::as_table_mut);
        if let (Some(particles), Some((cloud, _))) = (particles, body.cloud()) {
            particles.insert("file".to_owned(), cloud.file.path.clone().into());
            particles.insert("sha256".to_owned(), cloud.file.sha256.clone().into());
        }
    }
    toml::to_string(&table).map_err(|e| failed(e.to_string()))
}
