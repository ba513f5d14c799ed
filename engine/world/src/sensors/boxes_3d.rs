//! Oriented boxes around things in view.

use super::image::{self, Kind, Look, Shape};
use super::list;
use super::{Dtype, Out, Sensor, SensorKind, Site};
use crate::error::WorldError;
use dwell_render::ImageChannels;

const ABOUT: &str = "Oriented boxes around objects and agents in view, in the camera's frame, by id: id, middle in m, \
                     edges in m, rotation x, y, z, w; rows as in visible_objects; shape (max_objects, 11).";

pub(super) const KIND: SensorKind = SensorKind {
    name: IMAGE.name,
    about: ABOUT,
    build,
    image: Some(&IMAGE),
};

static IMAGE: Kind = Kind {
    name: "boxes_3d",
    about: ABOUT,
    shape: Shape::List(11),
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

fn build(value: &serde_json::Value, site: Site<'_>) -> Result<Box<dyn Sensor>, WorldError> {
    image::build(&IMAGE, value, site)
}

fn write(look: Look<'_>, out: Out<'_>) {
    let Out::Float32(out) = out else { return };
    let world = look.world;
    let camera_from_world = look.view().world_from_camera.inverse();
    list::fill(&look, out, |sighting| {
        let renderer = world.engines().renderer();
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
