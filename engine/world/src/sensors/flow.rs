//! Optical flow.

use super::camera::CameraConfig;
use super::image::{self, DisplayStyle, ImageContext, ImageSensorKind, ObservationShape};
use super::{Dtype, ObservationBuffer, Sensor, SensorKind, SensorSetup};
use crate::error::WorldError;
use crate::schema;
use dwell_render::ImageChannels;

const ABOUT: &str = "Optical flow: how far what a pixel shows has moved in the image since the step before, pixels to the \
                     right and down, by the camera's movement and its own; shape (height, width, 2).";

pub(super) const KIND: SensorKind = SensorKind {
    name: IMAGE.name,
    about: ABOUT,
    build,
    settings: schema::fields_of::<CameraConfig>,
    image: Some(|_| &IMAGE),
    goal_part: None,
};

static IMAGE: ImageSensorKind = ImageSensorKind {
    name: "flow",
    about: ABOUT,
    shape: ObservationShape::Image(2),
    style: DisplayStyle::Flow,
    dtype: Dtype::Float32,
    unit: "px",
    low: -1e9,
    high: 1e9,
    channels: ImageChannels {
        flow: true,
        ..ImageChannels::NONE
    },
    write,
};

fn build(value: &serde_json::Value, site: SensorSetup<'_>) -> Result<Box<dyn Sensor>, WorldError> {
    image::build(|_| &IMAGE, value, site)
}

fn write(look: ImageContext<'_>, out: ObservationBuffer<'_>) {
    if let ObservationBuffer::Float32(out) = out {
        for (out, flow) in out.iter_mut().zip(&look.frame.flow) {
            *out = flow.clamp(-1e9, 1e9);
        }
    }
}
