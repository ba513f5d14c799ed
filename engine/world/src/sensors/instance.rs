//! Instance ids.

use super::camera::CameraConfig;
use super::image::{self, DisplayStyle, ImageContext, ImageSensorKind, ObservationShape};
use super::{Dtype, ObservationBuffer, Sensor, SensorKind, SensorSetup};
use crate::error::WorldError;
use crate::schema;
use dwell_render::ImageChannels;

const ABOUT: &str = "Instance ids: 0 void, then structure pieces, objects, agents, in file order; shape (height, width, \
                     1).";

pub(super) const KIND: SensorKind = SensorKind {
    name: IMAGE.name,
    about: ABOUT,
    build,
    settings: schema::fields_of::<CameraConfig>,
    image: Some(|_| &IMAGE),
    goal_part: None,
};

static IMAGE: ImageSensorKind = ImageSensorKind {
    name: "instance",
    about: ABOUT,
    shape: ObservationShape::Image(1),
    style: DisplayStyle::Ids,
    dtype: Dtype::Int32,
    unit: "id",
    low: 0.0,
    high: i32::MAX as f64,
    channels: ImageChannels {
        instance: true,
        ..ImageChannels::NONE
    },
    write,
};

fn build(value: &serde_json::Value, site: SensorSetup<'_>) -> Result<Box<dyn Sensor>, WorldError> {
    image::build(|_| &IMAGE, value, site)
}

fn write(look: ImageContext<'_>, out: ObservationBuffer<'_>) {
    if let ObservationBuffer::Int32(out) = out {
        out.copy_from_slice(&look.frame.instance);
    }
}
