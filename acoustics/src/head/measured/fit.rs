//! The sphere fitted to a measured head.

use super::spectra::ComplexExponentials;
use crate::head::{Ear, sphere_response, woodworth_delay_s};
use glam::DVec3;
use realfft::num_complex::Complex;
use std::f64::consts::TAU;

/// Speed of sound during measurements, m/s.
const SPEED_M_S: f64 = 343.2;
/// Frequencies at which levels are compared, Hz: a head is small against these waves, and loudspeakers reproduce them.
const LEVELS_HZ: [f64; 5] = [200.0, 250.0, 315.0, 400.0, 500.0];
/// Range of radii of heads, m.
const RADII_M: (f64, f64) = (0.05, 0.15);
/// Radius where delays do not determine it, m.
const USUAL_RADIUS_M: f64 = 0.0875;
/// Number of measured directions used for one that was not measured.
const NEIGHBOURS: usize = 6;
/// Directions within this of each other share their weight: the cosine of 10 degrees.
const CLOSE_COSINE: f64 = 0.984_807_753;

/// A sphere fitted to a measured head.
pub(super) struct SphereFit {
    pub(super) radius_m: f64,
    /// Delay common to all responses, re the sphere, s.
    pub(super) common_delay_s: f64,
    /// Share of the sphere of each direction, up to a factor.
    weights: Vec<f64>,
}

/// Measured directions and their weights.
pub(super) struct WeightedDirections(pub(super) Vec<(usize, f64)>);

impl WeightedDirections {
    /// Returns the directions nearest to one, weighted by the inverse square of the distance; the weights sum to 1.
    pub(super) fn near(directions: &[DVec3], towards: DVec3) -> Self {
        let mut all: Vec<(usize, f64)> = directions
            .iter()
            .map(|d| d.distance_squared(towards))
            .enumerate()
            .collect();
        all.sort_by(|a, b| a.1.total_cmp(&b.1).then(a.0.cmp(&b.0)));
        all.truncate(NEIGHBOURS);
        for (_, x) in &mut all {
            *x = 1.0 / x.max(1e-9);
        }
        let sum: f64 = all.iter().map(|(_, w)| w).sum();
        for (_, x) in &mut all {
            *x /= sum;
        }
        Self(all)
    }
}

/// Returns the cosine of the angle between a direction and an ear's axis.
pub(super) fn cosine(direction: DVec3, ear: usize) -> f64 {
    direction.dot(Ear::BOTH[ear].axis_in_head().as_dvec3())
}

impl SphereFit {
    /// Fits the radius and the common delay by least squares between all delays and Woodworth's.
    pub(super) fn new(directions: &[DVec3], delay_s: &[[f64; 2]]) -> Self {
        let crowd = |d: &DVec3| {
            let close = directions.iter().filter(|e| e.dot(*d) > CLOSE_COSINE);
            1.0 / close.count().max(1) as f64
        };
        let weights: Vec<f64> = directions.iter().map(crowd).collect();
        let of_unit = |k: usize, ear: usize| {
            // For a radius of 1 m.
            woodworth_delay_s(cosine(directions[k], ear), 1.0, SPEED_M_S)
        };
        let mean = |value: &dyn Fn(usize, usize) -> f64| {
            let (mut sum, mut all) = (0.0, 0.0);
            for (k, weight) in weights.iter().enumerate() {
                for ear in 0..2 {
                    sum += weight * value(k, ear);
                    all += weight;
                }
            }
            sum / all
        };
        let (x, y) = (mean(&of_unit), mean(&|k, ear| delay_s[k][ear]));
        let xx = mean(&|k, ear| (of_unit(k, ear) - x) * (of_unit(k, ear) - x));
        let xy = mean(&|k, ear| (of_unit(k, ear) - x) * (delay_s[k][ear] - y));
        // Directions in the median plane alone do not determine the radius.
        let radius_m = if xx * SPEED_M_S * SPEED_M_S > 1e-3 {
            (xy / xx).clamp(RADII_M.0, RADII_M.1)
        } else {
            USUAL_RADIUS_M
        };
        Self {
            radius_m,
            common_delay_s: y - radius_m * x,
            weights,
        }
    }

    /// Returns the delay of a wave at the sphere, s.
    fn delay_s(&self, direction: DVec3, ear: usize) -> f64 {
        woodworth_delay_s(cosine(direction, ear), self.radius_m, SPEED_M_S)
    }

    /// Returns the gain that gives all responses the sphere's energy at low frequencies.
    pub(super) fn level_matching_gain(
        &self,
        directions: &[DVec3],
        responses: &[[Vec<f32>; 2]],
        rate_hz: f64,
        samples: usize,
    ) -> f64 {
        let waves = ComplexExponentials::new(&LEVELS_HZ, rate_hz, samples);
        let (mut sphere, mut head) = (0.0, 0.0);
        for ((direction, pair), weight) in directions.iter().zip(responses).zip(&self.weights) {
            for (ear, response) in pair.iter().enumerate() {
                for (frequency_hz, value) in LEVELS_HZ.iter().zip(waves.spectrum(response)) {
                    let there = self.response(*frequency_hz, &[cosine(*direction, ear)]);
                    sphere += weight * there[0].norm_sqr();
                    head += weight * f64::from(value.norm_sqr());
                }
            }
        }
        (sphere / head.max(1e-30)).sqrt()
    }

    /// Returns pressure at the sphere over that at its centre without it. Shape (cosine,).
    fn response(&self, frequency_hz: f64, cosines: &[f64]) -> Vec<Complex<f64>> {
        sphere_spectrum(self.radius_m, frequency_hz, cosines)
    }

    /// Returns the delays from a direction that was not measured: the sphere's, plus the deviation of those nearby, s.
    pub(super) fn extrapolated_delay_s(
        &self,
        directions: &[DVec3],
        delay_s: &[[f64; 2]],
        near: &WeightedDirections,
        towards: DVec3,
    ) -> [f64; 2] {
        [0, 1].map(|ear| {
            let differs = |(k, weight): &(usize, f64)| {
                weight * (delay_s[*k][ear] - self.delay_s(directions[*k], ear))
            };
            self.delay_s(towards, ear) + near.0.iter().map(differs).sum::<f64>()
        })
    }
}

/// Returns the pressure at a sphere, with the delay of [`woodworth_delay_s`] included. Shape (cosine,).
pub(super) fn sphere_spectrum(
    radius_m: f64,
    frequency_hz: f64,
    cosines: &[f64],
) -> Vec<Complex<f64>> {
    sphere_response(TAU * frequency_hz * radius_m / SPEED_M_S, cosines)
}

/// Returns the phase that removes Woodworth's delay from [`sphere_spectrum`].
pub(super) fn delay_removal_phase(radius_m: f64, frequency_hz: f64, cosine: f64) -> Complex<f64> {
    let phase = TAU * frequency_hz * woodworth_delay_s(cosine, radius_m, SPEED_M_S);
    Complex::new(libm::cos(phase), libm::sin(phase))
}
