//! The motion that a window starts from, estimated from the measured poses up to it.

use super::motion::Motion;
use super::regime::Regime;
use super::track::Track;
use crate::bundle::turn;
use crate::fit::median;
use dwell_scene::random::{Key, Stream};
use glam::{DQuat, DVec3};
use serde::Serialize;

/// Samples that a start is estimated from, itself among them, at most.
const SAMPLES: usize = 8;
/// A speed that nothing here exceeds, m/s or rad/s: what is known before the first sample.
const UNKNOWN_SPEED: f64 = 50.0;
/// The noise of a tracker is not taken to be less, m and rad.
const LEAST_NOISE: [f64; 2] = [1e-6, 1e-5];

/// A tracker's noise from sample to sample: one standard deviation along each axis.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Noise {
    /// m.
    pub position_m: f64,
    /// rad.
    pub rotation_rad: f64,
}

impl Noise {
    /// What flights show of it: second differences of positions, freed from the fall, and of rotations have the square
    /// root of six times the noise of one sample. The median keeps what is no noise out.
    pub fn of(episodes: &[Track], step_s: f64, gravity_m_s2: f64) -> Self {
        let fall = DVec3::NEG_Y * (gravity_m_s2 * step_s * step_s);
        let (mut shifts, mut turns) = (Vec::new(), Vec::new());
        for track in episodes {
            for (motions, regimes) in track.motions.windows(3).zip(track.regimes.windows(3)) {
                if regimes.iter().any(|regime| *regime != Regime::Flight) {
                    continue;
                }
                let [a, b, c] = [&motions[0], &motions[1], &motions[2]];
                let shift = c.position - 2.0 * b.position + a.position - fall;
                let bend = turn(b.rotation, c.rotation) - turn(a.rotation, b.rotation);
                shifts.extend(shift.to_array().map(f64::abs));
                turns.extend(bend.to_array().map(f64::abs));
            }
        }
        let sd = |sizes: &mut Vec<f64>| 1.4826 * median(sizes) / 6.0_f64.sqrt();
        Self {
            position_m: sd(&mut shifts).max(LEAST_NOISE[0]),
            rotation_rad: sd(&mut turns).max(LEAST_NOISE[1]),
        }
    }
}

/// What a start is taken to be, and how well it is known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Start {
    /// The estimate.
    pub motion: Motion,
    /// Covariance of position and velocity along each axis: m², m²/s, m²/s².
    linear: [f64; 3],
    /// The same of rotation and angular velocity.
    angular: [f64; 3],
}

impl Start {
    /// The start of a window at the sample `at`: the end of a smoother over the samples up to it (which there is the
    /// Kalman filter), with positions and rotations measured and accelerations random; how large they are is a matter of
    /// the regime. Recorded velocities, which are often filtered differences that lag, are not looked at, nor is anything
    /// after the start.
    ///
    /// # Source
    /// H. E. Rauch, F. Tung, C. T. Striebel, AIAA Journal 3, 1445 (1965); accelerations as white noise: Y. Bar-Shalom,
    /// X. R. Li, T. Kirubarajan, Estimation with Applications to Tracking and Navigation (2001), section 6.2.2.
    pub fn of(track: &Track, at: usize, step_s: f64, gravity_m_s2: f64, noise: &Noise) -> Self {
        let past = (at + 1).saturating_sub(SAMPLES)..at + 1;
        let (motions, regimes) = (&track.motions[past.clone()], &track.regimes[past]);
        let here = track.motions[at];
        let places: Vec<DVec3> = motions.iter().map(|m| m.position).collect();
        let turns: Vec<DVec3> = motions
            .iter()
            .map(|m| turn(here.rotation, m.rotation))
            .collect();
        if places.len() < 2 {
            // Nothing before: what was recorded must do.
            return Self {
                motion: here,
                linear: [noise.position_m.powi(2), 0.0, 0.0],
                angular: [noise.rotation_rad.powi(2), 0.0, 0.0],
            };
        }
        let fall = DVec3::NEG_Y * gravity_m_s2;
        let (place, linear) = filtered(&places, regimes, step_s, noise.position_m, |regime| {
            let drift = if regime == Regime::Flight {
                fall
            } else {
                DVec3::ZERO
            };
            (drift, LINEAR_M_S2[kind(regime)])
        });
        let (turned, angular) = filtered(&turns, regimes, step_s, noise.rotation_rad, |regime| {
            (DVec3::ZERO, ANGULAR_RAD_S2[kind(regime)])
        });
        Self {
            motion: Motion {
                position: place.0,
                rotation: (DQuat::from_scaled_axis(turned.0) * here.rotation).normalize(),
                linear: place.1,
                angular: turned.1,
            },
            linear,
            angular,
        }
    }

    /// Another estimate that is known as well as this one.
    #[must_use]
    pub fn at(self, motion: Motion) -> Self {
        Self { motion, ..self }
    }

    /// A motion drawn from within the uncertainty.
    pub fn nudged(&self, key: Key) -> Motion {
        let mut stream = key.stream();
        let (shift, kick) = draw(&mut stream, self.linear);
        let (turned, spin) = draw(&mut stream, self.angular);
        Motion {
            position: self.motion.position + shift,
            rotation: (DQuat::from_scaled_axis(turned) * self.motion.rotation).normalize(),
            linear: self.motion.linear + kick,
            angular: self.motion.angular + spin,
        }
    }
}

/// How far accelerations stray from what is expected over a sample: in flight, in a blow, in contact, at rest. m/s².
const LINEAR_M_S2: [f64; 4] = [0.1, 150.0, 5.0, 0.3];
/// The same for angular accelerations, rad/s².
const ANGULAR_RAD_S2: [f64; 4] = [1.0, 1500.0, 100.0, 5.0];

fn kind(regime: Regime) -> usize {
    match regime {
        Regime::Flight => 0,
        Regime::Impact => 1,
        Regime::Rest => 3,
        _ => 2,
    }
}

/// The place and its rate at the last sample, and their covariance along each axis.
fn filtered(
    values: &[DVec3],
    regimes: &[Regime],
    step_s: f64,
    noise: f64,
    expected: impl Fn(Regime) -> (DVec3, f64),
) -> ((DVec3, DVec3), [f64; 3]) {
    let (mut place, mut rate) = (values[0], DVec3::ZERO);
    let (mut pp, mut pv, mut vv) = (noise * noise, 0.0, UNKNOWN_SPEED * UNKNOWN_SPEED);
    for k in 1..values.len() {
        // Where one of both samples is in a blow, so is the time between.
        let wilder = expected(regimes[k - 1]).1 > expected(regimes[k]).1;
        let (drift, stray) = expected(regimes[k - usize::from(wilder)]);
        let (dt, power) = (step_s, stray * stray * step_s);
        place += rate * dt + 0.5 * drift * dt * dt;
        rate += drift * dt;
        pp += dt * (2.0 * pv + dt * vv) + power * dt * dt * dt / 3.0;
        pv += dt * vv + power * dt * dt / 2.0;
        vv += power * dt;
        let sum = pp + noise * noise;
        let (to_place, to_rate) = (pp / sum, pv / sum);
        let news = values[k] - place;
        place += to_place * news;
        rate += to_rate * news;
        vv -= to_rate * pv;
        pv *= 1.0 - to_place;
        pp *= 1.0 - to_place;
    }
    ((place, rate), [pp, pv, vv])
}

/// A place and a rate with this covariance along each axis.
fn draw(stream: &mut Stream, [pp, pv, vv]: [f64; 3]) -> (DVec3, DVec3) {
    let place_sd = pp.max(0.0).sqrt();
    let lean = if place_sd > 0.0 { pv / place_sd } else { 0.0 };
    let rest = (vv - lean * lean).max(0.0).sqrt();
    let mut normal = || DVec3::from_array([(); 3].map(|()| stream.normal()));
    let (a, b) = (normal(), normal());
    (place_sd * a, lean * a + rest * b)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// In flight, with no random accelerations to speak of, the filter is the straight line of least squares through
    /// the samples (freed from the fall), whose slope is known to noise sqrt(12 / (n (n² - 1))) / dt.
    #[test]
    fn a_flight_start_is_the_line_of_least_squares() {
        let (step_s, g, noise, count) = (0.01, 9.81, 1e-3, SAMPLES);
        let mut stream = Key::root(8).stream();
        let truth = |t: f64| DVec3::new(t, 2.0 * t - 0.5 * g * t * t, 0.0);
        let values: Vec<DVec3> = (0..count)
            .map(|k| {
                truth(k as f64 * step_s)
                    + noise * DVec3::new(stream.normal(), stream.normal(), stream.normal())
            })
            .collect();
        let regimes = vec![Regime::Flight; count];
        let fall = DVec3::NEG_Y * g;
        let ((place, rate), [pp, _, vv]) =
            filtered(&values, &regimes, step_s, noise, |_| (fall, 0.0));
        let end = (count - 1) as f64 * step_s;
        let time = |k: usize| k as f64 * step_s - end;
        let straight: Vec<DVec3> = (0..count)
            .map(|k| values[k] - 0.5 * fall * time(k).powi(2))
            .collect();
        let mean: DVec3 = straight.iter().sum::<DVec3>() / count as f64;
        let mean_t = (0..count).map(time).sum::<f64>() / count as f64;
        let spread: f64 = (0..count).map(|k| (time(k) - mean_t).powi(2)).sum();
        let slope: DVec3 = (0..count)
            .map(|k| straight[k] * (time(k) - mean_t))
            .sum::<DVec3>()
            / spread;
        // What is known before the first sample, 50 m/s, is not nothing.
        assert!((rate - slope).length() < 1e-5, "{rate} {slope}");
        assert!((place - (mean - slope * mean_t)).length() < 1e-6);
        let n = count as f64;
        let slope_sd = noise / step_s * (12.0 / (n * (n * n - 1.0))).sqrt();
        assert!((vv.sqrt() / slope_sd - 1.0).abs() < 1e-3);
        let place_sd = noise * (1.0 / n + mean_t * mean_t / spread).sqrt();
        assert!((pp.sqrt() / place_sd - 1.0).abs() < 1e-3);
    }

    /// Draws have the covariance that they are drawn from: 20,000 draws of three axes tell it to 1 % (3 sd 0.9 %).
    #[test]
    fn nudges_have_the_covariance_of_the_estimate() {
        let mut stream = Key::root(1).stream();
        let want = [4.0, -1.0, 0.5];
        let (mut sums, count) = ([0.0; 3], 20_000);
        for _ in 0..count {
            let (p, v) = draw(&mut stream, want);
            sums[0] += p.dot(p);
            sums[1] += p.dot(v);
            sums[2] += v.dot(v);
        }
        let found = sums.map(|sum| sum / (3.0 * f64::from(count)));
        assert!((found[0] / want[0] - 1.0).abs() < 0.02, "{found:?}");
        assert!((found[1] / want[1] - 1.0).abs() < 0.04, "{found:?}");
        assert!((found[2] / want[2] - 1.0).abs() < 0.02, "{found:?}");
    }
}
