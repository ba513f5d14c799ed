//! Sensors: what an agent observes. One file each, and one line in [`all`].
//!
//! A sensor works in two phases. In the first it states its requests ([`Sensor::request`]); the engines then run once for
//! all sensors of all worlds; in the second it writes into a buffer that the caller owns ([`Sensor::write_observation`]).

mod albedo;
mod audio;
mod boxes_2d;
mod boxes_3d;
mod camera;
mod compass;
mod contact;
mod depth;
mod flow;
mod gps;
mod gyro;
mod heard_directions;
mod heard_tokens;
mod image;
mod imagegoal;
mod instance;
mod instruction;
mod instruction_tokens;
mod lidar;
mod normals;
mod object_list;
mod objectgoal;
mod picture_memory;
mod pointgoal_with_gps_compass;
mod proprioception;
mod question;
mod question_tokens;
mod rearrangegoal;
mod receiver;
mod reply;
mod reply_tokens;
mod rgb;
mod roomgoal;
mod semantic;
mod spectrogram;
mod surfels;
mod top_down_map;
mod unshuffled_rgb;
mod visible_objects;
mod wheel_odometry;

pub use crate::eye_camera::EyeCamera;
pub use camera::CameraConfig;
pub(crate) use camera::mount;
pub use image::{DisplayStyle, ImageObservationOptions, Observation, ObservationData};
pub(crate) use picture_memory::{image_bytes, observation_bytes};

use crate::episode::{Episode, GoalField};
use crate::error::WorldError;
use crate::schema::FieldSchema;
use crate::sensor_requests::{RenderedImages, SensorRequests};
use crate::world::World;
use dwell_render::ClassSet;
use dwell_scene::random::RandomKey;
use dwell_scene::{AgentId, AgentState, Id, IdVec, Pose};
use dwell_semantics::dialogue::Reply;
use serde::Serialize;
use std::fmt::Debug;

/// The type of an observation's elements.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Dtype {
    /// Bytes.
    Uint8,
    /// 32-bit floats.
    Float32,
    /// 32-bit integers, each from 0 to below the spec's `high`.
    Int32,
    /// A string; `high` is its greatest length.
    Text,
}

/// The specification of a sensor's observation.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SensorSpec {
    /// The key in the observation.
    pub name: String,
    /// The shape; empty for text.
    pub shape: Vec<usize>,
    /// The element type.
    pub dtype: Dtype,
    /// The unit; `"1"` for none.
    pub unit: &'static str,
    /// The lowest value.
    pub low: f64,
    /// The highest value (for text: the greatest length; for tokens: the vocabulary's size).
    pub high: f64,
    /// One sentence about it.
    pub about: &'static str,
}

impl SensorSpec {
    /// The number of elements.
    pub fn len(&self) -> usize {
        self.shape.iter().product()
    }

    /// Returns whether the observation has no elements.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

/// The buffer that a sensor writes into.
#[derive(Debug)]
pub enum ObservationBuffer<'a> {
    /// For [`Dtype::Uint8`].
    Uint8(&'a mut [u8]),
    /// For [`Dtype::Float32`].
    Float32(&'a mut [f32]),
    /// For [`Dtype::Int32`].
    Int32(&'a mut [i32]),
    /// For [`Dtype::Text`].
    Text(&'a mut String),
}

/// The inputs of a sensor when it finishes.
#[derive(Clone, Copy, Debug)]
pub struct SensorContext<'a> {
    /// The world after the step.
    pub world: &'a World,
    /// The episode of the agent whose sensor it is.
    pub episode: &'a Episode,
    /// Poses of all agents of the world at the beginning of the episode. Shape (agent,).
    pub start_poses: &'a IdVec<AgentId, Pose>,
    /// What the oracle of the agent's task replied to what it asked in the latest step.
    pub reply: Option<&'a Reply>,
    /// The results of the engines.
    pub results: &'a RenderedImages,
    /// The sensor's random stream in this step.
    pub key: RandomKey,
}

impl SensorContext<'_> {
    /// Returns where an agent started.
    pub(crate) fn start_pose(&self, agent: AgentId) -> Pose {
        self.start_poses
            .get(agent)
            .copied()
            .unwrap_or(Pose::IDENTITY)
    }
}

/// A sensor on one agent.
pub trait Sensor: Debug + Send + Sync {
    /// Shape, type, unit and range of the observation.
    fn spec(&self) -> SensorSpec;

    /// Its camera, if it has one.
    fn camera(&self) -> Option<&EyeCamera> {
        None
    }

    /// Looks at the start of an episode; most sensors keep nothing of it.
    ///
    /// # Errors
    /// [`WorldError::Render`] for a picture that cannot be made.
    fn begin_episode(&mut self, _world: &World, _episode: &Episode) -> Result<(), WorldError> {
        Ok(())
    }

    /// Takes in the world after a control step, whether or not somebody observes it; most sensors keep nothing of it.
    ///
    /// # Errors
    /// [`WorldError::Scene`] for a world of another house.
    fn advance(&mut self, _world: &World) -> Result<(), WorldError> {
        Ok(())
    }

    /// Begins its memory of the episode anew, with what it senses in the world as it is now; nothing for most.
    ///
    /// # Errors
    /// As [`Self::advance`].
    fn forget(&mut self, _world: &World) -> Result<(), WorldError> {
        Ok(())
    }

    /// What it remembers of the episode, as bytes for snapshots; nothing for most.
    fn snapshot(&self) -> Vec<u8> {
        Vec::new()
    }

    /// Goes to a [`Self::snapshot`] of a sensor with equal settings in the same house.
    ///
    /// # Errors
    /// [`WorldError::Snapshot`] for bytes that are none.
    fn restore(&mut self, _world: &World, bytes: &[u8]) -> Result<(), WorldError> {
        match bytes {
            [] => Ok(()),
            _ => Err(WorldError::Snapshot(format!(
                "the sensor {:?} remembers nothing",
                self.spec().name
            ))),
        }
    }

    /// States the requests to the engines; most sensors that read the state need nothing.
    fn request(&self, _world: &World, _requests: &mut SensorRequests) {}

    /// Writes the observation. `out` has the type and length of [`Sensor::spec`].
    fn write_observation(&self, seen: SensorContext<'_>, out: ObservationBuffer<'_>);

    /// Returns the number of samples of the latest observation that were clipped to its range.
    fn clipped_samples(&self) -> u64 {
        0
    }
}

/// The inputs from which a sensor is built: the world's fixed numbers.
#[derive(Clone, Copy, Debug)]
pub struct SensorSetup<'a> {
    /// The world's settings.
    pub config: &'a crate::config::WorldConfig,
    /// Whose sensor it is: the agent of sensors that name none.
    pub agent: AgentId,
}

impl SensorSetup<'_> {
    /// The agent of a sensor whose settings name one, or none.
    ///
    /// # Errors
    /// [`WorldError::Config`] for an agent that does not exist.
    fn agent(&self, named: Option<u32>) -> Result<AgentId, WorldError> {
        let agent = named.map_or(self.agent, AgentId);
        if agent.index() < self.config.agents.len() {
            return Ok(agent);
        }
        let allowed = match self.config.agents.len() {
            0 => "none: the world has no agents; give it one at least".to_owned(),
            count => format!("below the number of agents, {count}"),
        };
        Err(WorldError::Config {
            field: "agent",
            found: agent.0.to_string(),
            allowed,
        })
    }
}

/// The number of samples of a window of sound.
///
/// # Errors
/// [`WorldError::Config`] for less than a sample or more than 10 s.
fn window_samples(site: SensorSetup<'_>, window_s: f64) -> Result<usize, WorldError> {
    let samples = (window_s * f64::from(site.config.sound_rate_hz)).round();
    if window_s <= 10.0 && samples >= 1.0 {
        return Ok(samples as usize);
    }
    Err(WorldError::Config {
        field: "window_s",
        found: window_s.to_string(),
        allowed: "one sample to 10 s".to_owned(),
    })
}

/// The settings of a sensor that has only a name.
#[derive(Debug, Default, serde::Deserialize, schemars::JsonSchema)]
#[serde(default, deny_unknown_fields)]
struct NameSettings {
    /// The key in the observation; by default the sensor's kind.
    name: Option<String>,
}

/// The settings of a sensor of an agent that has no others.
#[derive(Debug, Default, serde::Deserialize, schemars::JsonSchema)]
#[serde(default, deny_unknown_fields)]
struct AgentSensorSettings {
    /// The key in the observation; by default the sensor's kind.
    name: Option<String>,
    /// Which agent's; by default the one whom the environment is about.
    agent: Option<u32>,
}

/// The agent of a sensor, and its key in the observation.
#[derive(Debug)]
struct ObservedAgent {
    name: String,
    agent: AgentId,
}

impl ObservedAgent {
    fn build(
        kind: &str,
        value: &serde_json::Value,
        setup: SensorSetup<'_>,
    ) -> Result<Self, WorldError> {
        let AgentSensorSettings { name, agent } = parse_sensor_settings(value)?;
        Ok(Self {
            name: key(kind, name)?,
            agent: setup.agent(agent)?,
        })
    }

    /// The agent's state in a world.
    fn state<'a>(&self, seen: SensorContext<'a>) -> Option<&'a AgentState> {
        seen.world.state().agents.get(self.agent)
    }
}

/// The key of a sensor in the observation.
///
/// # Errors
/// [`WorldError::Config`] for an empty name.
fn key(kind: &str, name: Option<String>) -> Result<String, WorldError> {
    match name {
        Some(name) if name.is_empty() => Err(WorldError::Config {
            field: "name",
            found: "\"\"".to_owned(),
            allowed: "a word".to_owned(),
        }),
        name => Ok(name.unwrap_or_else(|| kind.to_owned())),
    }
}

/// Builds a sensor from its settings (a JSON object; `null` gives the defaults).
pub type SensorBuilder =
    fn(&serde_json::Value, SensorSetup<'_>) -> Result<Box<dyn Sensor>, WorldError>;

/// A kind of sensor, requested by name.
#[derive(Clone, Copy, Debug)]
pub struct SensorKind {
    /// The name, and the observation's default key.
    pub name: &'static str,
    /// One sentence about it.
    pub about: &'static str,
    /// Builds one from its settings (a JSON object; `{}` gives the defaults).
    pub build: SensorBuilder,
    /// The fields of its settings.
    pub settings: fn() -> Vec<FieldSchema>,
    /// The image sensor's part in [`World::image_observations`].
    pub(crate) image: Option<image::ClassImageSensor>,
    /// What it observes of the goal; `None` for sensors that observe nothing of it, or in words.
    pub goal_part: Option<GoalField>,
}

impl SensorKind {
    /// Returns whether it is an image sensor: [`World::image_observations`] knows it.
    pub fn is_image_sensor(&self) -> bool {
        self.image.is_some()
    }

    /// Returns the style in which its observation is shown to people; `None` for other than image sensors.
    pub fn picture_style(&self) -> Option<DisplayStyle> {
        let image = self.image?;
        Some(image(ClassSet::Coarse).style)
    }
}

/// All kinds of sensors.
pub fn all() -> &'static [SensorKind] {
    &[
        rgb::KIND,
        depth::KIND,
        instance::KIND,
        semantic::KIND,
        normals::KIND,
        albedo::KIND,
        surfels::KIND,
        flow::KIND,
        visible_objects::KIND,
        boxes_2d::KIND,
        boxes_3d::KIND,
        audio::KIND,
        spectrogram::KIND,
        heard_tokens::KIND,
        heard_directions::KIND,
        pointgoal_with_gps_compass::KIND,
        roomgoal::KIND,
        objectgoal::KIND,
        imagegoal::KIND,
        rearrangegoal::KIND,
        unshuffled_rgb::KIND,
        instruction::KIND,
        instruction_tokens::KIND,
        question::KIND,
        question_tokens::KIND,
        reply::KIND,
        reply_tokens::KIND,
        gps::KIND,
        compass::KIND,
        wheel_odometry::KIND,
        gyro::KIND,
        lidar::KIND,
        top_down_map::KIND,
        contact::KIND,
        proprioception::KIND,
    ]
}

/// The kind called `name`.
pub(crate) fn find(name: &str) -> Option<&'static SensorKind> {
    all().iter().find(|kind| kind.name == name)
}

/// Builds the sensor called `name` from `settings`.
///
/// # Errors
/// [`WorldError::Unknown`] lists the names there are; [`WorldError::Config`] names a wrong setting.
pub fn build(
    name: &str,
    settings: &serde_json::Value,
    site: SensorSetup<'_>,
) -> Result<Box<dyn Sensor>, WorldError> {
    let Some(kind) = find(name) else {
        return Err(unknown("sensor", name, all().iter()));
    };
    (kind.build)(settings, site).map_err(|error| match &error {
        // Of this kind there is one alone, called as the kind is.
        WorldError::Settings { error: told, .. }
            if told.to_string().starts_with("unknown field `name`") =>
        {
            let mut own = settings.clone();
            own.as_object_mut().map(|fields| fields.remove("name"));
            WorldError::Config {
                field: "a sensor's name",
                found: settings["name"].to_string(),
                allowed: format!("{name:?}, the only one of its kind: give {{{name:?}: {own}}}"),
            }
        }
        _ => error,
    })
}

/// The error for a name that no sensor has; an earlier name leads to the setting that took its place.
fn unknown<'a>(
    kind: &'static str,
    name: &str,
    known: impl Iterator<Item = &'a SensorKind>,
) -> WorldError {
    match semantic::setting_of_deprecated_name(name) {
        Some(classes) => WorldError::Config {
            field: kind,
            found: format!("{name:?}"),
            allowed: format!("\"semantic\" with the setting classes = {classes:?}"),
        },
        None => WorldError::Unknown {
            kind,
            name: name.to_owned(),
            known: known.map(|kind| kind.name.to_owned()).collect(),
        },
    }
}

/// Reads a sensor's settings; `null` counts as `{}`.
pub(crate) fn parse_sensor_settings<
    T: serde::de::DeserializeOwned + schemars::JsonSchema + Default,
>(
    value: &serde_json::Value,
) -> Result<T, WorldError> {
    if value.is_null() {
        return Ok(T::default());
    }
    crate::parse_settings::parse_settings("sensor settings", value)
}

/// The settings of a sensor that has none.
#[derive(Debug, Default, serde::Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct NoSettings {}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::WorldConfig;
    use serde_json::json;

    #[test]
    fn a_name_for_what_has_none_leads_to_the_settings_that_are_meant() {
        let config = WorldConfig::default();
        let site = SensorSetup {
            config: &config,
            agent: AgentId(0),
        };
        let told = |kind: &str, settings: serde_json::Value| {
            build(kind, &settings, site).unwrap_err().to_string()
        };
        assert_eq!(
            told("instruction", json!({"name": "what"})),
            "a sensor's name is \"what\"; allowed is \"instruction\", the only one of its kind: give {\"instruction\": {}}"
        );
        assert!(build("rgb", &json!({"name": "left"}), site).is_ok());
        assert_eq!(
            told("semantic_nyu40", json!({})),
            "sensor is \"semantic_nyu40\"; allowed is \"semantic\" with the setting classes = \"nyu40\""
        );
        let second = build("gps", &json!({"name": "where", "agent": 0}), site).unwrap();
        assert_eq!(second.spec().name, "where");
        assert_eq!(
            told("gyro", json!({"agent": 1})),
            "agent is 1; allowed is below the number of agents, 1"
        );
        assert!(build("semantic", &json!({"classes": "nyu40"}), site).is_ok());
        assert!(told("gps", json!({"nme": 1})).contains("unknown field `nme`"));
    }
}
