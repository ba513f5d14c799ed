//! Formants of vowels: what the vocal tract passes.

use super::loop_builder::resonance_gain;

/// First three formants of five vowels of men, Hz (G. E. Peterson, H. L. Barney, JASA 24, 175, 1952, table II).
pub(crate) const VOWELS_HZ: [[f64; 3]; 5] = [
    [270.0, 2290.0, 3010.0],
    [530.0, 1840.0, 2480.0],
    [730.0, 1090.0, 2440.0],
    [570.0, 840.0, 2410.0],
    [300.0, 870.0, 2240.0],
];

/// Returns the amplitude that a vocal tract with these formants, Hz, passes at a frequency; about 1 at the first formant.
/// `size` multiplies the formants.
pub(crate) fn formant_gain(frequency_hz: f64, formants_hz: &[f64; 3], size: f64) -> f64 {
    formants_hz
        .iter()
        .zip([1.0, 0.5, 0.25])
        .map(|(formant, weight)| weight * resonance_gain(frequency_hz, formant * size, 110.0))
        .sum()
}
