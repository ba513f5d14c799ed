//! Compression of snapshots: Brotli (RFC 7932).
//!
//! Repetitions in a snapshot, such as the same place in a body and in its contacts, lie further apart than the 32 KiB
//! window of zlib.

use crate::error::SceneError;
use crate::interrupt;
use brotli::enc::{BrotliEncoderParams, StandardAlloc};
use brotli::{IoReaderWrapper, IoWriterWrapper};
use std::io::{Cursor, Read};
use std::sync::{Arc, Weak, mpsc};
use std::thread;

/// Quality level (0 to 11). 5 is the first that looks for matches well; 9 takes twice as long for a hundredth less.
const QUALITY: i32 = 5;
/// The first level that weighs encodings against one another: a tenth less, in some fifty times the time.
const BEST_QUALITY: i32 = 10;
/// Window size as a power of two: 4 MiB.
const WINDOW: i32 = 22;
/// Largest size of unpacked data, bytes.
const MOST_UNPACKED: u64 = 1 << 30;
/// Number of bytes that are packed within some 0.1 s at the usual quality.
const QUICK: usize = 1 << 20;
/// The most bytes that are packed at the best quality: those of thousands of things would take minutes.
const MAX_HARDER: usize = 2 << 20;
const NEVER: &str = "reading and writing memory cannot fail";
/// Bytes that are unpacked at a time.
const BUFFER: usize = 1 << 16;

/// Compresses bytes; the same bytes give the same result. Parts shared with `base`, which [`unpack`] also gets, take next
/// to nothing.
///
/// # Panics
/// If the system has no room for one more thread.
pub fn pack(bytes: &[u8], base: &[u8]) -> Vec<u8> {
    if bytes.len() + base.len() > QUICK {
        return pack_stoppably(QUALITY, bytes, base);
    }
    pack_with(QUALITY, bytes, bytes.len(), base).expect(NEVER)
}

/// As [`pack`], but with a higher quality where that alone would give more than `most` bytes; it may still be more. A
/// megabyte then takes seconds, instead of a tenth of one; more than 2 MiB are packed as usual.
///
/// # Panics
/// As [`pack`].
pub fn pack_to_size(bytes: &[u8], base: &[u8], most: usize) -> Vec<u8> {
    let packed = pack(bytes, base);
    if packed.len() <= most || bytes.len() > MAX_HARDER {
        return packed;
    }
    pack_stoppably(BEST_QUALITY, bytes, base)
}

/// Packs on a thread of its own, so that the caller can be cancelled meanwhile.
fn pack_stoppably(quality: i32, bytes: &[u8], base: &[u8]) -> Vec<u8> {
    // Dropped when the caller stops waiting, which ends the thread at the next block of input.
    let wanted = Arc::new(());
    let source = CancellableReader {
        bytes: Cursor::new(bytes.to_vec()),
        wanted: Arc::downgrade(&wanted),
    };
    let (length, base) = (bytes.len(), base.to_vec());
    let (sender, receiver) = mpsc::channel();
    thread::spawn(move || {
        // Sending fails once the caller has stopped waiting.
        let _ = sender.send(pack_with(quality, source, length, &base));
    });
    loop {
        interrupt::unwind_if_cancelled();
        match receiver.recv_timeout(interrupt::INTERVAL) {
            Err(mpsc::RecvTimeoutError::Timeout) => {}
            packed => return packed.expect(NEVER).expect(NEVER),
        }
    }
}

fn pack_with(
    quality: i32,
    mut bytes: impl Read,
    length: usize,
    base: &[u8],
) -> std::io::Result<Vec<u8>> {
    let parameters = BrotliEncoderParams {
        quality,
        lgwin: WINDOW,
        size_hint: length,
        ..Default::default()
    };
    let mut packed = Vec::with_capacity(length / 2);
    let (mut from, mut to) = (vec![0; BUFFER], vec![0; BUFFER]);
    brotli::BrotliCompressCustomIoCustomDict(
        &mut IoReaderWrapper(&mut bytes),
        &mut IoWriterWrapper(&mut packed),
        &mut from,
        &mut to,
        &parameters,
        StandardAlloc::default(),
        &mut |_, _, _, _| (),
        base,
        std::io::ErrorKind::UnexpectedEof.into(),
    )?;
    Ok(packed)
}

/// A reader that fails as soon as the caller has stopped waiting.
struct CancellableReader {
    bytes: Cursor<Vec<u8>>,
    wanted: Weak<()>,
}

impl Read for CancellableReader {
    fn read(&mut self, to: &mut [u8]) -> std::io::Result<usize> {
        if self.wanted.strong_count() == 0 {
            return Err(std::io::ErrorKind::ConnectionAborted.into());
        }
        self.bytes.read(to)
    }
}

/// Returns the bytes that [`pack`] packed with the same `base`.
///
/// # Errors
/// [`SceneError::Snapshot`] for bytes that are damaged, or larger than 1 GiB unpacked.
pub fn unpack(packed: &[u8], base: &[u8]) -> Result<Vec<u8>, SceneError> {
    let refuse = |why: String| SceneError::Snapshot(format!("it cannot be unpacked: {why}"));
    let mut bytes = Vec::new();
    brotli::Decompressor::new_with_custom_dict(packed, BUFFER, base.to_vec().into())
        .take(MOST_UNPACKED + 1)
        .read_to_end(&mut bytes)
        .map_err(|error| refuse(error.to_string()))?;
    if bytes.len() as u64 > MOST_UNPACKED {
        return Err(refuse(format!("more than {MOST_UNPACKED} bytes")));
    }
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn packed_bytes_come_back_and_damage_is_refused() {
        let bytes: Vec<u8> = (0..10_000_u32).map(|k| (k * k % 251) as u8).collect();
        let packed = pack(&bytes, &[]);
        assert!(packed.len() < bytes.len() / 2);
        assert_eq!(packed, pack(&bytes, &[]));
        assert_eq!(unpack(&packed, &[]).unwrap(), bytes);
        let empty = unpack(&pack(&[], &[]), &[]).unwrap();
        assert!(empty.is_empty());
        for length in [0, 1, packed.len() / 2, packed.len() - 1] {
            let refused = unpack(&packed[..length], &[]).unwrap_err().to_string();
            assert!(refused.contains("cannot be unpacked"), "{refused}");
        }
    }

    #[test]
    fn what_would_be_too_large_is_packed_harder() {
        let mut stream = crate::random::RandomKey::root(3).stream();
        let words: Vec<[u8; 5]> = (0..400)
            .map(|_| std::array::from_fn(|_| stream.bits() as u8))
            .collect();
        let bytes: Vec<u8> = (0..20_000)
            .flat_map(|_| words[stream.below(words.len())])
            .collect();
        let plain = pack(&bytes, &[]);
        assert_eq!(pack_to_size(&bytes, &[], plain.len()), plain);
        let harder = pack_to_size(&bytes, &[], plain.len() - 1);
        assert!(
            harder.len() < plain.len(),
            "{} of {}",
            harder.len(),
            plain.len()
        );
        assert_eq!(unpack(&harder, &[]).unwrap(), bytes);
    }

    /// At the best quality it would take half a minute.
    #[test]
    fn much_is_not_packed_harder() {
        let mut stream = crate::random::RandomKey::root(4).stream();
        let bytes: Vec<u8> = (0..=MAX_HARDER).map(|_| stream.below(7) as u8).collect();
        assert_eq!(pack_to_size(&bytes, &[], 0), pack(&bytes, &[]));
    }

    /// A megabyte whose second half repeats the first one.
    #[test]
    fn what_repeats_far_away_is_packed_once() {
        let mut stream = crate::random::RandomKey::root(1).stream();
        let half: Vec<u8> = (0..500_000).map(|_| stream.bits() as u8).collect();
        let packed = pack(&[half.clone(), half.clone()].concat(), &[]);
        assert!(
            packed.len() < half.len() + half.len() / 50,
            "{}",
            packed.len()
        );
    }

    /// Half a megabyte of noise against the same noise with one byte in a thousand changed; another base does not unpack it.
    #[test]
    fn what_the_base_has_takes_next_to_nothing() {
        let mut stream = crate::random::RandomKey::root(2).stream();
        let base: Vec<u8> = (0..500_000).map(|_| stream.bits() as u8).collect();
        let mut bytes = base.clone();
        for byte in bytes.iter_mut().step_by(1000) {
            *byte ^= 1;
        }
        let packed = pack(&bytes, &base);
        assert!(packed.len() < bytes.len() / 50, "{}", packed.len());
        assert_eq!(unpack(&packed, &base).unwrap(), bytes);
        let other: Vec<u8> = base.iter().rev().copied().collect();
        assert!(unpack(&packed, &other).map_or(true, |found| found != bytes));
    }
}
