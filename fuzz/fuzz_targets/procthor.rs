//! The files of the sample `procthor`.
#![no_main]

use dwell_tests::hostile::{fuzz, plant};

libfuzzer_sys::fuzz_target!(init: plant("procthor"), |bytes: &[u8]| fuzz("procthor", bytes));
