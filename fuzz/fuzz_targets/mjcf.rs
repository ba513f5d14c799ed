//! The files of the sample `mjcf`.
#![no_main]

use dwell_tests::hostile::{fuzz, plant};

libfuzzer_sys::fuzz_target!(init: plant("mjcf"), |bytes: &[u8]| fuzz("mjcf", bytes));
