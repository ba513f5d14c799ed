//! Thread pools, and waiting for them.

use crate::interrupt;
use std::collections::BTreeMap;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::{Arc, Condvar, Mutex, PoisonError};

/// Returns the pool of `count` threads of this process, started at first use.
pub(super) fn pool(count: usize) -> Option<Arc<rayon::ThreadPool>> {
    static POOLS: Mutex<BTreeMap<(u32, usize), Arc<rayon::ThreadPool>>> =
        Mutex::new(BTreeMap::new());
    let mut pools = POOLS.lock().unwrap_or_else(PoisonError::into_inner);
    let key = (std::process::id(), count);
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
        .num_threads(count)
        .thread_name(|k| format!("dwell-{k}"))
        .build();
    let pool = Arc::new(pool.ok()?);
    pools.insert(key, pool.clone());
    Some(pool)
}

/// Runs `work` on the pool. A thread whose call can be cancelled polls while it waits.
pub(super) fn install<R: Send>(pool: &rayon::ThreadPool, work: impl FnOnce() -> R + Send) -> R {
    if !interrupt::is_polling() {
        return pool.install(work);
    }
    let (mut outcome, done) = (None, OneShotEvent::default());
    pool.in_place_scope(|scope| {
        scope.spawn(|_| {
            // Unwinding is resumed below, on the waiting thread.
            outcome = Some(catch_unwind(AssertUnwindSafe(work)));
            done.raise();
        });
        while !done.wait() {
            interrupt::poll_now();
        }
    });
    match outcome {
        Some(Ok(result)) => result,
        Some(Err(panic)) => resume_unwind(panic),
        None => unreachable!("the scope ends after its only piece of work"),
    }
}

/// An event that is set once.
#[derive(Default)]
struct OneShotEvent {
    raised: Mutex<bool>,
    changed: Condvar,
}

impl OneShotEvent {
    fn raise(&self) {
        *self.raised.lock().unwrap_or_else(PoisonError::into_inner) = true;
        self.changed.notify_one();
    }

    /// Waits for some time; returns whether it is set.
    fn wait(&self) -> bool {
        let raised = self.raised.lock().unwrap_or_else(PoisonError::into_inner);
        let waited = self
            .changed
            .wait_timeout_while(raised, interrupt::INTERVAL, |raised| !*raised);
        *waited.unwrap_or_else(PoisonError::into_inner).0
    }
}
