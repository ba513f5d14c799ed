//! The thing that a pixel shows, as the target of an action.

use crate::error::WorldError;
use crate::world::World;
use dwell_physics::Target;
use dwell_render::Camera;
use dwell_scene::{AgentId, Pose};
use glam::{Vec2, Vec3};

impl World {
    /// Returns the thing that a pixel of a camera at an agent's eye shows, as a target.
    ///
    /// `eye_from_camera`: the camera's mount.
    /// `pixel`: column and row, counted from 0 at the top left; the middle of the pixel is meant.
    ///
    /// # Errors
    /// [`WorldError::Config`] for a pixel outside the image, [`WorldError::InvalidCall`] for an agent that does not exist.
    pub fn pixel_target(
        &self,
        agent: AgentId,
        camera: &Camera,
        eye_from_camera: Pose,
        [column, row]: [f32; 2],
    ) -> Result<Target, WorldError> {
        let (width, height) = (camera.width() as f32, camera.height() as f32);
        if !(0.0..width).contains(&column) || !(0.0..height).contains(&row) {
            return Err(WorldError::Config {
                field: "pixel",
                found: format!("[{column}, {row}]"),
                allowed: format!("[0 to {}, 0 to {}]", width - 1.0, height - 1.0),
            });
        }
        let Some(state) = self.state().agents.get(agent) else {
            return Err(WorldError::InvalidCall(format!(
                "no agent {}; there are {}",
                agent.0,
                self.state().agents.len()
            )));
        };
        let eye = state.world_from_eye() * eye_from_camera;
        let place = Vec2::new(column + 0.5, row + 0.5);
        Self::ray_target(camera, eye, place).ok_or_else(|| WorldError::Config {
            field: "pixel",
            found: format!("[{column}, {row}]"),
            allowed: "a pixel that sees something".to_owned(),
        })
    }

    /// Returns the ray through a place of an image, pixels from its left and upper edge; `None` where the camera sees nothing.
    pub(crate) fn ray_target(
        camera: &Camera,
        world_from_camera: Pose,
        place: Vec2,
    ) -> Option<Target> {
        let (start, direction) = camera.ray_in_camera(place);
        (direction != Vec3::ZERO).then(|| Target::Ray {
            origin: world_from_camera.transform_point(start),
            direction: world_from_camera.transform_vector(direction),
        })
    }
}
