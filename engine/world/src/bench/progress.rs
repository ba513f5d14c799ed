//! Progress of a bench.

use crate::error::WorldError;

/// A callback with a fraction (0 to 1) and what is measured next, which answers whether to go on.
pub type BenchCallback<'a> = &'a mut dyn FnMut(f64, &str) -> bool;

/// Counts the parts of a bench, between which nothing is timed, and tells a listener.
pub(super) struct BenchProgress<'a> {
    listener: BenchCallback<'a>,
    parts: usize,
    done: usize,
}

impl<'a> BenchProgress<'a> {
    pub(super) fn new(listener: BenchCallback<'a>) -> Self {
        Self {
            listener,
            parts: 1,
            done: 0,
        }
    }

    /// Sets the number of parts.
    pub(super) fn set_part_count(&mut self, parts: usize) {
        self.parts = parts.max(1);
    }

    /// Begins the next part.
    ///
    /// # Errors
    /// [`WorldError::Cancelled`] where the listener does not want to go on.
    pub(super) fn begin_part(&mut self, what: &str) -> Result<(), WorldError> {
        let fraction = self.done as f64 / self.parts as f64;
        self.done += 1;
        self.tell(fraction.min(1.0), what)
    }

    /// Reports that all is measured.
    ///
    /// # Errors
    /// As [`Self::begin_part`].
    pub(super) fn end(&mut self) -> Result<(), WorldError> {
        self.tell(1.0, "done")
    }

    fn tell(&mut self, fraction: f64, what: &str) -> Result<(), WorldError> {
        if (self.listener)(fraction, what) {
            Ok(())
        } else {
            Err(WorldError::Cancelled)
        }
    }
}
