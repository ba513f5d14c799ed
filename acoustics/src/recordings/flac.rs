//! FLAC, by `claxon`.

use super::{MonoMix, damaged};
use crate::error::AcousticsError;
use std::io::Cursor;

pub(super) fn decode<'a>(name: &'a str, bytes: &[u8]) -> Result<MonoMix<'a>, AcousticsError> {
    let broken = |error: claxon::Error| damaged(name, &error);
    let mut reader = claxon::FlacReader::new(Cursor::new(bytes)).map_err(broken)?;
    let info = reader.streaminfo();
    let mut mix = MonoMix::new(name, info.sample_rate, info.channels)?;
    // The format allows 4 to 32 bits.
    let scale = libm::ldexp(1.0, 1 - info.bits_per_sample as i32);
    let mut blocks = reader.blocks();
    let mut memory = Vec::new();
    while let Some(block) = blocks.read_next_or_eof(memory).map_err(broken)? {
        if block.channels() != info.channels {
            return Err(damaged(name, &"the number of channels changes"));
        }
        for frame in 0..block.duration() {
            for channel in 0..info.channels {
                mix.push(f64::from(block.sample(channel, frame)) * scale)?;
            }
        }
        memory = block.into_buffer();
    }
    let found = mix.samples.len() as u64;
    if let Some(told) = info.samples.filter(|told| *told != found) {
        let found = format!("{found} samples where its header says {told}");
        return Err(damaged(name, &found));
    }
    Ok(mix)
}
