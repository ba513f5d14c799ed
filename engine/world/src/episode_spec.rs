//! Episodes that state where they start and what they ask for, in place of drawing it from their seed.

use crate::error::WorldError;
use crate::parse_settings::parse_settings;
use glam::Vec3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Largest coordinate of a place, m.
const MOST_M: f32 = 1e6;
/// Longest time of a sound, s: a year.
const MOST_S: f64 = 3.2e7;

/// What an episode states; all else is drawn from its seed.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct EpisodeSpec {
    /// Where the agent starts; default drawn.
    pub start: Option<StatedStart>,
    /// What is asked; default drawn.
    pub goal: Option<StatedGoal>,
}

/// A start that is stated.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StatedStart {
    /// The point between the agent's feet, m.
    pub position: [f32; 3],
    /// Where it faces, degrees, positive to the left, 0 along -Z.
    #[serde(default)]
    pub yaw_deg: Option<f64>,
    /// The same, rad, in place of `yaw_deg`.
    #[serde(default)]
    pub yaw_rad: Option<f32>,
}

impl StatedStart {
    /// The heading, rad; 0 where none is stated.
    pub(crate) fn heading_rad(&self) -> f32 {
        let of_degrees = self.yaw_deg.map(|yaw_deg| yaw_deg.to_radians() as f32);
        self.yaw_rad.or(of_degrees).unwrap_or(0.0)
    }
}

/// A goal that is stated: the fields of the task's kind of goals, and no others.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct StatedGoal {
    /// The point to go to, on the floor, m; of a sound, the floor below it (`PointNav`, `AudioNav`).
    pub position: Option<[f32; 3]>,
    /// The class of the things of which one counts, by a name or alias of `assets/categories.csv` (`ObjectNav`).
    pub class: Option<String>,
    /// Further classes whose things count as of `class`, such as double beds as beds (`ObjectNav`).
    pub also: Vec<String>,
    /// Their ids, as sensors and the scene graph give them; default all of the class (`ObjectNav`).
    pub objects: Vec<u32>,
    /// Points on or near which things of the class are, m: these alone count (`ObjectNav`).
    pub positions: Vec<[f32; 3]>,
    /// The signal that sounds, as `dwell.sounds.signals` names it; default drawn from the task's `sounds` (`AudioNav`).
    pub sound: Option<String>,
    /// A recording in place of a signal: its path below the world's `sound_root` (`AudioNav`).
    pub sound_file: Option<String>,
    /// Level at 1 m, dB SPL; default the task's, else the signal's usual one. Recordings need one (`AudioNav`).
    pub level_db: Option<f32>,
    /// Height of the source over the floor, m; default 1.5 (`AudioNav`).
    pub height_m: Option<f32>,
    /// After how many seconds it begins to sound; default 0 (`AudioNav`).
    pub offset_s: Option<f64>,
    /// For how many seconds it sounds; default till the episode's end (`AudioNav`).
    pub duration_s: Option<f64>,
}

impl StatedGoal {
    /// The names of the fields that are stated.
    fn fields(&self) -> Vec<&'static str> {
        let all = [
            ("position", self.position.is_some()),
            ("class", self.class.is_some()),
            ("also", !self.also.is_empty()),
            ("objects", !self.objects.is_empty()),
            ("positions", !self.positions.is_empty()),
            ("sound", self.sound.is_some()),
            ("sound_file", self.sound_file.is_some()),
            ("level_db", self.level_db.is_some()),
            ("height_m", self.height_m.is_some()),
            ("offset_s", self.offset_s.is_some()),
            ("duration_s", self.duration_s.is_some()),
        ];
        let stated = all.into_iter().filter(|(_, stated)| *stated);
        stated.map(|(name, _)| name).collect()
    }

    /// Refuses fields that goals of a task do not have.
    ///
    /// # Errors
    /// [`WorldError::Config`] names the field.
    pub(crate) fn reject_other_fields(&self, task: &str, own: &[&str]) -> Result<(), WorldError> {
        let fields = self.fields();
        match fields.iter().find(|name| !own.contains(name)) {
            None => Ok(()),
            Some(name) => Err(WorldError::Config {
                field: "episode.goal",
                found: format!("one with {name}"),
                allowed: format!("of {task} one with {}", own.join(", ")),
            }),
        }
    }

    /// The stated point.
    ///
    /// # Errors
    /// [`WorldError::Config`] where there is none.
    pub(crate) fn position(&self, task: &str) -> Result<Vec3, WorldError> {
        let position = self.position.map(Vec3::from_array);
        position.ok_or_else(|| WorldError::Config {
            field: "episode.goal",
            found: "one without a position".to_owned(),
            allowed: format!("of {task} one with position, [x, y, z] in metres"),
        })
    }
}

impl EpisodeSpec {
    /// Reads what an episode states from JSON.
    ///
    /// # Errors
    /// [`WorldError::Settings`] and [`WorldError::Config`] name the field.
    pub fn from_json(value: &serde_json::Value) -> Result<Self, WorldError> {
        let spec: Self = parse_settings("episode", value)?;
        spec.check()?;
        Ok(spec)
    }

    /// Returns whether nothing is stated.
    pub fn is_empty(&self) -> bool {
        self.start.is_none() && self.goal.is_none()
    }

    /// Refuses numbers out of range.
    ///
    /// # Errors
    /// [`WorldError::Config`] names the field.
    pub(crate) fn check(&self) -> Result<(), WorldError> {
        let fault = |field: &'static str, found: String, allowed: &str| {
            Err(WorldError::Config {
                field,
                found,
                allowed: allowed.to_owned(),
            })
        };
        let is_place = |place: &[f32; 3]| place.iter().all(|value| value.abs() <= MOST_M);
        let places = "three numbers up to 1,000,000 m";
        if let Some(start) = &self.start {
            if !is_place(&start.position) {
                let found = format!("{:?}", start.position);
                return fault("episode.start.position", found, places);
            }
            if start.yaw_deg.is_some() && start.yaw_rad.is_some() {
                let found = "one with yaw_deg and yaw_rad".to_owned();
                return fault("episode.start", found, "one of the two");
            }
            let yaw_deg = start.yaw_deg.unwrap_or_default();
            let yaw_rad = start.yaw_rad.unwrap_or_default();
            if yaw_deg.is_nan() || yaw_deg.abs() > 1e6 || yaw_rad.is_nan() || yaw_rad.abs() > 1e4 {
                let found = format!("{yaw_deg} degrees, {yaw_rad} rad");
                return fault("episode.start", found, "up to 1,000,000 degrees");
            }
        }
        let Some(goal) = &self.goal else {
            return Ok(());
        };
        let stated = goal.position.iter().chain(&goal.positions);
        for place in stated {
            if !is_place(place) {
                return fault("episode.goal.position", format!("{place:?}"), places);
            }
        }
        if let Some(height_m) = goal.height_m.filter(|value| !(0.0..=100.0).contains(value)) {
            return fault("episode.goal.height_m", height_m.to_string(), "0 to 100");
        }
        for (field, value) in [
            ("episode.goal.offset_s", goal.offset_s),
            ("episode.goal.duration_s", goal.duration_s),
        ] {
            if let Some(seconds) = value.filter(|value| !(0.0..=MOST_S).contains(value)) {
                return fault(field, seconds.to_string(), "0 to 32,000,000");
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn told(value: &serde_json::Value) -> String {
        EpisodeSpec::from_json(value).unwrap_err().to_string()
    }

    #[test]
    fn what_is_stated_wrongly_is_refused_by_its_field() {
        for (value, expected) in [
            (json!({"begin": 1}), "unknown field `begin`"),
            (
                json!({"start": {"yaw_deg": 1.0}}),
                "missing field `position`",
            ),
            (
                json!({"start": {"position": [1, 2]}}),
                "start is {\"position\":[1,2]}",
            ),
            (
                json!({"start": {"position": [1e30, 0, 0]}}),
                "episode.start.position is [1e30, 0.0, 0.0]; allowed is three numbers up to",
            ),
            (
                json!({"start": {"position": [0, 0, 0], "yaw_deg": 1, "yaw_rad": 1}}),
                "episode.start is one with yaw_deg and yaw_rad; allowed is one of the two",
            ),
            (
                json!({"goal": {"position": [0, 1e9, 0]}}),
                "episode.goal.position is [0.0, 1000000000.0, 0.0]",
            ),
            (
                json!({"goal": {"duration_s": -1.0}}),
                "episode.goal.duration_s is -1; allowed is 0 to 32,000,000",
            ),
            (
                json!({"goal": {"height_m": -1.0}}),
                "episode.goal.height_m is -1",
            ),
        ] {
            let found = told(&value);
            assert!(found.contains(expected), "{found}");
        }
        assert!(EpisodeSpec::from_json(&json!({})).unwrap().is_empty());
    }

    /// A heading that went through degrees of 64 bits is the same.
    #[test]
    fn headings_keep_their_bits() {
        for k in 0..1000 {
            let yaw_rad = -3.0_f32 + 0.006_173 * k as f32;
            let start = StatedStart {
                yaw_deg: Some(f64::from(yaw_rad).to_degrees()),
                ..StatedStart::default()
            };
            assert_eq!(start.heading_rad(), yaw_rad);
        }
    }

    #[test]
    fn fields_of_other_kinds_of_goals_are_refused() {
        let goal = StatedGoal {
            class: Some("chair".to_owned()),
            ..StatedGoal::default()
        };
        let error = goal
            .reject_other_fields("PointNav", &["position"])
            .unwrap_err();
        assert_eq!(
            error.to_string(),
            "episode.goal is one with class; allowed is of PointNav one with position"
        );
        assert!(goal.position("PointNav").is_err());
    }
}
