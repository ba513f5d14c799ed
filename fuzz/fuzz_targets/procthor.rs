//! The first file of the sample `procthor`.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| dwell_tests::hostile::fuzz("procthor", bytes));
