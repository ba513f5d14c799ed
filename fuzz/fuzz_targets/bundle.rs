//! A bundle of measurements.
#![no_main]

use dwell_tests::hostile::{fuzz, plant};

libfuzzer_sys::fuzz_target!(init: plant("bundle"), |bytes: &[u8]| fuzz("bundle", bytes));
