//! The picture at the goal.

use super::camera::CameraConfig;
use super::{
    Dtype, ObservationBuffer, Sensor, SensorContext, SensorKind, SensorSetup, SensorSpec,
    parse_sensor_settings,
};
use crate::camera_capture::{CameraMount, ImageRequest};
use crate::episode::{Episode, GoalField};
use crate::error::WorldError;
use crate::eye_camera::EyeCamera;
use crate::schema;
use crate::world::World;
use dwell_render::ImageChannels;
use dwell_scene::parallel::Threads;
use dwell_scene::{AgentState, Pose};

const ABOUT: &str = "Colour image that the agent would see at the goal as the episode begins, without itself: shape (height, width, 3), sRGB bytes.";

pub(super) const KIND: SensorKind = SensorKind {
    name: "imagegoal",
    about: ABOUT,
    build,
    settings: schema::fields_of::<CameraConfig>,
    image: None,
    goal_part: Some(GoalField::Image),
};

#[derive(Debug)]
struct ImageGoalSensor {
    name: String,
    eye: EyeCamera,
    /// The picture of the episode; shape (height, width, 3).
    rgb: Vec<u8>,
}

fn build(value: &serde_json::Value, setup: SensorSetup<'_>) -> Result<Box<dyn Sensor>, WorldError> {
    let config: CameraConfig = parse_sensor_settings(value)?;
    let eye = config.build(setup)?;
    Ok(Box::new(ImageGoalSensor {
        name: super::key(KIND.name, config.name)?,
        rgb: vec![0; eye.camera.width() as usize * eye.camera.height() as usize * 3],
        eye,
    }))
}

impl Sensor for ImageGoalSensor {
    fn spec(&self) -> SensorSpec {
        let camera = &self.eye.camera;
        SensorSpec {
            name: self.name.clone(),
            shape: vec![camera.height() as usize, camera.width() as usize, 3],
            dtype: Dtype::Uint8,
            unit: "sRGB",
            low: 0.0,
            high: 255.0,
            about: ABOUT,
        }
    }

    fn begin_episode(&mut self, world: &World, episode: &Episode) -> Result<(), WorldError> {
        let agent = world.state().agents.get(self.eye.agent);
        let (Some(agent), Some(position)) = (agent, episode.goal.position) else {
            return Ok(());
        };
        let there = AgentState {
            position,
            yaw_rad: episode.goal.yaw_rad,
            ..*agent
        };
        let world_from_camera: Pose = there.world_from_eye() * self.eye.eye_from_camera;
        let request = ImageRequest {
            mount: CameraMount::WorldWithout(self.eye.agent, world_from_camera),
            ..self.eye.request(world.state())
        };
        let channels = ImageChannels {
            rgb: true,
            ..ImageChannels::NONE
        };
        let (_, frame) = world.render_image(&request, channels, Threads::ONE)?;
        self.rgb = frame.rgb;
        Ok(())
    }

    fn write_observation(&self, _: SensorContext<'_>, out: ObservationBuffer<'_>) {
        if let ObservationBuffer::Uint8(out) = out {
            out.copy_from_slice(&self.rgb);
        }
    }
}
