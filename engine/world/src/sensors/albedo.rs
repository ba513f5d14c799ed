//! Reflectance of surfaces.

use super::image::{self, Kind, Look, Shape};
use super::{Dtype, Out, Sensor, SensorKind, Site};
use crate::error::WorldError;
use dwell_render::ImageChannels;

const ABOUT: &str = "Reflectance of surfaces for red, green and blue, linear, 0 to 1, zeros where nothing is seen; shape \
                     (height, width, 3).";

pub(super) const KIND: SensorKind = SensorKind {
    name: IMAGE.name,
    about: ABOUT,
    build,
    image: Some(&IMAGE),
};

static IMAGE: Kind = Kind {
    name: "albedo",
    about: ABOUT,
    shape: Shape::Image(3),
    dtype: Dtype::Float32,
    unit: "1",
    low: 0.0,
    high: 1.0,
    channels: ImageChannels {
        albedo: true,
        ..ImageChannels::NONE
    },
    write,
};

fn build(value: &serde_json::Value, site: Site<'_>) -> Result<Box<dyn Sensor>, WorldError> {
    image::build(&IMAGE, value, site)
}

fn write(look: Look<'_>, out: Out<'_>) {
    if let Out::Float32(out) = out {
        out.copy_from_slice(&look.frame.albedo);
    }
}
