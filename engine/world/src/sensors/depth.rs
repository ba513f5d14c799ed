//! Depth image: metres along the camera's -Z, shape (height, width, 1); misses are clamped to `far_m`.

use super::camera::{CameraConfig, EyeCamera};
use super::{Dtype, Out, Seen, Sensor, SensorKind, SensorSpec, Site, settings};
use crate::error::WorldError;
use crate::requests::{Channel, Requests};
use crate::world::World;

const ABOUT: &str = "Depth image: metres along the camera's -Z, shape (height, width, 1); misses are clamped to `far_m`.";

pub(super) const KIND: SensorKind = SensorKind {
    name: "depth",
    about: ABOUT,
    build,
};

#[derive(Debug)]
struct Depth {
    config: CameraConfig,
    eye: EyeCamera,
}

fn build(value: &serde_json::Value, site: Site<'_>) -> Result<Box<dyn Sensor>, WorldError> {
    let config: CameraConfig = settings(value)?;
    let eye = config.build(&site.config.agents)?;
    Ok(Box::new(Depth { config, eye }))
}

impl Sensor for Depth {
    fn spec(&self) -> SensorSpec {
        SensorSpec {
            name: "depth".to_owned(),
            shape: self.config.shape(1),
            dtype: Dtype::Float32,
            unit: "m",
            low: 0.0,
            high: f64::from(self.config.far_m),
            about: ABOUT,
        }
    }

    fn eye(&self) -> Option<&EyeCamera> {
        Some(&self.eye)
    }

    fn plan(&self, _world: &World, requests: &mut Requests) {
        requests.view(&self.eye, Channel::Depth);
    }

    fn finish(&self, seen: Seen<'_>, out: Out<'_>) {
        if let (Some(view), Out::Float32(out)) = (seen.results.view(&self.eye), out) {
            out.copy_from_slice(&view.depth);
        }
    }
}
