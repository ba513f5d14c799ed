//! The sound of syllables.

use super::speaker_voice::SpeakerVoice;
use super::spectrum::{HIGHEST_HZ, VoiceSpectrum, harmonic_amplitude, turbulence_psd, whisper_psd};
use super::syllables::{
    CONSONANT_EDGE_S, ConsonantSound, PAUSE_S, Syllable, VOWEL_EDGE_S, syllables,
};
use super::vocal_effort::VocalEffort;
use crate::fft::RealFft;
use crate::signals::{raised_cosine_envelope, raised_cosine_rise};
use dwell_scene::interrupt;
use dwell_scene::random::RandomKey;
use realfft::num_complex::Complex;
use std::f64::consts::TAU;

/// Time in which the formants go from the locus to the vowel, s.
const GLIDE_S: f64 = 0.05;
/// Fall of the pitch from token to token and within a syllable, and its random variation, relative.
const PITCH_FALL: f64 = 0.025;
const SYLLABLE_FALL: f64 = 0.08;
const PITCH_VARIATION: f64 = 0.03;
/// Longest sound of one piece, s.
const LONGEST_S: f64 = 0.15;

/// A piece of sound.
#[derive(Clone, Copy)]
#[expect(clippy::struct_field_names, reason = "all three are in seconds")]
struct Span {
    start_s: f64,
    duration_s: f64,
    edge_s: f64,
}

struct Renderer<'a> {
    rate_hz: f64,
    /// Factor of formants.
    size: f64,
    spectrum: &'a VoiceSpectrum,
    fft: RealFft,
    out: Vec<f64>,
}

/// See [`utterance`](super::utterance).
pub(super) fn render(
    tokens: &[u32],
    voice: &SpeakerVoice,
    effort: VocalEffort,
    rate_hz: u32,
    key: RandomKey,
) -> Vec<f32> {
    let duration_s: f64 = tokens
        .iter()
        .map(|t| super::syllables::token_duration_s(*t))
        .sum();
    let rate = f64::from(rate_hz);
    let mut renderer = Renderer {
        rate_hz: rate,
        size: voice.formant_ratio(),
        spectrum: &VoiceSpectrum::new(voice, effort),
        fft: RealFft::at_least((LONGEST_S * rate) as usize + 2),
        out: vec![0.0; (duration_s * rate).ceil() as usize],
    };
    let mut now_s = 0.0;
    for (place, token) in tokens.iter().enumerate() {
        for (k, syllable) in syllables(*token).iter().enumerate() {
            let key = key.child(place as u64).child(k as u64);
            let vary = 1.0 + PITCH_VARIATION * (2.0 * key.child("pitch").stream().uniform() - 1.0);
            let intonation = (1.08 - PITCH_FALL * place as f64) * vary;
            let pitch_hz = effort
                .is_voiced()
                .then(|| voice.pitch_hz * effort.pitch_ratio() * intonation);
            renderer.add_syllable(syllable, now_s, pitch_hz, key);
            now_s += syllable.duration_s;
        }
        now_s += PAUSE_S;
    }
    renderer.out.into_iter().map(|x| x as f32).collect()
}

impl Renderer<'_> {
    /// Adds a syllable; without a pitch it is whispered.
    fn add_syllable(&mut self, of: &Syllable, now_s: f64, pitch_hz: Option<f64>, key: RandomKey) {
        let (start_s, duration_s) = of.consonant_span_s();
        let span = Span {
            start_s: now_s + start_s,
            duration_s,
            edge_s: CONSONANT_EDGE_S,
        };
        match &of.consonant.sound {
            ConsonantSound::Turbulence {
                resonance_hz,
                level,
                ..
            } => {
                let size = self.size;
                let density = |f: f64| level * level * turbulence_psd(f, *resonance_hz, size);
                let noise = self.noise(key.child("turbulence"), density);
                self.add(span, |k, _| noise[k]);
            }
            ConsonantSound::Sonorant(formants_hz, level) => {
                let tract = [formants_hz, formants_hz];
                self.add_formants(span, tract, *level, pitch_hz, key.child("sonorant"));
            }
        }
        let (start_s, duration_s) = of.vowel_span_s();
        let span = Span {
            start_s: now_s + start_s,
            duration_s,
            edge_s: VOWEL_EDGE_S,
        };
        let tract = [&of.consonant.locus_hz, of.vowel_hz];
        self.add_formants(span, tract, 1.0, pitch_hz, key.child("vowel"));
    }

    /// Adds voiced or whispered sound whose formants go from the first to the second.
    fn add_formants(
        &mut self,
        span: Span,
        tract: [&[f64; 3]; 2],
        level: f64,
        pitch_hz: Option<f64>,
        key: RandomKey,
    ) {
        let size = self.size;
        let Some(pitch_hz) = pitch_hz else {
            // The same key: the same noise, shaped by the one and the other.
            let [from, to] = tract.map(|formants_hz| {
                let density = |f: f64| level * level * whisper_psd(f, formants_hz, size);
                self.noise(key, density)
            });
            self.add(span, |k, t| {
                let way = raised_cosine_rise(t, GLIDE_S);
                (1.0 - way) * from[k] + way * to[k]
            });
            return;
        };
        let highest_hz = (0.45 * self.rate_hz / (1.0 + 0.5 * SYLLABLE_FALL)).min(HIGHEST_HZ);
        let harmonics: Vec<[f64; 2]> = (1..=(highest_hz / pitch_hz) as usize)
            .map(|n| {
                let frequency_hz = n as f64 * pitch_hz;
                let gain = level * self.spectrum.gain_pa(frequency_hz);
                tract.map(|formants_hz| gain * harmonic_amplitude(frequency_hz, formants_hz, size))
            })
            .collect();
        self.add(span, |_, t| {
            let bend = 0.5 * SYLLABLE_FALL * (1.0 - t / span.duration_s);
            let phase = TAU * pitch_hz * t * (1.0 + bend);
            // sin((n + 1) x) = 2 cos(x) sin(n x) - sin((n - 1) x).
            let twice_cos = 2.0 * libm::cos(phase);
            let (mut before, mut now) = (0.0, libm::sin(phase));
            let [mut from, mut to] = [0.0; 2];
            for [a, b] in &harmonics {
                from += a * now;
                to += b * now;
                (before, now) = (now, twice_cos * now - before);
            }
            let way = raised_cosine_rise(t, GLIDE_S);
            (1.0 - way) * from + way * to
        });
    }

    /// Returns noise of a one-sided power density, 1/Hz, as long as the longest piece, Pa. Shape (sample,).
    fn noise(&mut self, key: RandomKey, density: impl Fn(f64) -> f64) -> Vec<f64> {
        let step_hz = self.rate_hz / self.fft.len() as f64;
        let highest_hz = (0.45 * self.rate_hz).min(HIGHEST_HZ);
        let mut stream = key.stream();
        let mut spectrum = vec![Complex::default(); self.fft.bins()];
        let half = 0.5 * self.fft.len() as f64;
        for (bin, value) in spectrum.iter_mut().enumerate().skip(1) {
            let frequency_hz = bin as f64 * step_hz;
            if frequency_hz > highest_hz {
                break;
            }
            let gain = self.spectrum.gain_pa(frequency_hz);
            // A bin of amplitude half * a is a tone of amplitude a and power a² / 2.
            let size = half * gain * (2.0 * density(frequency_hz) * step_hz).sqrt();
            let phase = TAU * stream.uniform();
            *value = Complex::new(
                (size * libm::cos(phase)) as f32,
                (size * libm::sin(phase)) as f32,
            );
        }
        let samples = self.fft.inverse_ref(&mut spectrum);
        samples.iter().map(|x| f64::from(*x)).collect()
    }

    /// Adds `value(sample of the span, time since its start)` with a rise and a fall.
    fn add(&mut self, span: Span, value: impl Fn(usize, f64) -> f64) {
        interrupt::unwind_if_cancelled();
        let first = (span.start_s * self.rate_hz).ceil() as usize;
        for (k, out) in self.out.iter_mut().skip(first).enumerate() {
            let t = (first + k) as f64 / self.rate_hz - span.start_s;
            if t >= span.duration_s {
                break;
            }
            *out += raised_cosine_envelope(t, span.duration_s, span.edge_s) * value(k, t);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_piece_is_shorter_than_the_noise() {
        for token in [0, super::super::MAX_VOCABULARY - 1] {
            for syllable in syllables(token) {
                assert!(syllable.vowel_span_s().1 < LONGEST_S);
                assert!(syllable.consonant_span_s().1 < LONGEST_S);
            }
        }
    }
}
