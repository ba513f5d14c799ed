//! Filters applied to a chunk before it was stored.

use super::bytes::{Cursor, Hdf5Result, unsupported};
use dwell_scene::interrupt;
use flate2::read::ZlibDecoder;
use std::io::Read as _;

/// Most filters of a variable.
const MOST_FILTERS: u8 = 8;
/// Bytes that are inflated at once.
const PIECE: u64 = 1 << 20;

#[derive(Debug, Clone, Copy, PartialEq)]
enum ChunkFilter {
    Deflate,
    /// Bytes of values, grouped by their place in the value: this many bytes a value.
    Shuffle(usize),
    Fletcher32,
}

/// Filters in the order in which they were applied.
#[derive(Debug, Clone, Default)]
pub(super) struct FilterPipeline(Vec<ChunkFilter>);

impl FilterPipeline {
    pub(super) fn read(mut cursor: Cursor<'_>) -> Hdf5Result<Self> {
        let version = cursor.u8()?;
        let count = cursor.u8()?;
        if !(1..=2).contains(&version) || count > MOST_FILTERS {
            return unsupported(format!(
                "{count} filters of version {version}; allowed are {MOST_FILTERS} of versions 1 and 2"
            ));
        }
        if version == 1 {
            cursor.skip(6)?;
        }
        let mut filters = Vec::new();
        for _ in 0..count {
            let id = cursor.u16()?;
            let name = if version == 1 || id >= 256 {
                cursor.u16()?
            } else {
                0
            };
            cursor.skip(2)?;
            let values = usize::from(cursor.u16()?);
            cursor.skip(usize::from(name))?;
            let mut of = cursor.sub_cursor(4 * values)?;
            if version == 1 {
                cursor.skip(4 * (values % 2))?;
            }
            filters.push(match id {
                1 => ChunkFilter::Deflate,
                2 => ChunkFilter::Shuffle(of.u32()? as usize),
                3 => ChunkFilter::Fletcher32,
                _ => {
                    return unsupported(format!(
                        "compressed by filter {id}; read are deflate (1), shuffle (2) and Fletcher-32 (3)"
                    ));
                }
            });
        }
        Ok(Self(filters))
    }

    pub(super) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Returns the `size` bytes of a chunk from those stored; the filters of `skipped` were not applied.
    pub(super) fn decode(&self, stored: &[u8], skipped: u32, size: usize) -> Hdf5Result<Vec<u8>> {
        let mut bytes = stored.to_vec();
        for (k, filter) in self.0.iter().enumerate().rev() {
            if skipped & (1 << k) != 0 {
                continue;
            }
            bytes = match filter {
                // A checksum may follow the values.
                ChunkFilter::Deflate => inflate(&bytes, size as u64 + 64)?,
                ChunkFilter::Shuffle(width) => unshuffle(&bytes, *width),
                ChunkFilter::Fletcher32 => verify_checksum(bytes)?,
            };
        }
        if bytes.len() != size {
            return unsupported(format!(
                "damaged: a chunk of {} bytes; expected {size}",
                bytes.len()
            ));
        }
        Ok(bytes)
    }
}

fn inflate(bytes: &[u8], most: u64) -> Hdf5Result<Vec<u8>> {
    let mut stream = ZlibDecoder::new(bytes).take(most + 1);
    let mut inflated = Vec::new();
    loop {
        interrupt::unwind_if_cancelled();
        match (&mut stream).take(PIECE).read_to_end(&mut inflated) {
            Ok(0) => break,
            Ok(_) => {}
            Err(error) => {
                return unsupported(format!("damaged: a chunk cannot be inflated: {error}"));
            }
        }
    }
    if inflated.len() as u64 > most {
        return unsupported("damaged: a chunk inflates to more bytes than it has");
    }
    Ok(inflated)
}

/// Reverses the shuffle filter: first bytes of all values, then second bytes, and so on; the remainder at the end stays.
fn unshuffle(bytes: &[u8], width: usize) -> Vec<u8> {
    let count = bytes.len() / width.max(1);
    if width < 2 || count < 2 {
        return bytes.to_vec();
    }
    let whole = count * width;
    let mut ordered = vec![0; whole];
    for (place, of_place) in bytes[..whole].chunks_exact(count).enumerate() {
        for (value, byte) in ordered.chunks_exact_mut(width).zip(of_place) {
            value[place] = *byte;
        }
    }
    ordered.extend_from_slice(&bytes[whole..]);
    ordered
}

/// Returns the bytes before their checksum, if it is valid.
fn verify_checksum(mut bytes: Vec<u8>) -> Hdf5Result<Vec<u8>> {
    let Some(at) = bytes.len().checked_sub(4) else {
        return unsupported("damaged: a chunk without its check sum");
    };
    let mut stated = [0; 4];
    stated.copy_from_slice(&bytes[at..]);
    bytes.truncate(at);
    if fletcher32(&bytes) != u32::from_le_bytes(stated) {
        return unsupported("damaged: a chunk whose check sum is another");
    }
    Ok(bytes)
}

/// Fletcher's sums of big-endian words of 16 bits, modulo 65535.
fn fletcher32(bytes: &[u8]) -> u32 {
    // Words, so many that no sum overflows.
    const PIECE: usize = 2 * 360;
    let fold = |sum: u32| (sum & 0xffff) + (sum >> 16);
    let (mut low, mut high) = (0_u32, 0_u32);
    for piece in bytes.chunks(PIECE) {
        for word in piece.chunks(2) {
            low += u32::from(word[0]) << 8 | u32::from(word.get(1).copied().unwrap_or(0));
            high += low;
        }
        (low, high) = (fold(low), fold(high));
    }
    fold(high) << 16 | fold(low)
}
