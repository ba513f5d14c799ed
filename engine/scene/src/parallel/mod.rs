//! Thread pools: their size, and the parallel loops of all engines.
//!
//! A pool belongs to one process id, because threads do not survive `fork()`. Results never depend on the number of
//! threads: work is cut into pieces of constant size, and pieces are joined in order.

mod own_threads;
mod pool;
mod thread_count;

use crate::error::SceneError;
use crate::interrupt;
pub use own_threads::{apart_from_pool, on_one_thread};
use std::sync::{Mutex, PoisonError};
pub use thread_count::{available_cores, hardware_threads, threads_variable};

/// The number of threads that a call may use; at least one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Threads(usize);

impl Threads {
    /// One thread: the caller's.
    pub const ONE: Self = Self(1);

    /// The largest number of threads.
    pub const MAX: usize = 1024;

    /// Exactly `thread_count` threads, at least one and at most [`Threads::MAX`].
    pub fn new(count: usize) -> Self {
        Self(count.clamp(1, Self::MAX))
    }

    /// As [`Threads::resolve`], for numbers from users: invalid ones are refused.
    ///
    /// # Errors
    /// [`SceneError::Threads`] for zero or too many, requested or in the variable, and for a variable that is no number.
    pub fn try_resolve(requested: Option<usize>) -> Result<Self, SceneError> {
        match requested {
            Some(count) if (1..=Self::MAX).contains(&count) => Ok(Self(count)),
            Some(count) => Err(thread_count::thread_count_error(
                "threads",
                count.to_string(),
            )),
            None if own_threads::is_single() => Ok(Self::ONE),
            None => Ok(Self::new(thread_count::default_thread_count(
                threads_variable()?,
            ))),
        }
    }

    /// `requested` if given, else all [`available_cores`], but no more than the variable `DWELL_THREADS` allows. An invalid
    /// variable is ignored.
    pub fn resolve(requested: Option<usize>) -> Self {
        Self::new(requested.unwrap_or_else(|| {
            if own_threads::is_single() {
                return 1;
            }
            thread_count::default_thread_count(threads_variable().ok().flatten())
        }))
    }

    /// The number of threads.
    pub fn count(self) -> usize {
        self.0
    }

    /// Returns the pool, for more than one thread.
    fn pool(self) -> Option<std::sync::Arc<rayon::ThreadPool>> {
        (self.0 > 1).then(|| pool::pool(self.0)).flatten()
    }

    /// Calls `work` once for each item, with the item's position. Can be cancelled between items: see [`interrupt`].
    pub fn for_each<T: Send>(self, items: &mut [T], work: impl Fn(usize, &mut T) + Sync) {
        use rayon::prelude::*;
        if items.len() > 1 && self.0 > 1 && own_threads::is_apart() {
            let slots: Vec<Mutex<&mut T>> = items.iter_mut().map(Mutex::new).collect();
            own_threads::map(self.0, slots.len(), |k| {
                let mut item = slots[k].lock().unwrap_or_else(PoisonError::into_inner);
                work(k, &mut item);
            });
            return;
        }
        if items.len() > 1
            && let Some(pool) = self.pool()
        {
            let token = interrupt::current_token();
            pool::install(&pool, || {
                items
                    .par_iter_mut()
                    .enumerate()
                    .with_max_len(1)
                    .for_each(|(k, item)| {
                        interrupt::run_with_token(token.as_ref(), || work(k, item));
                    });
            });
            return;
        }
        for (k, item) in items.iter_mut().enumerate() {
            interrupt::unwind_if_cancelled();
            work(k, item);
        }
    }

    /// Runs both, at the same time where there are threads for it.
    pub fn join<A: Send, B: Send>(
        self,
        first: impl FnOnce() -> A + Send,
        second: impl FnOnce() -> B + Send,
    ) -> (A, B) {
        if self.0 > 1 && own_threads::is_apart() {
            return own_threads::join(first, second);
        }
        if let Some(pool) = self.pool() {
            let token = interrupt::current_token();
            let token = token.as_ref();
            return pool::install(&pool, || {
                rayon::join(
                    || interrupt::run_with_token(token, first),
                    || interrupt::run_with_token(token, second),
                )
            });
        }
        (first(), second())
    }

    /// Returns the results of `work(0)` to `work(thread_count - 1)`, in order. Can be cancelled between them: see [`interrupt`].
    pub fn map<R: Send>(self, count: usize, work: impl Fn(usize) -> R + Sync) -> Vec<R> {
        use rayon::prelude::*;
        if count > 1 && self.0 > 1 && own_threads::is_apart() {
            return own_threads::map(self.0, count, work);
        }
        if count > 1
            && let Some(pool) = self.pool()
        {
            let token = interrupt::current_token();
            return pool::install(&pool, || {
                (0..count)
                    .into_par_iter()
                    .with_max_len(1)
                    .map(|k| interrupt::run_with_token(token.as_ref(), || work(k)))
                    .collect()
            });
        }
        let work = |k| {
            interrupt::unwind_if_cancelled();
            work(k)
        };
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
            let error = Threads::try_resolve(Some(count)).unwrap_err().to_string();
            assert_eq!(error, format!("threads is {count}; allowed are 1 to 1024"));
            assert!((1..=Threads::MAX).contains(&Threads::new(count).count()));
        }
        assert_eq!(Threads::try_resolve(Some(1024)).unwrap().count(), 1024);
    }

    #[test]
    fn who_works_alone_has_one_thread_until_it_is_done() {
        let before = Threads::default();
        on_one_thread(|| {
            assert_eq!(Threads::default(), Threads::ONE);
            assert_eq!(Threads::try_resolve(None).unwrap(), Threads::ONE);
            assert_eq!(Threads::resolve(Some(3)).count(), 3);
        });
        assert_eq!(Threads::default(), before);
    }

    #[test]
    fn results_come_in_order_for_any_number_of_threads() {
        let expected: Vec<usize> = (0..1000).map(|k| k * k).collect();
        for count in [1, 2, 7] {
            assert_eq!(Threads::new(count).map(1000, |k| k * k), expected);
            let mut items: Vec<usize> = (0..1000).collect();
            Threads::new(count).for_each(&mut items, |k, item| *item *= k);
            assert_eq!(items, expected);
        }
    }
}
