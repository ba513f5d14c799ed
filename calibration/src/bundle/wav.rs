//! Impulse responses from WAV files.

use super::limits;
use crate::error::CalibrationError;
use dwell_acoustics::recordings::without_other_chunks;
use std::fs::File;
use std::io::BufReader;

/// The samples of a WAV file with one channel; whole numbers are scaled to -1..1.
pub(super) fn samples(file: File, at: &str, rate_hz: u32) -> Result<Vec<f32>, CalibrationError> {
    let syntax = |error: hound::Error| CalibrationError::Syntax {
        at: at.to_owned(),
        what: error.to_string(),
    };
    let reader = without_other_chunks(BufReader::new(file)).map_err(hound::Error::IoError);
    let mut reader = reader.and_then(hound::WavReader::new).map_err(syntax)?;
    let spec = reader.spec();
    let field = |name: &str, found: u32, allowed: String| {
        Err(CalibrationError::field(at, name, found, allowed))
    };
    if spec.channels != 1 {
        return field("channels", spec.channels.into(), "1".to_owned());
    }
    if spec.sample_rate != rate_hz {
        return field(
            "sample rate",
            spec.sample_rate,
            format!("{rate_hz}, as ir.csv says"),
        );
    }
    if !(8_000..=192_000).contains(&rate_hz) {
        return field("sample rate", rate_hz, "8000 to 192000 Hz".to_owned());
    }
    let count = u64::from(reader.duration());
    if count > limits::MAX_WAV_SAMPLES {
        let limit = limits::MAX_WAV_SAMPLES;
        return Err(CalibrationError::TooLarge {
            at: at.to_owned(),
            what: "samples",
            found: count,
            limit,
        });
    }
    let samples: Result<Vec<f32>, _> = match spec.sample_format {
        hound::SampleFormat::Float => reader.samples::<f32>().collect(),
        hound::SampleFormat::Int => {
            let bits = u32::from(spec.bits_per_sample);
            if !(8..=32).contains(&bits) {
                return field("bits per sample", bits, "8 to 32".to_owned());
            }
            let scale = 1.0 / f64::from(2_u32.pow(bits - 1));
            let whole = reader.samples::<i32>();
            whole
                .map(|s| s.map(|s| (f64::from(s) * scale) as f32))
                .collect()
        }
    };
    let samples = samples.map_err(syntax)?;
    if let Some(found) = samples.iter().find(|s| !s.is_finite()) {
        return Err(CalibrationError::field(
            at,
            "a sample",
            found,
            "finite numbers",
        ));
    }
    if samples.iter().all(|s| *s == 0.0) {
        return Err(CalibrationError::field(
            at,
            "every sample",
            0,
            "an impulse response with sound in it",
        ));
    }
    Ok(samples)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::{Cursor, Write};

    #[test]
    fn a_chunk_of_odd_length_before_the_samples_is_passed_over() {
        let spec = hound::WavSpec {
            channels: 1,
            sample_rate: 48_000,
            bits_per_sample: 16,
            sample_format: hound::SampleFormat::Int,
        };
        let mut plain = Cursor::new(Vec::new());
        let mut writer = hound::WavWriter::new(&mut plain, spec).unwrap();
        for sample in [0_i16, 16_384, -8192] {
            writer.write_sample(sample).unwrap();
        }
        writer.finalize().unwrap();
        let plain = plain.into_inner();
        // Behind the header and the format.
        let (head, data) = plain.split_at(36);
        let mut file = tempfile::NamedTempFile::new().unwrap();
        for bytes in [head, b"LIST\x03\0\0\0abc\0", data] {
            file.write_all(bytes).unwrap();
        }
        let file = File::open(file.path()).unwrap();
        assert_eq!(samples(file, "ir.wav", 48_000).unwrap(), [0.0, 0.5, -0.25]);
    }
}
