//! Colour image.

use super::camera::CameraConfig;
use super::image::{self, DisplayStyle, ImageContext, ImageSensorKind, ObservationShape};
use super::{Dtype, ObservationBuffer, Sensor, SensorKind, SensorSetup};
use crate::error::WorldError;
use crate::schema;
use dwell_render::ImageChannels;

const ABOUT: &str = "Colour image: shape (height, width, 3), sRGB bytes.";

pub(super) const KIND: SensorKind = SensorKind {
    name: IMAGE.name,
    about: ABOUT,
    build,
    settings: schema::fields_of::<CameraConfig>,
    image: Some(|_| &IMAGE),
    goal_part: None,
};

static IMAGE: ImageSensorKind = ImageSensorKind {
    name: "rgb",
    about: ABOUT,
    shape: ObservationShape::Image(3),
    style: DisplayStyle::Colors,
    dtype: Dtype::Uint8,
    unit: "sRGB",
    low: 0.0,
    high: 255.0,
    channels: ImageChannels {
        rgb: true,
        ..ImageChannels::NONE
    },
    write,
};

fn build(value: &serde_json::Value, site: SensorSetup<'_>) -> Result<Box<dyn Sensor>, WorldError> {
    image::build(|_| &IMAGE, value, site)
}

fn write(look: ImageContext<'_>, out: ObservationBuffer<'_>) {
    if let ObservationBuffer::Uint8(out) = out {
        out.copy_from_slice(&look.frame.rgb);
        look.optics().apply_to_color(look.camera, look.key, out);
    }
}
