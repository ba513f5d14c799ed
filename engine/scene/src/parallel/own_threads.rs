//! Parallel loops on threads of their own, for work that others wait for.
//!
//! Who makes under a lock what many share must not wait for the pool: its threads may all wait for that lock.

use crate::interrupt;
use std::cell::Cell;
use std::panic::resume_unwind;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};
use std::thread;

thread_local! {
    static APART: Cell<bool> = const { Cell::new(false) };
    static SINGLE: Cell<bool> = const { Cell::new(false) };
}

/// Sets a flag of this thread while `work` runs.
fn with_flag<R>(flag: &'static std::thread::LocalKey<Cell<bool>>, work: impl FnOnce() -> R) -> R {
    struct Before(&'static std::thread::LocalKey<Cell<bool>>, bool);
    impl Drop for Before {
        fn drop(&mut self) {
            self.0.set(self.1);
        }
    }
    let _before = Before(flag, flag.replace(true));
    work()
}

/// Runs `work` on this thread alone where it says nothing about threads: [`Threads::default`](super::Threads::default) is one in it.
/// For what is made behind those who must not wait.
pub fn on_one_thread<R>(work: impl FnOnce() -> R) -> R {
    with_flag(&SINGLE, work)
}

/// Returns whether this thread works alone.
pub(super) fn is_single() -> bool {
    SINGLE.get()
}

/// Runs `work`; the parallel loops in it use threads of their own rather than those of the pool. For what is made under a lock.
pub fn apart_from_pool<R>(work: impl FnOnce() -> R) -> R {
    with_flag(&APART, work)
}

/// Returns whether this thread's loops keep apart from the pool.
pub(super) fn is_apart() -> bool {
    APART.get()
}

/// Returns the results of `work(0)` to `work(count - 1)`, in order, on at most so many threads: the caller's and new ones, as many as
/// the system gives.
pub(super) fn map<R: Send>(
    threads: usize,
    count: usize,
    work: impl Fn(usize) -> R + Sync,
) -> Vec<R> {
    let next = AtomicUsize::new(0);
    let run = || {
        let mut own = Vec::new();
        loop {
            let k = next.fetch_add(1, Ordering::Relaxed);
            if k >= count {
                return own;
            }
            interrupt::unwind_if_cancelled();
            own.push((k, work(k)));
        }
    };
    let token = interrupt::current_token();
    let token = token.as_ref();
    let mut results = thread::scope(|scope| {
        let mut others = Vec::new();
        for _ in 1..threads.min(count) {
            let helped = || interrupt::run_with_token(token, || apart_from_pool(run));
            let Ok(other) = thread::Builder::new().spawn_scoped(scope, helped) else {
                break;
            };
            others.push(other);
        }
        let mut results = run();
        for other in others {
            results.extend(other.join().unwrap_or_else(|panic| resume_unwind(panic)));
        }
        results
    });
    results.sort_unstable_by_key(|(k, _)| *k);
    results.into_iter().map(|(_, result)| result).collect()
}

/// Runs both, the second on a thread of its own where the system gives one.
pub(super) fn join<A: Send, B: Send>(
    first: impl FnOnce() -> A + Send,
    second: impl FnOnce() -> B + Send,
) -> (A, B) {
    let second = Mutex::new(Some(second));
    let take = || {
        let second = second.lock().unwrap_or_else(PoisonError::into_inner).take();
        second.map(|second| second())
    };
    let token = interrupt::current_token();
    let token = token.as_ref();
    thread::scope(|scope| {
        let other = thread::Builder::new().spawn_scoped(scope, || {
            interrupt::run_with_token(token, || apart_from_pool(take))
        });
        let a = first();
        let b = match other {
            Ok(other) => other.join().unwrap_or_else(|panic| resume_unwind(panic)),
            Err(_) => take(),
        };
        let b = b.expect("it is taken once: by the thread, or here where there is none");
        (a, b)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parallel::Threads;
    use std::sync::mpsc;

    /// All threads of the pool wait for a lock, and its holder's loops end nevertheless.
    #[test]
    fn loops_apart_from_the_pool_end_while_its_threads_wait() {
        let lock = Mutex::new(());
        let held = lock.lock().unwrap();
        let (arrived, arrivals) = mpsc::channel();
        thread::scope(|scope| {
            scope.spawn(|| {
                let arrived = Mutex::new(arrived);
                Threads::new(3).for_each(&mut [0, 1, 2], |_, _| {
                    arrived.lock().unwrap().send(()).unwrap();
                    drop(lock.lock().unwrap());
                });
            });
            for _ in 0..3 {
                arrivals.recv().unwrap();
            }
            let threads = Threads::new(3);
            let made = apart_from_pool(|| {
                let mut items = vec![0; 100];
                threads.for_each(&mut items, |k, item| *item = k);
                let (a, b) =
                    threads.join(|| threads.map(50, |k| k), || threads.map(50, |k| k + 50));
                (items, [a, b].concat())
            });
            let expected: Vec<usize> = (0..100).collect();
            assert_eq!(made, (expected.clone(), expected));
            drop(held);
        });
    }

    #[test]
    fn the_pool_is_used_again_afterwards_and_panics_pass_through() {
        let panicked = std::panic::catch_unwind(|| {
            apart_from_pool(|| map(4, 8, |k| assert_ne!(k, 5, "the fifth")))
        });
        assert!(panicked.is_err() && !is_apart());
        let nested = apart_from_pool(|| {
            apart_from_pool(is_apart) && is_apart() && map(2, 4, |_| is_apart()) == [true; 4]
        });
        assert!(nested && !is_apart());
    }
}
