//! Memory budget of a diagnosis.
//!
//! A search holds the effect of every law on every output at every sample, so it takes
//! laws x samples x outputs x 8 bytes. What a budget does not hold is left out by one rule: laws that
//! explain least of what is left when each is alone (`search::dictionary`), and the middle of stretches
//! of a record that is longer than can be looked at (`prepare::windows`). All else (blocks in which
//! simulations and fits are made) changes no result.

use std::fmt;
use std::str::FromStr;
use std::sync::OnceLock;

/// Bytes that a diagnosis may take where the system does not say how many there are.
const UNKNOWN: u64 = 4 << 30;
/// A budget below this holds no search.
const LEAST: u64 = 64 << 20;
/// Suffixes and what they stand for: powers of 10 (SI) and of 2 (IEC 80000-13).
const UNITS: [(&str, u64); 9] = [
    ("KiB", 1 << 10),
    ("MiB", 1 << 20),
    ("GiB", 1 << 30),
    ("TiB", 1 << 40),
    ("kB", 1_000),
    ("KB", 1_000),
    ("MB", 1_000_000),
    ("GB", 1_000_000_000),
    ("TB", 1_000_000_000_000),
];

/// How much memory a diagnosis may take.
///
/// # Example
///
/// ```
/// use lacuna::diagnose::Memory;
///
/// let memory: Memory = "1.5GB".parse()?;
/// assert_eq!(memory.bytes(), 1_500_000_000);
/// assert_eq!("512MiB".parse::<Memory>()?.to_string(), "537 MB");
/// assert!("much".parse::<Memory>().is_err());
/// # Ok::<(), String>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Memory(u64);

impl Memory {
    /// So many bytes; never below the 64 MiB that a search takes.
    pub fn of(bytes: u64) -> Self {
        Self(bytes.max(LEAST))
    }

    /// Number of bytes.
    pub fn bytes(self) -> u64 {
        self.0
    }

    /// So few bytes that little fits.
    #[cfg(test)]
    pub(crate) fn small(bytes: u64) -> Self {
        Self(bytes)
    }

    /// One part of so many.
    pub(crate) fn part(self, of: u64) -> usize {
        usize::try_from(self.0 / of).unwrap_or(usize::MAX)
    }
}

impl Default for Memory {
    /// Half of the machine's memory, or of what the process may have of it; 4 GiB where neither is
    /// known.
    fn default() -> Self {
        static HALF: OnceLock<u64> = OnceLock::new();
        Self::of(*HALF.get_or_init(|| {
            let known = [machine(), allowance()].into_iter().flatten().min();
            known.map_or(UNKNOWN, |bytes| bytes / 2)
        }))
    }
}

/// Memory of the machine in bytes, as Linux tells it.
fn machine() -> Option<u64> {
    of_meminfo(&std::fs::read_to_string("/proc/meminfo").ok()?)
}

fn of_meminfo(text: &str) -> Option<u64> {
    let line = text.lines().find_map(|line| line.strip_prefix("MemTotal:"))?;
    let kibibytes: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    kibibytes.checked_mul(1024)
}

/// Memory that a container may have, in bytes (Linux control groups, version 2).
fn allowance() -> Option<u64> {
    std::fs::read_to_string("/sys/fs/cgroup/memory.max").ok()?.trim().parse().ok()
}

impl FromStr for Memory {
    type Err = String;

    /// Reads `2GB`, `512 MiB` or a plain number of bytes.
    fn from_str(text: &str) -> Result<Self, String> {
        let wanted = || format!("`{text}` is no size: write one such as 2GB or 512MiB");
        let text = text.trim();
        let (number, unit) = UNITS
            .iter()
            .find_map(|(suffix, unit)| Some((text.strip_suffix(suffix)?, *unit)))
            .unwrap_or((text, 1));
        let number: f64 = number.trim().parse().map_err(|_| wanted())?;
        let bytes = number * unit as f64;
        if !(bytes > 0.0 && bytes < u64::MAX as f64) {
            return Err(wanted());
        }
        if bytes < LEAST as f64 {
            return Err(format!("`{text}` holds no search: at least 64MiB are needed"));
        }
        Ok(Self::of(bytes as u64))
    }
}

impl fmt::Display for Memory {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 {
            bytes if bytes < 1_000_000_000 => write!(f, "{:.0} MB", bytes as f64 / 1e6),
            bytes => write!(f, "{:.1} GB", bytes as f64 / 1e9),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_as_people_write_them() {
        let read = |text: &str| text.parse::<Memory>().map(Memory::bytes);
        assert_eq!(read("2GB"), Ok(2_000_000_000));
        assert_eq!(read("0.5 GiB"), Ok(1 << 29));
        assert_eq!(read("100000000"), Ok(100_000_000));
        for text in ["", "GB", "-1GB", "nanGB", "infGB", "1e30", "2 gigs", "63MiB", "0"] {
            assert!(read(text).is_err(), "{text}");
        }
    }

    #[test]
    fn half_of_the_machine_is_read_off_it() {
        let text = "MemFree: 12 kB\nMemTotal:       16318480 kB\n";
        assert_eq!(of_meminfo(text), Some(16_318_480 * 1024));
        assert_eq!(of_meminfo("MemTotal: many kB"), None);
        assert!(Memory::default() >= Memory::of(0));
    }
}
