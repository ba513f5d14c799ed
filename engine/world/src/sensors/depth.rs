//! Depth image.

use super::camera::CameraConfig;
use super::image::{self, DisplayStyle, ImageContext, ImageSensorKind, ObservationShape};
use super::{Dtype, ObservationBuffer, Sensor, SensorKind, SensorSetup};
use crate::error::WorldError;
use crate::schema;
use dwell_render::ImageChannels;

const ABOUT: &str = "Depth image: metres along the camera's -Z (range for fisheyes and cameras that see all around), \
                     shape (height, width, 1); misses are clamped to `far_m`.";

pub(super) const KIND: SensorKind = SensorKind {
    name: IMAGE.name,
    about: ABOUT,
    build,
    settings: schema::fields_of::<CameraConfig>,
    image: Some(|_| &IMAGE),
    goal_part: None,
};

static IMAGE: ImageSensorKind = ImageSensorKind {
    name: "depth",
    about: ABOUT,
    shape: ObservationShape::Image(1),
    style: DisplayStyle::Depth,
    dtype: Dtype::Float32,
    unit: "m",
    low: 0.0,
    high: 1e6,
    channels: ImageChannels {
        depth: true,
        ..ImageChannels::NONE
    },
    write,
};

fn build(value: &serde_json::Value, site: SensorSetup<'_>) -> Result<Box<dyn Sensor>, WorldError> {
    image::build(|_| &IMAGE, value, site)
}

fn write(look: ImageContext<'_>, out: ObservationBuffer<'_>) {
    if let ObservationBuffer::Float32(out) = out {
        let (frame, camera) = (look.frame, look.camera);
        out.copy_from_slice(&frame.depth);
        look.optics()
            .apply_to_depth(camera, &frame.normals, look.key, out);
    }
}
