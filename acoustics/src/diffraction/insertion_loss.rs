//! Insertion loss of sound that is diffracted at an edge.

use crate::bands::{BAND_COUNT, NOMINAL_CENTRES_HZ};
use std::f64::consts::{FRAC_PI_2, TAU};

/// Transmitted energy at the shadow boundary: -5 dB.
const AT_SHADOW_BOUNDARY: f64 = 0.316_227_766_016_837_94;
/// Fresnel number of half of the full effect of a bend, for a thick obstacle's second edge.
const HALF_EFFECT_FRESNEL: f64 = 0.1;

/// Fresnel numbers of a detour of 1 m. Shape (band,).
pub(super) fn fresnel_numbers_per_m(speed_m_s: f64) -> [f64; BAND_COUNT] {
    NOMINAL_CENTRES_HZ.map(|centre_hz| 2.0 * f64::from(centre_hz) / speed_m_s)
}

/// Returns the fraction of energy that a screen passes to a point with Fresnel number `n = 2 detour / wavelength`; negative
/// `n`: the point sees the source, and the detour is that over the edge. 1 from about -0.19 on.
///
/// # Source
/// U. J. Kurze, G. S. Anderson, *Sound attenuation by barriers*, Applied Acoustics 4, 35 (1971): the loss is
/// 5 dB + 20 lg(x / tanh x) with x = sqrt(2 pi n); on the lit side tan takes the place of tanh.
pub(super) fn transmitted_energy(n: f64) -> f64 {
    let x = (TAU * n.abs()).sqrt();
    if x < 1e-6 {
        return AT_SHADOW_BOUNDARY;
    }
    // The shadow: 5 dB + 20 lg(x / tanh x).
    if n >= 0.0 {
        let ratio = libm::tanh(x) / x;
        return AT_SHADOW_BOUNDARY * ratio * ratio;
    }
    if x >= FRAC_PI_2 {
        return 1.0;
    }
    // The lit side: tan in place of tanh.
    let ratio = libm::tan(x) / x;
    (AT_SHADOW_BOUNDARY * ratio * ratio).min(1.0)
}

/// Returns the factor of a second edge `apart_m` behind the first on the energy that one edge with the same detour passes:
/// from 1 down to 1/3. `bends`: Fresnel numbers of the bend at each edge alone; it acts in full only where both are well in
/// the shadow of the other.
///
/// # Source
/// ISO 9613-2:1996, equations 14 and 15: the loss of a single edge is 10 lg(3 + 20 n), that of two 10 lg(3 + 20 `c_3` n).
pub(super) fn second_edge_factor(n: f64, wavelength_m: f64, apart_m: f64, bends: [f64; 2]) -> f64 {
    let ratio = 5.0 * wavelength_m / apart_m.max(1e-6);
    let square = ratio * ratio;
    let full = (1.0 + square) / (1.0 / 3.0 + square);
    let share = |bend: f64| bend.max(0.0) / (bend.max(0.0) + HALF_EFFECT_FRESNEL);
    let c3 = 1.0 + (full - 1.0) * share(bends[0]) * share(bends[1]);
    let n = n.max(0.0);
    (3.0 + 20.0 * n) / (3.0 + 20.0 * c3 * n)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Against the chart of Z. Maekawa, *Noise reduction by screens*, Applied Acoustics 1, 157 (1968), Figure 5, as it is printed
    /// in textbooks: 5 dB at 0, 13 dB at 1, 23 dB at 10.
    #[test]
    fn losses_follow_the_published_chart() {
        for (n, wanted_db) in [(0.0, 5.0), (1.0, 13.0), (10.0, 23.0)] {
            let loss_db = -10.0 * libm::log10(transmitted_energy(n));
            assert!((loss_db - wanted_db).abs() < 0.3, "{n}: {loss_db}");
        }
        assert_eq!(transmitted_energy(-0.3), 1.0);
    }

    #[test]
    fn losses_are_continuous_and_grow_with_the_detour() {
        let mut before = transmitted_energy(-0.4);
        for k in -3999..20_000 {
            let now = transmitted_energy(f64::from(k) * 1e-4);
            assert!(now <= before && before - now < 2e-3, "{k}: {before} {now}");
            before = now;
        }
    }

    #[test]
    fn a_second_edge_takes_at_most_two_thirds_more() {
        for n in [0.0, 0.1, 1.0, 100.0] {
            // Close together against the wavelength: one edge. Far apart, and well bent at both: the bound of the standard.
            assert!((second_edge_factor(n, 1.0, 0.001, [9.0, 9.0]) - 1.0).abs() < 1e-4);
            assert!(second_edge_factor(n, 1.0, 100.0, [1e6, 1e6]) >= 1.0 / 3.0);
            assert_eq!(second_edge_factor(n, 1.0, 100.0, [0.0, 1e6]), 1.0);
        }
        assert!(second_edge_factor(100.0, 1.0, 100.0, [1e6, 1e6]) < 0.345);
    }
}
