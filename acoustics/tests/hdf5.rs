//! HDF5 files, valid and damaged. Both samples were written by h5py: with the oldest forms of the format that hold them,
//! and with the newest. `python/tests/test_hdf5.py` compares many more with h5py itself.

use dwell_acoustics::hdf5::Hdf5;
use stats_alloc::{INSTRUMENTED_SYSTEM, StatsAlloc};
use std::alloc::System;
use std::hint::black_box;
use std::sync::{Mutex, PoisonError};

#[global_allocator]
static HEAP: &StatsAlloc<System> = &INSTRUMENTED_SYSTEM;

/// One test at a time counts.
static ALONE: Mutex<()> = Mutex::new(());

/// Most memory that queries of a damaged file of 15 KB may allocate, bytes, counting memory that is freed in between as well.
const MOST_BYTES: usize = 100 << 20;

const SAMPLES: [(&str, &[u8]); 2] = [
    ("earliest.sofa", include_bytes!("data/earliest.sofa")),
    ("latest.sofa", include_bytes!("data/latest.sofa")),
];
const VARIABLES: [&str; 6] = [
    "SourcePosition",
    "ReceiverPosition",
    "Data.IR",
    "Data.SamplingRate",
    "Data.Delay",
    "ListenerView",
];

/// Queries everything that a head is made of; returns the number of successful queries.
fn ask(bytes: Vec<u8>) -> usize {
    let Ok(file) = Hdf5::open(bytes) else {
        return 0;
    };
    let texts = [
        file.attribute_text(None, "SOFAConventions"),
        file.attribute_text(Some("SourcePosition"), "Type"),
        file.attribute_text(Some("SourcePosition"), "Units"),
    ];
    let mut answered = texts.iter().filter(|text| text.is_ok()).count();
    for name in VARIABLES {
        answered += usize::from(black_box(file.shape(name)).is_ok());
        match black_box(file.numbers(name)) {
            Ok(numbers) => {
                assert_eq!(
                    numbers.shape.iter().product::<usize>(),
                    numbers.values.len()
                );
                answered += 1;
            }
            Err(error) => assert!(!error.to_string().is_empty()),
        }
    }
    answered
}

#[test]
fn old_and_new_files_hold_the_same() {
    for (name, bytes) in SAMPLES {
        let file = Hdf5::open(bytes.to_vec()).unwrap();
        let text = |of, what| file.attribute_text(of, what).unwrap();
        let convention = text(None, "SOFAConventions");
        assert_eq!(convention.as_deref(), Some("SimpleFreeFieldHRIR"), "{name}");
        assert_eq!(text(None, "RoomType"), None);
        let units = text(Some("SourcePosition"), "Units");
        assert_eq!(units.as_deref(), Some("degree, degree, metre"));
        assert_eq!(file.shape("Data.IR").unwrap(), Some(vec![6, 2, 16]));
        assert_eq!(file.shape("EmitterPosition").unwrap(), None);
        let responses = file.numbers("Data.IR").unwrap();
        assert_eq!(responses.shape, [6, 2, 16]);
        let ends = [responses.values[0], *responses.values.last().unwrap()];
        assert_eq!(ends, [0.35_f32, 1.23].map(f64::from));
        let places = file.numbers("SourcePosition").unwrap();
        assert_eq!(places.values[..4], [41.0, 33.0, 88.0, 42.0]);
        assert_eq!(*places.values.last().unwrap(), 77.0);
        assert_eq!(
            file.numbers("ListenerView").unwrap().values,
            [1.0, 0.0, 0.0]
        );
        assert_eq!(
            file.numbers("Data.SamplingRate").unwrap().values,
            [44_100.0]
        );
        let missing = file.numbers("Emitter").unwrap_err().to_string();
        assert_eq!(missing, "Emitter: missing");
    }
}

/// Every bit of every byte that is not 0, and of every seventh that is.
#[test]
#[ignore = "long: make test runs one of eight shares of these, make test-all all"]
fn every_flipped_bit_ends_in_an_answer_or_an_error() {
    let _alone = ALONE.lock().unwrap_or_else(PoisonError::into_inner);
    let mut refused = 0;
    for (name, bytes) in SAMPLES {
        let whole = ask(bytes.to_vec());
        assert_eq!(whole, 15, "{name}");
        for at in (0..bytes.len()).filter(|at| bytes[*at] != 0 || at % 7 == 0) {
            for bit in 0..8 {
                let mut flipped = bytes.to_vec();
                flipped[at] ^= 1 << bit;
                let before = HEAP.stats().bytes_allocated;
                let answered = ask(flipped);
                let taken = HEAP.stats().bytes_allocated - before;
                assert!(
                    taken < MOST_BYTES,
                    "{name}: byte {at}, bit {bit}: {taken} bytes"
                );
                refused += usize::from(answered < whole);
            }
        }
    }
    assert!(refused > 3000, "{refused}");
}

#[test]
fn files_that_are_cut_end_in_an_error() {
    for (name, bytes) in SAMPLES {
        for length in (0..bytes.len() - 4).step_by(61) {
            assert!(
                ask(bytes[..length].to_vec()) < 15,
                "{name} cut at {length} bytes"
            );
        }
        // Bytes of the user's may stand before the file.
        let mut shifted = vec![b'x'; 512];
        shifted.extend_from_slice(bytes);
        assert_eq!(ask(shifted), 15, "{name}");
    }
    let told = Hdf5::open(b"no HDF5".to_vec()).unwrap_err().to_string();
    assert!(told.starts_with("no HDF5"), "{told}");
}
