//! Cameras on agents.

use crate::camera_capture::{CameraMount, ImageRequest};
use dwell_render::{Camera, Preset};
use dwell_scene::{AgentId, Pose, State};

/// A checked camera on an agent.
#[derive(Clone, Debug, PartialEq)]
pub struct EyeCamera {
    /// The agent that carries it.
    pub agent: AgentId,
    /// The camera.
    pub camera: Camera,
    /// Its horizontal field of view, degrees; `None` for a camera that was given by its projection.
    pub fov_deg: Option<f32>,
    /// Its pose relative to the eyes.
    pub eye_from_camera: Pose,
    /// Flat or lit.
    pub preset: Preset,
}

impl EyeCamera {
    /// The camera under a world's parameters: once `agent/N/camera/fov_deg` is set it takes precedence over its own
    /// field of view. A camera that was given by its projection keeps it.
    pub fn camera_in(&self, state: &State) -> Camera {
        let (Some(fov_deg), Some(_)) = (state.overridden_fov_deg(self.agent), self.fov_deg) else {
            return self.camera;
        };
        let own = &self.camera;
        Camera::from_fov(own.width(), own.height(), fov_deg)
            .and_then(|camera| camera.with_range(own.near_m(), own.far_m()))
            .unwrap_or(self.camera)
    }
}

impl EyeCamera {
    /// Its request for a picture.
    pub fn request(&self, state: &State) -> ImageRequest {
        ImageRequest {
            camera: self.camera_in(state),
            mount: CameraMount::Agent(self.agent, self.eye_from_camera),
            preset: self.preset,
        }
    }
}
