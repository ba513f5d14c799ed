//! The files of the sample `plan`.
#![no_main]

use dwell_tests::hostile::{fuzz, plant};

libfuzzer_sys::fuzz_target!(init: plant("plan"), |bytes: &[u8]| fuzz("plan", bytes));
