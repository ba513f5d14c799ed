//! Absorption by air above the highest band.
//!
//! Surfaces, walls and edges act on all higher frequencies as at 8 kHz. Absorption by air rises with frequency: at 16 kHz
//! it is three and a half times as large.

use crate::bands::{self, BAND_COUNT};
use crate::config::AcousticConfig;
use crate::fft::RealFft;
use crate::minimum_phase::MinimumPhaseDesigner;
use dwell_scene::interrupt::CancelPoller;
use realfft::num_complex::Complex;

/// Ringing of the parts' filters beyond this wraps around to the other end, s: they are a third of an octave wide or more.
const WRAP_S: f64 = 0.02;
/// Path length beyond which nothing is audible, m.
const FURTHEST_M: f64 = 1e6;

/// Returns the centre of the highest band, Hz.
fn top_band_centre_hz() -> f64 {
    bands::exact_centre_hz(BAND_COUNT - 1)
}

/// Returns the centres of the parts, Hz: thirds of an octave above that of the highest band as far as a sample rate reaches. Shape (part,).
fn centres_hz(rate_hz: f64) -> impl Iterator<Item = f64> {
    let centres = (1..).map(|k| top_band_centre_hz() * libm::pow(10.0, 0.1 * f64::from(k)));
    centres.take_while(move |centre_hz| *centre_hz < 0.5 * rate_hz)
}

/// Absorption by air above the highest band, in excess of that in the band.
#[derive(Debug)]
pub(crate) struct UpperAirAbsorption {
    /// Logarithmic spectrum of minimum phase for 1 m. Shape (bin,).
    per_m: Vec<Complex<f32>>,
    /// Decay of the amplitude of each part, 1/m. Shape (part,).
    decay_per_m: Vec<f64>,
}

impl UpperAirAbsorption {
    /// The absorption of `config`'s air, with this `share` of it; `None` without absorption, or where nothing above the
    /// highest band is audible.
    pub(super) fn new(
        config: &AcousticConfig,
        share: f64,
        filters: &MinimumPhaseDesigner,
    ) -> Option<Self> {
        let rate_hz = f64::from(config.rate_hz);
        let centres_hz: Vec<f64> = centres_hz(rate_hz).collect();
        if !config.air_absorption || share <= 0.0 || centres_hz.is_empty() {
            return None;
        }
        let known = config.air.attenuation_db_per_m(top_band_centre_hz());
        let decay_per_m = |frequency_hz: f64| {
            let more_db = config.air.attenuation_db_per_m(frequency_hz) - known;
            share * more_db.max(0.0) / (20.0 * std::f64::consts::LOG10_E)
        };
        Some(Self {
            per_m: filters.log_spectrum(|frequency_hz| {
                if frequency_hz > top_band_centre_hz() {
                    -decay_per_m(frequency_hz)
                } else {
                    0.0
                }
            }),
            decay_per_m: centres_hz.into_iter().map(decay_per_m).collect(),
        })
    }

    /// Returns the logarithmic spectrum for a path of `length_m`.
    pub(super) fn log_spectrum_at(&self, length_m: f64) -> (&[Complex<f32>], f32) {
        (&self.per_m, length_m.min(FURTHEST_M) as f32)
    }
}

/// Filters that split the range above the highest band, for signals of one length.
#[derive(Debug)]
pub(super) struct UpperBands {
    fft: RealFft,
    /// The first bin of each part and the shares from there on. Shape (part,).
    shares: Vec<(usize, Vec<f32>)>,
}

impl UpperBands {
    /// Filters for signals of at most `length` samples.
    pub(super) fn new(rate_hz: f64, length: usize) -> Self {
        let fft = RealFft::at_least(length + (WRAP_S * rate_hz) as usize);
        let count = centres_hz(rate_hz).count();
        let mut shares = vec![(0, Vec::new()); count];
        let mut poll = CancelPoller::new(4096);
        for bin in 0..fft.bins() {
            poll.count_one();
            let frequency_hz = bin as f64 * rate_hz / fft.len() as f64;
            // In thirds of an octave above the highest band, which includes everything below.
            let place = 10.0 * libm::log10(frequency_hz.max(1.0) / top_band_centre_hz());
            let place = place.clamp(0.0, count as f64);
            let below = place.floor();
            let upper = libm::sin(std::f64::consts::FRAC_PI_2 * (place - below));
            let upper = (upper * upper) as f32;
            for (part, share) in [(below as usize, 1.0 - upper), (below as usize + 1, upper)] {
                if part > 0 && share > 0.0 && part <= count {
                    let (first, shares) = &mut shares[part - 1];
                    if shares.is_empty() {
                        *first = bin;
                    }
                    shares.push(share);
                }
            }
        }
        Self { fft, shares }
    }

    /// Fades the parts of `signal`, which begins with the impulse, by absorption in air.
    pub(super) fn apply_air_absorption(
        &self,
        signal: &mut [f32],
        air: &UpperAirAbsorption,
        metres_per_sample: f64,
    ) {
        let mut fft = self.fft.clone();
        let spectrum = fft.forward(signal);
        let mut part = vec![Complex::default(); fft.bins()];
        for ((first, shares), decay_per_m) in self.shares.iter().zip(&air.decay_per_m) {
            part.fill(Complex::default());
            for ((x, value), share) in part[*first..]
                .iter_mut()
                .zip(&spectrum[*first..])
                .zip(shares)
            {
                *x = value * share;
            }
            let decay = decay_per_m * metres_per_sample;
            for (k, (y, x)) in signal
                .iter_mut()
                .zip(fft.inverse_ref(&mut part))
                .enumerate()
            {
                *y += x * libm::expm1(-decay * k as f64) as f32;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A tone of 16 kHz decays over time as the standard says, one of 6 kHz not at all.
    #[test]
    fn parts_fade_as_their_frequencies_do() {
        let config = AcousticConfig {
            rate_hz: 48_000,
            ..AcousticConfig::full()
        };
        let air =
            UpperAirAbsorption::new(&config, 1.0, &MinimumPhaseDesigner::new(48_000.0)).unwrap();
        let n = 48_000;
        let parts = UpperBands::new(48_000.0, n);
        let more_db = |frequency_hz| {
            config.air.attenuation_db_per_m(frequency_hz)
                - config.air.attenuation_db_per_m(top_band_centre_hz())
        };
        let sixteen_hz = top_band_centre_hz() * libm::pow(10.0, 0.3);
        for (frequency_hz, wanted_db) in [(6_000.0, 0.0), (sixteen_hz, more_db(sixteen_hz))] {
            let omega = std::f64::consts::TAU * frequency_hz / 48_000.0;
            let mut tone: Vec<f32> = (0..n).map(|k| libm::sin(omega * k as f64) as f32).collect();
            // 0.01 m a sample: 100 m after 10,000 samples.
            parts.apply_air_absorption(&mut tone, &air, 0.01);
            let level_db = |at: usize| {
                let power = tone[at - 480..at + 480]
                    .iter()
                    .map(|x| f64::from(*x).powi(2));
                10.0 * libm::log10(power.sum::<f64>() / 480.0)
            };
            let lost_db = level_db(5_000) - level_db(15_000);
            assert!(
                (lost_db - 100.0 * wanted_db).abs() < 0.1,
                "{frequency_hz}: {lost_db}"
            );
        }
    }

    #[test]
    fn there_is_nothing_to_take_at_16_khz_or_without_absorption() {
        let made = |config: &AcousticConfig, share| {
            UpperAirAbsorption::new(
                config,
                share,
                &MinimumPhaseDesigner::new(f64::from(config.rate_hz)),
            )
        };
        let fast = AcousticConfig {
            rate_hz: 48_000,
            ..AcousticConfig::full()
        };
        assert!(made(&fast, 1.0).is_some());
        assert!(made(&fast, 0.0).is_none());
        assert!(made(&AcousticConfig::full(), 1.0).is_none());
        let dry = AcousticConfig {
            air_absorption: false,
            ..fast
        };
        assert!(made(&dry, 1.0).is_none());
    }
}
