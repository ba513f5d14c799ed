//! The first file of the sample `map`.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| dwell_tests::hostile::fuzz("map", bytes));
