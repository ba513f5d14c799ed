//! The motion that a window starts from, estimated from the measured poses up to it.

use super::motion::MotionState;
use super::pose_tracks::PoseTrack;
use super::regime::ContactRegime;
use crate::bundle::rotation_vector_between;
use crate::median::median;
use dwell_scene::random::{RandomKey, RandomStream};
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
pub struct TrackerNoise {
    /// m.
    pub position_m: f64,
    /// rad.
    pub rotation_rad: f64,
}

impl TrackerNoise {
    /// Returns what flights show of it: second differences of positions, freed from the fall, and of rotations have the square
    /// root of six times the noise of one sample. The median keeps what is no noise out.
    pub fn estimate(episodes: &[PoseTrack], step_s: f64, gravity_m_s2: f64) -> Self {
        let fall = DVec3::NEG_Y * (gravity_m_s2 * step_s * step_s);
        let (mut shifts, mut turns) = (Vec::new(), Vec::new());
        for track in episodes {
            for (motions, regimes) in track.motions.windows(3).zip(track.regimes.windows(3)) {
                if regimes
                    .iter()
                    .any(|regime| *regime != ContactRegime::Flight)
                {
                    continue;
                }
                let [a, b, c] = [&motions[0], &motions[1], &motions[2]];
                let shift = c.position - 2.0 * b.position + a.position - fall;
                let bend = rotation_vector_between(b.rotation, c.rotation)
                    - rotation_vector_between(a.rotation, b.rotation);
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

/// The motion that a window at the sample `at` starts from: the end of a smoother over the samples up to it (which there is
/// the Kalman filter), with positions and rotations measured and accelerations random; how large they are is a matter of the
/// regime. Recorded velocities, which are often filtered differences that lag, are not looked at, nor is anything after the
/// start. With a `nudge` the tracker's noise is drawn once more and added to every sample: another start that could as well
/// have been measured.
///
/// # Source
/// H. E. Rauch, F. Tung, C. T. Striebel, AIAA Journal 3, 1445 (1965); accelerations as white noise: Y. Bar-Shalom, X. R. Li,
/// T. Kirubarajan, Estimation with Applications to Tracking and Navigation (2001), section 6.2.2.
pub fn window_start(
    track: &PoseTrack,
    at: usize,
    step_s: f64,
    gravity_m_s2: f64,
    noise: &TrackerNoise,
    nudge: Option<RandomKey>,
) -> MotionState {
    let past = (at + 1).saturating_sub(SAMPLES)..at + 1;
    let (motions, regimes) = (&track.motions[past.clone()], &track.regimes[past]);
    let here = track.motions[at];
    let mut stream = nudge.map(RandomKey::stream);
    let mut off = |sd: f64| {
        let mut normal = || stream.as_mut().map_or(0.0, RandomStream::normal);
        sd * DVec3::new(normal(), normal(), normal())
    };
    let places: Vec<DVec3> = motions
        .iter()
        .map(|m| m.position + off(noise.position_m))
        .collect();
    let turns: Vec<DVec3> = motions
        .iter()
        .map(|m| rotation_vector_between(here.rotation, m.rotation) + off(noise.rotation_rad))
        .collect();
    let turned_by = |by: DVec3| (DQuat::from_scaled_axis(by) * here.rotation).normalize();
    if let ([place], [turned]) = (&places[..], &turns[..]) {
        // Nothing before: the velocities that were recorded must do.
        return MotionState {
            position: *place,
            rotation: turned_by(*turned),
            ..here
        };
    }
    let fall = DVec3::NEG_Y * gravity_m_s2;
    let (position, linear) = kalman_filter(&places, regimes, step_s, noise.position_m, |regime| {
        let drift = if regime == ContactRegime::Flight {
            fall
        } else {
            DVec3::ZERO
        };
        (drift, LINEAR_M_S2[acceleration_index(regime)])
    });
    let (turned, angular) = kalman_filter(&turns, regimes, step_s, noise.rotation_rad, |regime| {
        (DVec3::ZERO, ANGULAR_RAD_S2[acceleration_index(regime)])
    });
    MotionState {
        position,
        rotation: turned_by(turned),
        linear,
        angular,
    }
}

/// Standard deviation of accelerations about their expected value over a sample: in flight, in a blow, in contact, at rest. m/s².
const LINEAR_M_S2: [f64; 4] = [0.1, 150.0, 5.0, 0.3];
/// The same for angular accelerations, rad/s².
const ANGULAR_RAD_S2: [f64; 4] = [1.0, 1500.0, 100.0, 5.0];

fn acceleration_index(regime: ContactRegime) -> usize {
    match regime {
        ContactRegime::Flight => 0,
        ContactRegime::Impact => 1,
        ContactRegime::Rest => 3,
        ContactRegime::Contact => 2,
    }
}

/// The place and its rate at the last sample.
fn kalman_filter(
    values: &[DVec3],
    regimes: &[ContactRegime],
    step_s: f64,
    noise: f64,
    expected: impl Fn(ContactRegime) -> (DVec3, f64),
) -> (DVec3, DVec3) {
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
    (place, rate)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// In flight, with no random accelerations to speak of, the filter is the straight line of least squares through
    /// the samples, freed from the fall.
    #[test]
    fn a_flight_start_is_the_line_of_least_squares() {
        let (step_s, g, noise, count) = (0.01, 9.81, 1e-3, SAMPLES);
        let mut stream = RandomKey::root(8).stream();
        let truth = |t: f64| DVec3::new(t, 2.0 * t - 0.5 * g * t * t, 0.0);
        let values: Vec<DVec3> = (0..count)
            .map(|k| {
                let off = DVec3::new(stream.normal(), stream.normal(), stream.normal());
                truth(k as f64 * step_s) + noise * off
            })
            .collect();
        let regimes = vec![ContactRegime::Flight; count];
        let fall = DVec3::NEG_Y * g;
        let (place, rate) = kalman_filter(&values, &regimes, step_s, noise, |_| (fall, 0.0));
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
    }

    /// The scatter of nudged starts is what the tracker's noise makes of a slope through n samples,
    /// noise sqrt(12 / (n (n² - 1))) / dt, within 5 % (2,000 draws of three axes tell it to 1 %; the accelerations that the
    /// filter allows for cost some).
    #[test]
    fn nudges_scatter_as_the_noise_of_the_tracker_does() {
        let (step_s, count) = (0.007, SAMPLES);
        let noise = TrackerNoise {
            position_m: 1e-3,
            rotation_rad: 1e-2,
        };
        let still = MotionState {
            position: DVec3::Y,
            rotation: DQuat::IDENTITY,
            linear: DVec3::ZERO,
            angular: DVec3::ZERO,
        };
        let track = PoseTrack {
            name: String::new(),
            group: String::new(),
            motions: vec![still; count],
            regimes: vec![ContactRegime::Flight; count],
            start: 0,
            start_motion: still,
        };
        let start = |nudge| window_start(&track, count - 1, step_s, 0.0, &noise, nudge);
        let plain = start(None);
        assert!(plain.linear.length() < 1e-12 && plain.angular.length() < 1e-12);
        let draws = 2_000_u64;
        let (mut linear, mut angular) = (0.0, 0.0);
        for k in 0..draws {
            let nudged = start(Some(RandomKey::root(3).child(k)));
            linear += nudged.linear.length_squared();
            angular += nudged.angular.length_squared();
        }
        let n = count as f64;
        let slope = (12.0 / (n * (n * n - 1.0))).sqrt() / step_s;
        let sd = |sum: f64| (sum / (3.0 * draws as f64)).sqrt();
        assert!((sd(linear) / (noise.position_m * slope) - 1.0).abs() < 0.05);
        assert!((sd(angular) / (noise.rotation_rad * slope) - 1.0).abs() < 0.05);
    }
}
