//! Progress of the work, and its cancellation.

use crate::error::CalibrationError;
use std::cell::RefCell;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// Ends a search early, from another thread or from within its progress callback. Copies share the signal.
#[derive(Clone, Debug, Default)]
pub struct StopSignal(Arc<AtomicBool>);

impl StopSignal {
    /// Asks the search to end with what it has.
    pub fn raise(&self) {
        self.0.store(true, Ordering::Relaxed);
    }

    /// Returns whether it was raised.
    pub fn is_raised(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}

impl PartialEq for StopSignal {
    fn eq(&self, other: &Self) -> bool {
        self.is_raised() == other.is_raised()
    }
}

/// When a search ends at the latest.
#[derive(Clone, Debug, Default)]
pub(crate) struct Deadline {
    end: Option<Instant>,
    stop: StopSignal,
}

impl Deadline {
    /// So many seconds from now, or when the signal is raised.
    pub(crate) fn after(budget_s: Option<f64>, stop: &StopSignal) -> Self {
        let budget = budget_s.map(Duration::from_secs_f64);
        Self {
            end: budget.and_then(|budget| Instant::now().checked_add(budget)),
            stop: stop.clone(),
        }
    }

    /// Returns whether it is over.
    pub(crate) fn is_over(&self) -> bool {
        self.stop.is_raised() || self.end.is_some_and(|end| Instant::now() >= end)
    }
}

/// Takes a fraction and a sentence, and answers whether to go on.
type ProgressCallback<'a> = &'a mut dyn FnMut(f32, &str) -> bool;

/// Tells the caller how far the work is. A trait, so that what works need not name the caller's lifetime.
pub(crate) trait ProgressReporter {
    /// Reports a new stage.
    ///
    /// # Errors
    /// [`CalibrationError::Interrupted`] when the caller wants to stop.
    fn stage(&self, fraction: f32, what: &str) -> Result<(), CalibrationError>;

    /// Asks whether to go on.
    ///
    /// # Errors
    /// [`CalibrationError::Interrupted`] when the caller wants to stop.
    fn check(&self) -> Result<(), CalibrationError>;

    /// When the work ends with what it has.
    fn deadline(&self) -> &Deadline;
}

/// A reporter that calls back the caller.
pub(crate) struct CallbackProgress<'a> {
    now: RefCell<(ProgressCallback<'a>, f32, String)>,
    deadline: Deadline,
}

impl<'a> CallbackProgress<'a> {
    pub(crate) fn new(listener: ProgressCallback<'a>) -> Self {
        Self::with_deadline(listener, Deadline::default())
    }

    pub(crate) fn with_deadline(listener: ProgressCallback<'a>, deadline: Deadline) -> Self {
        Self {
            now: RefCell::new((listener, 0.0, String::new())),
            deadline,
        }
    }
}

impl ProgressReporter for CallbackProgress<'_> {
    fn stage(&self, fraction: f32, what: &str) -> Result<(), CalibrationError> {
        {
            let mut now = self.now.borrow_mut();
            now.1 = fraction;
            what.clone_into(&mut now.2);
        }
        self.check()
    }

    fn check(&self) -> Result<(), CalibrationError> {
        let (listener, fraction, what) = &mut *self.now.borrow_mut();
        if listener(*fraction, what) {
            Ok(())
        } else {
            Err(CalibrationError::Interrupted)
        }
    }

    fn deadline(&self) -> &Deadline {
        &self.deadline
    }
}

#[cfg(test)]
mod tests {
    use crate::{CalibrationOptions, CalibrationVerdict, calibrate};

    /// A search that is ended early says so, names nothing and installs nothing.
    #[test]
    fn a_search_that_is_ended_keeps_what_it_has_and_names_nothing() {
        let folder = tempfile::tempdir().unwrap();
        crate::example::write(folder.path(), 1).unwrap();
        let none = CalibrationOptions {
            budget_s: Some(0.0),
            ..CalibrationOptions::default()
        };
        let at_once = calibrate(folder.path(), &none, &mut |_, _| true).unwrap();
        let stopped = CalibrationOptions::default();
        let stop = stopped.stop.clone();
        let later = calibrate(folder.path(), &stopped, &mut |_, what| {
            // The second cause is not tried any more.
            if what.starts_with("trying") {
                stop.raise();
            }
            true
        });
        let later = later.unwrap();
        for report in [&at_once, &later] {
            assert!(!report.finished, "{}", report.sentence);
            assert!(
                matches!(report.verdict, CalibrationVerdict::Unexplained { .. }),
                "{}",
                report.sentence
            );
            assert!(report.found.laws.is_empty() && report.found.intervals.is_empty());
        }
        let tried = |report: &crate::CalibrationReport| {
            let candidates = report.candidates.iter();
            candidates.filter(|cause| cause.gain.is_some()).count()
        };
        assert_eq!((tried(&at_once), tried(&later)), (0, 1));
        assert!(
            at_once.sentence.contains("budget of 0 s"),
            "{}",
            at_once.sentence
        );
        assert!(
            later.sentence.contains("ended by its user"),
            "{}",
            later.sentence
        );
    }
}
