//! Cancellation of long calls.
//!
//! Long loops call [`unwind_if_cancelled`] between pieces of at most some 20 ms; `parallel` does so between all pieces that it hands out.
//! A caller wraps a cancellable call in [`interruptible`], with a function that is polled every [`INTERVAL`] on the calling
//! thread. When it returns true, `unwind_if_cancelled` unwinds the stack, of pool threads too, with [`Interrupted`], and `interruptible`
//! returns it. That is no panic: no hook sees it. (salsa cancels its queries in the same way.)
//!
//! Code that must not stop half-way runs in [`uninterruptible`], where polling goes on; code that holds a lock or half a result
//! meanwhile uses [`catch_interrupt`]. The initializer of a `LazyLock` must not meet it: interrupted once, it is poisoned for
//! good. A `OnceLock` stays empty, and is filled the next time.

use std::cell::RefCell;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// Polling interval of the caller's function.
pub const INTERVAL: Duration = Duration::from_millis(25);

/// The payload that unwinds when a call is cancelled.
#[derive(Debug, PartialEq, Eq, thiserror::Error)]
#[error("the call was stopped")]
pub struct Interrupted(());

impl Interrupted {
    /// Resumes unwinding towards the caller that requested the stop.
    pub fn resume_unwind(self) -> ! {
        resume_unwind(Box::new(self))
    }
}

/// Set when a call is to stop. Shared with all threads that work for it.
pub(crate) type CancelToken = Arc<AtomicBool>;

/// The function that is polled, the next time for it, and the token that is set when it returns true.
#[derive(Clone, Debug)]
struct PollSchedule {
    ask: fn() -> bool,
    next: Instant,
    token: CancelToken,
}

thread_local! {
    /// That of the call that this thread works for; none: the call cannot be cancelled.
    static TOKEN: RefCell<Option<CancelToken>> = const { RefCell::new(None) };
    /// Set only on the calling thread.
    static POLL: RefCell<Option<PollSchedule>> = const { RefCell::new(None) };
}

/// Restores the previous values, also when the stack unwinds.
struct ScopeGuard {
    token: Option<CancelToken>,
    ask: Option<PollSchedule>,
}

impl ScopeGuard {
    fn set_and_guard(token: Option<CancelToken>, ask: Option<PollSchedule>) -> Self {
        Self {
            token: TOKEN.replace(token),
            ask: POLL.replace(ask),
        }
    }
}

impl Drop for ScopeGuard {
    fn drop(&mut self) {
        TOKEN.set(self.token.take());
        POLL.set(self.ask.take());
    }
}

/// Runs `work`; cancels it soon after `ask` has returned true. `ask` is called on this thread only, in the middle of
/// `work`: it must not call engines, whose locks `work` may hold.
///
/// # Errors
/// [`Interrupted`] when the work was cancelled. Work that ends before it meets a [`unwind_if_cancelled`] is done, whatever `ask` returned.
pub fn interruptible<R>(ask: fn() -> bool, work: impl FnOnce() -> R) -> Result<R, Interrupted> {
    let token = Arc::new(AtomicBool::new(false));
    let schedule = PollSchedule {
        ask,
        next: Instant::now() + INTERVAL,
        token: token.clone(),
    };
    let _restore = ScopeGuard::set_and_guard(Some(token), Some(schedule));
    catch_interrupt(work)
}

/// Runs `work`, and catches the unwinding of a cancellation. Panics pass.
///
/// # Errors
/// [`Interrupted`] when the work was cancelled; pass it on by [`Interrupted::resume_unwind`] or as an error.
pub fn catch_interrupt<R>(work: impl FnOnce() -> R) -> Result<R, Interrupted> {
    // Panics pass, and repairing interrupted data is up to the caller: that is the purpose of `catch_interrupt`.
    catch_unwind(AssertUnwindSafe(work)).map_err(|cause| match cause.downcast::<Interrupted>() {
        Ok(interrupted) => *interrupted,
        Err(panic) => resume_unwind(panic),
    })
}

/// Runs `work` to its end: it is not cancelled. Polling goes on, and a cancellation meanwhile stops the call at its next [`unwind_if_cancelled`]
/// after this work.
pub fn uninterruptible<R>(work: impl FnOnce() -> R) -> R {
    let _restore = ScopeGuard::set_and_guard(None, schedule());
    work()
}

/// Unwinds here when the call is to stop. Costs some nanoseconds; meant for loops whose turns take a millisecond or so.
pub fn unwind_if_cancelled() {
    if POLL.with_borrow(|poll| poll.as_ref().is_some_and(PollSchedule::is_due)) {
        poll_now();
    }
    if TOKEN.with_borrow(|token| token.as_ref().is_some_and(is_set)) {
        Interrupted(()).resume_unwind();
    }
}

/// Calls [`unwind_if_cancelled`] once in a number of turns: for loops whose turns are hardly longer than a check.
#[derive(Debug)]
pub struct CancelPoller {
    every: usize,
    left: usize,
}

impl CancelPoller {
    /// Checks at the first turn, and again after `every` turns, at least one.
    pub fn new(every: usize) -> Self {
        Self { every, left: 0 }
    }

    /// Counts one turn.
    #[inline]
    pub fn count_one(&mut self) {
        self.count_many(1);
    }

    /// Counts several turns at once: those of an inner loop.
    #[inline]
    pub fn count_many(&mut self, count: usize) {
        if self.left < count.max(1) {
            self.left = self.every;
            unwind_if_cancelled();
        }
        self.left = self.left.saturating_sub(count);
    }
}

fn is_set(token: &CancelToken) -> bool {
    token.load(Ordering::Relaxed)
}

impl PollSchedule {
    fn is_due(&self) -> bool {
        Instant::now() >= self.next
    }
}

fn schedule() -> Option<PollSchedule> {
    POLL.with_borrow(Clone::clone)
}

/// Returns whether this thread polls.
pub(crate) fn is_polling() -> bool {
    POLL.with_borrow(Option::is_some)
}

/// Polls, and stores the result for all threads of the call.
pub(crate) fn poll_now() {
    let Some(PollSchedule { ask, token, .. }) = schedule() else {
        return;
    };
    if ask() {
        token.store(true, Ordering::Relaxed);
    }
    let next = Instant::now() + INTERVAL;
    POLL.set(Some(PollSchedule { ask, next, token }));
}

/// Returns the token of the call that this thread works for.
pub(crate) fn current_token() -> Option<CancelToken> {
    TOKEN.with_borrow(Clone::clone)
}

/// Runs a piece of the work of the call that `token` belongs to, on any thread.
pub(crate) fn run_with_token<R>(token: Option<&CancelToken>, work: impl FnOnce() -> R) -> R {
    // The calling thread polls, too, when it has pieces to do itself.
    let _restore = ScopeGuard::set_and_guard(token.cloned(), schedule());
    unwind_if_cancelled();
    work()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parallel::Threads;
    use std::sync::atomic::AtomicUsize;

    fn yes() -> bool {
        true
    }

    fn no() -> bool {
        false
    }

    /// Turns of a millisecond each.
    fn spin(turns: usize) -> usize {
        for _ in 0..turns {
            unwind_if_cancelled();
            std::thread::sleep(Duration::from_millis(1));
        }
        turns
    }

    #[test]
    fn a_loop_stops_when_its_caller_wants_it_to() {
        let start = Instant::now();
        assert_eq!(interruptible(yes, || spin(100_000)), Err(Interrupted(())));
        assert!(start.elapsed() >= INTERVAL);
        assert_eq!(interruptible(no, || spin(40)), Ok(40));
        unwind_if_cancelled();
    }

    #[test]
    #[ignore = "long: make test runs one of eight shares of these, make test-all all"]
    fn pieces_on_other_threads_stop_too_and_those_of_others_do_not() {
        for threads in [1, 2, 7] {
            let done = AtomicUsize::new(0);
            let count = 100_000;
            let stopped = interruptible(yes, || {
                Threads::new(threads).map(count, |_| {
                    std::thread::sleep(Duration::from_millis(1));
                    done.fetch_add(1, Ordering::Relaxed)
                })
            });
            assert!(stopped.is_err());
            let done = done.into_inner();
            assert!(done > 0 && done < count, "{done}");
            assert_eq!(Threads::new(threads).map(3, |k| k), [0, 1, 2]);
        }
    }

    #[test]
    fn what_must_be_whole_is_whole() {
        let mut turns = 0;
        let stopped = interruptible(yes, || {
            turns = uninterruptible(|| spin(60) + Threads::new(2).map(60, |_| spin(1)).len());
            spin(100_000)
        });
        assert!(stopped.is_err());
        assert_eq!(turns, 120);
    }

    #[test]
    fn who_called_is_asked_in_the_middle_of_what_must_be_whole() {
        static ASKED: AtomicUsize = AtomicUsize::new(0);
        fn yes() -> bool {
            ASKED.fetch_add(1, Ordering::Relaxed);
            true
        }
        let (mut alone, mut shared) = (0, 0);
        let stopped = interruptible(yes, || {
            uninterruptible(|| {
                spin(60);
                alone = ASKED.load(Ordering::Relaxed);
                Threads::new(2).map(60, |_| spin(1));
                shared = ASKED.load(Ordering::Relaxed);
            });
            // Not once the work was done: the answer is known.
            unwind_if_cancelled();
        });
        assert_eq!(stopped, Err(Interrupted(())));
        assert!(alone > 0 && shared > alone, "{alone} {shared}");
    }

    #[test]
    fn a_pace_looks_at_once_and_then_every_so_often() {
        static ASKED: AtomicUsize = AtomicUsize::new(0);
        fn note() -> bool {
            ASKED.fetch_add(1, Ordering::Relaxed);
            false
        }
        let looks = |turns: &[usize]| {
            ASKED.store(0, Ordering::Relaxed);
            let mut pace = CancelPoller::new(10);
            for count in turns {
                // Every look is one that asks.
                POLL.set(Some(PollSchedule {
                    ask: note,
                    next: Instant::now(),
                    token: CancelToken::default(),
                }));
                pace.count_many(*count);
            }
            POLL.set(None);
            ASKED.load(Ordering::Relaxed)
        };
        assert_eq!([looks(&[1]), looks(&[1; 10]), looks(&[1; 11])], [1, 1, 2]);
        assert_eq!([looks(&[6; 4]), looks(&[25; 3]), looks(&[0; 5])], [4, 3, 1]);
    }

    #[test]
    fn half_work_can_be_mended_on_the_way() {
        let mut mended = false;
        let stopped = interruptible(yes, || {
            catch_interrupt(|| spin(100_000)).unwrap_or_else(|interrupted| {
                mended = true;
                interrupted.resume_unwind()
            })
        });
        assert!(stopped.is_err() && mended);
    }

    #[test]
    fn a_panic_is_no_interruption() {
        let panicked = catch_unwind(|| interruptible(no, || panic!("on purpose")));
        assert!(panicked.is_err());
        assert!(!is_polling() && current_token().is_none());
    }
}
