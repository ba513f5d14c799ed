//! The spectrum of a voice: what the tract's formants lack of the spectrum of real speech.

use super::speaker_voice::SpeakerVoice;
use super::syllables::{
    CONSONANT_EDGE_S, CONSONANTS, ConsonantSound, PAUSE_S, Syllable, VOWEL_EDGE_S, syllables,
};
use super::vocal_effort::{SPEECH_BAND_COUNT, SPEECH_CENTRES_HZ, VocalEffort};
use crate::signals::{VOWELS_HZ, formant_gain, resonance_gain};
use std::f64::consts::{FRAC_1_SQRT_2, PI, SQRT_2};
use std::sync::OnceLock;

/// Highest frequency of a voice, Hz: the upper edge of the octave of 8 kHz.
pub(super) const HIGHEST_HZ: f64 = 8000.0 * SQRT_2;
/// Square of the reference pressure, Pa².
const REFERENCE_PA2: f64 = 4e-10;
/// Distance of the harmonics whose power whispered noise has, Hz.
const NOISE_PER_HARMONIC_HZ: f64 = 100.0;
/// Steps a octave in which spectra of noise are summed.
const STEPS: usize = 24;
/// Rounds in which the equalizer is found: the octaves influence each other through the slopes between them.
const ROUNDS: usize = 40;
/// Pitch over its mean, evenly distributed between these: intonation.
const PITCHES: [f64; 9] = [0.9, 0.925, 0.95, 0.975, 1.0, 1.025, 1.05, 1.075, 1.1];

/// Amplitude of a harmonic of a sound with these formants, Hz, before the equalizer.
pub(super) fn harmonic_amplitude(frequency_hz: f64, formants_hz: &[f64; 3], size: f64) -> f64 {
    // The larynx's pulses fall 12 dB an octave, radiation gives 6 back.
    formant_gain(frequency_hz, formants_hz, size) * (100.0 / frequency_hz).sqrt()
}

/// Power density of whispered sound with these formants, Hz, before the equalizer, 1/Hz: that of harmonics.
pub(super) fn whisper_psd(frequency_hz: f64, formants_hz: &[f64; 3], size: f64) -> f64 {
    let amplitude = harmonic_amplitude(frequency_hz, formants_hz, size);
    0.5 * amplitude * amplitude / NOISE_PER_HARMONIC_HZ
}

/// Power density of turbulence of root mean square 1, before the equalizer, 1/Hz.
pub(super) fn turbulence_psd(frequency_hz: f64, resonance_hz: (f64, f64), size: f64) -> f64 {
    let (centre_hz, width_hz) = (resonance_hz.0 * size, resonance_hz.1);
    let gain = resonance_gain(frequency_hz, centre_hz, width_hz);
    // Integral of the squared resonance over all frequencies.
    gain * gain / (0.5 * PI * width_hz)
}

/// Power over time of a voice that speaks all syllables alike, before the equalizer.
struct LongTermSpectrum {
    /// Factor of the equalizer's frequencies.
    stretch: f64,
    /// Frequencies, Hz, and the power there.
    lines: Vec<(f64, f64)>,
}

/// Returns the factor by which a voice stretches the equalizer: it is that of the average man and woman, and larynx, constrictions and mouth grow
/// with the tract.
fn stretch(voice: &SpeakerVoice) -> f64 {
    let [man, woman] = SpeakerVoice::AVERAGE.map(|average| average.formant_ratio());
    voice.formant_ratio() / (man * woman).sqrt()
}

impl LongTermSpectrum {
    fn new(voice: &SpeakerVoice, effort: VocalEffort) -> Self {
        let mut lines = Self {
            stretch: stretch(voice),
            lines: Vec::new(),
        };
        // Tokens of two syllables; those of three are shorter with the same proportions.
        let syllable = syllables(0)[0];
        let period_s = syllable.duration_s + 0.5 * PAUSE_S;
        // Energy of a sound with raised cosines at both ends.
        let share = |duration_s: f64, edge_s: f64| (duration_s - 1.25 * edge_s) / period_s;
        let vowel = share(syllable.vowel_span_s().1, VOWEL_EDGE_S) / VOWELS_HZ.len() as f64;
        for formants_hz in &VOWELS_HZ {
            lines.add_formants(voice, effort, formants_hz, vowel);
        }
        let size = voice.formant_ratio();
        for consonant in &CONSONANTS {
            let of = Syllable {
                consonant,
                ..syllable
            };
            let power = share(of.consonant_span_s().1, CONSONANT_EDGE_S) / CONSONANTS.len() as f64;
            match consonant.sound {
                ConsonantSound::Sonorant(formants_hz, level) => {
                    lines.add_formants(voice, effort, &formants_hz, power * level * level);
                }
                ConsonantSound::Turbulence {
                    resonance_hz,
                    level,
                    ..
                } => lines
                    .add_noise(|f| power * level * level * turbulence_psd(f, resonance_hz, size)),
            }
        }
        lines
    }

    /// Adds voiced or whispered sound with these formants, times `power`.
    fn add_formants(
        &mut self,
        voice: &SpeakerVoice,
        effort: VocalEffort,
        formants_hz: &[f64; 3],
        power: f64,
    ) {
        let size = voice.formant_ratio();
        if !effort.is_voiced() {
            self.add_noise(|f| power * whisper_psd(f, formants_hz, size));
            return;
        }
        for ratio in PITCHES {
            let pitch_hz = voice.pitch_hz * effort.pitch_ratio() * ratio;
            for n in 1..=(HIGHEST_HZ / pitch_hz) as usize {
                let frequency_hz = n as f64 * pitch_hz;
                let amplitude = harmonic_amplitude(frequency_hz, formants_hz, size);
                let mean = 0.5 * power * amplitude * amplitude / PITCHES.len() as f64;
                self.lines.push((frequency_hz, mean));
            }
        }
    }

    /// Adds noise of a power density, 1/Hz.
    fn add_noise(&mut self, density: impl Fn(f64) -> f64) {
        let half = libm::exp2(0.5 / STEPS as f64);
        for step in 0..STEPS * SPEECH_BAND_COUNT {
            let octaves = (step as f64 + 0.5) / STEPS as f64 - 0.5;
            let frequency_hz = SPEECH_CENTRES_HZ[0] * libm::exp2(octaves);
            let width_hz = frequency_hz * (half - 1.0 / half);
            let power = density(frequency_hz) * width_hz;
            self.lines.push((frequency_hz, power));
        }
    }

    /// Returns the power in each octave behind an equalizer. Shape (band,).
    fn octaves(&self, equalizer: &Equalizer) -> [f64; SPEECH_BAND_COUNT] {
        let mut sums = [0.0; SPEECH_BAND_COUNT];
        for (frequency_hz, power) in &self.lines {
            let octave = libm::log2(frequency_hz / (SPEECH_CENTRES_HZ[0] * FRAC_1_SQRT_2));
            // Below the lowest octave a voice has nothing.
            if let Some(sum) = sums.get_mut(octave.max(0.0) as usize) {
                let gain = equalizer.gain(*frequency_hz / self.stretch);
                *sum += power * gain * gain;
            }
        }
        sums
    }
}

/// Gain by frequency: straight in dB over octaves between the centres of bands.
#[derive(Clone, Debug)]
struct Equalizer {
    /// Shape (band,).
    gain_db: [f64; SPEECH_BAND_COUNT],
}

impl Equalizer {
    /// Returns the equalizer of an effort: with it, the mean of an average man and an average woman has the effort's octaves.
    fn of(effort: VocalEffort) -> &'static Self {
        static ALL: OnceLock<[Equalizer; 5]> = OnceLock::new();
        let all = ALL.get_or_init(|| VocalEffort::ALL.map(Self::found));
        &all[effort as usize]
    }

    fn found(effort: VocalEffort) -> Self {
        let spectra = SpeakerVoice::AVERAGE.map(|voice| LongTermSpectrum::new(&voice, effort));
        let wanted = effort.octave_levels_db().map(power_pa2);
        let mut equalizer = Self {
            gain_db: [0.0; SPEECH_BAND_COUNT],
        };
        for _ in 0..ROUNDS {
            let [man, woman] = spectra.each_ref().map(|s| s.octaves(&equalizer));
            for band in 1..SPEECH_BAND_COUNT {
                let found = 0.5 * (man[band] + woman[band]);
                equalizer.gain_db[band] += 10.0 * libm::log10(wanted[band] / found);
            }
            // No voice has its own octave there: what is below 177 Hz is passed as what is above.
            equalizer.gain_db[0] = equalizer.gain_db[1];
        }
        equalizer
    }

    fn gain(&self, frequency_hz: f64) -> f64 {
        let last = SPEECH_BAND_COUNT - 1;
        let octave = libm::log2(frequency_hz / SPEECH_CENTRES_HZ[0]).clamp(0.0, last as f64);
        let below = (octave as usize).min(last - 1);
        let way = octave - below as f64;
        let db = self.gain_db[below] * (1.0 - way) + self.gain_db[below + 1] * way;
        libm::pow(10.0, 0.05 * db)
    }
}

/// Returns the mean square of the pressure at a level, Pa².
fn power_pa2(level_db: f64) -> f64 {
    REFERENCE_PA2 * libm::pow(10.0, 0.1 * level_db)
}

/// What a voice's sounds are multiplied by, by frequency.
#[derive(Clone, Debug)]
pub(super) struct VoiceSpectrum {
    equalizer: &'static Equalizer,
    /// Factor of the equalizer's frequencies.
    stretch: f64,
    scale_pa: f64,
}

impl VoiceSpectrum {
    /// Of a voice that has the level of its effort over a long time.
    pub(super) fn new(voice: &SpeakerVoice, effort: VocalEffort) -> Self {
        let equalizer = Equalizer::of(effort);
        let octaves = LongTermSpectrum::new(voice, effort).octaves(equalizer);
        let power: f64 = octaves[1..].iter().sum();
        Self {
            equalizer,
            stretch: stretch(voice),
            scale_pa: (power_pa2(effort.level_db()) / power).sqrt(),
        }
    }

    /// Returns the gain at a frequency, Pa.
    pub(super) fn gain_pa(&self, frequency_hz: f64) -> f64 {
        self.scale_pa * self.equalizer.gain(frequency_hz / self.stretch)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_equalizer_is_found() {
        for effort in VocalEffort::ALL {
            let equalizer = Equalizer::of(effort);
            let [man, woman] = SpeakerVoice::AVERAGE
                .map(|voice| LongTermSpectrum::new(&voice, effort).octaves(equalizer));
            let wanted = effort.octave_levels_db().map(power_pa2);
            for band in 1..SPEECH_BAND_COUNT {
                let ratio = 0.5 * (man[band] + woman[band]) / wanted[band];
                assert!((ratio - 1.0).abs() < 1e-3, "{effort:?} {band} {ratio}");
            }
        }
    }

    #[test]
    fn turbulence_has_the_power_that_it_is_scaled_to() {
        let sum: f64 = (0..4_000_000)
            .map(|f| turbulence_psd(0.1 * f64::from(f), (3000.0, 1500.0), 1.0) * 0.1)
            .sum();
        assert!((sum - 1.0).abs() < 0.1, "{sum}");
    }
}
