//! NYU-40 classes.

use super::image::{self, ImageContext, ImageSensorKind, ObservationShape};
use super::{Dtype, ObservationBuffer, Sensor, SensorKind, SensorSetup};
use crate::error::WorldError;
use dwell_render::{ClassSet, ImageChannels};

const ABOUT: &str = "NYU-40 classes: 0 void, 1 wall, 2 floor to 40 otherprop (House.semantic_classes); shape (height, \
                     width, 1).";

pub(super) const KIND: SensorKind = SensorKind {
    name: IMAGE.name,
    about: ABOUT,
    build,
    image: Some(&IMAGE),
};

static IMAGE: ImageSensorKind = ImageSensorKind {
    name: "semantic_nyu40",
    about: ABOUT,
    shape: ObservationShape::Image(1),
    dtype: Dtype::Int32,
    unit: "class",
    low: 0.0,
    high: i32::MAX as f64,
    channels: ImageChannels {
        instance: true,
        ..ImageChannels::NONE
    },
    write,
};

fn build(value: &serde_json::Value, site: SensorSetup<'_>) -> Result<Box<dyn Sensor>, WorldError> {
    image::build(&IMAGE, value, site)
}

fn write(look: ImageContext<'_>, out: ObservationBuffer<'_>) {
    look.write_classes(ClassSet::Nyu40, out);
}
