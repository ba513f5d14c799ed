//! Voices without words: the spectrum, rhythm and pitch of speech.

use super::formants::{VOWELS_HZ, formant_gain};
use super::loop_builder::{LoopBuilder, raised_cosine_envelope, resonance_gain};
use super::music;
use std::f64::consts::TAU;

/// A voice.
struct SpeechVoice {
    /// Mean pitch, Hz.
    pitch_hz: f64,
    /// Formants in relation to those of a man.
    size: f64,
}

/// Adds a voice that speaks from `start_s` to `end_s` in syllables of about a quarter of a second, with pauses.
fn talk(canvas: &mut LoopBuilder, voice: &SpeechVoice, name: &str, (start_s, end_s): (f64, f64)) {
    let hiss = canvas.shaped_noise(name, |f| resonance_gain(f, 4500.0, 3000.0));
    let mut stream = canvas.key.child(name).stream();
    let mut now_s = start_s;
    while now_s < end_s - 0.3 {
        let phrase = 4 + stream.below(6);
        for syllable in 0..phrase {
            if now_s >= end_s - 0.3 {
                break;
            }
            let duration_s = 0.13 + 0.14 * stream.uniform();
            if stream.uniform() < 0.5 {
                let (length_s, size) = (
                    0.05 + 0.06 * stream.uniform(),
                    0.06 + 0.1 * stream.uniform(),
                );
                canvas.add_noise(&hiss, now_s, length_s, |t| {
                    size * raised_cosine_envelope(t, length_s, 0.02)
                });
                now_s += 0.7 * length_s;
            }
            // Pitch falls through a phrase.
            let fall = 1.12 - 0.25 * syllable as f64 / phrase as f64;
            let pitch_hz = voice.pitch_hz * fall * (0.95 + 0.1 * stream.uniform());
            let vowel = VOWELS_HZ[stream.below(VOWELS_HZ.len())];
            let stress = 0.6 + 0.6 * stream.uniform();
            vowel_sound(canvas, voice, &vowel, now_s, duration_s, pitch_hz, stress);
            now_s += 0.85 * duration_s;
        }
        now_s += 0.15 + 0.35 * stream.uniform();
    }
}

/// Adds harmonics of the pitch that are strong near the formants.
fn vowel_sound(
    canvas: &mut LoopBuilder,
    voice: &SpeechVoice,
    vowel: &[f64; 3],
    start_s: f64,
    duration_s: f64,
    pitch_hz: f64,
    amplitude: f64,
) {
    let highest_hz = (0.45 * canvas.rate_hz).min(4200.0);
    let harmonics = (highest_hz / pitch_hz) as usize;
    let partials: Vec<(f64, f64)> = (1..=harmonics)
        .map(|n| {
            let frequency_hz = n as f64 * pitch_hz;
            let resonance = formant_gain(frequency_hz, vowel, voice.size);
            // The larynx's pulses fall 12 dB an octave, radiation gives 6 back.
            (
                TAU * frequency_hz,
                amplitude * resonance / (n as f64).sqrt(),
            )
        })
        .filter(|(_, size)| *size > 0.01 * amplitude)
        .collect();
    canvas.add(start_s, duration_s, |t| {
        // The glide of pitch is common to all harmonics.
        let bent = t * (1.0 - 0.08 * t / duration_s);
        let sum: f64 = partials
            .iter()
            .map(|(omega, size)| size * libm::sin(omega * bent))
            .sum();
        sum * raised_cosine_envelope(t, duration_s, 0.03)
    });
}

/// One voice without words.
pub(super) fn speech(canvas: &mut LoopBuilder) {
    let voice = SpeechVoice {
        pitch_hz: 118.0,
        size: 1.0,
    };
    let end_s = canvas.loop_s();
    talk(canvas, &voice, "voice", (0.0, end_s));
}

/// Two voices in turn over quiet music.
pub(super) fn television(canvas: &mut LoopBuilder) {
    let (man, woman) = (
        SpeechVoice {
            pitch_hz: 112.0,
            size: 1.0,
        },
        SpeechVoice {
            pitch_hz: 205.0,
            size: 1.17,
        },
    );
    let end_s = canvas.loop_s();
    let turns = 4;
    for turn in 0..turns {
        let start = end_s * f64::from(turn) / f64::from(turns);
        let stop = end_s * f64::from(turn + 1) / f64::from(turns);
        let (voice, name) = if turn % 2 == 0 {
            (&man, "man")
        } else {
            (&woman, "woman")
        };
        talk(
            canvas,
            voice,
            &format!("{name} {turn}"),
            (start, stop - 0.2),
        );
    }
    music::music_band(canvas, 0.12);
}

/// Six voices at once: a room full of people.
pub(super) fn babble(canvas: &mut LoopBuilder) {
    let end_s = canvas.loop_s();
    for (k, (pitch_hz, size)) in [
        (104.0, 1.0),
        (118.0, 0.98),
        (131.0, 1.03),
        (188.0, 1.14),
        (205.0, 1.17),
        (226.0, 1.2),
    ]
    .into_iter()
    .enumerate()
    {
        let voice = SpeechVoice { pitch_hz, size };
        // They begin in turn, so that pauses do not fall together.
        let start_s = 0.21 * k as f64;
        talk(
            canvas,
            &voice,
            &format!("talker {k}"),
            (start_s, start_s + end_s),
        );
    }
}
