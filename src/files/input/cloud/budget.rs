//! A bound on what a file may make of few bytes.

/// Bytes of memory for each byte of a file, and of any file.
const TIMES: u64 = 32;
const LEAST: u64 = 64 << 20;

/// Memory that is left for what a file names several times, as elements of many sets.
#[derive(Debug)]
pub struct Budget {
    /// Bytes.
    left: u64,
}

impl Default for Budget {
    fn default() -> Self {
        Self { left: LEAST }
    }
}

impl Budget {
    /// That of a file of some length (bytes).
    pub fn of(length: usize) -> Self {
        let mut budget = Self::default();
        budget.add(length);
        budget
    }

    /// Adds what another file of its deck allows, by its length (bytes).
    pub fn add(&mut self, length: usize) {
        self.left = self
            .left
            .saturating_add(TIMES.saturating_mul(length as u64));
    }

    /// Takes the memory of `count` things of so many bytes, before they are made or gone through.
    ///
    /// # Errors
    /// If no more is left.
    pub fn take(&mut self, count: usize, bytes: usize) -> Result<(), String> {
        let all = (count as u64).checked_mul(bytes as u64);
        let left = all.and_then(|all| self.left.checked_sub(all));
        self.left = left.ok_or_else(|| {
            let most = LEAST >> 20;
            format!("it takes more than {TIMES} times its length and {most} MiB of memory")
        })?;
        Ok(())
    }
}
