//! Optical flow.

use super::image::{self, Kind, Look, Shape};
use super::{Dtype, Out, Sensor, SensorKind, Site};
use crate::error::WorldError;
use dwell_render::ImageChannels;

const ABOUT: &str = "Optical flow: how far what a pixel shows has moved in the image since the step before, pixels to the \
                     right and down, by the camera's movement and its own; shape (height, width, 2).";

pub(super) const KIND: SensorKind = SensorKind {
    name: IMAGE.name,
    about: ABOUT,
    build,
    image: Some(&IMAGE),
};

static IMAGE: Kind = Kind {
    name: "flow",
    about: ABOUT,
    shape: Shape::Image(2),
    dtype: Dtype::Float32,
    unit: "px",
    low: -1e9,
    high: 1e9,
    channels: ImageChannels {
        flow: true,
        ..ImageChannels::NONE
    },
    write,
};

fn build(value: &serde_json::Value, site: Site<'_>) -> Result<Box<dyn Sensor>, WorldError> {
    image::build(&IMAGE, value, site)
}

fn write(look: Look<'_>, out: Out<'_>) {
    if let Out::Float32(out) = out {
        for (out, flow) in out.iter_mut().zip(&look.frame.flow) {
            *out = flow.clamp(-1e9, 1e9);
        }
    }
}
