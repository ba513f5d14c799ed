//! Sound of a footstep.

use super::friction_noise::{FrictionSound, FrictionSoundKind};
use super::impact_force::{add_half_sine, effective_modulus_pa, hertz_contact_time_s};
use super::radiation::Radiator;
use super::{ContactPartner, samples};
use dwell_scene::random::RandomKey;
use glam::Vec3;
use serde::{Deserialize, Serialize};

/// Mass of foot and shank, over the mass of the body (D. A. Winter, *Biomechanics and Motor Control of Human Movement*, 2009, table 4.1).
const LEG: f64 = 0.061;
/// Speed of the heel at impact, over walking speed: 0.3 m/s at 1.3 m/s (D. A. Winter, Hum. Mov. Sci. 11, 1992, some 0.4 m/s
/// along the ground and less across it).
const HEEL: f64 = 0.23;
/// Radius of the heel, m.
const HEEL_M: f64 = 0.03;
/// Mass of the sole's hard edge over that of the leg (a third of the foot), and its radius, m: estimates that give steps
/// their measured level. It determines the sound above 200 Hz.
const EDGE: f64 = 0.08;
const EDGE_M: f64 = 0.003;
/// Delay of the forefoot, over the time between steps, and its impulse, over the heel's.
const TOE_AFTER: f64 = 0.2;
const TOE: f64 = 0.35;
/// Duration of the sole's rubbing, s, and its speed over walking speed.
const RUB_S: f32 = 0.08;
const RUB_SPEED: f32 = 0.15;
const SOLE: &str = "rubber";
const EDGE_OF: &str = "plastic";

/// A footstep of a walking person.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FootstepSound {
    /// Position of the foot, m.
    pub position: Vec3,
    /// Mass of the whole body, kg; 1 to 1,000.
    pub mass_kg: f32,
    /// Walking speed, m/s; at least 0.
    pub speed_m_s: f32,
    /// The time between two steps, s.
    pub period_s: f32,
    /// The floor underfoot.
    pub floor: ContactPartner,
    /// Random key that distinguishes steps.
    pub key: RandomKey,
}

impl FootstepSound {
    fn toe_s(&self) -> f64 {
        TOE_AFTER * f64::from(self.period_s).clamp(0.1, 2.0)
    }

    /// Returns masses in kg, radii in m and substances of the impacting parts: the leg behind its sole, and the sole's edge.
    fn impacting_masses(&self) -> [(f64, f64, &'static str); 2] {
        let leg = LEG * f64::from(self.mass_kg).clamp(1.0, 1_000.0);
        [(leg, HEEL_M, SOLE), (EDGE * leg, EDGE_M, EDGE_OF)]
    }

    fn rub(&self) -> FrictionSound {
        FrictionSound {
            position: self.position,
            kind: FrictionSoundKind::Slide,
            force_n: self.mass_kg.clamp(1.0, 1_000.0) * 9.8 * 0.2,
            speed_m_s: RUB_SPEED * self.speed_m_s,
            length_s: RUB_S,
            partners: [
                ContactPartner::body(SOLE, 0.3, [0.3, 0.1, 0.02]),
                self.floor.clone(),
            ],
            key: self.key.child("rub"),
            contact_key: self.key,
        }
    }

    /// Returns the duration of its sound, s.
    pub fn duration_s(&self) -> f64 {
        let ring_s = Radiator::new(std::slice::from_ref(&self.floor), self.key).ringing_s();
        (self.toe_s() + 0.1 + ring_s + 0.012).max(self.rub().duration_s())
    }

    /// Returns the whole sound: pressure at 1 m, Pa. Shape (`duration_s` * `rate_hz`, rounded up,).
    pub fn render(&self, rate_hz: u32) -> Vec<f32> {
        let mut out = vec![0.0; samples(self.duration_s(), rate_hz)];
        let speed = HEEL * f64::from(self.speed_m_s).clamp(0.0, 10.0);
        if speed > 0.0 {
            let radiator = Radiator::new(std::slice::from_ref(&self.floor), self.key);
            let mut force = vec![0.0; samples(self.toe_s() + 0.1, rate_hz) + 1];
            let mut stream = self.key.child("step").stream();
            for (start_s, share) in [(0.0, 1.0), (self.toe_s(), TOE)] {
                let strength = share * (0.85 + 0.3 * stream.uniform());
                for (mass_kg, radius_m, substance) in self.impacting_masses() {
                    let modulus = effective_modulus_pa(substance, &self.floor.substance);
                    let lasts_s = hertz_contact_time_s(mass_kg, radius_m, modulus, speed);
                    let impulse = mass_kg * speed * strength;
                    add_half_sine(&mut force, rate_hz, start_s, impulse, lasts_s);
                }
            }
            radiator.add_response(&force, rate_hz, &mut out);
        }
        for (y, x) in out.iter_mut().zip(self.rub().render(rate_hz)) {
            *y += f64::from(x);
        }
        out.into_iter().map(|x| x as f32).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn step(mass_kg: f32, speed_m_s: f32, floor: &str, leaf: f32) -> FootstepSound {
        FootstepSound {
            position: Vec3::ZERO,
            mass_kg,
            speed_m_s,
            period_s: 0.5,
            floor: ContactPartner::panel(floor, leaf),
            key: RandomKey::root(2),
        }
    }

    /// IEC 61672-1, equation 8.
    fn a_weighting_db(frequency_hz: f64) -> f64 {
        let f2 = frequency_hz * frequency_hz;
        let low = (f2 + 20.6_f64.powi(2)) * (f2 + 12_194.0_f64.powi(2));
        let middle = ((f2 + 107.7_f64.powi(2)) * (f2 + 737.9_f64.powi(2))).sqrt();
        20.0 * (12_194.0_f64.powi(2) * f2 * f2 / (low * middle)).log10() + 2.0
    }

    /// A-weighted level over the half second of a step, dB.
    fn level_dba(of: &FootstepSound) -> f64 {
        let heard = of.render(16_000);
        assert!(heard.iter().all(|x| x.is_finite()));
        let mut fft = crate::fft::RealFft::new(16_384);
        let spectrum = fft.forward(&heard);
        let power: f64 = spectrum
            .iter()
            .enumerate()
            .skip(1)
            .map(|(k, x)| {
                let weight_db = a_weighting_db(k as f64 * 16_000.0 / 16_384.0);
                f64::from(x.norm_sqr()) * 10.0_f64.powf(0.1 * weight_db)
            })
            .sum();
        // Parseval, both halves of the spectrum, over 8,000 samples.
        10.0 * (2.0 * power / 16_384.0 / 8_000.0 / 4e-10).log10()
    }

    /// Walking steps at 1 m: some 40 to 60 dB(A) on hard floors, and 10 dB less and more on carpet.
    #[test]
    fn steps_are_as_loud_as_steps_are() {
        let hard = level_dba(&step(75.0, 1.3, "oak", 150.0));
        assert!((38.0..62.0).contains(&hard), "{hard}");
        let tiles = level_dba(&step(75.0, 1.3, "ceramic_tile", 300.0));
        assert!((35.0..65.0).contains(&tiles), "{tiles}");
        let carpet = level_dba(&step(75.0, 1.3, "carpet", 150.0));
        assert!(carpet < hard - 8.0, "{carpet} {hard}");
        assert!(level_dba(&step(110.0, 1.3, "oak", 150.0)) > hard + 1.0);
        assert!(level_dba(&step(75.0, 2.6, "oak", 150.0)) > hard + 3.0);
    }

    #[test]
    fn a_foot_that_stands_is_silent_and_no_two_steps_are_equal() {
        assert!(
            step(75.0, 0.0, "oak", 150.0)
                .render(16_000)
                .iter()
                .all(|x| *x == 0.0)
        );
        let one = step(75.0, 1.3, "oak", 150.0);
        let two = FootstepSound {
            key: RandomKey::root(3),
            ..one.clone()
        };
        assert_ne!(one.render(16_000), two.render(16_000));
        assert_eq!(one.render(16_000), one.render(16_000));
    }
}
