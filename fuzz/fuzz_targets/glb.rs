//! The files of the sample `glb`.
#![no_main]

use dwell_tests::hostile::{fuzz, plant};

libfuzzer_sys::fuzz_target!(init: plant("glb"), |bytes: &[u8]| fuzz("glb", bytes));
