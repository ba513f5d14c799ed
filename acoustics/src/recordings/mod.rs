//! Sound files: WAV, FLAC and Ogg Vorbis as sources.
//!
//! Files are untrusted: header fields allocate nothing, and the output is finite, of known length and not silent.

mod flac;
mod resample;
mod vorbis;
mod vorbis_headers;
mod wav;
mod wav_chunks;

pub use resample::resample;
pub use wav_chunks::without_other_chunks;

use crate::error::AcousticsError;
use crate::signals::Signal;
use std::fmt::Display;

/// Largest size of a sound file, bytes.
pub const MAX_FILE_BYTES: u64 = 64 << 20;
/// Most samples a channel, in the file and at the requested rate: 35 minutes at 16 kHz.
pub const MAX_SAMPLES: usize = 1 << 25;
/// Most channels.
const MOST_CHANNELS: u32 = 64;
/// Range of sample rates, Hz.
const RATES_HZ: (u32, u32) = (1_000, 768_000);

/// A sound file's samples: the mean of its channels, full scale 1.
#[derive(Clone, Debug, PartialEq)]
pub struct Recording {
    name: String,
    rate_hz: u32,
    channels: u32,
    samples: Vec<f32>,
}

/// The frames decoded so far, mixed to one channel.
struct MonoMix<'a> {
    name: &'a str,
    rate_hz: u32,
    channels: u32,
    samples: Vec<f32>,
    /// Sum of the incomplete frame.
    sum: f64,
    taken: u32,
}

impl<'a> MonoMix<'a> {
    /// Checks the header's values.
    fn new(name: &'a str, rate_hz: u32, channels: u32) -> Result<Self, AcousticsError> {
        let (low, high) = RATES_HZ;
        if !(low..=high).contains(&rate_hz) {
            let allowed = format!("{low} to {high}");
            return Err(fault(name, "samples a second", &rate_hz, allowed));
        }
        if !(1..=MOST_CHANNELS).contains(&channels) {
            let allowed = format!("1 to {MOST_CHANNELS}");
            return Err(fault(name, "channels", &channels, allowed));
        }
        Ok(Self {
            name,
            rate_hz,
            channels,
            samples: Vec::new(),
            sum: 0.0,
            taken: 0,
        })
    }

    /// Takes the next sample of the interleaved channels.
    fn push(&mut self, sample: f64) -> Result<(), AcousticsError> {
        // Samples beyond 24 times full scale in files of float are damage, and would overflow later.
        if !sample.is_finite() || sample.abs() > 1e6 {
            let at = format!("sample {}", self.samples.len());
            return Err(fault(self.name, &at, &sample, "finite numbers to 1e6"));
        }
        self.sum += sample;
        self.taken += 1;
        if self.taken == self.channels {
            if self.samples.len() == MAX_SAMPLES {
                let found = format!("more than {MAX_SAMPLES}");
                let allowed = format!("at most {MAX_SAMPLES}");
                return Err(fault(self.name, "samples a channel", &found, allowed));
            }
            self.samples
                .push((self.sum / f64::from(self.channels)) as f32);
            (self.sum, self.taken) = (0.0, 0);
        }
        Ok(())
    }
}

fn fault(
    name: &str,
    what: &str,
    found: &dyn Display,
    allowed: impl Into<String>,
) -> AcousticsError {
    AcousticsError::SoundFile {
        name: name.to_owned(),
        what: what.to_owned(),
        found: found.to_string(),
        allowed: allowed.into(),
    }
}

/// The error of a damaged file.
fn damaged(name: &str, error: &dyn Display) -> AcousticsError {
    fault(name, "data", error, "a whole, undamaged file")
}

impl Recording {
    /// Decodes the bytes of a file: WAV (PCM of 8, 16, 24 and 32 bits, float of 32 and 64), FLAC, Ogg Vorbis, recognized by their
    /// first bytes. `name`: for errors.
    ///
    /// # Errors
    /// [`AcousticsError::SoundFile`] names the value found and the allowed ones: another format, damage, more than
    /// [`MAX_FILE_BYTES`] or [`MAX_SAMPLES`], 1 to 64 channels, 1,000 to 768,000 samples a second, numbers that are not
    /// finite, silence.
    ///
    /// # Determinism
    /// WAV and FLAC give the same bits on every machine. The tables of the Vorbis decoder come from the platform's sine and
    /// cosine: between platforms the last bits of its samples can differ.
    pub fn decode(name: &str, bytes: &[u8]) -> Result<Self, AcousticsError> {
        if bytes.len() as u64 > MAX_FILE_BYTES {
            let allowed = format!("at most {MAX_FILE_BYTES}");
            return Err(fault(name, "bytes", &bytes.len(), allowed));
        }
        let mix = match bytes {
            [b'R', b'I', b'F', b'F', ..] => wav::decode(name, bytes),
            [b'f', b'L', b'a', b'C', ..] => flac::decode(name, bytes),
            [b'O', b'g', b'g', b'S', ..] => vorbis::decode(name, bytes),
            _ => {
                let begins: Vec<u8> = bytes.iter().copied().take(4).collect();
                let found = format!("{:?}", String::from_utf8_lossy(&begins));
                let allowed = "WAV (\"RIFF\"), FLAC (\"fLaC\") and Ogg Vorbis (\"OggS\")";
                return Err(fault(name, "a file that begins with", &found, allowed));
            }
        }?;
        if mix.taken != 0 {
            return Err(damaged(name, &"the last frame lacks channels"));
        }
        if mix.samples.iter().all(|x| *x == 0.0) {
            let found = format!("{} samples of silence", mix.samples.len());
            return Err(fault(name, "sound", &found, "what has a level"));
        }
        Ok(Self {
            name: name.to_owned(),
            rate_hz: mix.rate_hz,
            channels: mix.channels,
            samples: mix.samples,
        })
    }

    /// Returns the sample rate of the file, Hz.
    pub fn rate_hz(&self) -> u32 {
        self.rate_hz
    }

    /// Returns the number of channels in the file.
    pub fn channels(&self) -> u32 {
        self.channels
    }

    /// Returns the mean of the channels. Shape (sample,), full scale 1.
    pub fn samples(&self) -> &[f32] {
        &self.samples
    }

    /// Returns its duration, s.
    pub fn duration_s(&self) -> f64 {
        self.samples.len() as f64 / f64::from(self.rate_hz)
    }

    /// Returns the sound at `rate_hz` samples a second, root mean square 1 Pa over its whole length.
    ///
    /// # Errors
    /// [`AcousticsError::Range`] for a rate outside 1,000 to 192,000, [`AcousticsError::SoundFile`] for more than
    /// [`MAX_SAMPLES`] at that rate or silence there.
    pub fn signal(&self, rate_hz: u32) -> Result<Signal, AcousticsError> {
        crate::signals::check_rate(rate_hz)?;
        let length = resample::resampled_length(self.samples.len(), self.rate_hz, rate_hz);
        if !(1..=MAX_SAMPLES).contains(&length) {
            let what = format!("samples at {rate_hz} Hz");
            let allowed = format!("1 to {MAX_SAMPLES}");
            return Err(fault(&self.name, &what, &length, allowed));
        }
        let mut samples = resample(&self.samples, self.rate_hz, rate_hz);
        let power: f64 = samples.iter().map(|x| f64::from(*x) * f64::from(*x)).sum();
        let scale = (samples.len() as f64 / power).sqrt();
        // Below the smallest step of 24 bits only rounding is left.
        if !scale.is_finite() || scale > 1e9 {
            let what = format!("level at {rate_hz} Hz");
            return Err(fault(
                &self.name,
                &what,
                &"silence",
                "what can be heard there",
            ));
        }
        for sample in &mut samples {
            *sample = (f64::from(*sample) * scale) as f32;
        }
        Ok(Signal::from_samples(samples.into()))
    }
}

#[cfg(test)]
mod tests;
