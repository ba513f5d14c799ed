//! Dropping the values of a stopped call without making its caller wait.

use std::ops::{Deref, DerefMut};

/// A vector whose items are dropped on a thread of their own when the stack unwinds: thousands of worlds take seconds, and Ctrl-C
/// should wait for none of them.
#[derive(Debug)]
pub(super) struct DropOnThread<T: Send + 'static>(pub(super) Vec<T>);

impl<T: Send + 'static> Drop for DropOnThread<T> {
    fn drop(&mut self) {
        if std::thread::panicking() {
            let items = std::mem::take(&mut self.0);
            // If no thread can be started they are dropped here: late, but dropped.
            drop(std::thread::Builder::new().spawn(move || drop(items)));
        }
    }
}

impl<T: Send + 'static> Deref for DropOnThread<T> {
    type Target = Vec<T>;
    fn deref(&self) -> &Vec<T> {
        &self.0
    }
}

impl<T: Send + 'static> DerefMut for DropOnThread<T> {
    fn deref_mut(&mut self) -> &mut Vec<T> {
        &mut self.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use dwell_scene::interrupt;
    use std::sync::mpsc;
    use std::thread::ThreadId;
    use std::time::Duration;

    /// Says on which thread it is dropped, and not before it may.
    struct Slow(mpsc::Sender<ThreadId>, mpsc::Receiver<()>);

    impl Drop for Slow {
        fn drop(&mut self) {
            let _ = self.1.recv_timeout(Duration::from_mins(1));
            let _ = self.0.send(std::thread::current().id());
        }
    }

    #[test]
    fn who_stops_a_call_does_not_wait_for_what_it_made() {
        let (told, dropped) = mpsc::channel();
        let (go, may) = mpsc::channel();
        let stopped = interrupt::interruptible(
            || true,
            || {
                let _items = DropOnThread(vec![Slow(told, may)]);
                std::thread::sleep(interrupt::INTERVAL);
                interrupt::unwind_if_cancelled();
            },
        );
        assert!(stopped.is_err());
        assert!(dropped.try_recv().is_err());
        go.send(()).unwrap();
        let thread = dropped.recv().unwrap();
        assert_ne!(thread, std::thread::current().id());
    }

    #[test]
    fn what_is_done_is_dropped_here() {
        let (told, dropped) = mpsc::channel();
        let (go, may) = mpsc::channel();
        go.send(()).unwrap();
        drop(DropOnThread(vec![Slow(told, may)]));
        assert_eq!(dropped.try_recv(), Ok(std::thread::current().id()));
    }
}
