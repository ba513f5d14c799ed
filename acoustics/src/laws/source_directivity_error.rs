//! Orientation and directivity errors of sources.

use super::{AcousticLaw, PathEffects, SignalStage, angle};
use dwell_scene::law::{EngineKind, LawRegime, ParamInfo};
use dwell_scene::{LawInfo, LawValues};

pub(super) const LAW: AcousticLaw = AcousticLaw {
    info: LawInfo {
        id: "source_directivity_error",
        version: 1,
        name: "error of the sources' directivity",
        equation: "D(u, f) = D_stated(R u, f) |D_stated(R u, f)|^sharpness 10^(-beam_db g(f) (1 - cos a) / 40), g(f) = 2 f / (f + 1 kHz): \
                   R takes off the turn by yaw_deg to the left and pitch_deg up, in the source's axes; a is the angle to its axis as \
                   it is, on which the level stays",
        source: "ISO 3382-1:2009, 4.2.1 (directivity of sources); L. L. Beranek, Acoustics (1954), chapter 4: loudspeakers are the \
                 narrower the shorter the wave",
        engine: EngineKind::Acoustics,
        acts_on: "world",
        params: &[
            angle("yaw_deg", 180.0, 45.0),
            angle("pitch_deg", 90.0, 30.0),
            ParamInfo {
                name: "sharpness",
                unit: "1",
                default: 0.0,
                low: -1.0,
                high: 3.0,
                plausible: [-0.7, 1.0],
            },
            ParamInfo {
                name: "beam_db",
                unit: "dB",
                default: 0.0,
                low: -40.0,
                high: 40.0,
                plausible: [0.0, 15.0],
            },
        ],
        regimes: &[LawRegime::DirectSound, LawRegime::EarlySound],
        probes: &[&[("yaw_deg", 20.0), ("pitch_deg", 5.0), ("beam_db", 3.0)]],
        rivals: &["source_gain", "source_response", "absorption"],
        separating_experiment: "turn the source on the spot: the direct sound and the first reflections change by other decibels than \
                                stated for each turn, high octaves most, late sound hardly; a gain or a response changes by the \
                                same for all turns",
    },
    effect: SignalStage::Propagation(apply_directivity_error),
};

fn apply_directivity_error(values: LawValues<'_>, effects: &mut PathEffects) {
    effects.source_rotation_deg[0] += values.get("yaw_deg") as f32;
    effects.source_rotation_deg[1] += values.get("pitch_deg") as f32;
    effects.source_sharpness += values.get("sharpness") as f32;
    effects.source_beam_db += values.get("beam_db") as f32;
}
