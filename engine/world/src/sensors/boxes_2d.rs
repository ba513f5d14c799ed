//! Boxes around things in the image.

use super::camera::CameraConfig;
use super::image::{self, DisplayStyle, ImageContext, ImageSensorKind, ObservationShape};
use super::object_list;
use super::{Dtype, ObservationBuffer, Sensor, SensorKind, SensorSetup};
use crate::error::WorldError;
use crate::schema;
use dwell_render::ImageChannels;

const ABOUT: &str = "Boxes around objects and agents in the image, by id: id, first column and row, the column and row \
                     behind the last, pixels; rows as in visible_objects; shape (max_objects, 6).";

pub(super) const KIND: SensorKind = SensorKind {
    name: IMAGE.name,
    about: ABOUT,
    build,
    settings: schema::fields_of::<CameraConfig>,
    image: Some(|_| &IMAGE),
    goal_part: None,
};

static IMAGE: ImageSensorKind = ImageSensorKind {
    name: "boxes_2d",
    about: ABOUT,
    shape: ObservationShape::List(6),
    style: DisplayStyle::List,
    dtype: Dtype::Int32,
    unit: "id, px",
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
    let ObservationBuffer::Int32(out) = out else {
        return;
    };
    object_list::write_object_rows(&look, out, |sighting| {
        let ([left, top], [right, bottom]) = (sighting.first_pixel, sighting.end_pixel);
        [
            sighting.entity.0 as u32,
            left,
            top,
            right,
            bottom,
            sighting.pixels,
        ]
        .map(|n| n as i32)
    });
}
