//! Sound of an impact.

use super::impact_force::{add_half_sine, impact_duration_s};
use super::radiation::Radiator;
use super::{ContactPartner, samples};
use dwell_scene::random::RandomKey;
use glam::Vec3;
use serde::{Deserialize, Serialize};

/// Largest share of an impact's energy that goes into vibration: for compact bodies some percent (J. Reed, J. Phys. D 18,
/// 2329, 1985; I. M. Hutchings, J. Phys. D 12, 1819, 1979); the rest is rebound, deformation and heat.
const MAX_VIBRATION_SHARE: f64 = 0.02;

/// An impact between two bodies as a sound.
///
/// The force is a half sine with the impact's impulse and the duration of Hertz's contact. Bodies ring with the modes of
/// the bar, panel or shell that represents them, damped as their substance is; walls and floors radiate the force itself.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ImpactSound {
    /// Position, m.
    pub position: Vec3,
    /// Impulse, N·s.
    pub impulse_n_s: f32,
    /// Approach speed, m/s.
    pub speed_m_s: f32,
    /// The two bodies.
    pub partners: [ContactPartner; 2],
    /// Random key that distinguishes equal impacts.
    pub key: RandomKey,
}

impl ImpactSound {
    /// Returns the duration of its sound, s: the impact, and the ringing down to 60 dB, at most 2.1.
    pub fn duration_s(&self) -> f64 {
        let radiator = Radiator::new(&self.partners, self.key);
        impact_duration_s(&self.partners, f64::from(self.speed_m_s)) + radiator.ringing_s() + 0.012
    }

    /// Returns the whole sound: pressure at 1 m, Pa. Shape (`duration_s` * `rate_hz`, rounded up,).
    pub fn render(&self, rate_hz: u32) -> Vec<f32> {
        let mut radiator = Radiator::new(&self.partners, self.key);
        let speed = f64::from(self.speed_m_s).max(0.0);
        let lasts = impact_duration_s(&self.partners, speed);
        let mut out = vec![0.0; samples(self.duration_s(), rate_hz)];
        let mut force = vec![0.0; samples(lasts, rate_hz) + 1];
        let impulse = f64::from(self.impulse_n_s).max(0.0);
        add_half_sine(&mut force, rate_hz, 0.0, impulse, lasts);
        radiator.limit_mode_energy(impulse, lasts, MAX_VIBRATION_SHARE * 0.5 * impulse * speed);
        radiator.add_response(&force, rate_hz, &mut out);
        out.into_iter().map(|x| x as f32).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn blow(partners: [ContactPartner; 2], impulse_n_s: f32, speed_m_s: f32) -> ImpactSound {
        ImpactSound {
            position: Vec3::ZERO,
            impulse_n_s,
            speed_m_s,
            partners,
            key: RandomKey::root(1),
        }
    }

    fn mug(substance: &str) -> ContactPartner {
        ContactPartner::body(substance, 0.3, [0.09, 0.1, 0.08])
    }

    fn floor(substance: &str) -> ContactPartner {
        ContactPartner::panel(substance, 300.0)
    }

    fn peak(samples: &[f32]) -> f32 {
        samples.iter().fold(0.0, |peak, x| peak.max(x.abs()))
    }

    /// Share of the energy above a frequency.
    fn bright(samples: &[f32], above_hz: f64) -> f64 {
        let mut fft = crate::fft::RealFft::new(samples.len().next_power_of_two());
        let step_hz = 16_000.0 / fft.len() as f64;
        let spectrum = fft.forward(samples);
        let power = |from: usize| -> f64 {
            spectrum[from..]
                .iter()
                .map(|x| f64::from(x.norm_sqr()))
                .sum()
        };
        power((above_hz / step_hz) as usize) / power(0)
    }

    #[test]
    fn twice_as_fast_is_twice_the_pressure_and_shorter() {
        let pair = || [mug("porcelain"), floor("oak")];
        let (one, two) = (
            blow(pair(), 0.3, 1.0).render(16_000),
            blow(pair(), 0.6, 2.0).render(16_000),
        );
        let ratio = peak(&two) / peak(&one);
        assert!((1.9..3.0).contains(&ratio), "{ratio}");
        // An impact too soft to reach the energy bound is exactly as loud as its impulse.
        let ball = || ContactPartner::body("rubber", 0.05, [0.04; 3]);
        let soft = |impulse| peak(&blow([ball(), floor("oak")], impulse, 1.0).render(16_000));
        let ratio = soft(0.1) / soft(0.05);
        assert!((ratio - 2.0).abs() < 1e-4, "{ratio}");
        assert!(
            blow(pair(), 0.0, 0.0)
                .render(16_000)
                .iter()
                .all(|x| *x == 0.0)
        );
    }

    /// Objects dropped from a hand: 70 to 115 dB peak at 1 m, for objects and floors of every kind that is not soft.
    #[test]
    fn blows_of_everyday_are_as_loud_as_everyday() {
        for substance in ["porcelain", "steel", "plastic", "oak", "glass", "aluminium"] {
            for under in ["oak", "ceramic_tile", "concrete", "laminate"] {
                let heard = blow([mug(substance), floor(under)], 0.6, 2.0).render(16_000);
                let level_db = 20.0 * (f64::from(peak(&heard)) / 20e-6).log10();
                assert!(
                    (70.0..118.0).contains(&level_db),
                    "{substance} on {under}: {level_db}"
                );
                assert!(heard.iter().all(|x| x.is_finite()));
            }
        }
    }

    #[test]
    fn steel_rings_longer_than_oak_and_carpet_makes_dull() {
        let late = |name: &str| {
            let tray = ContactPartner::body(name, 0.5, [0.4, 0.3, 0.01]);
            let heard = blow([tray, floor("oak")], 0.5, 1.0).render(16_000);
            let power = |x: &[f32]| x.iter().map(|v| f64::from(*v).powi(2)).sum::<f64>();
            power(&heard[heard.len().min(1_600)..]) / power(&heard)
        };
        assert!(
            late("steel") > 10.0 * late("oak"),
            "{} {}",
            late("steel"),
            late("oak")
        );
        let on = |under: &str| blow([mug("porcelain"), floor(under)], 0.6, 2.0).render(16_000);
        assert!(bright(&on("carpet"), 500.0) < 0.3 * bright(&on("ceramic_tile"), 500.0));
        assert!(peak(&on("carpet")) < 0.5 * peak(&on("ceramic_tile")));
    }

    #[test]
    fn it_begins_and_ends_without_a_click() {
        for rate_hz in [8_000, 16_000, 48_000] {
            let impact = blow([mug("steel"), floor("concrete")], 0.5, 1.0);
            let heard = impact.render(rate_hz);
            assert_eq!(heard.len(), samples(impact.duration_s(), rate_hz));
            assert!(heard.last().unwrap().abs() < 1e-3 * peak(&heard));
            assert!(impact.duration_s() <= 2.2);
        }
    }
}
