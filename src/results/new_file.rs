//! Large files that appear under their names once they are whole.

use std::fs::{self, File};
use std::io::{self, BufWriter, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use crate::OutputError;
use crate::files::{partial, publish};

/// Bytes that are kept together before they go to the system.
const BUFFER: usize = 1 << 20;

/// A file that is being written by one process. Dropped before its end it leaves nothing behind.
#[derive(Debug)]
pub struct NewFile {
    path: PathBuf,
    temporary: PathBuf,
    file: BufWriter<File>,
    written: u64,
    whole: bool,
}

impl NewFile {
    /// Begins a file; one of the same name stays until the new one is whole. Creates the folder if it
    /// is missing.
    ///
    /// # Errors
    /// [`OutputError::Io`].
    pub fn create(path: &Path) -> Result<Self, OutputError> {
        let folder = path
            .parent()
            .filter(|folder| !folder.as_os_str().is_empty());
        if let Some(folder) = folder {
            fs::create_dir_all(folder).map_err(OutputError::io("create the folder", folder))?;
        }
        let temporary = partial(path);
        let file = File::create(&temporary).map_err(OutputError::io("create", &temporary))?;
        Ok(Self {
            path: path.to_owned(),
            temporary,
            file: BufWriter::with_capacity(BUFFER, file),
            written: 0,
            whole: false,
        })
    }

    /// The path of the whole file.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Bytes put so far.
    #[must_use]
    pub fn written(&self) -> u64 {
        self.written
    }

    /// Adds bytes at the end.
    ///
    /// # Errors
    /// [`OutputError::Io`].
    pub fn put(&mut self, bytes: &[u8]) -> Result<(), OutputError> {
        let put = self.file.write_all(bytes);
        put.map_err(OutputError::io("write", &self.temporary))?;
        self.written += bytes.len() as u64;
        Ok(())
    }

    /// Overwrites bytes that have been put, from an offset (bytes) on.
    ///
    /// # Errors
    /// [`OutputError::Io`].
    pub fn replace(&mut self, offset: u64, bytes: &[u8]) -> Result<(), OutputError> {
        let put = self.file.seek(SeekFrom::Start(offset));
        let put = put.and_then(|_| self.file.write_all(bytes));
        let put = put.and_then(|()| self.file.seek(SeekFrom::Start(self.written)));
        put.map(|_| ())
            .map_err(OutputError::io("write", &self.temporary))
    }

    /// Syncs the file and gives it its name.
    ///
    /// # Errors
    /// [`OutputError::Io`].
    pub fn finish(mut self) -> Result<(), OutputError> {
        let flushed = self.file.flush();
        let synced = flushed.and_then(|()| self.file.get_ref().sync_all());
        synced.map_err(OutputError::io("write", &self.temporary))?;
        publish(&self.temporary, &self.path)?;
        self.whole = true;
        Ok(())
    }
}

impl Write for NewFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let count = self.file.write(bytes)?;
        self.written += count as u64;
        Ok(count)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

impl Drop for NewFile {
    fn drop(&mut self) {
        if !self.whole {
            let _ = fs::remove_file(&self.temporary);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_appears_when_it_is_whole() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("made/here.txt");
        let mut file = NewFile::create(&path).unwrap();
        file.put(b"0000, body").unwrap();
        file.replace(0, b"head").unwrap();
        file.put(b" and").unwrap();
        write!(file, " end").unwrap();
        assert!(!path.exists());
        assert_eq!(file.written(), 18);
        file.finish().unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"head, body and end");

        let mut next = NewFile::create(&path).unwrap();
        next.put(b"half").unwrap();
        drop(next);
        assert_eq!(fs::read(&path).unwrap(), b"head, body and end");
        let left = fs::read_dir(path.parent().unwrap()).unwrap();
        assert_eq!(left.count(), 1);
    }
}
