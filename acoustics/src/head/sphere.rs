//! Heads as rigid spheres.

use super::series::sphere_response;
use crate::bands::{self, BAND_COUNT, BandValues};
use realfft::num_complex::Complex;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Angles of incidence in the table: every 3 degrees.
const ANGLES: usize = 61;

/// Returns the arrival time of a plane wave at a point on a sphere, s, re its arrival at the centre.
///
/// # Source
/// R. S. Woodworth, H. Schlosberg, *Experimental Psychology* (1954): straight on the lit side, along the great circle on
/// the other. The difference of two ears is (a/c)(theta + sin theta).
pub fn woodworth_delay_s(cos_incidence: f64, radius_m: f64, speed_m_s: f64) -> f64 {
    let cos = cos_incidence.clamp(-1.0, 1.0);
    let way = if cos >= 0.0 {
        -cos
    } else {
        libm::acos(cos) - FRAC_PI_2
    };
    way * radius_m / speed_m_s
}

/// The filters of a spherical head, tabulated over the angle of incidence.
///
/// The exact response is split into the delay of [`woodworth_delay_s`], which paths have with sub-sample precision, and a
/// smooth remainder: head shadow, the doubling on the near side, and the longer delay of long waves.
#[derive(Debug)]
pub(crate) struct SphericalHead {
    radius_m: f64,
    speed_m_s: f64,
    /// The remainder at each bin of the path filters. Shape (angle, bin).
    rest: Vec<Vec<Complex<f32>>>,
    /// Gain of amplitude in each band. Shape (angle, band).
    gain: Vec<BandValues>,
    /// Total delay in each band, s. Shape (angle, band).
    delay_s: Vec<BandValues>,
}

fn angle_of(index: usize) -> f64 {
    PI * index as f64 / (ANGLES - 1) as f64
}

impl SphericalHead {
    /// A head of `radius_m` in air with `speed_m_s`, for spectra of `bins` values up to half of `rate_hz`.
    pub(crate) fn new(radius_m: f64, speed_m_s: f64, rate_hz: f64, bins: usize) -> Self {
        let cosines: Vec<f64> = (0..ANGLES).map(|k| libm::cos(angle_of(k))).collect();
        let advance: Vec<f64> = cosines
            .iter()
            .map(|cos| woodworth_delay_s(*cos, radius_m, speed_m_s))
            .collect();
        let response = |frequency_hz: f64| {
            let omega = TAU * frequency_hz;
            let mut values = sphere_response(omega * radius_m / speed_m_s, &cosines);
            for (value, delay) in values.iter_mut().zip(&advance) {
                let phase = omega * delay;
                *value *= Complex::new(libm::cos(phase), libm::sin(phase));
            }
            values
        };
        let mut rest = vec![vec![Complex::default(); bins]; ANGLES];
        for bin in 0..bins {
            let frequency_hz = 0.5 * rate_hz * bin as f64 / (bins - 1).max(1) as f64;
            for (row, value) in rest.iter_mut().zip(response(frequency_hz)) {
                row[bin] = Complex::new(value.re as f32, value.im as f32);
            }
        }
        let mut gain = vec![[0.0; BAND_COUNT]; ANGLES];
        let mut delay_s = vec![[0.0; BAND_COUNT]; ANGLES];
        for band in 0..BAND_COUNT {
            let frequency_hz = bands::exact_centre_hz(band);
            for (k, value) in response(frequency_hz).into_iter().enumerate() {
                gain[k][band] = libm::hypot(value.re, value.im) as f32;
                delay_s[k][band] =
                    (advance[k] - libm::atan2(value.im, value.re) / (TAU * frequency_hz)) as f32;
            }
        }
        Self {
            radius_m,
            speed_m_s,
            rest,
            gain,
            delay_s,
        }
    }

    /// Returns the place between two rows of the tables.
    fn place(cos_incidence: f64) -> (usize, f32) {
        let angle = dwell_scene::math::acos(cos_incidence as f32);
        let place = angle * ((ANGLES - 1) as f32 / std::f32::consts::PI);
        let below = (place as usize).min(ANGLES - 2);
        (below, place - below as f32)
    }

    /// Returns the delay of a path re the head's centre, s; negative on the near side.
    pub(crate) fn delay_s(&self, cos_incidence: f64) -> f64 {
        woodworth_delay_s(cos_incidence, self.radius_m, self.speed_m_s)
    }

    /// Multiplies a path's spectrum by the response without its delay.
    pub(crate) fn apply_undelayed_response(
        &self,
        cos_incidence: f64,
        spectrum: &mut [Complex<f32>],
    ) {
        let (below, way) = Self::place(cos_incidence);
        let rows = self.rest[below].iter().zip(&self.rest[below + 1]);
        for (value, (a, b)) in spectrum.iter_mut().zip(rows) {
            *value *= a + (b - a) * way;
        }
    }

    /// Returns gain of amplitude and delay re the head's centre (s) in each band.
    pub(crate) fn gain_and_delay(&self, cos_incidence: f64) -> (BandValues, BandValues) {
        let (below, way) = Self::place(cos_incidence);
        let mix = |table: &[BandValues]| {
            let (a, b) = (&table[below], &table[below + 1]);
            std::array::from_fn(|band| a[band] + (b[band] - a[band]) * way)
        };
        (mix(&self.gain), mix(&self.delay_s))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// V17: Woodworth's differences for a radius of 8.75 cm, in microseconds.
    #[test]
    fn ear_delays_differ_as_woodworth_has_it() {
        let printed = [
            (30.0, 261.0),
            (45.0, 381.0),
            (60.0, 488.0),
            (90.0, 655.0),
            (120.0, 488.0),
            (150.0, 261.0),
        ];
        for (azimuth_deg, microseconds) in printed {
            let sin = libm::sin(f64::to_radians(azimuth_deg));
            // The source is at the left: the left ear's incidence has the positive cosine.
            let left = woodworth_delay_s(sin, 0.0875, 343.2);
            let right = woodworth_delay_s(-sin, 0.0875, 343.2);
            assert!(
                (1e6 * (right - left) - microseconds).abs() < 1.0,
                "{azimuth_deg}"
            );
        }
    }

    #[test]
    fn the_table_shades_the_far_ear_more_at_high_frequencies() {
        let head = SphericalHead::new(0.0875, 343.2, 16_000.0, 257);
        let (near, near_delay) = head.gain_and_delay(1.0);
        let (far, far_delay) = head.gain_and_delay(-0.7);
        assert!(
            near[0] / far[0] < 1.02 && near[7] / far[7] > 3.0,
            "{near:?} {far:?}"
        );
        // Long waves: 1.5 a/c (cos a - cos b); short waves near Woodworth.
        let low = f64::from(far_delay[0] - near_delay[0]);
        assert!((low - 1.5 * 0.0875 / 343.2 * 1.7).abs() < 10e-6, "{low}");
        let high = f64::from(far_delay[6] - near_delay[6]);
        let woodworth = head.delay_s(-0.7) - head.delay_s(1.0);
        assert!((high - woodworth).abs() < 60e-6, "{high} {woodworth}");
    }
}
