//! Filters of a measured head for any direction.

use super::HeadResponses;
use super::fit::{WeightedDirections, cosine, delay_removal_phase, sphere_spectrum};
use super::hull::Triangulation;
use super::spectra::{ComplexExponentials, modulus};
use crate::bands::{self, BAND_COUNT, BandValues};
use crate::fft::RealFft;
use crate::head::Ear;
use glam::{DVec3, Vec3};
use realfft::num_complex::Complex;
use std::f64::consts::TAU;
use std::sync::Arc;

/// Range of the crossover from a head's theoretical bass response to the measured one, Hz.
const BASS_HZ: (f64, f64) = (80.0, 160.0);
/// Upper end of the range from [`BASS_HZ`] on in which the phase gives the delay of the bass, Hz.
const DELAY_HZ: f64 = 320.0;
/// Largest correction of the bass, as a logarithm of amplitude: 26 dB.
const MOST_BASS: f64 = 3.0;
/// Highest frequency used of a measurement, over its sample rate.
const HIGHEST: f64 = 0.46;

/// A measured head at one sample rate.
#[derive(Debug)]
pub(crate) struct MeasuredHead {
    mesh: Arc<Triangulation>,
    /// Shape (direction, ear).
    rows: Vec<[DirectionRow; 2]>,
}

/// The filter of one ear for a direction of the table.
#[derive(Debug)]
struct DirectionRow {
    /// Against the head's centre, s.
    delay_s: f64,
    /// The spectrum without the delay. Shape (bin,).
    rest: Vec<Complex<f32>>,
    /// Gain of amplitude and total delay (s) in each band.
    gain: BandValues,
    late_s: BandValues,
}

impl HeadResponses {
    /// Returns tables for spectra of `bins` values up to half of `rate_hz`.
    pub(in crate::head) fn tables(&self, rate_hz: f64, bins: usize) -> MeasuredHead {
        let step_hz = 0.5 * rate_hz / (bins - 1).max(1) as f64;
        let frequencies: Vec<f64> = (0..bins).map(|bin| bin as f64 * step_hz).collect();
        let highest_hz = HIGHEST * self.rate_hz;
        let heard: Vec<f64> = frequencies.iter().map(|f| f.min(highest_hz)).collect();
        let waves = ComplexExponentials::new(&heard, self.rate_hz, self.samples);
        let shares: Vec<[f64; BAND_COUNT]> = frequencies
            .iter()
            .map(|f| bands::power_shares(*f, 1.0))
            .collect();
        let finish = |delay_s: f64, rest: Vec<Complex<f32>>, per_hz: f64| {
            let gain = band_gains(&rest, &shares);
            let late_s = band_delays(&rest, step_hz, delay_s, per_hz);
            DirectionRow {
                delay_s,
                rest,
                gain,
                late_s,
            }
        };
        let measured = self.pressure.len();
        let mut rests: Vec<[Vec<Complex<f32>>; 2]> = Vec::with_capacity(measured);
        for (pair, begin_s) in self.pressure.iter().zip(&self.begin_s) {
            rests.push([0, 1].map(|ear| {
                let mut rest = waves.spectrum(&pair[ear]);
                for (value, frequency_hz) in rest.iter_mut().zip(&heard) {
                    let turns = frequency_hz * begin_s[ear];
                    let (s, c) = libm::sincos(TAU * (turns - turns.floor()));
                    *value *= Complex::new(c as f32, s as f32);
                }
                rest
            }));
        }
        let bass = bass_equalizer(&rests, &frequencies);
        let common = common_phase(&rests, &bass);
        let mut rows: Vec<[DirectionRow; 2]> = Vec::with_capacity(self.directions.len());
        for ([left, right], delay_s) in rests.into_iter().zip(&self.delay_s) {
            let whole = |delay_s: f64, mut rest: Vec<Complex<f32>>| {
                for (value, bass) in rest.iter_mut().zip(&bass) {
                    *value *= bass;
                }
                let per_hz = slope(&rest, &common, &frequencies);
                idealize_bass(&mut rest, &common, &frequencies, per_hz);
                finish(delay_s, rest, per_hz)
            };
            rows.push([whole(delay_s[0], left), whole(delay_s[1], right)]);
        }
        let radius_m = self.about.radius_m;
        let none = vec![0.0; bins];
        for (k, direction) in self.directions.iter().enumerate().skip(measured) {
            let near = WeightedDirections::near(&self.directions[..measured], *direction);
            let pair = [0, 1].map(|ear| {
                let like = |k: &usize| &rows[*k][ear].rest;
                let rest = extrapolated_response(
                    &self.directions,
                    &near,
                    like,
                    *direction,
                    ear,
                    radius_m,
                    &frequencies,
                );
                let per_hz = slope(&rest, &none, &frequencies);
                finish(self.delay_s[k][ear], rest, per_hz)
            });
            rows.push(pair);
        }
        MeasuredHead {
            mesh: self.mesh.clone(),
            rows,
        }
    }
}

/// Returns the response of a sphere in a direction, with the level deviations of those nearby.
fn extrapolated_response<'a>(
    directions: &[DVec3],
    near: &WeightedDirections,
    rest_of: impl Fn(&usize) -> &'a Vec<Complex<f32>>,
    towards: DVec3,
    ear: usize,
    radius_m: f64,
    frequencies: &[f64],
) -> Vec<Complex<f32>> {
    let own = cosine(towards, ear);
    let mut cosines = vec![own];
    cosines.extend(near.0.iter().map(|(k, _)| cosine(directions[*k], ear)));
    let log = |x: f64| libm::log(x.max(1e-12));
    frequencies
        .iter()
        .enumerate()
        .map(|(bin, frequency_hz)| {
            let sphere = sphere_spectrum(radius_m, *frequency_hz, &cosines);
            let differs: f64 = near
                .0
                .iter()
                .zip(&sphere[1..])
                .map(|((k, weight), there)| {
                    let found = f64::from(modulus(rest_of(k)[bin]));
                    weight * (log(found) - 0.5 * log(there.norm_sqr()))
                })
                .sum();
            let rest =
                sphere[0] * delay_removal_phase(radius_m, *frequency_hz, own) * libm::exp(differs);
            Complex::new(rest.re as f32, rest.im as f32)
        })
        .collect()
}

/// Returns the minimum-phase filter that makes the mean energy of all responses 1 below [`BASS_HZ`] and leaves all as it is
/// above. Shape (bin,).
fn bass_equalizer(rests: &[[Vec<Complex<f32>>; 2]], frequencies: &[f64]) -> Vec<Complex<f32>> {
    let mut fft = RealFft::new(2 * (frequencies.len() - 1));
    let mut logs: Vec<Complex<f32>> = (0..fft.bins()).map(|_| Complex::default()).collect();
    let (low, high) = BASS_HZ;
    for (bin, (log, frequency_hz)) in logs.iter_mut().zip(frequencies).enumerate() {
        if *frequency_hz >= high {
            break;
        }
        let octaves = libm::log2(frequency_hz.max(1.0) / low) / libm::log2(high / low);
        let cosine = libm::cos(std::f64::consts::FRAC_PI_2 * octaves.clamp(0.0, 1.0));
        let all = rests.iter().flatten();
        let energy: f64 = all.map(|rest| f64::from(rest[bin].norm_sqr())).sum();
        let mean = energy / (2 * rests.len()).max(1) as f64;
        let missing = -0.5 * libm::log(mean.max(1e-12));
        log.re = (cosine * cosine * missing.clamp(-MOST_BASS, MOST_BASS)) as f32;
    }
    // The causal half of the cepstrum, doubled: see `PathFilters`.
    let mut cepstrum = fft.inverse(&mut logs);
    let half = fft.len() / 2;
    for x in &mut cepstrum[1..half] {
        *x *= 2.0;
    }
    cepstrum[half + 1..].fill(0.0);
    let logs = fft.forward(&cepstrum).into_iter();
    logs.map(|log| {
        let (s, c) = libm::sincosf(log.im);
        Complex::new(c, s) * libm::expf(log.re)
    })
    .collect()
}

/// Returns the common phase of all responses, the loudspeaker's. Shape (bin,).
fn common_phase(rests: &[[Vec<Complex<f32>>; 2]], bass: &[Complex<f32>]) -> Vec<f32> {
    let both = bass.iter().enumerate().map(|(bin, bass)| {
        let mut sum = Complex::new(0.0_f32, 0.0);
        for rest in rests.iter().flatten() {
            sum += rest[bin];
        }
        angle(&(sum * bass))
    });
    both.collect()
}

fn angle(value: &Complex<f32>) -> f32 {
    libm::atan2f(value.im, value.re)
}

/// Returns the slope of the phase re the common one from [`BASS_HZ`] to [`DELAY_HZ`], rad/Hz: the least squares of a line through 0.
fn slope(rest: &[Complex<f32>], common: &[f32], frequencies: &[f64]) -> f64 {
    let (mut sum, mut all) = (0.0, 0.0);
    for ((value, common), frequency_hz) in rest.iter().zip(common).zip(frequencies) {
        if (BASS_HZ.1..DELAY_HZ).contains(frequency_hz) {
            let (s, c) = libm::sincosf(*common);
            let own = angle(&(value * Complex::new(c, -s)));
            sum += f64::from(own) * frequency_hz;
            all += frequency_hz * frequency_hz;
        }
    }
    if all > 0.0 { sum / all } else { 0.0 }
}

/// Below [`BASS_HZ`] the differences between responses are noise, and a head only delays: the level goes to 1, and the
/// phase to the common one and the delay of the frequencies above.
fn idealize_bass(rest: &mut [Complex<f32>], common: &[f32], frequencies: &[f64], per_hz: f64) {
    let (low, high) = BASS_HZ;
    for ((value, common), frequency_hz) in rest.iter_mut().zip(common).zip(frequencies) {
        if *frequency_hz >= high {
            break;
        }
        let octaves = libm::log2(frequency_hz.max(1.0) / low) / libm::log2(high / low);
        let sine = libm::sin(std::f64::consts::FRAC_PI_2 * octaves.clamp(0.0, 1.0));
        let own = (sine * sine) as f32;
        let level = libm::expf(own * libm::logf(modulus(*value).max(1e-6)));
        let (s, c) = libm::sincosf(*common);
        let differs = angle(&(*value * Complex::new(c, -s)));
        let delayed = (per_hz * frequency_hz) as f32;
        let (s, c) = libm::sincosf(common + own * differs + (1.0 - own) * delayed);
        *value = Complex::new(level * c, level * s);
    }
}

/// Returns the root of the mean energy in each band.
fn band_gains(rest: &[Complex<f32>], shares: &[[f64; BAND_COUNT]]) -> BandValues {
    std::array::from_fn(|band| {
        let (mut sum, mut all) = (0.0, 0.0);
        for (value, share) in rest.iter().zip(shares) {
            sum += share[band] * f64::from(value.norm_sqr());
            all += share[band];
        }
        if all > 0.0 {
            (sum / all).sqrt() as f32
        } else {
            1.0
        }
    })
}

/// Returns the delay of a wave at each band's centre, s: the common delay, and that of the remaining phase; in the bass,
/// where the phase is the loudspeaker's, by its slope re that (rad/Hz).
fn band_delays(rest: &[Complex<f32>], step_hz: f64, delay_s: f64, per_hz: f64) -> BandValues {
    // The unwrapped phase, from the first frequency that is the head's.
    let first = (BASS_HZ.1 / step_hz).ceil() as usize;
    let mut phase = vec![0.0; first.min(rest.len())];
    let mut last = 0.0_f64;
    for value in rest.iter().skip(first) {
        let principal = f64::from(angle(value));
        last = principal - TAU * ((principal - last) / TAU).round();
        phase.push(last);
    }
    std::array::from_fn(|band| {
        let centre_hz = bands::exact_centre_hz(band);
        if centre_hz < BASS_HZ.1 {
            return (delay_s - per_hz / TAU) as f32;
        }
        let place = centre_hz / step_hz;
        let below = (place as usize).min(phase.len().saturating_sub(2));
        let way = place - below as f64;
        if below + 1 >= phase.len() || way > 1.0 {
            // Above half of the sample rate.
            return delay_s as f32;
        }
        let there = phase[below] + (phase[below + 1] - phase[below]) * way;
        (delay_s - there / (TAU * centre_hz)) as f32
    })
}

impl MeasuredHead {
    /// Returns the rows around a direction of an ear, and their weights.
    fn interpolation_rows(&self, ear: Ear, towards: Vec3) -> ([&DirectionRow; 3], [f32; 3]) {
        let (corners, weights) = self.mesh.locate(towards);
        let ear = match ear {
            Ear::Left => 0,
            Ear::Right => 1,
        };
        (corners.map(|k| &self.rows[k as usize][ear]), weights)
    }

    /// Returns gain of amplitude and delay re the head's centre (s) in each band, from `towards` in head space.
    pub(in crate::head) fn gain_and_delay(
        &self,
        ear: Ear,
        towards: Vec3,
    ) -> (BandValues, BandValues) {
        let ([a, b, c], [u, v, w]) = self.interpolation_rows(ear, towards);
        let mix = |of: fn(&DirectionRow) -> &BandValues| {
            let (a, b, c) = (of(a), of(b), of(c));
            std::array::from_fn(|band| u * a[band] + v * b[band] + w * c[band])
        };
        (mix(|row| &row.gain), mix(|row| &row.late_s))
    }

    /// Multiplies a spectrum by the response without its delay, and returns the delay re the head's centre, s.
    pub(in crate::head) fn apply_undelayed_response(
        &self,
        ear: Ear,
        towards: Vec3,
        spectrum: &mut [Complex<f32>],
    ) -> f64 {
        let ([a, b, c], [u, v, w]) = self.interpolation_rows(ear, towards);
        let rests = a.rest.iter().zip(&b.rest).zip(&c.rest);
        for (value, ((a, b), c)) in spectrum.iter_mut().zip(rests) {
            // Differing phases must not reduce the level.
            let mean = a * u + b * v + c * w;
            let size = modulus(*a) * u + modulus(*b) * v + modulus(*c) * w;
            let found = modulus(mean);
            *value *= if found > 0.0 {
                mean * (size / found)
            } else {
                Complex::new(size, 0.0)
            };
        }
        let delays = [a, b, c].into_iter().zip([u, v, w]);
        delays
            .map(|(row, weight)| f64::from(weight) * row.delay_s)
            .sum()
    }
}
