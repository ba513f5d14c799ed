//! Normals of surfaces.

use super::image::{self, Kind, Look, Shape};
use super::{Dtype, Out, Sensor, SensorKind, Site};
use crate::error::WorldError;
use dwell_render::ImageChannels;

const ABOUT: &str = "Normals of surfaces in the camera's frame (to the right, up, back), on the side that is seen, unit \
                     length, zeros where nothing is seen; shape (height, width, 3).";

pub(super) const KIND: SensorKind = SensorKind {
    name: IMAGE.name,
    about: ABOUT,
    build,
    image: Some(&IMAGE),
};

static IMAGE: Kind = Kind {
    name: "normals",
    about: ABOUT,
    shape: Shape::Image(3),
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

fn build(value: &serde_json::Value, site: Site<'_>) -> Result<Box<dyn Sensor>, WorldError> {
    image::build(&IMAGE, value, site)
}

fn write(look: Look<'_>, out: Out<'_>) {
    if let Out::Float32(out) = out {
        out.copy_from_slice(&look.frame.normals);
    }
}
