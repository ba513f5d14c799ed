//! The first file of the sample `suncg`.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| dwell_tests::hostile::fuzz("suncg", bytes));
