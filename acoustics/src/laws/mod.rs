//! Effects on sound that the basic model lacks: one file and one line each.
//!
//! Laws of air, of sources and of microphones' poses change the energies between the two (`PathEffects`); other microphone
//! laws change pressure, block by block in a stream and at once in an impulse response (`MicrophoneStage`). A law at its
//! default is not installed, so that no bit changes.

mod automatic_gain;
mod background_noise;
mod clock_drift;
mod fir;
mod humidity_error;
mod microphone_clipping;
mod microphone_gain;
mod microphone_noise;
mod microphone_orientation_error;
mod microphone_position_error;
mod microphone_response;
pub(crate) mod microphone_stage;
mod no_air_absorption;
mod path_effects;
mod recording_delay;
mod source_directivity_error;
mod source_gain;
mod source_response;
mod temperature_error;
#[cfg(test)]
mod testing;

pub(crate) use path_effects::PathEffects;

use crate::bands::{BAND_COUNT, BandValues};
use dwell_scene::law::{Law, LawRegistry, ParamInfo};
use dwell_scene::{LawInfo, LawSpec, LawValues};
use microphone_stage::MicrophoneStage;

/// A law of this engine.
type AcousticLaw = Law<SignalStage>;

/// The stage at which a law acts.
enum SignalStage {
    /// On air, on sources, and on where receivers are.
    Propagation(fn(LawValues<'_>, &mut PathEffects)),
    /// On the pressure at microphones, before all laws of microphones, at so many samples a second.
    Field(fn(LawValues<'_>, f64) -> Box<dyn MicrophoneStage>),
    /// On what microphones give out, in the order in which laws were installed.
    Microphones(fn(LawValues<'_>, f64) -> Box<dyn MicrophoneStage>),
}

/// The laws of this engine.
static LAWS: LawRegistry<SignalStage> = LawRegistry::new(&[
    temperature_error::LAW,
    humidity_error::LAW,
    no_air_absorption::LAW,
    source_gain::LAW,
    source_response::LAW,
    source_directivity_error::LAW,
    microphone_position_error::LAW,
    microphone_orientation_error::LAW,
    background_noise::LAW,
    microphone_gain::LAW,
    microphone_response::LAW,
    microphone_noise::LAW,
    microphone_clipping::LAW,
    automatic_gain::LAW,
    recording_delay::LAW,
    clock_drift::LAW,
]);

/// Returns the descriptions of all laws of sound.
///
/// ```
/// assert!(dwell_acoustics::laws::all().any(|law| law.id == "microphone_noise"));
/// ```
pub fn all() -> impl Iterator<Item = &'static LawInfo> + Clone {
    LAWS.infos()
}

/// An angle of up to `most` degrees to either side.
const fn angle(name: &'static str, most: f64, plausible: f64) -> ParamInfo {
    ParamInfo {
        name,
        unit: "degree",
        default: 0.0,
        low: -most,
        high: most,
        plausible: [-plausible, plausible],
    }
}

/// A level in decibels for an octave band.
const fn band_db(name: &'static str) -> ParamInfo {
    ParamInfo {
        name,
        unit: "dB",
        default: 0.0,
        low: -60.0,
        high: 60.0,
        plausible: [-12.0, 12.0],
    }
}

/// The parameters of a response: a level in each octave band.
static BAND_DB: [ParamInfo; BAND_COUNT] = [
    band_db("db_63"),
    band_db("db_125"),
    band_db("db_250"),
    band_db("db_500"),
    band_db("db_1000"),
    band_db("db_2000"),
    band_db("db_4000"),
    band_db("db_8000"),
];

/// The values of [`BAND_DB`].
fn bands_db(values: LawValues<'_>) -> BandValues {
    std::array::from_fn(|band| values.get_f32(BAND_DB[band].name))
}

/// Returns the installed laws' effects on air and sources.
pub(crate) fn path_effects(installed: &[LawSpec]) -> PathEffects {
    let mut effects = PathEffects::default();
    for law in LAWS.active(installed) {
        if let SignalStage::Propagation(change) = law.effect {
            change(law.values, &mut effects);
        }
    }
    effects
}

/// Returns the stage of a law that acts on pressure and has an effect.
pub(crate) fn microphone_stage(spec: &LawSpec, rate_hz: f64) -> Option<Box<dyn MicrophoneStage>> {
    let law = LAWS.active(std::slice::from_ref(spec)).next()?;
    match law.effect {
        SignalStage::Propagation(_) => None,
        SignalStage::Field(install) | SignalStage::Microphones(install) => {
            Some(install(law.values, rate_hz))
        }
    }
}

/// Returns the laws with an effect on pressure, with their indices in the list, in the order in which they act.
pub(crate) fn pressure_laws(installed: &[LawSpec]) -> impl Iterator<Item = (u64, &LawSpec)> {
    let those = move |wanted: fn(&SignalStage) -> bool| {
        let acting = LAWS.active(installed).filter(move |law| wanted(law.effect));
        acting.map(|law| (law.index as u64, law.values.spec))
    };
    let fields = those(|acts| matches!(acts, SignalStage::Field(_)));
    fields.chain(those(|acts| matches!(acts, SignalStage::Microphones(_))))
}

#[cfg(test)]
mod tests {
    use super::testing::{RATE_HZ, law, microphone_output, streamed_microphone_output};
    use super::*;

    #[test]
    fn a_law_at_its_default_does_nothing() {
        for info in all() {
            let spec = info.spec(&[]);
            spec.check(info).unwrap();
            assert!(spec.is_default(info) && microphone_stage(&spec, RATE_HZ).is_none());
            let before = [0.1, -0.2, 0.3];
            assert_eq!(
                microphone_output(std::slice::from_ref(&spec), 1, &before),
                before
            );
            assert_eq!(streamed_microphone_output(&[spec], &before, 2), before);
        }
    }

    /// Checks that blocks of any size give the output of a single block.
    #[test]
    fn the_size_of_blocks_does_not_matter() {
        let mut stream = dwell_scene::random::RandomKey::root(3).stream();
        let pressure: Vec<f32> = (0..6000).map(|_| stream.normal() as f32).collect();
        for (id, name, value) in [
            ("microphone_gain", "gain_db", 7.0),
            ("microphone_response", "db_1000", -10.0),
            ("microphone_clipping", "limit_pa", 0.7),
            ("recording_delay", "delay_s", 0.040_07),
            ("automatic_gain", "strength", 0.8),
            ("background_noise", "level_pa", 0.8),
            ("background_noise", "hum_pa", 0.8),
        ] {
            let laws = [law(id, &[(name, value)])];
            let whole = microphone_output(&laws, 0, &pressure);
            for block in [1, 77, 800] {
                for (a, b) in streamed_microphone_output(&laws, &pressure, block)
                    .iter()
                    .zip(&whole)
                {
                    assert!((a - b).abs() < 1e-6, "{id} {block}: {a} {b}");
                }
            }
        }
    }
}
