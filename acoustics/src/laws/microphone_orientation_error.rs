//! Orientation error of microphones and heads.

use super::{AcousticLaw, PathEffects, SignalStage, angle};
use dwell_scene::law::{EngineKind, LawRegime};
use dwell_scene::{LawInfo, LawValues};

pub(super) const LAW: AcousticLaw = AcousticLaw {
    info: LawInfo {
        id: "microphone_orientation_error",
        version: 1,
        name: "error of the microphones' orientation",
        equation: "Q = Q_stated R_y(yaw_deg) R_x(pitch_deg) R_z(roll_deg) (degrees: to the left, up, to the left), Q from the receiver's \
                   axes to the house's; heads and arrays turn about their centre, and an omnidirectional microphone hears no difference",
        source: "IEC 60268-4:2018 (microphones), directional pattern",
        engine: EngineKind::Acoustics,
        acts_on: "sensor",
        params: &[
            angle("yaw_deg", 180.0, 30.0),
            angle("pitch_deg", 90.0, 20.0),
            angle("roll_deg", 180.0, 20.0),
        ],
        regimes: &[LawRegime::DirectSound, LawRegime::EarlySound],
        probes: &[&[("yaw_deg", 15.0), ("pitch_deg", 10.0), ("roll_deg", 10.0)]],
        rivals: &[
            "microphone_position_error",
            "source_directivity_error",
            "microphone_response",
        ],
        separating_experiment: "compare from where known sources on two sides are heard: all are turned by the same angles, while times \
                                of arrival and what an omnidirectional microphone hears stay",
    },
    effect: SignalStage::Propagation(add_rotation_error),
};

fn add_rotation_error(values: LawValues<'_>, effects: &mut PathEffects) {
    let names = ["yaw_deg", "pitch_deg", "roll_deg"];
    for (sum, name) in effects.receiver_rotation_deg.iter_mut().zip(names) {
        *sum += values.get(name) as f32;
    }
}
