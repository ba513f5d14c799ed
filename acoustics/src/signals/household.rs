//! Appliances, water, clocks, bells, steps.

use super::loop_builder::{
    FadedTone, LoopBuilder, raised_cosine_envelope, raised_cosine_rise, resonance_gain,
};
use std::f64::consts::TAU;

/// Three beeps of half a second and a pause (the temporal pattern of ISO 8201) at 3.1 kHz, as smoke alarms have it.
pub(super) fn alarm(canvas: &mut LoopBuilder) {
    for beep in 0..3 {
        for (harmonic, amplitude) in [(1.0, 1.0), (2.0, 0.2)] {
            canvas.add_tone(FadedTone {
                start_s: f64::from(beep),
                duration_s: 0.5,
                frequency_hz: 3100.0 * harmonic,
                amplitude,
                ramp_s: 0.01,
            });
        }
    }
}

/// A tick and a lower tock, each a few short resonances.
pub(super) fn clock(canvas: &mut LoopBuilder) {
    for (start_s, pitch) in [(0.1, 1.0), (1.1, 0.86)] {
        for (frequency_hz, amplitude) in
            [(1200.0, 0.4), (2400.0, 1.0), (3900.0, 0.8), (5600.0, 0.4)]
        {
            canvas.add_decaying_tone(start_s, frequency_hz * pitch, 0.03, amplitude);
        }
    }
}

/// Broad noise that falls off above 500 Hz, and the tone of the blades.
pub(super) fn fan(canvas: &mut LoopBuilder) {
    let air = canvas.shaped_noise("air", |f| 1.0 / (1.0 + (f / 500.0) * (f / 500.0)).sqrt());
    canvas.add_to_loop(&air, 1.0);
    for (harmonic, amplitude) in [(1.0, 0.25), (2.0, 0.15), (3.0, 0.08)] {
        canvas.add_continuous_tone(117.0 * harmonic, amplitude);
    }
}

/// Two steps a second: a dull thud of the heel, and the roll of the sole.
pub(super) fn footsteps(canvas: &mut LoopBuilder) {
    let sole = canvas.shaped_noise("sole", |f| resonance_gain(f, 900.0, 1200.0));
    let mut stream = canvas.key.child("steps").stream();
    for step in 0..8 {
        let start_s = 0.5 * f64::from(step) + 0.03 * stream.uniform();
        let weight = 0.8 + 0.4 * stream.uniform();
        let pitch = 0.92 + 0.16 * stream.uniform();
        for (frequency_hz, decay_s, amplitude) in
            [(75.0, 0.12, 1.0), (160.0, 0.07, 0.6), (420.0, 0.04, 0.25)]
        {
            canvas.add_decaying_tone(start_s, frequency_hz * pitch, decay_s, weight * amplitude);
        }
        canvas.add_noise(&sole, start_s + 0.01, 0.12, |t| {
            0.08 * weight * raised_cosine_envelope(t, 0.12, 0.05)
        });
    }
}

/// A compressor on 50 Hz mains: even harmonics, and a little air.
pub(super) fn fridge(canvas: &mut LoopBuilder) {
    for (frequency_hz, amplitude) in [
        (50.0, 0.5),
        (100.0, 1.0),
        (150.0, 0.2),
        (200.0, 0.45),
        (300.0, 0.2),
        (400.0, 0.12),
    ] {
        canvas.add_continuous_tone(frequency_hz, amplitude);
    }
    let air = canvas.shaped_noise("air", |f| resonance_gain(f, 250.0, 500.0));
    canvas.add_to_loop(&air, 0.15);
}

/// Harmonics of 100 Hz, as a transformer on 50 Hz mains gives them.
pub(super) fn hum(canvas: &mut LoopBuilder) {
    for harmonic in 1..=8 {
        canvas.add_continuous_tone(100.0 * f64::from(harmonic), 1.0 / f64::from(harmonic));
    }
}

/// The rush of heating water, and bubbles that pop at random.
pub(super) fn kettle(canvas: &mut LoopBuilder) {
    let rush = canvas.shaped_noise("rush", |f| {
        resonance_gain(f, 700.0, 900.0) + 0.3 * resonance_gain(f, 2500.0, 3000.0)
    });
    canvas.add_to_loop(&rush, 1.0);
    bubbles(canvas, 240, (350.0, 1400.0), 1.2);
}

/// Equal power in every octave from 40 Hz up.
pub(super) fn pink(canvas: &mut LoopBuilder) {
    let noise = canvas.shaped_noise("pink", |f| if f < 40.0 { 0.0 } else { 1.0 / f.sqrt() });
    canvas.add_to_loop(&noise, 1.0);
}

/// 440 and 480 Hz, two seconds on and four off (ANSI/TIA's ringing tone), with the clatter of a bell above.
pub(super) fn phone(canvas: &mut LoopBuilder) {
    for (frequency_hz, amplitude) in [
        (440.0, 1.0),
        (480.0, 1.0),
        (1320.0, 0.5),
        (1440.0, 0.5),
        (2200.0, 0.25),
    ] {
        canvas.add(0.2, 2.0, |t| {
            let shake = 0.6 + 0.4 * libm::sin(TAU * 20.0 * t);
            amplitude
                * shake
                * raised_cosine_envelope(t, 2.0, 0.01)
                * libm::sin(TAU * frequency_hz * t)
        });
    }
}

/// A jet of water on steel: broad noise with a rise at high frequencies, and drops.
pub(super) fn tap(canvas: &mut LoopBuilder) {
    let jet = canvas.shaped_noise("jet", |f| {
        0.5 * resonance_gain(f, 400.0, 500.0) + resonance_gain(f, 3500.0, 5000.0)
    });
    canvas.add_to_loop(&jet, 1.0);
    bubbles(canvas, 400, (500.0, 2600.0), 0.8);
}

/// Four seconds of rushing water, then the hiss of the valve while the cistern fills.
pub(super) fn toilet_flush(canvas: &mut LoopBuilder) {
    let (rush, hiss) = (
        canvas.shaped_noise("rush", |f| {
            resonance_gain(f, 350.0, 500.0) + 0.4 * resonance_gain(f, 1500.0, 2000.0)
        }),
        canvas.shaped_noise("hiss", |f| resonance_gain(f, 3000.0, 3500.0)),
    );
    canvas.add_noise(&rush, 0.2, 4.5, |t| {
        raised_cosine_envelope(t, 4.5, 0.6) * libm::exp(-0.25 * t)
    });
    canvas.add_noise(&hiss, 2.0, 8.5, |t| {
        0.12 * raised_cosine_envelope(t, 8.5, 1.0)
    });
    canvas.add(0.3, 4.0, |t| {
        0.3 * raised_cosine_envelope(t, 4.0, 0.5) * libm::sin(TAU * (90.0 + 8.0 * t) * t)
    });
}

/// A drum that turns 0.8 times a second with wet clothes, a motor, and water.
pub(super) fn washing_machine(canvas: &mut LoopBuilder) {
    let (motor, slosh) = (
        canvas.shaped_noise("motor", |f| resonance_gain(f, 120.0, 80.0)),
        canvas.shaped_noise("slosh", |f| resonance_gain(f, 500.0, 700.0)),
    );
    canvas.add_to_loop(&motor, 0.4);
    for (harmonic, amplitude) in [(1.0, 0.4), (2.0, 0.3), (4.0, 0.15)] {
        canvas.add_continuous_tone(100.0 * harmonic, amplitude);
    }
    let turns = (0.8 * canvas.loop_s()).round();
    let period_s = canvas.loop_s() / turns;
    for turn in 0..turns as usize {
        let start_s = turn as f64 * period_s;
        canvas.add_noise(&slosh, start_s, 0.7, |t| {
            0.9 * raised_cosine_envelope(t, 0.7, 0.3)
        });
        canvas.add_decaying_tone(start_s + 0.35, 62.0, 0.25, 2.0);
    }
}

/// Adds bubbles at random times: short tones that rise a little while they fade.
///
/// # Source
/// K. van den Doel, ACM Trans. Appl. Percept. 2, 534 (2005): a bubble is a decaying sine whose pitch rises.
fn bubbles(canvas: &mut LoopBuilder, count: usize, (low_hz, high_hz): (f64, f64), amplitude: f64) {
    let mut stream = canvas.key.child("bubbles").stream();
    for _ in 0..count {
        let start_s = canvas.loop_s() * stream.uniform();
        let frequency_hz = low_hz * libm::pow(high_hz / low_hz, stream.uniform());
        let size = amplitude * (0.2 + 0.8 * stream.uniform() * stream.uniform());
        let decay = 0.13 * frequency_hz + 0.0072 * libm::pow(frequency_hz, 1.5);
        canvas.add(start_s, (8.0 / decay).min(0.1), |t| {
            let phase = TAU * frequency_hz * (t + 0.05 * decay * t * t);
            size * raised_cosine_rise(t, 0.0008) * libm::exp(-decay * t) * libm::sin(phase)
        });
    }
}
