//! Who speaks.

use crate::error::{AcousticsError, check_range};
use dwell_scene::random::RandomKey;
use serde::{Deserialize, Serialize};

/// Pitch of men and women, Hz: means over ten vowels (G. E. Peterson, H. L. Barney, JASA 24, 175, 1952, table II).
const MEAN_PITCH_HZ: [f64; 2] = [132.0, 223.0];
/// Length of the vocal tract over that of a man. Formants of women are 1.17 times those of men (ibid., mean over vowels and formants).
const MEAN_TRACT: [f64; 2] = [1.0, 1.0 / 1.17];
/// Largest deviation of a speaker from the mean in pitch, semitones, and in tract length, relative. Estimates: about two
/// standard deviations of adults, after the scatter shown ibid. and in W. T. Fitch, J. Giedd, JASA 106, 1511 (1999).
const PITCH_SEMITONES: f64 = 3.0;
const TRACT: f64 = 0.08;

/// The voice of a speaker.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct SpeakerVoice {
    /// Mean pitch in normal speech, Hz; 50 to 500.
    pub pitch_hz: f64,
    /// Length of the vocal tract over that of an average man, 0.6 to 1.3: formants are divided by it.
    pub vocal_tract_scale: f64,
}

impl SpeakerVoice {
    /// The average man and woman of Peterson and Barney.
    pub(super) const AVERAGE: [Self; 2] = [
        Self {
            pitch_hz: MEAN_PITCH_HZ[0],
            vocal_tract_scale: MEAN_TRACT[0],
        },
        Self {
            pitch_hz: MEAN_PITCH_HZ[1],
            vocal_tract_scale: MEAN_TRACT[1],
        },
    ];

    /// Draws the voice of an adult: as often of a man (111 to 157 Hz, tract of 0.92 to 1.08) as of a woman (188 to 265 Hz, 0.79 to 0.92).
    pub fn draw(key: RandomKey) -> Self {
        let mut stream = key.child("voice").stream();
        let average = Self::AVERAGE[stream.below(2)];
        let mut spread = || 2.0 * stream.uniform() - 1.0;
        Self {
            pitch_hz: average.pitch_hz * libm::exp2(PITCH_SEMITONES / 12.0 * spread()),
            vocal_tract_scale: average.vocal_tract_scale * (1.0 + TRACT * spread()),
        }
    }

    /// Returns the factor of all formants.
    pub(super) fn formant_ratio(&self) -> f64 {
        1.0 / self.vocal_tract_scale
    }

    /// Refuses what no person has.
    pub(super) fn check(&self) -> Result<(), AcousticsError> {
        const AT: &str = "voice";
        let (pitch_hz, scale) = (self.pitch_hz, self.vocal_tract_scale);
        check_range(AT, "pitch_hz", pitch_hz, (50.0, 500.0), "50 to 500")?;
        check_range(AT, "vocal_tract_scale", scale, (0.6, 1.3), "0.6 to 1.3")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Means over 2,000 voices lie within 5 standard errors of those of the uniform distributions.
    #[test]
    fn drawn_voices_have_the_range_of_men_and_women() {
        let voices: Vec<SpeakerVoice> = (0..2000)
            .map(|k| SpeakerVoice::draw(RandomKey::root(k)))
            .collect();
        let (men, women): (Vec<SpeakerVoice>, Vec<SpeakerVoice>) =
            voices.iter().copied().partition(|v| v.pitch_hz < 170.0);
        assert!(men.len().abs_diff(1000) < 112);
        for (group, range_hz, tract) in [
            (men, 111.0..157.0, 0.92..1.08),
            (women, 187.5..265.3, 0.786..0.924),
        ] {
            assert!(group.iter().all(|v| range_hz.contains(&v.pitch_hz)));
            assert!(group.iter().all(|v| tract.contains(&v.vocal_tract_scale)));
            let n = group.len() as f64;
            let mean = group.iter().map(|v| v.vocal_tract_scale).sum::<f64>() / n;
            let error = (tract.end - tract.start) / 12_f64.sqrt() / n.sqrt();
            assert!((mean - 0.5 * (tract.start + tract.end)).abs() < 5.0 * error + 0.001);
        }
        assert_eq!(voices[3], SpeakerVoice::draw(RandomKey::root(3)));
    }

    #[test]
    fn voices_of_nobody_are_refused() {
        let man = SpeakerVoice::AVERAGE[0];
        assert!(man.check().is_ok());
        for (pitch_hz, vocal_tract_scale) in [(f64::NAN, 1.0), (10.0, 1.0), (100.0, 0.0)] {
            let voice = SpeakerVoice {
                pitch_hz,
                vocal_tract_scale,
            };
            assert!(voice.check().is_err());
        }
    }
}
