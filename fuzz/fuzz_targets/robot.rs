//! The files of the sample `robot`.
#![no_main]

use dwell_tests::hostile::{fuzz, plant};

libfuzzer_sys::fuzz_target!(init: plant("robot"), |bytes: &[u8]| fuzz("robot", bytes));
