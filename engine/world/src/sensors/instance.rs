//! Instance ids.

use super::image::{self, Kind, Look, Shape};
use super::{Dtype, Out, Sensor, SensorKind, Site};
use crate::error::WorldError;
use dwell_render::ImageChannels;

const ABOUT: &str = "Instance ids: 0 void, then structure pieces, objects, agents, in file order; shape (height, width, \
                     1).";

pub(super) const KIND: SensorKind = SensorKind {
    name: IMAGE.name,
    about: ABOUT,
    build,
    image: Some(&IMAGE),
};

static IMAGE: Kind = Kind {
    name: "instance",
    about: ABOUT,
    shape: Shape::Image(1),
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

fn build(value: &serde_json::Value, site: Site<'_>) -> Result<Box<dyn Sensor>, WorldError> {
    image::build(&IMAGE, value, site)
}

fn write(look: Look<'_>, out: Out<'_>) {
    if let Out::Int32(out) = out {
        out.copy_from_slice(&look.frame.instance);
    }
}
