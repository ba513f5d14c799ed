//! WAV, by `hound`.

use super::{MonoMix, damaged, fault};
use crate::error::AcousticsError;
use hound::SampleFormat::{Float, Int};
use std::io::Cursor;

pub(super) fn decode<'a>(name: &'a str, bytes: &[u8]) -> Result<MonoMix<'a>, AcousticsError> {
    let broken = |error: hound::Error| damaged(name, &error);
    let reader = hound::WavReader::new(Cursor::new(bytes)).map_err(broken)?;
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
            let allowed = "PCM of 8, 16, 24 and 32 bits, float of 32";
            return Err(fault(name, "samples", &found, allowed));
        }
    }
    Ok(mix)
}
