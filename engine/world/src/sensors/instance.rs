//! Instance ids: 0 void, then structure pieces, objects, agents, in file order; shape (height, width, 1).

use super::camera::{CameraConfig, EyeCamera};
use super::{Dtype, Out, Seen, Sensor, SensorKind, SensorSpec, Site, settings};
use crate::error::WorldError;
use crate::requests::{Channel, Requests};
use crate::world::World;

const ABOUT: &str = "Instance ids: 0 void, then structure pieces, objects, agents, in file order; shape (height, width, 1).";

pub(super) const KIND: SensorKind = SensorKind {
    name: "instance",
    about: ABOUT,
    build,
};

#[derive(Debug)]
struct Instance {
    config: CameraConfig,
    eye: EyeCamera,
}

fn build(value: &serde_json::Value, site: Site<'_>) -> Result<Box<dyn Sensor>, WorldError> {
    let config: CameraConfig = settings(value)?;
    let eye = config.build(&site.config.agents)?;
    Ok(Box::new(Instance { config, eye }))
}

impl Sensor for Instance {
    fn spec(&self) -> SensorSpec {
        SensorSpec {
            name: "instance".to_owned(),
            shape: self.config.shape(1),
            dtype: Dtype::Int32,
            unit: "id",
            low: 0.0,
            high: f64::from(i32::MAX),
            about: ABOUT,
        }
    }

    fn eye(&self) -> Option<&EyeCamera> {
        Some(&self.eye)
    }

    fn plan(&self, _world: &World, requests: &mut Requests) {
        requests.view(&self.eye, Channel::Instance);
    }

    fn finish(&self, seen: Seen<'_>, out: Out<'_>) {
        if let (Some(view), Out::Int32(out)) = (seen.results.view(&self.eye), out) {
            out.copy_from_slice(&view.instance);
        }
    }
}
