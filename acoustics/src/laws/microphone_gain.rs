//! Sensitivity error of microphones.

use super::microphone_stage::{MicrophoneStage, SampleBlock, StatelessStage};
use super::{AcousticLaw, SignalStage};
use dwell_scene::law::{EngineKind, LawRegime, ParamInfo};
use dwell_scene::{LawInfo, LawValues};

pub(super) const LAW: AcousticLaw = AcousticLaw {
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
        regimes: &[
            LawRegime::DirectSound,
            LawRegime::EarlySound,
            LawRegime::LateSound,
            LawRegime::NoiseFloor,
        ],
        probes: &[&[("gain_db", 2.0)]],
        rivals: &["source_gain", "distance", "automatic_gain"],
        separating_experiment: "compare levels at several positions, at two levels of the source, and with all sources off: a gain is \
                                the same number of decibels at all times, bands, places and levels; that of a microphone raises \
                                background noise too, that of a source does not",
    },
    effect: SignalStage::Microphones(install),
};

fn install(values: LawValues<'_>, _rate_hz: f64) -> Box<dyn MicrophoneStage> {
    let gain = libm::pow(10.0, values.get("gain_db") / 20.0) as f32;
    Box::new(StatelessStage(move |block: &mut SampleBlock<'_>| {
        for x in block.samples.iter_mut() {
            *x *= gain;
        }
    }))
}
