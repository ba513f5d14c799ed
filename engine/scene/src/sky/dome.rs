//! Sky luminance by direction.

use super::{Sky, Weather};
use crate::math;
use glam::{Vec2, Vec3};
use std::f32::consts::{FRAC_PI_2, PI, TAU};

/// Steps of the sum over the sky that sets its luminance: of elevation and of azimuth.
const STEPS: [u32; 2] = [24, 48];
/// The least cosine from the zenith: at the horizon the formula divides by it.
const HORIZON: f32 = 0.02;

/// A sky prepared for evaluation in many directions.
#[derive(Clone, Copy, Debug)]
pub struct SkyDome {
    to_sun: Vec3,
    spread: SkyModel,
    /// cd/m² of the formula's unit.
    scale_cd_m2: f32,
}

/// Luminance and colour by direction, up to a factor.
#[derive(Clone, Copy, Debug)]
enum SkyModel {
    /// Coefficients A to E for Y, x and y; chromaticity overhead.
    Clear {
        perez: [[f32; 5]; 3],
        zenith: Vec2,
    },
    Overcast,
}

impl SkyDome {
    /// Prepares a sky; its sum over the dome is [`Sky::diffuse_lx`].
    pub fn new(sky: &Sky) -> Self {
        let spread = match sky.weather {
            Weather::Overcast => SkyModel::Overcast,
            Weather::Clear { turbidity } => {
                let from_zenith = math::acos(sky.to_sun.y.max(0.0));
                SkyModel::Clear {
                    perez: coefficients(turbidity),
                    zenith: zenith_chromaticity(turbidity, from_zenith),
                }
            }
        };
        // After sunset the sky stays brightest above the sunset point.
        let level = Vec3::new(sky.to_sun.x, sky.to_sun.y.max(0.0), sky.to_sun.z);
        let mut dome = Self {
            to_sun: level.normalize_or(Vec3::Y),
            spread,
            scale_cd_m2: 1.0,
        };
        let sum = dome.horizontal_illuminance_lx();
        dome.scale_cd_m2 = sky.diffuse_lx / sum.max(1e-6);
        dome
    }

    /// Returns the luminance in a direction of unit length, cd/m² in linear sRGB; 0 below the horizon.
    ///
    /// # Source
    /// Clear: A. J. Preetham, P. Shirley, B. Smits, "A Practical Analytic Model for Daylight", SIGGRAPH 1999, equation 4
    /// with the coefficients of appendix A.2. Overcast: CIE S 003 (Moon and Spencer 1942), (1 + 2 sin elevation) / 3.
    pub fn luminance(&self, direction: Vec3) -> Vec3 {
        if direction.y < 0.0 {
            return Vec3::ZERO;
        }
        match &self.spread {
            SkyModel::Overcast => Vec3::splat((1.0 + 2.0 * direction.y) / 3.0 * self.scale_cd_m2),
            SkyModel::Clear { perez, zenith } => {
                let [luminance, x, y] = [0, 1, 2].map(|k| self.perez(&perez[k], direction));
                let bright = luminance * self.scale_cd_m2;
                srgb_from_xyy(zenith.x * x, zenith.y * y, bright)
            }
        }
    }

    /// Returns the coefficients of [`Self::luminance`], for processors that compute it without this crate: position of the
    /// sun, and 1 for a clear sky; zenith chromaticity and scale; then coefficients A to E for Y, x and y.
    pub fn coefficients(&self) -> [[f32; 4]; 6] {
        let [x, y, z] = self.to_sun.to_array();
        let (clear, zenith, perez) = match &self.spread {
            SkyModel::Clear { perez, zenith } => (1.0, *zenith, *perez),
            SkyModel::Overcast => (0.0, Vec2::ZERO, [[0.0; 5]; 3]),
        };
        let mut numbers = [[0.0; 4]; 6];
        numbers[0] = [x, y, z, clear];
        numbers[1] = [zenith.x, zenith.y, self.scale_cd_m2, 0.0];
        for (k, number) in perez.iter().flatten().enumerate() {
            numbers[2 + k / 4][k % 4] = *number;
        }
        numbers
    }

    /// Perez' function in a direction over that at the zenith, equation 3.
    fn perez(&self, [a, b, c, d, e]: &[f32; 5], direction: Vec3) -> f32 {
        let part = |cosine: f32, to_sun: f32| {
            let angle = math::acos(to_sun);
            (1.0 + a * math::exp(b / cosine.max(HORIZON)))
                * (1.0 + c * math::exp(d * angle) + e * to_sun * to_sun)
        };
        part(direction.y, direction.dot(self.to_sun)) / part(1.0, self.to_sun.y)
    }

    /// Illuminance on a horizontal surface, lx: the sum of luminance times sine of elevation.
    fn horizontal_illuminance_lx(&self) -> f32 {
        let [rows, columns] = STEPS;
        let mut sum = 0.0;
        for row in 0..rows {
            let elevation = (row as f32 + 0.5) * (FRAC_PI_2 / rows as f32);
            let (sin, cos) = math::sin_cos(elevation);
            let mut ring = 0.0;
            for column in 0..columns {
                let (s, c) = math::sin_cos((column as f32 + 0.5) * (TAU / columns as f32));
                let rgb = self.luminance(Vec3::new(cos * c, sin, cos * s));
                ring += rgb.dot(Vec3::new(0.2126, 0.7152, 0.0722));
            }
            sum += ring * sin * cos;
        }
        sum * (FRAC_PI_2 / rows as f32) * (TAU / columns as f32)
    }
}

/// Coefficients A to E for Y, x and y: Preetham et al. 1999, appendix A.2.
fn coefficients(turbidity: f32) -> [[f32; 5]; 3] {
    let rows: [[[f32; 2]; 5]; 3] = [
        [
            [0.1787, -1.4630],
            [-0.3554, 0.4275],
            [-0.0227, 5.3251],
            [0.1206, -2.5771],
            [-0.0670, 0.3703],
        ],
        [
            [-0.0193, -0.2592],
            [-0.0665, 0.0008],
            [-0.0004, 0.2125],
            [-0.0641, -0.8989],
            [-0.0033, 0.0452],
        ],
        [
            [-0.0167, -0.2608],
            [-0.0950, 0.0092],
            [-0.0079, 0.2102],
            [-0.0441, -1.6537],
            [-0.0109, 0.0529],
        ],
    ];
    rows.map(|row| row.map(|[slope, start]| slope * turbidity + start))
}

/// Zenith chromaticity at a zenith angle of the sun, rad: Preetham et al. 1999, appendix A.2.
fn zenith_chromaticity(turbidity: f32, from_zenith: f32) -> Vec2 {
    let x = [
        [0.001_66, -0.003_75, 0.002_09, 0.0],
        [-0.029_03, 0.063_77, -0.032_02, 0.003_94],
        [0.116_93, -0.211_96, 0.060_52, 0.258_86],
    ];
    let y = [
        [0.002_75, -0.006_10, 0.003_17, 0.0],
        [-0.042_14, 0.089_70, -0.041_53, 0.005_16],
        [0.153_46, -0.267_56, 0.066_70, 0.266_88],
    ];
    let t = from_zenith.clamp(0.0, FRAC_PI_2.min(PI));
    let of = |rows: [[f32; 4]; 3]| {
        let [squared, linear, constant] =
            rows.map(|[cube, square, first, rest]| rest + t * (first + t * (square + t * cube)));
        constant + turbidity * (linear + turbidity * squared)
    };
    Vec2::new(of(x), of(y))
}

/// Returns linear sRGB of a chromaticity and luminance; colours outside sRGB lose saturation, not luminance.
///
/// # Source
/// IEC 61966-2-1: the matrix from XYZ.
fn srgb_from_xyy(x: f32, y: f32, luminance: f32) -> Vec3 {
    let over_y = luminance / y.max(1e-3);
    let (big_x, big_z) = (x * over_y, (1.0 - x - y) * over_y);
    let rgb = Vec3::new(
        3.2406 * big_x - 1.5372 * luminance - 0.4986 * big_z,
        -0.9689 * big_x + 1.8758 * luminance + 0.0415 * big_z,
        0.0557 * big_x - 0.2040 * luminance + 1.0570 * big_z,
    );
    let least = rgb.min_element();
    if least >= 0.0 {
        return rgb;
    }
    // Towards the grey of the same luminance, as far as the least channel needs.
    let part = luminance / (luminance - least);
    (Vec3::splat(luminance) + (rgb - luminance) * part).max(Vec3::ZERO)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sky::SkyConditions;

    fn sky(hour_h: f32, weather: Weather) -> Sky {
        Sky::at(&SkyConditions {
            hour_h,
            weather,
            ..SkyConditions::default()
        })
        .unwrap()
    }

    fn bright(rgb: Vec3) -> f32 {
        rgb.dot(Vec3::new(0.2126, 0.7152, 0.0722))
    }

    /// Horizontal illuminance of the CIE's overcast sky is 7 pi / 9 times the zenith luminance.
    #[test]
    fn an_overcast_sky_sums_to_its_closed_form() {
        let sky = sky(12.0, Weather::Overcast);
        let zenith = bright(SkyDome::new(&sky).luminance(Vec3::Y));
        let expected = sky.diffuse_lx * 9.0 / (7.0 * PI);
        assert!(
            (zenith / expected - 1.0).abs() < 2e-3,
            "{zenith} {expected}"
        );
    }

    /// Against another sum: directions of a spiral instead of rings.
    #[test]
    fn a_clear_sky_gives_the_light_that_it_shall() {
        for hour in [7.0, 9.0, 12.0, 18.0, 19.5] {
            let sky = sky(hour, Weather::CLEAR_DEFAULT);
            let dome = SkyDome::new(&sky);
            let count = 40_000_u16;
            let mut sum = 0.0_f64;
            for k in 0..count {
                let up = (f32::from(k) + 0.5) / f32::from(count);
                let turn = f32::from(k) * 2.399_963;
                let level = (1.0 - up * up).sqrt();
                let direction = Vec3::new(level * turn.cos(), up, level * turn.sin());
                sum += f64::from(bright(dome.luminance(direction)) * up);
            }
            let found = sum * f64::from(TAU) / f64::from(count);
            let share = found / f64::from(sky.diffuse_lx);
            assert!((share - 1.0).abs() < 0.02, "{hour}: {share}");
        }
    }

    #[test]
    fn a_clear_sky_is_blue_overhead_and_brightest_at_the_sun() {
        let sky = sky(10.0, Weather::CLEAR_DEFAULT);
        let dome = SkyDome::new(&sky);
        let zenith = dome.luminance(Vec3::Y);
        assert!(zenith.z > 1.5 * zenith.x, "{zenith}");
        // A few thousand cd/m² overhead, as measured under clear skies.
        assert!((1500.0..8000.0).contains(&bright(zenith)), "{zenith}");
        let away = Vec3::new(-sky.to_sun.x, sky.to_sun.y, -sky.to_sun.z);
        assert!(bright(dome.luminance(sky.to_sun)) > 3.0 * bright(dome.luminance(away)));
        assert_eq!(dome.luminance(Vec3::NEG_Y), Vec3::ZERO);
        for hour in [0.0, 5.0, 6.0, 12.0, 19.0, 20.0, 24.0] {
            let dome = SkyDome::new(&self::sky(hour, Weather::Clear { turbidity: 10.0 }));
            for k in 0..200 {
                let turn = k as f32 * 2.4;
                let up = k as f32 / 200.0;
                let level = (1.0 - up * up).sqrt();
                let rgb = dome.luminance(Vec3::new(level * turn.cos(), up, level * turn.sin()));
                assert!(rgb.is_finite() && rgb.min_element() >= 0.0, "{hour}: {rgb}");
            }
        }
    }
}
