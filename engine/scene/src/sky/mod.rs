//! The sky: position of the sun, and daylight from sun and sky.

mod dome;
mod sun;

pub use dome::SkyDome;

use crate::error::{SceneError, check_range};
use crate::math;
use crate::space;
use glam::Vec3;
use serde::{Deserialize, Serialize};

/// Path of its numbers, for errors.
const AT: &str = "sky";

/// The weather, which determines the sky's luminance.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum Weather {
    /// No clouds.
    Clear {
        /// Turbidity of the air: 2 (very clear) to 10 (haze).
        turbidity: f32,
    },
    /// Overcast: no sun, grey, three times as bright at the zenith as at the horizon.
    Overcast,
}

impl Weather {
    /// Clear with a turbidity of 2.5, a fine day.
    pub const CLEAR_DEFAULT: Self = Self::Clear { turbidity: 2.5 };
}

/// Daylight from sun and sky at one moment, the same for all of a house.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Sky {
    /// Horizontal direction to the north in world space, unit length.
    pub north: Vec3,
    /// Direction to the middle of the sun in world space, unit length; below the horizon at night.
    pub to_sun: Vec3,
    /// Illuminance by the sun alone on a surface normal to its rays, lx, in linear sRGB; 0 at night and behind clouds.
    pub sun_lx: [f32; 3],
    /// Horizontal illuminance by the sky alone in the open, lx.
    pub diffuse_lx: f32,
    /// The distribution of light over the sky.
    pub weather: Weather,
}

/// The time and place that determine a [`Sky`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct SkyConditions {
    /// Local solar time, h: 0 to 24, the sun highest at 12.
    pub hour_h: f32,
    /// Day of the year, 1 to 366.
    pub day: u16,
    /// Latitude, degrees: -90 to 90, north positive.
    pub latitude_deg: f32,
    /// Yaw of north, degrees: 0 is -Z, positive to the left seen from above.
    pub north_yaw_deg: f32,
    /// Clouds and haze.
    pub weather: Weather,
}

impl Default for SkyConditions {
    /// Half past one on a fine day in the middle of April, at 48 degrees north, with north along -Z.
    fn default() -> Self {
        Self {
            hour_h: 13.5,
            day: 105,
            latitude_deg: 48.0,
            north_yaw_deg: 0.0,
            weather: Weather::CLEAR_DEFAULT,
        }
    }
}

impl Sky {
    /// Returns sun and sky of a moment.
    ///
    /// # Errors
    /// [`SceneError::Range`] for a number out of the range that its field names.
    ///
    /// # Source
    /// Position of the sun: see [`SkyConditions`]'s fields and J. W. Spencer, "Fourier series representation of the position of the
    /// sun", Search 2 (5), 172 (1971). Light of the sun: A. J. Preetham, P. Shirley, B. Smits, "A Practical Analytic Model
    /// for Daylight", SIGGRAPH 1999, appendix A.1, of the illuminance outside the air that the IES recommends. Light of the
    /// sky: IES Calculation Procedures Committee, "Recommended Practice for the Calculation of Daylight Availability",
    /// J. IES 13, 381 (1984); below level, P. M. Janiczek, J. A. De Young, USNO Circular 171 (1987).
    ///
    /// ```
    /// use dwell_scene::{SkyConditions, Sky};
    /// let noon = Sky::at(&SkyConditions { hour_h: 12.0, ..SkyConditions::default() })?;
    /// let night = Sky::at(&SkyConditions { hour_h: 23.0, ..SkyConditions::default() })?;
    /// assert!(noon.to_sun.y > 0.7 && noon.sun_lx[1] > 50_000.0);
    /// assert!(night.to_sun.y < 0.0 && night.sun_lx == [0.0; 3]);
    /// # Ok::<(), dwell_scene::SceneError>(())
    /// ```
    pub fn at(moment: &SkyConditions) -> Result<Self, SceneError> {
        moment.check()?;
        let north_yaw = moment.north_yaw_deg.to_radians();
        let north = space::rotation_from_yaw_pitch(north_yaw, 0.0) * Vec3::NEG_Z;
        let day = f32::from(moment.day);
        let [east, up, to_north] = sun::east_up_north(
            sun::declination_rad(day),
            moment.latitude_deg.to_radians(),
            sun::hour_angle_rad(moment.hour_h),
        );
        let to_sun =
            (north.cross(Vec3::Y) * east + Vec3::Y * up + north * to_north).normalize_or(Vec3::Y);
        let altitude_rad = math::asin(to_sun.y);
        Ok(Self {
            north,
            to_sun,
            sun_lx: sun::direct_lx(altitude_rad, day, moment.weather),
            diffuse_lx: sun::diffuse_lx(altitude_rad, moment.weather),
            weather: moment.weather,
        })
    }

    /// Returns the horizontal illuminance by sun and sky in the open, lx, in linear sRGB without the sky's colour.
    pub fn horizontal_illuminance_lx(&self) -> Vec3 {
        Vec3::splat(self.diffuse_lx) + Vec3::from_array(self.sun_lx) * self.to_sun.y.max(0.0)
    }

    /// Checks all numbers.
    ///
    /// # Errors
    /// [`SceneError::Range`] names the field, the value found, and the allowed ones.
    pub(crate) fn check(&self) -> Result<(), SceneError> {
        let unit = |v: Vec3| (v.length() - 1.0).abs() < 1e-3;
        check_range(
            AT,
            "north",
            unit(self.north) && self.north.y.abs() < 1e-3,
            self.north,
            "a level unit vector",
        )?;
        check_range(
            AT,
            "to_sun",
            unit(self.to_sun),
            self.to_sun,
            "a unit vector",
        )?;
        let lx = 0.0..=200_000.0;
        check_range(
            AT,
            "sun_lx",
            self.sun_lx.iter().all(|x| lx.contains(x)),
            format!("{:?}", self.sun_lx),
            "0 to 200000",
        )?;
        check_range(
            AT,
            "diffuse_lx",
            lx.contains(&self.diffuse_lx),
            self.diffuse_lx,
            "0 to 200000",
        )?;
        self.weather.check()
    }
}

impl Weather {
    fn check(self) -> Result<(), SceneError> {
        match self {
            Self::Overcast => Ok(()),
            Self::Clear { turbidity } => check_range(
                AT,
                "weather.turbidity",
                (2.0..=10.0).contains(&turbidity),
                turbidity,
                "2 to 10",
            ),
        }
    }
}

impl SkyConditions {
    fn check(&self) -> Result<(), SceneError> {
        let hour = self.hour_h;
        check_range(AT, "hour_h", (0.0..=24.0).contains(&hour), hour, "0 to 24")?;
        let day = self.day;
        check_range(AT, "day", (1..=366).contains(&day), day, "1 to 366")?;
        let latitude = self.latitude_deg;
        let ok = (-90.0..=90.0).contains(&latitude);
        check_range(AT, "latitude_deg", ok, latitude, "-90 to 90")?;
        let yaw = self.north_yaw_deg;
        let ok = (-360.0..=360.0).contains(&yaw);
        check_range(AT, "north_yaw_deg", ok, yaw, "-360 to 360")?;
        self.weather.check()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(hour_h: f32) -> Sky {
        Sky::at(&SkyConditions {
            hour_h,
            ..SkyConditions::default()
        })
        .unwrap()
    }

    #[test]
    fn the_sun_rises_in_the_east_stands_in_the_south_and_sets_in_the_west() {
        // North is -Z, so east is +X.
        let [morning, noon, evening] = [8.0, 12.0, 17.0].map(|hour| at(hour).to_sun);
        assert!(morning.x > 0.5 && morning.y > 0.2, "{morning}");
        assert!(noon.x.abs() < 1e-4 && noon.z > 0.5, "{noon}");
        assert!(evening.x < -0.5 && evening.y > 0.1, "{evening}");
        // A quarter turn of north turns the sun with it.
        let turned = Sky::at(&SkyConditions {
            hour_h: 12.0,
            north_yaw_deg: 90.0,
            ..SkyConditions::default()
        })
        .unwrap();
        assert!(turned.north.abs_diff_eq(Vec3::NEG_X, 1e-6));
        assert!(turned.to_sun.x > 0.5 && turned.to_sun.z.abs() < 1e-4);
    }

    #[test]
    fn a_day_is_bright_at_noon_red_in_the_evening_and_dark_at_night() {
        let (noon, evening, night) = (at(12.0), at(18.3), at(23.0));
        let level = |sky: &Sky| sky.horizontal_illuminance_lx().y;
        // A clear sky with the sun 51 degrees high: 80 to 100 klx, of which the sky gives some 15 (IES).
        assert!((75e3..105e3).contains(&level(&noon)), "{}", level(&noon));
        assert!((13e3..16e3).contains(&noon.diffuse_lx));
        assert!(level(&evening) < 0.1 * level(&noon));
        let redness = |sky: &Sky| sky.sun_lx[0] / sky.sun_lx[2];
        assert!(redness(&evening) > 2.0 * redness(&noon));
        assert!(level(&night) < 0.1);
        let dull = Sky::at(&SkyConditions {
            hour_h: 12.0,
            weather: Weather::Overcast,
            ..SkyConditions::default()
        })
        .unwrap();
        assert!(dull.sun_lx == [0.0; 3] && (10e3..25e3).contains(&dull.diffuse_lx));
    }

    #[test]
    fn impossible_moments_are_refused_by_field() {
        let refused = |change: &dyn Fn(&mut SkyConditions)| {
            let mut moment = SkyConditions::default();
            change(&mut moment);
            Sky::at(&moment).unwrap_err().to_string()
        };
        for (message, field) in [
            (refused(&|m| m.hour_h = 24.5), "hour_h"),
            (refused(&|m| m.hour_h = f32::NAN), "hour_h"),
            (refused(&|m| m.day = 0), "day"),
            (refused(&|m| m.latitude_deg = 91.0), "latitude_deg"),
            (
                refused(&|m| m.weather = Weather::Clear { turbidity: 1.0 }),
                "turbidity",
            ),
        ] {
            assert!(message.contains(field), "{message}");
        }
    }
}
