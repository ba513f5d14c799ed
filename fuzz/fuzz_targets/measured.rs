//! The files of the sample `measured`.
#![no_main]

use dwell_tests::hostile::{fuzz, plant};

libfuzzer_sys::fuzz_target!(init: plant("measured"), |bytes: &[u8]| fuzz("measured", bytes));
