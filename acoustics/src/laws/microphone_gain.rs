//! Microphones that are more sensitive than they are said to be.

use super::stage::{Block, Each, Stage};
use super::{Acts, Law, Values};
use dwell_scene::LawInfo;
use dwell_scene::law::{EngineKind, ParamInfo};

pub(super) const LAW: Law = Law {
    info: LawInfo {
        id: "microphone_gain",
        version: 1,
        name: "gain of the microphones",
        equation: "p_out = 10^(gain_db / 20) p (Pa), for all microphones",
        source: "IEC 60268-4:2018 (microphones), sensitivity",
        engine: EngineKind::Acoustics,
        acts_on: "sensor",
        params: &[ParamInfo {
            name: "gain_db",
            unit: "dB",
            default: 0.0,
            low: -120.0,
            high: 120.0,
            plausible: [-20.0, 20.0],
        }],
        rivals: &["source_gain", "distance", "automatic_gain"],
        separating_experiment: "compare levels at several positions, at two levels of the source, and with all sources off: a gain is \
                                the same number of decibels at all times, bands, places and levels; that of a microphone raises \
                                background noise too, that of a source does not",
    },
    acts: Acts::Microphones(install),
};

fn install(values: Values<'_>, _rate_hz: f64) -> Box<dyn Stage> {
    let gain = libm::pow(10.0, values.get("gain_db") / 20.0) as f32;
    Box::new(Each(move |block: &mut Block<'_>| {
        for x in block.samples.iter_mut() {
            *x *= gain;
        }
    }))
}
