//! The files of the sample `dwell`.
#![no_main]

use dwell_tests::hostile::{fuzz, plant};

libfuzzer_sys::fuzz_target!(init: plant("dwell"), |bytes: &[u8]| fuzz("dwell", bytes));
