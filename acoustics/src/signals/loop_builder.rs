//! Builder of a loop of sound: everything that is added wraps around its end.

use crate::fft::RealFft;
use dwell_scene::interrupt;
use dwell_scene::random::RandomKey;
use realfft::num_complex::Complex;
use std::f64::consts::TAU;

/// A tone with fade-in and fade-out.
#[derive(Clone, Copy, Debug)]
pub(super) struct FadedTone {
    pub(super) start_s: f64,
    pub(super) duration_s: f64,
    pub(super) frequency_hz: f64,
    pub(super) amplitude: f64,
    /// Duration of the fade-in and the fade-out, s; both are raised cosines.
    pub(super) ramp_s: f64,
}

/// Samples between checks for cancellation.
const SAMPLES_PER_CHECK: usize = 1 << 12;

/// One loop.
#[derive(Debug)]
pub(super) struct LoopBuilder {
    pub(super) rate_hz: f64,
    pub(super) key: RandomKey,
    samples: Vec<f64>,
}

impl LoopBuilder {
    pub(super) fn new(rate_hz: f64, loop_s: f64, key: RandomKey) -> Self {
        Self {
            rate_hz,
            key,
            samples: vec![0.0; ((loop_s * rate_hz) as usize).max(1)],
        }
    }

    pub(super) fn loop_s(&self) -> f64 {
        self.samples.len() as f64 / self.rate_hz
    }

    /// Adds `value(time since start_s)` for `duration_s`.
    pub(super) fn add(&mut self, start_s: f64, duration_s: f64, value: impl Fn(f64) -> f64) {
        let length = self.samples.len();
        let first = (start_s * self.rate_hz).ceil();
        let count = (duration_s * self.rate_hz) as usize;
        for k in 0..count {
            if k % SAMPLES_PER_CHECK == 0 {
                interrupt::unwind_if_cancelled();
            }
            let place = (first as i64 + k as i64).rem_euclid(length as i64) as usize;
            self.samples[place] += value((first + k as f64) / self.rate_hz - start_s);
        }
    }

    /// Adds a tone; nothing when it lies above 0.45 of the rate.
    pub(super) fn add_tone(&mut self, tone: FadedTone) {
        if tone.frequency_hz > 0.45 * self.rate_hz {
            return;
        }
        let omega = TAU * tone.frequency_hz;
        self.add(tone.start_s, tone.duration_s, |t| {
            tone.amplitude
                * raised_cosine_envelope(t, tone.duration_s, tone.ramp_s)
                * libm::sin(omega * t)
        });
    }

    /// Adds a continuous tone; its frequency is moved to the nearest that fits the loop.
    pub(super) fn add_continuous_tone(&mut self, frequency_hz: f64, amplitude: f64) {
        let loop_s = self.loop_s();
        let turns = (frequency_hz * loop_s).round().max(1.0);
        if turns / loop_s > 0.45 * self.rate_hz {
            return;
        }
        self.add(0.0, loop_s + 0.5 / self.rate_hz, |t| {
            amplitude * libm::sin(TAU * turns * t / loop_s)
        });
    }

    /// Adds a decaying tone that begins with a short rise; its energy falls 60 dB in `decay_s`.
    pub(super) fn add_decaying_tone(
        &mut self,
        start_s: f64,
        frequency_hz: f64,
        decay_s: f64,
        amplitude: f64,
    ) {
        if frequency_hz > 0.45 * self.rate_hz {
            return;
        }
        let (omega, rate) = (TAU * frequency_hz, 3.0 * std::f64::consts::LN_10 / decay_s);
        self.add(start_s, (1.2 * decay_s).min(self.loop_s()), |t| {
            amplitude * raised_cosine_rise(t, 0.002) * libm::exp(-rate * t) * libm::sin(omega * t)
        });
    }

    /// Returns periodic noise over the whole loop with root mean square 1: `gain(frequency in Hz)` shapes its amplitude.
    pub(super) fn shaped_noise(&self, name: &str, gain: impl Fn(f64) -> f64) -> Vec<f64> {
        let length = self.samples.len();
        // Odd lengths lose one sample, which is repeated: 20 us in a loop are inaudible.
        let mut fft = RealFft::new(length - length % 2);
        let mut stream = self.key.child("noise").child(name).stream();
        let mut spectrum = vec![Complex::default(); fft.bins()];
        let step_hz = self.rate_hz / fft.len() as f64;
        let last = spectrum.len() - 1;
        for (k, value) in spectrum.iter_mut().enumerate() {
            if k % SAMPLES_PER_CHECK == 0 {
                interrupt::unwind_if_cancelled();
            }
            let phase = TAU * stream.uniform();
            if k > 0 && k < last {
                let size = gain(k as f64 * step_hz);
                *value = Complex::new(
                    (size * libm::cos(phase)) as f32,
                    (size * libm::sin(phase)) as f32,
                );
            }
        }
        interrupt::unwind_if_cancelled();
        let samples = fft.inverse(&mut spectrum);
        interrupt::unwind_if_cancelled();
        let power: f64 = samples.iter().map(|x| f64::from(*x).powi(2)).sum();
        let scale = (samples.len() as f64 / power.max(1e-300)).sqrt();
        (0..length)
            .map(|k| f64::from(samples[k.min(samples.len() - 1)]) * scale)
            .collect()
    }

    /// Adds `noise` for `duration_s` from `start_s` on, times `value(time since start_s)`.
    pub(super) fn add_noise(
        &mut self,
        noise: &[f64],
        start_s: f64,
        duration_s: f64,
        value: impl Fn(f64) -> f64,
    ) {
        let length = self.samples.len().min(noise.len());
        let (rate, first) = (self.rate_hz, (start_s * self.rate_hz).ceil() as i64);
        for k in 0..(duration_s * rate) as i64 {
            if k % SAMPLES_PER_CHECK as i64 == 0 {
                interrupt::unwind_if_cancelled();
            }
            let place = (first + k).rem_euclid(length as i64) as usize;
            self.samples[place] += noise[place] * value((first + k) as f64 / rate - start_s);
        }
    }

    /// Adds `noise` over the whole loop, times `amplitude`.
    pub(super) fn add_to_loop(&mut self, noise: &[f64], amplitude: f64) {
        for (sample, x) in self.samples.iter_mut().zip(noise) {
            *sample += amplitude * x;
        }
    }

    /// Returns the loop with mean 0 and root mean square 1.
    pub(super) fn normalized(self) -> Vec<f32> {
        let n = self.samples.len() as f64;
        let mean = self.samples.iter().sum::<f64>() / n;
        let power = self
            .samples
            .iter()
            .map(|x| (x - mean) * (x - mean))
            .sum::<f64>()
            / n;
        let scale = if power > 0.0 { 1.0 / power.sqrt() } else { 0.0 };
        let scaled = self.samples.iter().map(|x| ((x - mean) * scale) as f32);
        scaled.collect()
    }
}

/// 0 to 1 within `edge_s` with a raised cosine.
pub(crate) fn raised_cosine_rise(t: f64, edge_s: f64) -> f64 {
    if t >= edge_s {
        1.0
    } else {
        0.5 - 0.5 * libm::cos(std::f64::consts::PI * (t / edge_s).max(0.0))
    }
}

/// Rises at the start and falls at the end.
pub(crate) fn raised_cosine_envelope(t: f64, duration_s: f64, edge_s: f64) -> f64 {
    raised_cosine_rise(t, edge_s) * raised_cosine_rise(duration_s - t, edge_s)
}

/// A resonance of amplitude 1 at `center_hz`, `width_hz` wide.
pub(crate) fn resonance_gain(frequency_hz: f64, center_hz: f64, width_hz: f64) -> f64 {
    let x = (frequency_hz - center_hz) / (0.5 * width_hz);
    1.0 / (1.0 + x * x).sqrt()
}
