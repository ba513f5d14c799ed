//! Shot noise of electrons, and read noise.

use super::{RenderLaw, RenderStage};
use crate::camera::Camera;
use dwell_scene::law::{EngineKind, LawRegime, ParamInfo};
use dwell_scene::random::{RandomKey, RandomStream};
use dwell_scene::{LawInfo, LawValues};
use glam::Vec3;

pub(super) const LAW: RenderLaw = RenderLaw {
    info: LawInfo {
        id: "shot_read_noise",
        version: 1,
        name: "shot noise and read noise",
        equation: "L_out = gain N + w, N Poisson with the mean L / gain (electrons), w normal with standard deviation read; light as \
                   the picture shows it, linear, 1 for white, so that 1 / gain is the number of electrons at white: variance gain \
                   L + read^2",
        source: "EMVA Standard 1288, release 4.0 (2021), equations 1 to 9 (linear camera model)",
        engine: EngineKind::Render,
        acts_on: "agent",
        params: &[
            ParamInfo {
                name: "gain",
                unit: "1",
                default: 0.0,
                low: 0.0,
                high: 0.1,
                plausible: [2e-5, 5e-3],
            },
            ParamInfo {
                name: "read",
                unit: "1",
                default: 0.0,
                low: 0.0,
                high: 1.0,
                plausible: [2e-4, 0.02],
            },
        ],
        regimes: &[LawRegime::StillImage, LawRegime::MovingImage],
        probes: &[&[("gain", 0.001), ("read", 0.005)]],
        rivals: &["samples_per_pixel"],
        separating_experiment: "take many pictures of a still scene and draw the variance over the mean of each pixel (photon \
                                transfer): shot noise is a slope, read noise the rest at black; noise of rendering goes when \
                                samples are added",
    },
    effect: RenderStage::Color(apply),
};

/// Mean from which on rejection is faster than counting.
const COUNTED: f64 = 12.0;

fn apply(values: LawValues<'_>, camera: &Camera, key: RandomKey, light: &mut [Vec3]) {
    let (gain, read) = (
        f64::from(values.get_f32("gain")),
        f64::from(values.get_f32("read")),
    );
    for (row, light) in (0_u64..).zip(light.chunks_mut(camera.width() as usize)) {
        let mut stream = key.child(row).stream();
        for light in light {
            *light = Vec3::from_array(light.to_array().map(|light| {
                let mut light = f64::from(light);
                if gain > 0.0 {
                    light = gain * poisson(light / gain, &mut stream);
                }
                if read > 0.0 {
                    light += read * stream.normal();
                }
                light as f32
            }));
        }
    }
}

/// Draws from the Poisson distribution.
///
/// # Source
/// Few: D. E. Knuth, The Art of Computer Programming 2, 3.4.1. Many: W. Hörmann, Insurance: Mathematics and Economics 12 (1993)
/// 39, algorithm PTRS.
fn poisson(mean: f64, stream: &mut RandomStream) -> f64 {
    if mean <= 0.0 || !mean.is_finite() {
        return 0.0;
    }
    if mean < COUNTED {
        let limit = libm::exp(-mean);
        let (mut count, mut product) = (0.0, stream.uniform());
        while product > limit {
            count += 1.0;
            product *= stream.uniform();
        }
        return count;
    }
    let b = 0.931 + 2.53 * mean.sqrt();
    let a = -0.059 + 0.024_83 * b;
    let inverse_alpha = 1.1239 + 1.1328 / (b - 3.4);
    let quick = 0.9277 - 3.6224 / (b - 2.0);
    let log_mean = libm::log(mean);
    loop {
        let u = stream.uniform() - 0.5;
        let v = stream.uniform();
        let us = 0.5 - u.abs();
        let count = ((2.0 * a / us + b) * u + mean + 0.43).floor();
        if us >= 0.07 && v <= quick {
            return count;
        }
        if count < 0.0 || (us < 0.013 && v > us) {
            continue;
        }
        let left = libm::log(v * inverse_alpha / (a / (us * us) + b));
        if left <= count * log_mean - mean - libm::lgamma(count + 1.0) {
            return count;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::{camera, law, moments};
    use super::*;

    /// Mean and variance are the mean within 5 standard errors, for five seeds, on both ways to draw; for few the share of
    /// zeros, too.
    #[test]
    fn counts_follow_poissons_law() {
        let n = 40_000;
        for seed in 0..5 {
            for mean in [0.3, 4.0, 11.9, 12.1, 60.0, 4000.0] {
                let mut stream = RandomKey::root(seed).stream();
                let counts: Vec<f64> = (0..n).map(|_| poisson(mean, &mut stream)).collect();
                let (found, deviation) = moments(&counts);
                let count = f64::from(n);
                assert!((found - mean).abs() < 5.0 * (mean / count).sqrt(), "{mean}");
                // Var(s²) = (mu4 - s⁴) / n, mu4 of Poisson: mean + 3 mean².
                let error = ((mean + 2.0 * mean * mean) / count).sqrt();
                assert!((deviation * deviation - mean).abs() < 5.0 * error, "{mean}");
                let zeros = counts.iter().filter(|count| **count == 0.0).count() as f64 / count;
                let expected = (-mean).exp();
                assert!((zeros - expected).abs() <= 5.0 * (expected / count).sqrt() + 1e-12);
            }
        }
    }

    /// The line of photon transfer: variance = gain L + read².
    #[test]
    fn variance_is_a_line_over_light() {
        let spec = law("shot_read_noise", &[("gain", 1e-3), ("read", 0.01)]);
        let camera = camera();
        let RenderStage::Color(change) = LAW.effect else {
            panic!("acts on colour")
        };
        let values = LawValues {
            spec: &spec,
            info: &LAW.info,
        };
        for seed in 0..5 {
            for level in [0.0, 0.1, 0.4, 0.9_f32] {
                let mut light = vec![Vec3::splat(level); camera.pixels()];
                change(values, &camera, RandomKey::root(seed), &mut light);
                let all: Vec<f64> = light
                    .iter()
                    .flat_map(Vec3::to_array)
                    .map(f64::from)
                    .collect();
                let (mean, deviation) = moments(&all);
                let variance = 1e-3 * f64::from(level) + 1e-4;
                let count = all.len() as f64;
                assert!((mean - f64::from(level)).abs() < 5.0 * (variance / count).sqrt());
                assert!((deviation.powi(2) / variance - 1.0).abs() < 5.0 * (2.2 / count).sqrt());
            }
        }
    }
}
