//! The first file of the sample `plan`.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| dwell_tests::hostile::fuzz("plan", bytes));
