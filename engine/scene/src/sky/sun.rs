//! Position of the sun, and its illuminance at the ground.

use super::Weather;
use crate::math;
use std::f32::consts::{PI, TAU};

/// Solar illuminance outside the atmosphere at mean distance, lx (IES 1984).
const OUTSIDE_AIR_LX: f32 = 127_500.0;
/// Wavelengths that represent red, green and blue, µm.
const WAVELENGTHS_UM: [f32; 3] = [0.61, 0.55, 0.465];
/// Altitude of the sun below which it adds no light to the sky, degrees.
const NIGHT_DEG: f32 = -18.0;

/// Declination of the sun on a day of the year, 1 to 366.
///
/// # Source
/// J. W. Spencer, Search 2 (5), 172 (1971): error below 0.0006 rad.
pub(super) fn declination_rad(day: f32) -> f32 {
    let turn = TAU * (day - 1.0) / 365.0;
    let ((s1, c1), (s2, c2), (s3, c3)) = (
        math::sin_cos(turn),
        math::sin_cos(2.0 * turn),
        math::sin_cos(3.0 * turn),
    );
    0.006_918 - 0.399_912 * c1 + 0.070_257 * s1 - 0.006_758 * c2 + 0.000_907 * s2 - 0.002_697 * c3
        + 0.001_48 * s3
}

/// Returns the hour angle of the sun.
pub(super) fn hour_angle_rad(hour_h: f32) -> f32 {
    (hour_h - 12.0) * (PI / 12.0)
}

/// Returns the direction to the sun: east, up and north.
///
/// # Source
/// Spherical astronomy: the equatorial direction turned by the latitude; e.g. J. A. Duffie and W. A. Beckman, *Solar
/// Engineering of Thermal Processes*, equations 1.6.5 and 1.6.6.
pub(super) fn east_up_north(declination: f32, latitude: f32, hour_angle: f32) -> [f32; 3] {
    let ((sd, cd), (sl, cl), (sh, ch)) = (
        math::sin_cos(declination),
        math::sin_cos(latitude),
        math::sin_cos(hour_angle),
    );
    [-cd * sh, sl * sd + cl * cd * ch, sd * cl - cd * sl * ch]
}

/// Illuminance by the sun normal to its rays at an altitude, lx, for red, green and blue.
///
/// # Source
/// Preetham, Shirley and Smits 1999, appendix A.1: relative air mass, Rayleigh scattering, Ångström's aerosols; distance
/// of the sun by IES 1984.
pub(super) fn direct_lx(altitude_rad: f32, day: f32, weather: Weather) -> [f32; 3] {
    let Weather::Clear { turbidity } = weather else {
        return [0.0; 3];
    };
    if altitude_rad <= 0.0 {
        return [0.0; 3];
    }
    let altitude_deg = altitude_rad.to_degrees();
    let mass = 1.0 / (math::sin(altitude_rad) + 0.15 * math::pow(altitude_deg + 3.885, -1.253));
    let aerosols = 0.046_08 * turbidity - 0.045_86;
    let distance = 1.0 + 0.034 * math::cos(TAU * (day - 2.0) / 365.0);
    WAVELENGTHS_UM.map(|wavelength| {
        let rayleigh = 0.008_735 * math::pow(wavelength, -4.08);
        let haze = aerosols * math::pow(wavelength, -1.3);
        OUTSIDE_AIR_LX * distance * math::exp(-(rayleigh + haze) * mass)
    })
}

/// Horizontal illuminance by the sky in the open, lx.
///
/// # Source
/// IES 1984, equation of the horizontal illuminance by the sky, A + B sin^C (clear: 0.8, 15.5, 0.5; cloudy: 0.3, 21, 1).
/// Below the horizon as [`twilight`] falls.
pub(super) fn diffuse_lx(altitude_rad: f32, weather: Weather) -> f32 {
    let (a, b, c) = match weather {
        Weather::Clear { .. } => (800.0, 15_500.0, 0.5),
        Weather::Overcast => (300.0, 21_000.0, 1.0),
    };
    if altitude_rad > 0.0 {
        a + b * math::pow(math::sin(altitude_rad), c)
    } else {
        a * math::pow(
            10.0,
            twilight_log10_lx(altitude_rad.to_degrees()) - twilight_log10_lx(0.0),
        )
    }
}

/// Decimal logarithm of the horizontal illuminance in lx with the sun 0 to 18 degrees below the horizon; lower down as at 18.
///
/// # Source
/// P. M. Janiczek, J. A. De Young, "Computer programs for sun and moon illuminance", USNO Circular 171 (1987), table of
/// the polynomials in altitude over 90 degrees.
fn twilight_log10_lx(altitude_deg: f32) -> f32 {
    let altitude = altitude_deg.clamp(NIGHT_DEG, 0.0);
    let [l0, l1, l2, l3] = if altitude > -0.8 {
        [2.88, 22.26, -207.64, 1034.30]
    } else if altitude > -5.0 {
        [2.88, 21.81, -258.11, -858.36]
    } else if altitude > -12.0 {
        [2.70, 12.17, -431.69, -1899.83]
    } else {
        [13.84, 262.72, 1447.42, 2797.93]
    };
    let x = altitude / 90.0;
    l0 + x * (l1 + x * (l2 + x * l3))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn solstices_and_equinoxes_fall_where_the_almanac_has_them() {
        // Days of 2023: 20 March, 21 June, 23 September, 22 December. At the equinoxes the declination moves by 0.4 degrees
        // a day, and years of 365 days run up to 0.2 degrees ahead of the mean year of the series.
        for (day, expected_deg, slack_deg) in [
            (79.0, 0.0, 0.6),
            (172.0, 23.44, 0.05),
            (266.0, 0.0, 0.6),
            (356.0, -23.44, 0.05),
        ] {
            let found = declination_rad(day).to_degrees();
            assert!((found - expected_deg).abs() < slack_deg, "{day}: {found}");
        }
    }

    #[test]
    fn the_sun_sets_when_the_sunset_equation_says() {
        for (day, latitude_deg) in [
            (105.0, 48.0_f32),
            (200.0, -35.0),
            (10.0, 60.0),
            (300.0, 0.0),
        ] {
            let (declination, latitude) = (declination_rad(day), latitude_deg.to_radians());
            // cos H = -tan(latitude) tan(declination)
            let sunset = (-latitude.tan() * declination.tan()).acos();
            let [east, up, north] = east_up_north(declination, latitude, sunset);
            assert!(up.abs() < 1e-5 && east < 0.0, "{up} {east}");
            assert!((east * east + up * up + north * north - 1.0).abs() < 1e-5);
        }
        // Overhead at the equator at noon of an equinox.
        let [_, up, _] = east_up_north(0.0, 0.0, 0.0);
        assert!((up - 1.0).abs() < 1e-6);
    }

    #[test]
    fn light_falls_steadily_as_the_sun_sinks() {
        for weather in [Weather::CLEAR_DEFAULT, Weather::Overcast] {
            let mut last = f32::INFINITY;
            for tenths in (-200..=900).rev() {
                let altitude = (tenths as f32 * 0.1).to_radians();
                let all = diffuse_lx(altitude, weather) + direct_lx(altitude, 100.0, weather)[1];
                // The table's polynomials meet within 2 %.
                assert!(
                    all <= last * 1.02 && all > 0.0,
                    "{tenths}: {all} after {last}"
                );
                // The IES' root of the sine falls by 45 % in the last tenth of a degree.
                assert!(
                    last.is_infinite() || all > 0.5 * last,
                    "{tenths}: {all} after {last}"
                );
                last = all;
            }
        }
    }

    /// The IES gives 127.5 klx times exp(-0.21 / sin) under a clear sky; clear means a turbidity of about 2.2.
    #[test]
    fn a_clear_sun_is_as_bright_as_the_ies_says() {
        let clear = Weather::Clear { turbidity: 2.2 };
        for altitude_deg in [20.0_f32, 40.0, 60.0, 90.0] {
            let altitude = altitude_deg.to_radians();
            let ies = 127_500.0 * (-0.21 / altitude.sin()).exp();
            // Day 93: the sun at its mean distance.
            let [r, g, b] = direct_lx(altitude, 93.0, clear);
            let found = 0.2126 * r + 0.7152 * g + 0.0722 * b;
            assert!(
                (found / ies - 1.0).abs() < 0.06,
                "{altitude_deg}: {found} {ies}"
            );
        }
    }
}
