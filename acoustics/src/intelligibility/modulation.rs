//! Modulation transfer: how much of the fluctuations of speech a room leaves.

use crate::bands::{BAND_COUNT, FilterBank};
use crate::echogram::Echogram;
use crate::error::{AcousticsError, check_range};
use crate::utterance::SPEECH_BAND_COUNT;
use std::f64::consts::{PI, TAU};

/// The modulation frequencies, Hz (IEC 60268-16:2011, A.2.2). Shape (modulation frequency,).
pub const MODULATION_FREQUENCIES_HZ: [f64; 14] = [
    0.63, 0.8, 1.0, 1.25, 1.6, 2.0, 2.5, 3.15, 4.0, 5.0, 6.3, 8.0, 10.0, 12.5,
];

/// Overlap of the octave filters, as in [`power_shares`](crate::bands::power_shares).
pub(super) const OVERLAP: f64 = 0.5;
/// Longest impulse response, samples.
const MAX_SAMPLES: usize = 1 << 25;

/// The modulation transfer function of a path of sound, without noise: depth of the fluctuations of power that arrive over the depth of those that
/// left, 0 to 1, by octave and modulation frequency.
#[derive(Clone, Debug, PartialEq)]
pub struct ModulationTransfer([[f64; MODULATION_FREQUENCIES_HZ.len()]; SPEECH_BAND_COUNT]);

/// Sum of e(t) exp(-2 pi i F t) dt over the energy e that arrives, and of e(t) dt.
#[derive(Clone, Copy, Default)]
struct EnergyTransform {
    real: f64,
    imaginary: f64,
    all: f64,
}

impl EnergyTransform {
    /// Adds energy that arrives evenly between a time and `duration_s` later.
    fn add(&mut self, modulation_hz: f64, start_s: f64, duration_s: f64, energy: f64) {
        let x = PI * modulation_hz * duration_s;
        // The transform of a rectangle.
        let left = if x > 1e-9 { libm::sin(x) / x } else { 1.0 };
        let phase = TAU * modulation_hz * (start_s + 0.5 * duration_s);
        self.real += energy * left * libm::cos(phase);
        self.imaginary -= energy * left * libm::sin(phase);
        self.all += energy;
    }

    /// Returns m; 0 where no energy arrives.
    fn depth(&self) -> f64 {
        if self.all > 0.0 {
            (libm::hypot(self.real, self.imaginary) / self.all).min(1.0)
        } else {
            0.0
        }
    }
}

impl ModulationTransfer {
    fn by(value: impl Fn(usize, f64) -> f64) -> Self {
        let row = |band| MODULATION_FREQUENCIES_HZ.map(|f| value(band, f));
        Self(std::array::from_fn(row))
    }

    /// Of the free field: everything is left.
    pub fn free_field() -> Self {
        Self::by(|_, _| 1.0)
    }

    /// Of a diffuse field that decays exponentially, without direct sound: m(F) = 1 / sqrt(1 + (2 pi F T / 13.8)²).
    ///
    /// # Errors
    /// [`AcousticsError::Range`]: reverberation times T of 0 to 100 s.
    ///
    /// # Source
    /// T. Houtgast, H. J. M. Steeneken, Acustica 28, 66 (1973); 13.8 is ln(10⁶).
    pub fn exponential_decay(t60_s: &[f64; SPEECH_BAND_COUNT]) -> Result<Self, AcousticsError> {
        for t60 in t60_s {
            check_range("reverberation", "t60_s", *t60, (0.0, 100.0), "0 to 100")?;
        }
        let rate = 6.0 * std::f64::consts::LN_10;
        Ok(Self::by(|band, f| {
            1.0 / libm::hypot(1.0, TAU * f * t60_s[band] / rate)
        }))
    }

    /// Of the energy that arrives after an impulse: m(F) = |sum of e(t) exp(-2 pi i F t)| / sum of e(t). A band in which nothing arrives has 0.
    ///
    /// Energy of the tail is spread evenly over its bins.
    ///
    /// # Source
    /// M. R. Schroeder, Acustica 49, 179 (1981); IEC 60268-16:2011, clause 6.1 (the indirect method).
    pub fn of_echogram(echogram: &Echogram) -> Self {
        let tail = &echogram.tail;
        Self::by(|band, f| {
            let band = band + BAND_COUNT - SPEECH_BAND_COUNT;
            let mut sum = EnergyTransform::default();
            for path in &echogram.paths {
                sum.add(f, echogram.delay_s(path), 0.0, f64::from(path.energy[band]));
            }
            for (k, bin) in tail.bins.iter().enumerate().filter(|(_, b)| b[band] > 0.0) {
                sum.add(f, k as f64 * tail.bin_s, tail.bin_s, bin[band]);
            }
            sum.depth()
        })
    }

    /// Of an impulse response, as [`ModulationTransfer::of_echogram`]; noise in the recording is not compensated for.
    ///
    /// `samples`: shape (sample,). The standard asks for 1.6 s and half the reverberation time at least.
    ///
    /// # Errors
    /// [`AcousticsError::Range`]: 1 to 2^25 finite samples at 1,000 to 192,000 Hz.
    pub fn of_impulse_response(samples: &[f32], rate_hz: u32) -> Result<Self, AcousticsError> {
        check_signal(samples, rate_hz)?;
        let bank = FilterBank::new(f64::from(rate_hz), samples.len(), OVERLAP);
        let bands = bank.split(samples);
        let step_s = 1.0 / f64::from(rate_hz);
        Ok(Self::by(|band, f| {
            let mut sum = EnergyTransform::default();
            let band = band + BAND_COUNT - SPEECH_BAND_COUNT;
            for (k, x) in bands[band].iter().enumerate() {
                sum.add(f, k as f64 * step_s, 0.0, f64::from(*x).powi(2));
            }
            sum.depth()
        }))
    }

    /// Returns m. Shape (band, modulation frequency).
    pub fn values(&self) -> &[[f64; MODULATION_FREQUENCIES_HZ.len()]; SPEECH_BAND_COUNT] {
        &self.0
    }
}

/// Refuses what is no signal.
pub(super) fn check_signal(samples: &[f32], rate_hz: u32) -> Result<(), AcousticsError> {
    const AT: &str = "speech bands";
    crate::signals::check_rate(rate_hz)?;
    let (count, most) = (samples.len() as f64, MAX_SAMPLES as f64);
    check_range(AT, "number of samples", count, (1.0, most), "1 to 2^25")?;
    for x in samples {
        check_range(AT, "sample", f64::from(*x), (-1e9, 1e9), "-1e9 to 1e9")?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::echogram::EnergyHistogram;

    /// The closed form of an exponential decay, by its integral: bins of 1 and of 20 ms.
    #[test]
    fn exponential_decays_have_the_closed_form() {
        for t60_s in [0.3, 1.2] {
            let known = ModulationTransfer::exponential_decay(&[t60_s; 7]).unwrap();
            for bin_s in [0.001, 0.02] {
                let mut echogram = Echogram {
                    speed_m_s: 343.0,
                    ..Echogram::default()
                };
                let left = |t: f64| (-13.815_510_558 * t / t60_s).exp();
                let bin = |k: usize| {
                    let start_s = k as f64 * bin_s;
                    [left(start_s) - left(start_s + bin_s); 8]
                };
                let count = (2.0 * t60_s / bin_s) as usize;
                echogram.tail = EnergyHistogram {
                    bin_s,
                    bins: (0..count).map(bin).collect(),
                    ..EnergyHistogram::default()
                };
                let found = ModulationTransfer::of_echogram(&echogram);
                for (a, b) in found.values().iter().zip(known.values()) {
                    for (a, b) in a.iter().zip(b) {
                        assert!((a - b).abs() < 0.01, "{t60_s} {bin_s}: {a} {b}");
                    }
                }
            }
        }
    }

    /// Pulses 10 ms apart that decay: a geometric series. Octaves from 1 kHz on ring for less than that.
    #[test]
    fn a_response_that_decays_has_the_closed_form() {
        for t60_s in [0.3, 1.2] {
            let left = |t: f64| (-13.815_510_558 * t / t60_s).exp();
            let mut response = vec![0.0_f32; 32_000];
            for (k, x) in response[800..].iter_mut().step_by(160).enumerate() {
                *x = left(0.01 * k as f64).sqrt() as f32;
            }
            let found = ModulationTransfer::of_impulse_response(&response, 16_000).unwrap();
            for row in &found.values()[3..] {
                for (m, f) in row.iter().zip(MODULATION_FREQUENCIES_HZ) {
                    let (ratio, turn) = (left(0.01), std::f64::consts::TAU * f * 0.01);
                    let (re, im) = (1.0 - ratio * turn.cos(), ratio * turn.sin());
                    let known = (1.0 - ratio) / re.hypot(im);
                    assert!((m - known).abs() < 0.01, "{t60_s} {f}: {m} {known}");
                }
            }
        }
    }

    /// Two equal pulses a time apart: m = |cos(pi F t)|.
    #[test]
    fn an_echo_has_the_closed_form() {
        let mut pulses = vec![0.0_f32; 40_000];
        (pulses[8_000], pulses[8_000 + 1_600]) = (0.5, -0.5);
        let found = ModulationTransfer::of_impulse_response(&pulses, 16_000).unwrap();
        for row in &found.values()[1..] {
            for (m, f) in row.iter().zip(MODULATION_FREQUENCIES_HZ) {
                let known = (std::f64::consts::PI * f * 0.1).cos().abs();
                assert!((m - known).abs() < 0.02, "{f}: {m} {known}");
            }
        }
    }

    #[test]
    fn the_free_field_leaves_all_and_silence_nothing() {
        let mut pulse = [0.0; 3_000];
        pulse[100] = 1.0;
        let found = ModulationTransfer::of_impulse_response(&pulse, 48_000).unwrap();
        // The octave of 125 Hz rings itself.
        for row in &found.values()[1..] {
            assert!(row.iter().all(|m| *m > 0.99), "{row:?}");
        }
        let silent = ModulationTransfer::of_echogram(&Echogram::default());
        assert!(silent.values().as_flattened().iter().all(|m| *m == 0.0));
        let free = ModulationTransfer::free_field();
        assert!(free.values().as_flattened().iter().all(|m| *m == 1.0));
    }

    #[test]
    fn what_is_no_response_is_refused() {
        for bad in [&[][..], &[f32::NAN], &[1.0, f32::INFINITY]] {
            assert!(ModulationTransfer::of_impulse_response(bad, 16_000).is_err());
        }
        assert!(ModulationTransfer::of_impulse_response(&[1.0], 1).is_err());
        for bad in [f64::NAN, -1.0, f64::INFINITY] {
            assert!(ModulationTransfer::exponential_decay(&[bad; 7]).is_err());
        }
    }
}
