//! The files of the sample `habitat`.
#![no_main]

use dwell_tests::hostile::{fuzz, plant};

libfuzzer_sys::fuzz_target!(init: plant("habitat"), |bytes: &[u8]| fuzz("habitat", bytes));
