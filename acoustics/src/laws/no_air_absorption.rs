//! Reduced absorption by air.

use super::{AcousticLaw, PathEffects, SignalStage};
use dwell_scene::law::{EngineKind, LawRegime, ParamInfo};
use dwell_scene::{LawInfo, LawValues};

pub(super) const LAW: AcousticLaw = AcousticLaw {
    info: LawInfo {
        id: "no_air_absorption",
        version: 1,
        name: "air absorption left out",
        equation: "m = (1 - missing) m_air, with m_air the energy decay in air (1/m) by temperature, humidity and pressure: over \
                   d metres exp(-m d) of the energy is left",
        source: "ISO 9613-1:1993, equations (3) to (6)",
        engine: EngineKind::Acoustics,
        acts_on: "world",
        params: &[ParamInfo {
            name: "missing",
            unit: "1",
            default: 0.0,
            low: 0.0,
            high: 1.0,
            plausible: [0.0, 1.0],
        }],
        regimes: &[
            LawRegime::DirectSound,
            LawRegime::EarlySound,
            LawRegime::LateSound,
        ],
        probes: &[&[("missing", 0.5)]],
        rivals: &["absorption", "source_response", "microphone_response"],
        separating_experiment: "compare the direct sound at 2 m and at 8 m: air takes decibels for every metre, more the higher the \
                                frequency, where surfaces take them for every reflection and responses take as many at any \
                                distance; or record at two humidities",
    },
    effect: SignalStage::Propagation(omit_air_absorption),
};

fn omit_air_absorption(values: LawValues<'_>, effects: &mut PathEffects) {
    effects.air_absorption *= 1.0 - values.get("missing");
}
