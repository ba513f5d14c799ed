//! The simulated motion of a ball, read between the steps of physics.

use crate::experiment::experiment_world::hermite_interpolation;

/// Number of quantities: positions x, y, z (m), then spins about these axes (rad/s).
pub(super) const QUANTITIES: usize = 6;
/// The first of the spins.
pub(super) const FIRST_SPIN: usize = 3;
/// Height as a quantity.
const HEIGHT: usize = 1;
/// Change of the vertical speed in one step beyond that of free fall which is an impact, m/s.
const LEAST_BLOW_M_S: f64 = 0.02;
/// Halvings of the step in which an impact is located.
const HALVINGS: usize = 30;

/// Value and rate of change of each quantity at equal steps.
pub(super) struct BallMotion {
    /// Shape (quantity, step).
    pub(super) tracks: [Vec<(f64, f64)>; QUANTITIES],
    pub(super) step_s: f64,
    pub(super) gravity_m_s2: f64,
    /// True if there is a board to bounce from.
    pub(super) bounces: bool,
}

impl BallMotion {
    /// The value of a quantity at a time. In a step with an impact the motion before and the motion after meet where the
    /// ball touches the board.
    pub(super) fn value(&self, quantity: usize, t_s: f64) -> f64 {
        let track = &self.tracks[quantity];
        let last = track.len() - 1;
        let k = ((t_s / self.step_s).clamp(0.0, last as f64).floor() as usize)
            .min(last.saturating_sub(1));
        let since = (t_s - k as f64 * self.step_s).clamp(0.0, self.step_s);
        let impact = self.impact_in_step(k);
        if last == 0 || (impact.is_none() && quantity < FIRST_SPIN) {
            return hermite_interpolation(track, self.step_s, t_s);
        }
        let ((p0, v0), (p1, v1)) = (track[k], track[k + 1]);
        let Some(impact_s) = impact else {
            return p0 + (p1 - p0) * since / self.step_s;
        };
        if quantity >= FIRST_SPIN {
            return if since < impact_s { p0 } else { p1 };
        }
        let fall = if quantity == HEIGHT {
            self.gravity_m_s2
        } else {
            0.0
        };
        if since < impact_s {
            flown(p0, v0, fall, since)
        } else {
            flown(p1, v1, fall, since - self.step_s)
        }
    }

    /// The time from the start of step `k` to the impact in it, s.
    fn impact_in_step(&self, k: usize) -> Option<f64> {
        let heights = &self.tracks[HEIGHT];
        if !self.bounces || k + 1 >= heights.len() {
            return None;
        }
        let ((p0, v0), (p1, v1)) = (heights[k], heights[k + 1]);
        let g = self.gravity_m_s2;
        if v0 > -LEAST_BLOW_M_S || v1 - v0 + g * self.step_s < LEAST_BLOW_M_S {
            return None;
        }
        // Above the motion after it before the impact, below it after it.
        let above = |t: f64| flown(p0, v0, g, t) - flown(p1, v1, g, t - self.step_s);
        let (mut low, mut high) = (0.0, self.step_s);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            if above(middle) > 0.0 {
                low = middle;
            } else {
                high = middle;
            }
        }
        Some(0.5 * (low + high))
    }
}

/// A place after (before: t < 0) a time in free fall.
fn flown(place: f64, speed: f64, gravity: f64, t_s: f64) -> f64 {
    place + speed * t_s - 0.5 * gravity * t_s * t_s
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A ball that falls from 0.5 m and leaves the board with 0.8 of its speed, and a spin that the impact gives it.
    #[test]
    fn a_bounce_is_read_exactly_between_steps() {
        let (g, step_s) = (9.81_f64, 1.0 / 240.0);
        let impact_s = (2.0 * 0.5 / g).sqrt();
        let height = |t: f64| {
            if t < impact_s {
                (0.5 - 0.5 * g * t * t, -g * t)
            } else {
                let (s, v) = (t - impact_s, 0.8 * g * impact_s);
                (v * s - 0.5 * g * s * s, v - g * s)
            }
        };
        let along = |t: f64| {
            let after = (t - impact_s).max(0.0);
            (t - 0.3 * after, if t < impact_s { 1.0 } else { 0.7 })
        };
        let steps = 120;
        let track =
            |f: &dyn Fn(f64) -> (f64, f64)| (0..steps).map(|k| f(f64::from(k) * step_s)).collect();
        let mut motion = BallMotion {
            tracks: std::array::from_fn(|_| vec![(0.0, 0.0); steps as usize]),
            step_s,
            gravity_m_s2: g,
            bounces: true,
        };
        motion.tracks[0] = track(&along);
        motion.tracks[1] = track(&height);
        motion.tracks[5] = track(&|t| (if t < impact_s { 0.0 } else { -9.0 }, 0.0));
        for k in 0..1000 {
            let t = f64::from(k) * 4.5e-4;
            assert!((motion.value(1, t) - height(t).0).abs() < 1e-9, "{t}");
            assert!((motion.value(0, t) - along(t).0).abs() < 1e-9, "{t}");
            let spin = if t < impact_s { 0.0 } else { -9.0 };
            assert!((motion.value(5, t) - spin).abs() < 1e-9 || (t - impact_s).abs() < 1e-6);
        }
    }
}
