//! Delay of a recording.

use super::fir::FirFilter;
use super::microphone_stage::MicrophoneStage;
use super::{AcousticLaw, SignalStage};
use dwell_scene::law::{EngineKind, LawRegime, ParamInfo};
use dwell_scene::{LawInfo, LawValues};

/// Most taps on either side of a delay between samples.
const HALF: usize = 32;

pub(super) const LAW: AcousticLaw = AcousticLaw {
    info: LawInfo {
        id: "recording_delay",
        version: 1,
        name: "delay of the recording",
        equation: "p_out(t) = p(t - delay_s) (s); between samples by a windowed sinc of 64 taps, or by Lagrange's polynomial where the \
                   delay is shorter than 31 samples (the shorter, the more the highest octave is damped between samples)",
        source: "T. I. Laakso et al., Splitting the unit delay, IEEE Signal Processing Magazine 13(1), 30 (1996)",
        engine: EngineKind::Acoustics,
        acts_on: "sensor",
        params: &[ParamInfo {
            name: "delay_s",
            unit: "s",
            default: 0.0,
            low: 0.0,
            high: 1.0,
            plausible: [0.0, 0.1],
        }],
        regimes: &[
            LawRegime::DirectSound,
            LawRegime::EarlySound,
            LawRegime::LateSound,
        ],
        probes: &[&[("delay_s", 0.005)]],
        rivals: &[
            "temperature_error",
            "clock_drift",
            "microphone_position_error",
        ],
        separating_experiment: "record at two or more distances: a delay shifts all arrivals by the same time at all places, warmth and \
                                clocks in proportion to the time, a wrong position each path by another",
    },
    effect: SignalStage::Microphones(install),
};

fn install(values: LawValues<'_>, rate_hz: f64) -> Box<dyn MicrophoneStage> {
    let delay = values.get("delay_s") * rate_hz;
    let whole = delay.floor();
    let fraction = delay - whole;
    let whole = whole as usize;
    if fraction < 1e-9 {
        return Box::new(FirFilter::new(whole, vec![1.0]));
    }
    let half = (whole + 1).min(HALF);
    let taps = if half < HALF {
        lagrange(fraction, half)
    } else {
        sinc(fraction, half)
    };
    Box::new(FirFilter::new(whole + 1 - half, taps))
}

/// Returns weights of the samples around a point `fraction` after one of them, `half` on either side, that are exact for
/// polynomials: the best for few samples and low frequencies.
fn lagrange(fraction: f64, half: usize) -> Vec<f32> {
    let place = half as f64 - 1.0 + fraction;
    let weight = |k: usize| {
        let others = (0..2 * half).filter(|other| *other != k);
        others.fold(1.0, |product, other| {
            product * (place - other as f64) / (k as f64 - other as f64)
        })
    };
    (0..2 * half).map(|k| weight(k) as f32).collect()
}

/// Returns the same by a windowed sinc, which holds for high frequencies, too.
fn sinc(fraction: f64, half: usize) -> Vec<f32> {
    use std::f64::consts::{FRAC_PI_2, PI};
    let value = |k: usize| {
        let x = k as f64 + 1.0 - half as f64 - fraction;
        let window = libm::cos(FRAC_PI_2 * x / (half as f64 + 0.5));
        let sinc = if x.abs() < 1e-9 {
            1.0
        } else {
            libm::sin(PI * x) / (PI * x)
        };
        sinc * window * window
    };
    let values: Vec<f64> = (0..2 * half).map(value).collect();
    let sum: f64 = values.iter().sum();
    values.iter().map(|x| (x / sum) as f32).collect()
}

#[cfg(test)]
mod tests {
    use super::super::testing::{RATE_HZ, law, microphone_output};
    use realfft::num_complex::Complex;

    fn delayed(delay_s: f64) -> Vec<f32> {
        microphone_output(
            &[law("recording_delay", &[("delay_s", delay_s)])],
            0,
            &[1.0],
        )
    }

    #[test]
    fn whole_samples_are_moved_as_they_are() {
        for samples in [1_usize, 5, 800, 16_000] {
            let out = delayed(samples as f64 / RATE_HZ);
            let late = out.iter().enumerate().filter(|(_, x)| **x != 0.0);
            let late: Vec<_> = late.map(|(k, x)| (k, *x)).collect();
            assert_eq!(late, [(samples, 1.0)]);
        }
    }

    /// Between samples: gain and delay up to 0.8 of Nyquist's frequency within 1e-3 beyond 32 samples, and at an eighth for
    /// any delay.
    #[test]
    fn between_samples_gain_and_delay_are_right() {
        for delay in [0.4, 1.5, 7.25, 40.7, 1000.37] {
            let out = delayed(delay / RATE_HZ);
            let highest = if delay > 32.0 { 0.8 } else { 0.125 };
            for part in [0.02, 0.125, 0.5, 0.8_f64]
                .into_iter()
                .filter(|part| *part <= highest)
            {
                let omega = std::f64::consts::PI * part;
                let sum: Complex<f64> = (0_u32..)
                    .zip(&out)
                    .map(|(k, x)| {
                        Complex::from_polar(f64::from(*x), -omega * (f64::from(k) - delay))
                    })
                    .sum();
                let allowed = if delay > 32.0 { 1e-3 } else { 0.03 };
                let found = (sum.norm(), -sum.arg() / omega);
                assert!((found.0 - 1.0).abs() < allowed, "{delay} {part}: {found:?}");
                assert!(found.1.abs() < 1.7 * allowed, "{delay} {part}: {found:?}");
            }
        }
    }
}
