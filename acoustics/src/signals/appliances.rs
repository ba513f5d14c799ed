//! More appliances, a doorbell, rain.

use super::loop_builder::{
    LoopBuilder, raised_cosine_envelope, raised_cosine_rise, resonance_gain,
};
use std::f64::consts::TAU;

/// Two tones a major third apart, struck bars with their first two overtones; once in six seconds.
pub(super) fn doorbell(canvas: &mut LoopBuilder) {
    for (start_s, frequency_hz) in [(0.1, 659.3), (0.75, 523.3)] {
        // A free bar's modes: 1, 2.76, 5.40.
        for (ratio, decay_s, amplitude) in [(1.0, 1.6, 1.0), (2.756, 0.7, 0.3), (5.404, 0.25, 0.15)]
        {
            canvas.add_decaying_tone(start_s, frequency_hz * ratio, decay_s, amplitude);
        }
    }
}

/// The transformer's hum, the fan and the slow turning of the plate.
pub(super) fn microwave(canvas: &mut LoopBuilder) {
    for (frequency_hz, amplitude) in [
        (100.0, 1.0),
        (200.0, 0.8),
        (300.0, 0.5),
        (400.0, 0.35),
        (600.0, 0.2),
    ] {
        canvas.add_continuous_tone(frequency_hz, amplitude);
    }
    let fan = canvas.shaped_noise("fan", |f| resonance_gain(f, 350.0, 700.0));
    let loop_s = canvas.loop_s();
    canvas.add_noise(&fan, 0.0, loop_s, |t| {
        0.8 + 0.15 * libm::cos(TAU * t / loop_s)
    });
}

/// Drops that fall everywhere at once, and some that are heard one by one on a sill.
pub(super) fn rain(canvas: &mut LoopBuilder) {
    let wash = canvas.shaped_noise("wash", |f| {
        0.6 * resonance_gain(f, 900.0, 1500.0) + resonance_gain(f, 5000.0, 9000.0)
    });
    canvas.add_to_loop(&wash, 1.0);
    let mut stream = canvas.key.child("drops").stream();
    for _ in 0..240 {
        let start_s = canvas.loop_s() * stream.uniform();
        let frequency_hz = 700.0 * libm::pow(6.0, stream.uniform());
        let size = 2.5 * stream.uniform() * stream.uniform() * stream.uniform();
        canvas.add_decaying_tone(start_s, frequency_hz, 0.02 + 0.03 * stream.uniform(), size);
    }
}

/// A universal motor at 30,000 turns a minute with nine blades, and much air.
pub(super) fn vacuum_cleaner(canvas: &mut LoopBuilder) {
    let (air, body) = (
        canvas.shaped_noise("air", |f| resonance_gain(f, 2200.0, 4500.0)),
        canvas.shaped_noise("body", |f| resonance_gain(f, 450.0, 500.0)),
    );
    canvas.add_to_loop(&air, 1.0);
    canvas.add_to_loop(&body, 0.7);
    for (frequency_hz, amplitude) in [(500.0, 0.5), (1000.0, 0.25), (4500.0, 0.45), (100.0, 0.3)] {
        canvas.add_continuous_tone(frequency_hz, amplitude);
    }
}

/// Air through a hot nozzle: noise with a strong blade tone.
pub(super) fn hair_dryer(canvas: &mut LoopBuilder) {
    let air = canvas.shaped_noise("air", |f| resonance_gain(f, 1500.0, 2500.0));
    canvas.add_to_loop(&air, 1.0);
    for (frequency_hz, amplitude) in [(250.0, 0.3), (1750.0, 0.5), (3500.0, 0.2)] {
        canvas.add_continuous_tone(frequency_hz, amplitude);
    }
}

/// Arms of water that sweep past, and a pump.
pub(super) fn dishwasher(canvas: &mut LoopBuilder) {
    let (water, pump) = (
        canvas.shaped_noise("water", |f| resonance_gain(f, 700.0, 1200.0)),
        canvas.shaped_noise("pump", |f| resonance_gain(f, 180.0, 150.0)),
    );
    canvas.add_to_loop(&pump, 0.5);
    canvas.add_continuous_tone(100.0, 0.3);
    canvas.add_continuous_tone(300.0, 0.15);
    let turns = (0.5 * canvas.loop_s()).round().max(1.0);
    let period_s = canvas.loop_s() / turns;
    for turn in 0..turns as usize {
        let start_s = turn as f64 * period_s;
        canvas.add_noise(&water, start_s, period_s, |t| {
            0.35 + 0.65
                * raised_cosine_envelope(t, period_s, 0.5 * period_s)
                * raised_cosine_rise(t, 0.2)
        });
    }
}
