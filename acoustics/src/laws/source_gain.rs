//! Level error of sources.

use super::{AcousticLaw, PathEffects, SignalStage};
use dwell_scene::law::{EngineKind, LawRegime, ParamInfo};
use dwell_scene::{LawInfo, LawValues};

pub(super) const LAW: AcousticLaw = AcousticLaw {
    info: LawInfo {
        id: "source_gain",
        version: 1,
        name: "gain of the sources",
        equation: "p_source = 10^(gain_db / 20) p_stated, at 1 m (Pa), for all sources",
        source: "ISO 3382-1:2009, A.2.1: the strength G needs a source of known power",
        engine: EngineKind::Acoustics,
        acts_on: "world",
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
        ],
        probes: &[&[("gain_db", 2.0)]],
        rivals: &["microphone_gain", "distance", "source_directivity_error"],
        separating_experiment: "compare levels at several positions, and with all sources off: a gain is the same number of decibels \
                                at all times, bands and places, a wrong distance is not; the gain of a microphone raises background \
                                noise too, that of a source does not",
    },
    effect: SignalStage::Propagation(apply_gain),
};

fn apply_gain(values: LawValues<'_>, effects: &mut PathEffects) {
    for db in &mut effects.source_db {
        *db += values.get("gain_db") as f32;
    }
}
