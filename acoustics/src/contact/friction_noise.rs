//! Sound of sliding and rolling.

use super::impact_force::effective_modulus_pa;
use super::radiation::Radiator;
use super::{ContactPartner, elastic, samples};
use dwell_scene::random::RandomKey;
use glam::Vec3;
use serde::{Deserialize, Serialize};
use std::f64::consts::{PI, TAU};

/// The kind of relative motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum FrictionSoundKind {
    /// Sliding.
    Slide,
    /// Rolling.
    Roll,
}

/// RMS force between sliding bodies, over the normal force, at 1 m/s and a roughness of 10 µm: estimate, so that a chair
/// pushed over a wooden floor makes some 70 dB at 1 m.
const SLIDE: f64 = 0.04;
/// The same for rolling: the surface is not torn, so that only its height matters.
const ROLL: f64 = 0.01;
/// Exponents of roughness and speed (H. Ben Abdelounis, A. Le Bot, J. Perret-Liaudet, H. Zahouani, Wear 268, 335, 2010: 0.8
/// to 1.16 and 0.7 to 0.96).
const BY_ROUGHNESS: f64 = 0.9;
const BY_SPEED: f64 = 0.9;
/// Modulus at which the force is halved because fibres and soft rubber yield to roughness, Pa. Estimate.
const SOFT_MODULUS_PA: f64 = 1e8;
/// Bound of the RMS force over the normal force.
const MAX_FORCE_SHARE: f64 = 0.5;
/// Contact length, m: of asperities at the least, with this many roughnesses more, and of the patch of a rolling body.
const ASPERITY_M: f64 = 5e-6;
const ROUGHNESSES: f64 = 5.0;
const PATCH_M: f64 = 1.5e-3;

/// A segment of sliding or rolling; segments that follow each other at half their length are one sound.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FrictionSound {
    /// Position, m.
    pub position: Vec3,
    /// Sliding or rolling.
    pub kind: FrictionSoundKind,
    /// The normal force between the two, N.
    pub force_n: f32,
    /// Relative speed, m/s.
    pub speed_m_s: f32,
    /// Duration, s: it swells over its first half and fades over its second; 0.001 to 2.
    pub length_s: f32,
    /// The two bodies.
    pub partners: [ContactPartner; 2],
    /// Random key of the noise.
    pub key: RandomKey,
    /// Random key of the contact position on the two: the same as long as the contact lasts.
    pub contact_key: RandomKey,
}

impl FrictionSound {
    fn segment_duration_s(&self) -> f64 {
        f64::from(self.length_s).clamp(1e-3, 2.0)
    }

    /// Returns the duration of its sound, s.
    pub fn duration_s(&self) -> f64 {
        self.segment_duration_s()
            + Radiator::new(&self.partners, self.contact_key).ringing_s()
            + 0.012
    }

    /// Returns the root mean square of the varying force, N.
    fn force_rms_n(&self) -> f64 {
        let (normal, speed) = (
            f64::from(self.force_n).max(0.0),
            f64::from(self.speed_m_s).max(0.0),
        );
        let factor = match self.kind {
            FrictionSoundKind::Slide => SLIDE,
            FrictionSoundKind::Roll => ROLL,
        };
        let rough = libm::pow(self.roughness_m() / 1e-5, BY_ROUGHNESS);
        let [a, b] = [0, 1].map(|k| self.partners[k].substance.as_str());
        let modulus = effective_modulus_pa(a, b);
        let hard = modulus / (modulus + SOFT_MODULUS_PA);
        (normal * factor * hard * rough * libm::pow(speed, BY_SPEED)).min(MAX_FORCE_SHARE * normal)
    }

    fn roughness_m(&self) -> f64 {
        let [a, b] = [0, 1].map(|k| elastic(&self.partners[k].substance).roughness_m);
        (a * a + b * b).sqrt()
    }

    /// Returns the corner frequency above which the force falls, Hz: speed over contact length.
    fn corner_hz(&self) -> f64 {
        let met_m = match self.kind {
            FrictionSoundKind::Slide => ASPERITY_M + ROUGHNESSES * self.roughness_m(),
            FrictionSoundKind::Roll => PATCH_M,
        };
        f64::from(self.speed_m_s).max(0.0) / (TAU * met_m)
    }

    /// Returns the whole sound: pressure at 1 m, Pa. Shape (`duration_s` * `rate_hz`, rounded up,).
    pub fn render(&self, rate_hz: u32) -> Vec<f32> {
        let radiator = Radiator::new(&self.partners, self.contact_key);
        let mut out = vec![0.0; samples(self.duration_s(), rate_hz)];
        let rate = f64::from(rate_hz);
        // Noise through a pole at the corner, and one at 20 Hz below which nothing is audible; its mean square is that of
        // the white noise times (1 - pole) / (1 + pole).
        let pole = libm::exp(-TAU * self.corner_hz().min(0.45 * rate) / rate);
        let slow = libm::exp(-TAU * 20.0 / rate);
        let scale = self.force_rms_n() * ((1.0 - pole) * (1.0 + pole)).sqrt();
        let mut stream = self.key.child("rub").stream();
        let count = samples(self.segment_duration_s(), rate_hz);
        let (mut low, mut drift) = (0.0, 0.0);
        let mut force = vec![0.0; count];
        // Samples before the segment let the filters settle.
        let settle = count.min(rate_hz as usize / 20);
        for k in 0..count + settle {
            low = pole * low + scale * stream.normal();
            drift = slow * drift + (1.0 - slow) * low;
            if let Some(at) = k.checked_sub(settle) {
                let swell = libm::sin(PI * (at as f64 + 0.5) / count as f64);
                force[at] = (low - drift) * swell;
            }
        }
        radiator.add_response(&force, rate_hz, &mut out);
        out.into_iter().map(|x| x as f32).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn chair(kind: FrictionSoundKind, force_n: f32, speed_m_s: f32, under: &str) -> FrictionSound {
        FrictionSound {
            position: Vec3::ZERO,
            kind,
            force_n,
            speed_m_s,
            length_s: 0.1,
            partners: [
                ContactPartner::body("oak", 6.0, [0.45, 0.9, 0.5]),
                ContactPartner::panel(under, 150.0),
            ],
            key: RandomKey::root(3),
            contact_key: RandomKey::root(4),
        }
    }

    /// Level of segments that overlap by half, dB SPL at 1 m.
    fn level_db(of: &FrictionSound) -> f64 {
        let rate_hz = 16_000;
        let mut sum = vec![0.0_f64; 3 * rate_hz as usize];
        for k in 0..40_u64 {
            let stretch = FrictionSound {
                key: RandomKey::root(7).child(k),
                ..of.clone()
            };
            for (y, x) in sum[k as usize * 800..]
                .iter_mut()
                .zip(stretch.render(rate_hz))
            {
                *y += f64::from(x);
            }
        }
        let middle = &sum[8_000..32_000];
        let power = middle.iter().map(|x| x * x).sum::<f64>() / middle.len() as f64;
        10.0 * (power / 4e-10).log10()
    }

    #[test]
    fn a_chair_on_wood_is_about_seventy_decibels_and_louder_when_fast_rough_or_heavy() {
        let at = |force_n, speed, under: &str| {
            level_db(&chair(FrictionSoundKind::Slide, force_n, speed, under))
        };
        let usual = at(60.0, 0.4, "oak");
        assert!((60.0..80.0).contains(&usual), "{usual}");
        // 20 log10 of the force; the speed acts on the spectrum, too.
        assert!((at(120.0, 0.4, "oak") - usual - 6.02).abs() < 0.01);
        assert!(at(60.0, 0.8, "oak") > usual + 3.0);
        assert!(at(60.0, 0.4, "concrete") > usual + 3.0);
        assert!(level_db(&chair(FrictionSoundKind::Roll, 60.0, 0.4, "oak")) < usual - 5.0);
    }

    #[test]
    fn what_stands_still_is_silent_and_stretches_have_no_clicks() {
        let still = chair(FrictionSoundKind::Slide, 60.0, 0.0, "oak").render(16_000);
        assert!(still.iter().all(|x| *x == 0.0));
        for kind in [FrictionSoundKind::Slide, FrictionSoundKind::Roll] {
            for rate_hz in [8_000, 44_100] {
                let it = chair(kind, 60.0, 0.5, "ceramic_tile");
                let heard = it.render(rate_hz);
                assert_eq!(heard.len(), samples(it.duration_s(), rate_hz));
                assert!(heard.iter().all(|x| x.is_finite()));
                let peak = heard.iter().fold(0.0_f32, |peak, x| peak.max(x.abs()));
                assert!(heard[0].abs() < 0.05 * peak && heard.last().unwrap().abs() < 0.01 * peak);
                assert_eq!(heard, it.render(rate_hz));
            }
        }
    }

    /// Segments that overlap by half have constant loudness.
    #[test]
    fn a_row_of_stretches_is_even() {
        let rate_hz = 16_000;
        let of = chair(FrictionSoundKind::Slide, 60.0, 0.4, "oak");
        let mut power = [0.0_f64; 4];
        for trial in 0..60_u64 {
            let mut sum = vec![0.0_f64; 8_000];
            for k in 0..6_u64 {
                let key = RandomKey::root(trial).child(k);
                let stretch = FrictionSound { key, ..of.clone() };
                for (y, x) in sum[k as usize * 800..]
                    .iter_mut()
                    .zip(stretch.render(rate_hz))
                {
                    *y += f64::from(x);
                }
            }
            for (k, power) in power.iter_mut().enumerate() {
                let part = &sum[2_400 + 200 * k..2_600 + 200 * k];
                *power += part.iter().map(|x| x * x).sum::<f64>();
            }
        }
        let mean = power.iter().sum::<f64>() / 4.0;
        for part in power {
            assert!((part / mean - 1.0).abs() < 0.25, "{power:?}");
        }
    }
}
