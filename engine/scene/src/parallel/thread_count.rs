//! The default number of threads; the one place that determines it.

use super::Threads;
use crate::error::SceneError;
use std::sync::atomic::{AtomicU64, Ordering};

/// The environment variable with the largest number of threads.
const VARIABLE: &str = "DWELL_THREADS";

/// Returns the cores that the affinity mask and the cgroup's quota give this process, at least one; on Linux a quota of 2.5
/// cores counts as 2. Counted once in a process, and again in a forked one.
pub fn available_cores() -> usize {
    // The process's number above, the count below: reading the quota takes longer than a small picture.
    static COUNTED: AtomicU64 = AtomicU64::new(0);
    let process = u64::from(std::process::id()) << 32;
    let counted = COUNTED.load(Ordering::Relaxed);
    if counted & !u64::from(u32::MAX) == process && counted as u32 > 0 {
        return counted as u32 as usize;
    }
    let cores = std::thread::available_parallelism().map_or(1, std::num::NonZero::get);
    COUNTED.store(process | cores as u64, Ordering::Relaxed);
    cores
}

/// Returns the hardware threads of the machine, whoever may use them; `None` where unknown.
pub fn hardware_threads() -> Option<usize> {
    let text = std::fs::read_to_string("/proc/cpuinfo").ok()?;
    let count = text
        .lines()
        .filter(|line| line.starts_with("processor"))
        .count();
    (count > 0).then_some(count)
}

/// Returns the value of `DWELL_THREADS`; `None` where it is not set.
///
/// # Errors
/// [`SceneError::Threads`] for a value that is no number, or out of range.
pub fn threads_variable() -> Result<Option<usize>, SceneError> {
    let Some(text) = std::env::var_os(VARIABLE) else {
        return Ok(None);
    };
    let range = 1..=Threads::MAX;
    let count = text.to_str().and_then(|text| text.trim().parse().ok());
    count
        .filter(|count| range.contains(count))
        .map(Some)
        .ok_or_else(|| thread_count_error(VARIABLE, format!("{:?}", text.to_string_lossy())))
}

/// The error of an invalid number of threads.
pub(super) fn thread_count_error(at: &'static str, found: String) -> SceneError {
    SceneError::Threads {
        at,
        found,
        allowed: Threads::MAX,
    }
}

/// The number of threads when none is requested: all cores, or fewer by the variable.
pub(super) fn default_thread_count(variable: Option<usize>) -> usize {
    variable.map_or(available_cores(), |most| most.min(available_cores()))
}
