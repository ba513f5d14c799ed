//! Boxes around things in the image.

use super::image::{self, Kind, Look, Shape};
use super::list;
use super::{Dtype, Out, Sensor, SensorKind, Site};
use crate::error::WorldError;
use dwell_render::ImageChannels;

const ABOUT: &str = "Boxes around objects and agents in the image, by id: id, first column and row, the column and row \
                     behind the last, pixels; rows as in visible_objects; shape (max_objects, 6).";

pub(super) const KIND: SensorKind = SensorKind {
    name: IMAGE.name,
    about: ABOUT,
    build,
    image: Some(&IMAGE),
};

static IMAGE: Kind = Kind {
    name: "boxes_2d",
    about: ABOUT,
    shape: Shape::List(6),
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

fn build(value: &serde_json::Value, site: Site<'_>) -> Result<Box<dyn Sensor>, WorldError> {
    image::build(&IMAGE, value, site)
}

fn write(look: Look<'_>, out: Out<'_>) {
    let Out::Int32(out) = out else { return };
    list::fill(&look, out, |sighting| {
        let ([left, top], [right, bottom]) = (sighting.first, sighting.end);
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
