//! Error of the air temperature.

use super::{AcousticLaw, PathEffects, SignalStage};
use dwell_scene::law::{EngineKind, LawRegime, ParamInfo};
use dwell_scene::{LawInfo, LawValues};

pub(super) const LAW: AcousticLaw = AcousticLaw {
    info: LawInfo {
        id: "temperature_error",
        version: 1,
        name: "error of the air's temperature",
        equation: "T = T_stated + offset_k, within -40 to 60 degrees Celsius; the speed of sound 343.2 sqrt(T / 293.15 K) m/s and \
                   the absorption of air follow",
        source: "ISO 9613-1:1993, equations (A.5) and (3) to (6)",
        engine: EngineKind::Acoustics,
        acts_on: "world",
        params: &[ParamInfo {
            name: "offset_k",
            unit: "K",
            default: 0.0,
            low: -60.0,
            high: 60.0,
            plausible: [-10.0, 10.0],
        }],
        regimes: &[
            LawRegime::DirectSound,
            LawRegime::EarlySound,
            LawRegime::LateSound,
        ],
        probes: &[&[("offset_k", 5.0)]],
        rivals: &["clock_drift", "recording_delay", "room_scale"],
        separating_experiment: "record at two or more distances with the excitation itself on a second channel: arrivals after it \
                                stretch with warmth, in proportion to their time and by 1700 ppm for a kelvin, while the \
                                excitation keeps its length and pitch; a clock stretches both, a delay nothing; a known distance \
                                tells warmth from a wrong size of the room",
    },
    effect: SignalStage::Propagation(apply_temperature_error),
};

fn apply_temperature_error(values: LawValues<'_>, effects: &mut PathEffects) {
    effects.temperature_error_k += values.get("offset_k");
}
