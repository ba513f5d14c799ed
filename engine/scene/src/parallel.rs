//! Threads: how many, and the only way the engines use them.
//!
//! A pool belongs to one process id, because threads do not survive `fork()`. Results never depend on the number of
//! threads: work is cut into pieces of constant size, and pieces are joined in order.

use crate::error::SceneError;
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

/// How many threads a call may use; at least one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Threads(usize);

impl Threads {
    /// One thread: the caller's.
    pub const ONE: Self = Self(1);

    /// The most that are ever started.
    pub const MOST: usize = 1024;

    /// Exactly `count` threads, at least one and at most [`Threads::MOST`].
    pub fn exactly(count: usize) -> Self {
        Self(count.clamp(1, Self::MOST))
    }

    /// As [`Threads::resolve`], for numbers that people give: what makes no sense is refused.
    ///
    /// # Errors
    /// [`SceneError::Threads`] for none or too many, asked for or in the variable, and for a variable that is no number.
    pub fn requested(requested: Option<usize>) -> Result<Self, SceneError> {
        let refuse = |at: &'static str, found: String| SceneError::Threads {
            at,
            found,
            allowed: Self::MOST,
        };
        let range = 1..=Self::MOST;
        if let Some(count) = requested {
            let allowed = range.contains(&count).then_some(Self(count));
            return allowed.ok_or_else(|| refuse("threads", count.to_string()));
        }
        if let Ok(text) = std::env::var("DWELL_THREADS") {
            let count = text.trim().parse().ok().filter(|n| range.contains(n));
            return count
                .map(Self)
                .ok_or_else(|| refuse("DWELL_THREADS", format!("{text:?}")));
        }
        Ok(Self::resolve(None))
    }

    /// `requested` if given, else the variable `DWELL_THREADS`, else what the affinity mask and the cgroup allow.
    pub fn resolve(requested: Option<usize>) -> Self {
        let from_environment = || {
            std::env::var("DWELL_THREADS")
                .ok()?
                .trim()
                .parse::<usize>()
                .ok()
                .filter(|n| *n > 0)
        };
        let available = || std::thread::available_parallelism().map_or(1, std::num::NonZero::get);
        Self::exactly(
            requested
                .or_else(from_environment)
                .unwrap_or_else(available),
        )
    }

    /// The number of threads.
    pub fn count(self) -> usize {
        self.0
    }

    fn pool(self) -> Option<Arc<rayon::ThreadPool>> {
        static POOLS: Mutex<BTreeMap<(u32, usize), Arc<rayon::ThreadPool>>> =
            Mutex::new(BTreeMap::new());
        let mut pools = POOLS.lock().unwrap_or_else(PoisonError::into_inner);
        let key = (std::process::id(), self.0);
        if let Some(pool) = pools.get(&key) {
            return Some(pool.clone());
        }
        // Pools of a parent process have no threads in this one; they are forgotten, never dropped or joined.
        let stale: Vec<_> = pools
            .keys()
            .filter(|(process, _)| *process != key.0)
            .copied()
            .collect();
        for old in stale {
            if let Some(pool) = pools.remove(&old) {
                std::mem::forget(pool);
            }
        }
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(self.0)
            .thread_name(|k| format!("dwell-{k}"))
            .build();
        let pool = Arc::new(pool.ok()?);
        pools.insert(key, pool.clone());
        Some(pool)
    }

    /// Calls `work` once for each item, with the item's position.
    pub fn for_each<T: Send>(self, items: &mut [T], work: impl Fn(usize, &mut T) + Sync) {
        use rayon::prelude::*;
        if self.0 > 1
            && items.len() > 1
            && let Some(pool) = self.pool()
        {
            pool.install(|| {
                items
                    .par_iter_mut()
                    .enumerate()
                    .with_max_len(1)
                    .for_each(|(k, item)| work(k, item));
            });
            return;
        }
        for (k, item) in items.iter_mut().enumerate() {
            work(k, item);
        }
    }

    /// Does both, at the same time where there are threads for it.
    pub fn both<A: Send, B: Send>(
        self,
        first: impl FnOnce() -> A + Send,
        second: impl FnOnce() -> B + Send,
    ) -> (A, B) {
        if self.0 > 1
            && let Some(pool) = self.pool()
        {
            return pool.install(|| rayon::join(first, second));
        }
        (first(), second())
    }

    /// The results of `work(0)` to `work(count - 1)`, in order.
    pub fn map<R: Send>(self, count: usize, work: impl Fn(usize) -> R + Sync) -> Vec<R> {
        use rayon::prelude::*;
        if self.0 > 1
            && count > 1
            && let Some(pool) = self.pool()
        {
            return pool.install(|| {
                (0..count)
                    .into_par_iter()
                    .with_max_len(1)
                    .map(&work)
                    .collect()
            });
        }
        (0..count).map(work).collect()
    }
}

impl Default for Threads {
    fn default() -> Self {
        Self::resolve(None)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn more_threads_than_a_machine_can_have_are_refused_and_never_started() {
        for count in [0, 1025, 100_000, usize::MAX] {
            let error = Threads::requested(Some(count)).unwrap_err().to_string();
            assert_eq!(error, format!("threads is {count}; allowed are 1 to 1024"));
            assert!((1..=Threads::MOST).contains(&Threads::exactly(count).count()));
        }
        assert_eq!(Threads::requested(Some(1024)).unwrap().count(), 1024);
    }

    #[test]
    fn results_come_in_order_for_any_number_of_threads() {
        let expected: Vec<usize> = (0..1000).map(|k| k * k).collect();
        for count in [1, 2, 7] {
            assert_eq!(Threads::exactly(count).map(1000, |k| k * k), expected);
            let mut items: Vec<usize> = (0..1000).collect();
            Threads::exactly(count).for_each(&mut items, |k, item| *item *= k);
            assert_eq!(items, expected);
        }
    }
}
