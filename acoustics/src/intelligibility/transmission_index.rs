//! The speech transmission index.

use super::modulation::ModulationTransfer;
use crate::error::{AcousticsError, check_range};
use crate::utterance::SPEECH_BAND_COUNT;

/// Weights of the bands and of the redundancy of neighbours for male speech (IEC 60268-16:2011, table A.3). Shapes (band,), (band - 1,).
const ALPHA: [f64; SPEECH_BAND_COUNT] = [0.085, 0.127, 0.230, 0.233, 0.309, 0.224, 0.173];
const BETA: [f64; SPEECH_BAND_COUNT - 1] = [0.085, 0.078, 0.065, 0.011, 0.047, 0.095];
/// Absolute speech reception threshold, dB SPL (ibid., table A.2). Shape (band,).
const RECEPTION_THRESHOLD_DB: [f64; SPEECH_BAND_COUNT] = [46.0, 27.0, 12.0, 6.5, 7.5, 8.0, 12.0];
/// Apparent ratio of signal to noise beyond which nothing improves or worsens, dB (ibid., A.5.4).
const SNR_LIMIT_DB: f64 = 15.0;
/// Highest level, dB SPL.
const HIGHEST_DB: f64 = 200.0;

/// How well speech is transmitted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpeechTransmission {
    /// Speech transmission index, 0 to 1: below 0.3 bad, to 0.45 poor, to 0.6 fair, to 0.75 good, above excellent.
    pub sti: f64,
    /// Modulation transfer index of each octave, 0 to 1. Shape (band,).
    pub band_indices: [f64; SPEECH_BAND_COUNT],
}

/// Returns the speech transmission index at an ear.
///
/// `speech_db`, `noise_db`: level of speech and of all else in each octave at the ear, dB SPL, minus infinity where there is none. Shape
/// (band,).
///
/// With the intensity I = 10^(L / 10), for octave k and modulation frequency F:
///
/// ```text
/// m'(k, F)  = m(k, F) I_speech(k) / (I_speech(k) + I_noise(k) + I_masking(k) + I_threshold(k))       (A.5.3)
/// I_masking(k) = 10^(a / 10) (I_speech(k-1) + I_noise(k-1)), 0 at 125 Hz; for the level L of that sum (A.3.2)
///           a  = L / 2 - 65 below 63 dB, 1.8 L - 146.9 to 67 dB, L / 2 - 59.8 above, at most -10     (table A.1)
/// SNR(k, F) = 10 lg(m' / (1 - m')), limited to -15 to 15 dB                                          (A.5.4)
/// TI(k, F)  = (SNR + 15) / 30                                                                        (A.5.5)
/// MTI(k)    = mean of TI(k, F) over F
/// STI       = sum of alpha(k) MTI(k) - sum of beta(k) sqrt(MTI(k) MTI(k+1)), at most 1               (A.5.6)
/// ```
///
/// Noise fills the gaps of speech; a loud octave masks the one above it; below the threshold (A.3.3, table A.2) nothing is heard.
/// The printed table of masking steps by 0.2 dB at 100 dB; here it has no step.
///
/// # Errors
/// [`AcousticsError::Range`]: levels of at most 200 dB, and no NaN.
///
/// # Source
/// IEC 60268-16:2011, annex A. The constants were taken from an implementation that was written from the standard's text; the weights agree with several others;
/// the standard itself was not at hand. The edition of 2020 keeps those for male speech and has none for female speech.
pub fn speech_transmission_index(
    speech_db: &[f64; SPEECH_BAND_COUNT],
    noise_db: &[f64; SPEECH_BAND_COUNT],
    transfer: &ModulationTransfer,
) -> Result<SpeechTransmission, AcousticsError> {
    for (field, levels) in [("speech level", speech_db), ("noise level", noise_db)] {
        for level in levels {
            let range = (f64::NEG_INFINITY, HIGHEST_DB);
            let allowed = "-inf (silence) to 200 dB";
            check_range("intelligibility", field, *level, range, allowed)?;
        }
    }
    let (speech, noise) = (speech_db.map(intensity), noise_db.map(intensity));
    let band_indices = std::array::from_fn(|band| {
        let masking = band.checked_sub(1).map_or(0.0, |below| {
            let total = speech[below] + noise[below];
            total * intensity(masking_db(10.0 * libm::log10(total)))
        });
        let threshold = intensity(RECEPTION_THRESHOLD_DB[band]);
        let heard = speech[band] / (speech[band] + noise[band] + masking + threshold);
        let row = &transfer.values()[band];
        row.iter().map(|m| transmission(m * heard)).sum::<f64>() / row.len() as f64
    });
    Ok(SpeechTransmission {
        sti: weighted(&band_indices),
        band_indices,
    })
}

/// Returns 10^(L / 10).
fn intensity(level_db: f64) -> f64 {
    libm::pow(10.0, 0.1 * level_db)
}

/// Returns the level of masking in an octave re the level in the octave below, dB.
fn masking_db(level_db: f64) -> f64 {
    if level_db < 63.0 {
        0.5 * level_db - 65.0
    } else if level_db < 67.0 {
        1.8 * level_db - 146.9
    } else {
        (0.5 * level_db - 59.8).min(-10.0)
    }
}

/// Returns the transmission index of a modulation depth.
fn transmission(depth: f64) -> f64 {
    let snr_db = 10.0 * libm::log10(depth / (1.0 - depth));
    (snr_db.clamp(-SNR_LIMIT_DB, SNR_LIMIT_DB) + SNR_LIMIT_DB) / (2.0 * SNR_LIMIT_DB)
}

fn weighted(indices: &[f64; SPEECH_BAND_COUNT]) -> f64 {
    let bands: f64 = ALPHA.iter().zip(indices).map(|(a, x)| a * x).sum();
    let pairs = BETA.iter().zip(indices.windows(2));
    let redundant: f64 = pairs.map(|(b, pair)| b * (pair[0] * pair[1]).sqrt()).sum();
    (bands - redundant).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    const NONE: [f64; 7] = [f64::NEG_INFINITY; 7];
    /// Speech well above the threshold, and falling by octave, so that masking is below 1 %.
    const SPEECH: [f64; 7] = [62.0, 62.0, 60.0, 58.0, 57.0, 56.0, 56.0];

    fn sti(speech: &[f64; 7], noise: &[f64; 7], transfer: &ModulationTransfer) -> f64 {
        speech_transmission_index(speech, noise, transfer)
            .unwrap()
            .sti
    }

    #[test]
    fn weights_sum_to_one() {
        assert!((ALPHA.iter().sum::<f64>() - BETA.iter().sum::<f64>() - 1.0).abs() < 1e-12);
        assert!((weighted(&[1.0; 7]) - 1.0).abs() < 1e-12);
        assert!((weighted(&[0.4; 7]) - 0.4).abs() < 1e-12);
    }

    /// Without reverberation each octave has TI = (SNR + 15) / 30, so the same ratio everywhere is the index itself.
    #[test]
    fn noise_alone_has_the_closed_form() {
        let free = ModulationTransfer::free_field();
        for snr_db in [-20.0, -15.0, -9.0, -3.0, 0.0, 6.0] {
            let noise = SPEECH.map(|level| level - snr_db);
            let known = ((snr_db + 15.0) / 30.0_f64).clamp(0.0, 1.0);
            let found = speech_transmission_index(&SPEECH, &noise, &free).unwrap();
            for (band, index) in found.band_indices.iter().enumerate() {
                // In the lowest octave the threshold is near.
                let within = if band == 0 { 0.02 } else { 0.01 };
                assert!((index - known).abs() < within, "{snr_db}: {found:?}");
            }
            assert!((found.sti - known).abs() < 0.01, "{snr_db}: {found:?}");
        }
    }

    /// Exponential decay without noise, by a sum of our own over published modulation frequencies: 0.69 at 0.6 s and so on.
    #[test]
    fn reverberation_alone_has_the_closed_form() {
        let modulation_hz = (0..14).map(|k| 0.63 * 10_f64.powf(f64::from(k) / 10.0));
        for t60_s in [0.3, 0.6, 1.0, 2.0, 5.0] {
            let indices = modulation_hz.clone().map(|f| {
                let ratio = 2.0 * std::f64::consts::PI * f * t60_s / 13.8;
                let m = 1.0 / (1.0 + ratio * ratio).sqrt();
                ((10.0 * (m / (1.0 - m)).log10()).clamp(-15.0, 15.0) + 15.0) / 30.0
            });
            let known = indices.sum::<f64>() / 14.0;
            let decay = ModulationTransfer::exponential_decay(&[t60_s; 7]).unwrap();
            let found = sti(&SPEECH, &NONE, &decay);
            assert!((found - known).abs() < 0.012, "{t60_s}: {found} {known}");
        }
    }

    #[test]
    fn more_noise_and_more_reverberation_are_never_better() {
        let mut before = [1.1; 3];
        for step in 0..60 {
            let noise = SPEECH.map(|level| level - 30.0 + f64::from(step));
            let t60_s = 0.1 * f64::from(step);
            let decay = ModulationTransfer::exponential_decay(&[t60_s; 7]).unwrap();
            let fast = ModulationTransfer::exponential_decay(&[0.5; 7]).unwrap();
            let now = [
                sti(&SPEECH, &noise, &fast),
                sti(&SPEECH, &NONE, &decay),
                sti(&SPEECH.map(|db| db - f64::from(step)), &[20.0; 7], &fast),
            ];
            assert!(now.iter().zip(before).all(|(a, b)| *a <= b), "{step}");
            before = now;
        }
        assert!(before.iter().all(|sti| *sti < 0.25), "{before:?}");
    }

    /// Speech at the reception threshold has as much threshold as speech: 0 dB, an index of 1/2; loud sound masks the octave above it.
    #[test]
    fn hearing_limits_what_is_understood() {
        let free = ModulationTransfer::free_field();
        let at_threshold = [46.0, 27.0, 12.0, 6.5, 7.5, 8.0, 12.0];
        let found = speech_transmission_index(&at_threshold, &NONE, &free).unwrap();
        assert!(
            found
                .band_indices
                .iter()
                .all(|index| (index - 0.5).abs() < 0.01)
        );
        let inaudible = at_threshold.map(|db| db - 20.0);
        assert_eq!(sti(&inaudible, &NONE, &free), 0.0);
        assert_eq!(sti(&NONE, &NONE, &free), 0.0);
        // Noise of 90 dB at 500 Hz gives 90 + 45 - 59.8 = 75.2 dB at 1 kHz: 60 dB of speech are lost, at 2 kHz not.
        let mut noise = NONE;
        noise[2] = 90.0;
        let found = speech_transmission_index(&[60.0; 7], &noise, &free).unwrap();
        assert!(
            found.band_indices[3] < 0.01 && found.band_indices[4] > 0.9,
            "{found:?}"
        );
        // 75 dB give 75 + 37.5 - 59.8 = 52.7 dB, 7.3 dB below speech.
        noise[2] = 75.0;
        let found = speech_transmission_index(&[60.0; 7], &noise, &free).unwrap();
        assert!(
            (found.band_indices[3] - 22.3 / 30.0).abs() < 0.01,
            "{found:?}"
        );
    }

    #[test]
    fn levels_that_are_none_are_refused() {
        let free = ModulationTransfer::free_field();
        for bad in [f64::NAN, f64::INFINITY, 1e6] {
            let told = speech_transmission_index(&[bad; 7], &NONE, &free).unwrap_err();
            assert!(told.to_string().contains("speech level"), "{told}");
            assert!(speech_transmission_index(&SPEECH, &[bad; 7], &free).is_err());
        }
        let loudest = sti(&[200.0; 7], &[200.0; 7], &free);
        assert!((0.0..0.6).contains(&loudest));
    }
}
