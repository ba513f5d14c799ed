//! Normals of surfaces.

use super::camera::CameraConfig;
use super::image::{self, DisplayStyle, ImageContext, ImageSensorKind, ObservationShape};
use super::{Dtype, ObservationBuffer, Sensor, SensorKind, SensorSetup};
use crate::error::WorldError;
use crate::schema;
use dwell_render::ImageChannels;

const ABOUT: &str = "Normals of surfaces in the camera's frame (to the right, up, back), on the side that is seen, unit \
                     length, zeros where nothing is seen; shape (height, width, 3).";

pub(super) const KIND: SensorKind = SensorKind {
    name: IMAGE.name,
    about: ABOUT,
    build,
    settings: schema::fields_of::<CameraConfig>,
    image: Some(|_| &IMAGE),
    goal_part: None,
};

static IMAGE: ImageSensorKind = ImageSensorKind {
    name: "normals",
    about: ABOUT,
    shape: ObservationShape::Image(3),
    style: DisplayStyle::Directions,
    dtype: Dtype::Float32,
    unit: "1",
    low: -1.000_01,
    high: 1.000_01,
    channels: ImageChannels {
        normals: true,
        ..ImageChannels::NONE
    },
    write,
};

fn build(value: &serde_json::Value, site: SensorSetup<'_>) -> Result<Box<dyn Sensor>, WorldError> {
    image::build(|_| &IMAGE, value, site)
}

fn write(look: ImageContext<'_>, out: ObservationBuffer<'_>) {
    if let ObservationBuffer::Float32(out) = out {
        out.copy_from_slice(&look.frame.normals);
    }
}
