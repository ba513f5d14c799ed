//! Spectrum error of sources.

use super::{AcousticLaw, BAND_DB, PathEffects, SignalStage, bands_db};
use dwell_scene::law::{EngineKind, LawRegime};
use dwell_scene::{LawInfo, LawValues};

pub(super) const LAW: AcousticLaw = AcousticLaw {
    info: LawInfo {
        id: "source_response",
        version: 1,
        name: "frequency response of the sources",
        equation: "E_source(f) = 10^(L(f) / 10) E_stated(f), the energy of all paths and of the tail, with L in each octave band its \
                   parameter (dB), the same into all directions; minimum phase, smooth between the bands",
        source: "IEC 60268-21:2018 (output-based measurement of loudspeakers), frequency response; A. V. Oppenheim, R. W. Schafer, \
                 Discrete-Time Signal Processing (2010), section 13.5",
        engine: EngineKind::Acoustics,
        acts_on: "world",
        params: &BAND_DB,
        regimes: &[
            LawRegime::DirectSound,
            LawRegime::EarlySound,
            LawRegime::LateSound,
        ],
        probes: &[&[
            ("db_63", 2.0),
            ("db_125", 2.0),
            ("db_250", 2.0),
            ("db_500", 2.0),
            ("db_1000", 2.0),
            ("db_2000", 2.0),
            ("db_4000", 2.0),
            ("db_8000", 2.0),
        ]],
        rivals: &["microphone_response", "absorption", "no_air_absorption"],
        separating_experiment: "compare direct and late sound at several places: a response is the same number of decibels in both, \
                                absorption grows with time; with all sources off, background noise bears the response of the \
                                microphone and not that of a source",
    },
    effect: SignalStage::Propagation(apply_response),
};

fn apply_response(values: LawValues<'_>, effects: &mut PathEffects) {
    for (sum, db) in effects.source_db.iter_mut().zip(bands_db(values)) {
        *sum += db;
    }
}
