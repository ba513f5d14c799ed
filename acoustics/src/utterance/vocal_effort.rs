//! How loudly a voice speaks.

use serde::{Deserialize, Serialize};

/// The number of octave bands of speech: 125 Hz to 8 kHz.
pub const SPEECH_BAND_COUNT: usize = 7;

/// Nominal centres of the octave bands of speech, Hz: those of [`bands`](crate::bands) but the lowest. Shape (band,).
pub const SPEECH_CENTRES_HZ: [f64; SPEECH_BAND_COUNT] =
    [125.0, 250.0, 500.0, 1000.0, 2000.0, 4000.0, 8000.0];

/// The effort with which somebody speaks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum VocalEffort {
    /// Without voice: turbulent air in place of the larynx's pulses.
    Whisper,
    /// As in conversation, 62 dB at 1 m.
    #[default]
    Normal,
    /// Raised voice, 68 dB at 1 m.
    Raised,
    /// Loud voice, 75 dB at 1 m.
    Loud,
    /// Shouting, 82 dB at 1 m.
    Shout,
}

impl VocalEffort {
    /// All, quietest first.
    pub const ALL: [Self; 5] = [
        Self::Whisper,
        Self::Normal,
        Self::Raised,
        Self::Loud,
        Self::Shout,
    ];

    /// Returns whether the larynx sounds.
    pub fn is_voiced(self) -> bool {
        self != Self::Whisper
    }

    /// Spectrum levels at 1 m ahead of the mouth at 250 Hz to 8 kHz, dB re (20 µPa)²/Hz: means over time, pauses included.
    ///
    /// # Source
    /// Voiced: ANSI S3.5-1997, table 4 (octave bands), as an open implementation of the standard has it (`MoSQITo`); the levels below
    /// agree with the standard's overall levels within 0.5 dB, and with its third-octave table within 1 dB.
    ///
    /// Whisper: an estimate, probably within 5 dB. No table of octave bands of whispers was found. Published is that vowels lose
    /// some 20 dB and most below 1.5 kHz (T. Ito, K. Takeda, F. Itakura, Speech Commun. 45, 139, 2005), and unvoiced consonants only
    /// some dB (S. T. Jovičić, Z. Šarić, J. Voice 22, 263, 2008): the normal voice less 28, 26, 20, 13, 8 and 5 dB.
    fn spectrum_levels_db(self) -> [f64; SPEECH_BAND_COUNT - 1] {
        match self {
            Self::Whisper => [6.75, 8.27, 5.01, 4.32, 1.33, -3.87],
            Self::Normal => [34.75, 34.27, 25.01, 17.32, 9.33, 1.13],
            Self::Raised => [38.98, 40.15, 33.86, 25.32, 16.78, 5.07],
            Self::Loud => [41.55, 44.85, 42.16, 34.39, 25.41, 11.39],
            Self::Shout => [42.50, 49.24, 51.31, 44.32, 34.41, 20.72],
        }
    }

    /// Returns the level of each octave at 1 m ahead of the mouth, dB SPL, of speech that goes on and on: 125 Hz to 8 kHz.
    /// Shape (band,).
    ///
    /// A voice of one speaker differs by some dB ([`utterance`](super::utterance)). At 125 Hz, where the standard has none, it is
    /// 6 dB below 250 Hz, which is between men (some 3 dB) and women (more than 15 dB; D. Byrne et al., JASA 96, 2108, 1994).
    pub fn octave_levels_db(self) -> [f64; SPEECH_BAND_COUNT] {
        let spectrum = self.spectrum_levels_db();
        let octave = |band: usize| {
            let width_hz = SPEECH_CENTRES_HZ[band] * std::f64::consts::FRAC_1_SQRT_2;
            spectrum[band - 1] + 10.0 * libm::log10(width_hz)
        };
        let below = octave(1) - 6.0;
        std::array::from_fn(|band| if band == 0 { below } else { octave(band) })
    }

    /// Returns the level at 1 m ahead of the mouth, dB SPL: the sum of the octaves from 250 Hz on.
    pub fn level_db(self) -> f64 {
        let levels = self.octave_levels_db();
        let power = |level: &f64| libm::pow(10.0, 0.1 * level);
        10.0 * libm::log10(levels[1..].iter().map(power).sum())
    }

    /// Returns the pitch over that of the normal voice: it doubles while the level rises by 30 dB.
    ///
    /// # Source
    /// A. Andersson, A. Eriksson, H. Traunmüller, TMH-QPSR 2/1996, 127.
    pub fn pitch_ratio(self) -> f64 {
        if self.is_voiced() {
            libm::exp2((self.level_db() - Self::Normal.level_db()) / 30.0)
        } else {
            1.0
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The standard states them beside its tables: 62.35, 68.34, 74.85 and 82.30 dB.
    #[test]
    fn octaves_sum_to_the_overall_levels_of_the_standard() {
        let stated = [62.35, 68.34, 74.85, 82.30];
        for (effort, stated_db) in VocalEffort::ALL[1..].iter().zip(stated) {
            let found_db = effort.level_db();
            assert!((found_db - stated_db).abs() < 0.5, "{effort:?} {found_db}");
        }
    }

    /// The standard's table of third octaves, summed, is that of octaves.
    #[test]
    fn octaves_agree_with_the_third_octaves_of_the_standard() {
        const NORMAL: [f64; 18] = [
            32.41, 34.48, 34.75, 33.98, 34.59, 34.27, 32.06, 28.30, 25.01, 23.00, 20.15, 17.32,
            13.18, 11.55, 9.33, 5.31, 2.59, 1.13,
        ];
        let levels = VocalEffort::Normal.octave_levels_db();
        // 160 Hz is the first third, 200 to 315 Hz are the octave of 250 Hz.
        for (octave, thirds) in NORMAL[1..16].chunks(3).enumerate() {
            let power = thirds.iter().enumerate().map(|(k, level)| {
                let centre_hz = 1000.0 * 10_f64.powf(0.1 * (3.0 * octave as f64 + k as f64 - 7.0));
                let width_hz = centre_hz * (10_f64.powf(0.05) - 10_f64.powf(-0.05));
                10_f64.powf(0.1 * level) * width_hz
            });
            let level_db = 10.0 * power.sum::<f64>().log10();
            assert!((level_db - levels[octave + 1]).abs() < 1.0, "{octave}");
        }
    }

    #[test]
    fn more_effort_is_louder_and_higher() {
        let levels = VocalEffort::ALL.map(VocalEffort::level_db);
        assert!(levels.is_sorted() && levels[0] > 35.0 && levels[0] < 45.0);
        let pitches = VocalEffort::ALL.map(VocalEffort::pitch_ratio);
        assert!(
            pitches.is_sorted() && (pitches[4] - 1.57).abs() < 0.05,
            "{pitches:?}"
        );
        assert!((pitches[1] - 1.0).abs() < 0.01);
    }
}
