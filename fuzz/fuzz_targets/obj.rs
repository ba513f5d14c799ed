//! The files of the sample `obj`.
#![no_main]

use dwell_tests::hostile::{fuzz, plant};

libfuzzer_sys::fuzz_target!(init: plant("obj"), |bytes: &[u8]| fuzz("obj", bytes));
