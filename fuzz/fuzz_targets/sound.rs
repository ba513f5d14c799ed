//! Sound files.
#![no_main]

use dwell_tests::hostile::{fuzz, plant};

libfuzzer_sys::fuzz_target!(init: plant("sound"), |bytes: &[u8]| fuzz("sound", bytes));
