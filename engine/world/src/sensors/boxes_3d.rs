//! Oriented boxes around things in view.

use super::camera::CameraConfig;
use super::image::{self, DisplayStyle, ImageContext, ImageSensorKind, ObservationShape};
use super::object_list;
use super::{Dtype, ObservationBuffer, Sensor, SensorKind, SensorSetup};
use crate::error::WorldError;
use crate::schema;
use dwell_render::ImageChannels;

const ABOUT: &str = "Oriented boxes around objects and agents in view, in the camera's frame, by id: id, middle in m, \
                     edges in m, rotation x, y, z, w; rows as in visible_objects; shape (max_objects, 11).";

pub(super) const KIND: SensorKind = SensorKind {
    name: IMAGE.name,
    about: ABOUT,
    build,
    settings: schema::fields_of::<CameraConfig>,
    image: Some(|_| &IMAGE),
    goal_part: None,
};

static IMAGE: ImageSensorKind = ImageSensorKind {
    name: "boxes_3d",
    about: ABOUT,
    shape: ObservationShape::List(11),
    style: DisplayStyle::List,
    dtype: Dtype::Float32,
    unit: "id, m, m, 1",
    low: -1e9,
    high: 1e9,
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
    let ObservationBuffer::Float32(out) = out else {
        return;
    };
    let world = look.world;
    let camera_from_world = look.view().world_from_camera.inverse();
    // The picture was taken with it.
    let Ok(renderer) = world.engines().cpu_renderer() else {
        return;
    };
    object_list::write_object_rows(&look, out, |sighting| {
        let mut row = [0.0; 11];
        row[0] = sighting.entity.0 as f32;
        if let Some(bounds) = renderer.oriented_box(world.state(), sighting.entity) {
            let pose = camera_from_world * bounds.world_from_box;
            row[1..4].copy_from_slice(&pose.position.to_array());
            row[4..7].copy_from_slice(&bounds.size.to_array());
            row[7..].copy_from_slice(&pose.rotation.to_array());
        }
        row
    });
}
