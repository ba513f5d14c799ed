//! Measured heads: SOFA files.
#![no_main]

use dwell_tests::hostile::{fuzz, plant};

libfuzzer_sys::fuzz_target!(init: plant("head"), |bytes: &[u8]| fuzz("head", bytes));
