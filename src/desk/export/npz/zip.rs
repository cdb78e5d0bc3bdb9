//! A ZIP archive of entries as they are, without compression.

use crc32fast::Hasher;

use files::output::{NewFile, OutputError};

const LOCAL: u32 = 0x0403_4b50;
const CENTRAL: u32 = 0x0201_4b50;
const END: u32 = 0x0605_4b50;
const END_64: u32 = 0x0606_4b50;
const LOCATOR_64: u32 = 0x0706_4b50;
/// Version of the layout that knows sizes of 64 bits.
const VERSION: u16 = 45;
/// First day of the layout: 1 January 1980.
const DAY: u16 = 0x0021;
/// Names are UTF-8.
const UTF_8: u16 = 1 << 11;
/// The value of a short number whose long one follows.
const LONG: u64 = 0xffff_ffff;
/// Bytes of a local head before the digest.
const DIGEST_AT: u64 = 14;

struct Entry {
    name: String,
    size: u64,
    offset: u64,
    digest: u32,
}

/// An archive that is being written.
pub struct Archive<'a> {
    out: &'a mut NewFile,
    entries: Vec<Entry>,
    digest: Hasher,
}

impl<'a> Archive<'a> {
    /// Begins an archive at the start of a file.
    pub fn new(out: &'a mut NewFile) -> Self {
        Self {
            out,
            entries: Vec::new(),
            digest: Hasher::new(),
        }
    }

    /// Begins an entry of so many bytes.
    pub fn begin(&mut self, name: &str, size: u64) -> Result<(), OutputError> {
        let entry = Entry {
            name: name.to_owned(),
            size,
            offset: self.out.written(),
            digest: 0,
        };
        let longs: &[u64] = if size >= LONG { &[size, size] } else { &[] };
        let mut head = LOCAL.to_le_bytes().to_vec();
        head.extend(common(&entry, longs));
        head.extend(name.bytes());
        head.extend(extra(longs));
        self.entries.push(entry);
        self.digest = Hasher::new();
        self.out.put(&head)
    }

    /// Adds bytes to the entry.
    pub fn put(&mut self, bytes: &[u8]) -> Result<(), OutputError> {
        self.digest.update(bytes);
        self.out.put(bytes)
    }

    /// Ends the entry.
    pub fn end(&mut self) -> Result<(), OutputError> {
        let digest = self.digest.clone().finalize();
        let Some(entry) = self.entries.last_mut() else {
            return Ok(());
        };
        entry.digest = digest;
        let offset = entry.offset + DIGEST_AT;
        self.out.replace(offset, &digest.to_le_bytes())
    }

    /// Ends the archive with the list of its entries.
    pub fn finish(self) -> Result<(), OutputError> {
        let first = self.out.written();
        let count = self.entries.len() as u64;
        for entry in &self.entries {
            self.out.put(&listed(entry))?;
        }
        let size = self.out.written() - first;
        if first + size >= LONG {
            let at = self.out.written();
            self.out.put(&end_64(count, size, first, at))?;
        }
        let short = |value: u64| u32::try_from(value).unwrap_or(u32::MAX).to_le_bytes();
        let entries = u16::try_from(count).unwrap_or(u16::MAX).to_le_bytes();
        let mut end = END.to_le_bytes().to_vec();
        end.extend([0; 4]);
        end.extend(entries);
        end.extend(entries);
        end.extend(short(size));
        end.extend(short(first));
        end.extend([0; 2]);
        self.out.put(&end)
    }
}

/// The common part of the head of an entry and its line in the list; `longs` are numbers that
/// follow.
fn common(entry: &Entry, longs: &[u64]) -> Vec<u8> {
    let mut bytes = Vec::new();
    for number in [VERSION, UTF_8, 0, 0, DAY] {
        bytes.extend(number.to_le_bytes());
    }
    bytes.extend(entry.digest.to_le_bytes());
    let size = u32::try_from(entry.size).unwrap_or(u32::MAX);
    bytes.extend(size.to_le_bytes());
    bytes.extend(size.to_le_bytes());
    let lengths = [entry.name.len(), extra(longs).len()];
    for length in lengths {
        bytes.extend(u16::try_from(length).unwrap_or(u16::MAX).to_le_bytes());
    }
    bytes
}

/// An entry in the list.
fn listed(entry: &Entry) -> Vec<u8> {
    let mut longs = Vec::new();
    if entry.size >= LONG {
        longs.extend([entry.size; 2]);
    }
    if entry.offset >= LONG {
        longs.push(entry.offset);
    }
    let mut bytes = CENTRAL.to_le_bytes().to_vec();
    bytes.extend(VERSION.to_le_bytes());
    bytes.extend(common(entry, &longs));
    // Comment, disk and attributes.
    bytes.extend([0; 10]);
    let offset = u32::try_from(entry.offset).unwrap_or(u32::MAX);
    bytes.extend(offset.to_le_bytes());
    bytes.extend(entry.name.bytes());
    bytes.extend(extra(&longs));
    bytes
}

/// Numbers of 64 bits behind a name.
fn extra(longs: &[u64]) -> Vec<u8> {
    if longs.is_empty() {
        return Vec::new();
    }
    let mut bytes = 1_u16.to_le_bytes().to_vec();
    let length = u16::try_from(8 * longs.len()).unwrap_or(u16::MAX);
    bytes.extend(length.to_le_bytes());
    for long in longs {
        bytes.extend(long.to_le_bytes());
    }
    bytes
}

/// The end of a long archive, and its offset.
fn end_64(count: u64, size: u64, first: u64, at: u64) -> Vec<u8> {
    let mut bytes = END_64.to_le_bytes().to_vec();
    bytes.extend(44_u64.to_le_bytes());
    bytes.extend(VERSION.to_le_bytes());
    bytes.extend(VERSION.to_le_bytes());
    bytes.extend([0; 8]);
    for number in [count, count, size, first] {
        bytes.extend(number.to_le_bytes());
    }
    bytes.extend(LOCATOR_64.to_le_bytes());
    bytes.extend([0; 4]);
    bytes.extend(at.to_le_bytes());
    bytes.extend(1_u32.to_le_bytes());
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Sizes and offsets beyond 4 GB follow the name, as the short ones say.
    #[test]
    fn large_entries_have_long_numbers() {
        let entry = Entry {
            name: "a.npy".to_owned(),
            size: 5 << 30,
            offset: 6 << 30,
            digest: 7,
        };
        let bytes = listed(&entry);
        assert_eq!(bytes.len(), 46 + 5 + 4 + 24);
        assert_eq!(bytes[20..28], [0xff; 8]);
        assert_eq!(bytes[30..32], 28_u16.to_le_bytes());
        assert_eq!(bytes[42..46], [0xff; 4]);
        assert_eq!(bytes[51..55], [1, 0, 24, 0]);
        assert_eq!(bytes[55..63], (5_u64 << 30).to_le_bytes());
        assert_eq!(bytes[71..79], (6_u64 << 30).to_le_bytes());
    }
}
