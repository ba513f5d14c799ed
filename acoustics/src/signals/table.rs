//! All signals, by name.

use super::loop_builder::LoopBuilder;
use super::{SignalInfo, appliances, household, music, speech, test_signals};

const fn signal_row(
    name: &'static str,
    description: &'static str,
    loop_s: f64,
    (usual_level_db, level_source): (f32, &'static str),
    paint: fn(&mut LoopBuilder),
) -> SignalInfo {
    SignalInfo {
        name,
        description,
        loop_s,
        typical_level_db: usual_level_db,
        level_source,
        paint,
    }
}

/// By name. Levels are root mean squares over the whole loop, pauses included.
pub(super) const ALL: [SignalInfo; 26] = [
    signal_row(
        "alarm",
        "a smoke alarm: three beeps and a pause",
        4.0,
        (
            85.0,
            "EN 14604: at least 85 dB(A) at 3 m asked for, taken at 1 m so that ears are spared",
        ),
        household::alarm,
    ),
    signal_row(
        "babble",
        "many voices at once, without words",
        12.0,
        (
            65.0,
            "six talkers of 57 to 60 dB at 1 m (ANSI S3.5-1997: normal speech 62 dB)",
        ),
        speech::babble,
    ),
    signal_row(
        "clock",
        "a clock that ticks every second",
        2.0,
        (35.0, "estimate: ticks of 50 dB, a tenth of the time"),
        household::clock,
    ),
    signal_row(
        "dishwasher",
        "a dishwasher: water that sweeps, a pump",
        8.0,
        (
            42.0,
            "sound power on EU energy labels less 8 dB to 1 m over a floor",
        ),
        appliances::dishwasher,
    ),
    signal_row(
        "doorbell",
        "a chime of two bars, once in six seconds",
        6.0,
        (68.0, "makers' figures: 80 dB at 1 m while it strikes"),
        appliances::doorbell,
    ),
    signal_row(
        "fan",
        "a fan or a hood: broad noise with a blade tone",
        4.0,
        (55.0, "EU labels of hoods, middle step: 63 dB(A) of power"),
        household::fan,
    ),
    signal_row(
        "footsteps",
        "steps of a walking person",
        4.0,
        (55.0, "estimate, as of `FootstepSound` on wood"),
        household::footsteps,
    ),
    signal_row(
        "fridge",
        "the hum of a compressor",
        4.0,
        (
            40.0,
            "EU labels: up to 41 dB(A) of power; most of it below 200 Hz, where A weighting takes off",
        ),
        household::fridge,
    ),
    signal_row(
        "hair_dryer",
        "a hair dryer: hot air with a blade tone",
        4.0,
        (72.0, "makers' figures: 75 to 85 dB(A) of power"),
        appliances::hair_dryer,
    ),
    signal_row(
        "hum",
        "mains hum of a transformer",
        2.0,
        (35.0, "estimate"),
        household::hum,
    ),
    signal_row(
        "impulse",
        "one sample a second, for measuring",
        1.0,
        (70.0, "as is asked for"),
        test_signals::impulse,
    ),
    signal_row(
        "kettle",
        "water that heats up",
        4.0,
        (
            60.0,
            "estimate after measured kettles, 55 to 70 dB(A) at 1 m",
        ),
        household::kettle,
    ),
    signal_row(
        "microwave",
        "a microwave oven: hum and fan",
        4.0,
        (55.0, "makers' figures: 50 to 60 dB(A) at 1 m"),
        appliances::microwave,
    ),
    signal_row(
        "noise",
        "pink noise, for measuring",
        4.0,
        (70.0, "as is asked for"),
        household::pink,
    ),
    signal_row(
        "phone",
        "a telephone that rings two seconds of six",
        6.0,
        (75.0, "estimate: 80 dB while it rings"),
        household::phone,
    ),
    signal_row(
        "radio",
        "music with a beat",
        16.0,
        (
            65.0,
            "ITU-R BS.1116 listens at 78 dB(A) and more; at home some 13 dB less",
        ),
        music::radio,
    ),
    signal_row(
        "rain",
        "rain on leaves and a sill",
        8.0,
        (55.0, "estimate: moderate rain, 50 dB(A)"),
        appliances::rain,
    ),
    signal_row(
        "sine",
        "a tone of 1 kHz, for measuring",
        1.0,
        (70.0, "as is asked for"),
        test_signals::sine,
    ),
    signal_row(
        "speech",
        "one voice without words",
        8.0,
        (62.0, "ANSI S3.5-1997: normal speech, 62.35 dB at 1 m"),
        speech::speech,
    ),
    signal_row(
        "sweep",
        "an exponential sweep and a pause, for measuring",
        4.0,
        (70.0, "as is asked for"),
        test_signals::sweep,
    ),
    signal_row(
        "tap",
        "water that runs into a sink",
        4.0,
        (
            60.0,
            "estimate after ISO 3822 taps of class II, 30 dB behind a wall",
        ),
        household::tap,
    ),
    signal_row(
        "television",
        "two voices over music",
        16.0,
        (62.0, "as speech"),
        speech::television,
    ),
    signal_row(
        "toilet_flush",
        "a cistern that empties and fills again",
        12.0,
        (70.0, "estimate: 75 dB(A) while it empties"),
        household::toilet_flush,
    ),
    signal_row(
        "vacuum_cleaner",
        "a vacuum cleaner: air, motor, blades",
        4.0,
        (
            70.0,
            "EU label 665/2013: at most 80 dB(A) of power, usually 76 to 78, less 8 dB to 1 m over a floor",
        ),
        appliances::vacuum_cleaner,
    ),
    signal_row(
        "washing_machine",
        "a washing machine: drum, motor, water",
        6.0,
        (
            58.0,
            "EU labels, washing: 50 to 62 dB(A) of power, most of it below 500 Hz",
        ),
        household::washing_machine,
    ),
    signal_row(
        "white",
        "white noise, for measuring",
        4.0,
        (70.0, "as is asked for"),
        test_signals::white,
    ),
];
