//! Colour image from an agent's eyes: shape (height, width, 3), sRGB bytes.

use super::camera::{CameraConfig, EyeCamera};
use super::{Dtype, Out, Seen, Sensor, SensorKind, SensorSpec, Site, settings};
use crate::error::WorldError;
use crate::requests::{Channel, Requests};
use crate::world::World;

const ABOUT: &str = "Colour image from an agent's eyes: shape (height, width, 3), sRGB bytes.";

pub(super) const KIND: SensorKind = SensorKind {
    name: "rgb",
    about: ABOUT,
    build,
};

#[derive(Debug)]
struct Rgb {
    config: CameraConfig,
    eye: EyeCamera,
}

fn build(value: &serde_json::Value, site: Site<'_>) -> Result<Box<dyn Sensor>, WorldError> {
    let config: CameraConfig = settings(value)?;
    let eye = config.build(&site.config.agents)?;
    Ok(Box::new(Rgb { config, eye }))
}

impl Sensor for Rgb {
    fn spec(&self) -> SensorSpec {
        SensorSpec {
            name: "rgb".to_owned(),
            shape: self.config.shape(3),
            dtype: Dtype::Uint8,
            unit: "sRGB",
            low: 0.0,
            high: 255.0,
            about: ABOUT,
        }
    }

    fn eye(&self) -> Option<&EyeCamera> {
        Some(&self.eye)
    }

    fn plan(&self, _world: &World, requests: &mut Requests) {
        requests.view(&self.eye, Channel::Rgb);
    }

    fn finish(&self, seen: Seen<'_>, out: Out<'_>) {
        if let (Some(view), Out::Uint8(out)) = (seen.results.view(&self.eye), out) {
            out.copy_from_slice(&view.rgb);
        }
    }
}
