//! Sound of a hinge that sticks and slips.

use super::impact_force::add_half_sine;
use super::radiation::Radiator;
use super::{ContactPartner, samples};
use dwell_scene::random::RandomKey;
use glam::Vec3;
use serde::{Deserialize, Serialize};

/// The angle from slip to slip, rad: 50 µm on a pin of 5 mm radius.
const SLIP_RAD: f64 = 0.01;
/// Radius of the pin, m.
const PIN_M: f64 = 0.005;
/// Share of the friction that is lost in a slip, and duration of a slip, s: estimates.
const DROP: f64 = 0.15;
const SLIP_S: f64 = 0.0006;
/// Share of that force that bends the leaf and the frame: the pin pulls along them, at their edge. Estimate.
const BENDING_SHARE: f64 = 0.02;
/// The pin's speed above which it slides smoothly, m/s (Stribeck's curve): estimate.
const SMOOTH_M_S: f64 = 0.012;

/// A segment of a hinge's rotation. Slips are at fixed angles, so that consecutive segments are one sound, and a hinge at
/// rest is silent.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CreakSound {
    /// Position, m.
    pub position: Vec3,
    /// Angles at the beginning and at the end of the segment, rad.
    pub angle_rad: [f32; 2],
    /// Duration, s; 0.001 to 2.
    pub length_s: f32,
    /// The hinge's friction, N·m.
    pub friction_n_m: f32,
    /// The part that turns on the hinge, and the one that carries it.
    pub partners: [ContactPartner; 2],
    /// Random key of the hinge.
    pub hinge_key: RandomKey,
}

impl CreakSound {
    fn segment_duration_s(&self) -> f64 {
        f64::from(self.length_s).clamp(1e-3, 2.0)
    }

    /// Returns the duration of its sound, s.
    pub fn duration_s(&self) -> f64 {
        self.segment_duration_s()
            + SLIP_S
            + Radiator::new(&self.partners, self.hinge_key).ringing_s()
            + 0.012
    }

    /// Returns the times of its slips, from the beginning of the segment, s, and their impulses, N·s.
    fn slips(&self) -> Vec<(f64, f64)> {
        let [from, to] = self.angle_rad.map(f64::from);
        let turned = to - from;
        let speed_m_s = turned.abs() / self.segment_duration_s() * PIN_M;
        let force_n = BENDING_SHARE * DROP * f64::from(self.friction_n_m).max(0.0) / PIN_M;
        let ease = libm::exp(-(speed_m_s / SMOOTH_M_S) * (speed_m_s / SMOOTH_M_S));
        let impulse_n_s = force_n * SLIP_S * ease;
        if turned == 0.0 || !turned.is_finite() || impulse_n_s <= 0.0 {
            return Vec::new();
        }
        let (low, high) = (from.min(to), from.max(to));
        let first = (low / SLIP_RAD).floor() as i64 - 1;
        let last = (high / SLIP_RAD).ceil() as i64 + 1;
        // A leaf turns by some 200 of them at the most.
        let last = last.min(first + 2_000);
        let mut slips: Vec<(f64, f64)> = (first..=last)
            .filter_map(|k| {
                let mut stream = self.hinge_key.child("slip").child(k as u64).stream();
                let at = (k as f64 + 0.3 * (stream.uniform() - 0.5)) * SLIP_RAD;
                let strength = 0.5 + stream.uniform();
                let inside = at > low && at <= high;
                inside.then(|| {
                    (
                        (at - from) / turned * self.segment_duration_s(),
                        impulse_n_s * strength,
                    )
                })
            })
            .collect();
        slips.sort_by(|a, b| a.0.total_cmp(&b.0));
        slips
    }

    /// Returns the whole sound: pressure at 1 m, Pa. Shape (`duration_s` * `rate_hz`, rounded up,).
    pub fn render(&self, rate_hz: u32) -> Vec<f32> {
        let radiator = Radiator::new(&self.partners, self.hinge_key);
        let mut out = vec![0.0; samples(self.duration_s(), rate_hz)];
        let mut force = vec![0.0; samples(self.segment_duration_s() + SLIP_S, rate_hz) + 1];
        for (start_s, impulse_n_s) in self.slips() {
            add_half_sine(&mut force, rate_hz, start_s, impulse_n_s, SLIP_S);
        }
        if force.iter().any(|f| *f != 0.0) {
            radiator.add_response(&force, rate_hz, &mut out);
        }
        out.into_iter().map(|x| x as f32).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn door(angle_rad: [f32; 2], length_s: f32, friction_n_m: f32) -> CreakSound {
        CreakSound {
            position: Vec3::ZERO,
            angle_rad,
            length_s,
            friction_n_m,
            partners: [
                ContactPartner::body("wood_door", 20.0, [0.9, 2.0, 0.04]),
                ContactPartner::panel("gypsum_board", 40.0),
            ],
            hinge_key: RandomKey::root(8),
        }
    }

    #[test]
    fn a_door_that_stands_is_silent_and_rust_is_loud() {
        assert!(
            door([0.4, 0.4], 0.5, 3.0)
                .render(16_000)
                .iter()
                .all(|x| *x == 0.0)
        );
        assert!(
            door([0.4, 0.6], 0.5, 0.0)
                .render(16_000)
                .iter()
                .all(|x| *x == 0.0)
        );
        let rms = |friction_n_m| {
            let heard = door([0.2, 0.5], 1.0, friction_n_m).render(16_000);
            let power: f64 = heard[..16_000].iter().map(|x| f64::from(*x).powi(2)).sum();
            (power / 16_000.0).sqrt()
        };
        let level_db = 20.0 * (rms(3.0) / 20e-6_f64).log10();
        assert!((45.0..75.0).contains(&level_db), "{level_db}");
        assert!((rms(3.0) / rms(0.3) - 10.0).abs() < 1e-4);
    }

    #[test]
    fn slips_follow_the_angle_and_not_the_time() {
        let slow = door([0.2, 0.5], 1.0, 1.0).slips();
        assert!((28..=32).contains(&slow.len()), "{}", slow.len());
        let fast = door([0.2, 0.5], 0.5, 1.0).slips();
        for (a, b) in slow.iter().zip(&fast) {
            assert!((a.0 - 2.0 * b.0).abs() < 1e-6 && b.1 < a.1);
        }
        // Two segments are one sound; and the way back has the same slips.
        let parts = [door([0.2, 0.3], 0.4, 1.0), door([0.3, 0.5], 0.8, 1.0)];
        let count: usize = parts.iter().map(|part| part.slips().len()).sum();
        assert_eq!(count, slow.len());
        assert_eq!(door([0.5, 0.2], 1.0, 1.0).slips().len(), slow.len());
        // Swung open it hardly creaks at all.
        let swung = door([0.0, 1.5], 0.3, 1.0).slips();
        assert!(swung.iter().all(|slip| slip.1 < 0.05 * slow[0].1));
    }
}
