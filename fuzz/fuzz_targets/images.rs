//! The files of the sample `images`.
#![no_main]

use dwell_tests::hostile::{fuzz, plant};

libfuzzer_sys::fuzz_target!(init: plant("images"), |bytes: &[u8]| fuzz("images", bytes));
