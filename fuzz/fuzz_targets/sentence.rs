//! Sentences, read and said again.
#![no_main]

use dwell_tests::hostile::{fuzz, plant};

libfuzzer_sys::fuzz_target!(init: plant("sentence"), |bytes: &[u8]| fuzz("sentence", bytes));
