//! The first file of the sample `images`.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| dwell_tests::hostile::fuzz("images", bytes));
