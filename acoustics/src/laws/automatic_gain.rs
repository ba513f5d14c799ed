//! Automatic gain control of recorders.

use super::microphone_stage::{MicrophoneStage, SampleBlock, StageState};
use super::{AcousticLaw, SignalStage};
use dwell_scene::law::{EngineKind, LawRegime, ParamInfo};
use dwell_scene::{LawInfo, LawValues};

pub(super) const LAW: AcousticLaw = AcousticLaw {
    info: LawInfo {
        id: "automatic_gain",
        version: 1,
        name: "automatic gain control of the microphones",
        equation: "p_out = 10^(g / 20) p, g = clamp(strength (L_target - L), -max_gain_db, max_gain_db) (dB), L = 10 log10 of the \
                   smoothed square s (Pa2), L_target that of target_pa^2; ds/dt = (p^2 - s) / tau, tau = attack_s while p^2 > s, \
                   else release_s; p^2 is the mean over a receiver's channels, which share g; before the first sound s = target_pa^2",
        source: "D. Giannoulis, M. Massberg, J. D. Reiss, Digital dynamic range compressor design, J. Audio Eng. Soc. 60(6), 399 (2012)",
        engine: EngineKind::Acoustics,
        acts_on: "sensor",
        params: &[
            ParamInfo {
                name: "strength",
                unit: "1",
                default: 0.0,
                low: 0.0,
                high: 1.0,
                plausible: [0.2, 1.0],
            },
            ParamInfo {
                name: "target_pa",
                unit: "Pa",
                default: 0.1,
                low: 1e-5,
                high: 100.0,
                // 54 to 94 dB SPL.
                plausible: [0.01, 1.0],
            },
            ParamInfo {
                name: "attack_s",
                unit: "s",
                default: 0.005,
                low: 1e-4,
                high: 10.0,
                plausible: [0.001, 0.1],
            },
            ParamInfo {
                name: "release_s",
                unit: "s",
                default: 0.5,
                low: 1e-3,
                high: 100.0,
                plausible: [0.05, 5.0],
            },
            ParamInfo {
                name: "max_gain_db",
                unit: "dB",
                default: 30.0,
                low: 0.0,
                high: 80.0,
                plausible: [10.0, 40.0],
            },
        ],
        regimes: &[
            LawRegime::DirectSound,
            LawRegime::EarlySound,
            LawRegime::LateSound,
        ],
        probes: &[&[("strength", 0.5)]],
        rivals: &["microphone_clipping", "absorption", "microphone_gain"],
        separating_experiment: "play the same sound at two levels: automatic gain makes the difference smaller, from the beginning of \
                                a passage to its end, and lifts tails that were loud at first; a clip touches only peaks; absorption \
                                and gains do not depend on the level",
    },
    effect: SignalStage::Microphones(install),
};

/// Squares below this are silence, Pa².
const SILENCE: f64 = 1e-24;

#[derive(Debug)]
struct AutomaticGain {
    strength: f64,
    /// Pa².
    target: f64,
    /// Smoothing factors of the squared signal per sample: attack, release.
    pace: [f64; 2],
    most_db: f64,
    /// The smoothed square, Pa².
    square: f64,
}

fn install(values: LawValues<'_>, rate_hz: f64) -> Box<dyn MicrophoneStage> {
    let target = values.get("target_pa") * values.get("target_pa");
    let pace = |name| -libm::expm1(-1.0 / (values.get(name) * rate_hz));
    Box::new(AutomaticGain {
        strength: values.get("strength"),
        target,
        pace: [pace("attack_s"), pace("release_s")],
        most_db: values.get("max_gain_db"),
        square: target,
    })
}

impl MicrophoneStage for AutomaticGain {
    fn process(&mut self, block: &mut SampleBlock<'_>) {
        let length = block.len();
        for n in 0..length {
            let at = |channel: usize| channel * length + n;
            let squares = (0..block.channels).map(|c| f64::from(block.samples[at(c)]).powi(2));
            let square = squares.sum::<f64>() / block.channels as f64;
            let pace = self.pace[usize::from(square <= self.square)];
            self.square = (self.square + pace * (square - self.square)).max(SILENCE);
            let level_db = 10.0 * libm::log10(self.target / self.square);
            let gain_db = (self.strength * level_db).clamp(-self.most_db, self.most_db);
            let gain = libm::pow(10.0, gain_db / 20.0) as f32;
            for c in 0..block.channels {
                block.samples[at(c)] *= gain;
            }
        }
    }

    fn restore(&mut self, memory: &StageState) {
        if let Some(square) = memory.numbers.first() {
            self.square = *square;
        }
    }

    fn state(&self) -> StageState {
        StageState {
            numbers: vec![self.square],
            samples: Vec::new(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::{RATE_HZ, law, microphone_output};

    fn rms(samples: &[f32]) -> f64 {
        let power: f64 = samples.iter().map(|x| f64::from(*x).powi(2)).sum();
        (power / samples.len() as f64).sqrt()
    }

    /// A steady tone of any level comes out at the level set by the strength; within 0.2 dB, as the control ripples within a period.
    #[test]
    fn steady_tones_come_out_at_the_target() {
        for (strength, amplitude) in [(1.0, 0.02), (1.0, 1.5), (0.5, 0.02), (0.5, 1.5)] {
            let tone: Vec<f32> = (0..80_000)
                .map(|k| {
                    amplitude
                        * (std::f64::consts::TAU * 900.0 * f64::from(k) / RATE_HZ).sin() as f32
                })
                .collect();
            let values = [
                ("strength", strength),
                ("attack_s", 0.1),
                ("release_s", 0.1),
            ];
            let out = microphone_output(&[law("automatic_gain", &values)], 0, &tone);
            let (before, after) = (rms(&tone[64_000..]), rms(&out[64_000..]));
            let wanted_db = strength * 20.0 * (0.1 / before).log10();
            let found_db = 20.0 * (after / before).log10();
            assert!((found_db - wanted_db).abs() < 0.2, "{found_db} {wanted_db}");
        }
    }

    /// Silence after a loud sound is amplified with the release's time constant, up to the maximum.
    #[test]
    fn what_follows_a_loud_sound_is_lifted_slowly() {
        let mut sound = vec![1.0_f32; 16_000];
        sound.extend(vec![1e-6; 64_000]);
        let values = [
            ("strength", 1.0),
            ("release_s", 0.25),
            ("max_gain_db", 20.0),
        ];
        let out = microphone_output(&[law("automatic_gain", &values)], 0, &sound);
        let gain_db = |k: usize| 20.0 * f64::from(out[k] / sound[k]).log10();
        assert!((gain_db(15_999) + 20.0).abs() < 1e-3);
        // The square falls by 1/e in 0.25 s: 4.343 dB; the gain rises as much.
        assert!(
            (gain_db(20_000) + 20.0 - 4.343).abs() < 0.02,
            "{}",
            gain_db(20_000)
        );
        assert!((gain_db(79_999) - 20.0).abs() < 1e-3);
    }
}
