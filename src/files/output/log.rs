//! The log of a run.

use std::fs::File;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::time::Instant;

use model::readable::printable;

/// Lines of `log.txt`, each with the time since the start and the rank. Any rank may write; a
/// line goes out in one call, to the end of the file, at once.
#[derive(Debug)]
pub struct Log {
    path: PathBuf,
    file: Option<File>,
    start: Instant,
    rank: usize,
}

impl Log {
    /// A log of this rank's lines; nothing is opened before the first line.
    #[must_use]
    pub fn new(path: &Path, rank: usize) -> Self {
        Self {
            path: path.to_owned(),
            file: None,
            start: Instant::now(),
            rank,
        }
    }

    /// Appends a line. Trouble with the log is no reason to end a run and is ignored.
    pub fn line(&mut self, text: &str) {
        if self.file.is_none() {
            let mut options = File::options();
            self.file = options.append(true).create(true).open(&self.path).ok();
        }
        if let Some(file) = &mut self.file {
            let seconds = self.start.elapsed().as_secs_f64();
            let text = printable(text);
            let line = format!("[{seconds:10.3} s] rank {}: {text}\n", self.rank);
            let _ = file.write_all(line.as_bytes());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_of_two_ranks_go_to_one_file_at_once() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("log.txt");
        let (mut a, mut b) = (Log::new(&path, 0), Log::new(&path, 3));
        a.line("one");
        b.line("two");
        a.line("three");
        let text = std::fs::read_to_string(&path).unwrap();
        let tails: Vec<&str> = text
            .lines()
            .filter_map(|l| l.split_once("] "))
            .map(|l| l.1)
            .collect();
        assert_eq!(tails, ["rank 0: one", "rank 3: two", "rank 0: three"]);
    }
}
