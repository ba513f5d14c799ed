//! Error of the air's humidity.

use super::{AcousticLaw, PathEffects, SignalStage};
use dwell_scene::law::{EngineKind, LawRegime, ParamInfo};
use dwell_scene::{LawInfo, LawValues};

pub(super) const LAW: AcousticLaw = AcousticLaw {
    info: LawInfo {
        id: "humidity_error",
        version: 1,
        name: "error of the air's humidity",
        equation: "h = h_stated + offset_pct, within 0 to 100 % relative humidity; the absorption of air follows, and the speed of \
                   sound stays",
        source: "ISO 9613-1:1993, equations (3) to (6), (B.1)",
        engine: EngineKind::Acoustics,
        acts_on: "world",
        params: &[ParamInfo {
            name: "offset_pct",
            unit: "%",
            default: 0.0,
            low: -100.0,
            high: 100.0,
            plausible: [-45.0, 45.0],
        }],
        regimes: &[
            LawRegime::DirectSound,
            LawRegime::EarlySound,
            LawRegime::LateSound,
        ],
        probes: &[&[("offset_pct", -20.0)], &[("offset_pct", 20.0)]],
        rivals: &["no_air_absorption", "temperature_error", "absorption"],
        separating_experiment: "compare the direct sound at 2 m and at 8 m: air takes decibels for every metre, most in the highest \
                                octaves, where surfaces take them for every reflection; a hygrometer tells dryness from warmth",
    },
    effect: SignalStage::Propagation(apply_humidity_error),
};

fn apply_humidity_error(values: LawValues<'_>, effects: &mut PathEffects) {
    effects.humidity_error_pct += values.get("offset_pct");
}
