//! The machine that was measured.

use std::hash::{DefaultHasher, Hash, Hasher};

use serde::{Deserialize, Serialize};

/// The machine and the instructions in use.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Machine {
    /// The processor's own name.
    pub processor: String,
    /// Cores that this process may use.
    pub cores: usize,
    /// Instruction set of the pair sums.
    pub instructions: String,
    /// Operating system and architecture.
    pub system: String,
}

impl Machine {
    /// The machine that this process runs on.
    pub fn here() -> Self {
        Self {
            processor: processor().unwrap_or_else(|| "unknown".to_owned()),
            cores: cores(),
            instructions: numerics::dispatch::instructions().name().to_owned(),
            system: format!("{}, {}", std::env::consts::OS, std::env::consts::ARCH),
        }
    }
}

/// Cores that this process may use.
pub fn cores() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}

/// A hash of the host name.
pub fn host() -> u64 {
    let mut hasher = DefaultHasher::new();
    let name = std::fs::read("/proc/sys/kernel/hostname");
    name.unwrap_or_default().hash(&mut hasher);
    hasher.finish()
}

fn processor() -> Option<String> {
    let text = std::fs::read_to_string("/proc/cpuinfo").ok()?;
    let line = text.lines().find(|line| line.starts_with("model name"))?;
    Some(line.split_once(':')?.1.trim().to_owned())
}
