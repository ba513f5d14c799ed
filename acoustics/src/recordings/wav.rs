//! WAV, by `hound`; 64-bit float, which that does not read, by hand.

use super::wav_chunks::without_other_chunks;
use super::{MonoMix, damaged, fault};
use crate::error::AcousticsError;
use hound::SampleFormat::{Float, Int};

/// The kinds of samples that are read.
const ALLOWED: &str = "PCM of 8, 16, 24 and 32 bits, float of 32 and 64";

pub(super) fn decode<'a>(name: &'a str, bytes: &[u8]) -> Result<MonoMix<'a>, AcousticsError> {
    if let Some((rate_hz, channels)) = double_layout(bytes) {
        return decode_double(MonoMix::new(name, rate_hz, channels)?, bytes);
    }
    let broken = |error: hound::Error| match error {
        hound::Error::Unsupported => fault(name, "samples", &"another kind", ALLOWED),
        error => damaged(name, &error),
    };
    let reader = without_other_chunks(bytes).map_err(hound::Error::IoError);
    let reader = reader.and_then(hound::WavReader::new).map_err(broken)?;
    let spec = reader.spec();
    let mut mix = MonoMix::new(name, spec.sample_rate, u32::from(spec.channels))?;
    match (spec.sample_format, spec.bits_per_sample) {
        (Float, 32) => {
            for sample in reader.into_samples::<f32>() {
                mix.push(f64::from(sample.map_err(broken)?))?;
            }
        }
        (Int, 8 | 16 | 24 | 32) => {
            let scale = f64::from(1_u32 << (spec.bits_per_sample - 1)).recip();
            for sample in reader.into_samples::<i32>() {
                mix.push(f64::from(sample.map_err(broken)?) * scale)?;
            }
        }
        (format, bits) => {
            let found = format!("{bits} bits, {format:?}");
            return Err(fault(name, "samples", &found, ALLOWED));
        }
    }
    Ok(mix)
}

/// The first chunk of a name, as far as the file has it, and the length that its header says.
fn chunk<'a>(bytes: &'a [u8], name: &[u8; 4]) -> Option<(&'a [u8], usize)> {
    let mut rest = bytes.get(8..)?.strip_prefix(b"WAVE")?;
    loop {
        let (head, content) = rest.split_at_checked(8)?;
        let length = u32::from_le_bytes(head[4..].try_into().ok()?) as usize;
        if head.starts_with(name) {
            return Some((&content[..length.min(content.len())], length));
        }
        // Chunks begin at even places.
        rest = content.get(length.checked_next_multiple_of(2)?..)?;
    }
}

/// The sample rate, Hz, and the number of channels of a file of 64-bit float; `None` for other kinds of samples.
fn double_layout(bytes: &[u8]) -> Option<(u32, u32)> {
    const FLOAT: u16 = 3;
    const EXTENSIBLE: u16 = 0xfffe;
    let (layout, _) = chunk(bytes, b"fmt ")?;
    let short = |at: usize| Some(u16::from_le_bytes(*layout.get(at..)?.first_chunk()?));
    let kind = match short(0)? {
        EXTENSIBLE => short(24)?,
        kind => kind,
    };
    let rate_hz = u32::from_le_bytes(*layout.get(4..)?.first_chunk()?);
    (kind == FLOAT && short(14)? == 64).then_some((rate_hz, u32::from(short(2)?)))
}

/// Reads samples of 64-bit float.
fn decode_double<'a>(mut mix: MonoMix<'a>, bytes: &[u8]) -> Result<MonoMix<'a>, AcousticsError> {
    let Some((data, length)) = chunk(bytes, b"data") else {
        return Err(damaged(mix.name, &"no chunk of data"));
    };
    let (samples, rest) = data.as_chunks::<8>();
    if data.len() < length || !rest.is_empty() {
        let found = format!("{} bytes of {length}", data.len());
        return Err(damaged(mix.name, &found));
    }
    for sample in samples {
        mix.push(f64::from_le_bytes(*sample))?;
    }
    Ok(mix)
}
