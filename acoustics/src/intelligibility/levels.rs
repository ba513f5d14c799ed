//! Levels in the octaves of speech.

use super::modulation::{OVERLAP, check_signal};
use crate::bands::{BAND_COUNT, power_shares};
use crate::echogram::Echogram;
use crate::error::AcousticsError;
use crate::fft::RealFft;
use crate::utterance::SPEECH_BAND_COUNT;

/// Square of the reference pressure, Pa².
const REFERENCE_PA2: f64 = 4e-10;

/// Returns the level of each octave of a signal over all its length, dB SPL; minus infinity in silence. Shape (band,).
///
/// `samples`: pressure, Pa, shape (sample,).
///
/// # Errors
/// [`AcousticsError::Range`]: 1 to 2^25 finite samples at 1,000 to 192,000 Hz.
pub fn octave_levels_db(
    samples: &[f32],
    rate_hz: u32,
) -> Result<[f64; SPEECH_BAND_COUNT], AcousticsError> {
    check_signal(samples, rate_hz)?;
    let mut fft = RealFft::at_least(samples.len());
    let spectrum = fft.forward(samples);
    let step_hz = f64::from(rate_hz) / fft.len() as f64;
    let last = spectrum.len() - 1;
    let mut sums = [0.0; BAND_COUNT];
    for (bin, value) in spectrum.iter().enumerate() {
        // All bins but the first and the last represent two frequencies.
        let count = if bin == 0 || bin == last { 1.0 } else { 2.0 };
        let power = count * (f64::from(value.re).powi(2) + f64::from(value.im).powi(2));
        let shares = power_shares(bin as f64 * step_hz, OVERLAP);
        for (sum, share) in sums.iter_mut().zip(shares) {
            *sum += power * share;
        }
    }
    // Parseval.
    let scale = 1.0 / (fft.len() as f64 * samples.len() as f64 * REFERENCE_PA2);
    let speech = &sums[BAND_COUNT - SPEECH_BAND_COUNT..];
    Ok(std::array::from_fn(|band| {
        10.0 * libm::log10(speech[band] * scale)
    }))
}

/// Returns the level of each octave at a receiver, dB SPL, of a source with `source_db` at 1 m on its axis: direct sound, reflections and
/// tail together; minus infinity where nothing arrives. Shape (band,).
pub fn received_levels_db(
    source_db: &[f64; SPEECH_BAND_COUNT],
    echogram: &Echogram,
) -> [f64; SPEECH_BAND_COUNT] {
    let energy = echogram.total();
    std::array::from_fn(|band| {
        source_db[band] + 10.0 * libm::log10(energy[band + BAND_COUNT - SPEECH_BAND_COUNT])
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::echogram::PropagationPath;
    use glam::Vec3;

    #[test]
    fn a_tone_has_its_level_in_its_octave() {
        let tone = |k: u32| (0.2 * (std::f64::consts::TAU * f64::from(k) / 16.0).sin()) as f32;
        let samples: Vec<f32> = (0..16_000).map(tone).collect();
        let levels = octave_levels_db(&samples, 16_000).unwrap();
        // 0.2 Pa of amplitude: 20 lg(0.2 / sqrt(2) / 20e-6) = 76.99 dB.
        assert!((levels[3] - 76.99).abs() < 0.02, "{levels:?}");
        assert!(levels[1] < 40.0 && levels[5] < 40.0);
        let silence = octave_levels_db(&[0.0; 100], 16_000).unwrap();
        assert_eq!(silence, [f64::NEG_INFINITY; 7]);
        assert!(octave_levels_db(&[f32::NAN], 16_000).is_err());
    }

    /// Free field: 6.02 dB less for each doubling of the distance.
    #[test]
    fn a_free_path_takes_the_level_of_its_distance() {
        let path = PropagationPath {
            planes: Vec::new(),
            diffraction_points: Vec::new(),
            length_m: 4.0,
            energy: [1.0 / 16.0; 8],
            arrival: Vec3::X,
            departure: Vec3::X,
            walls: 0,
            inverted: false,
        };
        let echogram = Echogram {
            paths: vec![path],
            ..Echogram::default()
        };
        let levels = received_levels_db(&[60.0; 7], &echogram);
        assert!(levels.iter().all(|db| (db - (60.0 - 12.04)).abs() < 0.01));
        let none = received_levels_db(&[60.0; 7], &Echogram::default());
        assert_eq!(none, [f64::NEG_INFINITY; 7]);
    }
}
