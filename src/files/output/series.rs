//! The index of a run's snapshots, with which `ParaView` opens them as one animation.

use std::path::Path;

use serde::{Deserialize, Serialize};

use super::{OutputError, read_small, write_json};

/// A snapshot in the index.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Entry {
    /// File name, beside the index.
    pub name: String,
    /// Time (s).
    pub time: f64,
}

#[derive(Serialize, Deserialize)]
struct Index {
    #[serde(rename = "file-series-version")]
    version: String,
    files: Vec<Entry>,
}

/// The snapshots of an index in order of time; none if there is no index.
///
/// # Errors
/// [`OutputError::Io`], [`OutputError::Damaged`].
pub fn read(path: &Path) -> Result<Vec<Entry>, OutputError> {
    if !path.exists() {
        return Ok(Vec::new());
    }
    let text = read_small(path)?;
    let index: Index = serde_json::from_slice(&text)
        .map_err(|e| OutputError::damaged(path, format!("it is no file series: {e}")))?;
    Ok(index.files)
}

/// Adds a snapshot, or renews its entry. Rank 0's alone.
///
/// # Errors
/// [`OutputError::Io`], [`OutputError::Damaged`].
pub fn add(path: &Path, name: &str, time: f64) -> Result<(), OutputError> {
    let mut files = read(path)?;
    files.retain(|entry| entry.name != name);
    files.push(Entry {
        name: name.to_owned(),
        time,
    });
    write(path, files)
}

/// Keeps the snapshots up to a time (s). Rank 0's alone.
///
/// # Errors
/// [`OutputError::Io`], [`OutputError::Damaged`].
pub fn keep(path: &Path, keeps: impl Fn(&Entry) -> bool) -> Result<(), OutputError> {
    if !path.exists() {
        return Ok(());
    }
    let mut files = read(path)?;
    files.retain(keeps);
    write(path, files)
}

fn write(path: &Path, mut files: Vec<Entry>) -> Result<(), OutputError> {
    files.sort_by(|a, b| a.time.total_cmp(&b.time));
    let version = "1.0".to_owned();
    write_json(path, &Index { version, files })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn entries_are_added_renewed_and_dropped() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("snapshots.vtkhdf.series");
        assert!(read(&path).unwrap().is_empty());
        for (name, time) in [("a", 0.0), ("b", 1e-9), ("c", 2e-9), ("b", 1.5e-9)] {
            add(&path, name, time).unwrap();
        }
        keep(&path, |entry| entry.time <= 1.5e-9).unwrap();
        let names: Vec<_> = read(&path)
            .unwrap()
            .into_iter()
            .map(|e| (e.name, e.time))
            .collect();
        assert_eq!(names, [("a".to_owned(), 0.0), ("b".to_owned(), 1.5e-9)]);
        let text = std::fs::read_to_string(&path).unwrap();
        assert!(text.contains("\"file-series-version\": \"1.0\""), "{text}");
    }
}
