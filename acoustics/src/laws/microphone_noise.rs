//! The noise that a microphone adds of itself.

use super::{Acts, Law};
use dwell_scene::law::{Engine, ParamInfo};
use dwell_scene::random::Key;
use dwell_scene::{LawInfo, LawSpec};

pub(super) const LAW: Law = Law {
    info: LawInfo {
        id: "microphone_noise",
        version: 1,
        name: "self-noise of the microphones",
        equation: "p_out = p + w, w white and normal with standard deviation sigma_pa (Pa), independent in every sample and channel",
        source: "IEC 60268-4:2018, clause 17 (equivalent sound pressure due to inherent noise)",
        engine: Engine::Acoustics,
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
        rivals: &["background_noise", "second_slope"],
        separating_experiment: "record with all sources off, then move the microphone: self-noise is the same everywhere and \
                                unlike in two microphones, background noise is neither; play the same sound louder: a \
                                second slope of the decay rises with it, noise does not",
    },
    acts: Acts::Microphones(add),
};

fn add(spec: &LawSpec, info: &LawInfo, key: Key, block: &mut [f32]) {
    let sigma = spec.value(info, "sigma_pa").unwrap_or(0.0);
    let mut stream = key.stream();
    for sample in block {
        *sample += (sigma * stream.normal()) as f32;
    }
}

#[cfg(test)]
mod tests {
    use super::super::at_microphones;
    use super::*;
    use std::collections::BTreeMap;

    fn law(sigma_pa: f64) -> LawSpec {
        LawSpec {
            id: LAW.info.id.to_owned(),
            version: 1,
            target: None,
            params: BTreeMap::from([("sigma_pa".to_owned(), sigma_pa)]),
        }
    }

    #[test]
    fn nothing_changes_unless_it_is_installed() {
        let before = [0.1_f32, -0.2, 0.3];
        for laws in [vec![], vec![law(0.0)]] {
            let mut out = before;
            at_microphones(&laws, Key::root(1), &mut out);
            assert_eq!(out.map(f32::to_bits), before.map(f32::to_bits));
        }
    }

    /// Variance within 5 standard errors for five seeds; two equal noises add their powers.
    #[test]
    fn the_noise_has_its_power() {
        for seed in 0..5 {
            for (laws, variance) in [(vec![law(0.02)], 4e-4), (vec![law(0.02), law(0.02)], 8e-4)] {
                let mut out = vec![0.0; 20_000];
                at_microphones(&laws, Key::root(seed), &mut out);
                let found = out.iter().map(|x| f64::from(*x).powi(2)).sum::<f64>() / 20_000.0;
                assert!((found / variance - 1.0).abs() < 5.0 * (2.0 / 20_000.0_f64).sqrt());
            }
        }
    }
}
