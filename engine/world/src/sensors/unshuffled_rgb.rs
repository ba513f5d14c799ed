//! The picture that the agent would see if everything were as it was before it was changed.

use super::camera::CameraConfig;
use super::{
    Dtype, ObservationBuffer, Sensor, SensorContext, SensorKind, SensorSetup, SensorSpec,
    parse_sensor_settings,
};
use crate::episode::{Episode, GoalField};
use crate::error::WorldError;
use crate::eye_camera::EyeCamera;
use crate::schema;
use crate::world::World;
use dwell_render::{Frame, ImageChannels, RenderJob};
use dwell_scene::State;
use dwell_scene::parallel::Threads;
use dwell_scene::rays::RayScene;
use std::fmt;
use std::sync::{Mutex, PoisonError};

const ABOUT: &str = "Colour image that the agent would see from where it stands if what was changed were as it was at the house's start, \
                     without noise: shape (height, width, 3), sRGB bytes.";

pub(super) const KIND: SensorKind = SensorKind {
    name: "unshuffled_rgb",
    about: ABOUT,
    build,
    settings: schema::fields_of::<CameraConfig>,
    image: None,
    goal_part: Some(GoalField::Placements),
};

struct UnshuffledRgbSensor {
    name: String,
    eye: EyeCamera,
    /// The house as it is to be, and its surfaces; only agents move in it.
    goal: Option<Mutex<(State, RayScene)>>,
}

impl fmt::Debug for UnshuffledRgbSensor {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("UnshuffledRgbSensor")
            .field("name", &self.name)
            .field("eye", &self.eye)
            .finish_non_exhaustive()
    }
}

fn build(value: &serde_json::Value, setup: SensorSetup<'_>) -> Result<Box<dyn Sensor>, WorldError> {
    let config: CameraConfig = parse_sensor_settings(value)?;
    let eye = config.build(setup)?;
    Ok(Box::new(UnshuffledRgbSensor {
        name: super::key(KIND.name, config.name)?,
        eye,
        goal: None,
    }))
}

impl UnshuffledRgbSensor {
    /// Takes the picture; `None` where there is no goal, or it cannot be taken.
    fn render(&self, world: &World) -> Option<Vec<u8>> {
        let goal = self.goal.as_ref()?;
        let mut goal = goal.lock().unwrap_or_else(PoisonError::into_inner);
        let (state, scene) = &mut *goal;
        state.agents.clone_from(&world.state().agents);
        scene.update(state);
        let view = world.moving_view(&self.eye.request(world.state())).view;
        let channels = ImageChannels {
            rgb: true,
            ..ImageChannels::NONE
        };
        let mut frame = Frame::new(&view.camera, channels);
        let renderer = world
            .engines()
            .image_renderer(&world.config().renderer)
            .ok()?;
        let mut jobs = vec![RenderJob::new(scene, state, view, frame.as_mut())];
        renderer.render_batch(&mut jobs, Threads::ONE).ok()?;
        drop(jobs);
        Some(frame.rgb)
    }
}

impl Sensor for UnshuffledRgbSensor {
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
        let house = world.house();
        let initial = &world.initial.state;
        let mut state = world.state().clone();
        for placement in &episode.goal.placements {
            for part in house.objects[placement.object].parts() {
                state.part_pose[part] = initial.part_pose[part];
            }
            for joint in house.joints_of(placement.object) {
                state.joint_position[joint] = initial.joint_position[joint];
            }
        }
        let mut scene = RayScene::new(house.clone());
        scene.update(&state);
        self.goal = Some(Mutex::new((state, scene)));
        Ok(())
    }

    fn write_observation(&self, seen: SensorContext<'_>, out: ObservationBuffer<'_>) {
        let ObservationBuffer::Uint8(out) = out else {
            return;
        };
        match self.render(seen.world) {
            Some(rgb) if rgb.len() == out.len() => out.copy_from_slice(&rgb),
            _ => out.fill(0),
        }
    }
}
