//! The settings that all camera sensors share. Sensors with equal settings share one picture.

use crate::error::WorldError;
use dwell_render::{Camera, Preset};
use dwell_scene::{AgentId, State};
use serde::{Deserialize, Serialize};

/// A camera at an agent's eyes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct CameraConfig {
    /// Which agent's eyes.
    pub agent: u32,
    /// Pixels across; 1 to 8,192, default 128.
    pub width: u32,
    /// Pixels down; 1 to 8,192, default 128.
    pub height: u32,
    /// Horizontal field of view, degrees; 1 to 170, default 90.
    pub fov_deg: f32,
    /// Nearest distance that is seen, m; default 0.05.
    pub near_m: f32,
    /// Furthest distance, to which depth is clamped, m; default 50.
    pub far_m: f32,
    /// `"flat"` (texture times colour) or `"lit"` (lamps and daylight).
    pub preset: String,
}

impl Default for CameraConfig {
    fn default() -> Self {
        Self {
            agent: 0,
            width: 128,
            height: 128,
            fov_deg: State::CAMERA_FOV_DEG,
            near_m: 0.05,
            far_m: 50.0,
            preset: "lit".to_owned(),
        }
    }
}

/// A checked camera on an agent.
#[derive(Clone, Debug, PartialEq)]
pub struct EyeCamera {
    /// Which agent's eyes.
    pub agent: AgentId,
    /// The camera.
    pub camera: Camera,
    /// Flat or lit.
    pub preset: Preset,
}

impl EyeCamera {
    /// The camera as a world's parameters have it: `agent/N/camera/fov_deg` goes before its own field of view.
    pub fn camera_in(&self, state: &State) -> Camera {
        let Some(fov_deg) = state.camera_fov_deg(self.agent) else {
            return self.camera;
        };
        let own = &self.camera;
        Camera::from_fov(own.width(), own.height(), fov_deg)
            .and_then(|camera| camera.with_range(own.near_m(), own.far_m()))
            .unwrap_or(self.camera)
    }
}

impl CameraConfig {
    /// Checks every range.
    ///
    /// # Errors
    /// [`WorldError::Config`] or [`WorldError::Render`] names the field.
    pub fn build(&self, agent_count: usize) -> Result<EyeCamera, WorldError> {
        if self.agent as usize >= agent_count {
            let allowed = format!("below the number of agents, {agent_count}");
            return Err(WorldError::Config {
                field: "agent",
                found: self.agent.to_string(),
                allowed,
            });
        }
        let preset = match self.preset.as_str() {
            "flat" => Preset::Flat,
            "lit" => Preset::Lit,
            other => {
                let allowed = "\"flat\" or \"lit\"".to_owned();
                return Err(WorldError::Config {
                    field: "preset",
                    found: format!("{other:?}"),
                    allowed,
                });
            }
        };
        let camera = Camera::from_fov(self.width, self.height, self.fov_deg)?
            .with_range(self.near_m, self.far_m)?;
        Ok(EyeCamera {
            agent: AgentId(self.agent),
            camera,
            preset,
        })
    }

    /// The shape of an image with `channels` channels.
    pub(crate) fn shape(&self, channels: usize) -> Vec<usize> {
        vec![self.height as usize, self.width as usize, channels]
    }
}
