//! Limits of one job: time, and memory where the system can hold a process to it.

use serde::{Deserialize, Serialize};
use toile_geometry::Duration;

/// Time that a job may take where nothing is said (s).
const DEFAULT_TIME: f64 = 3600.0;
/// Memory that a job may take where nothing is said (bytes). The finest drape of the dress that ships takes 0.7 GB
/// (`VmPeak` of the process on Linux, one thread).
const DEFAULT_MEMORY: u64 = 3_000_000_000;
/// Shortest time that can be asked for (s).
const MIN_TIME: f64 = 0.1;
/// Longest time that can be asked for (s): thirty days.
const MAX_TIME: f64 = 30.0 * 86_400.0;
/// Least memory that can be asked for (bytes): the program alone takes some.
const MIN_MEMORY: u64 = 16_000_000;
/// Units of memory with their bytes.
const UNITS: [(&str, f64); 2] = [("GB", 1e9), ("MB", 1e6)];

/// Limits of a job.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Limits {
    /// Longest time (s).
    pub time_s: f64,
    /// Largest memory (bytes).
    pub memory_bytes: u64,
}

impl Default for Limits {
    fn default() -> Self {
        Self {
            time_s: DEFAULT_TIME,
            memory_bytes: DEFAULT_MEMORY,
        }
    }
}

/// Reads a limit of time (s), as in "10min".
pub(crate) fn time_of(text: &str) -> Result<f64, String> {
    let remedy = "give a time from 100ms to 43200min, as in 10min";
    let seconds = text
        .parse::<Duration>()
        .map_err(|error| error.to_string())?;
    let seconds = seconds.as_seconds();
    match (MIN_TIME..=MAX_TIME).contains(&seconds) {
        true => Ok(seconds),
        false => Err(format!("{text:?} is no limit of time: {remedy}")),
    }
}

/// Reads a limit of memory (bytes), as in "2GB".
pub(crate) fn memory_of(text: &str) -> Result<u64, String> {
    let refused = || format!("{text:?} is no limit of memory: give 16MB or more, as in 2GB");
    let parts = UNITS.iter().find_map(|(unit, bytes)| {
        let number: f64 = text.strip_suffix(unit)?.trim().parse().ok()?;
        Some(number * bytes)
    });
    let bytes = parts
        .filter(|bytes| bytes.is_finite())
        .ok_or_else(refused)? as u64;
    match bytes >= MIN_MEMORY {
        true => Ok(bytes),
        false => Err(refused()),
    }
}

impl Limits {
    /// The limit of memory in words.
    pub(crate) fn memory_words(self) -> String {
        let megabytes = self.memory_bytes as f64 / 1e6;
        match megabytes < 1000.0 {
            true => format!("{megabytes} MB"),
            false => format!("{} GB", megabytes / 1e3),
        }
    }

    /// Holds this process to the limit of memory from now on; beyond it, it ends. Returns whether the system can
    /// do so.
    #[cfg(target_os = "linux")]
    pub fn hold_memory(self) -> bool {
        use rustix::process::{Resource, Rlimit, setrlimit};
        let limit = Rlimit {
            current: Some(self.memory_bytes),
            maximum: Some(self.memory_bytes),
        };
        setrlimit(Resource::As, limit).is_ok()
    }

    /// Memory is without a limit on this system.
    #[cfg(not(target_os = "linux"))]
    pub fn hold_memory(self) -> bool {
        false
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limits_are_read_with_their_units() {
        assert_eq!(time_of("90s"), Ok(90.0));
        assert_eq!(time_of("2min"), Ok(120.0));
        assert_eq!(memory_of("2GB"), Ok(2_000_000_000));
        assert_eq!(memory_of("1.5 GB"), Ok(1_500_000_000));
        assert_eq!(memory_of("64MB"), Ok(64_000_000));
        for wrong in ["0s", "-1s", "1e9min", "soon", "nan s"] {
            assert!(time_of(wrong).is_err(), "{wrong}");
        }
        for wrong in ["2", "2 GiB", "1MB", "-2GB", "nanGB", "infGB"] {
            assert!(memory_of(wrong).unwrap_err().contains("2GB"), "{wrong}");
        }
        let limits = Limits {
            memory_bytes: 2_500_000_000,
            ..Limits::default()
        };
        assert_eq!(limits.memory_words(), "2.5 GB");
    }
}
