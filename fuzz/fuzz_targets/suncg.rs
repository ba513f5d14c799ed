//! The files of the sample `suncg`.
#![no_main]

use dwell_tests::hostile::{fuzz, plant};

libfuzzer_sys::fuzz_target!(init: plant("suncg"), |bytes: &[u8]| fuzz("suncg", bytes));
