//! Clipping of microphones.

use super::microphone_stage::{MicrophoneStage, SampleBlock, StatelessStage};
use super::{AcousticLaw, SignalStage};
use dwell_scene::law::{EngineKind, LawRegime, ParamInfo};
use dwell_scene::{LawInfo, LawValues};

pub(super) const LAW: AcousticLaw = AcousticLaw {
    info: LawInfo {
        id: "microphone_clipping",
        version: 1,
        name: "clipping of the microphones",
        equation: "p_out = sign(p) g(|p|), with g(x) = x up to the knee k = (1 - softness) limit_pa (Pa), and beyond it \
                   k + (limit_pa - k) tanh((x - k) / (limit_pa - k)); softness 0 is a hard clip at limit_pa, 1 bends from the start",
        source: "IEC 60268-4:2018 (microphones), overload sound pressure; U. Zoelzer (ed.), DAFX: Digital Audio Effects (2011), \
                 section 4.3",
        engine: EngineKind::Acoustics,
        acts_on: "sensor",
        params: &[
            ParamInfo {
                name: "limit_pa",
                unit: "Pa",
                default: 1e6,
                low: 1e-5,
                high: 1e6,
                // 94 to 140 dB SPL, peak.
                plausible: [1.0, 300.0],
            },
            ParamInfo {
                name: "softness",
                unit: "1",
                default: 0.0,
                low: 0.0,
                high: 1.0,
                plausible: [0.0, 1.0],
            },
        ],
        regimes: &[LawRegime::DirectSound, LawRegime::EarlySound],
        probes: &[
            &[("limit_pa", 1.0)],
            &[("limit_pa", 0.3)],
            &[("limit_pa", 0.1)],
        ],
        rivals: &["automatic_gain", "absorption", "microphone_gain"],
        separating_experiment: "play the same sound at two levels: a clip changes only what is loud, within a period, and adds harmonics \
                                (of an exponential sweep they stand before time 0); automatic gain changes whole passages, all others \
                                do not depend on the level",
    },
    effect: SignalStage::Microphones(install),
};

fn install(values: LawValues<'_>, _rate_hz: f64) -> Box<dyn MicrophoneStage> {
    let limit = values.get("limit_pa") as f32;
    let knee = limit * (1.0 - values.get("softness") as f32);
    let room = limit - knee;
    Box::new(StatelessStage(move |block: &mut SampleBlock<'_>| {
        for x in block.samples.iter_mut() {
            let size = x.abs();
            if size > knee {
                let bent = if room > 0.0 {
                    knee + room * libm::tanhf((size - knee) / room)
                } else {
                    limit
                };
                *x = bent.copysign(*x);
            }
        }
    }))
}

#[cfg(test)]
mod tests {
    use super::super::testing::{law, microphone_output};

    #[test]
    fn it_bends_as_its_equation_says() {
        let clip = |limit: f64, softness: f64, x: f32| {
            let values = [("limit_pa", limit), ("softness", softness)];
            microphone_output(&[law("microphone_clipping", &values)], 0, &[x])[0]
        };
        for x in [-3.0, -0.5, 0.0, 0.2, 0.999, 1.001, 7.0_f32] {
            assert_eq!(clip(1.0, 0.0, x), x.clamp(-1.0, 1.0));
            assert!((clip(2.0, 1.0, x) - 2.0 * (x / 2.0).tanh()).abs() < 1e-6);
        }
        // Half soft: linear up to the knee, below the limit beyond it, without a kink.
        assert_eq!(clip(1.0, 0.5, 0.5), 0.5);
        assert!((clip(1.0, 0.5, 0.51) - 0.51).abs() < 1e-4);
        assert!((clip(1.0, 0.5, -1.0) + (0.5 + 0.5 * 1.0_f32.tanh())).abs() < 1e-6);
        assert!(clip(1.0, 0.5, 100.0) <= 1.0);
    }
}
