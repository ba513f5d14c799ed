//! The settings that all camera sensors share. Sensors with equal settings share one picture.

use crate::error::WorldError;
use dwell_render::{Camera, Preset};
use dwell_scene::{AgentBody, AgentId, State};
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
    /// Horizontal field of view, degrees; 1 to 170; by default that of the agent's body, 90 if nothing else is said.
    pub fov_deg: Option<f32>,
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
            fov_deg: None,
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
    /// Its horizontal field of view, degrees.
    pub fov_deg: f32,
    /// Flat or lit.
    pub preset: Preset,
}

impl EyeCamera {
    /// The camera as a world's parameters have it: once `agent/N/camera/fov_deg` is set it goes before its own
    /// field of view.
    pub fn camera_in(&self, state: &State) -> Camera {
        let Some(fov_deg) = state.overridden_fov_deg(self.agent) else {
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
    pub fn build(&self, agents: &[AgentBody]) -> Result<EyeCamera, WorldError> {
        let Some(body) = agents.get(self.agent as usize) else {
            let agent_count = agents.len();
            let allowed = format!("below the number of agents, {agent_count}");
            return Err(WorldError::Config {
                field: "agent",
                found: self.agent.to_string(),
                allowed,
            });
        };
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
        let fov_deg = self.fov_deg.unwrap_or(body.camera_fov_deg);
        let camera = Camera::from_fov(self.width, self.height, fov_deg)?
            .with_range(self.near_m, self.far_m)?;
        Ok(EyeCamera {
            agent: AgentId(self.agent),
            camera,
            fov_deg,
            preset,
        })
    }

    /// The shape of an image with `channels` channels.
    pub(crate) fn shape(&self, channels: usize) -> Vec<usize> {
        vec![self.height as usize, self.width as usize, channels]
    }
}
