//! Decks of text: a file, and those that it includes.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use ::sha2::{Digest, Sha256};

use super::LONGEST;
use super::budget::Budget;
use super::text::{self, shortened};
use results::regular;

/// Files that include each other, one in the other, at most.
const DEEPEST: usize = 16;

/// Access to the files that a deck includes, from its own folder and those below.
#[derive(Debug, Default)]
pub struct Deck {
    /// Nothing of a deck that may include no files.
    folder: Option<PathBuf>,
    /// Of all that was read, in this order.
    digest: Sha256,
    included: BTreeSet<PathBuf>,
    depth: usize,
    /// Length of all files (bytes).
    length: u64,
    /// Memory that they allow.
    pub budget: Budget,
}

impl Deck {
    /// A deck of some content that stands at a path.
    pub fn of(path: &Path, content: &[u8]) -> Self {
        let folder = path.parent().map(|folder| match folder.as_os_str() {
            empty if empty.is_empty() => PathBuf::from("."),
            folder => folder.into(),
        });
        let mut deck = Self {
            folder: folder.and_then(|folder| folder.canonicalize().ok()),
            length: content.len() as u64,
            budget: Budget::of(content.len()),
            ..Self::default()
        };
        deck.digest.update(content);
        deck
    }

    /// Hands the text of a file that the deck names to `read`. Each is read once, so that all costs
    /// no more than the files have bytes.
    ///
    /// # Errors
    /// If there is no such file below the folder of the deck, it was read before, or `read` fails.
    pub fn include(
        &mut self,
        name: &str,
        read: impl FnOnce(&mut Self, &str) -> Result<(), String>,
    ) -> Result<(), String> {
        let name = name.trim().trim_matches(['"', '\'']);
        let content = self
            .content(name)
            .map_err(|why| format!("cannot include `{}`: {why}", shortened(name)))?;
        self.depth += 1;
        let done = read(self, &text::of(&content));
        self.depth -= 1;
        done.map_err(|what| format!("in `{}`, {what}", shortened(name)))
    }

    fn content(&mut self, name: &str) -> Result<Vec<u8>, String> {
        let folder = self.folder.as_ref().ok_or("the deck is in no folder")?;
        let path = folder.join(name).canonicalize();
        let path = path.map_err(|cause| cause.to_string())?;
        if !path.starts_with(folder) {
            return Err("it is not below the folder of the deck".to_owned());
        }
        if self.depth == DEEPEST || !self.included.insert(path.clone()) {
            return Err("it is included twice, or too deep".to_owned());
        }
        let content = regular::content(&path, LONGEST - self.length.min(LONGEST), "a deck");
        let content = content.map_err(|cause| cause.to_string())?;
        self.length += content.len() as u64;
        self.budget.add(content.len());
        self.digest.update(&content);
        Ok(content)
    }

    /// The SHA-256 of all that was read, in hexadecimal digits.
    pub fn sha256(&self) -> String {
        format!("{:x}", self.digest.clone().finalize())
    }
}
