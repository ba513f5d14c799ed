//! The open air of a house that knows its sky.

use super::tone;
use dwell_scene::{Sky, SkyDome, math};
use glam::Vec3;
use std::f32::consts::{FRAC_PI_2, PI, TAU};

/// Albedo of the ground outside: grey-brown, the usual 0.2 (B. Y. H. Liu, R. C. Jordan, Solar Energy 7 (1963)).
const GROUND: Vec3 = Vec3::new(0.2, 0.2, 0.165);
/// Steps of the sum over the sky: of elevation and of azimuth.
const STEPS: [u32; 2] = [16, 32];

/// Sun, sky and ground.
#[derive(Debug)]
pub(crate) struct OutdoorLight {
    pub(super) dome: SkyDome,
    /// Direction to the sun, unit length.
    pub(crate) to_sun: Vec3,
    /// Illuminance by the sun across its rays, lx.
    pub(crate) sun_lx: Vec3,
    /// Luminance of the sky as spherical harmonics, cd/m². Shape (9,).
    pub(super) harmonics: [Vec3; 9],
    /// Radiant exitance of the ground, lm/m².
    pub(super) ground_lx: Vec3,
    /// Display white per lx in the open.
    pub(super) white_per_lx: f32,
}

/// The first nine spherical harmonics in a direction.
fn basis(d: Vec3) -> [f32; 9] {
    [
        0.282_095,
        0.488_603 * d.y,
        0.488_603 * d.z,
        0.488_603 * d.x,
        1.092_548 * d.x * d.y,
        1.092_548 * d.y * d.z,
        0.315_392 * (3.0 * d.z * d.z - 1.0),
        1.092_548 * d.x * d.z,
        0.546_274 * (d.x * d.x - d.y * d.y),
    ]
}

impl OutdoorLight {
    pub(crate) fn new(sky: &Sky) -> Self {
        let dome = SkyDome::new(sky);
        let [rows, columns] = STEPS;
        let (up, around) = (FRAC_PI_2 / rows as f32, TAU / columns as f32);
        let mut harmonics = [Vec3::ZERO; 9];
        for row in 0..rows {
            let (sin, cos) = math::sin_cos((row as f32 + 0.5) * up);
            for column in 0..columns {
                let (s, c) = math::sin_cos((column as f32 + 0.5) * around);
                let direction = Vec3::new(cos * c, sin, cos * s);
                let light = dome.luminance(direction) * (cos * up * around);
                for (sum, value) in harmonics.iter_mut().zip(basis(direction)) {
                    *sum += light * value;
                }
            }
        }
        let mut air = Self {
            dome,
            to_sun: sky.to_sun,
            sun_lx: Vec3::from_array(sky.sun_lx),
            harmonics,
            ground_lx: Vec3::ZERO,
            white_per_lx: 1.0,
        };
        let level = air.sky_illuminance(Vec3::Y) + air.sun_lx * air.to_sun.y.max(0.0);
        air.ground_lx = level * GROUND;
        air.white_per_lx = tone::exposure_per_lx(super::indirect::luminance(level));
        air
    }

    /// Illuminance by the sky on a surface that faces along `normal`, lx.
    ///
    /// # Source
    /// R. Ramamoorthi, P. Hanrahan, "An Efficient Representation for Irradiance Environment Maps", SIGGRAPH 2001: the
    /// cosine weighs the bands by pi, 2 pi / 3 and pi / 4 (equation 8).
    pub(crate) fn sky_illuminance(&self, normal: Vec3) -> Vec3 {
        let weight = |k: usize| match k {
            0 => PI,
            1..=3 => TAU / 3.0,
            _ => PI / 4.0,
        };
        let parts = self.harmonics.iter().zip(basis(normal)).enumerate();
        let sum: Vec3 = parts.map(|(k, (l, y))| *l * (y * weight(k))).sum();
        sum.max(Vec3::ZERO)
    }

    /// Illuminance by the ground on a surface that faces along `normal`, lx: its share of the hemisphere.
    pub(crate) fn ground_illuminance(&self, normal: Vec3) -> Vec3 {
        self.ground_lx * (0.5 - 0.5 * normal.y)
    }

    /// Returns the exposure of the open air beside a camera's own exposure: as eyes adapt to it by day, and not brighter than
    /// rooms by night.
    pub(crate) fn capped_exposure(&self, camera_per_lx: f32) -> f32 {
        self.white_per_lx.min(camera_per_lx)
    }

    /// Returns the luminance of the background, cd/m² times pi.
    pub(crate) fn background_luminance(&self, direction: Vec3) -> Vec3 {
        if direction.y >= 0.0 {
            self.dome.luminance(direction) * PI
        } else {
            self.ground_lx
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use dwell_scene::{SkyConditions, Weather};

    /// Against the sum of luminance times cosine over the sky.
    #[test]
    fn skylight_is_the_sum_over_the_sky() {
        for (hour_h, weather) in [
            (9.0, Weather::CLEAR_DEFAULT),
            (12.0, Weather::CLEAR_DEFAULT),
            (18.0, Weather::CLEAR_DEFAULT),
            (12.0, Weather::Overcast),
        ] {
            let sky = Sky::at(&SkyConditions {
                hour_h,
                weather,
                ..SkyConditions::default()
            })
            .unwrap();
            let air = OutdoorLight::new(&sky);
            let most = sky.diffuse_lx;
            for normal in [Vec3::Y, Vec3::X, Vec3::NEG_X, Vec3::Z, Vec3::NEG_Z] {
                let count = 20_000_u16;
                let sum: Vec3 = (0..count)
                    .map(|k| {
                        let up = (f32::from(k) + 0.5) / f32::from(count);
                        let (s, c) = (f32::from(k) * 2.399_963).sin_cos();
                        let level = (1.0 - up * up).sqrt();
                        let direction = Vec3::new(level * c, up, level * s);
                        air.dome.luminance(direction) * direction.dot(normal).max(0.0)
                    })
                    .sum();
                let exact = sum * (TAU / f32::from(count));
                // Nine harmonics keep irradiance to some percent (the paper: 1 % on average of smooth skies).
                let off = (air.sky_illuminance(normal) - exact).abs().max_element();
                assert!(off < 0.06 * most, "{hour_h} {normal}: {off} of {most}");
            }
            let below = air.sky_illuminance(Vec3::NEG_Y).max_element();
            assert!(below < 0.06 * most, "{below}");
        }
    }
}
