//! The files of the sample `map`.
#![no_main]

use dwell_tests::hostile::{fuzz, plant};

libfuzzer_sys::fuzz_target!(init: plant("map"), |bytes: &[u8]| fuzz("map", bytes));
