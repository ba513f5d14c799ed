//! The files of the sample `urdf`.
#![no_main]

use dwell_tests::hostile::{fuzz, plant};

libfuzzer_sys::fuzz_target!(init: plant("urdf"), |bytes: &[u8]| fuzz("urdf", bytes));
