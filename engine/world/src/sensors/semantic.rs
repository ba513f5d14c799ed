//! Semantic classes: 0 void, then the table that the house's info prints; shape (height, width, 1).

use super::camera::{CameraConfig, EyeCamera};
use super::{Dtype, Out, Seen, Sensor, SensorKind, SensorSpec, Site, settings};
use crate::error::WorldError;
use crate::requests::{Channel, Requests};
use crate::world::World;

const ABOUT: &str = "Semantic classes: 0 void, then the table that the house's info prints; shape (height, width, 1).";

pub(super) const KIND: SensorKind = SensorKind {
    name: "semantic",
    about: ABOUT,
    build,
};

#[derive(Debug)]
struct Semantic {
    config: CameraConfig,
    eye: EyeCamera,
}

fn build(value: &serde_json::Value, site: Site<'_>) -> Result<Box<dyn Sensor>, WorldError> {
    let config: CameraConfig = settings(value)?;
    let eye = config.build(&site.config.agents)?;
    Ok(Box::new(Semantic { config, eye }))
}

impl Sensor for Semantic {
    fn spec(&self) -> SensorSpec {
        SensorSpec {
            name: "semantic".to_owned(),
            shape: self.config.shape(1),
            dtype: Dtype::Int32,
            unit: "class",
            low: 0.0,
            high: f64::from(i32::MAX),
            about: ABOUT,
        }
    }

    fn eye(&self) -> Option<&EyeCamera> {
        Some(&self.eye)
    }

    fn plan(&self, _world: &World, requests: &mut Requests) {
        requests.view(&self.eye, Channel::Semantic);
    }

    fn finish(&self, seen: Seen<'_>, out: Out<'_>) {
        if let (Some(view), Out::Int32(out)) = (seen.results.view(&self.eye), out) {
            out.copy_from_slice(&view.semantic);
        }
    }
}
