//! The sensor of objects in view, with their hidden shares.

use super::camera::CameraConfig;
use super::image::{self, DisplayStyle, ImageContext, ImageSensorKind, ObservationShape};
use super::object_list;
use super::{Dtype, ObservationBuffer, Sensor, SensorKind, SensorSetup};
use crate::error::WorldError;
use crate::schema;
use dwell_render::ImageChannels;

const ABOUT: &str = "Objects and agents in view, by id: id, pixels, and how much of it others hide, 0 to 1; of more than \
                     fit those with most pixels, unused rows 0; shape (max_objects, 3).";

pub(super) const KIND: SensorKind = SensorKind {
    name: IMAGE.name,
    about: ABOUT,
    build,
    settings: schema::fields_of::<CameraConfig>,
    image: Some(|_| &IMAGE),
    goal_part: None,
};

static IMAGE: ImageSensorKind = ImageSensorKind {
    name: "visible_objects",
    about: ABOUT,
    shape: ObservationShape::List(3),
    style: DisplayStyle::List,
    dtype: Dtype::Float32,
    unit: "id, px, 1",
    low: 0.0,
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
    let view = look.view();
    // The picture was taken with it.
    let Ok(renderer) = world.engines().cpu_renderer() else {
        return;
    };
    object_list::write_object_rows(&look, out, |sighting| {
        let (scene, state) = (world.rays(), world.state());
        let alone = renderer.unoccluded_pixel_count(scene, state, &view, sighting.entity);
        let hidden = 1.0 - sighting.pixels as f32 / alone.max(sighting.pixels) as f32;
        [sighting.entity.0 as f32, sighting.pixels as f32, hidden]
    });
}
