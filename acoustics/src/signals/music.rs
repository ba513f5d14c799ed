//! Music enough for a radio: chords, a bass, a tune, a beat.

use super::loop_builder::{LoopBuilder, raised_cosine_envelope, resonance_gain};
use std::f64::consts::TAU;

/// Frequency of a key of the piano, A4 = 69 = 440 Hz.
fn pitch_hz(key: i32) -> f64 {
    440.0 * libm::pow(2.0, f64::from(key - 69) / 12.0)
}

/// Adds a plucked string: partials that fade the sooner the higher they are.
fn pluck(canvas: &mut LoopBuilder, start_s: f64, key: i32, amplitude: f64, decay_s: f64) {
    let frequency_hz = pitch_hz(key);
    for partial in 1..=8 {
        let n = f64::from(partial);
        canvas.add_decaying_tone(start_s, n * frequency_hz, decay_s / n.sqrt(), amplitude / n);
    }
}

/// Adds a held note: few partials, with a slow vibrato.
fn hold(canvas: &mut LoopBuilder, start_s: f64, duration_s: f64, key: i32, amplitude: f64) {
    for partial in 1..=5 {
        let n = f64::from(partial);
        let frequency_hz = n * pitch_hz(key);
        if frequency_hz > 0.45 * canvas.rate_hz {
            break;
        }
        canvas.add(start_s, duration_s, |t| {
            let phase =
                TAU * frequency_hz * t + 0.004 * frequency_hz / 5.0 * libm::sin(TAU * 5.0 * t);
            amplitude / (n * n) * raised_cosine_envelope(t, duration_s, 0.08) * libm::sin(phase)
        });
    }
}

/// Adds the four chords of so many songs (I, vi, IV, V in C), over and over, with bass, drums and a tune that wanders.
pub(super) fn music_band(canvas: &mut LoopBuilder, amplitude: f64) {
    const CHORDS: [[i32; 3]; 4] = [[60, 64, 67], [57, 60, 64], [53, 57, 60], [55, 59, 62]];
    const SCALE: [i32; 6] = [72, 74, 76, 79, 81, 84];
    let bars = (canvas.loop_s() / 2.0).floor() as usize;
    let bar_s = canvas.loop_s() / bars.max(1) as f64;
    let (snare, hat) = (
        canvas.shaped_noise("snare", |f| resonance_gain(f, 1800.0, 2500.0)),
        canvas.shaped_noise("hat", |f| if f > 5000.0 { 1.0 } else { 0.0 }),
    );
    let mut stream = canvas.key.child("tune").stream();
    let mut step = 2_usize;
    for bar in 0..bars {
        let (start_s, chord) = (bar as f64 * bar_s, CHORDS[bar % 4]);
        let beat_s = bar_s / 4.0;
        for key in chord {
            hold(canvas, start_s, bar_s, key, 0.25 * amplitude);
        }
        for beat in 0..4 {
            let at_s = start_s + f64::from(beat) * beat_s;
            pluck(canvas, at_s, chord[0] - 24, 0.9 * amplitude, 0.7);
            if beat % 2 == 0 {
                canvas.add_decaying_tone(at_s, 58.0, 0.3, 1.2 * amplitude);
            } else {
                let decay = |t: f64| {
                    0.5 * amplitude * libm::exp(-28.0 * t) * raised_cosine_envelope(t, 0.2, 0.002)
                };
                canvas.add_noise(&snare, at_s, 0.2, decay);
            }
            for half in [0.0, 0.5] {
                let decay = |t: f64| {
                    0.2 * amplitude * libm::exp(-70.0 * t) * raised_cosine_envelope(t, 0.06, 0.001)
                };
                canvas.add_noise(&hat, at_s + half * beat_s, 0.06, decay);
                if stream.uniform() < 0.7 {
                    step = (step + [0, 1, 5][stream.below(3)]) % SCALE.len();
                    pluck(
                        canvas,
                        at_s + half * beat_s,
                        SCALE[step],
                        0.5 * amplitude,
                        0.9,
                    );
                }
            }
        }
    }
}

/// Music with a beat.
pub(super) fn radio(canvas: &mut LoopBuilder) {
    music_band(canvas, 1.0);
}
