//! Self-noise of microphones.

use super::microphone_stage::{MicrophoneStage, SampleBlock, StatelessStage};
use super::{AcousticLaw, SignalStage};
use dwell_scene::law::{EngineKind, LawRegime, ParamInfo};
use dwell_scene::{LawInfo, LawValues};

pub(super) const LAW: AcousticLaw = AcousticLaw {
    info: LawInfo {
        id: "microphone_noise",
        version: 1,
        name: "self-noise of the microphones",
        equation: "p_out = p + w, w white and normal with standard deviation sigma_pa (Pa), independent in every sample and channel",
        source: "IEC 60268-4:2018, clause 17 (equivalent sound pressure due to inherent noise)",
        engine: EngineKind::Acoustics,
        acts_on: "sensor",
        params: &[ParamInfo {
            name: "sigma_pa",
            unit: "Pa",
            default: 0.0,
            low: 0.0,
            high: 10.0,
            // 10 to 40 dB SPL.
            plausible: [6.3e-5, 2e-3],
        }],
        regimes: &[LawRegime::NoiseFloor],
        probes: &[&[("sigma_pa", 0.0003)]],
        rivals: &["background_noise", "second_slope"],
        separating_experiment: "record with all sources off, then move the microphone: self-noise is the same everywhere and \
                                unlike in two microphones, background noise is neither; play the same sound louder: a \
                                second slope of the decay rises with it, noise does not",
    },
    effect: SignalStage::Microphones(install),
};

fn install(values: LawValues<'_>, _rate_hz: f64) -> Box<dyn MicrophoneStage> {
    let sigma = values.get("sigma_pa");
    Box::new(StatelessStage(move |block: &mut SampleBlock<'_>| {
        let mut stream = block.key.stream();
        for sample in block.samples.iter_mut() {
            *sample += (sigma * stream.normal()) as f32;
        }
    }))
}

#[cfg(test)]
mod tests {
    use super::super::testing::{law, microphone_output};

    /// Variance within 5 standard errors (two-sided p below 1e-6) for five seeds; two equal noises add their powers.
    #[test]
    fn the_noise_has_its_power() {
        let noise = law("microphone_noise", &[("sigma_pa", 0.02)]);
        for seed in 0..5 {
            for (laws, variance) in [
                (vec![noise.clone()], 4e-4),
                (vec![noise.clone(), noise.clone()], 8e-4),
            ] {
                let out = microphone_output(&laws, seed, &vec![0.0; 20_000]);
                let found = out.iter().map(|x| f64::from(*x).powi(2)).sum::<f64>() / 20_000.0;
                assert!((found / variance - 1.0).abs() < 5.0 * (2.0 / 20_000.0_f64).sqrt());
            }
        }
    }
}
