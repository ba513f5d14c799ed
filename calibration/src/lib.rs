//! Measured data against the simulation: residuals, causes, extensions, gain.
