//! The tail as pressure: random arrivals with the histogram's energies.

use super::noise_gains::{BandEnergyCurve, BandGains, GainCurve};
use super::upper_air::{UpperAirAbsorption, UpperBands};
use crate::bands::{BAND_COUNT, BandValues, FilterBank};
use crate::directions::DirectionalEnergy;
use crate::echogram::Echogram;
use crate::receiver_channel::{Delay, ReceiverChannel};
use dwell_scene::interrupt::CancelPoller;
use dwell_scene::random::{RandomKey, RandomStream};
use glam::Vec3;
use std::sync::LazyLock;

/// Taps on either side of an arrival between samples.
const HALF: i32 = 4;
const TAPS: usize = 2 * HALF as usize;
/// Arrivals in some milliseconds of work.
const ARRIVALS_BETWEEN_POLLS: usize = 16_384;
/// Tabulated points between two samples.
const PHASES: usize = 64;

/// Rounds of measurement and gain correction for one microphone's noise: changes over time spread in frequency, and bands cross.
const ROUNDS: usize = 2;
/// The same for several channels. The correction is of the centre's noise: where that is faint by chance the others' is
/// not, so that every round costs them some of their coherence.
const ROUNDS_OF_MANY: usize = 1;

/// The inputs of the tail's noise.
pub(super) struct TailNoise<'a> {
    pub(super) echogram: &'a Echogram,
    /// The smoothed energy of the tail. Shape (bin, band).
    pub(super) energy: Vec<[f64; BAND_COUNT]>,
    pub(super) rate_hz: f64,
    pub(super) arrivals_per_s: f64,
    pub(super) length: usize,
    /// Samples at the start that must be silent.
    pub(super) silent_samples: usize,
    pub(super) bank: &'a FilterBank,
    /// Absorption by air above the highest band, if any.
    pub(super) upper_air_absorption: Option<(&'a UpperBands, &'a UpperAirAbsorption)>,
}

/// One arrival of the tail.
pub(super) struct TailArrival {
    /// At the receiver's centre, s.
    time_s: f64,
    from: Vec3,
    amplitude: BandValues,
}

/// One signal for each band. Shape (band, sample).
type BandSignals = Vec<Vec<f32>>;

impl TailNoise<'_> {
    /// Adds the tail to `out`, shape (channel, sample).
    ///
    /// All channels receive the same arrivals, each with its own delay and gain, so that their coherence is right: that of
    /// a diffuse field where sound comes from all directions.
    ///
    /// # Source
    /// R. K. Cook et al., JASA 27, 1072 (1955).
    pub(super) fn add(
        &self,
        arrivals: &[TailArrival],
        levels: &BandGains,
        channels: &[ReceiverChannel],
        out: &mut [f32],
    ) {
        let speed = self.echogram.speed_m_s;
        let pulses = arrivals
            .iter()
            .map(|arrival| self.arrival_amplitudes(arrival, levels));
        let pulses: Vec<BandValues> = pulses.collect();
        let mut bus: BandSignals = vec![Vec::new(); BAND_COUNT];
        let mut poll = CancelPoller::new(ARRIVALS_BETWEEN_POLLS);
        for (channel, out) in channels.iter().zip(out.chunks_exact_mut(self.length)) {
            for band in &mut bus {
                band.clear();
                band.resize(self.length, 0.0);
            }
            for (arrival, pulse) in arrivals.iter().zip(&pulses) {
                poll.count_one();
                let heard = channel.response(speed, arrival.from);
                let pulse = std::array::from_fn(|band| pulse[band] * heard.gain[band]);
                self.add_arrival(&mut bus, arrival.time_s, &pulse, &heard.delay);
            }
            let heard = self.blend(&mut bus);
            // Zero-phase bands ring before their pulses.
            for (y, x) in out.iter_mut().zip(heard).skip(self.silent_samples) {
                *y += x;
            }
        }
    }

    /// Returns the sum of the bands, with absorption above the highest of them.
    fn blend(&self, bus: &mut BandSignals) -> Vec<f32> {
        let Some((parts, air)) = self.upper_air_absorption else {
            return self.bank.blend(bus, self.length);
        };
        let mut alone = vec![Vec::new(); BAND_COUNT];
        alone[BAND_COUNT - 1] = std::mem::take(&mut bus[BAND_COUNT - 1]);
        let mut highest = self.bank.blend(&alone, self.length);
        parts.apply_air_absorption(&mut highest, air, self.echogram.speed_m_s / self.rate_hz);
        let mut heard = self.bank.blend(bus, self.length);
        for (y, x) in heard.iter_mut().zip(highest) {
            *y += x;
        }
        heard
    }

    /// Returns all arrivals of the tail, by bins: they come at random (Poisson), each with a sign and a direction drawn
    /// from those of its bin. Within a bin all are equally strong, and their energies sum to the bin's in every band.
    ///
    /// # Source
    /// D. Schroeder, *Physically Based Real-Time Auralization of Interactive Virtual Environments*, RWTH Aachen (2011),
    /// section 5.3.4.
    pub(super) fn arrivals(&self, key: RandomKey) -> Vec<TailArrival> {
        let tail = &self.echogram.tail;
        let nowhere = DirectionalEnergy::default();
        let mut sampler = None;
        let mut arrivals = Vec::new();
        let mut poll = CancelPoller::new(ARRIVALS_BETWEEN_POLLS);
        for (k, bin) in self.energy.iter().enumerate() {
            if k % tail.bins_per_direction.max(1) == 0 {
                sampler = None;
            }
            if bin.iter().all(|e| *e <= 0.0) {
                continue;
            }
            let start_s = k as f64 * tail.bin_s;
            if start_s * self.rate_hz >= self.length as f64 {
                break;
            }
            let sampler =
                sampler.get_or_insert_with(|| tail.directions_at(k).unwrap_or(&nowhere).sampler());
            // Keyed by the bin, so that draws in one bin do not depend on the others.
            let mut stream = key.child(k as u64).stream();
            let count = poisson(self.arrivals_per_s * tail.bin_s, &mut stream).max(1);
            poll.count_many(count);
            let amplitude: BandValues =
                std::array::from_fn(|b| (bin[b] / count as f64).sqrt() as f32);
            for _ in 0..count {
                let time_s = start_s + tail.bin_s * stream.uniform();
                let sign = if stream.bits() & 1 == 0 { 1.0 } else { -1.0 };
                let (from, gain) = sampler.draw(&mut stream);
                arrivals.push(TailArrival {
                    time_s,
                    from,
                    amplitude: std::array::from_fn(|b| sign * amplitude[b] * gain[b]),
                });
            }
        }
        arrivals
    }

    /// Returns the gains that give the noise, at the receiver's centre and with the early paths, its wanted energy.
    /// `paths`: the paths at the centre, shape (sample,); `channels`: their number.
    pub(super) fn noise_gains(
        &self,
        arrivals: &[TailArrival],
        paths: &[f32],
        channels: usize,
    ) -> BandGains {
        let rounds = if channels == 1 {
            ROUNDS
        } else {
            ROUNDS_OF_MANY
        };
        let wanted: [BandEnergyCurve<'_>; BAND_COUNT] =
            std::array::from_fn(|band| self.target_energy(band));
        let mut levels: BandGains = std::array::from_fn(|band| GainCurve::unity(&wanted[band]));
        let paths = self.bank.split_decimated(paths);
        let mut poll = CancelPoller::new(ARRIVALS_BETWEEN_POLLS);
        for _ in 0..rounds {
            let mut bus: BandSignals = vec![vec![0.0; self.length]; BAND_COUNT];
            for arrival in arrivals {
                poll.count_one();
                let pulse = self.arrival_amplitudes(arrival, &levels);
                self.add_arrival(&mut bus, arrival.time_s, &pulse, &Delay::None);
            }
            let mut noise = self.bank.blend(&bus, self.length);
            noise[..self.silent_samples].fill(0.0);
            let noise = self.bank.split_decimated(&noise);
            for (band, gains) in levels.iter_mut().enumerate() {
                gains.correct(&paths[band], &noise[band], &wanted[band]);
            }
        }
        levels
    }

    /// Returns the wanted energy of a band over time.
    fn target_energy(&self, band: usize) -> BandEnergyCurve<'_> {
        let Self { bank, rate_hz, .. } = self;
        let mut wanted =
            BandEnergyCurve::new(bank, band, *rate_hz, self.length, self.silent_samples);
        let mut add = |time_s: f64, energy: &[f64; BAND_COUNT]| {
            let place = (time_s * rate_hz) as usize;
            if place < self.length {
                wanted.add(place, bank.band_pulse_energy(band, energy));
            }
        };
        for (k, bin) in self.energy.iter().enumerate() {
            add((k as f64 + 0.5) * self.echogram.tail.bin_s, bin);
        }
        for path in &self.echogram.paths {
            add(self.echogram.delay_s(path), &path.energy.map(f64::from));
        }
        wanted
    }

    /// Returns the amplitude of an arrival in each band.
    fn arrival_amplitudes(&self, arrival: &TailArrival, levels: &BandGains) -> BandValues {
        let place = ((arrival.time_s * self.rate_hz) as usize).min(self.length - 1);
        std::array::from_fn(|band| arrival.amplitude[band] * levels[band].at(place))
    }

    /// Adds one arrival to the bands of one channel.
    fn add_arrival(&self, bus: &mut BandSignals, time_s: f64, pulse: &BandValues, delay: &Delay) {
        match delay {
            Delay::None => {
                let place = (time_s * self.rate_hz) as usize;
                for (band, amplitude) in bus.iter_mut().zip(pulse) {
                    if let Some(x) = band.get_mut(place) {
                        *x += amplitude;
                    }
                }
            }
            Delay::Constant(delay_s) => {
                let between = FractionalPulse::new((time_s + f64::from(*delay_s)) * self.rate_hz);
                for (band, amplitude) in bus.iter_mut().zip(pulse) {
                    between.add(band, *amplitude);
                }
            }
            Delay::Banded(delay_s) => {
                for ((band, amplitude), delay_s) in bus.iter_mut().zip(pulse).zip(delay_s) {
                    let place = (time_s + f64::from(*delay_s)) * self.rate_hz;
                    FractionalPulse::new(place).add(band, *amplitude);
                }
            }
        }
    }
}

/// Weights of a pulse of energy 1 at each 64th between two samples. Shape (phase, tap).
static WEIGHTS: LazyLock<[[f32; TAPS]; PHASES]> =
    LazyLock::new(|| std::array::from_fn(|k| weights(k as f32 / PHASES as f32)));

fn weights(fraction: f32) -> [f32; TAPS] {
    let mut weights = [0.0; TAPS];
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
    let scale = 1.0 / energy.sqrt();
    weights.map(|weight| weight * scale)
}

/// Samples before the start from which on pulses fall outside with all their taps.
const BEFORE: i64 = TAPS as i64;

/// A pulse of energy 1 between two samples, within a 128th of its position.
struct FractionalPulse {
    weights: &'static [f32; TAPS],
    first: i64,
}

impl FractionalPulse {
    fn new(place: f64) -> Self {
        // Rounds to the nearest; a cast truncates, and makes 0 of negative values.
        let place = ((place + BEFORE as f64) * PHASES as f64 + 0.5) as usize;
        Self {
            weights: &WEIGHTS[place % PHASES],
            first: (place / PHASES) as i64 - BEFORE + 1 - i64::from(HALF),
        }
    }

    fn add(&self, samples: &mut [f32], amplitude: f32) {
        let first = usize::try_from(self.first).ok();
        let inside = first.and_then(|first| samples.get_mut(first..first + TAPS));
        if let Some(inside) = inside {
            for (x, weight) in inside.iter_mut().zip(self.weights) {
                *x += weight * amplitude;
            }
            return;
        }
        for (k, weight) in self.weights.iter().enumerate() {
            let place = usize::try_from(self.first + k as i64).ok();
            if let Some(x) = place.and_then(|place| samples.get_mut(place)) {
                *x += weight * amplitude;
            }
        }
    }
}

/// Draws from the Poisson distribution with mean `mean`, at most a few hundred.
/// # Source
/// D. E. Knuth, *The Art of Computer Programming* 2, section 3.4.1, in pieces of 16 so that nothing underflows.
fn poisson(mean: f64, stream: &mut RandomStream) -> usize {
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
            let mut stream = RandomKey::root(seed).stream();
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
    fn a_pulse_between_samples_keeps_its_energy_and_place() {
        for k in 0..20 {
            let place = 50.0 + f64::from(k) * 0.05;
            let mut samples = vec![0.0; 100];
            FractionalPulse::new(place).add(&mut samples, 2.0);
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
