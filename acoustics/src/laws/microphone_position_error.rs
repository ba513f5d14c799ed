//! Position error of microphones.

use super::{AcousticLaw, PathEffects, SignalStage};
use dwell_scene::law::{EngineKind, LawRegime, ParamInfo};
use dwell_scene::{LawInfo, LawValues};

/// The parameter of the offset along one axis.
const fn offset(name: &'static str) -> ParamInfo {
    ParamInfo {
        name,
        unit: "m",
        default: 0.0,
        low: -2.0,
        high: 2.0,
        plausible: [-0.2, 0.2],
    }
}

pub(super) const LAW: AcousticLaw = AcousticLaw {
    info: LawInfo {
        id: "microphone_position_error",
        version: 1,
        name: "error of the microphones' position",
        equation: "x = x_stated + Q (right_m, up_m, back_m) (m), Q from the receiver's axes to the house's (1 for a single microphone); \
                   heads and arrays move as a whole",
        source: "ISO 3382-1:2009, 4.3 (positions of microphones)",
        engine: EngineKind::Acoustics,
        acts_on: "sensor",
        params: &[offset("right_m"), offset("up_m"), offset("back_m")],
        regimes: &[LawRegime::DirectSound, LawRegime::EarlySound],
        probes: &[&[("right_m", 0.05), ("up_m", 0.05), ("back_m", 0.05)]],
        rivals: &["recording_delay", "temperature_error", "room_scale"],
        separating_experiment: "play from opposite sides of the microphone: what comes later from one side comes earlier from the other, \
                                and all reflections agree with one displacement; a delay is the same from all sides, warmth \
                                proportional to the way",
    },
    effect: SignalStage::Propagation(apply_offset),
};

fn apply_offset(values: LawValues<'_>, effects: &mut PathEffects) {
    let names = ["right_m", "up_m", "back_m"];
    for (sum, name) in effects.receiver_offset_m.iter_mut().zip(names) {
        *sum += values.get(name) as f32;
    }
}
