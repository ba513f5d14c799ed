//! What two things sound like that hit each other.

use dwell_scene::material::library;
use dwell_scene::random::Key;
use glam::Vec3;
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

/// Ratios of the frequencies of a free bar's bending modes to the lowest.
///
/// # Source
/// N. H. Fletcher, T. D. Rossing, *The Physics of Musical Instruments* (1998), table 2.1.
const MODES: [f64; 6] = [1.0, 2.756, 5.404, 8.933, 13.344, 18.638];

/// A blow between two things, as a sound of its own.
///
/// Each of the two rings with the modes of a bar of its size, damped as its substance is; a short thud of the contact goes
/// with them. This is a plausible sound, not a measured one: see [`ImpactSound::PEAK_PA_PER_N_S`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ImpactSound {
    /// Where it happens, m.
    pub position: Vec3,
    /// How hard, N s.
    pub impulse_n_s: f32,
    /// What the two are made of: names of [`library`]; unknown ones count as its default.
    pub substances: [String; 2],
    /// The largest measure of each of the two, m; `None` for what does not ring: walls, floors, the ground.
    pub size_m: [Option<f32>; 2],
    /// Tells blows apart that are otherwise equal.
    pub key: Key,
}

/// How a substance rings.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Ringing {
    /// Speed of longitudinal waves in a bar, m/s.
    bar_speed_m_s: f64,
    /// Loss factor.
    loss: f64,
    /// Loudness re wood.
    loudness: f64,
}

/// How a substance rings, by the words of its name, else by how well it bounces.
///
/// # Source
/// Bar speeds: D. R. Lide, *CRC Handbook of Chemistry and Physics*, speed of sound in solids. Loss factors: L. Cremer, M. Heckl,
/// B. A. T. Petersson, *Structure-Borne Sound* (2005), table 4.3, for built-up things in use, ten times those of bare
/// specimens. Loudness: estimate.
fn ringing(substance: &str) -> Ringing {
    const KINDS: [(&[&str], f64, f64, f64); 7] = [
        (
            &["steel", "chrome", "cast_iron", "brass", "copper"],
            5000.0,
            0.003,
            1.5,
        ),
        (&["aluminium", "appliance"], 5100.0, 0.005, 1.3),
        (
            &["glass", "double_glazing", "mirror", "porcelain"],
            5200.0,
            0.006,
            1.4,
        ),
        (
            &[
                "ceramic_tile",
                "clay",
                "marble",
                "stone",
                "concrete",
                "brick",
            ],
            3800.0,
            0.01,
            1.0,
        ),
        (
            &[
                "wood",
                "oak",
                "pine",
                "plywood",
                "parquet",
                "wood_door",
                "laminate",
            ],
            3400.0,
            0.02,
            1.0,
        ),
        (
            &["plastic", "acrylic", "vinyl", "electronics"],
            1500.0,
            0.05,
            0.7,
        ),
        (
            &[
                "rubber", "cork", "wax", "leather", "food", "human", "animal",
            ],
            500.0,
            0.3,
            0.25,
        ),
    ];
    let known = KINDS.iter().find(|(names, ..)| names.contains(&substance));
    if let Some((_, bar_speed_m_s, loss, loudness)) = known {
        return Ringing {
            bar_speed_m_s: *bar_speed_m_s,
            loss: *loss,
            loudness: *loudness,
        };
    }
    // What does not bounce does not ring.
    let bounce = f64::from(library().get_or_default(substance).restitution).clamp(0.0, 1.0);
    Ringing {
        bar_speed_m_s: 400.0 + 5000.0 * bounce,
        loss: 0.4 * libm::pow(0.02, bounce),
        loudness: 0.1 + 1.5 * bounce,
    }
}

/// One decaying sine.
struct Mode {
    omega: f64,
    decay_per_s: f64,
    amplitude: f64,
    phase: f64,
}

impl ImpactSound {
    /// Peak pressure at 1 m that a blow of 1 N s between wooden things makes, Pa: estimate, 86 dB SPL.
    pub const PEAK_PA_PER_N_S: f64 = 0.4;

    /// How long it is heard, s: until it has decayed by 60 dB, at most 2.
    pub fn duration_s(&self) -> f64 {
        self.modes()
            .iter()
            .map(|mode| 3.0 * std::f64::consts::LN_10 / mode.decay_per_s)
            .fold(0.05, f64::max)
            .min(2.0)
    }

    fn modes(&self) -> Vec<Mode> {
        let mut stream = self.key.child("impact").stream();
        let mut modes = Vec::new();
        let kinds = [0, 1].map(|k| ringing(&self.substances[k]));
        // The softer of the two lasts longer under the blow and leaves the high modes out.
        let softer = kinds.iter().map(|kind| kind.loss).fold(0.0, f64::max);
        let contact_s = 0.00012 * (softer / 0.01).sqrt().clamp(0.3, 20.0);
        for (kind, size) in kinds.iter().zip(self.size_m) {
            let Some(size) = size else { continue };
            let length_m = f64::from(size).clamp(0.02, 3.0);
            // 1.028 (h / L^2) sqrt(E / rho) for a bar a tenth as thick as it is long (Fletcher, Rossing, equation 2.63).
            let lowest_hz = 1.028 * 0.1 / length_m * kind.bar_speed_m_s;
            for (number, ratio) in MODES.iter().enumerate() {
                let spread = 0.97 + 0.06 * stream.uniform();
                let weight = 0.5 + stream.uniform();
                let frequency_hz = lowest_hz * ratio * spread;
                let omega = TAU * frequency_hz;
                let reached = libm::exp(-0.5 * (omega * contact_s) * (omega * contact_s) / 9.0);
                modes.push(Mode {
                    omega,
                    decay_per_s: (0.5 * omega * kind.loss).clamp(3.5, 400.0),
                    amplitude: kind.loudness * weight * reached / (number as f64 + 1.0),
                    phase: 0.0,
                });
            }
        }
        // The thud: what the contact itself radiates.
        let loudness = 0.5 * (kinds[0].loudness + kinds[1].loudness);
        modes.push(Mode {
            omega: (0.6 / contact_s).clamp(TAU * 40.0, TAU * 1500.0),
            decay_per_s: 90.0,
            amplitude: 0.6 * loudness,
            phase: 0.0,
        });
        let sum: f64 = modes.iter().map(|mode| mode.amplitude).sum();
        // The softer partner decides how much of the blow becomes sound at all.
        let quiet = kinds
            .iter()
            .map(|kind| kind.loudness)
            .fold(f64::INFINITY, f64::min);
        let scale = Self::PEAK_PA_PER_N_S * f64::from(self.impulse_n_s.max(0.0)) * quiet / sum;
        for mode in &mut modes {
            mode.amplitude *= scale;
        }
        modes
    }

    /// Writes the pressure at 1 m, Pa, from `start_sample` after the blow on.
    ///
    /// # Determinism
    /// Blocks of any size give the same samples.
    pub fn synthesize(&self, rate_hz: u32, start_sample: u64, out: &mut [f32]) {
        let modes = self.modes();
        let end_s = self.duration_s();
        let rate = f64::from(rate_hz.max(1));
        for (k, y) in out.iter_mut().enumerate() {
            let t = (start_sample + k as u64) as f64 / rate;
            let mut sum = 0.0;
            if t <= end_s {
                // A rise of half a millisecond, and an end without a click.
                let gate = (t / 0.0005).min(1.0) * ((end_s - t) / 0.01).clamp(0.0, 1.0);
                for mode in modes.iter().filter(|mode| mode.omega < 0.45 * TAU * rate) {
                    let phase = mode.omega * t + mode.phase;
                    sum += mode.amplitude * libm::exp(-mode.decay_per_s * t) * libm::sin(phase);
                }
                sum *= gate;
            }
            *y = sum as f32;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn blow(a: &str, b: &str, impulse_n_s: f32) -> ImpactSound {
        ImpactSound {
            position: Vec3::ZERO,
            impulse_n_s,
            substances: [a.to_owned(), b.to_owned()],
            size_m: [Some(0.2), None],
            key: Key::root(1),
        }
    }

    fn sound(impact: &ImpactSound) -> Vec<f32> {
        let mut out = vec![0.0; 32_000];
        impact.synthesize(16_000, 0, &mut out);
        out
    }

    fn peak(samples: &[f32]) -> f32 {
        samples.iter().fold(0.0, |peak, x| peak.max(x.abs()))
    }

    #[test]
    fn twice_the_impulse_is_twice_the_pressure() {
        let (one, two) = (
            sound(&blow("wood", "oak", 1.0)),
            sound(&blow("wood", "oak", 2.0)),
        );
        assert!((peak(&two) / peak(&one) - 2.0).abs() < 1e-4);
        assert!((0.05..=0.45).contains(&peak(&one)), "{}", peak(&one));
    }

    #[test]
    fn steel_rings_longer_than_wood_and_felt_is_dull() {
        let late = |name: &str| {
            let samples = sound(&blow(name, "concrete", 1.0));
            let power = |x: &[f32]| x.iter().map(|v| f64::from(*v).powi(2)).sum::<f64>();
            power(&samples[3_200..]) / power(&samples)
        };
        assert!(late("steel") > 10.0 * late("wood"));
        assert!(
            peak(&sound(&blow("felt", "concrete", 1.0)))
                < 0.5 * peak(&sound(&blow("wood", "concrete", 1.0)))
        );
    }

    #[test]
    fn blocks_give_the_same_samples_and_the_end_is_silent() {
        let impact = blow("glass", "stone", 0.5);
        let whole = sound(&impact);
        let mut pieces = Vec::new();
        while pieces.len() < whole.len() {
            let mut block = vec![0.0; 800];
            impact.synthesize(16_000, pieces.len() as u64, &mut block);
            pieces.extend(block);
        }
        assert_eq!(whole, pieces);
        let mut after = [1.0; 100];
        impact.synthesize(16_000, 32_100, &mut after);
        assert!(after.iter().all(|x| *x == 0.0));
        assert!(impact.duration_s() <= 2.0);
    }
}
