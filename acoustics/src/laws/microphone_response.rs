//! Frequency response of microphones.

use super::fir::FirFilter;
use super::microphone_stage::MicrophoneStage;
use super::{AcousticLaw, BAND_DB, SignalStage, bands_db};
use crate::minimum_phase::MinimumPhaseDesigner;
use dwell_scene::law::{EngineKind, LawRegime};
use dwell_scene::{LawInfo, LawValues};

/// Duration of the transform, s: the lowest band is as wide as its inverse.
const SPAN_S: f64 = 0.064;

pub(super) const LAW: AcousticLaw = AcousticLaw {
    info: LawInfo {
        id: "microphone_response",
        version: 1,
        name: "frequency response of the microphones",
        equation: "p_out = h * p, h of minimum phase with the level L(f) (dB): in each octave band's centre its parameter, between two \
                   centres a raised cosine of log f, constant beyond the lowest and the highest",
        source: "IEC 60268-4:2018 (microphones), frequency response; A. V. Oppenheim, R. W. Schafer, Discrete-Time Signal Processing \
                 (2010), section 13.5",
        engine: EngineKind::Acoustics,
        acts_on: "sensor",
        params: &BAND_DB,
        regimes: &[
            LawRegime::DirectSound,
            LawRegime::EarlySound,
            LawRegime::LateSound,
            LawRegime::NoiseFloor,
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
        rivals: &["source_response", "absorption", "no_air_absorption"],
        separating_experiment: "compare direct and late sound at several places: a response is the same number of decibels in both, \
                                absorption grows with time; with all sources off, background noise bears the response of the \
                                microphone and not that of a source",
    },
    effect: SignalStage::Microphones(install),
};

fn install(values: LawValues<'_>, rate_hz: f64) -> Box<dyn MicrophoneStage> {
    let filters = MinimumPhaseDesigner::with_min_span(rate_hz, SPAN_S);
    let energy = bands_db(values).map(|db| libm::powf(10.0, db / 10.0));
    let (mut spectrum, amplitude) = filters.spectrum(&energy, None);
    let taps = filters.impulse_response(&mut filters.fft(), &mut spectrum);
    let taps = taps.into_iter().map(|x| amplitude * x).collect();
    Box::new(FirFilter::new(0, taps))
}

#[cfg(test)]
mod tests {
    use super::super::testing::{RATE_HZ, law, microphone_output};
    use crate::bands::exact_centre_hz;
    use realfft::num_complex::Complex;

    /// The response of an impulse has the requested levels at the bands' centres, within 0.3 dB (half a decibel in the
    /// lowest band, which is as narrow as the filter is long).
    #[test]
    fn bands_have_their_levels() {
        let names = [
            "db_63", "db_125", "db_250", "db_500", "db_1000", "db_2000", "db_4000", "db_8000",
        ];
        let wanted = [-9.0, -3.0, 0.0, 4.0, -6.0, -6.0, 3.0, -12.0];
        let values: Vec<_> = names.into_iter().zip(wanted).collect();
        let out = microphone_output(&[law("microphone_response", &values)], 0, &[1.0]);
        for (band, wanted) in wanted.iter().enumerate() {
            let frequency_hz = exact_centre_hz(band);
            let omega = std::f64::consts::TAU * frequency_hz / RATE_HZ;
            let parts = out.iter().enumerate();
            let sum: Complex<f64> = parts
                .map(|(k, x)| Complex::from_polar(f64::from(*x), -omega * k as f64))
                .sum();
            let found = 20.0 * sum.norm().log10();
            let allowed = if band == 0 { 0.5 } else { 0.3 };
            assert!(
                (found - wanted).abs() < allowed,
                "{frequency_hz}: {found} {wanted}"
            );
        }
        // Minimum phase: nearly all energy comes within 2 ms.
        let energy = |x: &[f32]| x.iter().map(|x| x * x).sum::<f32>();
        assert!(energy(&out[..32]) > 0.95 * energy(&out));
    }
}
