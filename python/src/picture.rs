//! One picture of a world, as Python requests it.

use crate::errors::PyFault;
use crate::values::JsonArgument;
use dwell::sensors::{ImageObservationOptions, Observation, ObservationData};
use dwell::{CameraMount, ImageRequest, World, camera_mount};
use dwell_render::{Camera, ClassSet, Preset, Projection};
use dwell_scene::parallel::Threads;
use dwell_scene::space::{rotation_from_forward, rotation_from_yaw_pitch};
use dwell_scene::{AgentId, Pose};
use glam::Vec3;
use numpy::{IntoPyArray, PyArrayMethods};
use pyo3::prelude::*;
use serde::Deserialize;

/// A requested picture.
#[derive(Deserialize)]
#[serde(default, deny_unknown_fields)]
struct PictureSettings {
    camera: CameraSettings,
    agent: Option<u32>,
    position: [f32; 3],
    yaw_deg: f32,
    pitch_deg: f32,
    forward: Option<[f32; 3]>,
}

/// The camera of a picture, and how it is mounted.
#[derive(Deserialize)]
#[serde(default, deny_unknown_fields)]
struct CameraSettings {
    width: u32,
    height: u32,
    fov_deg: Option<f32>,
    projection: Option<Projection>,
    near_m: f32,
    far_m: f32,
    preset: Preset,
    position_m: [f32; 3],
    yaw_deg: f32,
    pitch_deg: f32,
    roll_deg: f32,
    max_objects: u32,
    classes: ClassSet,
}

impl Default for CameraSettings {
    fn default() -> Self {
        Self {
            width: 128,
            height: 128,
            fov_deg: None,
            projection: None,
            near_m: Camera::DEFAULT_NEAR_M,
            far_m: Camera::DEFAULT_FAR_M,
            preset: Preset::Lit,
            position_m: [0.0; 3],
            yaw_deg: 0.0,
            pitch_deg: 0.0,
            roll_deg: 0.0,
            max_objects: 64,
            classes: ClassSet::Coarse,
        }
    }
}

impl Default for PictureSettings {
    fn default() -> Self {
        Self {
            camera: CameraSettings::default(),
            agent: None,
            position: [0.0; 3],
            yaw_deg: 0.0,
            pitch_deg: 0.0,
            forward: None,
        }
    }
}

/// Returns what the sensors called `channels` give for the view that `view` describes.
pub(crate) fn render(
    world: &World,
    view: JsonArgument,
    channels: &[String],
) -> Result<Vec<Observation>, PyFault> {
    let settings: PictureSettings = view.read()?;
    let own = &settings.camera;
    let camera = match (own.projection, own.fov_deg) {
        (Some(_), Some(fov_deg)) => {
            return Err(PyFault::Config(format!(
                "camera.fov_deg is {fov_deg}; allowed is None beside a projection"
            )));
        }
        (Some(projection), None) => Camera::new(own.width, own.height, projection)?,
        (None, fov_deg) => {
            let agents = settings
                .agent
                .filter(|agent| (*agent as usize) < world.state().agents.len())
                .map(|agent| world.state().camera_fov_deg(AgentId(agent)));
            // A camera away from an agent's eyes has their default right angle.
            let fov_deg = fov_deg.or(agents).unwrap_or(90.0);
            Camera::from_fov(own.width, own.height, fov_deg)?
        }
    };
    let request = ImageRequest {
        camera: camera.with_range(own.near_m, own.far_m)?,
        mount: checked_mount(world, &settings)?,
        preset: own.preset,
    };
    let threads = Threads::try_resolve(None)?;
    let images = ImageObservationOptions {
        max_objects: own.max_objects,
        classes: own.classes,
    };
    Ok(world.image_observations(&request, channels, images, threads)?)
}

/// An observation as an array of its own shape.
pub(crate) fn array(py: Python<'_>, observation: Observation) -> PyResult<Bound<'_, PyAny>> {
    let shape = observation.spec.shape;
    Ok(match observation.data {
        ObservationData::Uint8(data) => data.into_pyarray(py).reshape(shape)?.into_any(),
        ObservationData::Float32(data) => data.into_pyarray(py).reshape(shape)?.into_any(),
        ObservationData::Int32(data) => data.into_pyarray(py).reshape(shape)?.into_any(),
    })
}

/// Returns the mount of the camera.
fn checked_mount(world: &World, settings: &PictureSettings) -> Result<CameraMount, PyFault> {
    let own = &settings.camera;
    let mount = camera_mount(own.position_m, [own.yaw_deg, own.pitch_deg, own.roll_deg]);
    if !mount.is_valid() {
        return Err(PyFault::Config(
            "camera: position and angles must be finite".to_owned(),
        ));
    }
    if let Some(number) = settings.agent {
        let count = world.state().agents.len();
        if number as usize >= count {
            return Err(PyFault::Config(format!(
                "no agent {number}; there are {count}, counted from 0"
            )));
        }
        return Ok(CameraMount::Agent(AgentId(number), mount));
    }
    let rotation = match settings.forward {
        Some(forward) => rotation_from_forward(Vec3::from_array(forward)).ok_or_else(|| {
            PyFault::Config(format!(
                "forward is {forward:?}; allowed is a direction that is not zero"
            ))
        })?,
        None => rotation_from_yaw_pitch(
            settings.yaw_deg.to_radians(),
            settings.pitch_deg.to_radians(),
        ),
    };
    let pose = Pose::new(Vec3::from_array(settings.position), rotation);
    if pose.is_valid() {
        Ok(CameraMount::World(pose * mount))
    } else {
        Err(PyFault::Config(
            "position and angles must be finite".to_owned(),
        ))
    }
}
