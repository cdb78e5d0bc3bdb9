//! Finding snapshots: a file, or the snapshots of a run folder.

use std::path::{Path, PathBuf};

use crate::PlotError;
use results::Opener;

/// The choice of snapshots of a run.
#[derive(Debug, Clone, PartialEq)]
pub enum Wanted {
    /// The last one.
    Last,
    /// All of them.
    All,
    /// The first, the middle and the last one.
    Three,
    /// Those nearest to some times (s).
    Times(Vec<f64>),
    /// Those with some numbers, counted from 0 in the order of time.
    Indices(Vec<usize>),
}

/// A run, or a snapshot alone, and which of its snapshots are drawn.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Source {
    /// Its name if several are in one picture.
    pub name: String,
    /// Snapshots in the order of time.
    pub snapshots: Vec<PathBuf>,
}

/// The snapshots of a run folder, or of its snapshots folder, in the order of time.
///
/// # Errors
/// [`PlotError::NoSnapshots`] if there are none, [`PlotError::Read`] if one cannot be read.
pub fn snapshots(opener: &dyn Opener, folder: &Path) -> Result<Vec<(f64, PathBuf)>, PlotError> {
    let inner = folder.join("snapshots");
    let folder = if inner.is_dir() { &inner } else { folder };
    let none = || PlotError::NoSnapshots {
        path: folder.to_owned(),
    };
    let mut times = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(|_| none())?.flatten() {
        let path = entry.path();
        // A name with a dot in front is a file that is still being written.
        let hidden = entry.file_name().to_string_lossy().starts_with('.');
        if !hidden && path.extension().is_some_and(|e| e == "vtkhdf") {
            times.push((opener.snapshot(&path)?.time()?, path));
        }
    }
    if times.is_empty() {
        return Err(none());
    }
    times.sort_by(|a, b| a.0.total_cmp(&b.0).then_with(|| a.1.cmp(&b.1)));
    Ok(times)
}

/// Chooses among snapshots (time, path), at least one, in the order of time; each at most once.
///
/// # Errors
/// [`PlotError::Index`] if there is no snapshot of some number.
pub fn choose<T: Clone>(snapshots: &[(f64, T)], wanted: &Wanted) -> Result<Vec<T>, PlotError> {
    let last = snapshots.len() - 1;
    let mut chosen = match wanted {
        Wanted::Last => vec![last],
        Wanted::All => (0..=last).collect(),
        Wanted::Three => vec![0, last / 2, last],
        Wanted::Times(times) => {
            let nearest = |time: &f64| {
                let distance = |k: &usize| (snapshots[*k].0 - time).abs();
                (0..=last).min_by(|a, b| distance(a).total_cmp(&distance(b)))
            };
            times.iter().filter_map(nearest).collect()
        }
        Wanted::Indices(indices) => {
            if let Some(&index) = indices.iter().find(|&&index| index > last) {
                return Err(PlotError::Index { index, last });
            }
            indices.clone()
        }
    };
    chosen.sort_unstable();
    chosen.dedup();
    Ok(chosen.into_iter().map(|k| snapshots[k].1.clone()).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn chooses_by_time_and_index() {
        let snapshots: Vec<_> = (0..5)
            .map(|k| (f64::from(k), PathBuf::from(k.to_string())))
            .collect();
        let names = |wanted| -> Vec<String> {
            let chosen = choose(&snapshots, &wanted).unwrap();
            chosen.iter().map(|p| p.display().to_string()).collect()
        };
        assert_eq!(names(Wanted::Last), ["4"]);
        assert_eq!(names(Wanted::Three), ["0", "2", "4"]);
        assert_eq!(names(Wanted::Times(vec![2.4, -1.0, 9.0])), ["0", "2", "4"]);
        assert_eq!(names(Wanted::Indices(vec![3, 1, 3])), ["1", "3"]);
        let error = choose(&snapshots, &Wanted::Indices(vec![7])).unwrap_err();
        assert!(error.to_string().contains("0 to 4"));
    }
}
