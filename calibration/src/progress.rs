//! Progress of the work, and its cancellation.

use crate::error::CalibrationError;
use std::cell::RefCell;

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
}

/// A reporter that calls back the caller.
pub(crate) struct CallbackProgress<'a> {
    now: RefCell<(ProgressCallback<'a>, f32, String)>,
}

impl<'a> CallbackProgress<'a> {
    pub(crate) fn new(listener: ProgressCallback<'a>) -> Self {
        Self {
            now: RefCell::new((listener, 0.0, String::new())),
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
}
