//! The tail as pressure: random arrivals whose energies are the histogram's.

use crate::bands::{BAND_COUNT, Banded, FilterBank};
use crate::echogram::{Bin, Echogram};
use crate::head::SphericalHead;
use dwell_scene::math::sin_cos;
use dwell_scene::random::{Key, Stream};
use glam::Vec3;
use std::f64::consts::PI;

/// Most arrivals a second: denser ones cannot be told apart.
const MOST_ARRIVALS_PER_S: f64 = 1e4;
/// Taps on either side of an arrival that falls between samples.
const HALF: i32 = 4;

/// What the noise is made from.
pub(super) struct Noise<'a> {
    pub(super) echogram: &'a Echogram,
    pub(super) rate_hz: f64,
    pub(super) length: usize,
    pub(super) head: &'a SphericalHead,
    pub(super) bank: &'a FilterBank,
}

/// Adds the tail to `out`, shape (ear, sample); an ear is the direction it points to, or nothing for a microphone.
///
/// Arrivals come at random (Poisson) with the density of a room of the volume in sight, each with a sign and a direction drawn
/// from those of its bin. Within a bin all arrivals are equally strong, and their energies sum to the bin's in every band.
/// Both ears hear the same arrivals, each with its own delay and shadow, so that their coherence is right.
///
/// # Source
/// D. Schroeder, *Physically Based Real-Time Auralization of Interactive Virtual Environments*, RWTH Aachen (2011),
/// section 5.3.4.
pub(super) fn add(noise: &Noise<'_>, ears: &[Option<Vec3>], key: Key, out: &mut [f32]) {
    let tail = &noise.echogram.tail;
    let mut buses = vec![vec![vec![0.0_f32; noise.length]; BAND_COUNT]; ears.len()];
    let mut any = false;
    for (k, bin) in super::smooth::smooth(tail).iter().enumerate() {
        if bin.energy.iter().all(|e| *e <= 0.0) {
            continue;
        }
        any = true;
        let start_s = k as f64 * tail.bin_s;
        if start_s * noise.rate_hz >= noise.length as f64 {
            break;
        }
        // Keyed by the bin, so that what is drawn in one bin does not depend on the others.
        let mut stream = key.child(k as u64).stream();
        let time_s = start_s + 0.5 * tail.bin_s;
        let volume = noise.echogram.trace.seen_volume_m3.max(1.0);
        let speed = noise.echogram.speed_m_s;
        let density = 4.0 * PI * speed * speed * speed * time_s * time_s / volume;
        let count = poisson(density.min(MOST_ARRIVALS_PER_S) * tail.bin_s, &mut stream).max(1);
        let amplitude: Banded =
            std::array::from_fn(|b| (bin.energy[b] / count as f64).sqrt() as f32);
        for _ in 0..count {
            let time_s = start_s + tail.bin_s * stream.uniform();
            let sign = if stream.bits() & 1 == 0 { 1.0 } else { -1.0 };
            let arrival = direction(bin, &mut stream);
            let pulse = amplitude.map(|a| sign * a);
            for (ear, bus) in ears.iter().zip(&mut buses) {
                noise.strike(bus, time_s, &pulse, ear.map(|axis| axis.dot(arrival)));
            }
        }
    }
    if !any {
        return;
    }
    for (bus, channel) in buses.iter().zip(out.chunks_exact_mut(noise.length)) {
        for (y, x) in channel.iter_mut().zip(noise.bank.blend(bus, noise.length)) {
            *y += x;
        }
    }
}

impl Noise<'_> {
    /// Adds one arrival to the bands of one ear.
    fn strike(&self, bus: &mut [Vec<f32>], time_s: f64, pulse: &Banded, cosine: Option<f32>) {
        let Some(cosine) = cosine else {
            let place = (time_s * self.rate_hz) as usize;
            for (band, amplitude) in bus.iter_mut().zip(pulse) {
                if let Some(x) = band.get_mut(place) {
                    *x += amplitude;
                }
            }
            return;
        };
        let (gain, delay_s) = self.head.banded(f64::from(cosine));
        for (band, samples) in bus.iter_mut().enumerate() {
            let place = (time_s + f64::from(delay_s[band])) * self.rate_hz;
            add_between(samples, place, pulse[band] * gain[band]);
        }
    }
}

/// Adds a pulse of energy `amplitude`² between two samples.
fn add_between(samples: &mut [f32], place: f64, amplitude: f32) {
    let whole = place.floor();
    let fraction = (place - whole) as f32;
    let mut weights = [0.0; 2 * HALF as usize];
    let mut energy = 0.0;
    let sine = libm::sinf(std::f32::consts::PI * fraction);
    for (weight, n) in weights.iter_mut().zip(1 - HALF..=HALF) {
        let x = n as f32 - fraction;
        let sinc = if x.abs() < 1e-4 {
            1.0
        } else {
            let sign = if n % 2 == 0 { -1.0 } else { 1.0 };
            sign * sine / (std::f32::consts::PI * x)
        };
        // A parabola in place of a bell: it is as good for noise, and needs no cosine.
        let edge = x / (HALF as f32 + 0.5);
        *weight = sinc * (1.0 - edge * edge);
        energy += *weight * *weight;
    }
    let scale = amplitude / energy.sqrt();
    let first = whole as i64 + 1 - i64::from(HALF);
    for (k, weight) in weights.iter().enumerate() {
        let place = usize::try_from(first + k as i64).ok();
        if let Some(x) = place.and_then(|place| samples.get_mut(place)) {
            *x += weight * scale;
        }
    }
}

/// A direction from the von Mises-Fisher distribution whose mean vector is the bin's.
///
/// # Source
/// K. V. Mardia, P. E. Jupp, *Directional Statistics* (2000), section 9.3.2; the concentration by A. Banerjee et al.,
/// J. Mach. Learn. Res. 6, 1345 (2005), equation (4.4).
fn direction(bin: &Bin, stream: &mut Stream) -> Vec3 {
    let mean = bin.arrival.length().min(0.9999);
    if mean < 1e-3 {
        return stream.direction();
    }
    let axis = bin.arrival / bin.arrival.length();
    let concentration = mean * (3.0 - mean * mean) / (1.0 - mean * mean);
    let u = stream.uniform_f32();
    let cosine = 1.0 + libm::logf(u + (1.0 - u) * libm::expf(-2.0 * concentration)) / concentration;
    let cosine = cosine.clamp(-1.0, 1.0);
    let (s, c) = sin_cos(std::f32::consts::TAU * stream.uniform_f32());
    let (tangent, bitangent) = axis.any_orthonormal_pair();
    let across = (1.0 - cosine * cosine).sqrt();
    axis * cosine + (tangent * c + bitangent * s) * across
}

/// A count from the Poisson distribution with mean `mean`, at most a few hundred.
///
/// # Source
/// D. E. Knuth, *The Art of Computer Programming* 2, section 3.4.1, in pieces of 16 so that nothing underflows.
fn poisson(mean: f64, stream: &mut Stream) -> usize {
    let mut count = 0;
    let mut left = mean.clamp(0.0, 1e4);
    while left > 0.0 {
        let limit = libm::exp(-left.min(16.0));
        left -= 16.0;
        let mut product = stream.uniform();
        while product > limit {
            count += 1;
            product *= stream.uniform();
        }
    }
    count
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_have_poissons_mean_and_variance() {
        for (seed, mean) in [(0, 0.3), (1, 5.0), (2, 40.0)] {
            let mut stream = Key::root(seed).stream();
            let n = 20_000;
            let (mut first, mut second) = (0.0, 0.0);
            for _ in 0..n {
                let x = poisson(mean, &mut stream) as f64;
                first += x;
                second += x * x;
            }
            let (n, average) = (f64::from(n), first / f64::from(n));
            assert!((average - mean).abs() < 5.0 * (mean / n).sqrt());
            assert!(((second / n - average * average) / mean - 1.0).abs() < 0.06);
        }
    }

    #[test]
    fn directions_have_their_bins_mean() {
        for (seed, mean) in [(0, 0.0), (1, 0.2), (2, 0.6), (3, 0.95)] {
            let wanted = Vec3::new(0.6, 0.0, -0.8) * mean;
            let bin = Bin {
                energy: [1.0; BAND_COUNT],
                arrival: wanted,
            };
            let mut stream = Key::root(seed).stream();
            let n = 20_000;
            let sum: Vec3 = (0..n).map(|_| direction(&bin, &mut stream)).sum();
            let found = sum / n as f32;
            // The concentration is an approximation within a few hundredths.
            assert!((found - wanted).length() < 0.03, "{mean}: {found}");
        }
    }

    #[test]
    fn a_pulse_between_samples_keeps_its_energy_and_place() {
        for k in 0..20 {
            let place = 50.0 + f64::from(k) * 0.05;
            let mut samples = vec![0.0; 100];
            add_between(&mut samples, place, 2.0);
            let energy: f32 = samples.iter().map(|x| x * x).sum();
            assert!((energy - 4.0).abs() < 1e-4);
            // The delay of the phase at a third of Nyquist's frequency.
            let (mut re, mut im) = (0.0, 0.0);
            for (k, x) in samples.iter().enumerate() {
                let (s, c) = libm::sincos(1.05 * (k as f64 - place));
                re += f64::from(*x) * c;
                im += f64::from(*x) * s;
            }
            assert!((im.atan2(re) / 1.05).abs() < 0.02, "{place}");
        }
    }
}
