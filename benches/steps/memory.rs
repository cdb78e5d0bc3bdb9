//! Memory of this process as the system counts it.

/// Memory of the process at the start of a measurement, to find the increase up to its peak.
pub struct Resident(Option<u64>);

impl Resident {
    /// Starts; resets the peak where the system supports it.
    pub fn start() -> Self {
        // 5 resets the peak (Linux, proc(5)).
        let reset = std::fs::write("/proc/self/clear_refs", "5").is_ok();
        Self(status("VmRSS:").filter(|_| reset))
    }

    /// Bytes at the peak beyond those at the start; `None` if unknown.
    pub fn peak(&self) -> Option<u64> {
        Some(status("VmHWM:")?.saturating_sub(self.0?))
    }
}

/// An entry of `/proc/self/status` (bytes).
fn status(key: &str) -> Option<u64> {
    let text = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = text.lines().find_map(|line| line.strip_prefix(key))?;
    let kilobytes: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kilobytes * 1024)
}
