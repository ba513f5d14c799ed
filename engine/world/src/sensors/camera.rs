//! The settings that all camera sensors share. Sensors with equal settings share one picture.

use super::SensorSetup;
use crate::error::WorldError;
use crate::eye_camera::EyeCamera;
use dwell_render::{Camera, ClassSet, Preset, Projection};
use dwell_scene::space::rotation_from_yaw_pitch;
use dwell_scene::{Id, Pose, math};
use glam::{Quat, Vec3};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A camera at an agent's eyes, or mounted beside them. Several sensors of one kind need names; two cameras side by side are a
/// stereo pair.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct CameraConfig {
    /// The key in the observation; by default the sensor's kind.
    pub name: Option<String>,
    /// Which agent's eyes; by default those of the one whom the environment is about.
    pub agent: Option<u32>,
    /// Pixels across; 1 to 8,192, default 128.
    pub width: u32,
    /// Pixels down; 1 to 8,192, default 128.
    pub height: u32,
    /// Horizontal field of view of a pinhole, degrees; 1 to 170; by default that of the agent's body, 90 if nothing else is
    /// said.
    pub fov_deg: Option<f32>,
    /// The kind of camera with its numbers, in place of `fov_deg`: `{"kind": "pinhole", "fx": ...}`, `brown_conrady`,
    /// `fisheye`, `equirectangular`, `cubemap`, `orthographic`.
    #[schemars(with = "Option<serde_json::Map<String, serde_json::Value>>")]
    pub projection: Option<Projection>,
    /// Position of the camera relative to the eyes: to the right, up, back, m; default none of them.
    pub position_m: [f32; 3],
    /// Rotation of the camera relative to the eyes: yaw, degrees to the left.
    pub yaw_deg: f32,
    /// Then up, degrees.
    pub pitch_deg: f32,
    /// Then about its own axis, degrees, counter-clockwise as it looks.
    pub roll_deg: f32,
    /// Nearest distance that is seen, m; default 0.05.
    pub near_m: f32,
    /// Furthest distance, to which depth is clamped, m; default 50.
    pub far_m: f32,
    /// `"flat"` (texture times colour), `"lit"` (lamps and daylight) or `"full"` (all light, for pictures): see [`Preset`].
    pub preset: String,
    /// Rows of sensors that list things; 1 to 4,096, default 64.
    pub max_objects: u32,
    /// The classes of `semantic`, which are those of `House.semantic_classes`: `"coarse"` (default), `"fine"` or `"nyu40"`.
    pub classes: ClassSet,
}

impl Default for CameraConfig {
    fn default() -> Self {
        Self {
            name: None,
            agent: None,
            width: 128,
            height: 128,
            fov_deg: None,
            projection: None,
            position_m: [0.0; 3],
            yaw_deg: 0.0,
            pitch_deg: 0.0,
            roll_deg: 0.0,
            near_m: 0.05,
            far_m: 50.0,
            preset: "lit".to_owned(),
            max_objects: 64,
            classes: ClassSet::Coarse,
        }
    }
}

/// Returns the pose of a camera relative to the eyes, from its settings.
pub(crate) fn mount(position_m: [f32; 3], [yaw_deg, pitch_deg, roll_deg]: [f32; 3]) -> Pose {
    let turned = rotation_from_yaw_pitch(yaw_deg.to_radians(), pitch_deg.to_radians());
    let (sine, cosine) = math::sin_cos(0.5 * roll_deg.to_radians());
    let rolled = Quat::from_xyzw(0.0, 0.0, sine, cosine);
    Pose::new(Vec3::from_array(position_m), (turned * rolled).normalize())
}

impl CameraConfig {
    /// Checks every range.
    ///
    /// # Errors
    /// [`WorldError::Config`] or [`WorldError::Render`] names the field.
    pub fn build(&self, setup: SensorSetup<'_>) -> Result<EyeCamera, WorldError> {
        let fault = |field: &'static str, found: String, allowed: String| {
            Err(WorldError::Config {
                field,
                found,
                allowed,
            })
        };
        let agent = setup.agent(self.agent)?;
        let body = &setup.config.agents[agent.index()];
        let Some(preset) = Preset::from_name(&self.preset) else {
            let allowed = Preset::ALL.map(|preset| format!("{:?}", preset.name()));
            return fault("preset", format!("{:?}", self.preset), allowed.join(", "));
        };
        if !self.position_m.iter().all(|part| part.abs() <= 100.0) {
            let found = format!("{:?}", self.position_m);
            return fault(
                "position_m",
                found,
                "-100 to 100 m along each axis".to_owned(),
            );
        }
        let angles = [self.yaw_deg, self.pitch_deg, self.roll_deg];
        for (field, angle) in ["yaw_deg", "pitch_deg", "roll_deg"].into_iter().zip(angles) {
            if !(-360.0..=360.0).contains(&angle) {
                return fault(field, angle.to_string(), "-360 to 360 degrees".to_owned());
            }
        }
        if !(1..=4096).contains(&self.max_objects) {
            let found = self.max_objects.to_string();
            return fault("max_objects", found, "1 to 4096".to_owned());
        }
        if self.name.as_ref().is_some_and(String::is_empty) {
            return fault("name", "\"\"".to_owned(), "a word".to_owned());
        }
        let (camera, fov_deg) = match (self.projection, self.fov_deg) {
            (Some(_), Some(fov_deg)) => {
                let allowed = "nothing beside a projection".to_owned();
                return fault("fov_deg", fov_deg.to_string(), allowed);
            }
            (Some(projection), None) => (Camera::new(self.width, self.height, projection)?, None),
            (None, own) => {
                let fov_deg = own.unwrap_or(body.camera_fov_deg);
                let camera = Camera::from_fov(self.width, self.height, fov_deg)?;
                (camera, Some(fov_deg))
            }
        };
        Ok(EyeCamera {
            agent,
            camera: camera.with_range(self.near_m, self.far_m)?,
            fov_deg,
            eye_from_camera: mount(self.position_m, angles),
            preset,
        })
    }
}
