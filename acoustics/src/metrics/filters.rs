//! Octave and third-octave filters for measuring.

use crate::fft::RealFft;
use realfft::num_complex::Complex;
use serde::{Deserialize, Serialize};
use std::f64::consts::FRAC_PI_2;

/// Overlap of the slopes of two neighbours, as a fraction of a band.
const OVERLAP: f64 = 0.5;
/// Silence after a signal in which the narrowest filter rings out before it wraps around, s.
const RING_S: f64 = 1.0;

/// The bandwidth of a measure.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum BandWidth {
    /// Eight octaves, 62.5 Hz to 8 kHz.
    #[default]
    Octave,
    /// Twenty-four third octaves, 50 Hz to 10 kHz: three for each octave.
    ThirdOctave,
}

/// Nominal centres of third octaves of one decade, Hz.
const THIRDS_HZ: [f64; 10] = [
    100.0, 125.0, 160.0, 200.0, 250.0, 315.0, 400.0, 500.0, 630.0, 800.0,
];

impl BandWidth {
    /// Returns the number of bands.
    pub fn count(self) -> usize {
        match self {
            Self::Octave => 8,
            Self::ThirdOctave => 24,
        }
    }

    /// Returns the number of bands in an octave.
    fn per_octave(self) -> f64 {
        match self {
            Self::Octave => 1.0,
            Self::ThirdOctave => 3.0,
        }
    }

    /// Returns the position of the 1 kHz band.
    fn band_index_of_1_khz(self) -> f64 {
        match self {
            Self::Octave => 4.0,
            Self::ThirdOctave => 13.0,
        }
    }

    /// Returns the exact midband frequency, Hz.
    ///
    /// # Source
    /// IEC 61260-1:2014: 1000 G^(k/b), with the octave ratio G = 10^0.3.
    pub fn exact_centre_hz(self, band: usize) -> f64 {
        1000.0
            * libm::pow(
                10.0,
                0.3 * (band as f64 - self.band_index_of_1_khz()) / self.per_octave(),
            )
    }

    /// Returns the nominal frequency of a band, Hz.
    pub fn nominal_centre_hz(self, band: usize) -> f64 {
        match self {
            Self::Octave => 62.5 * libm::pow(2.0, band as f64),
            Self::ThirdOctave => {
                // Band 3 is that of 100 Hz.
                let (decade, place) = ((band + 7) / 10, (band + 7) % 10);
                THIRDS_HZ[place] * [0.1, 1.0, 10.0, 100.0][decade.min(3)]
            }
        }
    }

    /// Returns its lower and upper edge, Hz.
    pub fn edges_hz(self, band: usize) -> (f64, f64) {
        let half = libm::pow(10.0, 0.15 / self.per_octave());
        let centre_hz = self.exact_centre_hz(band);
        (centre_hz / half, centre_hz * half)
    }

    /// Returns the power that a band's filter passes at a frequency, 0 to 1.
    ///
    /// 1 around the centre, 1/2 at the edges, with slopes that are raised cosines in the logarithm of frequency: within the limits
    /// of class 1, and neighbours sum to 1.
    ///
    /// # Source
    /// IEC 61260-1:2014 (limits); J. Antoni, JASA 127, 884 (2010) (slopes).
    pub fn power_response(self, band: usize, frequency_hz: f64) -> f64 {
        if frequency_hz <= 0.0 {
            return 0.0;
        }
        let ratio = frequency_hz / self.exact_centre_hz(band);
        let off = (libm::log10(ratio) / 0.3 * self.per_octave()).abs();
        let way = ((off - 0.5) / OVERLAP + 0.5).clamp(0.0, 1.0);
        let cos = libm::cos(FRAC_PI_2 * way);
        if way < 1.0 { cos * cos } else { 0.0 }
    }
}

/// Zero-phase filters for signals of one length.
pub(super) struct ZeroPhaseFilters {
    fft: RealFft,
    rate_hz: f64,
    width: BandWidth,
}

impl ZeroPhaseFilters {
    pub(super) fn new(width: BandWidth, rate_hz: f64, length: usize) -> Self {
        Self {
            fft: RealFft::at_least(length + (RING_S * rate_hz) as usize),
            rate_hz,
            width,
        }
    }

    /// Returns a signal's spectrum, for [`Self::band_signal`].
    pub(super) fn spectrum(&mut self, signal: &[f32]) -> Vec<Complex<f32>> {
        self.fft.forward(signal)
    }

    fn frequency_hz(&self, bin: usize) -> f64 {
        bin as f64 * self.rate_hz / self.fft.len() as f64
    }

    /// Returns a band of a spectrum as a signal, scaled so that a pulse keeps its energy; nothing above half the rate.
    ///
    /// Ringing before the signal wraps around to the end. Shape (sample,), longer than the signal.
    pub(super) fn band_signal(
        &mut self,
        band: usize,
        spectrum: &[Complex<f32>],
    ) -> Option<Vec<f32>> {
        let powers: Vec<f64> = (0..spectrum.len())
            .map(|bin| self.width.power_response(band, self.frequency_hz(bin)))
            .collect();
        let passed = powers.iter().sum::<f64>() / (spectrum.len() - 1) as f64;
        // A band with no more than the foot of a slope below half the rate gives nothing.
        if self.width.edges_hz(band).0 >= 0.5 * self.rate_hz || passed <= 0.0 {
            return None;
        }
        let mut filtered: Vec<Complex<f32>> = spectrum
            .iter()
            .zip(&powers)
            .map(|(value, power)| value * (power / passed).sqrt() as f32)
            .collect();
        Some(self.fft.inverse(&mut filtered))
    }

    /// Returns a spectrum low-passed at a frequency, in samples as those of [`Self::band_signal`].
    pub(super) fn low_pass(&mut self, spectrum: &[Complex<f32>], edge_hz: f64) -> Vec<f32> {
        let gain = |bin: usize| {
            // A slope of half an octave, so that it rings little.
            let off = libm::log2((self.frequency_hz(bin) / edge_hz).max(1e-6));
            let way = (2.0 * off + 0.5).clamp(0.0, 1.0);
            libm::cos(FRAC_PI_2 * way) as f32
        };
        let values = spectrum.iter().enumerate();
        let mut filtered: Vec<Complex<f32>> =
            values.map(|(bin, value)| value * gain(bin)).collect();
        self.fft.inverse(&mut filtered)
    }

    /// Returns the number of samples of [`Self::band_signal`] before the signal.
    pub(super) fn leading_samples(&self) -> usize {
        (0.5 * RING_S * self.rate_hz) as usize
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const BOTH: [BandWidth; 2] = [BandWidth::Octave, BandWidth::ThirdOctave];

    #[test]
    fn nominal_centres_name_the_exact_ones() {
        for width in BOTH {
            for band in 0..width.count() {
                let (nominal, exact) = (width.nominal_centre_hz(band), width.exact_centre_hz(band));
                assert!((nominal / exact - 1.0).abs() < 0.02, "{nominal} {exact}");
            }
        }
        let thirds = BandWidth::ThirdOctave;
        assert_eq!(
            (thirds.nominal_centre_hz(0), thirds.nominal_centre_hz(23)),
            (50.0, 10_000.0)
        );
        assert!((thirds.exact_centre_hz(13) - 1000.0).abs() < 1e-9);
    }

    /// Attenuation limits of class 1 at the breakpoints of octaves, dB. These are those of IEC 1260:1995; the edition of 2014
    /// allows 0.1 dB to 1.5 dB more.
    const LIMITS_DB: [(f64, f64, f64); 9] = [
        (0.0, -0.3, 0.3),
        (0.125, -0.3, 0.4),
        (0.25, -0.3, 0.6),
        (0.375, -0.3, 1.3),
        (0.5, 2.0, 5.0),
        (1.0, 17.5, f64::INFINITY),
        (2.0, 42.0, f64::INFINITY),
        (3.0, 61.0, f64::INFINITY),
        (4.0, 70.0, f64::INFINITY),
    ];

    #[test]
    fn attenuation_is_that_of_class_1() {
        let g = |exponent: f64| libm::pow(10.0, 0.3 * exponent);
        for width in BOTH {
            let b = width.per_octave();
            for (exponent, low, high) in LIMITS_DB {
                // Breakpoints of narrower bands, IEC 61260-1:2014.
                let above = 1.0 + (g(0.5 / b) - 1.0) / (g(0.5) - 1.0) * (g(exponent) - 1.0);
                for ratio in [above, 1.0 / above] {
                    let power = width.power_response(4, ratio * width.exact_centre_hz(4));
                    let attenuation_db = -10.0 * libm::log10(power);
                    assert!(
                        attenuation_db >= low && attenuation_db <= high,
                        "{width:?} {exponent}: {attenuation_db}"
                    );
                }
            }
        }
    }

    #[test]
    fn neighbours_sum_to_one() {
        for width in BOTH {
            for k in 100..7000 {
                let frequency_hz = f64::from(k);
                let sum: f64 = (0..width.count())
                    .map(|band| width.power_response(band, frequency_hz))
                    .sum();
                assert!((sum - 1.0).abs() < 1e-12, "{frequency_hz}: {sum}");
            }
        }
    }

    #[test]
    fn a_pulse_keeps_its_energy_in_every_band_below_half_the_rate() {
        let rate_hz = 16_000.0;
        let mut pulse = vec![0.0; 4000];
        pulse[1000] = 1.0;
        for width in BOTH {
            let mut filters = ZeroPhaseFilters::new(width, rate_hz, pulse.len());
            let spectrum = filters.spectrum(&pulse);
            for band in 0..width.count() {
                let Some(found) = filters.band_signal(band, &spectrum) else {
                    assert!(width.edges_hz(band).0 >= 8000.0);
                    continue;
                };
                let energy: f64 = found.iter().map(|x| f64::from(*x).powi(2)).sum();
                assert!((energy - 1.0).abs() < 1e-3, "{band}: {energy}");
            }
        }
    }
}
